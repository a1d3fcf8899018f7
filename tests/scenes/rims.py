# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Loads on round and turned holes of lattices are those of the true rim, not of the cells' stairs; thin holes are open all along.

    rims.py heat
    rims.py thin    slits about a cell wide at an angle, stars, ellipses
    rims.py pressed
"""

import math
import re

from scene_test import BC, COUPLED, FE, PD, check, check_close, run_parts, run_scene, scene_text

ALL = f"{FE}, {PD}, {COUPLED}"

HEAT = scene_text("""
Dimension = 2
Models = finite elements, peridynamics, coupled
Domain/Lower corner = -4, -4
Domain/Upper corner = 4, 4
Domain/Cells = 32, 32
Domain/Holes = circle: 0, 0, 1
Boundary conditions/Dirichlet = left: 0; right: 0; top: 0; bottom: 0
Boundary conditions/Flux = hole: 1
Coupling/Zone = 1.5 - sqrt(x^2 + y^2)
Time/Steady = true
Output/Fields = none
""")


def polygon(n, radius, degrees, center=(0, 0)):
    """The text of a hole and its perimeter."""
    corners = [(center[0] + radius * math.cos(math.radians(degrees + 360 * k / n)), center[1] + radius * math.sin(math.radians(degrees + 360 * k / n))) for k in range(n)]
    return "polygon: " + ", ".join(f"{x:.16g}, {y:.16g}" for x, y in corners), 2 * n * radius * math.sin(math.pi / n)


def flows(what, overrides, right, side="hole", relative=1e-9, **more):
    run = run_scene(HEAT, overrides, **more)
    for model in run.summary["models"]:
        check_close(run.model(model)["boundary flux"][side], right, relative=relative, what=f"{what}, {model}: flux through the rim")
    return run


def heat():
    """What enters is the flux times the length of the rim inside the body, whatever its shape and place."""
    flows("circle", {}, 2 * math.pi)
    flows("circle, cell centres", {"Domain/Nodes": "cell centers", "Models": f"{FE}, {PD}"}, 2 * math.pi)
    for degrees in (10, 30, 45, 75):
        hole, perimeter = polygon(4, math.sqrt(2), degrees)
        flows(f"square turned by {degrees - 45} degrees", {"Domain/Holes": hole}, perimeter)
    flows("the hole with entries of its own", {"Domain/Holes": "", "Domain/Shape": "plate with hole", "Domain/Hole center": "0, 0", "Domain/Hole radius": "1",
                                               "Domain/Hole shape": "square", "Domain/Hole angle": "30"}, 8)
    turned = [(2 * c - 0.7 * s, 2 * s + 0.7 * c) for c, s in [(math.cos(0.3), math.sin(0.3))]][0]
    other = [(2 * c + 0.7 * s, 2 * s - 0.7 * c) for c, s in [(math.cos(0.3), math.sin(0.3))]][0]
    flows("rectangle turned", {"Domain/Holes": f"polygon: {turned[0]}, {turned[1]}, {-other[0]}, {-other[1]}, {-turned[0]}, {-turned[1]}, {other[0]}, {other[1]}"}, 10.8)
    flows("several", {"Domain/Holes": "circle: -1.5, 0.3, 0.8 ; circle: 1.5, 0, 0.9 ; rectangle: -0.5, 2, 0.5, 3"}, 2 * math.pi * 1.7 + 4)
    flows("half a circle at the edge", {"Domain/Holes": "circle: 4, 0, 1", BC + "Dirichlet": "left: 0"}, math.pi)
    flows("a quarter at a corner", {"Domain/Holes": "circle: -4, -4, 1.5", BC + "Dirichlet": "right: 0"}, 0.75 * math.pi)
    flows("two circles in one", {"Domain/Holes": "circle: -0.5, 0, 1 ; circle: 0.5, 0, 1"}, 8 * math.pi / 3)
    for a, b in ((0.3, 0.4), (0.7, 0), (0.94, 0.342)):  # a slot with round ends, across and turned
        u = (1 / math.hypot(a, b) * a, 1 / math.hypot(a, b) * b)
        corners = [(x * u[0] - y * u[1], x * u[1] + y * u[0]) for x, y in ((-1, -0.8), (1, -0.8), (1, 0.8), (-1, 0.8))]
        flows("a slot with round ends", {"Domain/Holes": "polygon: " + ", ".join(f"{x:.16g}, {y:.16g}" for x, y in corners)
                                         + "".join(f" ; circle: {s * u[0]:.16g}, {s * u[1]:.16g}, 0.8" for s in (-1, 1))}, 4 + 1.6 * math.pi, relative=1e-6)
    flows("a rectangle on faces", {"Domain/Holes": "rectangle: -1, -0.5, 1.5, 0.5"}, 7, relative=1e-12)
    flows("part of the rim", {BC + "Parts": "half: hole if x + y > 0", BC + "Flux": "half: 1"}, math.pi, side="half")
    # h int (1 - u) with u as it is: the heat through the rim leaves through the sides.
    run = run_scene(HEAT, {BC + "Flux": "", BC + "Convection": "hole: 0.5, 1"})
    for model in run.summary["models"]:
        flow = run.model(model)["boundary flux"]
        check_close(flow["hole"], -sum(flow[side] for side in ("left", "right", "top", "bottom")), relative=1e-6, what=f"{model}: balance with convection")
        # In series: 1/(h 2 pi) and the resistance of the square with a hole, log(1.0787 b / r) / (2 pi).
        check_close(flow["hole"], 2 * math.pi / (2 + math.log(1.0787 * 4)), relative=0.02, what=f"{model}: flow by convection")
    flows("bore", {"Dimension": "3", "Domain/Lower corner": "-2, -2, 0", "Domain/Upper corner": "2, 2, 1.5", "Domain/Cells": "12, 12, 4", "Coupling/Zone": "1.7 - sqrt(x^2 + y^2)"},
          3 * math.pi, ranks=2)
    flows("part of a bore", {"Dimension": "3", "Domain/Lower corner": "-2, -2, 0", "Domain/Upper corner": "2, 2, 1.5", "Domain/Cells": "12, 12, 4", "Models": f"{FE}, {PD}",
                             BC + "Parts": "deep: hole if z < 0.7", BC + "Flux": "deep: 1"}, 1.4 * math.pi, side="deep", relative=6e-3)  # faces that a part cuts in 3D


PULL = scene_text("""
Dimension = 2
Physics = elasticity
Models = finite elements, peridynamics, coupled
Domain/Cells = 24, 24
Material/Young modulus = 1
Material/Poisson ratio = 0.3
Boundary conditions/Displacement = bottom: 0, 0 ; top: 0, 1e-3
Coupling/Zone = everywhere
Output/Fields = none
""")


def slit(length, width, degrees, center=(0, 0)):
    """The text of a slit, and its perimeter."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    corners = [(0.5 * a * length, 0.5 * b * width) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    return "polygon: " + ", ".join(f"{center[0] + x * c - y * s:.16g}, {center[1] + x * s + y * c:.16g}" for x, y in corners), 2 * (length + width)


