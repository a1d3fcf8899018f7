# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Moduli and thermal expansion that depend on the temperature, against closed forms.

    warm_moduli.py held | field | bars | motion | plastic | mistakes
"""

import math

from scene_test import COUPLED, FE, PD, Comparison, check_less, check_message, run_parts, run_scene, scene_text

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
WARMING = {"Elasticity/Temperature change": "computed", "Initial and source/Source": "300*t", "Time/End time": "1", "Time/Time step": "0.05"}
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
    table = Comparison("Held bodies, stress by E(T), nu(T), alpha(T)")
    bonds = {"Elasticity/Model": "bond-based", "Models": "peridynamics"}
    strain = {"Elasticity/Plane": "strain"}
    cases = (("stress", {}, 1), ("stress", NODAL, 1), ("stress", bonds, 1), ("stress", WARMING, 1), ("strain", strain, 2), ("strain", {**strain, **NODAL}, 2), ("space", SPACE, 2), ("space", {**SPACE, **NODAL}, 2))
    for name, settings, n in cases:
        run = run_scene(HOT, settings)
        T = 150 if settings is WARMING else 300
        exact = -young(T) * free_strain(T) / (1 - n * poisson(T))
        for model in (PD,) if "Models" in settings else (FE, PD):
            row = run.rows(model)[-1]
            for column in ("sxx", "szz") if n == 2 else ("sxx",):
                table.add(f"{name}, {settings.get('Elasticity/Model', model)}, T = {T}, {column}", row[column], exact, relative=1e-10)
    table.show()


FIELD = {"Material/Young modulus": "1000*(1.1 - T/400)", "Boundary conditions/Displacement": "left: 0, 0", "Boundary conditions/Traction": "right: 2, 1", "Output/Probes": "0.55,0.55 ; 1.9,0.1", "Solver/Tolerance": "1e-12"}
BY_HEAT = {"Elasticity/Temperature change": "computed", "Elasticity/Reference temperature": "20", "Boundary conditions/Dirichlet": "left: 20 ; right: 320", "Time/Steady": "true"}


def field():
    """A temperature that is computed, linear in space, and the same one given: matrices and springs that are made anew are those that are made at first."""
    table = Comparison("A plate that is warm at one end: computed and given temperature")
    for more, ranks in (({}, 1), ({"Models": "peridynamics"}, 4), (NODAL, 1), ({"Elasticity/Model": "bond-based", "Models": "peridynamics"}, 1), ({"Models": "peridynamics", "Elasticity/Plane": "strain", "Peridynamics/Surface correction": "none"}, 1)):
        # T is the change where it is given, which is 20 less.
        given = {key: value.replace("T", "(T + 20)") for key, value in (("Material/Young modulus", FIELD["Material/Young modulus"]), ("Material/Thermal expansion", ALPHA), ("Material/Poisson ratio", NU))}
        runs = [run_scene(HOT, {**FIELD, **BY_HEAT, **more}, ranks=ranks), run_scene(HOT, {**FIELD, **given, "Elasticity/Temperature change": "150*x", **more})]
        for model in (PD,) if more else (FE, PD):
            for column in ("ux", "uy", "sxx", "szz"):
                values = [[row[column] for row in run.rows(model)] for run in runs]
                scale = max(map(abs, values[1])) or 1
                gap = max(abs(a - b) for a, b in zip(*values)) / scale
                # Formulas of elements are asked a little inside of cells (1e-7 of them).
                table.add_limit(f"{more.get('Elasticity/Model', model)}, {more.get('Elasticity/Plane', 'stress')}, {ranks} processes, {column}", gap, 1e-6 if model == FE and column == "sxx" else 1e-11)
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
Models = coupled
Domain/Lower corner = 0, 0
Domain/Upper corner = 2, 1
Domain/Cells = 24, 12
Domain/Nodes = vertices
Material/Young modulus = 200*(1.2 - T/1000)
Material/Poisson ratio = 0.3
Elasticity/Temperature change = 250*x
Boundary conditions/Symmetry = left, bottom
Boundary conditions/Traction = right: 2, 0
Coupling/Zone = if(x > 0.7 && x < 1.3, 1, -1)
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
        table.add(f"finite elements, {cells} cells", run.probe(FE, (1,), column="ux"), exact, relative=0.6 / cells**2) # measured: 0.39 / cells^2
        table.add(f"peridynamics, {cells} cells", run.probe(PD, (1,), column="ux"), exact, relative=0.007 / cells) # measured: 0.0045 / cells and less
    check_less(abs(gaps[2] / gaps[1]), 0.5, "gap of peridynamics at half the horizon, over that before")
    # Zones beside elements have the moduli of the temperature, as a formula of x gives them.
    for scheme, more in (("exchange", {}), ("blending", {}), ("blending", {"Elasticity/Model": "correspondence"})):
        settings = {"Coupling/Scheme": scheme, **more}
        by_place = {"Material/Young modulus": "200*(1.2 - 250*x/1000)", "Elasticity/Temperature change": "0"}
        ends = [run_scene(LAMINA, {**settings, **by}).probe(COUPLED, (2, 0.5), column="ux") for by in ({}, by_place)]
        table.add(f"coupled, {scheme} {more}", *ends, relative=1e-12)
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
        table.add(f"{model}, steps", warm.model(model)["steps"], cold.model(model)["steps"], absolute=1)
    table.show()


PLASTIC = {**WARMING, "Initial and source/Source": "if(t < 1, 300, -300)", "Time/End time": "2", "Time/Time step": "0.05", "Material/Poisson ratio": "0.3", "Material/Law": "plastic", "Material/Yield stress": "1.2 - 0.002*T",
           "Material/Hardening modulus": "50", "Elasticity/Solver": "newton", "Output/Write every": "0.2", "Solver/Tolerance": "1e-12"}


def plastic():
    """Plates held in plane stress, heated and cooled as a whole: yield by equal stresses, of strains alpha(T) dT, by E(T) and the yield stress of T."""
    table = Comparison("Heated, yielding, cooled, of moduli of T")
    stress, strain, kappa = {}, 0.0, 0.0
    for k in range(1, 41):
        T = 300 * 0.05 * min(k, 40 - k)
        stiffness = young(T) / 0.7
        trial = -stiffness * (free_strain(T) + strain)
        over = abs(trial) - (1.2 - 0.002 * T) - 50 * kappa
        if over > 0:
            grown = over / (0.5 * stiffness + 50)
            kappa += grown
            strain += math.copysign(0.5 * grown, trial)
        stress[round(0.05 * k, 10)] = -stiffness * (free_strain(T) + strain)
    for more, ranks in (({}, 1), (NODAL, 1), ({"Models": "peridynamics"}, 2)):
        run = run_scene(HOT, {**PLASTIC, **more}, ranks=ranks)
        for model in (PD,) if more else (FE, PD):
            for time in (0.2, 0.6, 1.0, 1.4, 2.0):
                table.add(f"{more.get('Elasticity/Model', model)}, {ranks} processes, t = {time}", run.rows(model, time=time)[0]["sxx"], stress[time], relative=1e-8)
    table.show()


CLOSED = {**{f"Boundary conditions/{entry}": "" for entry in ("Symmetry", "Convection")}, "Models": "peridynamics", "Domain/Lower corner": "0, 0", "Domain/Upper corner": "2, 1", "Domain/Cells": "20, 10", "Material/Thermal expansion": "0",
          "Material/Poisson ratio": "0.2", "Material/Conductivity": "1", "Cracks/Segments": "1,0.2 ; 1,0.8", "Boundary conditions/Dirichlet": "top: 1000 ; bottom: 1000", "Boundary conditions/Displacement": "left: 0, 0",
          "Boundary conditions/Traction": "right: -1, 0", "Elasticity/Temperature change": "computed", "Elasticity/Reference temperature": "0", "Time/Steady": "true", "Output/Probes": "1.975,0.475 ; 0.725,0.475", "Output/Fields": "none"}


def stiffer():
    """Bodies that get stiffer or softer than they were at the reference: closed cracks, and solvers, follow."""
    table = Comparison("Pressed on a crack, E = 100 to 1100: displacement times E")
    scale = {name: value for name, value in (("1000*(1.1 - T/1000)", 100), ("1000*(0.1 + T/1000)", 1100))}
    for solver in ("linear", "adaptive dynamic relaxation", "dynamic relaxation"):
        settings = {**CLOSED, "Elasticity/Solver": solver, "Solver/Tolerance": "1e-10", **({} if solver == "linear" else {"Domain/Cells": "8, 4", "Output/Probes": "1.9,0.4"})}
        places = ((1.975, 0.475), (0.725, 0.475)) if solver == "linear" else ((1.9, 0.4),)
        given = run_scene(HOT, {**settings, "Material/Young modulus": "1000 + 0*T"})
        for modulus, now in scale.items():
            run = run_scene(HOT, {**settings, "Material/Young modulus": modulus})
            for place in places:
                table.add(f"{solver}, E = {now}, at {place}", run.probe(PD, place, column="ux") * now, given.probe(PD, place, column="ux") * 1000, relative=1e-9)
    table.show()


def mistakes():
    """What is refused, in one message."""
    cases = (
        ({"Elasticity/Temperature change": "0"}, ("Young modulus", "depends on T", "Temperature change")),
        ({"Material/Young modulus": "1000 + t"}, ("Young modulus", "depends on t", "x, y, z, T")),
        ({"Material/Young modulus": "1000*(1 - T/300)"}, ("Young modulus", "Material", "T = 300", "found 0")),
        ({"Material/Young modulus": "1000*(1 - T/100)", **WARMING}, ("Young modulus", "Material", "T = ", "found -")),
        ({"Material/Poisson ratio": "T/500"}, ("Poisson ratio", "T = 300", "0.6")),
        ({"Material/Law": "viscoelastic", "Material/Relaxation": "0.5, 1", "Elasticity/Plane": "strain", "Models": "peridynamics"}, ("depends on T", "viscoelastic", "linear", "plastic")),
        ({**WARMING, "Models": "coupled"}, ("depends on T", "coupled")),
        ({**WARMING, "Models": "peridynamics", "Material/Fracture energy": "1"}, ("depends on T", "Fracture energy", "Critical stretch")),
        ({**WARMING, "Models": "peridynamics", "Material/Critical stretch": "1", "Material/Phases/Regions": "a: x - 1", "Material/Phases/Young modulus": "a: 1000", "Material/Interfaces": "a/elsewhere: fracture energy 1"}, ("depends on T", "Interfaces", "Critical stretch")),
    )
    for settings, words in cases:
        check_message(run_scene(HOT, settings, expect_error=True), *words, what=str(settings))


if __name__ == "__main__":
    run_parts(held, field, bars, motion, plastic, stiffer, mistakes)
