# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Solvers of elastic equilibria, and bodies in motion.

    elastic_solvers.py statics   the solvers agree; iterations against L/delta (fine_statics: up to 64)
    elastic_solvers.py waves     wave speed, the exact dispersion of the lattice, orders in time, energies
    elastic_solvers.py round_off what round-off allows is enough, in any units
"""

import math

from scene_test import FE, PD, check, check_close, check_less, check_message, observed_orders, print_table, run_parts, run_scene, scene_text


PLATE = scene_text("""
Title = Plate under its own weight and a pull
Dimension = 2
Physics = elasticity
Models = peridynamics
Domain/Lower corner = 0, 0
Domain/Upper corner = 1, 1
Domain/Cells = 24, 24
Material/Young modulus = 3
Material/Poisson ratio = 0.3
Initial and source/Body force = 0, -0.1
Boundary conditions/Displacement = left: 0, 0
Boundary conditions/Traction = right: 0.1, 0
Solver/Direct solver up to = 200
Output/Fields = none
Output/Line = 0,0.5 ; 1,0.6 ; 25
""")

BAR = scene_text("""
Title = Standing wave in the middle of a long bar
Dimension = 1
Physics = elasticity
Models = peridynamics
Domain/Lower corner = 0
Domain/Upper corner = 400
Domain/Cells = 400
Material/Young modulus = 4
Material/Density = 0.25
Initial and source/Initial displacement = 1e-3*cos(0.6*(x - 200))
Peridynamics/Kernel exponent = 2
Elasticity/Solver = dynamics
Time/End time = 5
Time/Time step = 0.1
Output/Fields = none
Output/Write every = 1
Output/Probes = 200 ; 205
""")


def displacements(run, model=PD):
    """All components along the line."""
    rows = run.rows(model, table="line.csv")
    return [row[column] for row in rows for column in ("ux", "uy") if column in row]


def statics(sizes=(4, 8, 16, 32)):
    """One displacement from all solvers; what they cost."""
    table = []
    reference, growth = None, []
    for size in sizes:
        cells = {"Domain/Cells": f"{3 * size}, {3 * size}"}
        run = run_scene(PLATE, cells)
        reference = displacements(run)
        row = [f"{size}", run.model(PD)["iterations"]]
        if size >= 8:
            growth.append(row[1])
        for name, largest, more in (("conjugate gradients", 64, {}), ("conjugate gradients", 64, {"Elasticity/Preconditioner": "none"}),
                                    ("adaptive dynamic relaxation", 16, {}), ("dynamic relaxation", 4, {})):
            if size > largest:
                row.append("-")
                continue
            run = run_scene(PLATE, {**cells, "Elasticity/Solver": name, **({"Solver/Tolerance": "1e-8"} if "relaxation" in name else {}), **more})
            row.append(run.model(PD)["iterations"])
            check_close(displacements(run), reference, relative=1e-5 if "relaxation" in name else 1e-7, what=f"L/delta = {size}, {name} {more or ''}")
        table.append(row)
    print_table("Iterations against L/delta (m = 3; relaxations to 1e-8, the others to 1e-10)",
                ("L/delta", "linear", "nonlinear CG, multigrid", "nonlinear CG", "adaptive relaxation", "relaxation"), table)
    check_less(max(growth) / min(growth), 1.5, "iterations of the linear solver, largest over smallest")
    # large displacements
    bend = {"Domain/Upper corner": "1, 0.25", "Domain/Cells": "48, 12", "Elasticity/Kinematics": "full", "Elasticity/Solver": "conjugate gradients",
            "Boundary conditions/Displacement": "left: 0, 0; right: free, 0.4", "Boundary conditions/Traction": "", "Initial and source/Body force": "",
            "Output/Line": "0,0.1 ; 1,0.2 ; 25"}
    bent = run_scene(PLATE, bend)
    relaxed = run_scene(PLATE, {**bend, "Elasticity/Solver": "adaptive dynamic relaxation", "Solver/Tolerance": "1e-8"})
    straight = run_scene(PLATE, {**bend, "Elasticity/Kinematics": "linear"})
    check_close(displacements(relaxed), displacements(bent), relative=1e-5, what="a bent strip, full kinematics")
    gap = max(abs(a - b) for a, b in zip(displacements(bent), displacements(straight)))
    check(gap > 0.01, f"full and linear kinematics differ by {gap} only")
    print(f"full kinematics: {bent.model(PD)['iterations']} and {relaxed.model(PD)['iterations']} iterations")


def frequency(wave_number, ratio=3.0):
    """omega of a plane wave on the lattice of the bar: conical kernel over r^2, linear volume fraction, spacing 1, E/rho = 16."""
    weight_sum = stiffness = 0.0
    for k in range(1, int(ratio + 1)):
        part = min(1.0, ratio + 0.5 - k)
        shifted = k if k < ratio - 0.5 else k - (1 - part) / 2 if k <= ratio else ratio - part / 2
        weight = (1 - shifted / ratio) / k ** 2 * part
        weight_sum += 2 * weight * k ** 2
        stiffness += 2 * weight * (1 - math.cos(wave_number * k))
    return math.sqrt(2 * 16 * stiffness / weight_sum)


def waves():
    """Speed, dispersion, orders and energies."""
    run = run_scene("prm/elasticity/wave_in_bar.prm", {"Output/Fields": "none"})
    for model, apart in ((FE, 0.011), (PD, 0.04)):
        centres = []
        for t in (0, 5e-5, 1e-4):
            values = run.along_line(model, time=t, column="ux")
            centres.append(sum(k / 400 * u for k, u in enumerate(values)) / sum(values))
        check_close((centres[2] - centres[0]) / 1e-4, 5000, relative=1e-12, what=f"{model}: speed of the pulse")
        exact = [1e-6 * math.exp(-((k / 400 - 0.75) / 0.03) ** 2) for k in range(401)]
        check_close(run.along_line(model, time=1e-4, column="ux"), exact, relative=apart, what=f"{model}: pulse after 0.5 m")
        energy = run.model(model)["energy balance"]
        check_less(abs(energy["imbalance"]) / energy["start"], 1e-3, f"{model}: energy")
    # The exact frequency of the lattice, and the exact one of each stepper.
    omega = frequency(0.6)
    for stepper, discrete in (("verlet", 2 / 0.1 * math.asin(0.1 * omega / 2)), ("newmark", 2 / 0.1 * math.atan(0.1 * omega / 2))):
        run = run_scene(BAR, {"Time/Stepper": stepper, "Solver/Tolerance": "1e-13"})
        for t in (1, 3, 5):
            for x in (200, 205):
                check_close(run.probe(PD, (x,), time=t, column="ux"), 1e-3 * math.cos(0.6 * (x - 200)) * math.cos(discrete * t), absolute=1e-12,
                            scale=1e-3, what=f"{stepper}: standing wave at x = {x}, t = {t}")
        check_less(abs(run.model(PD)["energy balance"]["imbalance"]) / run.model(PD)["energy balance"]["start"],
                   1e-10 if stepper == "newmark" else 0.01, f"{stepper}: energy")
        errors = []
        for step in (0.1, 0.05, 0.025):
            run = run_scene(BAR, {"Time/Stepper": stepper, "Time/Time step": str(step), "Solver/Tolerance": "1e-13"})
            errors.append(abs(run.probe(PD, (200,), time=5, column="ux") - 1e-3 * math.cos(omega * 5)))
        check_close(observed_orders([0.1, 0.05, 0.025], errors), [2, 2], absolute=0.05, what=f"{stepper}: order in time")


CANTILEVER = scene_text("""
Dimension = 2
Physics = elasticity
Models = finite elements
Domain/Upper corner = 100, 1
Domain/Cells = 200, 2
Material/Poisson ratio = 0.3
Boundary conditions/Displacement = left: 0, 0
Elasticity/Solver = conjugate gradients
Elasticity/Preconditioner = none
Time/Time step = 1
Time/End time = 1
Output/Fields = none
""")


def round_off():
    """
    A slender cantilever moves 1e6 times as far as its cells stretch: residuals, found anew each 50 iterations, fall to some 1e-8. The support
    bears the load, and the displacement is that of a direct solution.
    """
    said = "the residual of an equilibrium fell no further than to"
    for modulus in (1., 1e-3, 2e11, 1e15):
        load = 1e-9 * modulus
        scene = {"Material/Young modulus": f"{modulus:g}", "Boundary conditions/Traction": f"right: 0, {load:g}*t"}
        case = f"E = {modulus:g}"
        run = run_scene(CANTILEVER, {**scene, "Solver/Maximum iterations": "30000"})
        direct = run_scene(CANTILEVER, {**scene, "Elasticity/Preconditioner": "multigrid", "Solver/Tolerance": "1e-7"})
        check(sum(said in note and "'Tolerance' = 1e-10" in note for note in run.summary["notes"]) == 1, f"{case}: one note")
        check(not any(said in note for note in direct.summary["notes"]), f"{case}: no note where the tolerance is reached")
        check_close(run.total("force on left in y", FE), -load, relative=1e-6, what=f"{case}: force on the support")
        check_close(run.total("strain energy", FE), direct.total("strain energy", FE), relative=1e-5, what=f"{case}: strain energy")
        # Far above round-off it remains an error.
        stopped = run_scene(CANTILEVER, {**scene, "Solver/Maximum iterations": "900"}, expect_error=True)
        check_message(stopped, "stopped after 900 iterations", "'Tolerance'")


if __name__ == "__main__":
    run_parts(statics, waves, round_off, fine_statics=lambda: statics((4, 8, 16, 32, 64)))
