// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "scene_test_tools.h"

namespace PeriDeal
{
  using namespace SceneTests;
  using dealii::Point;


  TEST(Scenes, domain_errors)
  {
    const std::string s = "Domain";
    expect_faults(s,
                  {{"Shape = boxx", {"a.prm:3: ", "Did you mean 'box'?"}},
                   {"Nodes = centers", {"vertices, cell centers"}},
                   {"Cells = 0, 3", {"at least one cell"}},
                   {"Cells = 3", {"needs 2 numbers, found 1"}},
                   {"Cells = -3, 3", {"'-3'", "whole number"}},
                   {"Cells = 12e, 3", {"'12e' is not a number"}},
                   {"Lower corner = 0, 0, 0", {"2 coordinates, found 3"}},
                   {"Lower corner = abc, 0", {"'abc' is not a number"}},
                   {"Lower corner = 0, 1", {"coordinate 2", "Lower corner"}, "Upper corner"},
                   {"Hole radius = 12e", {"'12e' is not a number"}},
                   {"Shape = plate with hole & Hole radius = 0", {"greater than 0"}},
                   {"Shape = plate with hole & Hole center = 2, 0", {"outside the body"}}});
    expect_fault(fault<1>(s, "Shape = plate with hole"), s, "Shape", {"'Dimension' 2 or 3"});
    expect_faults(s,
                  {{"Shape = mesh file", {"is empty"}, "Mesh file"},
                   {"Mesh file = a.msh", {"'box'"}},
                   {"Node spacing = 0", {"greater than 0"}},
                   {"Node spacing = 0.1 & Cells = 3, 3", {"'Cells' is given"}, "Node spacing"},
                   {"Node spacing = 0.0166667", {"nearest", "0.0166666666667"}},
                   {"Node spacing = 0.4 & Upper corner = 1, 1.5", {"is 0.5."}, "Node spacing"},
                   {"Node spacing = 0.3 & Upper corner = 1, 1.41421356",
                    {"give 'Cells' instead"},
                    "Node spacing"}});

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
                      material = "x, y, z, T";
    const std::vector<Case>
      of_heat       = {{"Material", "Conductivity = 1 + #", material},
                       {"Material", "Density = 1 + #", material},
                       {"Initial and source", "Source = #", all},
                       {"Boundary conditions", "Dirichlet = left: #", all},
                       {"Boundary conditions", "Flux = left: #", all},
                       {"Boundary conditions", "Convection = left: 1 + #, 0", place},
                       {"Boundary conditions", "Convection = left: 1, #", all},
                       {"Boundary conditions", "Parts = a: left if 1 + #", place},
                       {"Cracks", "Segments = 0.2,0.5;0.8,0.5\nset Transmission = 0.5*#", "t"}},
      of_solids     = {{"Elasticity", "Temperature change = #", place},
                       {"Initial and source", "Body force = #, 0", all},
                       {"Boundary conditions", "Traction = right: #, 0", all},
                       {"Boundary conditions", "Displacement = left: #, 0", all},
                       {"Boundary conditions", "Displacement = left: if(y + # > 2, 0, free), 0", place},
                       {"Material", "Thermal expansion = 1 + #", place},
                       {"Material", "Young modulus = 1 + #\nset Poisson ratio = 0.3", place}};
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
    const std::string s = "Material", i = "Initial and source";
    expect_faults(s,
                  {{"Conductivity = -1", {"a.prm:3: ", "greater than 0"}},
                   {"Density = -2*pi", {"greater than 0"}},
                   {"Heat capacity = 0", {"greater than 0"}},
                   {"Conductivity = 1 + t", {"depends on t"}},
                   {"Conductivity = 1 + S", {"'S'", "column 5", "known variables: x, y, z, T."}},
                   {"Conductivity =", {"is empty"}},
                   {"Interface rule = harmonics", {"Did you mean 'harmonic'?"}}});
    expect_faults(
      i,
      {{"Source = 1/0", {"not finite"}}, {"Initial value = foo(x)", {"unknown name 'foo'"}}});
  }