def thin():
    """What slits part carries nothing, and what enters is the flux times the length of the rim."""
    across = {"Domain/Cells": "24, 24", BC + "Dirichlet": "bottom: 0; top: 1", BC + "Flux": "", "Coupling/Zone": "everywhere"}
    for width in (0.2, 0.7, 1.2):  # cells
        for degrees in (20, 45):
            ranks = 2 if degrees == 20 else 1
            run = run_scene(HEAT, {**across, "Domain/Holes": slit(20, width / 3, degrees, (0.1, 0.05))[0]}, ranks=ranks)
            for model in run.summary["models"]:
                check_close(run.model(model)["boundary flux"]["top"], 0, absolute=1e-9, what=f"{width} cells at {degrees} degrees, {model}: flow")
            if width < 1:
                check("is thin for the cells" in run.stdout + run.stderr, "a note on the slit")
            flows(f"slit of {width} cells at {degrees} degrees", {"Domain/Holes": slit(3.1, width / 4, degrees, (0.1, 0.05))[0]}, slit(3.1, width / 4, degrees)[1], ranks=ranks)
    run = run_scene(PULL, {"Domain/Holes": slit(2.5, 0.8 / 24, 30, (0.51, 0.47))[0]})
    for model in run.summary["models"]:
        check_close(run.total("force on top in y", model), 0, absolute=1e-12, what=f"{model}: force on what a slit parts")
    star = [(r * math.cos(math.radians(18 + 36 * k)), r * math.sin(math.radians(18 + 36 * k))) for k, r in enumerate((2, 0.7) * 5)]
    ellipse = [(2 * math.cos(t) * math.cos(0.5) - 0.1 * math.sin(t) * math.sin(0.5), 2 * math.cos(t) * math.sin(0.5) + 0.1 * math.sin(t) * math.cos(0.5)) for t in (2 * math.pi * k / 60 for k in range(60))]
    for name, corners in (("star", star), ("thin ellipse", ellipse)):
        perimeter = sum(math.dist(a, b) for a, b in zip(corners, corners[1:] + corners[:1]))
        flows(name, {"Domain/Holes": "polygon: " + ", ".join(f"{x:.16g}, {y:.16g}" for x, y in corners)}, perimeter)
    # Each side of a slit has the load of its own rim.
    run = run_scene(HEAT, {"Domain/Holes": slit(20, 0.2, 20, (0.1, 0.05))[0], BC + "Dirichlet": "bottom: 0; top: 0", "Coupling/Zone": "everywhere"})
    for model in run.summary["models"]:
        for side in ("bottom", "top"):
            check_close(-run.model(model)["boundary flux"][side], 8 / math.cos(math.radians(20)), relative=1e-9, what=f"{model}: what one side of a slit has leaves through {side}")


