# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Bodies in motion: the energy stays within 1 % of what start and loads bring in, or the run stops and says why.

    motion.py kept | stopped | supplied | refused
"""

from scene_test import PD, Comparison, check, check_close, check_message, run_parts, run_scene
from scene_texts import body_of_bonds

BODY = body_of_bonds("""
Domain/Cells = 24, 24
Elasticity/Solver = dynamics
Elasticity/Kinematics = full
Output/Write every = 1
Output/Fields = none
""", young=1, poisson=0.25)
HELD = {"Boundary conditions/Displacement": "left: 0, 0"}


def history(run, quantity, model=PD):
    return [row["value"] for row in run.totals if row["model"] == model and row["quantity"] == quantity]


def energy_kept(table, what, run, model=PD, drift=0.01, imbalance=0.01):
    """Drift and imbalance at all times of output, over the most that start and work have been."""
    start = run.model(model)["energy balance"]["start"]
    given = start + max(abs(w) for w in history(run, "work of loads and supports", model))
    check(given > 0, f"{what}: something happens")
    table.add_limit(f"{what}: energy drift", max(abs(d) for d in history(run, "energy drift", model)) / given, drift)
    table.add_limit(f"{what}: energy imbalance", max(abs(d) for d in history(run, "energy imbalance", model)) / given, imbalance)


def kept():
    """Motions that are followed to the end."""
    table = Comparison("Energy over what start and loads have brought in")
    pulled = run_scene(BODY, {**HELD, "Boundary conditions/Traction": "right: 0.1, 0", "Time/End time": "20"})
    energy_kept(table, "pulled", pulled)
    # A strip that bends through a right angle and swings back.
    strip = {"Domain/Cells": "60, 6", "Domain/Upper corner": "1, 0.1", **HELD, "Time/End time": "60", "Output/Write every": "2",
             "Output/Probes": "1, 0.05", "Boundary conditions/Traction": "right: 0, -1.5e-3"}
    bent = run_scene(BODY, strip)
    energy_kept(table, "bent", bent)
    tip = min(row["uy"] for row in bent.probes)
    check(tip < -0.5, f"the strip bends far: {tip}")
    # Flight: nothing holds the body, which turns twice while it flies away.
    turns = {"Domain/Cells": "12, 12", "Initial and source/Initial velocity": "0.2 - 0.6*(y - 0.5), 0.1 + 0.6*(x - 0.5)",
             "Time/End time": "20", "Output/Probes": "0.5, 0.5; 1, 0.5"}
    flight = run_scene(BODY, turns)
    energy_kept(table, "flight", flight)
    middle = [(row["ux"], row["uy"]) for row in flight.rows(PD, (0.5, 0.5), 20)]
    check_close(middle[0], (4, 2), relative=1e-9, what="where the middle is")
    # Breaking: a strip with an edge crack, large displacements.
    breaking = {"Domain/Cells": "40, 20", "Domain/Lower corner": "0, -0.5", "Domain/Upper corner": "2, 0.5", "Cracks/Segments": "0,0; 0.7,0",
                "Material/Fracture energy": "2e-3", "Boundary conditions/Traction": "top: 0, 0.04; bottom: 0, -0.04", "Time/End time": "12"}
    broken = run_scene(BODY, breaking)
    energy_kept(table, "breaking", broken)
    lost = broken.model(PD)["energy balance"]
    check(lost["broken bonds"] > 200, f"bonds break: {lost['broken bonds']}")
    table.add_limit("breaking: energy imbalance over energy released", abs(lost["imbalance"]) / lost["released"], 0.05)
    # Impact: a block flies onto its own support.
    impact = run_scene(BODY, {**HELD, "Initial and source/Initial velocity": "-0.1, 0", "Time/End time": "10", "Time/Time step": "0.025"})
    energy_kept(table, "impact", impact)
    table.show()


def ramps():
    """Loads that begin at nothing, where the first velocity comes before the first work; also in the midst of a run and with output after each step."""
    table = Comparison("Energy over what loads that set in gently have brought in")
    bar = {**HELD, "Domain/Cells": "20, 4", "Domain/Upper corner": "1, 0.2", "Elasticity/Kinematics": "linear", "Time/End time": "3",
           "Models": "peridynamics, finite elements"}
    traction, body = "Boundary conditions/Traction", "Initial and source/Body force"
    for name, settings in (("line", {traction: "right: 0.1*min(t, 1), 0"}), ("sine", {traction: "right: 0.1*sin(t), 0"}),
                           ("square", {traction: "right: 0.1*t^2, 0"}), ("later", {traction: "right: 0.1*max(0, t - 1.01), 0"}),
                           ("weight", {body: "0.1*t, 0"}), ("often", {traction: "right: 0.1*t, 0", "Output/Write every": "0.01", "Time/End time": "0.5"}),
                           ("moved", {traction: "right: 0.1*t, 0", "Initial and source/Initial velocity": "1e-12, 0"})):
        run = run_scene(BODY, {**bar, **settings})
        for model in (PD, "finite elements"):
            energy_kept(table, f"{name}, {model}", run, model, imbalance=0.002)
    run = run_scene(BODY, {**bar, "Models": PD, "Elasticity/Kinematics": "full", traction: "right: 0.1*t, 0"})
    energy_kept(table, "full kinematics", run)
    table.show()


def stopped():
    """Motions and an equilibrium that mean nothing any more end with a message."""
    for settings in ({"Boundary conditions/Traction": "right: -0.2, 0"},
                     {"Boundary conditions/Traction": "right: -0.2, 0", "Time/Time step": "0.025"},
                     {"Boundary conditions/Traction": "right: -0.3, 0; top: 0, -0.3; bottom: 0, 0.3"},
                     {"Initial and source/Initial velocity": "-1, 0"}):
        run = run_scene(BODY, {**HELD, "Time/End time": "20", **settings}, expect_error=True)
        check_message(run, "Before t = ", "the body is inside out at", "worst at (", "make the load smaller")
    still = {**HELD, "Boundary conditions/Traction": "right: -0.3, 0", "Elasticity/Solver": "conjugate gradients"}
    run = run_scene(BODY.replace("  set Write every = 1\n", ""), still, expect_error=True)
    check_message(run, "'conjugate gradients' has found", "the body is inside out at", "make the load smaller")
    # Small displacements by definition: a note.
    linear = {**HELD, "Boundary conditions/Traction": "right: -2, 0", "Elasticity/Kinematics": "linear", "Time/End time": "1.5"}
    run = run_scene(BODY, linear)
    check(any("inside out" in note and "'Kinematics = linear'" in note for note in run.summary["notes"]), f"a note: {run.summary['notes']}")


def supplied():
    """Ten times the steps of the supplied motions."""
    table = Comparison("Ten times as long")
    wave = run_scene("prm/elasticity/wave_in_bar.prm", {"Time/End time": "1e-3", "Output/Write at": "", "Output/Write every": "5e-5", "Output/Fields": "none"})
    for model in (PD, "finite elements"):
        energy_kept(table, f"wave, {model}", wave, model)
    branches = run_scene("prm/fracture/branching_crack.prm", {"Time/End time": "4e-4", "Output/Write every": "2e-5", "Output/Fields": "none"})
    energy_kept(table, "branches", branches)
    table.show()


def refused():
    """Nodes without mass."""
    for density in ("max(0, x - 0.5)", "x - 0.5"):
        run = run_scene(BODY, {**HELD, "Material/Density": density, "Time/End time": "1"}, expect_error=True)
        check_message(run, "'Density' in section 'Material'", "at (0, 0)", "positive density everywhere")


if __name__ == "__main__":
    run_parts(kept, ramps, stopped, supplied, refused)