  TEST(Scenes, boundary_condition_errors)
  {
    const std::string s = "Boundary conditions";
    expect_faults(
      s,
      {{"Dirichlet = topp: 1", {"a.prm:3: ", "left, right, bottom, top.", "Did you mean 'top'?"}},
       {"Dirichlet = front: 1", {"unknown side 'front'"}}});
    expect_fault(fault<1>(s, "Flux = top: 1"), s, "Flux", {"the sides are: left, right."});
    expect_faults(
      s,
      {{"Dirichlet = hole: 1", {"unknown side 'hole'"}},
       {"Dirichlet = 3: 1", {"unknown side '3'"}},
       {"Dirichlet = top", {"'name: value'"}},
       {"Dirichlet = top:", {"'name: value'"}},
       {"Dirichlet = top: 1; top: 2", {"'top' is named twice"}},
       {"Dirichlet = left: 0; top: 2*xx", {"side 'top'", "column 3"}},
       {"Dirichlet = top: 1, 2", {"needs one formula"}},
       {"Convection = top: 1", {"coefficient, ambient value"}},
       {"Convection = top: -1, 2", {"-1 is negative"}},
       {"Dirichlet = top: 1 & Flux = top: 1", {"'top'", "'Dirichlet'"}},
       {"Dirichlet = top: 1 & Convection = top: 1, 2", {"'top'", "'Dirichlet'"}},
       {"Dirichlet = top: 1 & Symmetry = top", {"'top'", "'Symmetry'"}, "Dirichlet"},
       {"Flux = top: 1 & Symmetry = top", {"'top'", "'Symmetry'"}, "Flux"},
       {"Convection = top: 1, 0 & Symmetry = top", {"'top'", "'Symmetry'"}, "Convection"},
       {"Symmetry = top; top", {"'top' is named twice"}},
       {"Symmetry = lft", {"Did you mean 'left'?"}}});
    EXPECT_EQ(fault(s, "Flux = top: 1; left: 0 & Convection = top: 1, 2 & Symmetry = left, right"),
              "");

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
    const std::string s = "Cracks";
    expect_faults(
      s,
      {{"Segments = 0,0 ; 1,0 ; 0,1", {"a.prm:3: ", "two points", "found 3"}},
       {"Segments = 0,0,0 ; 1,0,0", {"needs 2 coordinates, found 3"}},
       {"Segments = 0,0 ; 1,1 ; 0.5,0.5 ; 0.5,0.5", {"crack 2", "no length"}},
       {"Segments = 0,0 ; 1,1 ; 2,0 ; 2,1", {"crack 2 (2,0 ; 2,1)", "outside the body"}}});
    // passes the corner of the body by, although the bounding boxes overlap
    expect_fault(fault(s, "Segments = 0.8,1.5 ; 1.5,0.8"), s, "Segments", {"outside the body"});
    EXPECT_EQ(fault(s, "Segments = -1,0.5 ; 2,0.5 ; 0.5,1.5 ; 1.5,0.4"), "");
    expect_fault(fault<3>(s, "Segments = 0,0,0 ; 1,0,0"), s, "Segments", {"Polygons"});
    expect_faults<1>(
      s,
      {{"Segments = 0 ; 1", {"'Dimension' 2 or 3"}}, {"Polygons = 0 ; 1", {"'Dimension' 2 or 3"}}});
    expect_fault(fault(s, "Polygons = 0,0 ; 1,0 ; 1,1"), s, "Polygons", {"Segments"});
    const std::string square = "0,0,0.5 ; 1,0,0.5 ; 1,1,0.5 ; 0,1,";
    EXPECT_EQ(fault<3>(s, "Polygons = " + square + "0.5 | 0,0,0 ; 1,0,0 ; 0,1,1"), "");
    expect_fault(fault<3>(s, "Polygons = " + square + "0.5001"),
                 s,
                 "Polygons",
                 {"crack 1", "not planar"});
    EXPECT_EQ(fault<3>(s, "Polygons = " + square + "0.50000000001"), "");
    expect_faults<3>(s,
                     {{"Polygons = 0,0,0 ; 1,0,0", {"three or more corners, found 2"}},
                      {"Polygons = 0,0,0 ; 1,0,0 ; 0.5,0,0", {"no area"}},
                      {"Polygons = 0,0,0 ; 1,0,0 ; 1,0,0", {"same corner twice"}},
                      {"Polygons = 0,0,2 ; 1,0,2 ; 1,1,2", {"crack 1", "outside the body"}}});
    expect_faults(
      s,
      {{"Transmission = 1.5", {"from 0 to 1"}},
       {"Transmission = -0.1", {"from 0 to 1"}},
       {"Transmission = 0.5 & Contact conductance = 3", {"'Transmission' is given"}},
       {"Contact conductance = -3", {"0 or more"}},
       {"Contact conductance = abc", {"not a number"}},
       {"Mesh = faces & Transmission = 0.5", {"Transmission", "use 'pairs'"}, "Mesh"},
       {"Mesh = removed & Contact conductance = 5", {"Contact conductance", "use 'pairs'"}, "Mesh"},
       {"Mesh = pair", {"Did you mean 'pairs'?"}}});
  }


