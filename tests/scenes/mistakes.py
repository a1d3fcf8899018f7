# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Mistakes in scenes and on the command line: each ends with exit status 1 and one message that names the entry and the remedy.

A mistake is a change of the small plate below (overrides), or lines put into it, or a command line. The words are what the
message has to say; 'late' ones are found while the mesh or the operators are built. On two processes the message must come
once and the program must not hang.

    mistakes.py [part of the names of those wanted]
"""

import json
import os
import re
import sys

from scene_test import check, finish, print_table, run_perideal, run_scene, temporary_folder, write_file
from scene_texts import FOUR_CELLS, SQUARE_MESH

SCENE = """
set Title     = Small plate
set Dimension = 2
subsection Domain
  set Lower corner = 0, 0
  set Upper corner = 1, 1
  set Cells        = 12, 12
end
subsection Boundary conditions
  set Dirichlet = top: 1; bottom: 0
end
subsection Time
  set End time = 0.01
end
subsection Output
  set Fields = none
  set Probes = 0.5,0.5
end
"""

STEADY = {"Time/Steady": "true"}
CRACK = {"Cracks/Segments": "0.25,0.5 ; 0.75,0.5"}
IN_PART = {"Cracks/Bonds through tips": "in part"}
ELASTIC = {"Physics": "elasticity", "Material/Young modulus": "200", "Material/Poisson ratio": "0.3", "Boundary conditions/Dirichlet": "",
           "Boundary conditions/Displacement": "left: 0, 0"}
PARTS, DIRICHLET = "Boundary conditions/Parts", "Boundary conditions/Dirichlet"
HOT = {DIRICHLET: "bottom: 0; a: 1"}
BLOCK = {"Dimension": "3", "Domain/Lower corner": "0, 0, 0", "Domain/Upper corner": "1, 1, 1", "Domain/Cells": "4, 4, 4", "Output/Probes": ""}
CUT_OFF = {**ELASTIC, "Boundary conditions/Displacement": "bottom: 0, 0", "Boundary conditions/Traction": "right: if(y > 0.6, 1, 0), 0",
           "Cracks/Segments": "-1, 0.52 ; 2, 0.52"}
MOTION = {**ELASTIC, "Elasticity/Solver": "dynamics"}
BRITTLE = {**ELASTIC, "Models": "peridynamics", "Material/Fracture energy": "1"}
SCATTER = {"Material/Weibull modulus": "10", "Material/Strength seed": "1"}
FOLLOWING = {"Models": "coupled", "Coupling/Zone": "follow"}


def mesh_scene(folder, name, text, more=()):
    """Overrides for a scene on a mesh file with this text."""
    path = write_file(name, text, folder)
    return {"Domain/Shape": "mesh file", "Domain/Mesh file": path, "Peridynamics/Horizon": "0.8",
            "Boundary conditions/Dirichlet": "3: 0; 4: 1", "Domain/Lower corner": "0, 0", **dict(more)}


def box_faces(low, high):
    """The six faces of a cube as polygons."""
    corners = [(a, b) for a, b in ((low, low), (high, low), (high, high), (low, high))]
    faces = []
    for axis in range(3):
        for level in (low, high):
            faces.append(" ; ".join(",".join(str(x) for x in (*pair[:axis], level, *pair[axis:])) for pair in corners))
    return faces


def scene_mistakes(folder):
    """(name, overrides or text of a scene, words of the message)."""
    whole = SQUARE_MESH.format(names="", n=8, cells=FOUR_CELLS)
    triangles = SQUARE_MESH.format(names="", n=5, cells="5 2 2 7 7 1 2 5")
    file_of_directory = write_file("a_file", "text", folder)
    changed = [
        # names
        ("unknown entry", {"Material/Conductivty": "2"}, ["Conductivty", "'Material'", "Did you mean 'Conductivity'?"]),
        ("unknown section", {"Materials/Conductivity": "2"}, ["'Materials'", "Did you mean 'Material'?"]),
        ("entry in another section", {"Domain/Horizon": "0.3"}, ["Horizon", "Peridynamics"]),
        ("unknown choice", {"Peridynamics/Kernel": "conicle"}, ["'Kernel'", "Peridynamics", "Did you mean 'conical'?"]),
        ("unknown model", {"Models": "peridynamic"}, ["'Models'", "Did you mean 'peridynamics'?"]),
        ("unknown stepper", {"Time/Stepper": "rk5"}, ["'Stepper'", "'Time'", "Did you mean 'rk4'?"]),
        # points
        ("points without a semicolon", {"Output/Probes": "0,0.1, 0.5,0.1"}, ["'Probes'", "2 points", "0, 0.1 ; 0.5, 0.1"]),
        ("crack without a semicolon", {"Cracks/Segments": "-0.5,0, 0.5,0"}, ["'Segments'", "2 points", "-0.5, 0 ; 0.5, 0"]),
        ("image that is not there", {"Domain/Shape": "image", "Domain/Cells": "20, 20", "Domain/Image": "no_such.png"}, ["'Image'", "no_such.png", "Looked for it at"]),
        # types and ranges
        ("text for a number", {"Time/End time": "soon"}, ["'End time'", "'Time'", "'soon' is not a number"]),
        ("fraction for a count", {"Domain/Cells": "12.5, 12"}, ["'Cells'", "12.5", "whole number"]),
        ("cells without a comma", {"Domain/Cells": "160 20"}, ["'Cells'", "2 numbers, found 1", "Commas separate them: 160, 20"]),
        ("corner with a semicolon", {"Domain/Upper corner": "80; 5"}, ["'Upper corner'", "found 1", "Commas separate them: 80, 5"]),
        ("horizon longer than the body", {"Peridynamics/Horizon": "5"}, ["'Horizon'", "longer than the body, 1", "three spacings of the nodes are 0.25"]),
        ("symmetry of heat and doubled nodes", {**CRACK, "Cracks/Mesh": "faces", "Boundary conditions/Symmetry": "left"}, ["'Symmetry'", "'Mesh = faces'", "'Mesh = pairs'"]),
        ("negative conductivity", {"Material/Conductivity": "-1"}, ["'Conductivity'", "'Material'", "greater than 0"]),
        ("negative density", {"Material/Density": "-2"}, ["'Density'", "greater than 0"]),
        ("exchange at cell centers", {"Peridynamics/Boundary treatment": "exchange", "Domain/Nodes": "cell centers"},
         ["'Nodes' in section 'Domain'", "'Boundary treatment = exchange'", "none"]),
        ("exchange with slaves", {"Peridynamics/Boundary treatment": "exchange", "Peridynamics/Flux treatment": "extrapolation"},
         ["'Flux treatment'", "'Boundary treatment = exchange'"]),
        ("zone without a crack", {"Models": "coupled", "Cracks/Segments": ""}, ["'Zone'", "'Coupling'", "'Cracks'", "everywhere"]),
        ("zone in a bar", {"Models": "coupled", "Dimension": "1", "Domain/Lower corner": "0", "Domain/Upper corner": "1",
                           "Domain/Cells": "10", "Cracks/Segments": "", "Boundary conditions/Dirichlet": "left: 0", "Output/Probes": "",
                           "Output/Line": ""}, ["'Zone'", "'Dimension' 1", "formula"]),
        ("zone without a node", {"Models": "coupled", "Coupling/Zone": "x - 5"}, ["'Zone'", "no node"]),
        ("zone misspelt", {"Models": "coupled", "Coupling/Zone": "crack: 1"}, ["'Zone'", "'cracks: c'"]),
        ("zone of negative width", {"Models": "coupled", "Coupling/Zone": "cracks: -1"}, ["'Zone'", "0 or more"]),
        ("zone that changes", {"Models": "coupled", "Coupling/Zone": "x - t"}, ["'Zone'", "may not depend on t"]),
        ("adaptive splice", {"Models": "coupled", "Coupling/Zone": "adaptive", "Coupling/Scheme": "splice"}, ["'Zone'", "'adaptive'", "exchange"]),
        ("adaptive zone without larger cells", {**CRACK, "Models": "coupled", "Coupling/Zone": "adaptive"}, ["'Zone'", "'Coarsening'", "at least 1"]),
        ("adaptive zone without its model", {**CRACK, "Models": "finite elements", "Coupling/Zone": "adaptive", "Domain/Coarsening": "1"},
         ["'Zone'", "'coupled'"]),
        ("adaptive zone without its model or larger cells", {**CRACK, "Models": "finite elements", "Coupling/Zone": "adaptive"},
         ["'Zone'", "'coupled'"]),
        ("adaptive zone with steps of fixed size", {**CRACK, "Models": "coupled", "Coupling/Zone": "adaptive", "Domain/Coarsening": "1",
                                                    "Time/Stepper": "euler", "Time/Time step": "1e-5"}, ["'Zone'", "'Time step'", "auto"]),
        ("adaptive tolerance", {"Coupling/Adaptive tolerance": "0"}, ["'Adaptive tolerance'", "greater than 0"]),
        ("adaptive tolerance for nothing", {"Coupling/Adaptive tolerance": "0.1"}, ["'Adaptive tolerance'", "'Zone = adaptive'"]),
        ("merged cells too often", {**CRACK, "Models": "coupled", "Domain/Coarsening": "3"}, ["'Coarsening'", "12 cells", "2 times"]),
        ("merged cells under peridynamics", {**CRACK, "Domain/Coarsening": "1"}, ["'Coarsening'", "'Models'", "'coupled'"]),
        ("merged cells with splice", {**CRACK, "Models": "coupled", "Domain/Coarsening": "1", "Coupling/Scheme": "splice"},
         ["'Coarsening'", "'Scheme'", "'exchange'"]),
        ("merged cells without a crack", {"Models": "finite elements", "Domain/Coarsening": "1"}, ["'Coarsening'", "'Cracks'", "'Fine where'"]),
        ("merged cells around a hole", {"Models": "finite elements", "Domain/Coarsening": "1", "Domain/Shape": "plate with hole"},
         ["'Coarsening'", "'Shape'"]),
        ("fine cells without coarse ones", {"Domain/Fine where": "x"}, ["'Fine where'", "'Coarsening'"]),
        ("overlap wider than the body", {"Models": "coupled", "Coupling/Zone": "everywhere", "Coupling/Scheme": "blending", "Coupling/Overlap": "1000"},
         ["'Overlap'", "wider than the body"]),
        ("overlap of exchange", {"Models": "coupled", "Coupling/Zone": "everywhere", "Coupling/Overlap": "1"}, ["'Overlap'", "'exchange'"]),
        ("coupled with quadratic elements", {"Models": "coupled", "Finite elements/Degree": "2", "Coupling/Zone": "everywhere"}, ["'Degree'", "degree 1"]),
        ("negative horizon", {"Peridynamics/Horizon": "-0.3"}, ["'Horizon'", "greater than 0"]),
        ("m below 1", {"Peridynamics/Horizon ratio": "0.9"}, ["'Horizon ratio'", "1 or more"]),
        ("horizon below the spacing", {"Peridynamics/Horizon": "0.05"}, ["'Horizon'", "shorter than the node spacing"]),
        ("no cells", {"Domain/Cells": "0, 12"}, ["'Cells'", "at least one"]),
        ("cells beyond number", {"Domain/Cells": "100000, 100000"}, ["'Cells'", "nodes"]),
        ("corners exchanged", {"Domain/Upper corner": "-1, 1"}, ["'Upper corner'", "'Lower corner'"]),
        ("spacing that does not divide", {"Domain/Node spacing": "0.3", "Domain/Cells": "20, 20"},
         ["'Node spacing'", "0.333"]),
        ("dimension 4", {"Dimension": "4"}, ["'Dimension'", "1, 2 or 3"]),
        ("degree 7", {"Finite elements/Degree": "7"}, ["'Degree'", "1, 2 or 3"]),
        ("transmission of 2", {**CRACK, "Cracks/Transmission": "2"}, ["'Transmission'", "from 0 to 1"]),
        ("solver tolerance 0", {"Solver/Tolerance": "0"}, ["'Tolerance'", "'Solver'", "between 0 and 1"]),
        ("kernel exponent 3", {"Peridynamics/Kernel exponent": "3"}, ["'Kernel exponent'", "0, 1 or 2"]),
        ("horizon beyond the body", {"Peridynamics/Horizon ratio": "1e10"}, ["'Horizon ratio'", "longer than the body"]),
        ("transmission of removed cells", {**CRACK, "Cracks/Mesh": "removed", "Cracks/Transmission": "0.5"},
         ["'Mesh'", "'Transmission'", "'pairs'"]),
        # phases and other physics
        ("phase without a material", {"Material/Phases/Regions": "core: x > 0.5"}, ["'Regions'", "'core'", "no material"]),
        ("material of no phase", {"Material/Phases/Regions": "core: x > 0.5", "Material/Phases/Conductivity": "cor: 2"},
         ["'Conductivity'", "'cor'", "Did you mean 'core'?"]),
        ("circle without a radius", {"Material/Phases/Regions": "core: circle(0, 0)", "Material/Phases/Conductivity": "core: 2"},
         ["'Regions'", "circle(x, y, radius)"]),
        ("zero saturation", {"Physics": "moisture", "Material/Saturated concentration": "0"}, ["'Saturated concentration'", "greater than 0"]),
        ("heat without capacity", {"Material/Heat capacity": "0"}, ["'Heat capacity'", "greater than 0"]),
        ("unknown physics", {"Physics": "moistrue"}, ["'Physics'", "Did you mean 'moisture'?"]),
        # elasticity
        ("elastic body with one modulus", {**ELASTIC, "Material/Poisson ratio": ""}, ["'Young modulus'", "exactly two"]),
        ("moduli that contradict each other", {**ELASTIC, "Material/Poisson ratio": "", "Material/Bulk modulus": "20"},
         ["'Young modulus'", "Poisson ratio would be -1.1666"]),
        ("incompressible in plane strain", {**ELASTIC, "Material/Poisson ratio": "0.5", "Elasticity/Plane": "strain"}, ["'Poisson ratio'", "less than 0.5"]),
        ("body that may turn", {**ELASTIC, "Boundary conditions/Displacement": "bottom: 0, free"},
         ["'Displacement'", "translation in y, rotation about z"]),
        *[(f"part cut off, {model}", {**CUT_OFF, "Models": model}, ["holds a part", "it has no equilibrium", "one of them at (", "Cracks", "'Displacement'"])
          for model in ("finite elements", "peridynamics", "coupled")],
        ("part on a hinge", {**CUT_OFF, "Boundary conditions/Parts": "pin: point 0, 1", "Boundary conditions/Displacement": "bottom: 0, 0; pin: 0, 0"},
         ["holds a part", "it has no equilibrium"]),
        ("empty grip", {**ELASTIC, "Boundary conditions/Displacement": "left: 0, 0; top: free, free"}, ["'Displacement'", "'top'", "empty grip"]),
        ("traction on a grip", {**ELASTIC, "Boundary conditions/Traction": "left: 1, 0"}, ["'Traction'", "'left'", "displacement in x"]),
        ("temperature of an elastic body", {**ELASTIC, "Boundary conditions/Dirichlet": "top: 1"}, ["'Dirichlet'", "'Displacement'"]),
        ("displacement of heat", {"Boundary conditions/Displacement": "left: 0, 0"}, ["'Displacement'", "'Physics = elasticity'"]),
        ("motion of heat", {"Time/Stepper": "verlet"}, ["'Stepper'", "'verlet'", "'Physics = elasticity'", "'auto'"]),
        ("stepper of an equilibrium", {**ELASTIC, "Time/Stepper": "newmark"}, ["'Stepper'", "'newmark'", "'Solver = dynamics'"]),
        ("motion by a stepper of heat", {**MOTION, "Time/Stepper": "rk4"}, ["'Stepper'", "'rk4'", "'verlet' or 'newmark'"]),
        ("equilibrium with a velocity", {**ELASTIC, "Initial and source/Initial velocity": "1, 0"}, ["'Initial velocity'", "no effect", "'dynamics'"]),
        ("equilibrium of moving supports that is steady", {**ELASTIC, "Boundary conditions/Displacement": "left: 0, 0; right: t, 0", "Time/Steady": "true"},
         ["'Steady'", "depend on t"]),
        ("fracture of finite elements", {**ELASTIC, "Models": "finite elements", "Material/Fracture energy": "1"},
         ["'Fracture energy'", "finite elements do not break", "'peridynamics'"]),
        ("fracture of the coupled model", {**ELASTIC, "Models": "coupled", "Material/Critical stretch": "0.1", "Coupling/Zone": "cracks: 1"}, ["'Zone'", "is empty", "'follow'"]),
        ("scatter without a seed", {**BRITTLE, "Material/Weibull modulus": "10"}, ["'Strength seed' in section 'Material'", "is empty", "'Weibull modulus'"]),
        ("seed without a scatter", {**BRITTLE, "Material/Strength seed": "1"}, ["'Strength seed' in section 'Material'", "no effect", "'Weibull modulus'"]),
        *[("scatter of modulus " + modulus, {**BRITTLE, **SCATTER, "Material/Weibull modulus": modulus}, ["'Weibull modulus' in section 'Material'", modulus, "greater than 0"])
          for modulus in ("0", "-3")],
        ("scatter of unbreakable bonds", {**ELASTIC, **SCATTER}, ["'Weibull modulus'", "bonds that break", "'Fracture energy'", "'Critical stretch'"]),
        ("scatter of the coupled model", {**BRITTLE, **SCATTER, **FOLLOWING}, ["'Weibull modulus'", "'Models = peridynamics'", "not 'coupled'"]),
        ("seed that is no whole number", {**BRITTLE, **SCATTER, "Material/Strength seed": "-1"}, ["'Strength seed' in section 'Material'", "-1"]),
        ("breaking of a body in motion", {**MOTION, "Models": "peridynamics", "Material/Fracture energy": "1", "Elasticity/Breaking": "at rest"},
         ["'Breaking' in section 'Elasticity'", "bodies at rest", "'dynamics'"]),
        ("breaking of unbreakable bonds", {**ELASTIC, "Elasticity/Breaking": "at rest"}, ["'Breaking' in section 'Elasticity'", "bonds that break", "'Fracture energy'"]),
        ("unknown way of breaking", {**BRITTLE, "Elasticity/Breaking": "in moton"}, ["'Breaking' in section 'Elasticity'", "'in moton'", "at rest", "'in motion'"]),
        ("half a velocity", {**MOTION, "Initial and source/Initial velocity": "1"}, ["'Initial velocity'", "needs 2 components"]),
        ("initial displacement that depends on t", {**MOTION, "Initial and source/Initial displacement": "t, 0"},
         ["'Initial displacement'", "depends on t"]),
        ("initial displacement of heat", {"Initial and source/Initial displacement": "0, 0"}, ["'Initial displacement'", "'heat'"]),
        ("step of verlet above the limit", {**MOTION, "Time/Time step": "0.1", "Time/End time": "1"}, ["'Time step'", "is 0.1,", "stable up to", "newmark"]),
        ("full kinematics by a linear solver", {**ELASTIC, "Elasticity/Kinematics": "full"}, ["'Kinematics'", "'linear'", "'conjugate gradients'"]),
        ("full kinematics of finite elements", {**ELASTIC, "Elasticity/Kinematics": "full", "Elasticity/Solver": "conjugate gradients"},
         ["'Kinematics'", "'Models = peridynamics'"]),
        ("preconditioner of the linear solver", {**ELASTIC, "Elasticity/Preconditioner": "none"}, ["'Preconditioner'", "conjugate gradients", "'linear'"]),
        ("too few iterations", {**ELASTIC, "Boundary conditions/Traction": "right: 1, 0", "Elasticity/Solver": "dynamic relaxation",
                                "Solver/Maximum iterations": "20"}, ["'Solver = dynamic relaxation'", "20 iterations", "'Maximum iterations'"]),
        # expressions
        ("bad expression", {"Material/Conductivity": "1 + 2*(x"}, ["'Conductivity'", "column"]),
        ("unknown name in an expression", {"Initial and source/Source": "2*x + foo"}, ["'Source'", "foo", "column 7"]),
        ("time in the material", {"Material/Conductivity": "1 + t"}, ["'Conductivity'", "depends on t"]),
        ("nan as Dirichlet value", {"Boundary conditions/Dirichlet": "top: sqrt(-1); bottom: 0"},
         ["'Dirichlet'", "top", "is not finite"]),
        ("nan at some nodes of a side", {"Boundary conditions/Dirichlet": "top: sqrt(x - 0.5); bottom: 0"},
         ["'Dirichlet'", "top", "is not finite"]),
        ("nan as initial value", {"Initial and source/Initial value": "log(x - 0.5)"},
         ["'Initial value'", "is not finite"]),
        ("nan as source", {"Initial and source/Source": "1/(x - x)"}, ["'Source'", "is not finite"]),
        # sides
        ("unknown side", {"Boundary conditions/Dirichlet": "topp: 1"}, ["'Dirichlet'", "'topp'", "Did you mean 'top'?"]),
        ("side without a value", {"Boundary conditions/Dirichlet": "top"}, ["'Dirichlet'", "'name: value'"]),
        ("side twice", {"Boundary conditions/Dirichlet": "top: 1; top: 2"}, ["'Dirichlet'", "'top' is named twice"]),
        ("contradicting conditions", {"Boundary conditions/Flux": "top: 3"}, ["'Flux'", "'top'", "'Dirichlet'"]),
        ("negative coefficient", {"Boundary conditions/Convection": "left: -4, 20"}, ["'Convection'", "'left'", "negative"]),
        ("coefficient with t", {"Boundary conditions/Convection": "left: 4*t, 20"}, ["'Convection'", "'left'", "depends on t"]),
        ("symmetry of a hole", {"Domain/Shape": "plate with hole", "Boundary conditions/Symmetry": "hole"}, ["'Symmetry'", "flat"]),
        ("extrapolated flux with convection", {"Boundary conditions/Flux": "left: 1", "Boundary conditions/Convection": "left: 4, 20",
                                               "Peridynamics/Flux treatment": "extrapolation"},
         ["'Convection'", "'left'", "'Flux treatment'", "'natural'"]),
        # parts
        ("part of no form", {PARTS: "a: top", **HOT}, ["'Parts'", "part 'a'", "found 'top'", "'SIDE if FORMULA'"]),
        ("part of an unknown side", {PARTS: "a: topp if x > 0.5", **HOT}, ["'Parts'", "'topp'", "Did you mean 'top'?"]),
        ("part with a wrong formula", {PARTS: "a: top if x > ", **HOT}, ["'Parts'", "part 'a'", "column", "ends too early"]),
        ("part that moves", {PARTS: "a: top if x > t", **HOT}, ["'Parts'", "part 'a'", "depends on t"]),
        ("part that holds nowhere", {PARTS: "a: region 0", **HOT}, ["'Parts'", "part 'a'", "is empty"]),
        ("part with the name of a side", {PARTS: "left: top if x > 0.5"}, ["'Parts'", "'left'", "name of a side"]),
        ("part twice", {PARTS: "a: top if x > 0.5 ; a: point 0, 0", **HOT}, ["'Parts'", "'a' is named twice"]),
        ("point of three coordinates", {PARTS: "a: point 0, 0, 0", **HOT}, ["'Parts'", "part 'a'", "2 coordinates"]),
        ("unknown part", {PARTS: "load: top if x > 0.5", DIRICHLET: "bottom: 0; laod: 1"}, ["'Dirichlet'", "'laod'", "Parts: load", "Did you mean 'load'?"]),
        ("convection of a region", {PARTS: "a: region x > 0.5", "Boundary conditions/Convection": "a: 1, 2"}, ["'Convection'", "'a'", "no area", "'Flux'"]),
        ("symmetry of a part", {PARTS: "a: left if y > 0.5", "Boundary conditions/Symmetry": "a"}, ["'Symmetry'", "'a'", "whole sides"]),
        ("values on a part of a plane of symmetry", {PARTS: "a: left if y > 0.5", **HOT, "Boundary conditions/Symmetry": "left"}, ["'Dirichlet'", "'a'", "'left'", "'Symmetry'"]),
        ("extrapolated flux of a region", {PARTS: "a: region x > 0.5", "Boundary conditions/Flux": "a: 1", "Peridynamics/Flux treatment": "extrapolation"},
         ["'Flux'", "'a'", "'natural'"]),
        ("free in a sum", {**ELASTIC, "Boundary conditions/Displacement": "left: 0, 0 ; top: 1 + if(x > 0.5, 0, free), 0"}, ["'Displacement'", "'top'", "component in x", "if(condition, formula, free)"]),
        ("free at some times", {**ELASTIC, "Boundary conditions/Displacement": "left: 0, 0 ; top: if(t > 0.5, 0, free), 0"}, ["'Displacement'", "'top'", "at some times"]),
        ("free in a traction", {**ELASTIC, "Boundary conditions/Traction": "right: if(y > 0.5, 0, free), 0"}, ["'Traction'", "'right'", "'free'"]),
        ("velocity at rest", {**ELASTIC, "Boundary conditions/Velocity": "right: 1, free"}, ["'Velocity'", "'Solver'", "'dynamics'"]),
        ("velocity of heat", {"Boundary conditions/Velocity": "right: 1, free"}, ["'Velocity'", "'Physics = elasticity'"]),
        ("velocity and displacement", {**MOTION, "Boundary conditions/Velocity": "left: 1, free"}, ["'Velocity'", "'left'", "displacement in x"]),
        # holes
        ("hole of an unknown form", {"Domain/Holes": "circl: 0.5, 0.5, 0.2"}, ["'Holes'", "Did you mean 'circle'?"]),
        ("circle without a radius among holes", {"Domain/Holes": "circle: 0.5, 0.5"}, ["'Holes'", "circle", "x, y, radius"]),
        ("rectangle inside out", {"Domain/Holes": "rectangle: 0.5, 0.5, 0.2, 0.7"}, ["'Holes'", "rectangle", "second corner"]),
        ("hole smaller than a cell", {"Domain/Holes": "circle: 0.5, 0.5, 0.01"}, ["'Holes'", "no centre of a cell", "'Cells'"]),
        ("holes in a mesh file", mesh_scene(folder, "m12.msh", whole, {"Domain/Holes": "circle: 0.5, 0.5, 0.2"}.items()), ["'Holes'", "mesh file"]),
        ("two centres of a hole", {"Domain/Shape": "plate with hole", "Domain/Hole center": "0.3,0.3 ; 0.7,0.7"}, ["'Hole center'", "'Holes'"]),
        ("disc without a normal", {**BLOCK, "Cracks/Polygons": "disc: 0.5,0.5,0.5, 0,0,0, 0.2"}, ["'Polygons'", "disc", "normal"]),
        ("disc without a radius", {**BLOCK, "Cracks/Polygons": "disc: 0.5,0.5,0.5, 0,0,1"}, ["'Polygons'", "disc", "7 numbers"]),
        ("3D side in 2D", {"Boundary conditions/Flux": "front: 3"}, ["'Flux'", "'front'", "left, right, bottom, top"]),
        # cracks and points
        ("tips in part of a crack that grows", {**ELASTIC, **CRACK, **IN_PART, "Cracks/Growth": "2: 0, 0.1,0"}, ["'Bonds through tips'", "'in part'", "lie still"]),
        ("tips in part on faces", {**ELASTIC, **CRACK, **IN_PART, "Cracks/Mesh": "faces"}, ["'Bonds through tips'", "'in part'", "'Mesh = faces'"]),
        ("tips in part where bonds break", {**ELASTIC, **CRACK, **IN_PART, "Models": "peridynamics", "Material/Fracture energy": "1"},
         ["'Bonds through tips'", "'in part'", "'Fracture energy'"]),
        ("tips in part in diffusion", {**CRACK, **IN_PART}, ["'Bonds through tips'", "'in part'", "'Physics = elasticity'"]),
        ("crack outside", {"Cracks/Segments": "2,2 ; 3,3"}, ["'Segments'", "outside the body"]),
        ("crack of one point", {"Cracks/Segments": "0.2,0.2"}, ["'Segments'", "two points"]),
        ("crack of no length", {"Cracks/Segments": "0.2,0.2 ; 0.2,0.2"}, ["'Segments'", "no length"]),
        ("end that is not there", {**CRACK, "Cracks/Growth": "3: 0, 1,0"}, ["'Growth'", "no end point 3", "1 to 2"]),
        ("tip that leaves the body", {**CRACK, "Cracks/Growth": "2: 0, 1000,0"}, ["'Growth'", "left the body"]),
        ("tip that outruns the mesh", {**CRACK, "Cracks/Growth": "2: 0, 1,0, 0.01", "Time/Stepper": "bdf2", "Time/Time step": "0.5",
                                       "Domain/Cells": "200, 200", "Time/End time": "1", "Cracks/Growth step": "1e-3"},
         ["'Growth'", "advances by", "'Time step'"]),
        ("path that begins elsewhere", {**CRACK, "Cracks/Paths": "2: 0, 0.5,0.5 | 1, 0.9,0.5"}, ["'Paths'", "begins at (0.5, 0.5)"]),
        ("growing crack on faces", {**CRACK, "Cracks/Growth": "2: 0, 0.1,0", "Cracks/Mesh": "faces"}, ["'Mesh'", "'pairs'"]),
        ("transmission that leaves 0 to 1", {**CRACK, "Cracks/Transmission": "10000*t"}, ["'Transmission'", "from 0 to 1"]),
        ("family without energy", {"Cracks/Segments": "-1,0.49 ; 2,0.49 ; -1,0.51 ; 2,0.51", "Domain/Cells": "10, 10",
                                   "Models": "peridynamics", "Peridynamics/Surface correction": "energy"},
         ["'Surface correction = energy'", "no bond left", "in y"]),
        ("harmonic rule with T", {"Material/Conductivity": "1 + T", "Material/Interface rule": "harmonic"}, ["'Interface rule'", "arithmetic"]),
        ("diffusivity of heat", {"Material/Diffusivity": "2"}, ["'Diffusivity'", "moisture", "'Conductivity'"]),
        ("diffusivity and conductivity", {"Physics": "moisture", "Material/Diffusivity": "2", "Material/Conductivity": "2"}, ["'Conductivity'", "beside 'Diffusivity'"]),
        ("material id of no mesh", {"Material/Phases/Regions": "a: mesh(1)", "Material/Phases/Conductivity": "a: 2"},
         ["'Regions'", "mesh file"]),
        ("3D points in 2D", {"Output/Probes": "0.5,0.5,0.5"}, ["'Probes'", "needs 2 coordinates, found 3"]),
        ("probe outside", {"Output/Probes": "0.5,0.5 ; 0.5,1.5"}, ["'Probes'", "(0.5, 1.5)", "outside"]),
        ("line of one point", {"Output/Line": "0,0 ; 1,1 ; 1"}, ["'Line'", "2 or more"]),
        # time
        ("steady without a level", {**STEADY, "Boundary conditions/Dirichlet": ""}, ["'Steady'", "not determined"]),
        ("steady with t", {**STEADY, "Boundary conditions/Dirichlet": "top: t; bottom: 0"}, ["'Dirichlet'", "depends on t"]),
        ("unknown exact solution", {"Reference/Solution": "bobaru 2013 table 1"}, ["'Solution'", "'Reference'"]),
        # combinations
        ("degree 2 with pairs", {**CRACK, "Finite elements/Degree": "2"}, ["'Degree'", "pairs"]),
        ("mirror on a mesh file", mesh_scene(folder, "m0.msh", whole, {"Peridynamics/Boundary treatment": "fictitious mirror"}.items()),
         ["'Boundary treatment'", "sides of a box"]),
    ]
    late = [
        ("part that is empty", {PARTS: "a: top if x > 3", **HOT}, ["'Parts'", "part 'a'", "nowhere on the side 'top'"]),
        ("region without a node", {PARTS: "a: region (x - 0.54)^2 + (y - 0.54)^2 < 1e-4", **HOT}, ["'Parts'", "part 'a'", "no node", "'point X, Y'"]),
        ("part between nodes", {PARTS: "a: left if abs(y - 0.54) < 0.02", **HOT}, ["'Dirichlet'", "'a'", "holds no node", "'point X, Y'"]),
        ("elastic part between nodes", {**ELASTIC, "Boundary conditions/Dirichlet": "", PARTS: "a: right if abs(y - 0.54) < 0.02",
                                        "Boundary conditions/Displacement": "left: 0, 0 ; a: 1, 0"}, ["'Displacement'", "'a'", "holds no node"]),
        ("part behind its side", {PARTS: "a: top if x > 0.5", DIRICHLET: "top: 0 ; bottom: 0 ; a: 1"}, ["'Dirichlet'", "'a'", "named before", "Name the part first"]),
        ("formula of a part that is no number", {PARTS: "a: top if sqrt(x - 0.5)", **HOT}, ["'Parts'", "part 'a'", "is not finite"]),
        ("parts with two values", {PARTS: "a: left if y < 0.6 ; b: left if y > 0.4", DIRICHLET: "bottom: 0 ; a: 1 ; b: 2"},
         ["'Dirichlet'", "'b' overlaps 'a'", "different values"]),
        ("regions with two values", {PARTS: "a: region x < 0.6 ; b: region x > 0.4", DIRICHLET: "bottom: 0 ; a: 1 ; b: 2"}, ["'b' overlaps 'a'", "different values"]),
        ("parts with two fluxes", {PARTS: "a: left if y < 0.6 ; b: left if y > 0.4", "Boundary conditions/Flux": "a: 1 ; b: 2"},
         ["'Flux'", "'b' overlaps 'a'", "not added"]),
        ("value on a part of a side with a flux", {PARTS: "a: left if y < 0.6", DIRICHLET: "bottom: 0 ; a: 1", "Boundary conditions/Flux": "left: 1"},
         ["'Flux'", "'left' overlaps 'a'", "takes no load"]),
        ("traction on a held part", {**ELASTIC, "Boundary conditions/Dirichlet": "", PARTS: "a: left if y < 0.6", "Boundary conditions/Traction": "a: 0, 1"},
         ["'Traction'", "'a' overlaps 'left'", "takes no load"]),
        ("overlapping phases", {"Material/Phases/Regions": "a: x > 0.4 ; b: y > 0.7", "Material/Phases/Conductivity": "a: 2 ; b: 3"},
         ["'Regions'", "'a'", "'b'", "overlap at"]),
        ("not a directory", {"Output directory": file_of_directory + "/results"}, ["'Output directory'", "a_file"]),
        ("negative conductivity at a node", {"Material/Conductivity": "x - 0.5"}, ["'Conductivity'", "must be positive", "(0"]),
        ("negative conductivity in one corner", {"Material/Conductivity": "1.9 - x - y"}, ["'Conductivity'", "must be positive", "(0.9"]),
        ("infinite conductivity in another corner", {"Material/Conductivity": "2 + 1/(x + y)"}, ["'Conductivity'", "is not finite", "(0, 0)"]),
        ("infinite conductivity at a node", {"Material/Conductivity": "1/x"}, ["'Conductivity'", "is not finite", "(0"]),
        ("negative density at a node", {"Material/Density": "0.5 - y"}, ["'Density'", "must be positive"]),
        ("negative coefficient at a node", {"Boundary conditions/Convection": "left: 0.5 - y, 20"},
         ["'Convection'", "left", "negative"]),
        ("isolated node, bonds alone", {**STEADY, "Peridynamics/Boundary treatment": "none", "Domain/Cells": "4, 4",
                                        "Peridynamics/Horizon ratio": "1", "Models": "peridynamics",
                                        "Cracks/Segments": "0.4,0.4 ; 0.6,0.4 ; 0.6,0.4 ; 0.6,0.6 ; 0.6,0.6 ; 0.4,0.6 ; 0.4,0.6 ; 0.4,0.4"},
         ["(0.5", "0.5)", "'Cracks'", "isolated"]),
        ("isolated node", {**STEADY, "Domain/Cells": "4, 4", "Peridynamics/Horizon ratio": "1", "Models": "peridynamics",
                           "Cracks/Segments": "0.4,0.4 ; 0.6,0.4 ; 0.6,0.4 ; 0.6,0.6 ; 0.6,0.6 ; 0.4,0.6 ; 0.4,0.6 ; 0.4,0.4"},
         ["(0.5", "0.5)", "'Cracks'", "isolated"]),
        ("node without elements", {**STEADY, "Models": "finite elements", "Cracks/Mesh": "removed",
                                   "Domain/Cells": "6, 6", "Cracks/Segments": "0.3,0.3 ; 0.7,0.7 ; 0.3,0.7 ; 0.7,0.3"},
         ["'Mesh' in section 'Cracks'", "'pairs'"]),
        ("island", {**STEADY, "Models": "peridynamics", "Peridynamics/Horizon ratio": "2",
                    "Cracks/Segments": "0.3,0.3 ; 0.7,0.3 ; 0.7,0.3 ; 0.7,0.7 ; 0.7,0.7 ; 0.3,0.7 ; 0.3,0.7 ; 0.3,0.3",
                    "Initial and source/Source": "1"}, ["not determined", "'Cracks'", "'Transmission'", "(0.3"]),
        ("half a body cut off, finite elements", {**STEADY, "Models": "finite elements", "Cracks/Segments": "0,0.52 ; 1,0.52",
                                                  "Boundary conditions/Dirichlet": "bottom: 0"},
         ["not determined", "'Cracks'", "'Dirichlet'"]),
        ("horizon on a mesh for transmission", mesh_scene(folder, "m9.msh", whole, {
            "Models": "finite elements", "Peridynamics/Horizon": "", "Cracks/Segments": "0.3,0.5 ; 0.7,0.5", "Cracks/Transmission": "0.5"}.items()),
         ["'Horizon'", "'Transmission'", "'Contact conductance'"]),
        ("named solution on a mesh", mesh_scene(folder, "m10.msh", whole, {"Reference/Solution": "classical harmonic(1,1)"}.items()),
         ["'Solution'", "box", "expression"]),
        ("named solution, varying material", {"Material/Conductivity": "1 + x", "Reference/Solution": "classical harmonic(1,1)"},
         ["'Solution'", "uniform material"]),
        ("crack between a flux side and the body", {"Boundary conditions/Flux": "right: 1", "Cracks/Segments": "0.97,-1 ; 0.97,2",
                                                    "Peridynamics/Flux treatment": "extrapolation"},
         ["'Flux treatment", "'right'", "'Cracks'", "'natural'"]),
        ("probe in the hole, cell centres", {"Domain/Shape": "plate with hole", "Domain/Nodes": "cell centers"}, ["'Probes'", "(0.5, 0.5)"]),
        ("crack not on faces", {"Cracks/Mesh": "faces", "Cracks/Segments": "0.25,0.51 ; 0.75,0.51"},
         ["'Mesh = faces'", "'Cracks'", "'Mesh = pairs'"]),
        ("hole that leaves nothing", {"Domain/Shape": "plate with hole", "Domain/Hole radius": "3", "Output/Probes": ""}, ["'Hole radius'"]),
        ("probe in the hole", {"Domain/Shape": "plate with hole"}, ["'Probes'", "(0.5, 0.5)"]),
        ("line in the hole", {"Domain/Shape": "plate with hole", "Output/Probes": "", "Output/Line": "0.4,0.5 ; 0.6,0.5 ; 9"},
         ["'Line'", "none of its points"]),
        ("point far outside", {PARTS: "a: point 3, 0.5", **HOT}, ["'Parts'", "part 'a'", "(3, 0.5)", "outside the body", "2 from"]),
        ("point in a hole", {"Domain/Shape": "plate with hole", "Output/Probes": "", PARTS: "a: point 0.5, 0.5", **HOT}, ["'Parts'", "'a'", "outside the body", "'hole'"]),
        ("probe outside a mesh", mesh_scene(folder, "m1.msh", whole, {"Output/Probes": "3, 3"}.items()), ["'Probes'", "(3, 3)"]),
        ("missing mesh", {"Domain/Shape": "mesh file", "Domain/Mesh file": folder + "/none.msh",
                          "Peridynamics/Horizon": "0.8", "Boundary conditions/Dirichlet": "3: 0"},
         ["'Mesh file'", "none.msh", "cannot be read"]),
        ("missing mesh and a named side", {"Domain/Shape": "mesh file", "Domain/Mesh file": folder + "/none.msh", "Peridynamics/Horizon": "0.8",
                                           "Boundary conditions/Dirichlet": "bore: 0"}, ["'Mesh file'", "none.msh", "cannot be read", "Looked for it at"]),
        ("symmetry of heat on a mesh", mesh_scene(folder, "m13.msh", whole, {"Boundary conditions/Dirichlet": "4: 1", "Boundary conditions/Symmetry": "3"}.items()),
         ["'Symmetry'", "mesh file", "Leave the entry out", "insulated"]),
        ("broken mesh", mesh_scene(folder, "m2.msh", whole[:200]), ["'Mesh file'", "m2.msh", "broken"]),
        ("not a mesh", mesh_scene(folder, "m3.msh", "This is not a mesh.\n"), ["'Mesh file'", "m3.msh", "broken"]),
        ("empty mesh file", mesh_scene(folder, "m4.msh", ""), ["'Mesh file'", "m4.msh"]),
        ("mesh of triangles", mesh_scene(folder, "m5.msh", triangles), ["'Mesh file'", "quadrilaterals"]),
        ("2D mesh in 3D", {**mesh_scene(folder, "m6.msh", whole), "Dimension": "3", "Output/Probes": "",
                           "Domain/Lower corner": "0, 0, 0", "Domain/Upper corner": "1, 1, 1", "Domain/Cells": "4, 4, 4"},
         ["'Mesh file'", "m6.msh", "dimension 3"]),
        ("unknown side of a mesh", mesh_scene(folder, "m7.msh", whole, {"Boundary conditions/Dirichlet": "3: 0; 9: 1"}.items()),
         ["'9'", "'Dirichlet'", "boundary ids", "3, 4"]),
        ("elastic load on an unknown side of a mesh",
         {**ELASTIC, **mesh_scene(folder, "m9.msh", whole), "Boundary conditions/Dirichlet": "", "Boundary conditions/Displacement": "3: 0, 0",
          "Boundary conditions/Traction": "99: 1, 0"}, ["'99'", "'Traction'", "boundary ids", "3, 4"]),
        ("elastic support on an unknown side of a mesh",
         {**ELASTIC, **mesh_scene(folder, "m10.msh", whole), "Boundary conditions/Dirichlet": "", "Boundary conditions/Displacement": "3: 0, 0; 9: 0, 0"},
         ["'9'", "'Displacement'", "boundary ids", "3, 4"]),
        ("elastic symmetry on an unknown side of a mesh",
         {**ELASTIC, **mesh_scene(folder, "m11.msh", whole), "Boundary conditions/Dirichlet": "", "Boundary conditions/Displacement": "3: 0, 0",
          "Boundary conditions/Symmetry": "8"}, ["'8'", "'Symmetry'", "boundary ids", "3, 4"]),
        ("horizon too short for a mesh", mesh_scene(folder, "m8.msh", whole, {"Peridynamics/Horizon": "0.2"}.items()),
         ["'Horizon'", "no neighbour"]),
        ("unstable euler step", {"Time/Stepper": "euler", "Time/Time step": "0.01"}, ["'Time step'", "Lanczos", "Gershgorin"]),
        ("chebyshev with moving values", {"Time/Stepper": "chebyshev", "Boundary conditions/Dirichlet": "top: t; bottom: 0"},
         ["'Stepper", "chebyshev", "rkc2"]),
        ("euler with consistent capacity", {"Time/Stepper": "euler", "Finite elements/Capacity": "consistent"},
         ["'Stepper", "'Capacity", "lumped"]),
        ("mirror with doubled nodes", {**CRACK, "Cracks/Mesh": "faces", "Peridynamics/Boundary treatment": "fictitious mirror"},
         ["'Boundary treatment'", "pairs"]),
        ("solver that may not iterate", {**STEADY, "Solver/Maximum iterations": "2"}, ["'Maximum iterations'", "'Solver'"]),
        ("values become nan", {"Initial and source/Source": "sqrt(0.004 - t)", "Time/Stepper": "rkc2"},
         ["is not finite", "'Source'"]),
        ("traction beyond all numbers", {**ELASTIC, "Boundary conditions/Traction": "right: 1e300, 0"}, ["not finite", "Boundary conditions"]),
        ("motion beyond all numbers", {**MOTION, "Boundary conditions/Traction": "right: 1e300, 0"}, ["not finite"]),
        ("flux beyond all numbers", {**STEADY, "Boundary conditions/Flux": "right: 1e308; left: 1e308"}, ["finite"]),
        ("boundary value becomes nan", {"Boundary conditions/Dirichlet": "top: sqrt(0.004 - t); bottom: 0"},
         ["is not finite", "'Dirichlet'"]),
        ("scene file in the way", {"Output directory": folder}, ["'Output directory'", "scene file", "Choose another directory"]),
        ("closed crack around a node in 3D",
         {**STEADY, "Dimension": "3", "Models": "peridynamics", "Output/Probes": "", "Peridynamics/Horizon ratio": "1.4",
          "Domain/Lower corner": "0, 0, 0", "Domain/Upper corner": "1, 1, 1", "Domain/Cells": "4, 4, 4",
          "Cracks/Polygons": " | ".join(box_faces(0.4, 0.6))}, ["isolated", "'Cracks'"]),
        ("too few cells", {"Domain/Cells": "1, 1", "Output/Probes": "", "Peridynamics/Horizon ratio": "1"}, ["'Cells'", "fewer processes"]),
        ("endless run", {"Time/End time": "1e30"}, ["'End time'", "'Steady = true'"]),
        ("tolerance below round-off", {"Time/Tolerance": "1e-13", "Time/Stepper": "rkc2"}, ["'Tolerance'", "'Time'", "round-off"]),
        ("mirror wider than the body", {"Domain/Cells": "12, 48", "Domain/Upper corner": "1, 4", "Peridynamics/Horizon": "1.5",
                                        "Peridynamics/Boundary treatment": "fictitious mirror", "Boundary conditions/Dirichlet": "left: 1"},
         ["'Boundary treatment'", "'Horizon'"]),
        ("side cut away by the hole", {"Domain/Shape": "plate with hole", "Domain/Hole center": "0, 0.5", "Domain/Hole radius": "0.6",
                                       "Output/Probes": "", "Boundary conditions/Dirichlet": "left: 1; bottom: 0"},
         ["'Dirichlet'", "'left'", "hole"]),
        ("steady overflow", {**STEADY, "Boundary conditions/Dirichlet": "top: 1e308; bottom: -1e308"}, ["finite"]),
    ]
    texts = [
        ("misspelt keyword", SCENE + "sett Title = x\n", ["'sett", "Did you mean 'set'?"]),
        ("missing end", SCENE + "subsection Solver\n", ["'Solver'", "no 'end'"]),
        ("end too much", SCENE + "end\n", ["'end' without a subsection"]),
        ("entry twice", SCENE.replace("set Title ", "set Dimension = 3\nset Title "), ["'Dimension'", "twice"]),
        ("entry outside its section", SCENE + "set Horizon = 0.3\n", ["Horizon", "Peridynamics"]),
        ("no value", SCENE + "set Models\n", ["set entry = value"]),
    ]
    return changed, late, texts


COMMANDS = [
    ("no command", [], ["run", "check", "parameters", "--help"]),
    ("unknown command", ["runn", "SCENE"], ["'runn'", "Did you mean 'run'?"]),
    ("no scene", ["run"], ["scene"]),
    ("missing scene", ["run", "no_such_scene.prm"], ["'no_such_scene.prm'"]),
    ("a directory as scene", ["run", "/"], ["'/'"]),
    ("option with a typo", ["run", "SCENE", "--quite"], ["--quite", "Did you mean '--quiet'?"]),
    ("override of an unknown entry", ["run", "SCENE", "-s", "Domain/Cels=3, 3"], ["command line", "'Cels'", "Did you mean 'Cells'?"]),
    ("override of an unknown section", ["run", "SCENE", "-s", "Domian/Cells=3, 3"], ["command line", "Did you mean 'Domain'?"]),
    ("override without a value", ["run", "SCENE", "-s", "Domain/Cells"], ["'Domain/Cells'", "Section/Entry=value"]),
    ("override with a bad value", ["check", "SCENE", "-s", "Domain/Cells=a, b"], ["command line", "'Cells'", "'a'"]),
    ("unknown format", ["parameters", "yaml"], ["'yaml'", "prm, markdown, JSON, XML"]),
    ("two scenes", ["run", "SCENE", "SCENE"], ["argument"]),
]

TRACES = ("Stacktrace", "An error occurred in line", "terminate called", "Segmentation fault", "Signal:", "Process received signal",
          "Additional information", "MPI_ABORT", "internal error", "exception", "Assert")


def judge(name, status, stdout, stderr, words, results, ranks):
    """Count the checks of one mistake; returns the row of the table."""
    at = f"{name}, {ranks} process(es)"
    check(status == 1, f"{at}: exit status {status}\n{stdout[-600:]}{stderr[-1500:]}")
    for trace in TRACES:
        check(trace not in stdout + stderr, f"{at}: '{trace}' in the output\n{stderr[-1500:]}")
    message = stderr.strip()
    n_messages = len(re.findall(r"^perideal: error: ", stderr, re.M))
    check(n_messages == 1 and message.startswith("perideal: error: "), f"{at}: {n_messages} messages\n{stderr[-1500:]}")
    for word in words:
        check(word in message, f"{at}: the message does not say {word!r}:\n  {message[-1500:]}")
    check(len(message) < 700, f"{at}: a message of {len(message)} characters")
    summary = os.path.join(results, "summary.json") if results else ""
    if os.path.exists(summary):
        with open(summary) as file:
            status = json.load(file)["status"]
        check(status == "diverged", f"{at}: a summary was left behind, of a run that is {status}")
    return (name, ranks, message.replace("perideal: error: ", "")[:150])


def main():
    folder = temporary_folder()
    scene = write_file("scene.prm", SCENE, folder)
    changed, late, texts = scene_mistakes(folder)
    only = sys.argv[1] if len(sys.argv) > 1 else ""
    rows = []

    def attempt(name, arguments, words, ranks):
        if only and only not in name:
            return
        status, stdout, stderr = run_perideal(arguments, ranks, timeout=120)
        rows.append(judge(name, status, stdout, stderr, words, None, ranks))

    def attempt_scene(name, scene, overrides, words, ranks, alone):
        if only and only not in name:
            return
        run = run_scene(scene, overrides, ranks, expect_error=True, timeout=120, alone=alone)
        rows.append(judge(name, run.returncode, run.stdout, run.stderr, words, run.folder, ranks))

    # Every 32nd by the program itself, on one process or on two; the others by a process that
    # goes on to the next mistake, which must not be the worse for the one before.
    for number, (name, overrides, words) in enumerate(changed + late):
        if "Domain/Node spacing" in overrides:
            overrides = {entry: value for entry, value in overrides.items() if entry != "Domain/Cells"}
            scene_here = write_file("no_cells.prm", SCENE.replace("set Cells        = 12, 12", ""), folder)
        else:
            scene_here = scene
        for ranks in (2,) if name == "too few cells" else (1, 2):
            attempt_scene(name, scene_here, overrides, words, ranks, (number + 16 * ranks) % 32 == 0)
    for name, text, words in texts:
        attempt(name, ["run", write_file("text.prm", text, folder)], words, 1)  # messages that begin with the file's name and line
    for number, (name, arguments, words) in enumerate(COMMANDS):
        arguments = [scene if word == "SCENE" else word for word in arguments]
        for ranks in (1, 2) if number % 3 == 0 else (1,):
            attempt(name, arguments, words, ranks)
    print_table("Mistakes and what is said about them", ("mistake", "ranks", "message (first 150 characters)"), rows)
    finish()


if __name__ == "__main__":
    main()
