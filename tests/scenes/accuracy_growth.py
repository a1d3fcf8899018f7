# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""`Models = auto` where cracks grow: strengths and paths within the tolerance, against handbooks, symmetry and finer solutions.

    accuracy_growth.py strengths paths lattices refused
"""

import math
import os

from scene_test import SOURCE_DIR, check, check_close, check_less, check_message, run_parts, run_scene

E, NU, G = 200., 0.3, 0.01


def plate(cracks, conditions, lower="-0.5, -1.5", upper="0.5, 1.5", more="", measure="strength"):
    return (f"set Dimension = 2\nset Physics = elasticity\nset Models = auto\nsubsection Domain\n  set Lower corner = {lower}\n  set Upper corner = {upper}\nend\n"
            f"subsection Material\n  set Young modulus = {E}\n  set Poisson ratio = {NU}\n  set Fracture energy = {G}\nend\n"
            f"subsection Boundary conditions\n{conditions}end\nsubsection Cracks\n  set Segments = {cracks}\nend\n"
            f"subsection Accuracy\n  set Measure = {measure}\nend\nsubsection Output\n  set Fields = none\nend\n{more}")


PULLED = "  set Parts = one: point -0.5, 0 ; two: point 0.5, 0\n  set Displacement = one: 0, 0 ; two: free, 0\n  set Traction = top: 0, 4*t; bottom: 0, -4*t\n"


def griffith(half, factor):
    """The mean stress at which K = sqrt(E G), of a crack with K = s sqrt(pi a) factor."""
    return math.sqrt(E * G / (math.pi * half)) / factor


def strengths():
    """Handbooks (Tada, Paris and Irwin 2000), good to half a percent."""
    across = 0.4
    handbook = griffith(0.2, (1 - 0.025 * across ** 2 + 0.06 * across ** 4) / math.sqrt(math.cos(math.pi * across / 2)))
    for tolerance in ("1e-1", "2e-2"):
        run = run_scene(plate("-0.2,0 ; 0.2,0", PULLED), {"Accuracy/Tolerance": tolerance})
        found = run.summary["accuracy"]
        check(found["met"] and found["estimate"] <= float(tolerance), f"{found['estimate']} is within {tolerance}")
        check_close(found["strength"]["value"], handbook, relative=min(float(tolerance), 0.01), what="strength of a plate with a crack")
        check_close(run.model("auto")["largest force"]["value"], found["strength"]["value"], relative=1e-6, what="the force of the results")
    # The settings give the same without auto.
    again = run_scene(plate("-0.2,0 ; 0.2,0", PULLED), {"Models": found["model"], **found["settings"]})
    check_close(abs(again.model(found["model"])["largest force"]["value"]), found["strength"]["value"], relative=1e-6, what="the settings, without auto")
    share = 0.3
    edge = griffith(0.3, math.sqrt(2 / (math.pi * share) * math.tan(math.pi * share / 2))
                    * (0.752 + 2.02 * share + 0.37 * (1 - math.sin(math.pi * share / 2)) ** 3) / math.cos(math.pi * share / 2))
    held = PULLED.replace("one: point -0.5, 0 ; two: point 0.5, 0", "one: point 1, 0 ; two: point 0.8, 0")
    for ranks in (1, 2):
        run = run_scene(plate("0,0 ; 0.3,0", held, "0, -1.5", "1, 1.5"), {"Accuracy/Tolerance": "5e-2"}, ranks=ranks)
        check_close(run.summary["accuracy"]["strength"]["value"], edge, relative=0.01, what=f"strength of a plate with a crack in its side, {ranks} processes")
    # A crack that is not pulled far enough: what it bears at the end.
    run = run_scene(plate("-0.2,0 ; 0.2,0", PULLED), {"Accuracy/Tolerance": "5e-2", "Time/End time": "0.1"})
    check_close(run.summary["accuracy"]["strength"]["value"], 0.4, relative=1e-6, what="a crack that does not grow")


def paths():
    """Straight on where nothing turns a crack, to the same places twice where it is symmetric about its middle."""
    pulled = "  set Displacement = top: 0, 0.02*t; bottom: 0, -0.02*t\n"
    run = run_scene(plate("-0.2,0 ; 0.2,0", pulled, "-0.5, -0.75", "0.5, 0.75", measure="path"), {"Accuracy/Tolerance": "2e-2"})
    lines = run.summary["accuracy"]["path"]["lines"]
    check(run.summary["accuracy"]["met"] and len(lines) == 2, "both ends grow")
    for line in lines:
        check_close(abs(line[-1][0]), 0.5, absolute=1e-9, what="to the side")
        check_less(max(abs(y) for _, y in line), 1e-3, "straight on")
    run = run_scene(plate("-0.15,-0.1 ; 0.15,0.1", pulled, "-0.5, -0.75", "0.5, 0.75", measure="path"), {"Accuracy/Tolerance": "4e-2"})
    lines = sorted(run.summary["accuracy"]["path"]["lines"])
    check(run.summary["accuracy"]["met"] and len(lines) == 2, "both ends of an oblique crack grow")
    for a, b in zip(*(line[-1] for line in lines)):
        check_close(a, -b, absolute=5e-3, what="symmetric about the middle")
    for line in lines:
        check_less(abs(line[-1][1]), 0.2, "across the load")
    # Past the point that holds the plate, ahead of the crack, to the other side.
    held = PULLED.replace("one: point -0.5, 0 ; two: point 0.5, 0", "one: point 1, 0 ; two: point 0.8, 0")
    for ranks in (1, 2):
        run = run_scene(plate("0,0 ; 0.3,0", held, "0, -1.5", "1, 1.5", measure="path"), {"Accuracy/Tolerance": "2e-2"}, ranks=ranks)
        found = run.summary["accuracy"]
        check(found["met"] and len(found["path"]["lines"]) == 1, f"a crack from a side under traction: {found['estimate']}")
        check_close(found["path"]["lines"][0][-1][0], 1., absolute=1e-9, what="through the plate")
        check_less(max(abs(y) for _, y in found["path"]["lines"][0]), 2e-3, "straight on")


def lattices():
    """A horizon that is a length: bonds break."""
    pulled = "  set Displacement = top: 0, 0.01*t; bottom: 0, -0.01*t\n"
    run = run_scene(plate("-0.2,0 ; 0.2,0", pulled, "-0.5, -0.5", "0.5, 0.5", "subsection Peridynamics\n  set Horizon = 0.2\nend\n"),
                    {"Accuracy/Tolerance": "0.1", "Accuracy/Budget": "6"})
    found = run.summary["accuracy"]
    check(found["met"] == (found["estimate"] <= 0.1 and len(found["steps"]) >= 4), "met as the estimate says")
    check(all(part in found["left"] for part in ("mesh", "zone", "trapping", "steps")), "what is left")
    check_close(sum(found["left"].values()), found["estimate"], relative=1e-9, what="the sum of it")


def refused():
    base = plate("-0.2,0 ; 0.2,0", PULLED)

    def refuse(overrides, *words):
        check_message(run_scene(base, overrides, expect_error=True), *words)

    refuse({"Material/Fracture energy": ""}, "'Measure' in section 'Accuracy'", "is 'strength'", "nothing breaks")
    refuse({"Material/Fracture energy": "", "Material/Critical stretch": "1e-3"}, "'Critical stretch'", "nothing converges")
    refuse({"Cracks/Segments": ""}, "'Measure'", "no crack", "the smaller the horizon")
    refuse({"Boundary conditions/Traction": "top: 0, 4; bottom: 0, -4"}, "'Measure'", "no load depends on t")
    refuse({"Boundary conditions/Traction": "top: 0, 4*t^2; bottom: 0, -4*t^2"}, "'Measure'", "not in proportion to t")
    refuse({"Boundary conditions/Traction": "top: 0, -4*t; bottom: 0, 4*t"}, "'Measure'", "pressed together")
    refuse({"Elasticity/Solver": "dynamics"}, "'auto' does not choose for", "motion with cracks")
    refuse({"Material/Young modulus": "200 + y"}, "'auto' does not choose for", "moduli vary")
    refuse({"Accuracy/Measure": "strenght"}, "Did you mean 'strength'?")
    refuse({"Accuracy/Measure": "path", "Time/End time": "0.01"}, "'Measure'", "no crack grows")
    shown = open(os.path.join(SOURCE_DIR, "prm/fracture/chosen_strength.prm")).read()
    run = run_scene(shown, {"Output/Fields": "none"})
    check(run.summary["accuracy"]["met"], "chosen_strength: the tolerance is met")


if __name__ == "__main__":
    run_parts(strengths, paths, lattices, refused)