def pressed():
    """Pressure on circular holes of few cells: what is left is told, twofold, at the rim."""
    quarter = {"Domain/Upper corner": "3, 3", "Domain/Holes": "circle: 0, 0, 1", BC + "Displacement": "", BC + "Symmetry": "left, bottom", BC + "Traction": "hole: x, y",
               "Output/Probes": "0, 1", "Models": f"{FE}, {PD}"}

    def wide(cells, **more):
        run = run_scene(PULL, {**quarter, "Domain/Cells": f"{3 * cells}, {3 * cells}", **more})
        return run, {model: run.rows(model)[0]["uy"] for model in run.summary["models"]}

    right = wide(48, Models=FE)[1][FE]
    for cells in (3, 5, 8):
        run, found = wide(cells)
        note = [n for n in run.summary["notes"] if "on its rim" in n]
        said = {model: float(share) / 100 for share, model in re.findall(r"([0-9.]+) % \(([a-z ]+)\)", note[0])}
        for model in (FE, PD):
            gap = found[model] / right - 1
            print(f"  {cells} cells to a radius, {model}: {100 * gap:+.1f} %, told {100 * said[model]:.1f}")
            check(abs(gap) < said[model], f"{cells} cells, {model}: {gap} is more than the note tells: {note}")
        check(found[PD] / right - 1 > 0.5 * said[PD], f"{cells} cells: {found[PD] / right - 1} is less than half of what the note tells: {note}")
    for what, run in (("fine", wide(31)[0]), ("straight", wide(4, **{"Domain/Holes": "rectangle: -1, -1, 1, 1"})[0])):
        check(not any("on its rim" in n for n in run.summary["notes"]), f"no note on {what} rims")


if __name__ == "__main__":
    run_parts(heat, thin, pressed)
