# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Cracks in slender bodies: stress intensities of an end-notched flexure and of a double cantilever.

References: quadratic elements with the crack on faces of 640 x 40 cells (flexure, K_II = 129.0; beams with a correction 130.3) and of 256 x 32 and 512 x 64 cells (double cantilever, K_I = 32.68 by J,
whose square differs by 7e-4 between the two).

    slender_cracks.py default | told
"""

import re

from scene_test import COUPLED, FE, PD, Comparison, check, run_parts, run_scene, scene_text

TIP = "crack 1 end 2"
K_FLEXURE, K_CANTILEVER = 129.0, 32.68

COMMON = scene_text("""
Dimension = 2
Physics = elasticity
Models = finite elements, coupled
Material/Young modulus = 71700
Material/Poisson ratio = 0.33
Elasticity/Contact = false
Output/Fields = none
""")

FLEXURE = COMMON + scene_text("""
Domain/Lower corner = -0.5, -0.5
Domain/Upper corner = 15.5, 0.5
Boundary conditions/Parts = lower: point 0, -0.5 ; upper: point 0, 0.5 ; rfoot: point 15, -0.5 ; load: point 7.5, 0.5 ; mid: point 7.5,-0.5
Boundary conditions/Displacement = rfoot: free, 0 ; mid: 0, 0
Boundary conditions/Traction = lower: 0, 2.5 ; upper: 0, 2.5 ; load: 0, -10
Cracks/Segments = -0.5,0 ; 6,0
""")

CANTILEVER = COMMON + scene_text("""
Domain/Lower corner = 0, -0.5
Domain/Upper corner = 8, 0.5
Boundary conditions/Parts = lower: point 0, -0.5 ; upper: point 0, 0.5
Boundary conditions/Displacement = right: 0, 0
Boundary conditions/Traction = lower: 0, -1 ; upper: 0, 1
Cracks/Segments = 0,0 ; 3,0
""")


def flexure(n, more=None, ranks=1):
    return run_scene(FLEXURE, {"Domain/Cells": f"{16 * n}, {n}", **(more or {})}, ranks=ranks)


def cantilever(n, more=None, ranks=1):
    return run_scene(CANTILEVER, {"Domain/Cells": f"{8 * n}, {n}", **(more or {})}, ranks=ranks)


def gap(run, model, mode, reference):
    return abs(run.model(model)["stress intensity"][TIP][mode]) / reference - 1


def default():
    """Cracks on faces, of lattices on which they do not lie at first, too."""
    table = Comparison("Cracks on faces")
    for n in (30, 31, 61):
        bent, opened = flexure(n), cantilever(n)
        for model in (FE, COUPLED):
            table.add_limit(f"{model}, {n} cells: K_II of the flexure", abs(gap(bent, model, "II", K_FLEXURE)), 0.015)
            table.add_limit(f"{model}, {n} cells: K_I of the cantilever", abs(gap(opened, model, "I", K_CANTILEVER)), 0.015)
        for run in (bent, opened):
            check(any("are cut into the mesh" in note for note in run.summary["notes"]), f"{n} cells: a note: {run.summary['notes']}")
    # Ends that lie on no vertex: K goes with the length in the flexure, and nearly so in the
    # cantilever (arms turn where they end: K ~ a + 0.64 of their height).
    for shift in (0.007, 0.016):
        bent, opened = flexure(31, {"Cracks/Segments": f"-0.5,0 ; {6 + shift},0"}), cantilever(31, {"Cracks/Segments": f"0,0 ; {3 + shift},0"})
        for model in (FE, COUPLED):
            table.add_limit(f"{model}, tip {shift} farther: K_II of the flexure", abs(gap(bent, model, "II", K_FLEXURE * (1 + shift / 6))), 0.015)
            table.add_limit(f"{model}, tip {shift} farther: K_I of the cantilever", abs(gap(opened, model, "I", K_CANTILEVER * (1 + shift / 3.32))), 0.015)
    table.show()


def told():
    """The errors that the note expects, over those of the cells that are taken away."""
    table = Comparison("What notes say of slender cracks, over what is")
    for n, make, mode, reference in ((31, flexure, "II", K_FLEXURE), (31, cantilever, "I", K_CANTILEVER), (61, cantilever, "I", K_CANTILEVER)):
        run = make(n, {"Models": f"{FE}, {COUPLED}, {PD}", "Cracks/Mesh": "removed"})
        notes = [note for note in run.summary["notes"] if "slender arms" in note]
        check(len(notes) == 1, f"one note: {run.summary['notes']}")
        for model in (FE, COUPLED, PD):
            said = re.search(r"K_I (?:up to )?(\S+) % (?:off|too \w+) and K_II (\S+) % too (\w+) \(" + model, notes[0])
            check(said is not None, f"{model}: {notes[0]}")
            error = 100 * gap(run, model, mode, reference)
            table.add_limit(f"{model}, {n} cells: K_{mode} {error:+.2f} %, said {said[len(mode)]}, factor", max(float(said[len(mode)]) / abs(error), abs(error) / float(said[len(mode)])), 2)
            check(mode == "I" or (error < 0) == (said[3] == "small"), f"{model}: {error} is too {said[3]}")
    table.show()


if __name__ == "__main__":
    run_parts(default, told)
