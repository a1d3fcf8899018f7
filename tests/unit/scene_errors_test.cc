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
    expect_fault(fault(s, "Shape = boxx"), s, "Shape", {"a.prm:3: ", "Did you mean 'box'?"});
    expect_fault(fault(s, "Nodes = centers"), s, "Nodes", {"vertices, cell centers"});
    expect_fault(fault(s, "Cells = 0, 3"), s, "Cells", {"at least one cell"});
    expect_fault(fault(s, "Cells = 3"), s, "Cells", {"needs 2 numbers, found 1"});
    expect_fault(fault(s, "Cells = -3, 3"), s, "Cells", {"'-3'", "whole number"});
    expect_fault(fault(s, "Cells = 12e, 3"), s, "Cells", {"'12e' is not a number"});
    expect_fault(fault(s, "Lower corner = 0, 0, 0"), s, "Lower corner", {"2 coordinates, found 3"});
    expect_fault(fault(s, "Lower corner = abc, 0"), s, "Lower corner", {"'abc' is not a number"});
    expect_fault(fault(s, "Lower corner = 0, 1"),
                 s,
                 "Upper corner",
                 {"coordinate 2", "Lower corner"});
    expect_fault(fault(s, "Hole radius = 12e"), s, "Hole radius", {"'12e' is not a number"});
    expect_fault(fault(s, "Shape = plate with hole & Hole radius = 0"),
                 s,
                 "Hole radius",
                 {"greater than 0"});
    expect_fault(fault(s, "Shape = plate with hole & Hole center = 2, 0"),
                 s,
                 "Hole center",
                 {"outside the body"});
    expect_fault(fault<1>(s, "Shape = plate with hole"), s, "Shape", {"'Dimension' 2 or 3"});
    expect_fault(fault(s, "Shape = mesh file"), s, "Mesh file", {"is empty"});
    expect_fault(fault(s, "Mesh file = a.msh"), s, "Mesh file", {"'box'"});
    expect_fault(fault(s, "Node spacing = 0"), s, "Node spacing", {"greater than 0"});
    expect_fault(fault(s, "Node spacing = 0.1 & Cells = 3, 3"),
                 s,
                 "Node spacing",
                 {"'Cells' is given"});
    expect_fault(fault(s, "Node spacing = 0.0166667"),
                 s,
                 "Node spacing",
                 {"nearest", "0.0166666666667"});
    expect_fault(fault(s, "Node spacing = 0.4 & Upper corner = 1, 1.5"),
                 s,
                 "Node spacing",
                 {"is 0.5."});
    expect_fault(fault(s, "Node spacing = 0.3 & Upper corner = 1, 1.41421356"),
                 s,
                 "Node spacing",
                 {"give 'Cells' instead"});

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
    expect_fault(fault(s, "Conductivity = -1"), s, "Conductivity", {"a.prm:3: ", "greater than 0"});
    expect_fault(fault(s, "Density = -2*pi"), s, "Density", {"greater than 0"});
    expect_fault(fault(s, "Heat capacity = 0"), s, "Heat capacity", {"greater than 0"});
    expect_fault(fault(s, "Conductivity = 1 + t"), s, "Conductivity", {"depends on t"});
    expect_fault(fault(s, "Conductivity = 1 + S"),
                 s,
                 "Conductivity",
                 {"'S'", "column 5", "known variables: x, y, z, T."});
    expect_fault(fault(s, "Conductivity ="), s, "Conductivity", {"is empty"});
    expect_fault(fault(s, "Interface rule = harmonics"),
                 s,
                 "Interface rule",
                 {"Did you mean 'harmonic'?"});
    expect_fault(fault(i, "Source = 1/0"), i, "Source", {"not finite"});
    expect_fault(fault(i, "Initial value = foo(x)"), i, "Initial value", {"unknown name 'foo'"});
  }


  TEST(Scenes, boundary_condition_errors)
  {
    const std::string s = "Boundary conditions";
    expect_fault(fault(s, "Dirichlet = topp: 1"),
                 s,
                 "Dirichlet",
                 {"a.prm:3: ", "left, right, bottom, top.", "Did you mean 'top'?"});
    expect_fault(fault(s, "Dirichlet = front: 1"), s, "Dirichlet", {"unknown side 'front'"});
    expect_fault(fault<1>(s, "Flux = top: 1"), s, "Flux", {"the sides are: left, right."});
    expect_fault(fault(s, "Dirichlet = hole: 1"), s, "Dirichlet", {"unknown side 'hole'"});
    expect_fault(fault(s, "Dirichlet = 3: 1"), s, "Dirichlet", {"unknown side '3'"});
    expect_fault(fault(s, "Dirichlet = top"), s, "Dirichlet", {"'name: value'"});
    expect_fault(fault(s, "Dirichlet = top:"), s, "Dirichlet", {"'name: value'"});
    expect_fault(fault(s, "Dirichlet = top: 1; top: 2"), s, "Dirichlet", {"'top' is named twice"});
    expect_fault(fault(s, "Dirichlet = left: 0; top: 2*xx"),
                 s,
                 "Dirichlet",
                 {"side 'top'", "column 3"});
    expect_fault(fault(s, "Dirichlet = top: 1, 2"), s, "Dirichlet", {"needs one formula"});
    expect_fault(fault(s, "Convection = top: 1"), s, "Convection", {"coefficient, ambient value"});
    expect_fault(fault(s, "Convection = top: -1, 2"), s, "Convection", {"-1 is negative"});
    expect_fault(fault(s, "Dirichlet = top: 1 & Flux = top: 1"),
                 s,
                 "Flux",
                 {"'top'", "'Dirichlet'"});
    expect_fault(fault(s, "Dirichlet = top: 1 & Convection = top: 1, 2"),
                 s,
                 "Convection",
                 {"'top'", "'Dirichlet'"});
    expect_fault(fault(s, "Dirichlet = top: 1 & Symmetry = top"),
                 s,
                 "Dirichlet",
                 {"'top'", "'Symmetry'"});
    expect_fault(fault(s, "Flux = top: 1 & Symmetry = top"), s, "Flux", {"'top'", "'Symmetry'"});
    expect_fault(fault(s, "Convection = top: 1, 0 & Symmetry = top"),
                 s,
                 "Convection",
                 {"'top'", "'Symmetry'"});
    expect_fault(fault(s, "Symmetry = top; top"), s, "Symmetry", {"'top' is named twice"});
    expect_fault(fault(s, "Symmetry = lft"), s, "Symmetry", {"Did you mean 'left'?"});
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
    expect_fault(fault(s, "Segments = 0,0 ; 1,0 ; 0,1"),
                 s,
                 "Segments",
                 {"a.prm:3: ", "two points", "found 3"});
    expect_fault(fault(s, "Segments = 0,0,0 ; 1,0,0"),
                 s,
                 "Segments",
                 {"needs 2 coordinates, found 3"});
    expect_fault(fault(s, "Segments = 0,0 ; 1,1 ; 0.5,0.5 ; 0.5,0.5"),
                 s,
                 "Segments",
                 {"crack 2", "no length"});
    expect_fault(fault(s, "Segments = 0,0 ; 1,1 ; 2,0 ; 2,1"),
                 s,
                 "Segments",
                 {"crack 2 (2,0 ; 2,1)", "outside the body"});
    // passes the corner of the body by, although the bounding boxes overlap
    expect_fault(fault(s, "Segments = 0.8,1.5 ; 1.5,0.8"), s, "Segments", {"outside the body"});
    EXPECT_EQ(fault(s, "Segments = -1,0.5 ; 2,0.5 ; 0.5,1.5 ; 1.5,0.4"), "");
    expect_fault(fault<3>(s, "Segments = 0,0,0 ; 1,0,0"), s, "Segments", {"Polygons"});
    expect_fault(fault<1>(s, "Segments = 0 ; 1"), s, "Segments", {"'Dimension' 2 or 3"});
    expect_fault(fault<1>(s, "Polygons = 0 ; 1"), s, "Polygons", {"'Dimension' 2 or 3"});
    expect_fault(fault(s, "Polygons = 0,0 ; 1,0 ; 1,1"), s, "Polygons", {"Segments"});
    const std::string square = "0,0,0.5 ; 1,0,0.5 ; 1,1,0.5 ; 0,1,";
    EXPECT_EQ(fault<3>(s, "Polygons = " + square + "0.5 | 0,0,0 ; 1,0,0 ; 0,1,1"), "");
    expect_fault(fault<3>(s, "Polygons = " + square + "0.5001"),
                 s,
                 "Polygons",
                 {"crack 1", "not planar"});
    EXPECT_EQ(fault<3>(s, "Polygons = " + square + "0.50000000001"), "");
    expect_fault(fault<3>(s, "Polygons = 0,0,0 ; 1,0,0"),
                 s,
                 "Polygons",
                 {"three or more corners, found 2"});
    expect_fault(fault<3>(s, "Polygons = 0,0,0 ; 1,0,0 ; 0.5,0,0"), s, "Polygons", {"no area"});
    expect_fault(fault<3>(s, "Polygons = 0,0,0 ; 1,0,0 ; 1,0,0"),
                 s,
                 "Polygons",
                 {"same corner twice"});
    expect_fault(fault<3>(s, "Polygons = 0,0,2 ; 1,0,2 ; 1,1,2"),
                 s,
                 "Polygons",
                 {"crack 1", "outside the body"});
    expect_fault(fault(s, "Transmission = 1.5"), s, "Transmission", {"from 0 to 1"});
    expect_fault(fault(s, "Transmission = -0.1"), s, "Transmission", {"from 0 to 1"});
    expect_fault(fault(s, "Transmission = 0.5 & Contact conductance = 3"),
                 s,
                 "Contact conductance",
                 {"'Transmission' is given"});
    expect_fault(fault(s, "Contact conductance = -3"), s, "Contact conductance", {"0 or more"});
    expect_fault(fault(s, "Contact conductance = abc"), s, "Contact conductance", {"not a number"});
    expect_fault(fault(s, "Mesh = faces & Transmission = 0.5"),
                 s,
                 "Mesh",
                 {"Transmission", "use 'pairs'"});
    expect_fault(fault(s, "Mesh = removed & Contact conductance = 5"),
                 s,
                 "Mesh",
                 {"Contact conductance", "use 'pairs'"});
    expect_fault(fault(s, "Mesh = pair"), s, "Mesh", {"Did you mean 'pairs'?"});
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
    expect_fault(fault(s, "Horizon ratio = 0.5"), s, "Horizon ratio", {"a.prm:3: ", "1 or more"});
    expect_fault(fault(s, "Horizon ratio = 12e"), s, "Horizon ratio", {"'12e' is not a number"});
    expect_fault(fault(s, "Horizon = 0"), s, "Horizon", {"greater than 0"});
    expect_fault(fault(s, "Horizon = -1"), s, "Horizon", {"greater than 0"});
    expect_fault(fault(s, "Horizon = 0.01"),
                 s,
                 "Horizon",
                 {"shorter than the node spacing in x, 0.05"});
    expect_fault(fault(s, "Horizon = 0.2 & Horizon ratio = 4"),
                 s,
                 "Horizon",
                 {"'Horizon ratio' is given"});
    expect_fault(fault("subsection Domain\nset Cells = 10, 2\nend\nsubsection Peridynamics\nset "
                       "Horizon ratio = 3\nend\n"),
                 s,
                 "Horizon ratio",
                 {"a.prm:6: ", "node spacing in y, 0.5"});
    expect_fault(fault(s, "Kernel = conica"), s, "Kernel", {"Did you mean 'conical'?"});
    expect_fault(fault(s, "Kernel exponent = 3"), s, "Kernel exponent", {"0, 1 or 2"});
    expect_fault(fault(s, "Kernel exponent = 1.5"), s, "Kernel exponent", {"whole number"});
    expect_fault(fault(s, "Volume fraction = no"), s, "Volume fraction", {"none, linear, exact"});
    expect_fault(fault(s, "Calibration = x"), s, "Calibration", {"discrete, analytic"});
    expect_fault(fault(s, "Self term = x"), s, "Self term", {"none, paper"});
    expect_fault(fault(s, "Nodal volume = x"), s, "Nodal volume", {"partial, full"});
    expect_fault(fault(s, "Layer rows = 0"), s, "Layer rows", {"1 or more"});
    expect_fault(fault(s, "Boundary treatment = exchanged"),
                 s,
                 "Boundary treatment",
                 {"fictitious mirror"});
    expect_fault(fault(s, "Surface correction = crack scalng"),
                 s,
                 "Surface correction",
                 {"crack scaling"});
    expect_fault(fault(s, "Operator form = matrix"), s, "Operator form", {"auto, lattice, stored"});
    expect_fault(fault(s, "Flux treatment = layer extrapolation"),
                 s,
                 "Flux treatment",
                 {"'Dimension' 1"});
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
    expect_fault(fault(s, "Degree = 0"), s, "Degree", {"1, 2 or 3"});
    expect_fault(fault(s, "Degree = 4"), s, "Degree", {"1, 2 or 3"});
    expect_fault(fault(s, "Capacity = lump"), s, "Capacity", {"Did you mean 'lumped'?"});
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
    expect_fault(fault(s, "End time = 0"), s, "End time", {"greater than 0"});
    expect_fault(fault(s, "End time = abc"), s, "End time", {"'abc' is not a number"});
    expect_fault(fault(s, "Steady = maybe"), s, "Steady", {"true, false"});
    expect_fault(fault(s, "Stepper = euller"), s, "Stepper", {"Did you mean 'euler'?"});
    expect_fault(fault(s, "Time step = 0"), s, "Time step", {"greater than 0"});
    expect_fault(fault(s, "Time step = -1"), s, "Time step", {"greater than 0"});
    expect_fault(fault(s, "Time step = atuo"), s, "Time step", {"'auto' or a number"});
    expect_fault(fault(s, "Time step = 12e"), s, "Time step", {"'12e' is not a number"});
    expect_fault(fault(s, "Tolerance = 1"), s, "Tolerance", {"between 0 and 1"});
    expect_fault(fault("Solver", "Tolerance = 0"), "Solver", "Tolerance", {"between 0 and 1"});
    expect_fault(fault("Solver", "Maximum iterations = 0"),
                 "Solver",
                 "Maximum iterations",
                 {"1 or more"});
    expect_fault(fault("Solver", "Maximum iterations = -5"),
                 "Solver",
                 "Maximum iterations",
                 {"whole number"});

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
    expect_fault(fault(s, "Fields = vtk"), s, "Fields", {"Did you mean 'vtu'?"});
    expect_fault(fault(s, "Fields ="), s, "Fields", {"is empty"});
    expect_fault(fault(s, "Fields = vtu, none"), s, "Fields", {"stands alone"});
    expect_fault(fault(s, "Write at = -0.1"), s, "Write at", {"-0.1 is negative"});
    expect_fault(fault(s, "Write at = 0.1 0.2"), s, "Write at", {"not a number"});
    expect_fault(fault(s, "Write every = 0"), s, "Write every", {"greater than 0"});
    expect_fault(fault(s, "Write every = -1"), s, "Write every", {"greater than 0"});
    expect_fault(fault(s, "Write every = 1e-6"), s, "Write every", {"more than 100000"});
    expect_fault(fault(s, "Write every = 0.1 & Write at = 0.2"),
                 s,
                 "Write every",
                 {"'Write at' is given"});
    expect_fault(fault(s, "Probes = 0,0 ; 0.5,2"), s, "Probes", {"(0.5, 2) lies outside"});
    expect_fault(fault(s, "Probes = 0,0,0"), s, "Probes", {"needs 2 coordinates, found 3"});
    expect_fault(fault(s, "Line = 0,0 ; 1,1"), s, "Line", {"number of points"});
    expect_fault(fault(s, "Line = 0,0 ; 1,1 ; 1"), s, "Line", {"2 or more"});
    expect_fault(fault(s, "Line = 0,0 ; 0,0 ; 3"), s, "Line", {"same point"});
    expect_fault(fault(s, "Line = 0,0 ; 1,1.5 ; 3"), s, "Line", {"(1, 1.5) lies outside"});
    expect_fault(fault(s, "Grid = 4"), s, "Grid", {"'4'", "2 numbers of cells"});
    expect_fault(fault(s, "Grid = 4, 4 ; 0, 4"), s, "Grid", {"found 0"});
    expect_fault(fault(s, "Grid = 4, x"), s, "Grid", {"'x'"});
    expect_fault(fault(s, "Grid = 5000, 5000"), s, "Grid", {"more than 1000000 points"});
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
