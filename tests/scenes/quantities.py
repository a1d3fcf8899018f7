# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""`Quantities` and `Totals every` in section `Output`: rows of totals.csv that a scene asks for, more often than fields.

    quantities.py spot | bar | mistakes
"""

import math

from scene_test import BC, COUPLED, FE, PD, Comparison, check, check_message, run_parts, run_scene, scene_text

SPOT = "prm/heat/moving_spot.prm"

# Pulled by 1 along x: u = (x, -0.3 y)/E, E = 200 but for a soft half, u_x = x/100 - 0.5/100 + ... beyond x = 0.5.
BAR = scene_text("""
Dimension = 2
Physics = elasticity
Models = finite elements, peridynamics
Domain/Upper corner = 1, 0.5
Domain/Cells = 16, 8
Material/Young modulus = 200
Material/Poisson ratio = 0
Elasticity/Plane = stress
Boundary conditions/Parts = half: top if x - 0.5 ; corner: region 0.2 - x - y ; tip: point 1, 0.5
Boundary conditions/Symmetry = left, bottom
Boundary conditions/Traction = right: 1, 0
Output/Fields = none
Output/Quantities = far: max ux on right ; near: min ux ; mean: mean ux ; stress: mean von_mises over region x - 0.5 ; work: sum displacement ; upper: mean ux on half ; corner: max ux on corner
""")


def rows(run, quantity, model):
    return {row["time"]: row["value"] for row in run.totals if row["quantity"] == quantity and row["model"] == model}


def spot():
    """Heat that a moving source brings, where it is hottest, and rows between the times of fields; on two processes the same."""
    power = 5 * math.pi * 0.1
    run, two = (run_scene(SPOT, {"Domain/Cells": "40, 16", "Time/End time": "4"}, ranks=n) for n in (1, 2))
    table = Comparison("A moving spot of heat")
    for model in (FE, PD):
        heat, hottest, end = (rows(run, name, model) for name in ("heat", "hottest at x", "end"))
        check(len(heat) == 80 and max(heat) == 4, f"{model}: {len(heat)} rows")
        for t in (1, 2, 4):
            table.add(f"{model}: heat at t = {t}", heat[t], power * t, relative=1e-6)
            check(0.9 + t - 0.5 <= hottest[t] <= 1.01 + t, f"{model}: it is hottest at x = {hottest[t]} at t = {t}")
        check(abs(end[4]) < 1e-6, f"{model}: mean temperature of the end {end[4]}")
        for name in ("hottest", "hottest at x", "hottest at y", "heat", "coldest above"):
            table.add(f"{model}: {name} on 2 processes", rows(two, name, model)[4], rows(run, name, model)[4], absolute=1e-9)
    times = [entry["time"] for entry in run.summary["fields"]]
    check(times == [0, 2, 4], f"times of fields: {times}")
    check(len({row["time"] for row in run.probes}) == 80, "probes have rows at all times of tables")
    check(run.summary["write times"] != [], "times that are written")
    # Both in one list, with times that are equal but for round-off.
    both = run_scene(SPOT, {"Domain/Cells": "10, 4", "Time/End time": "0.6", "Output/Write every": "", "Output/Write at": "0.3, 0.6", "Output/Totals every": "0.1"})
    check(sorted(rows(both, "heat", FE)) == [0.1, 0.2, 0.3, 0.4, 0.5, 0.6], f"{sorted(rows(both, 'heat', FE))}")
    table.show()


def bar():
    """Values of a uniform stress, which linear fields have exactly: of vertices and of cell centres, of sides, parts, regions and phases."""
    table = Comparison("A pulled bar")
    for nodes, more, models in (("vertices", {}, (FE, PD)), ("cell centers", {"Domain/Nodes": "cell centers"}, (PD,)), ("vertices", {"Models": COUPLED, "Coupling/Zone": "x - 0.4"}, (COUPLED,))):
        run = run_scene(BAR, {**more, "Models": more.get("Models", f"{FE}, {PD}")}, ranks=1 if nodes == "vertices" else 2)
        h = 1 / 16 if nodes == "cell centers" else 0
        for model in models:
            bound = 1e-2 if model == PD else 1e-9
            at = {row["quantity"]: row["value"] for row in run.totals if row["model"] == model}
            for name, value in (("far", (1.01 if model == PD else 1) * (1 - h / 2) / 200), ("mean", 0.5 / 200), ("stress", 1), ("work", 0.5 * 0.5 / 200), ("upper", 0.75 / 200)):
                table.add(f"{model}, {nodes}: {name}", at[name], value, relative=bound)
            table.add(f"{model}, {nodes}: near", at["near"], h / 2 / 200, absolute=bound * 1e-3)
            check(at["far at x"] == 1 - h / 2 and (model == PD or at["far at y"] == 0), f"{model}, {nodes}: largest at {at['far at x']}, {at['far at y']}")
    phases = run_scene(BAR, {"Models": FE, "Material/Phases/Regions": "soft: x - 0.51", "Material/Phases/Young modulus": "soft: 100", "Output/Quantities": "soft: max von_mises over soft ; rest: min ux over elsewhere ; far: max ux"})
    at = {row["quantity"]: row["value"] for row in phases.totals}
    table.add("von Mises of a phase", at["soft"], 1, relative=0.2)
    table.add("the rest begins at x = 0", at["rest at x"], 0, absolute=0)
    check(at["far"] > 1.3 / 200, f"a soft half gives more: {at['far']}")
    table.show()


def mistakes():
    of = {"Models": FE}
    for overrides, words in (
            ({"Output/Quantities": "tip: max uz on right"}, ("'Quantities' in section 'Output', 'tip'", "no model has a field 'uz'", "Did you mean 'u")),
            ({"Output/Quantities": "tip: most ux"}, ("unknown name 'most'", "min, max, mean, sum")),
            ({"Output/Quantities": "tip: max"}, ("'tip'", "needs 'name: max FIELD'")),
            ({"Output/Quantities": "tip: max ux at right"}, ("found 'at right'", "'on SIDE'")),
            ({"Output/Quantities": "tip: max ux on rihgt"}, ("'Quantities'", "unknown side 'rihgt'", "Did you mean 'right'")),
            ({"Output/Quantities": "tip: max ux on tip"}, ("'tip' is a point", "Probes")),
            ({"Output/Quantities": "tip: max ux over iron"}, ("'Quantities'", "phase")),
            ({"Output/Quantities": "tip: max ux over region x - 2"}, ("no node of 'finite elements' lies there",)),
            ({"Output/Quantities": "tip: max ux over region x - t"}, ("depends on t",)),
            ({"Output/Quantities": "tip: max ux ; tip: min ux"}, ("'tip' is named twice",)),
            ({"Output/Totals every": "0.1"}, ("'Totals every' in section 'Output'", "steady"))):
        check_message(run_scene(BAR, {**of, **overrides}, expect_error=True), *words)
    for overrides, words in (({"Output/Totals every": "-1"}, ("'Totals every'", "greater than 0")), ({"Output/Totals every": "1e-9"}, ("'Totals every'", "more than 1000000")),
                             ({"Models": "auto"}, ("'auto' does not choose", "Totals every"))):
        check_message(run_scene(SPOT, overrides, expect_error=True), *words)


if __name__ == "__main__":
    run_parts(spot, bar, mistakes)
