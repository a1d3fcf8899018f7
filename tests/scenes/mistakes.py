# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Mistakes in scenes and on the command line: each ends with exit status 1 and one message that names the entry and the remedy.

A mistake is a change of the small plate below (overrides), or lines put into it, or a command line. The words are what the
message has to say. What entries make wrong by themselves or beside others is in tests/unit/scene_mistakes_test.cc, without a run for each:
here are some of them, those of files, and 'late' ones, which are found while the mesh or the operators are built. On two processes the message must come
once and the program must not hang.

    mistakes.py [part of the names of those wanted]
"""

import json
import os
import re
import sys

from scene_test import check, check_message, check_no_traces, finish, print_table, run_perideal, run_scene, temporary_folder, write_file
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
ELASTIC = {"Physics": "elasticity", "Material/Young modulus": "200", "Material/Poisson ratio": "0.3", "Boundary conditions/Dirichlet": "",
           "Boundary conditions/Displacement": "left: 0, 0"}
PARTS, DIRICHLET = "Boundary conditions/Parts", "Boundary conditions/Dirichlet"
HOT = {DIRICHLET: "bottom: 0; a: 1"}
CUT_OFF = {**ELASTIC, "Boundary conditions/Displacement": "bottom: 0, 0", "Boundary conditions/Traction": "right: if(y > 0.6, 1, 0), 0",
           "Cracks/Segments": "-1, 0.52 ; 2, 0.52"}
MOTION = {**ELASTIC, "Elasticity/Solver": "dynamics"}
BRITTLE = {**ELASTIC, "Models": "peridynamics", "Material/Fracture energy": "1"}


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
    pyramid = SQUARE_MESH.format(names="", n=5, cells="5 7 2 7 7 1 2 3 4 5")
    file_of_directory = write_file("a_file", "text", folder)
    changed = [
        # names
        ("unknown entry", {"Material/Conductivty": "2"}, ["Conductivty", "'Material'", "Did you mean 'Conductivity'?"]),
        ("unknown section", {"Materials/Conductivity": "2"}, ["'Materials'", "Did you mean 'Material'?"]),
        ("entry in another section", {"Domain/Horizon": "0.3"}, ["Horizon", "Peridynamics"]),
        ("unknown choice", {"Peridynamics/Kernel": "conicle"}, ["'Kernel'", "Peridynamics", "Did you mean 'conical'?"]),
        ("unknown model", {"Models": "peridynamic"}, ["'Models'", "Did you mean 'peridynamics'?"]),
        ("unknown stepper", {"Time/Stepper": "rk5"}, ["'Stepper'", "'Time'", "Did you mean 'rk4'?"]),
        ("image that is not there", {"Domain/Shape": "image", "Domain/Cells": "20, 20", "Domain/Image": "no_such.png"}, ["'Image'", "no_such.png", "Looked for it at"]),
        # types and ranges
        ("cells without a comma", {"Domain/Cells": "160 20"}, ["'Cells'", "2 numbers, found 1", "Commas separate them: 160, 20"]),
        ("negative conductivity", {"Material/Conductivity": "-1"}, ["'Conductivity'", "'Material'", "greater than 0"]),
        ("cells beyond number", {"Domain/Cells": "100000, 100000"}, ["'Cells'", "nodes"]),
        ("spacing that does not divide", {"Domain/Node spacing": "0.3", "Domain/Cells": "20, 20"},
         ["'Node spacing'", "0.333"]),
        ("dimension 4", {"Dimension": "4"}, ["'Dimension'", "1, 2 or 3"]),
        # elasticity
        ("scatter without a seed", {**BRITTLE, "Material/Weibull modulus": "10"}, ["'Strength seed' in section 'Material'", "is empty", "'Weibull modulus'"]),
        # expressions
        ("bad expression", {"Material/Conductivity": "1 + 2*(x"}, ["'Conductivity'", "column"]),
        ("nan as Dirichlet value", {"Boundary conditions/Dirichlet": "top: sqrt(-1); bottom: 0"},
         ["'Dirichlet'", "top", "is not finite"]),
        ("nan at some nodes of a side", {"Boundary conditions/Dirichlet": "top: sqrt(x - 0.5); bottom: 0"},
         ["'Dirichlet'", "top", "is not finite"]),
        # sides
        ("unknown side", {"Boundary conditions/Dirichlet": "topp: 1"}, ["'Dirichlet'", "'topp'", "Did you mean 'top'?"]),
        # parts
        ("part of an unknown side", {PARTS: "a: topp if x > 0.5", **HOT}, ["'Parts'", "'topp'", "Did you mean 'top'?"]),
        # holes
        ("holes in a mesh file", mesh_scene(folder, "m12.msh", whole, {"Domain/Holes": "circle: 0.5, 0.5, 0.2"}.items()), ["'Holes'", "mesh file"]),
        # cracks and points
        ("tip that outruns the mesh", {**CRACK, "Cracks/Growth": "2: 0, 1,0, 0.01", "Time/Stepper": "bdf2", "Time/Time step": "0.5",
                                       "Domain/Cells": "200, 200", "Time/End time": "1", "Cracks/Growth step": "1e-3"},
         ["'Growth'", "advances by", "'Time step'"]),
        ("probe outside", {"Output/Probes": "0.5,0.5 ; 0.5,1.5"}, ["'Probes'", "(0.5, 1.5)", "outside"]),
        # combinations
        ("mirror on a mesh file", mesh_scene(folder, "m0.msh", whole, {"Peridynamics/Boundary treatment": "fictitious mirror"}.items()),
         ["'Boundary treatment'", "sides of a box"]),
    ]
    late = [
        ("zone without a node", {"Models": "coupled", "Coupling/Zone": "x - 5"}, ["'Zone'", "no node"]),
        *[(f"part cut off, {model}", {**CUT_OFF, "Models": model}, ["holds a part", "it has no equilibrium", "one of them at (", "Cracks", "'Displacement'"])
          for model in ("finite elements", "peridynamics", "coupled")],
        ("part on a hinge", {**CUT_OFF, "Boundary conditions/Parts": "pin: point 0, 1", "Boundary conditions/Displacement": "bottom: 0, 0; pin: 0, 0"},
         ["holds a part", "it has no equilibrium"]),
        ("step of verlet above the limit", {**MOTION, "Time/Time step": "0.1", "Time/End time": "1"}, ["'Time step'", "is 0.1,", "stable up to", "newmark"]),
        ("too few iterations", {**ELASTIC, "Boundary conditions/Traction": "right: 1, 0", "Elasticity/Solver": "dynamic relaxation",
                                "Solver/Maximum iterations": "20"}, ["'Solver = dynamic relaxation'", "20 iterations", "'Maximum iterations'"]),
        ("nan as initial value", {"Initial and source/Initial value": "log(x - 0.5)"},
         ["'Initial value'", "is not finite"]),
        ("nan as source", {"Initial and source/Source": "1/(x - x)"}, ["'Source'", "is not finite"]),
        ("family without energy", {"Cracks/Segments": "-1,0.49 ; 2,0.49 ; -1,0.51 ; 2,0.51", "Domain/Cells": "10, 10",
                                   "Models": "peridynamics", "Peridynamics/Surface correction": "energy"},
         ["'Surface correction = energy'", "no bond left", "in y"]),
        ("unknown exact solution", {"Reference/Solution": "bobaru 2013 table 1"}, ["'Solution'", "'Reference'"]),
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
        ("mesh of pyramids", mesh_scene(folder, "m5.msh", pyramid), ["'Mesh file'", "pyramid", "dimension 2"]),
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

def judge(name, status, stdout, stderr, words, results, ranks):
    """Count the checks of one mistake; returns the row of the table."""
    at = f"{name}, {ranks} process(es)"
    check(status == 1, f"{at}: exit status {status}\n{stdout[-600:]}{stderr[-1500:]}")
    check_no_traces(stdout + stderr, at, "Process received signal", "internal error", "exception", "Assert")
    message = stderr.strip()
    n_messages = len(re.findall(r"^perideal: error: ", stderr, re.M))
    check(n_messages == 1 and message.startswith("perideal: error: "), f"{at}: {n_messages} messages\n{stderr[-1500:]}")
    check_message(message, *words, what=at)
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

    # Every 16th by the program itself, on one process or on two; the others by a process that
    # goes on to the next mistake, which must not be the worse for the one before.
    for number, (name, overrides, words) in enumerate(changed + late):
        if "Domain/Node spacing" in overrides:
            overrides = {entry: value for entry, value in overrides.items() if entry != "Domain/Cells"}
            scene_here = write_file("no_cells.prm", SCENE.replace("set Cells        = 12, 12", ""), folder)
        else:
            scene_here = scene
        for ranks in (2,) if name == "too few cells" else (1, 2):
            attempt_scene(name, scene_here, overrides, words, ranks, (number + 8 * ranks) % 16 == 0)
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
