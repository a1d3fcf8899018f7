# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Finite elements that yield: limit load of a ring, bars in two and three dimensions, other solvers, meshes with hanging nodes, cracks, phases, motion.

    yielding_elements.py ring       limit pressure, what is dissipated, processes, another solver, degree 2
    yielding_elements.py bars       stress over strain against a closed form, there and back
    yielding_elements.py bodies     hanging nodes, phases, a crack on faces of cells
    yielding_elements.py motion     a bar that is struck
"""

import math

from scene_test import FE, Comparison, check, check_close, check_less, run_parts, run_scene, scene_text

RING = "prm/elasticity/yielding_ring.prm"
LIMIT = 2 / math.sqrt(3) * math.log(2)
YOUNG, POISSON, YIELD = 1000.0, 0.3, 1.0


def pressures(run, cells):
    """Of a bore whose quarter has so many straight edges, between the times of totals.csv, from the work: forces at nodes of planes of symmetry have a part of what pulls there."""
    rows = [(row["time"], row["value"]) for row in run.totals if row["quantity"] == "work of loads and supports"]
    area = cells * math.sin(math.pi / 2 / cells)  # of the quarter, over half a radius squared
    return {after[0]: (after[1] - before[1]) / (widening(after[0]) - widening(before[0])) / area for before, after in zip(rows, rows[1:])}


def widening(time):
    return 0.001 * (0.5 * time if time < 2 else time - 1 if time < 5 else 4 * time - 16 if time < 10 else 24 - 0.5 * (time - 10))


def ring():
    coarse = {"Domain/Refinements": "3", "Output/Line": ""}
    run = run_scene(RING)
    found = pressures(run, 48)
    table = Comparison("a ring that yields: pressure over yield stress")
    # Lame, plane strain: u(a) = p (1 + nu)/E a^2/(b^2 - a^2) ((1 - 2 nu) a + b^2/a); between these times the mean.
    elastic = 1e-3 / ((1 + POISSON) / YOUNG / 3 * (1 - 2 * POISSON + 4))
    table.add("elastic, bore widened by 0.000125", found[0.5], 0.125 * elastic, relative=2e-3)
    table.add("limit", found[10], LIMIT, relative=5e-4)
    table.add("earlier at the limit", found[9], LIMIT, relative=5e-4)
    table.add("0.00025 back, elastic", found[10.5], found[10] - 0.125 * elastic, relative=1e-3)
    table.add("limit, 8 cells of degree 2 across", pressures(run_scene(RING, {**coarse, "Finite elements/Degree": "2"}), 24)[10], LIMIT, relative=5e-5)
    once = run_scene(RING, coarse)
    eight = pressures(once, 24)[10]
    table.add("limit, 8 cells across", eight, LIMIT, relative=2e-3)
    gradients = run_scene(RING, {**coarse, "Elasticity/Solver": "conjugate gradients"})
    table.add("conjugate gradients", pressures(gradients, 24)[10], eight, relative=1e-6)
    for ranks in (2, 4):
        several = run_scene(RING, coarse, ranks=ranks)
        table.add(f"{ranks} processes", pressures(several, 24)[10], eight, relative=1e-7)
        moved = "displacement of 0 in x"
        table.add(f"{ranks} processes, {moved}", several.total(moved, FE), once.total(moved, FE), relative=1e-9)
    table.show()
    energy = run.model(FE)["energy balance"]
    check(energy["dissipated by the law"] > 0.9 * energy["work"], f"dissipated: {energy}")
    check_less(abs(energy["imbalance"]), 1e-3 * energy["work"], "balance of energy")
    largest = max(row["von_mises"] for row in run.line)
    check(0.999 * YIELD < largest < (1 + 1e-10) * YIELD, f"largest von Mises stress along the line: {largest}")


BAR = """
Dimension = {dimension}
Physics = elasticity
Models = finite elements
Domain/Lower corner = 0, 0{zero}
Domain/Upper corner = 2, 1{one}
Domain/Cells = 4, 2{two}
Material/Young modulus = 1000
Material/Poisson ratio = 0.3
Material/Law = plastic
Material/Yield stress = 1
Material/Hardening modulus = 50
Elasticity/Solver = newton
Boundary conditions/Symmetry = left, bottom{back}
Boundary conditions/Displacement = right: 0.002*min(t, 10 - t), free{free}
Time/End time = 8
Time/Time step = 0.25
Output/Write every = 1
Output/Fields = none
"""


def bar(dimension, overrides=None, ranks=1):
    """Run a bar that is pulled to 5 times the strain at which it yields, and pushed back until it yields again."""
    in_space = dimension == 3
    more = {"dimension": dimension, "zero": ", 0", "one": ", 1", "two": ", 2", "back": ", back", "free": ", free"}
    if not in_space:
        more.update(zero="", one="", two="", back="", free="")
    return run_scene(scene_text(BAR.format(**more)), overrides, ranks=ranks)


def uniaxial(strains, hardening):
    """Stresses of a bar with isotropic hardening."""
    plastic = kappa = 0.0
    stresses = []
    for strain in strains:
        trial = YOUNG * (strain - plastic)
        over = abs(trial) - YIELD - hardening * kappa
        if over > 0:
            grown = over / (YOUNG + hardening)
            kappa += grown
            plastic += math.copysign(grown, trial)
        stresses.append(YOUNG * (strain - plastic))
    return stresses


def bars():
    table = Comparison("bars: force at the end")
    times = [0.25 * k for k in range(1, 33)]
    expected = uniaxial([0.001 * min(t, 10 - t) for t in times], 50)
    for dimension, degree in ((2, 1), (2, 2), (3, 1)):
        run = bar(dimension, {"Finite elements/Degree": str(degree)})
        for time in (1, 2, 5, 6, 8):
            table.add(f"{dimension}D, degree {degree}, t = {time}", run.total("force on right in x", FE, time), expected[4 * time - 1], relative=1e-8)
        energy = run.model(FE)["energy balance"]
        check_less(abs(energy["imbalance"]), 0.02 * energy["work"], "balance of energy")
    table.show()


def bodies():
    stress = uniaxial([0.001 * k / 4 for k in range(1, 21)], 50)
    notched = bar(2, {"Domain/Cells": "8, 4", "Cracks/Segments": "0.5,1 ; 0.5,0.5", "Time/End time": "5"})
    check(0.4 * stress[-1] < notched.total("force on right in x", FE) < 0.9 * stress[-1], "force of a notched bar")
    halves = bar(2, {"Material/Yield stress": "if(x > 1, 2, 1)", "Time/End time": "1"})
    check_close(halves.total("force on right in x", FE), stress[3], relative=1e-8, what="two yield stresses, elastic")
    layers = bar(2, {"Material/Phases/Regions": "hard: y - 0.5", "Material/Phases/Yield stress": "hard: 1e6", "Material/Phases/Hardening modulus": "hard: 0", "Time/End time": "5"})
    check_close(layers.total("force on right in x", FE), 0.5 * stress[-1] + 0.5 * YOUNG * 0.005, relative=1e-8, what="a half that stays elastic")
    graded = bar(2, {"Domain/Cells": "16, 8", "Domain/Coarsening": "1", "Domain/Fine where": "0.6 - x", "Time/End time": "5"})
    check_close(graded.total("force on right in x", FE), stress[-1], relative=1e-8, what="hanging nodes")
    for ranks in (2, 4):
        check_close(bar(2, {"Domain/Cells": "16, 8", "Domain/Coarsening": "1", "Domain/Fine where": "0.6 - x", "Time/End time": "5"}, ranks).total("force on right in x", FE), stress[-1], relative=1e-8, what=f"{ranks} processes")


def motion():
    struck = bar(2, {"Elasticity/Plane": "strain", "Elasticity/Solver": "dynamics", "Material/Density": "1.0", "Material/Hardening modulus": "0", "Boundary conditions/Displacement": "",
                     "Boundary conditions/Velocity": "right: 0.1*min(1, 20*t), free", "Time/End time": "0.3", "Time/Time step": "auto", "Output/Write every": "0.1"})
    energy = struck.model(FE)["energy balance"]
    check(energy["dissipated by the law"] > 0.3 * energy["work"], f"dissipated in motion: {energy}")
    check_less(abs(energy["drift"]), 0.02 * energy["work"], "energy drift")


if __name__ == "__main__":
    run_parts(ring, bars, bodies, motion)