  TEST(Scenes, peridynamics_errors)
  {
    const std::string s    = "Peridynamics",
                      mesh = "subsection Domain\nset Shape = mesh file\nset Mesh file = " +
                             std::string(PERIDEAL_SOURCE_DIR) + "/tests/data/quads.msh\nend\n";
    const auto on_mesh = [&](const std::string &entry, const std::string &value) {
      return fault(mesh + "subsection Peridynamics\nset Horizon = 0.1\nset " + entry + " = " +
                   value + "\nend\n");
    };
    expect_faults(s,
                  {{"Horizon ratio = 0.5", {"a.prm:3: ", "1 or more"}},
                   {"Horizon ratio = 12e", {"'12e' is not a number"}},
                   {"Horizon = 0", {"greater than 0"}},
                   {"Horizon = -1", {"greater than 0"}},
                   {"Horizon = 0.01", {"shorter than the node spacing in x, 0.05"}},
                   {"Horizon = 0.2 & Horizon ratio = 4", {"'Horizon ratio' is given"}, "Horizon"}});
    expect_fault(fault("subsection Domain\nset Cells = 10, 2\nend\nsubsection Peridynamics\nset "
                       "Horizon ratio = 3\nend\n"),
                 s,
                 "Horizon ratio",
                 {"a.prm:6: ", "node spacing in y, 0.5"});
    expect_faults(s,
                  {{"Kernel = conica", {"Did you mean 'conical'?"}},
                   {"Kernel exponent = 3", {"0, 1 or 2"}},
                   {"Kernel exponent = 1.5", {"whole number"}},
                   {"Volume fraction = no", {"none, linear, exact"}},
                   {"Calibration = x", {"discrete, analytic"}},
                   {"Self term = x", {"none, paper"}},
                   {"Nodal volume = x", {"partial, full"}},
                   {"Layer rows = 0", {"1 or more"}},
                   {"Boundary treatment = exchanged", {"fictitious mirror"}},
                   {"Surface correction = crack scalng", {"crack scaling"}},
                   {"Operator form = matrix", {"auto, lattice, stored"}},
                   {"Flux treatment = layer extrapolation", {"'Dimension' 1"}}});
    EXPECT_EQ(fault<1>(s, "Flux treatment = layer extrapolation"), "");
    expect_fault(fault<3>(s, "Self term = paper"), s, "Self term", {"'Dimension' 1 and 2"});
    expect_fault(on_mesh("Self term", "paper"), s, "Self term", {"mesh file"});
    expect_fault(on_mesh("Volume fraction", "exact"), s, "Volume fraction", {"mesh file"});
    expect_fault(on_mesh("Boundary treatment", "layer"), s, "Boundary treatment", {"mesh file"});
    expect_fault(on_mesh("Boundary treatment", "fictitious constant"),
                 s,
                 "Boundary treatment",
                 {"sides of a box"});
    expect_fault(on_mesh("Operator form", "lattice"), s, "Operator form", {"mesh file"});
    EXPECT_EQ(on_mesh("Operator form", "stored"), "");
    expect_fault(fault(mesh), s, "Horizon", {"mesh file"});
    EXPECT_EQ(fault("set Models = finite elements\n" + mesh), "");
    expect_fault(
      fault("subsection Domain\nset Shape = plate with hole\nend\nsubsection Peridynamics\n"
            "set Boundary treatment = fictitious mirror\nend\n"),
      s,
      "Boundary treatment",
      {"a.prm:6: ", "sides of a box"});
  }


