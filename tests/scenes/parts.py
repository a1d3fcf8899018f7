# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Conditions on parts of sides, regions and points: areas and totals, parts that are whole sides, meshes with names, velocities, holes, penny-shaped cracks.

    parts.py loads | whole | heat | meshes | motion | holes | scenes
"""

import math
import os

from scene_test import BC, COUPLED, FE, PD, check, check_close, run_parts, run_scene, scene_text, write_file
from scene_texts import FOUR_CELLS, SQUARE_MESH


HEAT = scene_text("""
Title = Parts of a plate
Dimension = 2
Domain/Cells = 12, 11
Boundary conditions/Dirichlet = bottom: 0
Time/Steady = true
Output/Fields = none
Output/Probes = 0.3,0.4 ; 0.71,0.93
""")
ELASTIC = {"Physics": "elasticity", "Material/Young modulus": "200", "Material/Poisson ratio": "0.3", BC + "Dirichlet": "",
           BC + "Displacement": "bottom: 0, 0", "Time/Steady": "false"}
CUBE = {"Dimension": "3", "Domain/Lower corner": "0, 0, 0", "Domain/Upper corner": "1, 1, 1", "Domain/Cells": "8, 7, 8", "Output/Probes": ""}


def force(run, model, side, direction="y"):
    return run.total(f"force on {side} in {direction}", model)


def flux(run, model, side):
    return run.model(model)["boundary flux"][side]


def loads():
    """The force on a part of a side is its area times the traction, on a region or point what is given; the other side carries it."""
    area = {BC + "Parts": "load: top if abs(x - 0.47) < 0.237", BC + "Traction": "load: 0, -1"}
    total = {BC + "Parts": "spot: region (x - 0.6)^2 + (y - 0.6)^2 < 0.04 ; tip: point 0.93, 1", BC + "Traction": "spot: 2, 0 ; tip: 0, 3"}
    both = f"{FE}, {PD}"
    for what, more in (("vertices", {"Models": both}), ("cell centres", {"Models": both, "Domain/Nodes": "cell centers"}),
                       ("m = 6", {"Models": PD, "Domain/Cells": "25, 24", "Peridynamics/Horizon ratio": "6"}),
                       ("degree 2", {"Models": FE, "Finite elements/Degree": "2"}),
                       ("coupled", {"Models": COUPLED, "Coupling/Zone": "y - 0.4"}),
                       ("a traction layer", {"Models": PD, BC + "Traction layer": "0.3"})):
        run = run_scene(HEAT, {**ELASTIC, **more, **area})
        for model in run.summary["models"]:
            check_close(force(run, model, "load"), -0.474, relative=1e-12, what=f"{model}, {what}: force on 0.474 of a side")
            check_close(force(run, model, "bottom"), 0.474, relative=1e-7, what=f"{model}, {what}: carried by the other side")
        if "layer" in what:
            continue
        run = run_scene(HEAT, {**ELASTIC, **more, **total})
        for model in run.summary["models"]:
            for side, axis, value in (("spot", "x", 2), ("tip", "y", 3), ("bottom", "x", -2), ("bottom", "y", -3)):
                check_close(force(run, model, side, axis), value, relative=1e-7, what=f"{model}, {what}: {axis} of {side}")
    # Half a disc on a side of a cube, a formula that is no number beyond the part.
    run = run_scene(HEAT, {**ELASTIC, **CUBE, BC + "Displacement": "bottom: 0, 0, 0", "Models": both, "Peridynamics/Horizon ratio": "2",
                           BC + "Parts": "disc: top if (x - 0.5)^2 + z^2 < 0.3^2", BC + "Traction": "disc: 0, -1, 0"})
    for model in (FE, PD):
        check_close(force(run, model, "disc"), -math.pi * 0.045, relative=6e-4, what=f"{model}: half a disc")  # measured: 3.7e-4
    run = run_scene(HEAT, {**ELASTIC, "Models": both, **area, BC + "Traction": "load: 0, -sqrt(0.237^2 - (x - 0.47)^2)"})
    # Measured: 9e-4 and, with one value of the formula for each node, 2.7e-2 on the six cells of
    # the part.
    for model, bound in ((FE, 1.4e-3), (PD, 0.04)):
        check_close(force(run, model, "load"), -math.pi * 0.237 ** 2 / 2, relative=bound, what=f"{model}: a pressure that ends at the rim of the part")


def same(what, one, other, tolerance=1e-11):
    """All probes and what passes through sides."""
    for a, b in zip(one.probes, other.probes):
        for key in a:
            if isinstance(a[key], float):
                check_close(b[key], a[key], absolute=tolerance * max(1, abs(a[key])), what=f"{what}: {a['model']}, {key}")


def whole():
    """A part that is a whole side is that side, and parts that make one up are it, too."""
    three = f"{FE}, {PD}, {COUPLED}"
    for treatment, more in (("exchange", {}), ("none", {}), ("layer", {}), ("fictitious mirror", {}), ("fictitious constant", {}),
                            ("fictitious mirror", {"Domain/Nodes": "cell centers"}), ("fictitious constant", {"Domain/Nodes": "cell centers"}),
                            ("none", {"Domain/Nodes": "cell centers", "Peridynamics/Horizon ratio": "6", "Domain/Cells": "24, 25"}),
                            ("none", {"Peridynamics/Flux treatment": "extrapolation"})):
        name = f"{treatment} {more}"
        base = {"Peridynamics/Boundary treatment": treatment, "Models": three if treatment == "exchange" else PD, "Coupling/Zone": "0.5 - y", **more}
        sides = run_scene(HEAT, {**base, BC + "Dirichlet": "bottom: x", BC + "Flux": "top: 1 + x"})
        parts = run_scene(HEAT, {**base, BC + "Parts": "floor: bottom if x > -1 ; a: top if x < 0.43 ; b: top if x >= 0.43",
                                 BC + "Dirichlet": "floor: x", BC + "Flux": "a: 1 + x ; b: 1 + x"})
        # A node on the border takes the values in the middle of its two pieces: formulas that are
        # straight lines are the same there.
        same(name, sides, parts, 1e-9)
        for model in parts.summary["models"]:
            check_close(flux(parts, model, "a") + flux(parts, model, "b"), flux(sides, model, "top"), relative=1e-9, what=f"{model}, {name}: flux through both parts")
    for nodes in ("vertices", "cell centers"):
        base = {**ELASTIC, "Domain/Nodes": nodes, "Models": f"{FE}, {PD}"}
        sides = run_scene(HEAT, {**base, BC + "Displacement": "bottom: 0, 0 ; top: 0.01*x, free", BC + "Traction": "right: 1, y"})
        parts = run_scene(HEAT, {**base, BC + "Parts": "floor: bottom if x > -1 ; lid: top if 1 ; wall: right if y < 7", BC + "Traction": "wall: 1, y",
                                 BC + "Displacement": "floor: 0, 0 ; lid: 0.01*x, free"})
        same(f"elastic, {nodes}", sides, parts)
        branch = run_scene(HEAT, {**base, BC + "Displacement": "bottom: 0, 0 ; top: if(x < 0.5, 0.01, free), free"})
        part = run_scene(HEAT, {**base, BC + "Parts": "half: top if x < 0.5", BC + "Displacement": "bottom: 0, 0 ; half: 0.01, free"})
        same(f"free beyond the half, {nodes}", branch, part)


def heat():
    """Power on parts is area times flux, on regions and points what is given; what is held gives it away. A part named before its side holds."""
    conditions = {BC + "Parts": "warm: top if x > 0.5 && x < 0.83 ; spot: region x^2 + (y-0.5)^2 < 0.09 ; tip: point 1, 0.7 ; gap: left if y > 0.4",
                  BC + "Flux": "warm: 2 ; spot: 3 ; tip: -1", BC + "Convection": "gap: 4, 1"}
    for more in ({}, {"Domain/Nodes": "cell centers", "Models": PD}, {"Models": PD, "Peridynamics/Boundary treatment": "fictitious mirror"},
                 {"Models": COUPLED, "Coupling/Zone": "y - 0.3"}):
        run = run_scene(HEAT, {**conditions, **more})
        for model in run.summary["models"]:
            for side, power in (("warm", 0.66), ("spot", 3), ("tip", -1)):
                check_close(flux(run, model, side), power, relative=1e-11, what=f"{model} {more}: power of {side}")
            check_close(sum(run.model(model)["boundary flux"].values()), 0, absolute=1e-7, what=f"{model} {more}: all of it leaves")
    # Half a side held, the rest insulated: both models against each other.
    half = {BC + "Parts": "cold: bottom if x < 0.5", BC + "Dirichlet": "cold: 0", BC + "Flux": "top: 1", "Models": f"{FE}, {PD}",
            "Peridynamics/Boundary treatment": "fictitious mirror", "Domain/Nodes": "cell centers"}
    gaps = []
    for cells in ("21, 20", "41, 40"):
        run = run_scene(HEAT, {**half, "Domain/Cells": cells})
        fe, pd = (run.probe(model, (0.71, 0.93)) for model in (FE, PD))
        gaps.append(pd / fe - 1)
    check(0 < gaps[1] < gaps[0] and gaps[1] < 0.04, f"half a side held by a fictitious layer: {gaps} above finite elements")  # measured: 4.3, 3.3, at 81 cells 1.5 %
    run = run_scene(HEAT, {BC + "Parts": "hot: top if x > 0.5", BC + "Dirichlet": "hot: 100 ; top: 0 ; bottom: 0", "Output/Probes": "0.25,1 ; 0.75,1"})
    for model in run.summary["models"]:
        check_close(run.probe(model, (0.25, 1)), 0, absolute=1e-12, what=f"{model}: the side beyond the part")
        check_close(run.probe(model, (0.75, 1)), 100, absolute=1e-9, what=f"{model}: the part named first")


NAMES = """$PhysicalNames
3
1 3 "cold wall"
1 4 "lid"
2 7 "body"
$EndPhysicalNames
"""


def meshes():
    """Physical names of a mesh file and its numbers are the same sides; parts of both."""
    path = write_file("named.msh", SQUARE_MESH.format(names=NAMES, n=8, cells=FOUR_CELLS))
    mesh = {"Domain/Shape": "mesh file", "Domain/Mesh file": path, "Peridynamics/Horizon": "1.1", "Output/Probes": "0.3,0.4"}
    numbers = run_scene(HEAT, {**mesh, BC + "Dirichlet": "3: 0; 4: x"})
    names = run_scene(HEAT, {**mesh, BC + "Dirichlet": "cold wall: 0; lid: x"})
    same("names for numbers", numbers, names)
    for model in names.summary["models"]:
        check_close(flux(names, model, "lid"), flux(numbers, model, "4"), relative=1e-10, what=f"{model}: flux through 'lid'")
    run = run_scene(HEAT, {**mesh, BC + "Dirichlet": "cold wall: 0", BC + "Parts": "warm: lid if x < 0.3 ; also: 4 if x > 0.8", BC + "Flux": "warm: 1 ; also: 2"})
    for model in run.summary["models"]:
        check_close(flux(run, model, "warm"), 0.3, relative=1e-11, what=f"{model}: part of a named side")
        check_close(flux(run, model, "also"), 0.4, relative=1e-11, what=f"{model}: part of a numbered side")


def motion():
    """A velocity is the rate of what is held: the end of a strip moves by its integral, and the strip like a rod."""
    coarse = {"Domain/Cells": "160, 8", "Output/Fields": "none", BC + "Parts": "blow: left if abs(y) < 0.13", "Output/Probes": "0,0 ; 4,0"}
    run = run_scene("prm/elasticity/impact_on_strip.prm", coarse)
    for model in (FE, PD):
        for t in (2, 4, 6, 8):
            check_close(run.probe(model, (0, 0), time=t, column="ux"), t - 0.5, absolute=1e-8, what=f"{model}: the end at t = {t}")
        now, before = (run.probe(model, (4, 0), time=t, column="ux") for t in (8, 6))
        check_close(now - before, 2, relative=0.02, what=f"{model}: a section at x = 4 moves as the end did 4 earlier")
        check_close(run.probe(model, (4, 0), time=8, column="sxx"), -1, relative=0.05, what=f"{model}: stress -E v/c")


def holes():
    """Lists of holes are the same body as single ones; a disc has the area of its circle."""
    plate = {"Domain/Cells": "20, 20", "Output/Probes": "0.1,0.4 ; 0.9,0.95"}
    one = run_scene(HEAT, {**plate, "Domain/Shape": "plate with hole", "Domain/Hole center": "0.4, 0.6", "Domain/Hole radius": "0.17", BC + "Flux": "hole: 1"})
    for more in ({"Domain/Holes": "circle: 0.4, 0.6, 0.17"}, {"Domain/Holes": "circle: 0.4, 0.6, 0.17", "Domain/Shape": "plate with hole"}):
        same(f"{more}", one, run_scene(HEAT, {**plate, **more, BC + "Flux": "hole: 1"}))
    rectangle = run_scene(HEAT, {**plate, "Domain/Holes": "rectangle: 0.2, 0.3, 0.5, 0.6", BC + "Flux": "hole: 1"})
    polygon = run_scene(HEAT, {**plate, "Domain/Holes": "polygon: 0.2,0.3, 0.5,0.3, 0.5,0.6, 0.2,0.6", BC + "Flux": "hole: 1"})
    same("a rectangle and its corners", rectangle, polygon)
    for model in rectangle.summary["models"]:
        check_close(flux(rectangle, model, "hole"), 1.2, relative=1e-9, what=f"{model}: flux through the rim of a rectangle")
    several = run_scene(HEAT, {**plate, "Domain/Holes": "circle: 0.3, 0.7, 0.1 ; rectangle: 0.6, 0.2, 0.8, 0.4",
                               BC + "Parts": "rim: hole if x < 0.5", BC + "Flux": "rim: 1"}, ranks=2)
    for model in several.summary["models"]:
        check_close(flux(several, model, "rim"), 0.2 * math.pi, relative=1e-9, what=f"{model}: flux through the rim of one of two holes")
    disc = run_scene(HEAT, {**CUBE, "Models": FE, "Cracks/Polygons": "disc: 0.5,0.5,0.5, 1,2,2, 0.3"})
    corners = disc.summary["cracks"][0]
    check(len(corners) == 96, "a disc has 96 corners")
    size, middle = len(corners), [0.5, 0.5, 0.5]
    twice = [0, 0, 0]
    for k in range(size):
        a, b = ([c - m for c, m in zip(corners[j % size], middle)] for j in (k, k + 1))
        for d in range(3):
            twice[d] += a[(d + 1) % 3] * b[(d + 2) % 3] - a[(d + 2) % 3] * b[(d + 1) % 3]
    check_close(math.sqrt(sum(c * c for c in twice)) / 2, math.pi * 0.09, relative=1e-10, what="area of a disc")
    check_close(twice[1] / twice[0], 2, relative=1e-9, what="normal of a disc")


def intensity(run, model):
    ends = run.model(model)["stress intensity"]
    return next(iter(ends.values()))["I"]


def scenes():
    """Three-point bend and compact tension against ASTM E399; the cracks of Kalthoff and Winkler."""
    quiet = {"Output/Fields": "none"}
    run = run_scene("prm/fracture/three_point_bend.prm", {**quiet, "Domain/Cells": "177, 41"})
    # Measured: 7.2 % (finite elements lose the cells that the crack cuts) and 0.5 %; on the scene's
    # own lattice 3.2 and -0.05 %.
    for model, bound in ((FE, 0.1), (COUPLED, 0.02)):
        check_close(intensity(run, model), 10.65, relative=bound, what=f"{model}: K of the three-point bend")
        for foot in ("left foot", "right foot"):
            check_close(force(run, model, foot), 0.5, relative=1e-2, what=f"{model}: the {foot} carries half")
    faces = run_scene("prm/fracture/three_point_bend.prm", {**quiet, "Domain/Cells": "176, 40", "Cracks/Mesh": "faces", "Models": FE})
    check_close(intensity(faces, FE), 10.65, relative=0.06, what="on faces: K of the three-point bend")  # measured: 3.8 %, on 352 x 80 cells 2.2 %
    run = run_scene("prm/fracture/compact_tension.prm", quiet)
    # Measured on 42, 84, 168, 336 cells: -1.7, -2.2, 1.0, 0.8 % and 2.7, 1.1, 0.4, 0.2 %.
    for model, bound in ((FE, 0.05), (COUPLED, 0.018)):
        check_close(intensity(run, model), 9.659, relative=bound, what=f"{model}: K of the compact tension specimen")
        check_close(force(run, model, "back"), 0, absolute=1e-6, what=f"{model}: nothing left for the back")
    body_force()
    kalthoff(quiet)
    kalthoff_halves()


def body_force():
    """A hanging strip with a crack in its middle: the stress there is that of the weight below, and K that of a traction of that size."""
    base = {**ELASTIC, "Domain/Lower corner": "-1, -2", "Domain/Upper corner": "1, 2", "Domain/Cells": "81, 161", "Cracks/Segments": "-0.3,0 ; 0.3,0", "Models": FE,
            BC + "Displacement": "top: free, 0 ; corner: 0, free", BC + "Parts": "corner: point -1, 2", "Output/Probes": "", "Material/Poisson ratio": "0"}
    hung = run_scene(HEAT, {**base, "Initial and source/Body force": "0, -0.5"})
    pulled = run_scene(HEAT, {**base, BC + "Traction": "bottom: 0, -1"})
    check_close(intensity(hung, FE), intensity(pulled, FE), relative=0.01, what="K under the own weight and under a traction")


def direction(nodes, damage, tip, side, shown=0.35, clear=0.006):
    """Angle to x, in degrees, of the straight line fitted (total least squares) to the damaged nodes further than `clear` beside a notch along x that ends at tip; side: 1 above, -1 below."""
    import numpy as np

    beyond = (nodes - np.array(tip)) * np.array([1, side])
    beyond = beyond[(damage > shown) & (beyond[:, 1] > clear)]
    along = np.linalg.svd(beyond - beyond.mean(0))[2][0]
    return math.degrees(math.atan2(abs(along[1]), along[0] * np.sign(along[1])))


def kalthoff_halves():
    """Half of the plate by a plane of symmetry breaks as the whole one. Notches lie between rows of cell centres, so that both have the same lattice."""
    import h5py

    angles, broken = [], []
    half = {"Domain/Lower corner": "0, 0", BC + "Symmetry": "bottom", "Cracks/Segments": "0,0.025 ; 0.05,0.025", BC + "Parts": "blow: left if y < 0.025"}
    for more, rows in (({}, 64), (half, 32)):
        run = run_scene("prm/fracture/kalthoff_winkler.prm", {"Domain/Cells": f"32, {rows}", "Peridynamics/Surface correction": "auto", "Output/Fields": "hdf5",
                                                              "Output/Write every": "", **more})
        with h5py.File(os.path.join(run.folder, run.summary["fields"][-1]["files"][PD])) as file:
            angles.append(direction(file["nodes"][:], file["damage"][:].ravel(), (0.05, 0.025), 1))
        broken.append(run.model(PD)["energy balance"]["broken bonds"])
    check(broken[1] > 500, f"bonds break: {broken}")
    print(f"Kalthoff and Winkler, whole plate and half of it: {angles[0]:.2f} and {angles[1]:.2f} degrees, {broken[0]} and {broken[1]} bonds")
    # Measured: 47.62 on both lattices; 2617 and 1303 bonds.
    check_close(angles[1], angles[0], absolute=1, what="angle of the crack, half and whole plate")


def kalthoff(quiet):
    """Both cracks run outward, mirrored, at the angle of experiment and published computations, 65 to 70 degrees."""
    import h5py
    import numpy as np

    run = run_scene("prm/fracture/kalthoff_winkler.prm", {"Output/Fields": "hdf5", "Domain/Cells": "50, 101", "Output/Write every": ""})
    with h5py.File(os.path.join(run.folder, run.summary["fields"][-1]["files"][PD])) as file:
        nodes, damage = file["nodes"][:], file["damage"][:].ravel()
    angles = []
    for side in (1, -1):
        broken = nodes[(damage > 0.35) & (side * nodes[:, 1] > 0.027)]
        tip = broken[np.argmax(side * broken[:, 1])]
        angles.append(math.degrees(math.atan2(side * tip[1] - 0.025, tip[0] - 0.05)))
    check_close(angles[0], angles[1], absolute=1e-6, what="the cracks are mirrored")
    check_close(angles[0], 67, absolute=8, what="angle of the cracks")  # measured: 61 here, 65 on the scene's own lattice


if __name__ == "__main__":
    run_parts(loads, whole, heat, meshes, motion, holes, scenes)
