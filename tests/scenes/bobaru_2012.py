# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Examples 1 and 2 of Bobaru and Duangpanya, J. Comput. Phys. 231 (2012), against the published numbers.

    bobaru_2012.py table_1       Table 1, in the settings of the paper and in ours
    bobaru_2012.py rates         Example 1, rates of convergence at four horizon ratios

Differences are those of equation 13, along all nodes of y = 0.5. Beside the published numbers (2 %) stand those of an
independent program with the same settings (numpy, dense slaves, Chebyshev expansion of the exponential): 1e-6.
"""

from scene_test import Comparison, fitted_order, print_table, relative_difference, run_parts, run_scene

PAPER = "prm/papers/bobaru_2012/example_{}_paper.prm"
OURS = "prm/papers/bobaru_2012/example_{}.prm"

TIMES = (0.05, 0.1, 0.2)
TABLE_1 = {60: (0.15741, 0.11342, 0.07517), 120: (0.07927, 0.05301, 0.03203), 240: (0.03474, 0.02302, 0.01881)}
PROGRAM = {60: (0.15767013, 0.11418381, 0.07648648), 120: (0.07955734, 0.05355440, 0.03254523),
           240: (0.03483308, 0.02308076, 0.01848132)}
PROGRAM_OURS = {(6.5, 60): (0.2444739747, 0.1908442595, 0.1510286761), (6.5, 120): (0.1400789912, 0.1048085195, 0.0808324546),
                (6.5, 240): (0.0746767968, 0.0547645475, 0.0417588011), (3, 120): (0.0493559412, 0.0365571092, 0.0284359574)}

# m: published rate, {cells: difference at t = 0.025 of the other program}; the horizons are 13/120,
# 13/240 and 13/480.
RATES = {5.2: (1.087, {48: 0.1200049239, 96: 0.0546361185, 192: 0.0266478269}),
         6.5: (1.112, {60: 0.1589407175, 120: 0.0803278458, 240: 0.0339142673}),
         104 / 15: (1.072, {64: 0.1699944806, 128: 0.0880393993, 256: 0.0383738148}),
         10.4: (0.878, {96: 0.2373242202, 192: 0.1357028573, 384: 0.0690322523})}
RATES_OURS = {(6.5, 60): 0.2444800891, (6.5, 120): 0.1452605046, (6.5, 240): 0.0792520096,
              (3, 60): 0.0978937853, (3, 120): 0.0527062336, (3, 240): 0.0273224574}


def settings(cells, ratio, **more):
    """Overrides: this many cells a side, the line through all nodes of y = 0.5, exact in time unless told otherwise."""
    chosen = {"Models": "peridynamics", "Domain/Cells": f"{cells}, {cells}", "Peridynamics/Horizon ratio": repr(ratio),
              "Output/Fields": "none", "Output/Line": f"0,0.5 ; 1,0.5 ; {cells + 1}", "Time/Tolerance": "1e-11"}
    chosen.update({key.replace("__", "/").replace("_", " "): value for key, value in more.items()})
    return chosen


def differences(run, times):
    return [relative_difference(run.along_line("peridynamics", t), run.along_line("exact", t)) for t in times]


def cost(run):
    """Seconds of set-up and time stepping."""
    wall = run.model("peridynamics")["wall time"]
    return wall["unknowns"] + wall["operator"] + wall["stepper"] + wall["time stepping"]


def table_1():
    published = Comparison("Table 1 of Bobaru and Duangpanya 2012 (paper settings, m = 6.5), against the paper")
    program = Comparison("The same, and our default settings, against an independent program")
    for cells in TABLE_1:
        # The slaves make the operator nonsymmetric; Runge-Kutta at its limit is exact to 1e-9 here.
        run = run_scene(PAPER.format(2), settings(cells, 6.5, Time__Stepper="rk4"))
        for t, value, paper, other in zip(TIMES, differences(run, TIMES), TABLE_1[cells], PROGRAM[cells]):
            published.add(f"horizon 6.5/{cells}, t = {t}", value, paper, relative=0.02)
            program.add(f"paper settings, {cells} cells, t = {t}", value, other, relative=1e-6)
    for (ratio, cells), others in PROGRAM_OURS.items():
        run = run_scene(OURS.format(2), settings(cells, ratio, Peridynamics__Boundary_treatment="none", Boundary_conditions__Symmetry=""))
        for t, value, other in zip(TIMES, differences(run, TIMES), others):
            program.add(f"defaults, m = {ratio}, {cells} cells, t = {t}", value, other, relative=1e-6)
    published.show()
    program.show()


def costs():
    """Table 1 in several settings, and what it costs."""
    rows = []
    for name, scene, ratio, treatment in (("paper, m = 6.5", PAPER, 6.5, "none"), ("defaults, m = 6.5", OURS, 6.5, "none"),
                                          ("defaults, m = 3", OURS, 3, "none"),
                                          ("mirror, m = 3", OURS, 3, "fictitious mirror")):
        for cells in TABLE_1:
            run = run_scene(scene.format(2), settings(cells, ratio, Time__Tolerance="1e-5", Boundary_conditions__Symmetry="",
                                                      Peridynamics__Boundary_treatment=treatment))
            pd = run.model("peridynamics")
            rows.append((name, cells, *[f"{x:.5f}" for x in differences(run, TIMES)], pd["bonds"], pd["stepper"],
                         pd["operator applications"], f"{cost(run):.3f}"))
    print_table("Table 1 in several settings: relative difference, and what it costs with the stepper chosen by auto at 1e-5",
                ("settings", "cells", "t = 0.05", "t = 0.1", "t = 0.2", "bonds", "stepper", "applications", "seconds"), rows)


def rates(fine=False):
    """Without the finest lattice and the rate that needs it, unless fine."""
    published = Comparison("Example 1 of Bobaru and Duangpanya 2012 (paper settings), rates at t = 0.025, against the paper")
    program = Comparison("Differences at t = 0.025, against an independent program")
    for ratio, (rate, others) in RATES.items():
        errors = []
        for cells, other in others.items():
            if cells > 300 and not fine:
                continue
            run = run_scene(PAPER.format(1), settings(cells, ratio, Time__Stepper="rk4", Time__End_time="0.025",
                                                      Output__Write_at=""))
            errors.append(differences(run, [0.025])[0])
            program.add(f"paper settings, m = {ratio:.4g}, {cells} cells", errors[-1], other, relative=1e-6)
        if len(errors) == len(others):
            published.add(f"rate, m = {ratio:.4g}", fitted_order([ratio / cells for cells in others], errors), rate, relative=0.02)
    for (ratio, cells), other in RATES_OURS.items():
        run = run_scene(OURS.format(1), settings(cells, ratio, Time__End_time="0.025", Output__Write_at="",
                                                 Peridynamics__Boundary_treatment="none"))
        program.add(f"defaults, m = {ratio}, {cells} cells", differences(run, [0.025])[0], other, relative=1e-6)
    published.show()
    program.show()


if __name__ == "__main__":
    run_parts(table_1, rates, rates_fine=lambda: rates(True), costs=costs)