  TEST(Scenes, finite_element_errors)
  {
    const std::string s     = "Finite elements",
                      crack = "subsection Cracks\nset Segments = 0,0 ; 1,1\nend\n";
    expect_faults(s,
                  {{"Degree = 0", {"1, 2 or 3"}},
                   {"Degree = 4", {"1, 2 or 3"}},
                   {"Capacity = lump", {"Did you mean 'lumped'?"}}});
    const std::string two = "subsection Finite elements\nset Degree = 2\nend\n";
    expect_fault(fault(crack + two), s, "Degree", {"a.prm:6: ", "pairs"});
    EXPECT_EQ(fault(two), "");
    EXPECT_EQ(fault("set Models = peridynamics\n" + crack + two), "");
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
    const std::string s = "Time";
    expect_faults(s,
                  {{"End time = 0", {"greater than 0"}},
                   {"End time = abc", {"'abc' is not a number"}},
                   {"Steady = maybe", {"true, false"}},
                   {"Stepper = euller", {"Did you mean 'euler'?"}},
                   {"Time step = 0", {"greater than 0"}},
                   {"Time step = -1", {"greater than 0"}},
                   {"Time step = atuo", {"'auto' or a number"}},
                   {"Time step = 12e", {"'12e' is not a number"}},
                   {"Tolerance = 1", {"between 0 and 1"}}});
    expect_faults("Solver",
                  {{"Tolerance = 0", {"between 0 and 1"}},
                   {"Maximum iterations = 0", {"1 or more"}},
                   {"Maximum iterations = -5", {"whole number"}}});

    const std::string steady = "subsection Time\nset Steady = true\nset Stepper = euler\nend\n";
    const auto        with   = [&](const std::string &conditions) {
      return fault(steady + "subsection Boundary conditions\n" + conditions + "\nend\n");
    };
    EXPECT_EQ(with("set Dirichlet = left: 0"), "");
    EXPECT_EQ(with("set Convection = left: 1, 0"), "");
    expect_fault(fault(steady), s, "Steady", {"a.prm:3: ", "not determined"});
    expect_fault(with("set Dirichlet = left: t"),
                 "Boundary conditions",
                 "Dirichlet",
                 {"depends on t"});
    expect_fault(with("set Dirichlet = left: 0\nset Flux = top: t"),
                 "Boundary conditions",
                 "Flux",
                 {"depends on t"});
    expect_fault(with("set Convection = left: 1, t"),
                 "Boundary conditions",
                 "Convection",
                 {"depends on t"});
    expect_fault(fault(steady + "subsection Initial and source\nset Source = t\nend\n"),
                 "Initial and source",
                 "Source",
                 {"depends on t"});
    expect_fault(fault(steady + "subsection Output\nset Write at = 0.1\nend\n"),
                 "Output",
                 "Write at",
                 {"a.prm:7: ", "'Steady'"});
    expect_fault(fault(steady + "subsection Output\nset Write every = 0.1\nend\n"),
                 "Output",
                 "Write every",
                 {"'Steady'"});
  }


  TEST(Scenes, output_errors)
  {
    const std::string s = "Output";
    expect_faults(s,
                  {{"Fields = vtk", {"Did you mean 'vtu'?"}},
                   {"Fields =", {"is empty"}},
                   {"Fields = vtu, none", {"stands alone"}},
                   {"Write at = -0.1", {"-0.1 is negative"}},
                   {"Write at = 0.1 0.2", {"not a number"}},
                   {"Write every = 0", {"greater than 0"}},
                   {"Write every = -1", {"greater than 0"}},
                   {"Write every = 1e-6", {"more than 100000"}},
                   {"Write every = 0.1 & Write at = 0.2", {"'Write at' is given"}, "Write every"},
                   {"Probes = 0,0 ; 0.5,2", {"(0.5, 2) lies outside"}},
                   {"Probes = 0,0,0", {"needs 2 coordinates, found 3"}},
                   {"Line = 0,0 ; 1,1", {"number of points"}},
                   {"Line = 0,0 ; 1,1 ; 1", {"2 or more"}},
                   {"Line = 0,0 ; 0,0 ; 3", {"same point"}},
                   {"Line = 0,0 ; 1,1.5 ; 3", {"(1, 1.5) lies outside"}},
                   {"Grid = 4", {"'4'", "2 numbers of cells"}},
                   {"Grid = 4, 4 ; 0, 4", {"found 0"}},
                   {"Grid = 4, x", {"'x'"}},
                   {"Grid = 5000, 5000", {"more than 1000000 points"}}});
    expect_fault(fault("subsection Domain\nset Shape = plate with hole\nend\n"
                       "subsection Output\nset Grid = 4, 4\nend\n"),
                 s,
                 "Grid",
                 {"a box"});
    expect_fault(fault("Solver", "Direct solver up to = 0"),
                 "Solver",
                 "Direct solver up to",
                 {"1 or more"});

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
