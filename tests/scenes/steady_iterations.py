# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Steady solves at m = 6.5: at most 20 iterations on 60^2 to 480^2 cells, with and without a crack; and the time beside finite elements'."""

import sys

from scene_test import check, check_less, finish, print_table, run_scene

SCENE = "prm/quick_start.prm"


def total(model):
    return sum(model["wall time"].values())


def main():
    sizes = [int(size) for size in sys.argv[1:]] or [60, 120, 240, 480]
    rows = []
    for crack in ("-0.5,0 ; 0.5,0", ""):
        for cells in sizes:
            run = run_scene(SCENE, {"Domain/Cells": f"{cells}, {cells}", "Peridynamics/Horizon ratio": "6.5", "Cracks/Segments": crack,
                                    "Time/Steady": "true", "Output/Write at": "", "Output/Fields": "none", "Output/Line": ""})
            pd, fem = run.model("peridynamics"), run.model("finite elements")
            for name, model in (("peridynamics", pd), ("finite elements", fem)):
                check_less(model["iterations"], 20, f"{name}, {cells}^2 cells, {'crack' if crack else 'no crack'}: iterations")
                balance = model["heat balance"]
                check(abs(balance["imbalance"]) <= 1e-8 * balance["throughput"], f"{name}: heat balance {balance}")
            setup = [sum(time for phase, time in model["wall time"].items() if phase != "solve") for model in (pd, fem)]
            rows.append((f"{cells}^2", "crack" if crack else "none", pd["iterations"], fem["iterations"],
                         setup[0], total(pd) - setup[0], setup[1], total(fem) - setup[1], total(pd) / total(fem)))
    print_table("Steady states at m = 6.5 (times in seconds)",
                ("cells", "crack", "PD iterations", "FEM", "PD set-up", "PD solve", "FEM set-up", "FEM solve", "PD/FEM, all"), rows)
    finish()


if __name__ == "__main__":
    main()
