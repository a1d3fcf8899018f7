# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Cracks with a prescribed path in elastic bodies: a strip, whose energy per length is known.

    growing_bodies.py strip | mesh | motion | mistakes
"""

from scene_test import COUPLED, FE, PD, Comparison, check, check_close, check_message, run_parts, run_scene

SCENE = "prm/elasticity/growing_crack.prm"
PER_LENGTH = 1e4 * 0.01 ** 2 / 2 / (1 - 0.3 ** 2)
INTENSITY = (PER_LENGTH * 1e4) ** 0.5
MOTION = {"Elasticity/Solver": "dynamics", "Elasticity/Contact": "false", "Material/Density": "1.0", "Time/Time step": "auto", "Time/End time": "0.04", "Output/Write at": "0, 0.02, 0.04",
          "Cracks/Growth": "2: 0.01, 40,0", "Boundary conditions/Displacement": "bottom: 0, -0.005*(1-exp(-(200*t)^2)) ; top: 0, 0.005*(1-exp(-(200*t)^2))"}


def strip():
    """The energy released, the stress intensity along the path, and the end against a crack that has been there from the start."""
    table = Comparison("A crack that grows through a strip, over what is exact")
    # Measured: -0.03, -1.13 and -1.08 %; on finer cells -0.54 %.
    run = run_scene(SCENE)
    for model, bound in ((FE, 0.001), (PD, 0.017), (COUPLED, 0.013)):
        table.add(f"{model}: energy", run.total("energy dissipated", model, time=1) / (2 * PER_LENGTH), 1, absolute=bound)
        check(0.05 < run.total("energy released by cracks", model, time=1) < 0.25, f"{model}: what the cut parts had stored")
        check(abs(run.total("energy imbalance", model, time=1)) < 1e-9, f"{model}: no energy is lost")
    # Nodes that join the zone change the energy by little: 8.4e-4 of 1.09.
    joining = run.total("energy released by nodes joining the zone", COUPLED, time=1)
    check(0 < abs(joining) < 1.2e-3 * 2 * PER_LENGTH, f"coupled: nodes that join the zone release {joining}")
    finer = run_scene(SCENE, {"Models": COUPLED, "Domain/Cells": "258, 43", "Output/Fields": "none"})
    table.add("coupled, 43 cells: energy", finer.total("energy dissipated", COUPLED, time=1) / (2 * PER_LENGTH), 1, absolute=0.007)
    for model in (FE, COUPLED):
        on_the_way = [run.total("stress intensity I at crack 1 end 2", model, time=k / 10) / INTENSITY for k in range(2, 10)]
        table.add(f"{model}: stress intensity, mean along the path", sum(on_the_way) / len(on_the_way), 1, absolute=0.02)
        check(max(abs(k - 1) for k in on_the_way) < 0.05, f"{model}: the stress intensity stays the same: {on_the_way}")
    # Until t = 0.95, so that the crack has stopped when the last span of time begins.
    stopped = run_scene(SCENE, {"Cracks/Growth": "2: 0, 2,0, 0.95", "Output/Fields": "none"})
    still = run_scene(SCENE, {"Cracks/Growth": "", "Cracks/Segments": "-3,0 ; 0.9,0", "Cracks/Mesh": "removed", "Time/Time step": "auto", "Output/Write at": "", "Output/Fields": "none"})
    for model in (FE, PD, COUPLED):
        table.add(f"{model}: strain energy, over that of the crack from the start",
                  stopped.total("strain energy", model, time=1) / still.total("strain energy", model), 1, absolute=1e-8)
    table.show()


def mesh():
    """On a mesh from a file families go on beyond its sides and planes of symmetry: cracks that grow beside these, against the same from the start."""
    table = Comparison("Strain energy of a ring with a crack that has grown, over that of the crack from the start")
    for what, start, growth, end in (("through a plane of symmetry", "0.72,-0.01 ; 0.72,0.1", "2: 0, 0,0.1, 0.95", "0.72,-0.01 ; 0.72,0.195"),
                                     ("from the bore", "0.4,0.05 ; 0.53,0.05", "2: 0, 0.2,0, 0.95", "0.4,0.05 ; 0.72,0.05")):
        ring = {"Models": PD, "Output/Line": "", "Output/Probes": ""}
        grown = run_scene("prm/elasticity/thick_ring.prm", {**ring, "Cracks/Segments": start, "Cracks/Growth": growth, "Cracks/Growth step": "0.01",
                                                            "Time/End time": "1", "Time/Time step": "0.5"})
        still = run_scene("prm/elasticity/thick_ring.prm", {**ring, "Cracks/Segments": end})
        table.add(what, grown.total("strain energy", PD) / still.total("strain energy", PD), 1, absolute=1e-9)
        check(grown.total("strain energy", PD) > 1.003 * grown.total("strain energy", PD, time=0), f"{what}: the ring gets softer")
    table.show()


def motion():
    """A crack at 0.4 of the speed of waves in a bar: steps lose nothing, and both steppers find the same."""
    explicit = run_scene(SCENE, {**MOTION, "Time/Time step": "1e-4"})
    implicit = run_scene(SCENE, {**MOTION, "Time/Stepper": "newmark", "Time/Time step": "1e-4"})
    for model in (FE, PD, COUPLED):
        work = explicit.total("work of loads and supports", model, time=0.04)
        for run in (explicit, implicit):
            check(abs(run.total("energy drift", model, time=0.04)) < 1e-8 * work, f"{model}: steps lose no energy")
            if model == COUPLED:  # measured: 7.9e-4
                check(abs(run.total("energy released by nodes joining the zone", model, time=0.04)) < 1.2e-3 * work, "coupled: nodes that join the zone")
        check_close(implicit.total("energy released by cracks", model, time=0.04), explicit.total("energy released by cracks", model, time=0.04),
                    relative=0.01, what=f"{model}: what is released, with newmark")


def mistakes():
    for more, words in (({"Time/Steady": "true"}, ("'Steady' in section 'Time'", "cracks that grow")),
                        ({"Models": PD, "Peridynamics/Surface correction": "energy"}, ("'Surface correction' in section 'Peridynamics'", "cracks that grow")),
                        ({"Cracks/Mesh": "faces"}, ("'Mesh' in section 'Cracks'", "cracks that grow"))):
        check_message(run_scene(SCENE, more, expect_error=True), *words)


if __name__ == "__main__":
    run_parts(strip, mesh, motion, mistakes)
