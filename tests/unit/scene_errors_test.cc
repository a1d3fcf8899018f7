// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "scene_tables.h"

namespace PeriDeal
{
  using namespace SceneTests;
  using dealii::Point;


  TEST(Scenes, domain_errors)
  {
    expect_faults("Domain", R"(
Shape = boxx => Shape | a.prm:3: | Did you mean 'box'?
Nodes = centers => Nodes | vertices, cell centers
Cells = 0, 3 => Cells | at least one cell
Cells = 3 => Cells | needs 2 numbers, found 1
Cells = -3, 3 => Cells | '-3' | whole number
Cells = 12e, 3 => Cells | '12e' is not a number
Lower corner = 0, 0, 0 => Lower corner | 2 coordinates, found 3
Lower corner = abc, 0 => Lower corner | 'abc' is not a number
Lower corner = 0, 1 => Upper corner | coordinate 2 | Lower corner
Hole radius = 12e => Hole radius | '12e' is not a number
Shape = plate with hole & Hole radius = 0 => Hole radius | greater than 0
Shape = plate with hole & Hole center = 2, 0 => Hole center | outside the body
Shape = mesh file => Mesh file | is empty
Mesh file = a.msh => Mesh file | 'box'
Node spacing = 0 => Node spacing | greater than 0
Node spacing = 0.1 & Cells = 3, 3 => Node spacing | 'Cells' is given
Node spacing = 0.0166667 => Node spacing | nearest | 0.0166666666667
Node spacing = 0.4 & Upper corner = 1, 1.5 => Node spacing | is 0.5.
Node spacing = 0.3 & Upper corner = 1, 1.41421356 => Node spacing | give 'Cells' instead
)");
    expect_faults<1>("Domain", "Shape = plate with hole => Shape | 'Dimension' 2 or 3");

    Scene<2> scene;
    parse_scene<2>(
      {"a.prm", "subsection Domain\nset Node spacing = 0.1\nset Upper corner = 3, 2\nend"},
      scene);
    EXPECT_EQ(scene.domain.cells, (std::array<unsigned int, 2>{{30u, 20u}}));
    scene.domain.set("Node spacing", "0.0166666666667");
    scene.domain.parse();
    EXPECT_EQ(scene.domain.cells, (std::array<unsigned int, 2>{{180u, 120u}}));
  }


  /** Messages list the variables that a formula may have, and no others. */
  TEST(Scenes, known_variables)
  {
    struct Case
    {
      std::string section, entry, list; // # is the variable
    };
    const std::string moduli =
      "subsection Material\nset Young modulus = 1\nset Poisson ratio = 0.3\nend\n";
    const std::string elastic = "set Physics = elasticity\n", place = "x, y, z", all = "x, y, z, t",
                      material = "x, y, z, T", loads = "x, y, z, t, T",
                      warm = "\nend\nsubsection Elasticity\nset Temperature change = 1";
    const std::vector<Case>
      of_heat       = {{"Material", "Conductivity = 1 + #", material},
                       {"Material", "Density = 1 + #", material},
                       {"Initial and source", "Source = #", loads},
                       {"Boundary conditions", "Dirichlet = left: #", all},
                       {"Boundary conditions", "Flux = left: #", loads},
                       {"Boundary conditions", "Convection = left: 1 + #, 0", material},
                       {"Boundary conditions", "Convection = left: 1, #", loads},
                       {"Boundary conditions", "Parts = a: left if 1 + #", place},
                       {"Cracks", "Segments = 0.2,0.5;0.8,0.5\nset Transmission = 0.5*#", "t"}},
      of_solids     = {{"Elasticity", "Temperature change = #", place},
                       {"Initial and source", "Body force = #, 0", all},
                       {"Boundary conditions", "Traction = right: #, 0", all},
                       {"Boundary conditions", "Displacement = left: #, 0", all},
                       {"Boundary conditions", "Displacement = left: if(y + # > 2, 0, free), 0", place},
                       {"Material", "Thermal expansion = 1 + #" + warm, material},
                       {"Material", "Young modulus = 1 + #\nset Poisson ratio = 0.3" + warm, material}};
    const auto with = [](const Case &one, const std::string &name) {
      std::string entry = one.entry;
      entry.replace(entry.find('#'), 1, name);
      return "subsection " + one.section + "\nset " + entry + "\nend\n";
    };
    for (const bool solid : {false, true})
      for (const Case &one : solid ? of_solids : of_heat)
        {
          const std::string head = solid ? elastic + (one.entry[0] == 'Y' ? "" : moduli) : "";
          SCOPED_TRACE(one.section + "/" + one.entry);
          expect_parts(fault(head + with(one, "q")), {"known variables: " + one.list + "."});
          for (const std::string name : {"x", "y", "z", "t", "T"})
            {
              const std::string message = fault(head + with(one, name));
              const bool        known   = (", " + one.list + ",").find(" " + name + ",") !=
                                 std::string::npos;
              EXPECT_EQ(message.find("depends on " + name) == std::string::npos &&
                          message.find("may not depend") == std::string::npos &&
                          message.find("'" + name + "':") == std::string::npos &&
                          message.find("may change with") == std::string::npos &&
                          message.find("some times only") == std::string::npos,
                        known)
                << name << ": " << message;
            }
        }
  }


