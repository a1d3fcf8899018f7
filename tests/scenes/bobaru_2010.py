# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""The three bars of Bobaru and Duangpanya, Int. J. Heat Mass Transfer 53 (2010), against the published numbers.

    bobaru_2010.py rates         Examples 1 and 2: 16 published rates at t = 8 s, temperatures of the middle; the two longer horizons
    bobaru_2010.py rates_fine    all horizons
    bobaru_2010.py flux          Example 3: a given flux
"""

import math

from scene_test import Comparison, fitted_order, observed_orders, print_table, run_parts, run_scene

SCENE = "prm/papers/bobaru_2010/example_{}_paper.prm"
RATIOS = (2, 4, 8, 16)
# The horizon is 3 L/200, 3 L/400, 3 L/800: Cells = round(ratio L/horizon), always odd, so that one
# node is the middle.
FINENESS = (200, 400, 800)

PUBLISHED = {(1, "constant"): (1.0104, 1.0132, 1.0109, 1.0104), (1, "conical"): (1.0095, 1.0102, 1.0082, 1.0055),
             (2, "constant"): (1.4824, 1.4982, 1.4914, 1.4811), (2, "conical"): (1.4843, 1.4990, 1.4877, 1.4433)}
MIDDLE = {1: 51.748, 2: 53.063}

# Differences and temperatures of the middle of an independent program (sparse matrix, Chebyshev
# expansion of the exponential).
PROGRAM = {
    (1, "constant", 2): ((1.1275360260e-02, 5.6073813835e-03, 2.8060553144e-03), (51.247982, 51.499315, 51.623373)),
    (1, "constant", 4): ((5.6095376395e-03, 2.8065726171e-03, 1.4008596034e-03), (52.011105, 51.880719, 51.814378)),
    (1, "constant", 8): ((6.4124444839e-03, 3.1743908397e-03, 1.5791180325e-03), (52.677453, 52.216522, 51.983278)),
    (1, "constant", 16): ((8.6635261328e-03, 4.2888906292e-03, 2.1304098045e-03), (53.286497, 52.527557, 52.140032)),
    (1, "conical", 2): ((1.1895278256e-02, 5.9088997876e-03, 2.9547626805e-03), (51.045094, 51.398525, 51.572952)),
    (1, "conical", 4): ((5.3945427469e-03, 2.7014213828e-03, 1.3491722338e-03), (51.616154, 51.681953, 51.714858)),
    (1, "conical", 8): ((3.2451139288e-03, 1.6159044437e-03, 8.0676983250e-04), (52.057890, 51.903433, 51.825761)),
    (1, "conical", 16): ((3.9507823852e-03, 1.9617806010e-03, 9.7637044803e-04), (52.426024, 52.089235, 51.918945)),
    (2, "constant", 2): ((3.1803963057e-04, 1.1158383161e-04, 3.9522191519e-05), (53.286621, 53.174015, 53.118363)),
    (2, "constant", 4): ((1.2878045475e-04, 4.5946285377e-05, 1.6272846813e-05), (52.935475, 52.998391, 53.030388)),
    (2, "constant", 8): ((3.1223432939e-04, 1.1101361365e-04, 3.9413428907e-05), (52.624761, 52.841810, 52.951630)),
    (2, "constant", 16): ((3.6559417210e-04, 1.3050227440e-04, 4.6326302012e-05), (52.339317, 52.696087, 52.878202)),
    (2, "conical", 2): ((4.4335592915e-04, 1.5580800858e-04, 5.5230642254e-05), (53.375675, 53.218293, 53.140523)),
    (2, "conical", 4): ((5.7641551419e-05, 2.0313448815e-05, 7.1501044265e-06), (53.119005, 53.090777, 53.076651)),
    (2, "conical", 8): ((1.0501776513e-04, 3.7247386002e-05, 1.3208170449e-05), (52.915152, 52.988546, 53.025451)),
    (2, "conical", 16): ((1.6061298372e-04, 5.7107237097e-05, 2.0233062184e-05), (52.743409, 52.901866, 52.981981)),
}

# Example 3 at t = 8 s, horizon 3L/800, m = 4: the paper, and an independent program with equation
# 22 (two digits).
FLUX = {"constant": (3.43e-5, 4.4e-5), "conical": (2.84e-5, 4.9e-5)}


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


def as_published(kernel):
    """Half a volume at r = horizon for the constant micro-conductivity; the triangular one is 0 there."""
    return {"Peridynamics__Kernel": kernel, "Peridynamics__Volume_fraction": "linear" if kernel == "constant" else "none"}


def rates(finenesses=FINENESS[:2], middle_gap=2.6e-2):
    published = Comparison("Bobaru and Duangpanya 2010: 16 rates at t = 8 s, against the paper")
    middle = Comparison("Temperature of the middle at t = 8 s, extrapolated to horizon 0 from the two shortest, against the"
                        " classical one")
    program = Comparison(f"Largest relative gap to an independent program, horizons 3L/200 to 3L/{finenesses[-1]}")
    for (example, kernel), wanted in PUBLISHED.items():
        for ratio, rate in zip(RATIOS, wanted):
            errors, middles = [], []
            for fineness in finenesses:
                cells = round(ratio * fineness / 3)
                run = run_scene(SCENE.format(example), settings(cells, ratio, 10, Output__Write_at="8", **as_published(kernel)))
                errors.append(average_difference(run, 8))
                middles.append(run.along_line("peridynamics", 8)[cells // 2])
            name = f"Example {example}, {kernel}, m = {ratio}"
            published.add(name, fitted_order([1 / f for f in finenesses], errors), rate, relative=0.05)
            middle.add(name, 2 * middles[-1] - middles[-2], MIDDLE[example], absolute=middle_gap)
            others = PROGRAM[example, kernel, ratio]
            program.add_limit(f"{name}: middle", max(abs(a / b - 1) for a, b in zip(middles, others[1])), 1e-6)
            # Measured: at most 2.3e-9 and, where the differences themselves are smaller, 9e-7.
            program.add_limit(f"{name}: difference", max(abs(a / b - 1) for a, b in zip(errors, others[0])),
                              1e-8 if example == 1 else 2e-6)
    for table in (published, middle, program):
        table.show()


def flux():
    table = Comparison("Example 3 (given flux), average difference at t = 8 s, horizon 3L/800, m = 4, against an independent program")
    rows = []
    for kernel, (published, other) in FLUX.items():
        errors = {}
        for fineness in FINENESS[1:]:
            cells = round(4 * fineness / 3)
            run = run_scene(SCENE.format(3), settings(cells, 4, math.pi, **as_published(kernel)))
            errors[fineness] = [average_difference(run, t) for t in (0.1, 4, 8)]
            # The layer beside the right end is a straight line of slope 3: equation 22.
            found, step = run.along_line("peridynamics", 8), math.pi / cells
            table.add(f"{kernel}, {cells} cells: slope at the right end", (found[-1] - found[-5]) / (4 * step), 3, relative=1e-8)
        table.add(f"{kernel}: average difference", errors[800][-1], other, absolute=0.05e-5)
        table.add(f"{kernel}: order in the horizon", observed_orders([2, 1], [errors[400][-1], errors[800][-1]])[0], 1.5,
                  absolute=0.05)
        rows.append((kernel, *[f"{x:.2e}" for x in errors[800]], f"{published:.2e}"))
    table.show()
    print_table("The published difference has no time and is not reproduced at any of these",
                ("kernel", "t = 0.1", "t = 4", "t = 8", "published"), rows)


if __name__ == "__main__":
    # What extrapolation leaves is of second order in the horizon; measured, at m = 16: at most
    # 2.1e-2 from the two longer horizons, 4.5e-3 from the two shorter ones.
    run_parts(rates, flux, rates_fine=lambda: rates(FINENESS, 6.5e-3))
