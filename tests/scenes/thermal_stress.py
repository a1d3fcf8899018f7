# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Elastic bodies whose temperature is computed: prm/elasticity/thermal_stress.prm and small plates against closed forms and against the same temperature as a formula.

    thermal_stress.py free | held | formula | strip | cooling | others | ranks | mistakes

Bounds that follow from no theory are at most 1.5 times the gap that was measured; the comment beside them gives it.
"""

import math
import sys

from scene_test import Comparison, check, check_close, check_message, finish, run_scene

FEM, PD = "finite elements", "peridynamics"
QUIET = {"Output/Fields": "none", "Solver/Tolerance": "1e-12"}
SCENE = "prm/elasticity/thermal_stress.prm"

# A plate 2 x 1 whose temperature is 100 at the left end and 300 at the right one; it is without stress at 50.
PLATE = """
set Dimension = 2
set Physics   = elasticity
set Models    = finite elements, peridynamics
subsection Domain
  set Lower corner = 0, -0.5
  set Upper corner = 2, 0.5
  set Cells        = 40, 20
end
subsection Material
  set Young modulus     = 200
  set Poisson ratio     = 0.3
  set Thermal expansion = 1e-5
  set Conductivity      = 7
end
subsection Boundary conditions
  set Displacement = left: -1e-5*100*y^2/2, 0
  set Dirichlet    = left: 100; right: 300
end
subsection Elasticity
  set Temperature change    = computed
  set Reference temperature = 50
end
subsection Time
  set Steady = true
end
subsection Finite elements
  set Degree = 2
end
subsection Output
  set Probes = 1,0 ; 2,0 ; 2,0.5 ; 1.5,0.25