  TEST(Scenes, material_errors)
  {
    expect_faults("Material", R"(
Conductivity = -1 => Conductivity | a.prm:3: | greater than 0
Density = -2*pi => Density | greater than 0
Heat capacity = 0 => Heat capacity | greater than 0
Conductivity = 1 + t => Conductivity | depends on t
Conductivity = 1 + S => Conductivity | 'S' | column 5 | known variables: x, y, z, T.
Conductivity = => Conductivity | is empty
Interface rule = harmonics => Interface rule | Did you mean 'harmonic'?
)");
    expect_faults("Initial and source", R"(
Source = 1/0 => Source | not finite
Initial value = foo(x) => Initial value | unknown name 'foo'
)");
  }


  TEST(Scenes, boundary_condition_errors)
  {
    expect_faults("Boundary conditions", R"(
Dirichlet = topp: 1 => Dirichlet | a.prm:3: | left, right, bottom, top. | Did you mean 'top'?
Dirichlet = front: 1 => Dirichlet | unknown side 'front'
Dirichlet = hole: 1 => Dirichlet | unknown side 'hole'
Dirichlet = 3: 1 => Dirichlet | unknown side '3'
Dirichlet = top => Dirichlet | 'name: value'
Dirichlet = top: => Dirichlet | 'name: value'
Dirichlet = top: 1; top: 2 => Dirichlet | 'top' is named twice
Dirichlet = left: 0; top: 2*xx => Dirichlet | side 'top' | column 3
Dirichlet = top: 1, 2 => Dirichlet | needs one formula
Convection = top: 1 => Convection | coefficient, ambient value
Convection = top: -1, 2 => Convection | -1 is negative
Dirichlet = top: 1 & Flux = top: 1 => Flux | 'top' | 'Dirichlet'
Dirichlet = top: 1 & Convection = top: 1, 2 => Convection | 'top' | 'Dirichlet'
Dirichlet = top: 1 & Symmetry = top => Dirichlet | 'top' | 'Symmetry'
Flux = top: 1 & Symmetry = top => Flux | 'top' | 'Symmetry'
Convection = top: 1, 0 & Symmetry = top => Convection | 'top' | 'Symmetry'
Symmetry = top; top => Symmetry | 'top' is named twice
Symmetry = lft => Symmetry | Did you mean 'left'?
Flux = top: 1; left: 0 & Convection = top: 1, 2 & Symmetry = left, right =>
)");
    expect_faults<1>("Boundary conditions", "Flux = top: 1 => Flux | the sides are: left, right.");

    Scene<2> scene;
    auto    &bc = scene.boundary_conditions;
    bc.set("Dirichlet", "hole: 1; left: 0");
    bc.parse(true, true);
    EXPECT_EQ(bc.dirichlet[0].id, 6u);
    bc.set("Dirichlet", "12: 1; 0: 2");
    bc.parse(false);
    EXPECT_EQ(bc.dirichlet[0].id, 12u);
    bc.set("Dirichlet", "left: 1");
    expect_parts(message_of([&] { bc.parse(false); }), {"'left'", "boundary ids"});
    EXPECT_EQ(box_side_names().size(), 6u);
  }


