# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Elastic bodies at rest: prm/elasticity against closed forms, prm/papers/le_2014 against finite elements that follow the hole.

    elasticity.py bars | plates | thermal | torsion | cells | le_quick | le_holes | le_corner

Bounds that follow from no theory are about 1.5 times the gap that was measured; the comment beside them gives it.
"""

import math
import os
import subprocess
import sys
import tempfile

from scene_test import SOURCE_DIR, Comparison, check, check_message, finish, fitted_order, print_table, run_scene

FEM, PD = "finite elements", "peridynamics"
QUIET = {"Output/Fields": "none", "Solver/Tolerance": "1e-12"}


def run_quietly(name, more=None):
    return run_scene(f"prm/elasticity/{name}.prm", {**QUIET, **(more or {})})


def balanced(table, run):
    """Forces on all sides add up to nothing."""
    for model, entry in run.summary["models"].items():
        forces = entry["force balance"]
        table.add_limit(f"{model}: imbalance of forces / throughput", forces["imbalance"] / forces["throughput"], 1e-9)


def young_and_poisson(run, model, dim):
    """From the slopes of the displacements between the two inner probes, and the mean of the stresses there."""
    a, b = run.rows(model)[:2]
    strain = [(b["u" + c] - a["u" + c]) / (b[c] - a[c]) for c in "xyz"[:dim]]
    return 0.5 * (a["sxx"] + b["sxx"]) / strain[0], -strain[1] / strain[0] if dim > 1 else None


def bars():
    table = Comparison("Bars in tension, E = 200, nu = 0.3, stress 1")
    run = run_quietly("bar_1d")
    # Measured: the softer ends add 1.43e-2 of the length at m = 3 and 100 cells, half of that at 200.
    ends = [r.probe(PD, [1], column="ux") / 5e-3 - 1 for r in (run, run_quietly("bar_1d", {"Domain/Cells": "200"}))]
    table.add("1D, FEM: end displacement", run.probe(FEM, [1], column="ux"), 5e-3, relative=1e-11)
    table.add("1D, PD: strain in the middle", (run.probe(PD, [0.75], column="ux") - run.probe(PD, [0.25], column="ux")) / 0.5, 5e-3, relative=1e-10)
    table.add_limit("1D, PD: end displacement, relative excess", ends[0], 0.0215)
    table.add("1D, PD: ratio of the excess on half the cells", ends[0] / ends[1], 2, relative=0.01)
    balanced(table, run)
    for name, dim, bounds in (("bar_2d", 2, (0.015, 0.011)), ("bar_3d", 3, (0.1, 0.1))):
        run = run_quietly(name)
        far = [2, 1, 1][:dim]
        for column, value in zip(("ux", "uy", "uz"), (0.01, -0.0015, -0.0015)[:dim]):
            table.add(f"{dim}D, FEM: {column} at the far corner", run.probe(FEM, far, column=column), value, relative=1e-8)
        E, nu = young_and_poisson(run, PD, dim)
        table.add(f"{dim}D, PD: Young's modulus inside", E, 200, relative=bounds[0])
        table.add(f"{dim}D, PD: Poisson's ratio inside", nu, 0.3, absolute=bounds[1])
        print(dim, "end displacement", run.probe(PD, far, column="ux") / 0.01 - 1)
        balanced(table, run)
    table.show()


def cells():
    """Cells of ratio 3 : 1: what the directions of a rectangular lattice do to the moduli (a lattice sum done by hand)."""
    table = Comparison("Plate in tension on cells of ratio 3 : 1, bulk")
    for cells_, E, nu in (("40, 60", None, None), ("120, 20", None, None)):
        run = run_quietly("bar_2d", {"Models": PD, "Domain/Cells": cells_, "Peridynamics/Horizon": "0.15", "Peridynamics/Horizon ratio": "3", "Peridynamics/Kernel exponent": "2"})
        print(cells_, young_and_poisson(run, PD, 2))
    table.show()


def plates():
    table = Comparison("Plates against closed forms")
    run = run_quietly("plate_with_hole")
    for model in (FEM, PD):
        for row in run.rows(model):
            r2 = row["x"] ** 2 + row["y"] ** 2
            table.add(f"hole, {model}: sxx at y = {row['y']}", row["sxx"], 1 + 0.5 / r2 + 1.5 / r2 ** 2, relative=0.1)
    balanced(table, run)
    run = run_quietly("cantilever")
    beam = 40 + 1.2 * 10 / (100 / 2.6)
    print("cantilever", beam, *(run.probe(m, (10, 0), column="uy") / beam - 1 for m in (FEM, PD)))
    run1 = run_quietly("cantilever", {"Finite elements/Degree": 1})
    run2 = run_quietly("cantilever", {"Domain/Cells": "200, 20"})
    run4 = run_quietly("cantilever", {"Domain/Cells": "400, 40"})
    print("bilinear", run1.probe(FEM, (10, 0), column="uy") / beam - 1, "PD finer", run2.probe(PD, (10, 0), column="uy") / beam - 1, run4.probe(PD, (10, 0), column="uy") / beam - 1)
    balanced(table, run)
    a, opening = 0.5, 1.1908
    for cells_ in ("40, 200", "80, 400"):
        run = run_quietly("crack", {"Domain/Cells": cells_})
        for model in (FEM, PD):
            s = run.model(model)["boundary force"]["top"][1]
            gap = run.probe(model, (0, 1e-6), column="uy") - run.probe(model, (0, -1e-6), column="uy")
            print("crack", cells_, model, s, gap * 200 / (4 * s * a) / opening - 1)
    balanced(table, run)
    table.show()


def thermal():
    table = Comparison("Layers under change of temperature")
    run = run_quietly("bimetal")
    exact = -24 * 2e-3 / 16.5
    for r in (run, run_quietly("bimetal", {"Models": PD, "Domain/Cells": "320, 40"})):
        for model in r.summary["models"]:
            line = r.rows(model, table="line.csv")
            u = {round(row["x"], 6): row["uy"] for row in line}
            curvature = (u[6.0] - 2 * u[4.0] + u[2.0]) / 4
            print("bimetal", model, curvature / exact - 1)
    for more in ({}, {"Domain/Cells": "360, 60"}, {"Boundary conditions/Displacement": "right: 0, free"}):
        run = run_quietly("laminate", more)
        for model in (FEM, PD):
            print("laminate", more, model, [row["sxx"] for row in run.rows(model)[:2]], "exact", [-1350 / 7, 900 / 7])
    table.show()


def torsion():
    table = Comparison("Torsion of a square bar, edge 1, G = 80, twist 0.01")
    odd = range(1, 60, 2)
    moment = (1 - 192 / math.pi ** 5 * sum(math.tanh(n * math.pi / 2) / n ** 5 for n in odd)) / 3
    shear = 1 - 8 / math.pi ** 2 * sum(1 / (n * n * math.cosh(n * math.pi / 2)) for n in odd)
    for cells_ in (6, 12, 24):
        run = run_quietly("torsion", {"Domain/Cells": f"{cells_}, {cells_}, {cells_}"})
        for model in (FEM, PD):
            torque = 8 * run.model(model)["strain energy"] / 0.005
            print(cells_, model, torque / (moment * 0.8) - 1, run.probe(model, (0.5, 0, 0.25), column="syz") / (shear * 0.8) - 1)
    table.show()


def main():
    parts = {function.__name__: function for function in (bars, cells, plates, thermal, torsion)}
    for name in sys.argv[1:] or parts:
        parts[name]()
    finish()


if __name__ == "__main__":
    main()