end
"""
# What makes the same temperature of it by a formula.
FORMULA = {"Elasticity/Temperature change": "50 + 100*x", "Elasticity/Reference temperature": "0", "Boundary conditions/Dirichlet": ""}
COLUMNS = ("ux", "uy", "sxx", "syy", "szz", "sxy", "von_mises")


def run_plate(more=None, **arguments):
    return run_scene(PLATE, {**QUIET, **(more or {})}, **arguments)


def numbers(run, model, columns=COLUMNS):
    return [row[c] for row in run.rows(model) for c in columns]


def free():
    """A temperature linear in x makes no stress in a free plate: u_x = alpha (T_0 x + g (x^2 - y^2)/2), u_y = alpha (T_0 + g x) y."""
    table = Comparison("Free plate, temperature linear in x")
    alpha, start, slope = 1e-5, 50, 100
    end = alpha * (2 * start + 2 * slope)
    for number, bound in (("40, 20", 1), ("80, 40", 1)):
        run = run_plate({"Domain/Cells": number})
        for model in (FEM, PD):
            gaps, stresses = [], []
            for row in run.rows(model):
                x, y = row["x"], row["y"]
                gaps += [row["ux"] - alpha * (start * x + slope * (x * x - y * y) / 2), row["uy"] - alpha * (start + slope * x) * y]
                stresses += [row[c] for c in COLUMNS[2:]]
                table.add(f"{number} cells, {model}: temperature at ({x}, {y})", row["temperature"], 100 + 100 * x, relative=1e-9)
            table.add_limit(f"{number} cells, {model}: displacement, largest gap / that of the end", max(map(abs, gaps)) / end, 1e-9 if model == FEM else FREE_PD[number][0])
            table.add_limit(f"{number} cells, {model}: stress, largest / E alpha times the difference of temperatures", max(map(abs, stresses)) / (200 * alpha * 200), 1e-8 if model == FEM else FREE_PD[number][1])
    table.show()


FREE_PD = {"40, 20": (1, 1), "80, 40": (1, 1)}


def held():
    """Between rigid ends: -E alpha times the mean temperature in a bar, over 1 - nu in a plate between four rigid, smooth sides."""
    table = Comparison("Held plates, temperature linear in x")
    bar = {"Dimension": "1", "Domain/Lower corner": "0", "Domain/Upper corner": "2", "Domain/Cells": "40", "Boundary conditions/Displacement": "left: 0; right: 0",
           "Output/Probes": "0.5 ; 1 ; 1.5"}
    sides = {"Boundary conditions/Displacement": "", "Boundary conditions/Symmetry": "bottom, top", "Boundary conditions/Displacement": "left: 0, free; right: 0, free"}
    alpha, start, slope = 1e-5, 50, 100
    for what, more, stress, factor in (("bar", bar, -200 * alpha * 150, 1), ("plate", sides, -200 * alpha * 150 / 0.7, 1.3)):
        run = run_plate(more)
        for model in (FEM, PD):
            for row in run.rows(model):
                x = row["x"]
                if model == PD and x > 1.9:
                    continue  # at the end
                table.add(f"{what}, {model}: sxx at x = {x}", row["sxx"], stress, relative=1e-9 if model == FEM else HELD_PD[what][0])
                table.add(f"{what}, {model}: ux at x = {x}", row["ux"], factor * alpha * slope * (x * x - 2 * x) / 2, absolute=(1e-9 if model == FEM else HELD_PD[what][1]) * factor * alpha * slope / 2)
    table.show()


HELD_PD = {"bar": (1, 1), "plate": (1, 1)}


def formula():
    """The same temperature computed and as a formula: to the tolerance of the solvers."""
    coupled = {"Models": "coupled", "Coupling/Zone": "x - 1", "Finite elements/Degree": "1"}
    full = {"Models": PD, "Elasticity/Kinematics": "full", "Elasticity/Solver": "conjugate gradients", "Material/Thermal expansion": "1e-3"}
    brittle = {"Models": PD, "Boundary conditions/Displacement": "left: 0, 0; right: 0, free", "Material/Thermal expansion": "-1e-5", "Material/Critical stretch": "2.2e-3"}
    for what, more in (("plane stress", {}), ("plane strain", {"Elasticity/Plane": "strain"}), ("cell centres", {"Models": PD, "Domain/Nodes": "cell centers"}),
                       ("linear elements", {"Finite elements/Degree": "1"}), ("coupled", coupled), ("full kinematics", full), ("brittle", brittle)):
        computed, given = run_plate(more), run_plate({**more, **FORMULA})
        for model in given.summary["models"]:
            for columns in (("ux", "uy"), COLUMNS[2:]):
                a, b = (numbers(run, model, columns) for run in (given, computed))
                check_close(b, a, absolute=2e-9 * max(max(map(abs, a)), 200 * 1e-3), what=f"{what}, {model}: {', '.join(columns)}")
            energies = [run.model(model)["strain energy"] for run in (given, computed)]
            print(what, model, energies, [max(abs(x - y) for x, y in zip(numbers(given, model, c), numbers(computed, model, c))) for c in (("ux", "uy"), COLUMNS[2:])])
            check_close(energies[1], energies[0], absolute=1e-9, what=f"{what}, {model}: strain energy")
        if what == "brittle":
            broken = [run.model(PD)["energy balance"]["broken bonds"] for run in (given, computed)]
            check(broken[0] == broken[1] > 0, f"bonds broken: {broken}")


# Half of a plate, thickness 20 mm, in thermal_stress.prm.
YOUNG, EXPANSION, HALF = 7e4, 9e-6, 10


def cooled(x, t):
    """Temperature less that of the air at x, and its mean over the thickness: Carslaw and Jaeger's series."""
    biot, fourier = 2e-4 * HALF / 1e-3, 1e-3 / (2.5e-3 * 0.84) * t / HALF ** 2
    here = mean = 0
    for n in range(60):
        low, high = n * math.pi + 1e-12, n * math.pi + math.pi / 2 - 1e-12
        for _ in range(200):
            z = 0.5 * (low + high)
            low, high = (low, z) if z * math.tan(z) > biot else (z, high)
        c = 100 * 4 * math.sin(z) / (2 * z + math.sin(2 * z)) * math.exp(-z * z * fourier)
        here += c * math.cos(z * x / HALF)
        mean += c * math.sin(z) / z
    return here, mean


