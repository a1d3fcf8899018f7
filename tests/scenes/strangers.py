# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Scenes as somebody else would write them, by defaults: right without a word, or with the right one.

    strangers.py voids      bonds across slits of lattices, meshes and images
    strangers.py contact    a contact conductance between two materials
    strangers.py refusals   what was refused, or never started, and is sound
    strangers.py meshes     files as others write them
"""

import numpy as np

from scene_test import BC, COUPLED, FE, PD, Comparison, check, check_close, run_parts, run_scene, scene_text, write_file
from scene_texts import mesh_text


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


def lines_of(xs, ys, holds):
    """A mesh file of rectangles between these lines; sides 1 to 4: left, right, bottom, top; 5: inside."""
    number, nodes, cells = {}, [], []
    for j in range(len(ys) - 1):
        for i in range(len(xs) - 1):
            if holds(0.5 * (xs[i] + xs[i + 1]), 0.5 * (ys[j] + ys[j + 1])):
                cells.append([(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)])
    for cell in cells:
        for corner in cell:
            if corner not in number:
                number[corner] = len(number) + 1
                nodes.append(f"{xs[corner[0]]!r} {ys[corner[1]]!r}")
    edges = {}
    for cell in cells:
        for a, b in zip(cell, cell[1:] + cell[:1]):
            edges.setdefault(frozenset((a, b)), []).append((a, b))
    elements = []
    for found in edges.values():
        if len(found) == 1:
            (i, j), (k, m) = found[0]
            side = 1 if i == k == 0 else 2 if i == k == len(xs) - 1 else 3 if j == m == 0 else 4 if j == m == len(ys) - 1 else 5
            elements.append(f"1 2 {side} {side} {number[found[0][0]]} {number[found[0][1]]}")
    elements += [f"3 2 9 9 " + " ".join(str(number[c]) for c in cell) for cell in cells]
    return mesh_text(nodes, elements, ("left", "right", "bottom", "top", "slot"))


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
    path = write_file("part.msh", lines_of(side + [0.5 + 0.5 * k / 20 for k in range(1, 21)], ys, lambda x, y: not (x < 0.5 and 0.49 < y < 0.51)))
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
    """In series: 0.5/5 + 1/2 + 0.5/1 = 1.1."""
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
            table.add(f"{name}, {model}", abs(run.model(model)["boundary flux"]["right"]) / area, 1 / 1.1, relative=0.01)
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


def enthalpies(n, end):
    """Temperatures of the nodes of LATENT: the heat of each by small explicit steps, its temperature from that."""
    bends = np.array([-10.0, -0.005, 0.005, 10.0])
    heats = bends + 100 * np.clip(bends + 0.005, 0, 0.01)
    h, steps = 1 / n, 8000
    u = np.full(n + 1, -0.01)
    u[0] = 1.0
    heat = np.interp(u, bends, heats)
    for _ in range(steps):
        flow = np.diff(u) / h
        heat[1:-1] += end / steps * np.diff(flow) / h
        heat[-1] -= end / steps * flow[-1] / (h / 2)
        u = np.interp(heat, heats, bends)
        u[0] = 1.0
    return u


def refusals():
    for young in ("200e9", "200e15"):
        run = run_scene(BAR, {"Material/Young modulus": young})
        for model in run.summary["models"]:
            check_close(run.probe(model, (1,), column="ux"), 200e6 / float(young), relative=1e-6, what=f"{model}: a bar of steel, E = {young}")
    run = run_scene(GRIP, {"Models": FE})
    check(run.returncode == 0, "a grip narrower than 1/40 of the body")
    refused = run_scene(GRIP, {"Models": FE, BC + "Parts": "grip: point 0, 0.2 ; back: point 1, 0.2", BC + "Displacement": "grip: 0, 1e-3 ; back: 0, free"}, expect_error=True)
    check("rotation" in refused.stderr, "a body that may turn is refused as before")

    exact = enthalpies(160, 0.1)
    for stepper in ("sdirk2", "bdf2", "crank nicolson"):
        run = run_scene(LATENT, {"Time/Stepper": stepper})
        for model in run.summary["models"]:
            for x in (0.1, 0.25, 0.4):
                check_close(run.probe(model, (x,)), exact[round(160 * x)], absolute=2e-3, what=f"{stepper}, {model}: latent heat, T at {x}")


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
    xs, ys = [0.25 * k for k in range(5)], [0.25 * k for k in range(5)]
    inner = lines_of(xs, ys, lambda x, y: True)
    inner = inner.replace("$Elements\n32\n", "$Elements\n33\n").replace("$EndElements", "33 1 2 7 7 2 3\n$EndElements")
    run = run_scene(scene, {"Models": FE, BC + "Dirichlet": "left: 0 ; right: 1", "Domain/Mesh file": write_file("part.msh", inner)})
    check_close(run.model(FE)["boundary flux"]["right"], 1, relative=1e-9, what="a named line between two cells")


if __name__ == "__main__":
    run_parts(voids, contact, refusals, meshes)