  TEST(Scenes, crack_errors)
  {
    expect_faults("Cracks", R"(
Segments = 0,0 ; 1,0 ; 0,1 => Segments | a.prm:3: | two points | found 3
Segments = 0,0,0 ; 1,0,0 => Segments | needs 2 coordinates, found 3
Segments = 0,0 ; 1,1 ; 0.5,0.5 ; 0.5,0.5 => Segments | crack 2 | no length
Segments = 0,0 ; 1,1 ; 2,0 ; 2,1 => Segments | crack 2 (2,0 ; 2,1) | outside the body
# passes the corner of the body by, although the bounding boxes overlap
Segments = 0.8,1.5 ; 1.5,0.8 => Segments | outside the body
Segments = -1,0.5 ; 2,0.5 ; 0.5,1.5 ; 1.5,0.4 =>
Polygons = 0,0 ; 1,0 ; 1,1 => Polygons | Segments
Transmission = 1.5 => Transmission | from 0 to 1
Transmission = -0.1 => Transmission | from 0 to 1
Transmission = 0.5 & Contact conductance = 3 => Contact conductance | 'Transmission' is given
Contact conductance = -3 => Contact conductance | 0 or more
Contact conductance = abc => Contact conductance | not a number
Mesh = faces & Transmission = 0.5 => Mesh | Transmission | use 'pairs'
Mesh = removed & Contact conductance = 5 => Mesh | Contact conductance | use 'pairs'
Mesh = pair => Mesh | Did you mean 'pairs'?
)");
    expect_faults<3>("Cracks", R"(
Segments = 0,0,0 ; 1,0,0 => Segments | Polygons
Polygons = 0,0,0.5 ; 1,0,0.5 ; 1,1,0.5 ; 0,1,0.5 | 0,0,0 ; 1,0,0 ; 0,1,1 =>
Polygons = 0,0,0.5 ; 1,0,0.5 ; 1,1,0.5 ; 0,1,0.5001 => Polygons | crack 1 | not planar
Polygons = 0,0,0.5 ; 1,0,0.5 ; 1,1,0.5 ; 0,1,0.50000000001 =>
Polygons = 0,0,0 ; 1,0,0 => Polygons | three or more corners, found 2
Polygons = 0,0,0 ; 1,0,0 ; 0.5,0,0 => Polygons | no area
Polygons = 0,0,0 ; 1,0,0 ; 1,0,0 => Polygons | same corner twice
Polygons = 0,0,2 ; 1,0,2 ; 1,1,2 => Polygons | crack 1 | outside the body
)");
    expect_faults<1>("Cracks", R"(
Segments = 0 ; 1 => Segments | 'Dimension' 2 or 3
Polygons = 0 ; 1 => Polygons | 'Dimension' 2 or 3
)");
  }


