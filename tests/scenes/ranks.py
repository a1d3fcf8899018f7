# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Results on 1, 2 and 4 processes.

Peridynamics with steps of a fixed size (euler, rk4, rkc2 with a given step) and with chebyshev: the same digits in probes.csv and line.csv.
Finite elements: 1e-12 of the largest value, since their sums are taken in another order. Adaptive and implicit steps and steady
states: 1e-8 at a solver tolerance of 1e-12.

    ranks.py [plates] [bodies] [others] [implicit] [quick]
"""

import os
import sys

from scene_test import check, finish, print_table, run_scene, scene_text, write_file
from scene_texts import mesh_text

PLATE = scene_text("""
Dimension = 2
Domain/Lower corner = 0, 0
Domain/Upper corner = 1.2, 1
Domain/Cells = 24, 20
Material/Conductivity = 1.5
Initial and source/Initial value = x*y
Initial and source/Source = 3*x
Boundary conditions/Dirichlet = top: 1 + x; left: 2*y
Boundary conditions/Flux = right: 0.5*y
Boundary conditions/Convection = bottom: 2, 0.3
Cracks/Segments = 0.2,0.31 ; 0.9,0.73
Peridynamics/Boundary treatment = none
Output/Fields = none
Output/Probes = 0.3,0.35 ; 0.31,0.62 ; 1.17,0.04
Output/Line = 0,0.5 ; 1.2,0.47 ; 23
Solver/Tolerance = 1e-12
Time/End time = 0.02
Time/Tolerance = 1e-6
""")

BODY = scene_text("""
Dimension = 3
Domain/Lower corner = 0, 0, 0
Domain/Upper corner = 1, 1, 0.8
Domain/Cells = 10, 10, 8
Boundary conditions/Dirichlet = top: 1 + x; bottom: 0
Boundary conditions/Flux = front: x
Cracks/Polygons = 0.21,0.5,0.2 ; 0.81,0.5,0.2 ; 0.81,0.5,0.63 ; 0.21,0.5,0.63
Peridynamics/Boundary treatment = none
Peridynamics/Horizon ratio = 2
Output/Fields = none
Output/Probes = 0.5,0.52,0.33 ; 0.9,0.1,0.7
Output/Line = 0.5,0,0.4 ; 0.5,1,0.4 ; 11
Solver/Tolerance = 1e-12
Time/End time = 0.02
Time/Tolerance = 1e-6
""")

BAR = scene_text("""
Dimension = 1
Domain/Upper corner = 2
Domain/Cells = 80
Initial and source/Source = sin(x)
Boundary conditions/Dirichlet = left: 1
Boundary conditions/Flux = right: 2
Peridynamics/Boundary treatment = none
Output/Fields = none
Output/Probes = 0.333 ; 1.9
Output/Line = 0 ; 2 ; 31
Time/End time = 0.1
Time/Tolerance = 1e-6
""")

FIXED = {"euler": {"Time/Stepper": "euler", "Time/Time step": "2e-4"},
         "rk4": {"Time/Stepper": "rk4", "Time/Time step": "3e-4"},
         "rkc2, fixed": {"Time/Stepper": "rkc2", "Time/Time step": "0.002"},
         "chebyshev": {"Time/Stepper": "chebyshev"}}
ADAPTIVE = {"rkc2, adaptive": {"Time/Stepper": "rkc2"}, "sdirk2": {"Time/Stepper": "sdirk2", "Time/Tolerance": "1e-4"},
            "bdf2": {"Time/Stepper": "bdf2", "Time/Time step": "0.001"},
            "crank nicolson": {"Time/Stepper": "crank nicolson", "Time/Time step": "0.001"}, "steady": {"Time/Steady": "true"}}

ROWS = []


def texts(run, model):
    """The rows of a model in probes.csv and line.csv, as they stand there."""
    lines = []
    for name in ("probes.csv", "line.csv"):
        with open(os.path.join(run.folder, name)) as file:
            lines += [line.strip() for line in file if f",{model}," in line]
    return lines


def gap(first, second):
    """Largest difference of the values over the largest value."""
    a = [float(line.rsplit(",", 1)[1]) for line in first]
    b = [float(line.rsplit(",", 1)[1]) for line in second]
    return max(abs(x - y) for x, y in zip(a, b)) / max(abs(x) for x in a)


def compare(what, scene, overrides, bounds, form=None, ranks=(2, 4)):
    """Run on one and on several processes; bounds: largest gap for each model, 0 for the same digits."""
    alone = run_scene(scene, {"Models": ", ".join(bounds), **overrides})
    if form is not None:
        found = alone.model("peridynamics")["operator form"]
        check(found == form, f"{what}: the operator form is {found}, not {form}")
    for n in ranks:
        run = run_scene(scene, {"Models": ", ".join(bounds), **overrides}, ranks=n)
        for model, bound in bounds.items():
            here, there = texts(alone, model), texts(run, model)
            equal = here == there and len(here) > 0
            difference = 0.0 if equal else gap(here, there)
            ok = equal if bound == 0 else difference <= bound
            check(ok, f"{what}, {model}, {n} processes: {'other digits, ' if bound == 0 else ''}relative gap {difference:.3g}")
            ROWS.append((what, model, str(n), "same digits" if equal else f"{difference:.2g}",
                         "same digits" if bound == 0 else f"{bound:.0e}"))


BOTH = {"peridynamics": 0, "finite elements": 1e-12}


def plates(only=None):
    for name, choice in FIXED.items():
        for place in ("vertices", "cell centers"):
            for form in ("lattice", "stored"):
                if only and (name, place, form) not in only:
                    continue
                compare(f"plate, {name}, {place}, {form}", PLATE,
                        {**choice, "Domain/Nodes": place, "Peridynamics/Operator form": form}, BOTH, form)


def bodies():
    for name in ("euler", "chebyshev"):
        choice = dict(FIXED[name])
        if name == "euler":
            choice["Time/Time step"] = "1e-3"
        for place in ("vertices", "cell centers"):
            for form in ("lattice", "stored"):
                compare(f"3D, {name}, {place}, {form}", BODY,
                        {**choice, "Domain/Nodes": place, "Peridynamics/Operator form": form}, BOTH, form)


def mesh_file(n=9):
    """A Gmsh file of n x n distorted quadrilaterals on the unit square; boundary ids 1 left, 2 right, 3 bottom, 4 top."""
    def place(i, j):
        x, y = i / n, j / n
        bump = 0.3 / n * (16 * x * (1 - x) * y * (1 - y))
        return x + bump * ((7 * i + 3 * j) % 5 - 2) / 2, y + bump * ((3 * i + 5 * j) % 7 - 3) / 3
    node = [[1 + i + (n + 1) * j for j in range(n + 1)] for i in range(n + 1)]
    elements = []
    for k in range(n):
        elements += [f"1 2 1 1 {node[0][k]} {node[0][k + 1]}", f"1 2 2 2 {node[n][k]} {node[n][k + 1]}",
                     f"1 2 3 3 {node[k][0]} {node[k + 1][0]}", f"1 2 4 4 {node[k][n]} {node[k + 1][n]}"]
    for j in range(n):
        for i in range(n):
            elements.append(f"3 2 9 9 {node[i][j]} {node[i + 1][j]} {node[i + 1][j + 1]} {node[i][j + 1]}")
    nodes = ["%.16g %.16g" % place(i, j) for j in range(n + 1) for i in range(n + 1)]
    return write_file("distorted.msh", mesh_text(nodes, elements))


def others():
    for form in ("lattice", "stored"):
        compare(f"bar, euler, {form}", BAR, {**FIXED["euler"], "Peridynamics/Operator form": form}, BOTH, form)
        compare(f"bar, chebyshev, {form}", BAR, {**FIXED["chebyshev"], "Peridynamics/Operator form": form}, BOTH, form)
    compare("bar, layer extrapolation, rkc2, fixed", BAR,
            {**FIXED["rkc2, fixed"], "Peridynamics/Flux treatment": "layer extrapolation"}, {"peridynamics": 0})
    for place in ("vertices", "cell centers"):
        mirror = {"Peridynamics/Boundary treatment": "fictitious mirror", "Domain/Nodes": place}
        compare(f"plate, mirror, chebyshev, {place}", PLATE, {**FIXED["chebyshev"], **mirror}, {"peridynamics": 0})
        compare(f"plate, mirror, rk4, {place}, graded", PLATE,
                {**FIXED["rk4"], **mirror, "Material/Conductivity": "1 + x/2"}, {"peridynamics": 0})
        compare(f"3D, mirror, chebyshev, {place}", BODY, {**FIXED["chebyshev"], **mirror}, {"peridynamics": 0})
    slaves = {"Peridynamics/Boundary treatment": "fictitious mirror", "Peridynamics/Flux treatment": "extrapolation",
              "Domain/Nodes": "cell centers"}
    compare("plate, mirror, flux extrapolation, rkc2, fixed", PLATE, {**FIXED["rkc2, fixed"], **slaves}, {"peridynamics": 0})
    compare("plate, moving values, euler", PLATE,
            {**FIXED["euler"], "Boundary conditions/Dirichlet": "top: cos(40*t) + x; left: 2*y"}, BOTH)
    compare("plate, crack on faces, chebyshev", PLATE,
            {**FIXED["chebyshev"], "Cracks/Mesh": "faces", "Cracks/Segments": "0.2,0.5 ; 0.9,0.5"}, BOTH)
    compare("plate with a hole, chebyshev", PLATE,
            {**FIXED["chebyshev"], "Domain/Shape": "plate with hole", "Domain/Hole center": "0.6, 0.5", "Domain/Hole radius": "0.22",
             "Output/Line": "", "Output/Probes": "0.1,0.35 ; 0.11,0.62 ; 1.17,0.04", "Output/Line": "0,0.9 ; 1.2,0.9 ; 9",
             "Cracks/Segments": "0.2,0.21 ; 0.9,0.13"}, BOTH)
    # Prime cell counts: too many coarse cells for p4est, so every process keeps all of them.
    compare("plate, 331 x 313 cells, chebyshev", PLATE, {**FIXED["chebyshev"], "Domain/Cells": "331, 313", "Time/End time": "1e-4"}, BOTH)
    mesh = {"Domain/Shape": "mesh file", "Domain/Mesh file": mesh_file(), "Peridynamics/Horizon": "0.35", "Cracks/Segments": "",
            "Boundary conditions/Dirichlet": "4: 1 + x; 1: 2*y", "Boundary conditions/Flux": "2: 0.5*y",
            "Boundary conditions/Convection": "3: 2, 0.3", "Output/Probes": "0.3,0.35 ; 0.91,0.62", "Output/Line": "0,0.5 ; 1,0.47 ; 23"}
    compare("mesh file, chebyshev, vertices", PLATE, {**FIXED["chebyshev"], **mesh}, BOTH, "stored")
    compare("mesh file, euler, cell centers", PLATE, {**FIXED["euler"], **mesh, "Domain/Nodes": "cell centers"}, BOTH, "stored")
    compare("mesh file, steady", PLATE, {**ADAPTIVE["steady"], **mesh}, {"peridynamics": 1e-8, "finite elements": 1e-8})


def coupled():
    """Cells are summed in another order on each number of processes: no same digits."""
    explicit = {"coupled": 1e-12, "peridynamics": 1e-12}
    exchange = {"Peridynamics/Boundary treatment": "exchange"}
    growing = {"Cracks/Growth": "2: 0, 5,3 ; 1: 0.01, -3,-2", "Cracks/Transmission": "0.05"}
    for name in ("euler", "chebyshev"):
        for correction in ("none", "crack scaling"):
            compare(f"plate, coupled, {name}, {correction}", PLATE,
                    {**FIXED[name], **exchange, "Peridynamics/Surface correction": correction}, explicit)
    compare("plate, growing, chebyshev", PLATE, {**FIXED["chebyshev"], **exchange, **growing}, explicit)
    compare("plate, growing, rk4", PLATE, {**FIXED["rk4"], **exchange, **growing}, explicit)
    for scheme in ("blending", "splice"):
        compare(f"plate, {scheme}, euler", PLATE,
                {**FIXED["euler"], "Coupling/Scheme": scheme, "Coupling/Overlap": "1"}, {"coupled": 1e-12})
    compare("3D, coupled, chebyshev", BODY, {**FIXED["chebyshev"], **exchange}, explicit)
    graded = {"Domain/Cells": "48, 40", "Domain/Coarsening": "3"}
    compare("plate, graded, chebyshev", PLATE, {**FIXED["chebyshev"], **graded}, {"coupled": 1e-12})
    compare("plate, adaptive, growing", PLATE,
            {**FIXED["chebyshev"], **graded, **growing, "Coupling/Zone": "adaptive"}, {"coupled": 1e-12})
    # Here cells that might be merged lie on both sides of the processes' borders.
    compare("square, adaptive, growing", "prm/coupling/adaptive_zone.prm",
            {"Domain/Cells": "40, 40", "Domain/Coarsening": "2", "Time/End time": "1", "Output/Write at": "0.38, 0.6", "Output/Line": "-0.9, -0.7 ; 0.9, 0.8 ; 41", "Output/Fields": "none",
             "Solver/Tolerance": "1e-13"}, {"coupled": 1e-12}, ranks=(3, 4))
    solved = {"coupled": 1e-8, "peridynamics": 1e-8}
    compare("plate, coupled, steady", PLATE, {**ADAPTIVE["steady"], **exchange}, solved)
    compare("plate, splice, steady", PLATE, {**ADAPTIVE["steady"], "Coupling/Scheme": "splice"}, {"coupled": 1e-8})
    compare("plate, graded, steady", PLATE, {**ADAPTIVE["steady"], **graded}, {"coupled": 1e-8})
    compare("3D, coupled, steady", BODY, {**ADAPTIVE["steady"], **exchange}, solved)
    compare("square crack in a block", "prm/coupling/square_crack_3d.prm",
            {"Domain/Cells": "20, 20, 20", "Output/Fields": "none", "Solver/Tolerance": "1e-13", "Coupling/Certificate": "false"},
            {"coupled": 1e-10}, ranks=(2,))


def work():
    """Cells are dealt out by what they cost: processes with bonds get fewer of them."""
    heavy = {"Coupling/Zone": "0.6 - x - 0.5*y", "Coupling/Certificate": "false", "Time/Steady": "true"}
    for what, scene, more in (("plate", PLATE, {"Domain/Cells": "96, 80", "Peridynamics/Horizon ratio": "5"}),
                              ("graded plate", PLATE, {"Domain/Cells": "96, 80", "Domain/Coarsening": "3"}),
                              ("body", BODY, {"Domain/Cells": "20, 20, 16", "Peridynamics/Horizon ratio": "2.4"})):
        for n in (2, 4):
            run = run_scene(scene, {"Models": "coupled", **heavy, **more}, ranks=n)
            share = run.model("coupled")["work of the busiest process"]
            check(1 <= share <= 1.2, f"{what}, {n} processes: the busiest has {share:.3f} times the mean work")


def implicit():
    bounds = {"peridynamics": 1e-8, "finite elements": 1e-8}
    for name, choice in ADAPTIVE.items():
        for place in ("vertices", "cell centers"):
            compare(f"plate, {name}, {place}", PLATE, {**choice, "Domain/Nodes": place}, bounds)
    for form in ("lattice", "stored"):
        compare(f"3D, steady, {form}", BODY, {**ADAPTIVE["steady"], "Peridynamics/Operator form": form}, bounds, form)
    compare("3D, sdirk2", BODY, ADAPTIVE["sdirk2"], bounds)
    compare("bar, steady", BAR, {**ADAPTIVE["steady"], "Solver/Tolerance": "1e-12"}, bounds)


def quick():
    """One of each kind."""
    plates({("chebyshev", "vertices", "lattice"), ("euler", "cell centers", "stored")})
    compare("3D, chebyshev", BODY, FIXED["chebyshev"], BOTH, ranks=(2,))
    compare("plate, steady", PLATE, ADAPTIVE["steady"], {"peridynamics": 1e-8, "finite elements": 1e-8}, ranks=(2,))
    compare("plate, coupled, chebyshev", PLATE, FIXED["chebyshev"], {"coupled": 1e-12}, ranks=(2,))


def main():
    parts = {"plates": plates, "bodies": bodies, "others": others, "implicit": implicit, "coupled": coupled,
             "work": work, "quick": quick}
    for name in sys.argv[1:] or ("plates", "bodies", "others", "implicit", "coupled", "work"):
        parts[name]()
    print_table("Differences from the run on one process", ("case", "model", "processes", "difference", "allowed"), ROWS)
    finish()


if __name__ == "__main__":
    main()
