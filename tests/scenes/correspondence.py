# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Correspondence: laws of stresses at the nodes of peridynamics.

    correspondence.py lamina      a lamina off its axes, and the teaching scene
    correspondence.py bodies      a console as by the ordinary solid and elements, rows that are pulled, a warm body in space, cracks
    correspondence.py flow        limit pressure of a ring, a plate that yields on several processes
    correspondence.py motion      speed of waves, energy, processes
    correspondence.py relaxing    a shear modulus that relaxes: closed forms, elements, the ordinary solid, energy, processes, bonds that break
    correspondence.py breaking    bodies whose bonds break, at rest and in motion
    correspondence.py blending    beside finite elements of the same law: laminae, cracks, bodies that yield, waves, bonds that break

Bounds that follow from no theory are about 1.5 times the gap that was measured; the comment beside them gives it.
"""

import math

import blended_breaking
from scene_test import COUPLED, FE, PD, Comparison, check, run_parts, run_scene, scene_text
from yielding import PLATE, RING, ring_mesh, share_lost
from yielding import STRUCK as YIELDING

NODAL = {"Elasticity/Model": "correspondence", "Peridynamics/Horizon ratio": "2", "Peridynamics/Kernel exponent": "auto"}
QUIET = {"Output/Fields": "none"}
TIGHT = {**QUIET, "Solver/Tolerance": "1e-12"}
LAMINA = "prm/elasticity/correspondence_lamina.prm"
LAMINA_CUT = "prm/elasticity/blended_lamina.prm"
STRUCK = "prm/fracture/kalthoff_winkler.prm"
TORN = "prm/fracture/torn_strip.prm"
USER = "prm/elasticity/user_law.prm"

SQUARE = scene_text("""
Dimension = 2
Physics = elasticity
Models = peridynamics
Domain/Lower corner = 0, 0
Domain/Upper corner = 1, 1
Domain/Cells = 24, 24
Elasticity/Plane = stress
Elasticity/Solver = linear
Elasticity/Model = correspondence
Peridynamics/Horizon ratio = 2
Output/Fields = none
""")


def pulled_lamina(angle):
    """A square that is free at three sides, its fibres at an angle: entries, and 1/E along x."""
    E1, E2, G12, nu12 = 150, 10, 5, 0.3
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    # Jones, Mechanics of Composite Materials, 2.8: S_xx, S_xy, S_xs
    along = c**4 / E1 + s**4 / E2 + (1 / G12 - 2 * nu12 / E1) * c**2 * s**2
    across = (1 / E1 + 1 / E2 - 1 / G12) * c**2 * s**2 - nu12 / E1 * (c**4 + s**4)
    shear = (2 / E1 + 2 * nu12 / E1 - 1 / G12) * s * c**3 - (2 / E2 + 2 * nu12 / E1 - 1 / G12) * s**3 * c
    return {"Material/Young moduli": "150, 10", "Material/Shear moduli": "5", "Material/Poisson ratios": "0.3", "Material/Material angle": str(angle),
            "Boundary conditions/Displacement": f"left: {shear / 2}*y, {across}*y", "Boundary conditions/Traction": "right: 1, 0", "Output/Probes": "0.25,0.5 ; 0.75,0.5"}, along


def lamina():
    """1/E along x of a square that is free at three sides, by the angle of its fibres."""
    table = Comparison("a lamina that is pulled off its axes")
    for angle in (0, 15, 30, 45, 90):
        settings, along = pulled_lamina(angle)
        left, right = run_scene(SQUARE, settings).rows(PD)
        table.add(f"{angle} degrees: 1/E", (right["ux"] - left["ux"]) / 0.5, along, relative=0.003)  # measured: 0.2 %
    run = run_scene(LAMINA, QUIET)
    for model in (FE, PD):
        left, right = run.rows(model)
        table.add(f"{LAMINA}, {model}", right["ux"] - left["ux"], 0.05 * 0.04675, relative=1e-3)
    table.show()


CONSOLE = {"Models": "finite elements, peridynamics", "Domain/Cells": "40, 40", "Material/Young modulus": "1", "Material/Poisson ratio": "0.25", "Elasticity/Plane": "strain",
           "Boundary conditions/Displacement": "left: 0, 0", "Boundary conditions/Traction": "right: 0.1*(1 + y), 0.3*y*(1 - y) ; top: 0, 0.8*x*x*(1 - x)*(1 - x)",
           "Output/Probes": "0.25,0.25 ; 0.5,0.5 ; 0.75,0.25 ; 1,0.1 ; 1,0.5 ; 1,0.9"}
HELD = {"Models": "finite elements, peridynamics", "Domain/Cells": "40, 40", "Material/Young modulus": "1", "Material/Poisson ratio": "0.3",
        "Boundary conditions/Displacement": "left: 0, free ; right: 0, free ; bottom: free, 0", "Output/Line": "0,0.5 ; 1,0.5 ; 41"}
BLOCK = scene_text("""
Dimension = 3
Physics = elasticity
Models = finite elements, peridynamics
Domain/Lower corner = 0, 0, 0
Domain/Upper corner = 2, 1, 1
Domain/Cells = 40, 20, 20
Material/Young modulus = 1
Material/Poisson ratio = 0.3
Material/Thermal expansion = 0.01
Elasticity/Temperature change = x
Elasticity/Solver = linear
Elasticity/Model = correspondence
Boundary conditions/Symmetry = left, bottom, back
Peridynamics/Horizon ratio = 2
Output/Fields = none
Output/Probes = 2,1,1 ; 1,0.5,0.5
""")


def alternating(run, model):
    """How much ux goes up and down from node to node along the line."""
    u = run.along_line(model, column="ux")
    return max(abs(u[k - 2] - 4 * u[k - 1] + 6 * u[k] - 4 * u[k + 1] + u[k + 2]) / 16 for k in range(2, len(u) - 2))


def bodies():
    table = Comparison("bodies by correspondence, and in another way")
    nodal, ordinary = (run_scene(SQUARE, {**CONSOLE, "Elasticity/Model": model}) for model in ("correspondence", "state-based"))
    most = max(abs(row["ux"]) for row in ordinary.rows(PD))
    for k, (a, b, c) in enumerate(zip(nodal.rows(PD), ordinary.rows(PD), nodal.rows(FE))):
        table.add(f"console, place {k + 1}, against the ordinary solid", a["ux"], b["ux"], absolute=0.006 * most)  # measured: 0.4 %
        table.add(f"console, place {k + 1}, against elements", a["ux"], c["ux"], absolute=0.012 * most)  # measured: 0.8 %
    for name, force in (("a row", "if(abs(x - 0.5) < 0.01, 4, 0), 0"), ("a node", "if(abs(x - 0.5) < 0.01, if(abs(y - 0.5) < 0.01, 160, 0), 0), 0")):
        run = run_scene(SQUARE, {**HELD, "Initial and source/Body force": force})
        # Measured: 1.3, 1.0.
        table.add_limit(f"{name} that is pulled: up and down, over that of elements", alternating(run, PD) / alternating(run, FE), 2)
    run = run_scene(BLOCK)
    for k, (a, b) in enumerate(zip(run.rows(PD), run.rows(FE))):
        for column in ("ux", "uy"):
            table.add(f"warm block, place {k + 1}, {column}", a[column], b[column], relative=0.022)  # measured: 1.5 %
    cracked = {**HELD, "Boundary conditions/Displacement": "bottom: free, 0 ; top: free, 0.01 ; left: 0, free", "Cracks/Segments": "0,0.51 ; 0.41,0.51"}
    run = run_scene(SQUARE, cracked)
    table.add("cracked square: force", run.total("force on top in y", PD), run.total("force on top in y", FE), relative=0.011)  # measured: 0.7 %
    table.show()


def flow():
    table = Comparison("Bodies that yield, by correspondence")
    limit, mesh = 2 / math.sqrt(3) * math.log(2), ring_mesh()
    # Measured: 0.09 % where families end, -0.71 % where they go on beyond the sides.
    for correction, bound in (("none", 0.002), ("auto", 0.011)):
        run = run_scene(RING, {"Domain/Mesh file": mesh, "Peridynamics/Horizon": "0.1", "Elasticity/Model": "correspondence", "Peridynamics/Surface correction": correction})
        table.add(f"limit pressure of a ring, 'Surface correction = {correction}'", run.total("force on 3 in x", PD), limit, relative=bound)
        table.add_limit("imbalance of energy", share_lost(run), 1e-9)
    runs = {ranks: run_scene(PLATE, {**NODAL, **QUIET, "Solver/Tolerance": "1e-10", "Domain/Cells": "20, 20", "Time/Time step": "0.1"}, ranks=ranks) for ranks in (1, 2, 4)}
    table.add_limit("plate: imbalance of energy", share_lost(runs[1]), 1e-9)
    quantities = ("force on right in x", "strain energy", "energy dissipated by the law")
    for ranks in (2, 4):
        for quantity in quantities:
            table.add(f"{quantity}, {ranks} processes", runs[ranks].total(quantity, PD), runs[1].total(quantity, PD), relative=1e-7)
    table.show()


BAR = {"Domain/Upper corner": "4, 0.4", "Domain/Cells": "80, 8", "Material/Young modulus": "1", "Material/Poisson ratio": "0", "Material/Density": "1.0", "Elasticity/Solver": "dynamics",
       "Boundary conditions/Velocity": "left: 0.01*min(t/0.2, 1), free", "Boundary conditions/Symmetry": "bottom", "Time/End time": "2.5", "Output/Probes": "1,0.2 ; 2,0.2"}


def motion():
    table = Comparison("a bar that is struck")
    runs = {ranks: run_scene(SQUARE, BAR, ranks=ranks) for ranks in (1, 2, 4)}
    first, second = (row["ux"] for row in runs[1].rows(PD, time=2.5))
    table.add("speed of the wave", 0.01 / (first - second), 1, relative=0.005)
    table.add("first place passed after", 2.4 - first / 0.01, 1, relative=0.005)
    work, drift = (runs[1].total(quantity, PD) for quantity in ("work of loads and supports", "energy drift"))
    table.add_limit("drift of energy over work", abs(drift / work), 1e-9)
    for ranks in (2, 4):
        for row, expected in zip(runs[ranks].rows(PD, time=2.5), runs[1].rows(PD, time=2.5)):
            table.add(f"ux at x = {row['x']}, {ranks} processes", row["ux"], expected["ux"], relative=1e-12)
    table.show()
    # A plate that is struck and yields
    struck = [run_scene(PLATE, {**YIELDING, **NODAL}, ranks=ranks) for ranks in (1, 2, 4)]
    for run, ranks in zip(struck[1:], (2, 4)):
        check(run.probes == struck[0].probes, f"the same digits on {ranks} processes")
    heat, work, drift = (struck[0].total(quantity, PD) for quantity in ("energy dissipated by the law", "work of loads and supports", "energy drift"))
    check(heat > 0.2 * work, f"the plate yields: {heat} of {work}")
    check(abs(drift) < 1e-9 * work, f"energy is kept: {drift} of {work}")


RELAXING = {"Material/Law": "viscoelastic", "Material/Relaxation": "0.3, 0.5 ; 0.4, 5", "Elasticity/Plane": "strain"}
HEAT = "energy dissipated by the law"


def of_ramp(t, terms):
    """The integral of the relaxation function of a Prony series, and the integral of that."""
    rest = 1 - sum(share for share, _ in terms)
    once = rest * t + sum(share * time * -math.expm1(-t / time) for share, time in terms)
    twice = rest * t * t / 2 + sum(share * time * (t + time * math.expm1(-t / time)) for share, time in terms)
    return once, twice


def relaxing():
    table = Comparison("correspondence with a shear modulus that relaxes")
    # Uniaxial strain, a ramp, with K = 2 and G = 1: exact in any steps, also of a fluid, whose shares sum up to 1.
    ramp = {**NODAL, **RELAXING, **TIGHT, "Material/Bulk modulus": "2", "Material/Shear modulus": "1", "Domain/Cells": "12, 12", "Boundary conditions/Symmetry": "left, bottom, top",
            "Boundary conditions/Displacement": "right: 0.01*t, free", "Time/End time": "6"}
    for step, terms in (("1.5", [(0.3, 0.5), (0.4, 5)]), ("6", [(0.3, 0.5), (0.4, 5)]), ("6", [(0.3, 0.5), (0.7, 5)])):
        run = run_scene(SQUARE, {**ramp, "Time/Time step": step, "Material/Relaxation": " ; ".join(f"{share}, {time}" for share, time in terms)})
        once, twice = of_ramp(6, terms)
        name = f"uniaxial strain, a ramp, steps of {step}, {terms[1][0]}"
        table.add(f"{name}: force", run.total("force on right in x", PD), 0.01 * (2 * 6 + 4 / 3 * once), relative=1e-12)
        table.add(f"{name}: stored and heat, over work", (run.total("strain energy", PD) + run.total(HEAT, PD)) / (1e-4 * (6 * 6 + 4 / 3 * twice)), 1, absolute=1e-12)
        check(run.total(HEAT, PD) > 0.02 * run.total("strain energy", PD), "the law dissipates")
    # A plate that creeps. (Its corners are stiff.)
    plate = {**NODAL, **QUIET, "Solver/Tolerance": "1e-11", "Domain/Cells": "16, 8", "Time/Time step": "0.5"}
    runs = {ranks: run_scene("prm/elasticity/creeping_plate.prm", {**plate, "Models": f"{FE}, {PD}, {COUPLED}"}, ranks=ranks) for ranks in (1, 2, 4)}
    for model, bound in ((PD, 2e-3), (COUPLED, 5e-5)):  # measured: 1.3e-3, 3.4e-5
        for t in (0, 1, 4):
            extension, of_elements = (runs[1].probe(name, (1, 0.5), time=t, column="ux") for name in (model, FE))
            table.add(f"creep, {model}: extension at t = {t}, over that of elements", extension / of_elements, 1, absolute=bound)
        table.add(f"creep, {model}: force on the plane of symmetry", runs[1].total("force on left in x", model), -0.01, relative=1e-9)
        for ranks in (2, 4):
            for quantity in ("strain energy", HEAT):
                table.add(f"creep, {model}: {quantity}, {ranks} processes", runs[ranks].total(quantity, model), runs[1].total(quantity, model), relative=1e-8)
    # A smooth problem at nu = 1/4, loads that grow.
    console = {**CONSOLE, **RELAXING, "Models": f"{FE}, {PD}", "Time/End time": "2", "Time/Time step": "0.5"}
    nodal, ordinary = (run_scene(SQUARE, {**console, "Elasticity/Model": model}) for model in ("correspondence", "state-based"))
    table.add_limit("console: from the ordinary solid", farthest(nodal, ordinary, (PD, PD)), 1e-2)  # measured: 0.62 %
    table.add_limit("console: from elements", farthest(nodal, nodal, (PD, FE)), 2.2e-2)  # measured: 1.5 %
    # In motion, where the balance of energy is one of second order in the step.
    runs = [run_scene(SQUARE, {**BAR, **RELAXING, "Time/Time step": "0.01", "Time/End time": "1.5"}, ranks=ranks) for ranks in (1, 2)]
    heat, imbalance = (runs[0].total(quantity, PD) for quantity in (HEAT, "energy imbalance"))
    check(heat > 0.1 * runs[0].total("work of loads and supports", PD), "the law dissipates")
    table.add_limit("bar that is struck: imbalance of energy over heat", abs(imbalance / heat), 5e-4)  # measured: 3.3e-4
    for row, expected in zip(runs[1].rows(PD, time=1.5), runs[0].rows(PD, time=1.5)):
        table.add(f"ux at x = {row['x']}, 2 processes", row["ux"], expected["ux"], relative=1e-12)
    # Bonds that break.
    run = run_scene(STRUCK, {**NODAL, **QUIET, **RELAXING, "Material/Relaxation": "0.3, 1e-5", "Domain/Cells": "40, 81"})
    released, imbalance = (run.total(quantity, PD) for quantity in ("energy released by broken bonds", "energy imbalance"))
    check(run.total("broken bonds", PD) > 100, "bonds break")
    table.add_limit("struck plate: what is missing of the energy that is released", abs(imbalance / released), 0.035)  # measured: 2.4 %; the ordinary solid 2.0 %
    table.show()


def breaking():
    table = Comparison("bodies whose bonds break, by correspondence")
    run = run_scene(TORN, {**NODAL, **QUIET})
    for row in run.rows(PD, time=1):
        table.add(f"torn strip: ux at {row['x']}", row["ux"], 0 if row["x"] < 0.5 else 0.02, absolute=1e-5)  # measured: 4.1e-6, what heat strains it by
    runs = {ranks: run_scene(STRUCK, {**NODAL, **QUIET, "Domain/Cells": "40, 81"}, ranks=ranks) for ranks in (1, 2)}
    released, drift, imbalance = (runs[1].total(quantity, PD) for quantity in ("energy released by broken bonds", "energy drift", "energy imbalance"))
    check(runs[1].total("broken bonds", PD) > 300, "bonds break")
    table.add_limit("struck plate: drift of energy over what is released", abs(drift / released), 1e-9)
    table.add_limit("struck plate: what is missing of it", abs(imbalance / released), 0.02)
    table.add("broken bonds on 2 processes", runs[2].total("broken bonds", PD), runs[1].total("broken bonds", PD), absolute=0)
    # In a zone beside elements.
    coarse = {**blended_breaking.COARSE, **NODAL, "Domain/Cells": "21, 31", "Time/Time step": "0.05", "Time/End time": "0.6", "Elasticity/Breaking": "at rest", "Coupling/Certificate": "false"}
    alone, everywhere, follow = (run_scene(blended_breaking.SCENE, {**coarse, **more}) for more in (blended_breaking.ALONE, {"Coupling/Zone": "everywhere"}, {}))
    broken, dissipated = "broken bonds", "energy dissipated"
    check(alone.total(broken, PD) > 100, f"bonds break: {alone.total(broken, PD)}")
    table.add("zone everywhere: broken bonds", everywhere.total(broken, COUPLED), alone.total(broken, PD), absolute=0)
    table.add("zone everywhere: energy dissipated", everywhere.total(dissipated, COUPLED), alone.total(dissipated, PD), relative=1e-7)
    table.add("zone that follows: broken bonds", follow.total(broken, COUPLED), alone.total(broken, PD), relative=0.02)
    table.add("zone that follows: energy dissipated", follow.total(dissipated, COUPLED), alone.total(dissipated, PD), relative=0.02)
    table.show()


BLENDED = {"Models": COUPLED, "Coupling/Scheme": "blending", "Coupling/Overlap": "1", "Coupling/Certificate": "false"}
DISC = {**BLENDED, "Coupling/Zone": "0.25 - sqrt((x - 0.5)^2 + (y - 0.5)^2)"}
RIM = {**BLENDED, **NODAL, "Domain/Nodes": "vertices", "Coupling/Zone": "1.15 - sqrt(x^2 + y^2)"}


def farthest(run, other, models):
    """Of displacements at the probes, over the largest."""
    pairs = list(zip(run.rows(models[0]), other.rows(models[1])))
    return max(math.hypot(a["ux"] - b["ux"], a["uy"] - b["uy"]) for a, b in pairs) / max(math.hypot(b["ux"], b["uy"]) for _, b in pairs)


def blending():
    table = Comparison("correspondence blended with finite elements")
    settings, along = pulled_lamina(30)
    left, right = run_scene(SQUARE, {**settings, **DISC}).rows(COUPLED)
    table.add("lamina at 30 degrees: 1/E through the zone", (right["ux"] - left["ux"]) / 0.5, along, relative=0.005)  # measured: 0.31 %
    run = run_scene(LAMINA_CUT, QUIET)
    opening = {}
    for model in (PD, COUPLED):
        above, below = run.rows(model)[:2]
        opening[model] = above["ux"] - below["ux"]
    table.add(f"{LAMINA_CUT}: opening, over that of peridynamics", opening[COUPLED] / opening[PD], 1, absolute=0.02)  # measured: 1.3 %
    blended, ordinary = (run_scene(SQUARE, {**CONSOLE, **DISC, "Elasticity/Model": model}) for model in ("correspondence", "state-based"))
    table.add_limit("console: from the ordinary solid, blended", farthest(blended, ordinary, (COUPLED, COUPLED)), 1.2e-3)  # measured: 7.8e-4
    table.add_limit("console: from elements", farthest(blended, run_scene(SQUARE, {**CONSOLE, "Models": FE}), (COUPLED, FE)), 8e-4)  # measured: 5.1e-4

    # On several processes: a bar that is struck, whose wave passes the zone; a plate that yields around its hole.
    runs = [run_scene(SQUARE, {**BAR, **BLENDED, "Coupling/Zone": "0.3 - abs(x - 1.5)"}, ranks=ranks) for ranks in (1, 2, 4)]
    first, second = (row["ux"] for row in runs[0].rows(COUPLED, time=2.5))
    table.add("speed of the wave through the zone", 0.01 / (first - second), 1, relative=0.005)  # measured: 0.2 %
    table.add_limit("drift of energy over work", abs(runs[0].total("energy drift", COUPLED) / runs[0].total("work of loads and supports", COUPLED)), 1e-9)
    for run, ranks in zip(runs[1:], (2, 4)):
        for row, expected in zip(run.rows(COUPLED, time=2.5), runs[0].rows(COUPLED, time=2.5)):
            table.add(f"ux at x = {row['x']}, {ranks} processes", row["ux"], expected["ux"], relative=1e-12)
    yielding = {**QUIET, "Solver/Tolerance": "1e-11", "Domain/Cells": "20, 20", "Time/Time step": "0.1", "Time/End time": "1"}
    runs = [run_scene(PLATE, {**yielding, **RIM}, ranks=ranks) for ranks in (1, 2, 4)]
    force = "force on right in x"
    table.add("plate that yields: force, against elements", runs[0].total(force, COUPLED), run_scene(PLATE, {**yielding, "Models": FE}).total(force, FE), relative=0.018)  # measured: 1.1 %
    for run, ranks in zip(runs[1:], (2, 4)):
        for quantity in (force, "strain energy", "energy dissipated by the law"):
            table.add(f"{quantity}, {ranks} processes", run.total(quantity, COUPLED), runs[0].total(quantity, COUPLED), relative=1e-9)
    bar = {**QUIET, **BLENDED, **NODAL, "Solver/Tolerance": "1e-10", "Time/End time": "3"}
    run = run_scene(USER, {**bar, "Coupling/Zone": "0.4 - abs(x - 1)"})
    table.add("bar with a law of a user: force, against elements", run.total(force, COUPLED), run_scene(USER, {**bar, "Models": FE}).total(force, FE), relative=1e-3)
    table.show()


if __name__ == "__main__":
    run_parts(lamina, bodies, flow, motion, relaxing, breaking, blending)
