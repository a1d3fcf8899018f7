# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Moduli and thermal expansion that depend on the temperature, against closed forms.

    warm_moduli.py held | bars | motion | plastic | mistakes
"""

import math

from scene_test import COUPLED, FE, PD, Comparison, run_parts, run_scene, scene_text
from scene_test import check_message

E, ALPHA, NU = "1000*(1.1 - T/1000)", "1e-5*(1 + T/500)", "0.25 + T/5000"
HOT = scene_text(f"""
Dimension = 2
Physics = elasticity
Models = finite elements, peridynamics
Domain/Lower corner = 0, 0
Domain/Upper corner = 2, 1
Domain/Cells = 8, 4
Material/Young modulus = {E}
Material/Poisson ratio = {NU}
Material/Thermal expansion = {ALPHA}
Elasticity/Temperature change = 300
Boundary conditions/Displacement = left: 0, 0; right: 0, 0; bottom: 0, 0; top: 0, 0
Output/Probes = 1,0.5
Output/Fields = none
Solver/Tolerance = 1e-13
""")
WARMING = {"Elasticity/Temperature change": "computed", "Initial and source/Source": "300*t", "Time/End time": "2", "Time/Time step": "0.02", "Output/Write every": "1"}
NODAL = {"Elasticity/Model": "correspondence", "Models": "peridynamics"}
SPACE = {"Dimension": "3", "Domain/Lower corner": "0, 0, 0", "Domain/Upper corner": "1, 1, 1", "Domain/Cells": "4, 4, 4", "Output/Probes": "0.5,0.5,0.5",
         "Boundary conditions/Displacement": "left: 0, 0, 0; right: 0, 0, 0; bottom: 0, 0, 0; top: 0, 0, 0; front: 0, 0, 0; back: 0, 0, 0"}


def young(T):
    return 1000 * (1.1 - T / 1000)


def poisson(T):
    return 0.25 + T / 5000


def free_strain(T, T_ref=0):
    return 1e-5 * (1 + T / 500) * (T - T_ref)


def held():
    """Bodies that are held on all sides: E alpha dT over 1 - nu in plane stress, over 1 - 2 nu where strains out of the plane are held, too."""
    table = Comparison("Held bodies, stress over that of E(T), nu(T), alpha(T)")
    cases = (("stress", {}, 1), ("strain", {"Elasticity/Plane": "strain"}, 2), ("space", SPACE, 2), ("stress, 2 processes", {"ranks": 2}, 1))
    for name, sides, n in cases:
        sides = dict(sides)
        ranks = sides.pop("ranks", 1)
        for more in ({}, NODAL, {"Elasticity/Model": "bond-based", "Models": "peridynamics"}):
            if name != "stress" and "bond-based" in more.values():
                continue # their Poisson ratio is 1/3 in plane stress, their stiffness here that of the moduli
            for by, T in ((WARMING, 150), ({}, 300)):
                if name == "space" and by:
                    by = {**by, "Time/End time": "1", "Time/Time step": "1"}
                run = run_scene(HOT, {**sides, **more, **by}, ranks=ranks)
                exact = -young(T) * free_strain(T) / (1 - n * poisson(T))
                for model in (PD,) if more else (FE, PD):
                    rows = [row for row in run.rows(model) if not by or abs(row["time"] - 1) < 1e-9]
                    what = f"{name}, {more.get('Elasticity/Model', model)}, {'computed' if by else 'given'}"
                    table.add(what, rows[0]["sxx"], exact, relative=1e-8 if by else 1e-10)
                    if name == "strain" and not more.get("Elasticity/Model") == "bond-based":
                        table.add(what + ", szz", rows[0]["szz"], exact, relative=1e-8 if by else 1e-10)
    table.show()


BAR = scene_text(f"""
Dimension = 1
Physics = elasticity
Models = finite elements, peridynamics
Domain/Lower corner = 0
Domain/Upper corner = 1
Domain/Cells = 80
Material/Young modulus = 200*(1.2 - T/1000)
Material/Poisson ratio = 0.3
Material/Thermal expansion = {ALPHA}
Elasticity/Temperature change = 800*x^2
Boundary conditions/Displacement = left: 0
Boundary conditions/Traction = right: 2
Output/Probes = 1
Output/Fields = none
Solver/Tolerance = 1e-12
""")
LAMINA = scene_text(f"""
Dimension = 2
Physics = elasticity
Models = finite elements, peridynamics, coupled
Domain/Lower corner = 0, 0
Domain/Upper corner = 2, 1
Domain/Cells = 32, 16
Domain/Nodes = vertices
Material/Young modulus = 200*(1.2 - T/1000)
Material/Poisson ratio = 0.3
Elasticity/Temperature change = 250*x
Boundary conditions/Symmetry = left, bottom
Boundary conditions/Traction = right: 2, 0
Coupling/Zone = if(x > 0.7 and x < 1.3, 1, -1)
Output/Probes = 2,0.5
Output/Fields = none
""")


def bars():
    """The elongation is the integral of stress/E(T(x)) and of the thermal strain."""
    table = Comparison("Bars whose temperature varies along them: displacement of the end")
    n = 2000
    points = [(k + 0.5) / n for k in range(n)]
    exact = sum(2 / (200 * (1.2 - 0.8 * x * x)) + free_strain(800 * x * x) for x in points) / n
    gaps = []
    for cells in (40, 80, 160):
        run = run_scene(BAR, {"Domain/Cells": str(cells)})
        gaps.append(run.probe(PD, (1,), column="ux") / exact - 1)
        table.add(f"finite elements, {cells} cells", run.probe(FE, (1,), column="ux"), exact, relative=0.2 / cells**2)
        table.add(f"peridynamics, {cells} cells", run.probe(PD, (1,), column="ux"), exact, relative=1 / cells)
    table.add("order of peridynamics at least 0.9", min(1, math.log2(abs(gaps[1] / gaps[2])) / 0.9), 1, relative=1e-12)
    for scheme in ("exchange", "blending"):
        run = run_scene(LAMINA, {"Coupling/Scheme": scheme})
        values = {model: run.probe(model, (2, 0.5), column="ux") for model in (FE, PD, COUPLED)}
        table.add(f"{scheme}, end", values[COUPLED], values[FE], relative=0.005)
        table.add("peridynamics, end", values[PD], values[FE], relative=0.01)
    table.show()


WAVE = scene_text("""
Dimension = 1
Physics = elasticity
Models = finite elements, peridynamics
Domain/Lower corner = 0
Domain/Upper corner = 1
Domain/Cells = 60
Material/Young modulus = 1 - T/1000
Material/Poisson ratio = 0.3
Material/Density = 1.0
Elasticity/Solver = dynamics
Elasticity/Temperature change = 0
Initial and source/Initial displacement = 0.001*sin(pi*x)
Boundary conditions/Displacement = left: 0 ; right: 0
Output/Probes = 0.5
Output/Fields = none
""")


def motion():
    """A bar that vibrates between its ends in cos(pi c t), c^2 = E(T)/density: at half the modulus as long as at all of it after sqrt(2) times the time."""
    table = Comparison("Bars that vibrate: displacement in the middle")
    cold = run_scene(WAVE, {"Material/Young modulus": "1", "Time/End time": "0.6"})
    warm = run_scene(WAVE, {"Elasticity/Temperature change": "500", "Time/End time": repr(0.6 * math.sqrt(2))})
    for model in (FE, PD):
        table.add(model, warm.probe(model, (0.5,), column="ux"), cold.probe(model, (0.5,), column="ux"), relative=1e-9)
        table.add(f"{model}, exact", warm.probe(model, (0.5,), column="ux"), 0.001 * math.cos(0.6 * math.pi), relative=0.01)
        steps = [run.model(model)["steps"] if "steps" in run.model(model) else None for run in (cold, warm)]
        print(model, "steps", steps)
    table.show()


PLASTIC = {**WARMING, "Initial and source/Source": "if(t < 1, 300, -300)", "Material/Poisson ratio": "0.3", "Material/Law": "plastic", "Material/Yield stress": "1.2 - 0.002*T",
           "Material/Hardening modulus": "50", "Elasticity/Solver": "newton", "Output/Write every": "0.2"}


def plastic():
    """Plates held in plane stress, heated and cooled as a whole: yield by equal stresses, of strains alpha(T) dT, by E(T) and the yield stress of T."""
    table = Comparison("Heated, yielding, cooled, of moduli of T")
    stress, strain, kappa = {}, 0.0, 0.0
    for k in range(1, 101):
        T = 300 * 0.02 * min(k, 100 - k)
        stiffness = young(T) / 0.7
        trial = -stiffness * (free_strain(T) + strain)
        over = abs(trial) - (1.2 - 0.002 * T) - 50 * kappa
        if over > 0:
            grown = over / (0.5 * stiffness + 50)
            kappa += grown
            strain += math.copysign(0.5 * grown, trial)
        stress[round(0.02 * k, 10)] = -stiffness * (free_strain(T) + strain)
    for more, ranks in (({}, 1), (NODAL, 1), ({"Models": "peridynamics"}, 4)):
        run = run_scene(HOT, {**PLASTIC, **more}, ranks=ranks)
        for model in (PD,) if more else (FE, PD):
            for time in (0.2, 0.6, 1.0, 1.4, 2.0):
                table.add(f"{more.get('Elasticity/Model', model)}, {ranks} processes, t = {time}", run.rows(model, time=time)[0]["sxx"], stress[time], relative=1e-8)
    table.show()


def mistakes():
    """What is refused, in one message."""
    cases = (
        ({"Elasticity/Temperature change": "0"}, ("Young modulus", "depends on T", "Temperature change")),
        ({"Material/Young modulus": "1000 + t"}, ("Young modulus", "depends on t", "x, y, z, T")),
        ({"Material/Young modulus": "1000*(1 - T/300)"}, ("Young modulus", "Material", "T = 300", "found 0")),
        ({"Material/Young modulus": "1000*(1 - T/400)", **WARMING}, ("Young modulus", "Material", "T = ", "found -")),
        ({"Material/Poisson ratio": "T/500"}, ("Poisson ratio", "T = 300", "0.6")),
        ({"Material/Law": "viscoelastic", "Material/Relaxation": "0.5, 1", "Elasticity/Plane": "strain", "Models": "peridynamics"}, ("depends on T", "viscoelastic", "linear", "plastic")),
        ({**WARMING, "Models": "coupled"}, ("depends on T", "coupled")),
        ({**WARMING, "Models": "peridynamics", "Material/Fracture energy": "1"}, ("depends on T", "Fracture energy", "Critical stretch")),
    )
    for settings, words in cases:
        check_message(run_scene(HOT, settings, expect_error=True), *words, what=str(settings))


if __name__ == "__main__":
    run_parts(held, bars, motion, plastic, mistakes)
