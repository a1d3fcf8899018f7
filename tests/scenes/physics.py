# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Moisture and electricity: the same equations under their own names.

    physics.py moisture          weight gain of a slab against the closed form (Diyaroglu 2017, example D), of the same thickness, but narrower
    physics.py moisture_fine     the slab as published
    physics.py electricity       two conductors in series and in parallel
    physics.py names             fields, totals and summary
"""

import math
import os

import h5py

from scene_test import Comparison, check, print_table, run_parts, run_scene

SLAB = "prm/papers/diyaroglu_2017/example_d.prm"
PUBLISHED_SLAB = "prm/papers/diyaroglu_2017/example_d_paper.prm"
# Cells of the slab, and bounds on the gaps of the published settings.
AS_PUBLISHED = (315, 283, 9), {5: 0.16, 20: 0.07, 60: 0.0105, 120: 3.5e-4}  # measured 0.123, 0.0517, 0.00707, 2.3e-4
NARROW = (84, 75, 9), {5: 0.15, 20: 0.06, 60: 0.008, 120: 2.4e-4}  # measured 0.117, 0.0456, 0.00552, 1.58e-4
CURRENT = "prm/electricity/two_phases.prm"


def rows_of(run, quantity):
    """Time, model and value of a quantity in totals.csv."""
    with open(os.path.join(run.folder, "totals.csv")) as file:
        rows = [line.strip().split(",") for line in file][1:]
    return {(row[1], float(row[0])): float(row[3]) for row in rows if row[2] == quantity}


def slab_weight(time, sizes):
    """Of an eighth of the slab, whose sizes are given: what is missing is a product of three series."""
    missing = 1.0
    for length in (2 * size for size in sizes):
        missing *= sum(8 / ((2 * n + 1) * math.pi) ** 2 * math.exp(-0.01026 * ((2 * n + 1) * math.pi / length) ** 2 * time)
                       for n in range(20000))
    return 0.0125 * math.prod(sizes) * (1 - missing)


def moisture(cells=NARROW[0], published_gaps=NARROW[1]):
    sizes = (21, 18.85, 0.6) if cells == AS_PUBLISHED[0] else [n / 15 for n in cells]
    slab = {"Domain/Cells": ", ".join(map(str, cells)), "Domain/Upper corner": ", ".join(map(repr, sizes))}
    table = Comparison("Weight of an eighth of the slab in mg, against the closed form")
    rows = []
    for treatment, scene, more in (("fictitious mirror", SLAB, {}),
                                   ("fictitious constant", SLAB, {"Peridynamics/Boundary treatment": "fictitious constant"}),
                                   ("as published", PUBLISHED_SLAB, {})):
        run = run_scene(scene, {**slab, **more})
        weights = rows_of(run, "weight")
        for time in (5, 20, 60, 120):
            found, exact = weights["peridynamics", time], slab_weight(time, sizes)
            rows.append((treatment, time, found, exact, found / exact - 1))
            if treatment == "fictitious mirror":
                table.add(f"mirror, {time} h", found, exact, relative=0.01)
            elif treatment == "as published":
                table.add(f"as published, {time} h", found, exact, relative=published_gaps[time])
    check(abs(rows[4][-1]) > 5 * abs(rows[0][-1]), "the constant layer is much worse than the mirror at 5 h")
    print_table("Both fictitious layers", ("treatment", "hours", "weight", "exact", "relative gap"), rows)
    table.show()


def electricity():
    table = Comparison("Total current through two conductors")
    for name, region, rule, current in (("series", "copper: y > 0", "harmonic", 200 * 2 / (1 + 1 / 100)),
                                        ("parallel", "copper: x > 0", "arithmetic", 200 / 2 * (1 + 100))):
        for nodes in ("vertices", "cell centers"):
            # At vertices an interface through nodes is of neither phase: an odd number of cells for
            # peridynamics, an even one for elements.
            for model, cells in (("finite elements", 40), ("peridynamics", 40 if nodes == "cell centers" else 41)):
                run = run_scene(CURRENT, {"Models": model, "Domain/Nodes": nodes, "Domain/Cells": f"{cells}, {cells}", "Output/Fields": "none",
                                          "Material/Interface rule": rule, "Material/Phases/Regions": region})
                flux = run.model(model)["boundary flux"]
                table.add(f"{name}, {model}, {nodes}: top", flux["top"], current, relative=1e-8)
                table.add(f"{name}, {model}, {nodes}: bottom", flux["bottom"], -current, relative=1e-8)
    table.show()


def names():
    run = run_scene(CURRENT, {})
    check(run.summary["physics"] == "electricity" and run.summary["steady"], "without capacitance the run is steady")
    check(run.summary["names"]["field"] == "potential" and run.summary["units"]["field"] == "V", "names and units of electricity")
    check(("peridynamics", 0.0) in rows_of(run, "current through top"), "totals.csv has the current through an electrode")
    run_charging = run_scene(CURRENT, {"Material/Heat capacity": "2", "Time/End time": "0.1", "Output/Fields": "none"})
    check(not run_charging.summary["steady"], "with capacitance the run is transient")
    wet = run_scene(SLAB, {"Models": "finite elements, peridynamics", "Domain/Cells": "20, 18, 6", "Domain/Nodes": "vertices",
                           "Peridynamics/Horizon": "2.2", "Peridynamics/Boundary treatment": "none", "Output/Fields": "hdf5",
                           "Boundary conditions/Symmetry": "", "Material/Saturated concentration": "0.01 + 0.001*x"})
    for model, series in (("finite elements", "finite_elements"), ("peridynamics", "peridynamics")):
        folder = os.path.join(wet.folder, "fields")
        path = sorted(name for name in os.listdir(folder) if name.startswith(series) and name.endswith(".h5"))[-1]
        with h5py.File(os.path.join(folder, path)) as file:
            check({"wetness", "concentration", "moisture_flux"} <= set(file), f"{model}: fields are {sorted(file)}")
            wetness, concentration = file["wetness"][:].ravel(), file["concentration"][:].ravel()
            x = file["nodes"][:, 0]
        # Fields are written in single precision.
        gap = max(abs(c - (0.01 + 0.001 * p) * w) for c, w, p in zip(concentration, wetness, x))
        check(gap < 1e-8, f"{model}: concentration is wetness times the saturated one, gap {gap:.2g}")
        check((model, 120.0) in rows_of(wet, "weight"), f"{model}: weight in totals.csv")


if __name__ == "__main__":
    run_parts(moisture, electricity, names, moisture_fine=lambda: moisture(*AS_PUBLISHED))