  TEST(Scenes, peridynamics_errors)
  {
    const std::string mesh = "subsection Domain\nset Shape = mesh file\nset Mesh file = " +
                             std::string(PERIDEAL_SOURCE_DIR) +
                             "/tests/data/two_materials.msh\nend\n";
    expect_faults("Peridynamics", R"(
Horizon ratio = 0.5 => Horizon ratio | a.prm:3: | 1 or more
Horizon ratio = 12e => Horizon ratio | '12e' is not a number
Horizon = 0 => Horizon | greater than 0
Horizon = -1 => Horizon | greater than 0
Horizon = 0.01 => Horizon | shorter than the node spacing in x, 0.05
Horizon = 0.2 & Horizon ratio = 4 => Horizon | 'Horizon ratio' is given
Kernel = conica => Kernel | Did you mean 'conical'?
Kernel exponent = 3 => Kernel exponent | 0, 1 or 2
Kernel exponent = 1.5 => Kernel exponent | whole number
Volume fraction = no => Volume fraction | none, linear, exact
Calibration = x => Calibration | discrete, isotropic, analytic
Self term = x => Self term | none, paper
Nodal volume = x => Nodal volume | partial, full
Layer rows = 0 => Layer rows | 1 or more
Boundary treatment = exchanged => Boundary treatment | fictitious mirror
Surface correction = crack scalng => Surface correction | crack scaling
Operator form = matrix => Operator form | auto, lattice, stored
Flux treatment = layer extrapolation => Flux treatment | 'Dimension' 1
)");
    expect_faults("Peridynamics",
                  "Horizon ratio = 3 => Horizon ratio | a.prm:6: | node spacing in y, 0.5",
                  "subsection Domain\nset Cells = 10, 2\nend\n");
    expect_faults<1>("Peridynamics", "Flux treatment = layer extrapolation =>");
    expect_faults<3>("Peridynamics", "Self term = paper => Self term | 'Dimension' 1 and 2");
    expect_faults("Peridynamics",
                  R"(
Horizon = 0.3 & Self term = paper => Self term | mesh file
Horizon = 0.3 & Volume fraction = exact => Volume fraction | mesh file
Horizon = 0.3 & Boundary treatment = layer => Boundary treatment | mesh file
Horizon = 0.3 & Boundary treatment = fictitious constant => Boundary treatment | sides of a box
Horizon = 0.3 & Operator form = lattice => Operator form | mesh file
Horizon = 0.3 & Operator form = stored =>
 => Horizon | mesh file
)",
                  mesh);
    EXPECT_EQ(fault("set Models = finite elements\n" + mesh), "");
    expect_faults(
      "Peridynamics",
      "Boundary treatment = fictitious mirror => Boundary treatment | a.prm:6: | sides of a box",
      "subsection Domain\nset Shape = plate with hole\nend\n");
  }


  TEST(Scenes, finite_element_errors)
  {
    const std::string crack = "subsection Cracks\nset Segments = 0,0 ; 1,1\nend\n";
    expect_faults("Finite elements", R"(
Degree = 0 => Degree | 1, 2 or 3
Degree = 2 =>
Degree = 4 => Degree | 1, 2 or 3
Capacity = lump => Capacity | Did you mean 'lumped'?
)");
    expect_faults("Finite elements", "Degree = 2 => Degree | a.prm:6: | pairs", crack);
    expect_faults("Finite elements", "Degree = 2 =>", "set Models = peridynamics\n" + crack);
  }


  TEST(Scenes, storage_is_needed_only_where_something_changes)
  {
    const std::string m      = "Material",
                      steady = "subsection Time\nset Steady = true\nend\n"
                               "subsection Boundary conditions\nset Dirichlet = left: 0\nend\n";
    const auto with          = [&](const std::string &head, const std::string &entry) {
      return fault(head + "subsection Material\nset " + entry + "\nend\n");
    };
    for (const std::string physics : {"heat", "moisture", "electricity"})
      for (const std::string entry : {"Density", "Heat capacity"})
        {
          const std::string name = "set Physics = " + physics + "\n";
          EXPECT_EQ(with(name + steady, entry + " = 0"), "") << physics;
          EXPECT_EQ(with(name + steady, entry + " = 0*x"), "") << physics;
          expect_fault(with(name + steady, entry + " = -1"), m, entry, {"greater than 0"});
          if (physics != "electricity" || entry == "Density")
            expect_fault(with(name, entry + " = 0"), m, entry, {"greater than 0"});
        }
    const std::string phases = "subsection Material\nsubsection Phases\nset Regions = a: x > 0.5\n"
                               "set Density = a: 0\nend\nend\n";
    EXPECT_EQ(fault(steady + phases), "");
    expect_fault(fault(phases), "Material/Phases", "Density", {"greater than 0"});
  }


  TEST(Scenes, time_and_solver_errors)
  {
    expect_faults("Time", R"(
End time = 0 => End time | greater than 0
End time = abc => End time | 'abc' is not a number
Steady = maybe => Steady | true, false
Stepper = euller => Stepper | Did you mean 'euler'?
Time step = 0 => Time step | greater than 0
Time step = -1 => Time step | greater than 0
Time step = atuo => Time step | 'auto' or a number
Time step = 12e => Time step | '12e' is not a number
Tolerance = 1 => Tolerance | between 0 and 1
)");
    expect_faults("Solver", R"(
Tolerance = 0 => Tolerance | between 0 and 1
Maximum iterations = 0 => Maximum iterations | 1 or more
Maximum iterations = -5 => Maximum iterations | whole number
)");

    const std::string steady = "subsection Time\nset Steady = true\nset Stepper = euler\nend\n";
    expect_faults("Time", " => Steady | a.prm:3: | not determined", steady);
    expect_faults("Boundary conditions",
                  R"(
Dirichlet = left: 0 =>
Convection = left: 1, 0 =>
Dirichlet = left: t => Dirichlet | depends on t
Dirichlet = left: 0 & Flux = top: t => Flux | depends on t
Convection = left: 1, t => Convection | depends on t
)",
                  steady);
    expect_faults("Initial and source", "Source = t => Source | depends on t", steady);
    expect_faults("Output",
                  R"(
Write at = 0.1 => Write at | a.prm:7: | 'Steady'
Write every = 0.1 => Write every | 'Steady'
)",
                  steady);
  }


  TEST(Scenes, output_errors)
  {
    expect_faults("Output", R"(
Fields = vtk => Fields | Did you mean 'vtu'?
Fields = => Fields | is empty
Fields = vtu, none => Fields | stands alone
Write at = -0.1 => Write at | -0.1 is negative
Write at = 0.1 0.2 => Write at | not a number
Write every = 0 => Write every | greater than 0
Write every = -1 => Write every | greater than 0
Write every = 1e-6 => Write every | more than 100000
Write every = 0.1 & Write at = 0.2 => Write every | 'Write at' is given
Probes = 0,0 ; 0.5,2 => Probes | (0.5, 2) lies outside
Probes = 0,0,0 => Probes | needs 2 coordinates, found 3
Line = 0,0 ; 1,1 => Line | number of points
Line = 0,0 ; 1,1 ; 1 => Line | 2 or more
Line = 0,0 ; 0,0 ; 3 => Line | same point
Line = 0,0 ; 1,1.5 ; 3 => Line | (1, 1.5) lies outside
Grid = 4 => Grid | '4' | 2 numbers of cells
Grid = 4, 4 ; 0, 4 => Grid | found 0
Grid = 4, x => Grid | 'x'
Grid = 5000, 5000 => Grid | more than 1000000 points
)");
    expect_faults("Output",
                  "Grid = 4, 4 => Grid | a box",
                  "subsection Domain\nset Shape = plate with hole\nend\n");
    expect_faults("Solver", "Direct solver up to = 0 => Direct solver up to | 1 or more");

    Scene<1> scene;
    scene.output.set("Write every", "0.1");
    scene.output.parse(1., false);
    ASSERT_EQ(scene.output.write_times.size(), 9u);
    EXPECT_DOUBLE_EQ(scene.output.write_times[8], 0.9);
    scene.output.set("Fields", "none");
    scene.output.parse(1., false);
    EXPECT_FALSE(scene.output.vtu || scene.output.hdf5);
  }
} // namespace PeriDeal
