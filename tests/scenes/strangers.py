# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Scenes as somebody else would write them, by defaults: right without a word, or with the right one.

    strangers.py voids      bonds across slits of lattices, meshes and images
    strangers.py contact    a contact conductance between two materials
    strangers.py refusals   what was refused, or never started, and is sound
    strangers.py latent     a latent heat as a narrow jump of the capacity
    strangers.py meshes     files as others write them
    strangers.py interfaces named lines and surfaces between two materials
    strangers.py names      what files give names to, and what is not there
    strangers.py touching   pieces of a mesh that share no nodes
"""

import math
import struct

import numpy as np

from scene_test import BC, COUPLED, FE, PD, Comparison, check, check_close, check_message, run_parts, run_scene, scene_text, write_file
from scene_texts import BOX, grid_mesh, mesh_text


SLIT = scene_text("""
Dimension = 2
Physics = elasticity
Domain/Cells = 41, 41
Domain/Holes = rectangle: 0, 0.49, 0.5, 0.51
Material/Young modulus = 1
Material/Poisson ratio = 0.3
Boundary conditions/Displacement = bottom: free, 0 ; top: free, 1e-3 ; right: 0, free
Output/Fields = none
Output/Probes = 0.01, 0.4878 ; 0.01, 0.5122
""")

HEAT = scene_text("""
Dimension = 2
Domain/Cells = 41, 41
Domain/Holes = rectangle: 0, 0.49, 0.5, 0.51
Boundary conditions/Dirichlet = bottom: 0 ; top: 1
Time/Steady = true
Output/Fields = none
""")


NAMES = ((1, 1, "left"), (1, 2, "right"), (1, 3, "bottom"), (1, 4, "top"))


def force(run, model):
    return run.total("force on top in y", model)


def voids():
    table = Comparison("Bonds across a slit")
    run = run_scene(SLIT, {"Models": f"{FE}, {PD}, {COUPLED}", "Coupling/Zone": "everywhere"})
    for model in (FE, PD, COUPLED):
        table.add(f"{model}: force on half a plate with a slit one cell wide", force(run, model), 5.93e-4, relative=0.02)
        opening = run.probe(model, (0.01, 0.5122), column="uy") - run.probe(model, (0.01, 0.4878), column="uy")
        table.add(f"{model}: opening of the slit", opening, 1.109e-3, relative=0.05)
    run = run_scene(SLIT, {"Models": PD, "Peridynamics/Bonds across voids": "keep"})
    check(force(run, PD) > 9e-4, f"'keep' keeps what it kept: {force(run, PD)}")
    run = run_scene(SLIT, {"Models": f"{FE}, {PD}", "Domain/Nodes": "cell centers", "Output/Probes": ""}, ranks=2)
    table.add("nodes at cell centers: force", force(run, PD), force(run, FE), relative=0.12)

    # Where bonds alone conduct: the same slit across most of a plate, and right through it.
    for treatment in ("none", "auto"):
        run = run_scene(HEAT, {"Models": f"{FE}, {PD}", "Peridynamics/Boundary treatment": treatment})
        flow = {model: run.model(model)["boundary flux"]["top"] for model in (FE, PD)}
        table.add(f"heat past a slit, treatment {treatment}: over finite elements", flow[PD] / flow[FE], 1, absolute=0.12 if treatment == "none" else 0.02)

    # A mesh from a file.
    side = [0.5 * k / 20 for k in range(21)]
    ys = [0.49 * k / 20 for k in range(21)] + [0.51 + 0.49 * k / 20 for k in range(21)]
    xs = side + [0.5 + 0.5 * k / 20 for k in range(1, 21)]
    path = grid_mesh((40, 41), lambda i, j: (xs[i], ys[j]), group=lambda i, j: None if i < 20 == j else 9, names=NAMES)
    on_mesh = {"Domain/Shape": "mesh file", "Domain/Mesh file": path, "Material/Young modulus": "1000", "Material/Poisson ratio": "0.25",
               "Peridynamics/Horizon": "0.1", BC + "Displacement": "bottom: 0, 0 ; top: 0, 1e-3", "Output/Probes": "", "Models": f"{FE}, {PD}"}
    lattice = "  set Cells = 41, 41\n  set Holes = rectangle: 0, 0.49, 0.5, 0.51\n"
    run = run_scene(SLIT.replace(lattice, ""), on_mesh)
    table.add("a slot in a mesh: force over finite elements", force(run, PD) / force(run, FE), 1, absolute=0.04)
    two = run_scene(SLIT.replace(lattice, ""), {**on_mesh, "Models": PD}, ranks=2)
    check_close(force(two, PD), force(run, PD), relative=1e-9, what="a slot in a mesh on 2 processes")
    heat = {key: value for key, value in on_mesh.items() if not key.startswith(("Material", BC))}
    run = run_scene(HEAT.replace(lattice, ""), {**heat, "Peridynamics/Boundary treatment": "none"})
    flow = {model: run.model(model)["boundary flux"]["top"] for model in (FE, PD)}
    table.add("heat in it: over finite elements", flow[PD] / flow[FE], 1, absolute=0.2)
    table.show()


WALL = scene_text("""
Dimension = 2
Models = finite elements, peridynamics, coupled
Domain/Cells = 41, 10
Domain/Upper corner = 1, 0.25
Material/Conductivity = 1
Material/Phases/Regions = left half: 0.5 - x
Material/Phases/Conductivity = left half: 5
Boundary conditions/Dirichlet = left: 0 ; right: 1
Cracks/Segments = 0.5,-1 ; 0.5,2
Cracks/Contact conductance = 2
Time/Steady = true
Output/Fields = none
""")


def contact():
    """In series: 0.5/5 + 1/2 + 0.5/1 = 1.1, or x/5 + 1/2 + (1 - x)/1 beside faces of cells; oblique: piecewise linear."""
    table = Comparison("Contact conductance between two materials")
    cases = {"41 cells": {}, "phases exchanged": {"Material/Conductivity": "5", "Material/Phases/Conductivity": "left half: 1"},
             "40 cells": {"Domain/Cells": "40, 10"}, "40 cells, nodes on the crack": {"Domain/Cells": "40, 10", "Cracks/Nodes on cracks": "left"},
             "the same, exchanged": {"Domain/Cells": "40, 10", "Cracks/Nodes on cracks": "left", "Material/Conductivity": "5", "Material/Phases/Conductivity": "left half: 1"},
             "m = 4": {"Peridynamics/Horizon ratio": "4"},
             "3D": {"Dimension": "3", "Domain/Cells": "21, 4, 4", "Domain/Upper corner": "1, 0.2, 0.2", "Cracks/Segments": "",
                    "Cracks/Polygons": "0.5,-1,-1 ; 0.5,2,-1 ; 0.5,2,2 ; 0.5,-1,2"}}
    for name, overrides in cases.items():
        run = run_scene(WALL, overrides)
        area = 0.04 if name == "3D" else 0.25
        for model in run.summary["models"]:
            table.add(f"{name}, {model}", abs(run.model(model)["boundary flux"]["right"]) / area, 1 / 1.1, relative=1e-6)
    for cells, pairs in ((0.1, ((5, 1), (1, 5), (1.3, 1))), (0.99, ((5, 1), (1, 5)))):
        x = (20 + cells) / 41
        for left, right in pairs:
            run = run_scene(WALL, {"Material/Phases/Regions": f"left half: {x} - x", "Cracks/Segments": f"{x},-1 ; {x},2",
                                   "Material/Conductivity": right, "Material/Phases/Conductivity": f"left half: {left}"})
            check("materials meet" not in run.stdout, f"{cells} cells beside a face: a note on mixed cells where a crack parts the materials")
            for model in run.summary["models"]:
                table.add(f"{cells} cells beside a face, {left} and {right}, {model}", abs(run.model(model)["boundary flux"]["right"]) / 0.25,
                          1 / (x / left + 0.5 + (1 - x) / right), relative=1e-8)
    for name, normal, overrides in (("oblique", (0.8, 0.6), {"Cracks/Segments": "1.45625,-1 ; -0.79375,2"}),
                                    ("oblique in 3D", (2 / 3, 2 / 3, 1 / 3), {"Cracks/Polygons": "2,-1,-0.85 ; 2,2,-6.85 ; -1,2,-0.85 ; -1,-1,5.15", "Domain/Cells": "8, 8, 8"})):
        dim = len(normal)
        far = " + ".join(f"{n}*{x}" for n, x in zip(normal, "xyz")) + f" - {0.565 if dim == 2 else 0.3833333333333333}"
        exact = f"if({far} < 0, ({far})/5, 0.5 + {far})"
        sides = ("left", "right", "bottom", "top", "back", "front")[:2 * dim]
        run = run_scene(WALL, {"Dimension": dim, "Domain/Upper corner": ", ".join("1" * dim), "Domain/Cells": "20, 20", "Cracks/Segments": "",
                               "Material/Phases/Regions": f"left half: -({far})", "Reference/Solution": exact,
                               BC + "Dirichlet": " ; ".join(f"{side}: {exact}" for side in sides), **overrides})
        for model in run.summary["models"]:
            table.add_limit(f"{name}, {model}: largest error", run.error(model, kind="maximum"), 1e-8)
    two = run_scene(WALL, {"Models": PD}, ranks=2)
    one = run_scene(WALL, {"Models": PD})
    check_close(two.model(PD)["boundary flux"]["right"], one.model(PD)["boundary flux"]["right"], relative=1e-9, what="on 2 processes")
    table.show()


BAR = scene_text("""
Dimension = 1
Physics = elasticity
Domain/Upper corner = 1
Domain/Cells = 100
Material/Young modulus = 200e9
Boundary conditions/Displacement = left: 0
Boundary conditions/Traction = right: 200e6
Output/Fields = none
Output/Probes = 1
""")

GRIP = scene_text("""
Dimension = 2
Physics = elasticity
Domain/Upper corner = 1, 0.4
Domain/Cells = 100, 40
Material/Young modulus = 1
Material/Poisson ratio = 0.3
Boundary conditions/Parts = grip: region x < 0.025 ; back: point 1, 0.2
Boundary conditions/Displacement = grip: free, 1e-3 ; back: 0, free
Output/Fields = none
""")

LATENT = scene_text("""
Dimension = 1
Models = finite elements, peridynamics
Domain/Upper corner = 1
Domain/Cells = 40
Material/Heat capacity = 1 + if(abs(T) < 0.005, 100, 0)
Initial and source/Initial value = -0.01
Boundary conditions/Dirichlet = left: 1
Time/End time = 0.1
Output/Fields = none
Output/Probes = 0.1 ; 0.25 ; 0.4
""")


def melting(x, t, half=0.005, capacity=101.0, wall=1.0, start=-0.01):
    """Temperature of LATENT as long as the other end is far: of x/(2 sqrt t) alone, with fronts at +half and -half between which the capacity is high."""
    def root(f, low, high):
        for _ in range(100):
            middle = (low + high) / 2
            low, high = (middle, high) if f(middle) > 0 else (low, middle)
        return middle

    fast = math.sqrt(capacity)

    def slope(at, a, b):
        return 2 * half * fast * math.exp(-(fast * at)**2) / (math.erfc(fast * a) - math.erfc(fast * b))

    def solid(a):
        return root(lambda b: slope(a, a, b) - (wall - half) * math.exp(-a * a) / math.erf(a), a, 1.0)

    a = root(lambda a: slope(solid(a), a, solid(a)) - (-half - start) * math.exp(-solid(a)**2) / math.erfc(solid(a)), 0.5, 0.7)
    b, s = solid(a), x / (2 * math.sqrt(t))
    if s < a:
        return wall - (wall - half) * math.erf(s) / math.erf(a)
    if s < b:
        return half - 2 * half * (math.erfc(fast * a) - math.erfc(fast * s)) / (math.erfc(fast * a) - math.erfc(fast * b))
    return start + (-half - start) * math.erfc(s) / math.erfc(b)


def refusals():
    for young in ("200e9", "200e15"):
        run = run_scene(BAR, {"Material/Young modulus": young})
        for model in run.summary["models"]:
            check_close(run.probe(model, (1,), column="ux"), 200e6 / float(young), relative=1e-6, what=f"{model}: a bar of steel, E = {young}")
    run = run_scene(GRIP, {"Models": FE})
    check(run.returncode == 0, "a grip narrower than 1/40 of the body")
    refused = run_scene(GRIP, {"Models": FE, BC + "Parts": "grip: point 0, 0.2 ; back: point 1, 0.2", BC + "Displacement": "grip: 0, 1e-3 ; back: 0, free"}, expect_error=True)
    check("rotation" in refused.stderr, "a body that may turn is refused as before")

    # Oblique cracks from a side: a node there of which they leave no cell follows its neighbour. 11.39: four times as fine, coupled.
    node = (0, 19 / 41)
    oblique = {"Models": FE, "Domain/Upper corner": "1, 1", "Domain/Cells": "41, 41", BC + "Parts": "", BC + "Displacement": "bottom: 0, 0", BC + "Traction": "top: 0, 1",
               "Cracks/Segments": "-0.026, 0.435 ; 0.433, 0.7", "Output/Probes": f"0, 1 ; {node[0]}, {node[1]!r}"}
    alone, shared = (run_scene(GRIP, oblique, ranks=ranks) for ranks in (1, 2))
    check_close(alone.probe(FE, (0, 1), column="uy"), 11.39, relative=0.06, what="a plate with an oblique crack from a side")
    for place in ((0, 1), node):
        check_close(shared.probe(FE, place, column="uy"), alone.probe(FE, place, column="uy"), relative=1e-8, what=f"the same at {place} on 2 processes")
    check(alone.probe(FE, node, column="uy") > 10, "its mouth moves with the upper side")


def latent():
    for stepper in ("sdirk2", "bdf2", "crank nicolson"):
        for step in ("auto", "1e-3"):
            run = run_scene(LATENT, {"Time/Stepper": stepper, "Time/Time step": step})
            for model in run.summary["models"]:
                for x in (0.1, 0.25, 0.4):
                    check_close(run.probe(model, (x,)), melting(x, 0.1), absolute=2e-3, what=f"{stepper}, {step}, {model}: latent heat, T at {x}")
        # A closed body passes a narrow peak in one step.
        closed = {BC + "Dirichlet": "", "Initial and source/Source": 1, "Time/Stepper": stepper, "Time/End time": 1.8, "Time/Time step": 1.8,
                  "Material/Heat capacity": "1 + if(abs(T - 0.3) < 0.0005, 1000, 0)"}
        run = run_scene(LATENT, closed)
        for model in run.summary["models"]:
            check_close(run.probe(model, (0.25,)), 0.79, relative=1e-9, what=f"{stepper}, {model}: heat of a narrow peak")
    # Iterations that do not converge in steps of a fixed length.
    run = run_scene(LATENT, {"Models": FE, "Domain/Cells": 20, "Time/Stepper": "sdirk2", "Time/Time step": 1e-2, "Time/End time": 0.05,
                             "Material/Heat capacity": "1 + if(abs(T) < 0.00005, 10000, 0)"})
    check_close(run.probe(FE, (0.1,)), melting(0.1, 0.05), absolute=3e-3, what="divided steps: T")
    divided = run.model(FE)["divided steps"]
    check(divided["number"] > 0 and divided["most parts"] > 1, f"divided steps: {divided}")
    check(any("were divided" in note for note in run.summary["notes"]), "a note on divided steps")


SQUARE = """$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
1 1 "wall"
1 2 "wall"
1 3 "hot"
$EndPhysicalNames
$Comments
as others write it
$EndComments
$Nodes
4
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
$EndNodes
$Elements
4
1 3 2 5 5 1 2 3 4
2 1 2 1 1 1 2
3 1 2 2 2 3 4
4 1 2 3 3 4 1
$EndElements
"""


def meshes():
    scene = HEAT.replace("set Cells = 41, 41", "set Shape = mesh file").replace("  set Holes = rectangle: 0, 0.49, 0.5, 0.51\n", "")
    settings = {"Models": FE, BC + "Dirichlet": "hot: 0", BC + "Flux": "wall: 1"}
    run = run_scene(scene, {**settings, "Domain/Mesh file": write_file("part.msh", SQUARE)})
    check_close(run.model(FE)["boundary flux"]["wall"], 2, relative=1e-9, what="two groups of one name: both let in")
    turned = SQUARE.replace("3 1 1 0", "3 1 0 1").replace("4 0 1 0", "4 0 0 1")
    refused = run_scene(scene, {**settings, "Domain/Mesh file": write_file("part.msh", turned)}, expect_error=True)
    check("plane of x and z" in refused.stderr, f"a mesh in the plane of x and z: {refused.stderr}")
    inner = grid_mesh((4, 4), lambda i, j: (i / 4, j / 4), (*BOX, (7, 0, 1, lambda j: j == 0)), names=NAMES)
    run = run_scene(scene, {"Models": FE, BC + "Dirichlet": "left: 0 ; right: 1", "Domain/Mesh file": inner})
    check_close(run.model(FE)["boundary flux"]["right"], 1, relative=1e-9, what="a named line between two cells")


def two_materials(xs, ys, at, moved=0.0, n_named=None):
    """A mesh of the rectangle xs by ys: cells left of `at` are the group "steel", others "oak: dry", the lowest n_named (or all) lines between them
    "glue; A:B", two corners on the right one group of points, one of them also number 1 without a name. moved: of inner nodes beside the line, in parts of a cell."""
    n, m, middle = len(xs) - 1, len(ys) - 1, xs.index(at)
    def place(i, j):
        free = moved if 0 < i < n and 0 < j < m and i != middle else 0
        return xs[i] + free * xs[1] * np.sin(7 * i + 3 * j), ys[j] + free * ys[1] * np.cos(5 * i + 11 * j)
    return grid_mesh((n, m), place, (*BOX[:2], (5, 0, middle, lambda j: j < (n_named or m))), lambda i, j: 8 if i < middle else 9,
                     ((1, 1, "left"), (1, 2, "right; hot"), (1, 5, "glue; A:B"), (0, 6, "pin"), (0, 7, "corners"), (2, 8, "steel"), (2, 9, "oak: dry")),
                     ((1, (n, 0)), (6, (0, 0)), (7, (n, 0)), (7, (n, m))))


def bricks(moved=0.0):
    """The same in 3D: 8 x 3 x 3 cells, the left half "steel"; the plane between is "glue". moved: of inner nodes, within that plane if they are on it."""
    def place(i, j, k):
        inner = moved if 0 < i < 8 and 0 < j < 3 and 0 < k < 3 else 0
        return [size * (p + (inner * np.sin(7 * i + 3 * j + 5 * k + 2 * d) if d > 0 or i != 4 else 0)) for d, (p, size) in enumerate(((i, 1 / 8), (j, 1 / 12), (k, 1 / 12)))]
    return grid_mesh((8, 3, 3), place, ((1, 0, 0), (2, 0, -1), (5, 0, 4)), lambda i, j, k: 8 if i < 4 else 9,
                     ((2, 1, "left"), (2, 2, "right"), (2, 5, "glue"), (3, 8, "steel")))


def ring(n):
    """A quarter of the ring 1 < r < 3 with a circle "glue" at r = 2; sides "inner", "outer", cells "core" within."""
    def place(i, k):
        r, angle = 1 + 2 * i / n, 0.5 * np.pi * k / n
        return r * np.cos(angle), r * np.sin(angle)
    return grid_mesh((n, n), place, ((1, 0, 0), (2, 0, -1), (3, 0, n // 2)), lambda i, k: 4 if i < n // 2 else 5,
                     ((1, 1, "inner"), (1, 2, "outer"), (1, 3, "glue"), (2, 4, "core"), (2, 5, "shell")))


NAMED = scene_text("""
Dimension = 2
Models = finite elements, peridynamics, coupled
Domain/Shape = mesh file
Material/Conductivity = 1
Material/Phases/Regions = metal: mesh(steel)
Material/Phases/Conductivity = metal: 5
Boundary conditions/Dirichlet = left: 0 ; "right; hot": 1
Cracks/Interfaces = "glue; A:B"
Cracks/Contact conductance = 2
Time/Steady = true
Output/Fields = none
""")


def interfaces():
    """Named lines and surfaces between two materials, as cracks that conduct or do not."""
    table = Comparison("Interfaces of mesh files")
    xs, ys = [k / 20 for k in range(21)], [k / 20 for k in range(6)]
    flow = lambda run, model, side='right; hot': abs(run.model(model)["boundary flux"][side])
    for name, moved in (("squares", 0), ("distorted cells", 0.25)):
        on_mesh = {"Domain/Mesh file": two_materials(xs, ys, 0.5, moved), "Peridynamics/Horizon": "0.15"}
        run = run_scene(NAMED, on_mesh)
        for model in run.summary["models"]:
            table.add(f"{name}, {model}: 0.5/5 + 1/2 + 0.5/1 in series", flow(run, model) / 0.25, 1 / 1.1, relative=1e-8 if model == FE else 1e-6)
            check_close(abs(sum(run.model(model)["crack flux"])), flow(run, model), relative=0.01, what=f"{name}, {model}: through the crack")
    two = run_scene(NAMED, on_mesh, ranks=2)
    for model in run.summary["models"]:
        check_close(flow(two, model), flow(run, model), relative=1e-9, what=f"{model}: on 2 processes")
    closed = run_scene(NAMED, {**on_mesh, "Cracks/Contact conductance": "", "Output/Probes": "0.1, 0.1 ; 0.9, 0.1"})
    for model in closed.summary["models"]:
        check(flow(closed, model) < 1e-9, f"{model}: nothing passes an insulated interface: {flow(closed, model)}")
        check_close(closed.probe(model, (0.9, 0.1)), 1, absolute=1e-8, what=f"{model}: behind it")
    for name, moved in (("3D", 0), ("3D, distorted", 0.1)):
        on_mesh = {"Dimension": "3", "Domain/Mesh file": bricks(moved), "Peridynamics/Horizon": "0.3", "Cracks/Interfaces": "glue",
                   BC + "Dirichlet": "left: 0 ; right: 1"}
        part = run_scene(NAMED, on_mesh)
        for model in part.summary["models"]:
            table.add(f"{name}, {model}", flow(part, model, "right") * 16, 1 / 1.1, relative=1e-8 if model == FE else 1e-6)
    closed = run_scene(NAMED, {**on_mesh, "Cracks/Contact conductance": ""}, ranks=2)
    for model in closed.summary["models"]:
        check(flow(closed, model, "right") < 1e-9, f"3D, distorted, {model}: nothing passes an insulated interface: {flow(closed, model, 'right')}")
    exact = 0.5 * np.pi / (np.log(2) / 5 + 1 / (2 * 2) + np.log(1.5))
    run = run_scene(NAMED, {"Domain/Mesh file": ring(32), "Peridynamics/Horizon": "0.25", "Cracks/Interfaces": "glue",
                            "Material/Phases/Regions": "metal: mesh(core)", BC + "Dirichlet": "inner: 0 ; outer: 1"})
    for model in run.summary["models"]:
        table.add(f"a circle, {model}: logarithms in series", flow(run, model, "outer"), exact, relative=2e-3 if model == FE else 0.02)
    table.show()

    # Solids: a part of the line, as the same faces given by a segment.
    part = two_materials(xs, ys, 0.5, 0.25, n_named=3)
    solid = scene_text(SOLID)
    runs = [run_scene(solid, {"Domain/Mesh file": part, "Cracks/" + entry: text, "Cracks/Mesh": mesh})
            for entry, text, mesh in (("Interfaces", '"glue; A:B"', "auto"), ("Segments", "0.5,0 ; 0.5,0.15", "faces"))]
    for model in runs[0].summary["models"]:
        pull = [run.total("force on right; hot in x", model) for run in runs]
        check_close(pull[0], pull[1], relative=1e-9, what=f"{model}: force on a notched plate, by interface and by segment")
        check(abs(pull[0]) < 0.9 * 0.25 * 0.01, f"{model}: the notch is open: {pull[0]}")


SOLID = """
Dimension = 2
Models = finite elements, peridynamics, coupled
Physics = elasticity
Domain/Shape = mesh file
Material/Young modulus = 1
Material/Poisson ratio = 0.25
Peridynamics/Horizon = 0.15
Boundary conditions/Displacement = left: 0, 0 ; "right; hot": 0.01, 0
Output/Fields = none
"""


def names():
    """What files give names to: points, materials, names with separators; binary files; what cannot be used, and what is not there."""
    xs, ys = [k / 8 for k in range(9)], [k / 16 for k in range(5)]
    part = two_materials(xs, ys, 0.5)
    heat = {"Models": FE, "Domain/Mesh file": part, "Cracks/Interfaces": "", "Cracks/Contact conductance": ""}
    series = 0.25 / (0.5 / 5 + 0.5)
    for regions in ("metal: mesh(steel)", 'metal: mesh("steel")', "metal: mesh(8)"):
        run = run_scene(NAMED, {**heat, "Material/Phases/Regions": regions})
        check_close(run.model(FE)["boundary flux"]["right; hot"], series, relative=1e-9, what=regions)
    run = run_scene(NAMED, {**heat, "Material/Conductivity": "5", "Material/Phases/Regions": 'wood: mesh("oak: dry")', "Material/Phases/Conductivity": "wood: 1"})
    check_close(run.model(FE)["boundary flux"]["right; hot"], series, relative=1e-9, what="a material with a colon in its name")
    run = run_scene(NAMED, {**heat, "Domain/Mesh file": write_file("binary.msh", binary(part)), "Material/Phases/Regions": "metal: mesh(steel)"})
    check_close(run.model(FE)["boundary flux"]["right; hot"], series, relative=1e-9, what="a binary file")

    # Points as the scene's own parts: two share a load, a part of the scene goes before a point of the file, one without a name is no side.
    solid = {"Models": FE, "Domain/Mesh file": part, "Peridynamics/Horizon": "0.3", "Output/Probes": "1, 0 ; 1, 0.25 ; 0, 0.25"}
    runs = [run_scene(scene_text(SOLID), {**solid, BC + "Parts": given, BC + "Displacement": f"1: 0, free ; {where}: free, 0", BC + "Traction": load})
            for where, given, load in (("pin", "", "corners: 0.02, 0"), ("pin", "pin: point 0, 0", "corners: 0.02, 0"),
                                       ("corner", "corner: point 0, 0 ; a: point 1, 0 ; b: point 1, 0.25", "a: 0.01, 0 ; b: 0.01, 0"))]
    for run in runs:
        check_close(run.total("force on 1 in x", FE), -0.02, relative=1e-8, what="the force of both points")
        for place in ((1, 0), (1, 0.25), (0, 0.25)):
            for column in ("ux", "uy"):
                check_close(run.probe(FE, place, column=column), runs[-1].probe(FE, place, column=column), absolute=1e-12, what=f"points of the file: {column} at {place}")
    check(runs[-1].probe(FE, (1, 0.25), column="uy") < -1e-4, "it is thinner")

    other = SQUARE.replace("2 1 2 1 1 1 2\n", "2 93 2 1 1 1 2 3\n")
    nothing = {"Models": FE, BC + "Dirichlet": "nowhere: 0", "Peridynamics/Horizon": "", "Cracks/Interfaces": "", "Cracks/Contact conductance": "", "Material/Phases/Regions": "a: mesh(b)"}
    for what, text, words in (("an unknown element", other, ["type 93", "first and second order"]),
                              ("no such side", SQUARE, ["mesh(b)", "physical group"])):
        run = run_scene(NAMED, {**nothing, "Domain/Mesh file": write_file("wrong.msh", text)}, expect_error=True)
        check_message(run, *words)
    for entry, text, words in ((BC + "Dirichlet", "left: 0 ; rihgt: 1", ["rihgt", "left (1)", "right; hot (2)"]), (BC + "Dirichlet", "left: 0 ; 3: 1", ["unknown side '3'", "left (1)"]),
                               ("Cracks/Interfaces", "glue", ["glue; A:B (5)"]), ("Cracks/Interfaces", "left", ["surface of the body", "glue; A:B (5)"]),
                               ("Cracks/Mesh", "pairs", ["'Interfaces'", "faces"])):
        run = run_scene(NAMED, {"Domain/Mesh file": part, "Peridynamics/Horizon": "0.3", entry: text}, expect_error=True)
        check_message(run, *words)


def binary(path):
    """A file of version 2.2 with names of groups as a binary one of version 4.1."""
    lines = open(path).read().split("\n")
    section = lambda name: lines[lines.index("$" + name) + 2:lines.index("$End" + name)]
    names = "\n".join(lines[lines.index("$PhysicalNames"):lines.index("$EndPhysicalNames") + 1])
    nodes = [line.split() for line in section("Nodes")]
    blocks = {}
    for line in section("Elements"):
        number, kind, _, group, _, *corners = map(int, line.split())
        blocks.setdefault(({15: 0, 1: 1, 3: 2}[kind], group, kind), []).append((number, *corners))
    sizes = [sum(dim == d for dim, _, _ in blocks) for d in range(4)]
    out = b"$MeshFormat\n4.1 1 8\n" + struct.pack("<i", 1) + b"\n$EndMeshFormat\n" + names.encode() + b"\n$Entities\n" + struct.pack("<4Q", *sizes)
    for dim, group, _ in sorted(blocks):
        out += struct.pack("<i", group) + bytes(8 * (3 if dim == 0 else 6)) + struct.pack("<Qi", 1, group) + (struct.pack("<Q", 0) if dim else b"")
    out += b"\n$EndEntities\n$Nodes\n" + struct.pack("<4Q", 1, len(nodes), 1, len(nodes)) + struct.pack("<3iQ", 2, 8, 0, len(nodes))
    out += b"".join(struct.pack("<Q", int(node[0])) for node in nodes) + b"".join(struct.pack("<3d", *map(float, node[1:])) for node in nodes)
    out += b"\n$EndNodes\n$Elements\n" + struct.pack("<4Q", len(blocks), sum(map(len, blocks.values())), 1, 10000)
    for (dim, group, kind), elements in blocks.items():
        out += struct.pack("<3iQ", dim, group, kind, len(elements)) + b"".join(struct.pack(f"<{len(e)}Q", *e) for e in elements)
    return out + b"\n$EndElements\n"


def pieces(path, blocks, parted=lambda corner, middle: 0, moved=0.0):
    """A mesh of blocks, each of rectangles or bricks between its own lines along x, y (and z): they share no nodes, nor do cells of a block for which
    parted(corner, middle of the cell) differs there. Sides 1, 2, 3, ...: left, right, bottom, top, ... of the blocks' box. moved: of nodes that are inside a
    block and not on x = 0.5 or y = 0.5, in parts of a cell."""
    dim = len(blocks[0])
    around = [(0, 0), (1, 0), (1, 1), (0, 1)] if dim == 2 else [(a, b, c) for c in (0, 1) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
    lowest, highest = [[end(lines[d][k] for lines in blocks) for d in range(dim)] for end, k in ((min, 0), (max, -1))]
    number, nodes, cells, sides = {}, [], [], []
    for which, lines in enumerate(blocks):
        def node(index, middle):
            place = [lines[d][index[d]] for d in range(dim)]
            key = (which, index, parted(place, middle))
            if key not in number:
                number[key] = len(number) + 1
                inside = all(0 < index[d] < len(lines[d]) - 1 for d in range(dim)) and 0.5 not in place[:2]
                nodes.append([p + (moved * (lines[d][1] - lines[d][0]) * np.sin(7 * index[0] + 3 * index[1] + 5 * index[-1] + d) if inside else 0)
                              for d, p in enumerate(place)])
            return number[key]
        for first in np.ndindex(*[len(line) - 1 for line in lines]):
            middle = [0.5 * (lines[d][first[d]] + lines[d][first[d] + 1]) for d in range(dim)]
            corners = {offset: node(tuple(i + o for i, o in zip(first, offset)), middle) for offset in around}
            cells.append(" ".join(str(corners[offset]) for offset in around))
            for d in range(dim):
                for end, limit in ((0, lowest), (1, highest)):
                    if lines[d][first[d] + end] == limit[d]:
                        face = [c for c in around if c[d] == end]
                        face = face if dim == 2 else [face[0], face[1], face[3], face[2]] if d < 2 else face
                        sides.append((2 * d + end + 1, " ".join(str(corners[c]) for c in face)))
    kind = (1, 3) if dim == 2 else (3, 5)
    elements = [f"{kind[0]} 2 {side} {side} {face}" for side, face in sides] + [f"{kind[1]} 2 9 9 {cell}" for cell in cells]
    return write_file(path, mesh_text(nodes, elements))


TOUCHING = {"Domain/Shape": "mesh file", "Peridynamics/Horizon": "0.21", "Coupling/Zone": "everywhere"}
CONDUCTS = scene_text("""
Dimension = 2
Boundary conditions/Dirichlet = 1: 0 ; 2: 1
Time/Steady = true
Output/Fields = none
""")
BEARS = scene_text("""
Dimension = 2
Physics = elasticity
Material/Young modulus = 1
Material/Poisson ratio = 0.25
Boundary conditions/Displacement = 1: 0, 0 ; 2: 0.01, 0
Output/Fields = none
""")


def touching():
    """Nothing passes from one piece of a mesh to another that only touches it, and a crack of doubled nodes is one, as in finite elements."""
    lines = lambda a, b, n: [a + (b - a) * k / n for k in range(n + 1)]
    low, high, coarse = lines(0, 0.5, 10), lines(0.5, 1, 10), lines(0.5, 1, 5)
    nothing = lambda values, what: check(all(abs(value) < 1e-12 for value in values.values()), f"{what}: nothing passes: {values}")
    for name, blocks in (("beside each other", [(low, low), (high, low)]), ("two faces beside one", [(low, low), (coarse, lines(0, 0.5, 5))]),
                         ("at a corner", [(low, low), (high, high)])):
        on_mesh = {**TOUCHING, "Domain/Mesh file": pieces("pieces.msh", blocks, moved=0.2)}
        for nodes, models in (("vertices", f"{FE}, {PD}, {COUPLED}"), ("cell centers", PD)):
            of_nodes = {**on_mesh, "Domain/Nodes": nodes, "Models": models}
            run = run_scene(CONDUCTS, of_nodes)
            nothing({model: run.model(model)["boundary flux"]["2"] for model in run.summary["models"]}, f"heat, {name}, {nodes}")
            run = run_scene(BEARS, of_nodes, ranks=2 if nodes == "vertices" else 1)
            nothing({model: run.total("force on 2 in x", model) for model in run.summary["models"]}, f"a solid, {name}, {nodes}")
    kept = run_scene(CONDUCTS, {**on_mesh, "Models": PD, "Peridynamics/Bonds across voids": "keep"})
    check(kept.model(PD)["boundary flux"]["2"] > 0.05, "'keep' keeps bonds between them")
    thin = lines(0, 0.25, 3)
    bricks = {**TOUCHING, "Dimension": "3", "Domain/Mesh file": pieces("bricks.msh", [(low[::2], thin, thin), (coarse, thin, lines(0, 0.25, 2))], moved=0.1),
              "Peridynamics/Horizon": "0.3"}
    for nodes, models in (("vertices", f"{FE}, {PD}, {COUPLED}"), ("cell centers", PD)):
        run = run_scene(CONDUCTS, {**bricks, "Domain/Nodes": nodes, "Models": models})
        nothing({model: run.model(model)["boundary flux"]["2"] for model in run.summary["models"]}, f"bricks, {nodes}")
    run = run_scene(BEARS, {**bricks, "Models": f"{FE}, {PD}", BC + "Displacement": "1: 0, 0, 0 ; 2: 0.01, 0, 0"})
    nothing({model: run.total("force on 2 in x", model) for model in run.summary["models"]}, "solid bricks")

    table = Comparison("A crack of doubled nodes up to the middle of a square")
    square = low + high[1:]
    doubled = pieces("crack.msh", [(square, square)], lambda place, middle: place[1] == 0.5 and place[0] < 0.5 and middle[1] > 0.5, moved=0.2)
    whole = pieces("whole.msh", [(square, square)], moved=0.2)
    across = {**TOUCHING, BC + "Dirichlet": "3: 0 ; 4: 1"}
    run = run_scene(CONDUCTS, {**across, "Domain/Mesh file": doubled, "Models": f"{FE}, {PD}, {COUPLED}"})
    flow = {model: run.model(model)["boundary flux"]["4"] for model in run.summary["models"]}
    for model in (PD, COUPLED):
        table.add(f"heat, {model}: over finite elements", flow[model] / flow[FE], 1, absolute=0.02)
    pull = {**TOUCHING, BC + "Displacement": "3: 0, 0 ; 4: 0, 0.01"}
    run = run_scene(BEARS, {**pull, "Domain/Mesh file": doubled, "Models": f"{FE}, {PD}, {COUPLED}"})
    force = {model: run.total("force on 4 in y", model) for model in run.summary["models"]}
    for model in (PD, COUPLED):
        table.add(f"solid, {model}: over finite elements", force[model] / force[FE], 1, absolute=0.06)
    # Bonds alone: those that a segment cuts, and those that end at the crack's faces.
    for nodes, limit in (("vertices", 1e-3), ("cell centers", 1e-6)):
        bonds = {**pull, "Models": PD, "Domain/Nodes": nodes, "Peridynamics/Surface correction": "none"}
        segment = {"Cracks/Segments": "0,0.5 ; 0.5,0.5", "Cracks/Mesh": "faces" if nodes == "vertices" else "auto"}
        runs = [run_scene(BEARS, {**bonds, **more}) for more in ({"Domain/Mesh file": doubled}, {"Domain/Mesh file": whole, **segment})]
        table.add(f"solid, {nodes}, bonds alone: over a segment there", runs[0].total("force on 4 in y", PD) / runs[1].total("force on 4 in y", PD), 1, absolute=limit)
    table.show()


if __name__ == "__main__":
    run_parts(voids, contact, refusals, latent, meshes, interfaces, names, touching)
