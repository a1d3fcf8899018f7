# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Laws of bonds of users (perideal_bond_law.h), compiled by the program: against closed forms and the built-in laws, on several processes, and broken ones.

    user_bonds.py bar       prm/elasticity/user_bonds.prm: forces and energies of a bar that yields and hardens; 2 and 4 processes, in 2D
    user_bonds.py same      F = s and others as formulas are: at rest, in motion, with bonds that break, full kinematics
    user_bonds.py mistakes  broken laws and entries: one message each, on 2 processes, too
"""

import os
import subprocess

from scene_test import PD, SOURCE_DIR, Comparison, check, check_less, check_message, check_one_message, run_parts, run_perideal, run_scene, temporary_folder, write_file

BAR = "prm/elasticity/user_bonds.prm"
PLATE = "prm/fracture/branching_crack.prm"


def law(body, version="PERIDEAL_BOND_LAW_VERSION"):
    return ("#include <math.h>\n#include <perideal_bond_law.h>\n" + (f"int perideal_bond_law_version(void) {{ return {version}; }}\n" if version else "")
            + "int perideal_bond_law(const struct perideal_bond *b, struct perideal_bond_answer *a, double *next)\n{\n  const double s = b->stretch;\n  a->force = s; a->slope = 1; a->stored = s * s / 2;\n"
            + body + "\n  return 0;\n}\n")


def user(path, states=0, properties="1"):
    return {"Material/Law": "user", "Material/User law": path, "Material/User properties": properties, "Material/User states": str(states)}


def bar():
    table = Comparison("a bar whose bonds yield and harden kinematically")
    run = run_scene(BAR)
    for time, force in ((0.25, 1), (1, 1.3), (1.5, -0.7), (2, -0.9), (3, -1.3), (3.5, 0.7), (4, 0.9)):
        table.add(f"force, t = {time}", run.total("force on right in x", PD, time), force, relative=1e-9)
    # p goes up by 0.0027, down by 0.0054 and up by 0.0018 (0.9 of each way beyond yield); what is left is stored by F and by p.
    p, c = -0.0009, 0.1 / 0.9
    table.add("dissipated", run.total("energy dissipated by the law", PD, 4), 1000 * 0.001 * 0.0099, relative=1e-9)
    table.add("stored", run.total("strain energy", PD, 4), 500 * (0.0009**2 + c * p**2), relative=1e-9)
    check_less(abs(run.total("energy imbalance", PD, 4)), 1e-9, "balance of energy")
    # Steps that end where bonds yield or within: the law is exact for any.
    coarse = run_scene(BAR, {"Time/Time step": "1"})
    table.add("steps as long as a way", coarse.total("force on right in x", PD, 4), 0.9, relative=1e-9)
    for n in (2, 4):
        several = run_scene(BAR, ranks=n)
        table.add(f"{n} processes", several.total("force on right in x", PD, 4), 0.9, relative=1e-9)
    # Laws that ask for short steps get them, and are not asked for a jump to no stretch.
    folder = temporary_folder()
    wary = law("  if (fabs(s - b->states[0]) > 0.0004) return PERIDEAL_BOND_LAW_SHORTER_STEP;\n  next[0] = s;")
    run = run_scene(BAR, {**user(write_file("wary.c", wary, folder), 1), "Time/Time step": "0.25", "Time/End time": "1"})
    table.add("shorter steps", run.total("force on right in x", PD, 1), 4, relative=1e-9)
    check("load steps were halved" in run.stdout, f"told: {run.stdout[-500:]}")
    jumpy = law("  if (fabs(s - b->states[0]) > 0.0015) return 3;\n  next[0] = s;")
    run = run_scene(BAR, {**user(write_file("jumpy.c", jumpy, folder), 1), "Time/End time": "1"})
    table.add("no jumps", run.total("force on right in x", PD, 1), 4, relative=1e-9)
    # A plate is pulled beyond yield and let go: what one process finds two find.
    plate = {"Dimension": "2", "Domain/Lower corner": "0, 0", "Domain/Upper corner": "1, 0.5", "Domain/Cells": "20, 10", "Material/Poisson ratio": "0.25", "Elasticity/Plane": "strain",
             "Boundary conditions/Displacement": "left: 0, 0 ; right: 0.004*min(t, 2 - t), 0", "Time/End time": "1.75", "Output/Line": "", "Output/Probes": "0.9, 0.1", "Solver/Tolerance": "1e-12"}
    first, two = run_scene(BAR, plate), run_scene(BAR, plate, ranks=2)
    for column in ("ux", "uy", "sxx"):
        table.add(f"plate, {column}, 2 processes", two.rows(PD)[-1][column], first.rows(PD)[-1][column], relative=1e-9)
    check(first.total("energy dissipated by the law", PD, 1.75) > 0.2 * first.total("work of loads and supports", PD, 1.75), "the plate yields")
    table.show()


def same():
    """To the last digit where the law is that of a formula."""
    folder = temporary_folder()
    moving = {"Domain/Cells": "40, 16", "Material/Fracture energy": "", "Material/Critical stretch": "1e-3", "Output/Fields": "none"}
    resting = {"Elasticity/Solver": "newton", "Time/Stepper": "auto", "Time/Time step": "0.5", "Time/End time": "1", "Boundary conditions/Traction": "", "Boundary conditions/Velocity": "",
               "Boundary conditions/Displacement": "bottom: 0, 0 ; top: 1e-6*t, 2e-6*t", "Output/Write at": "1", "Material/Critical stretch": "", "Material/Density": "1", "Output/Write every": ""}
    laws = {"linear": ("", "s"), "stiffer, softer where damaged": ("  a->force = s*(1 + 100*s)*(1 - 0.5*b->damage); a->slope = (1 + 200*s)*(1 - 0.5*b->damage);", "s*(1 + 100*s)*(1 - 0.5*damage)")}
    moves = ("in motion", moving), ("full kinematics", {**moving, "Elasticity/Kinematics": "full"})
    rests = ("at rest", {**moving, **resting})
    for (name, (body, formula)), kinds in zip(laws.items(), ((rests,), (*moves, rests))):
        path = write_file(name.replace(" ", "_") + ".c", law(body), folder)
        for kind, settings in kinds:
            found = run_scene(PLATE, {**settings, **user(path)})
            expected = run_scene(PLATE, {**settings, "Material/Law": "formula", "Material/Bond force": formula})
            # Energies of formulas are integrals by quadrature.
            rows = [[row for row in run.totals if "energy" not in row["quantity"] and "work" not in row["quantity"]] for run in (found, expected)]
            check(len(rows[0]) == len(rows[1]) > 5, f"{name}, {kind}: {len(rows[0])} rows")
            if kind == "at rest": # by Newton's iterations, whose slopes a formula has by differences
                size = max(abs(row["value"]) for row in rows[0])
                check_less(max(abs(a["value"] - b["value"]) for a, b in zip(*rows)), 1e-8 * size, f"{name}, {kind}")
            else:
                check(rows[0] == rows[1], f"{name}, {kind}: the same digits")
                check(max(row["value"] for row in found.totals if row["quantity"] == "broken bonds") > 100, f"{name}, {kind}: bonds break")


BROKEN = {
    "number": ("if (s != 0) a->force = sqrt(-1.);", 0, ["a force that is no number", "stretch"]),
    "slope": ("a->slope = 0. / (s - s);", 0, ["a slope that is no number"]),
    "status": ("if (s > 1e-4) return 7;", 0, ["returns 7 in place of 0"]),
    "states": ("next[2] = 1;", 2, ["writes more states than 'User states'", "which is 2"]),
    "no state": ("if (s != 0) next[0] = log(-1.);", 1, ["a state that is no number"]),
    "short steps": ("if (s != 0) return PERIDEAL_BOND_LAW_SHORTER_STEP;", 0, ["asks for a shorter step"]),
    "at rest": ("a->force = s + 1e-3;", 0, ["the force 0.001", "It has to be 0"]),
}


def mistakes():
    folder = temporary_folder()

    def fails(name, overrides, words):
        for n in (1, 2):
            run = run_scene(BAR, {"Output directory": os.path.join(folder, "results"), **overrides}, ranks=n, expect_error=True)
            check_one_message(run.stdout, run.stderr, words, f"{name}, {n} process(es)")
            if n == 1:
                print(f"{name}: {run.stderr.strip()}\n")

    for name, (body, states, words) in BROKEN.items():
        fails(name, user(write_file(f"{name.replace(' ', '_')}.c", law(body), folder), states), ["'User law'", *words])
    good = write_file("good.c", law(""), folder)

    def library(name, text):
        path = os.path.join(folder, name)
        subprocess.run(["cc", "-shared", "-fPIC", "-o", path, write_file(name + ".c", text, folder)], check=True)
        return path

    for name, path, words in (("neither", library("other.so", "void other(void) {}\n"), ["has no 'perideal_bond_law'"]),
                              ("of stresses", library("stresses.so", "void umat_(void) {}\n"), ["has a 'umat_', a law of stresses", "'Model = correspondence'"]),
                              ("version", write_file("version.c", law("", "2"), folder), ["was made with version 2", "has version 1"]),
                              ("no version", write_file("no_version.c", law("", ""), folder), ["has no 'perideal_bond_law_version'"]),
                              ("missing", "nowhere.c", ["is not there"])):
        fails(name, user(path), ["'User law'", *words])
    for overrides, words in (
            ({"Elasticity/Solver": "linear"}, ("Solver", "'Law = user'")),
            ({"Models": "coupled", "Material/Young modulus": ""}, ("Law", "of bonds, for 'Models = peridynamics' alone")),
            ({"Models": "finite elements", "Dimension": "2", "Domain/Lower corner": "0, 0", "Domain/Upper corner": "1, 1", "Domain/Cells": "4, 4", "Material/Young modulus": "",
              "Boundary conditions/Displacement": "left: 0, 0", "Output/Line": "", "Material/User states": "0"}, ("User law", "has a 'perideal_bond_law', a law of bonds")),
            ({"Material/Young modulus": ""}, ("Law", "a law of bonds, which needs moduli", "'Model = correspondence'")),
            ({"Material/Fracture energy": "1"}, ("Fracture energy", "'Critical stretch'")),
            ({"Material/Phases/Regions": "a: x - 0.5", "Material/Phases/User properties": "a: 1, 2"}, ("User properties", "bonds that lead from one to another have one law"))):
        check_message(run_scene(BAR, {**user(good), **overrides}, expect_error=True), *words)
    # check tells the law
    status, stdout, _ = run_perideal(["check", os.path.join(SOURCE_DIR, BAR)])
    check(status == 0 and "user_bonds.c, properties: 2, states: 1" in stdout, f"check tells the law: {stdout[-1500:]}")


if __name__ == "__main__":
    run_parts(bar, same, mistakes)