def cooling():
    """Far from its end the stress of the plate is E alpha (mean T - T(x)) at each time."""
    table = Comparison("Cooling glass plate")
    run = run_scene(SCENE, QUIET)
    most = YOUNG * EXPANSION * 100
    for t in (5, 30, 100, 400):
        for model in (FEM, PD):
            of_stress, of_temperature, crosswise = [], [], []
            for row in run.rows(model, time=t, table="line.csv"):
                if model == PD and row["x"] > HALF - 0.8:
                    continue  # cut families
                here, mean = cooled(row["x"], t)
                of_temperature.append(abs(row["temperature"] - 20 - here))
                of_stress.append(abs(row["syy"] - YOUNG * EXPANSION * (mean - here)))
                crosswise.append(max(abs(row["sxx"]), abs(row["sxy"])))
            table.add_limit(f"t = {t}, {model}: temperature, largest gap / 100", max(of_temperature) / 100, COOLING[model][0])
            table.add_limit(f"t = {t}, {model}: syy, largest gap / (E alpha 100)", max(of_stress) / most, COOLING[model][1])
            table.add_limit(f"t = {t}, {model}: sxx and sxy / (E alpha 100)", max(crosswise) / most, COOLING[model][2])
        print(t, [(x, YOUNG * EXPANSION * (cooled(x, t)[1] - cooled(x, t)[0])) for x in (0, 5, 8.5, 10)])
        face = run.rows(FEM, point=(10, 10), time=t, table="line.csv")[0]["syy"]
        print(t, face, run.rows(PD, point=(10, 10), time=t, table="line.csv")[0]["syy"])
    table.show()


COOLING = {FEM: (1, 1, 1), PD: (1, 1, 1)}


def strip():
    """A plate that heats itself: T = 20 + Q (L^2 - x^2)/(2 k), a parabola, and E alpha (mean T - T(x))."""
    table = Comparison("Strip with a parabolic temperature")
    source = 2e-3
    run = run_scene(SCENE, {**QUIET, "Time/Steady": "true", "Output/Write at": "", "Initial and source/Source": str(source), "Boundary conditions/Convection": "",
                            "Boundary conditions/Dirichlet": "right: 20", "Elasticity/Reference temperature": "20"})
    top = source * HALF ** 2 / (2 * 1e-3)
    for model in (FEM, PD):
        of_stress, of_temperature = [], []
        for row in run.rows(model, table="line.csv"):
            if model == PD and row["x"] > HALF - 0.8:
                continue
            here = top * (1 - (row["x"] / HALF) ** 2)
            of_temperature.append(abs(row["temperature"] - 20 - here))
            of_stress.append(abs(row["syy"] - YOUNG * EXPANSION * (2 / 3 * top - here)))
        table.add_limit(f"{model}: temperature, largest gap / that of the middle", max(of_temperature) / top, STRIP[model][0])
        table.add_limit(f"{model}: syy, largest gap / (E alpha T)", max(of_stress) / (YOUNG * EXPANSION * top), STRIP[model][1])
    table.show()


STRIP = {FEM: (1, 1), PD: (1, 1)}


def ranks():
    """The same on 1, 2 and 4 processes."""
    small = {**QUIET, "Domain/Cells": "20, 80", "Models": "finite elements, peridynamics"}
    for what, scene, more in (("cooling", SCENE, small), ("steady", PLATE, QUIET), ("coupled", PLATE, {**QUIET, "Models": "coupled", "Coupling/Zone": "x - 1", "Finite elements/Degree": "1"})):
        alone, two, four = (run_scene(scene, more, ranks=n) for n in (1, 2, 4))
        for columns in (("ux", "uy"), ("sxx", "syy", "szz", "sxy", "von_mises"), ("temperature",)):
            a, b, c = ([row[k] for row in run.probes for k in columns] for run in (alone, two, four))
            size = max(map(abs, a))
            print(what, columns, max(abs(x - y) for x, y in zip(a, b)) / size, max(abs(x - y) for x, y in zip(a, c)) / size)
            check_close(b, a, absolute=RANKS * size, what=f"{what}: {', '.join(columns)} on two processes")
            check_close(c, a, absolute=RANKS * size, what=f"{what}: {', '.join(columns)} on four processes")


RANKS = 1e-8


def mistakes():
    """Heat that is missing, entries of heat without a computed temperature."""
    for more, words in (({"Boundary conditions/Dirichlet": ""}, ("Steady", "Dirichlet", "Convection")),
                        ({"Material/Conductivity": "-1"}, ("Conductivity", "greater than 0")),
                        ({"Elasticity/Solver": "dynamics"}, ("Temperature change", "computed", "dynamics")),
                        ({"Elasticity/Temperature change": "1"}, ("Dirichlet", "Temperature change = computed")),
                        ({"Boundary conditions/Dirichlet": "left: log(-1)"}, ("Dirichlet",))):
        for ranks in (1, 2):
            check_message(run_plate(more, ranks=ranks, expect_error=True), *words)


def main():
    for part in sys.argv[1:]:
        {"free": free, "held": held, "formula": formula, "strip": strip, "cooling": cooling, "ranks": ranks, "mistakes": mistakes}[part]()
    finish()


main()
