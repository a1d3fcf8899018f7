# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Stiffness and wave speed of slender bodies of peridynamics whose bonds may break, or in motion, against rods.

    slender_bodies.py strip | waves | notes
"""

from scene_test import PD, Comparison, check, run_parts, run_scene
from scene_texts import body_of_bonds

BODY = body_of_bonds("""
Output/Fields = none
""", young=1)


def size(dim, thick, long):
    return {"Dimension": str(dim), "Domain/Upper corner": ", ".join([str(long)] + ["1"] * (dim - 1)),
            "Domain/Cells": ", ".join([str(long * thick)] + [str(thick)] * (dim - 1))}


def stiffness(dim, thick, m, more):
    """Force over that of a rod that is pulled by 1e-4; at its ends it is free to contract."""
    long = 10 if dim == 2 else 6
    free, hold, feet = (", free", "p: free, 0", "p: point 0, 0.5") if dim == 2 else \
                       (", free, free", "p: free, 0, 0 ; q: free, free, 0", "p: point 0, 0.5, 0.5 ; q: point 0, 1, 0.5")
    run = run_scene(BODY, {**size(dim, thick, long), "Peridynamics/Horizon ratio": str(m), "Time/Time step": "1", "Time/End time": "1",
                           "Boundary conditions/Parts": feet,
                           "Boundary conditions/Displacement": f"left: 0{free} ; right: {1e-4 * long}*t{free} ; {hold}", **more})
    return max(row["value"] for row in run.totals if row["quantity"].startswith("force") and "right" in row["quantity"]) / 1e-4


def speed(dim, thick, m, more=None):
    """Of the longest standing wave of a free rod: its end passes through 0 after a quarter of the period."""
    long = 8
    rest = ", 0" * (dim - 1)
    run = run_scene(BODY, {**size(dim, thick, long), "Peridynamics/Horizon ratio": str(m), "Elasticity/Solver": "dynamics",
                           "Initial and source/Initial displacement": f"1e-4*cos(pi*x/{long}){rest}",
                           "Output/Probes": "0" + ", 0.5" * (dim - 1), "Output/Write every": str(0.02 * long),
                           "Time/End time": str(0.58 * long), **(more or {})})
    rows = run.rows(PD)
    for one, next_one in zip(rows, rows[1:]):
        if one["ux"] > 0 >= next_one["ux"]:
            part = one["ux"] / (one["ux"] - next_one["ux"])
            return 0.5 * long / (one["time"] + part * (next_one["time"] - one["time"]))
    raise SystemExit("the rod does not swing")


BREAKS = {"Material/Critical stretch": "0.1"}


def strip():
    """Bodies of 4 and 8 cells that are pulled: within 2 % whether or not bonds may break, most of it what the lattice makes of the modulus."""
    table = Comparison("Force over that of a rod")
    for dim, thick, m in ((2, 4, 3), (2, 8, 3), (2, 8, 4), (2, 8, 6), (3, 4, 3)):
        for name, more in (("at rest", {}), ("may break", BREAKS)):
            table.add(f"{dim}D, {thick} cells, m = {m}, {name}", stiffness(dim, thick, m, more), 1, relative=0.02)
    table.add("full kinematics, may break", stiffness(2, 8, 3, {**BREAKS, "Elasticity/Kinematics": "full",
                                                              "Elasticity/Solver": "conjugate gradients"}), 1, relative=0.02)
    table.show()


def waves():
    """The same of waves; cells and vertices."""
    table = Comparison("Speed over that of waves in a rod")
    for dim, thick, m in ((2, 4, 3), (2, 8, 3), (2, 8, 6), (3, 4, 3)):
        for nodes in ("vertices", "cell centers"):
            if dim == 2 or nodes == "vertices":
                table.add(f"{dim}D, {thick} cells, m = {m}, {nodes}", speed(dim, thick, m, {"Domain/Nodes": nodes}), 1, relative=0.01)
    table.add("bonds that may break", speed(2, 8, 3, BREAKS), 1, relative=0.01)
    table.add("full kinematics", speed(2, 8, 3, {"Elasticity/Kinematics": "full"}), 1, relative=0.01)
    table.show()


def notes():
    """What is left where families end is said in figures."""
    run = run_scene(BODY, {**size(2, 4, 10), **BREAKS, "Peridynamics/Surface correction": "none", "Boundary conditions/Symmetry": "left, bottom",
                           "Boundary conditions/Displacement": "right: 1e-3*t, free", "Time/Time step": "1"})
    for word in ("stiffer", "% along x"):
        check(word in run.stdout + run.stderr, f"no note that says {word}:\n{run.stdout[-2000:]}")


if __name__ == "__main__":
    run_parts(strip, waves, notes)
