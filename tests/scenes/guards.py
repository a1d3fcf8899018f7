# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Runs that become unstable on their way: each is stopped soon after it begins to, says where and why, and keeps what it had.

Arguments: parts. `stopped`: each run, on one process and on two. `actions`: warn, off. `share`: the time that guards take, printed. `told`: what
a message and summary.json say of time, place and model, also where another run has left its results.
"""

import glob
import math
import os
import xml.etree.ElementTree as xml

import h5py
import numpy

from scene_test import Run, check, check_less, check_message, print_table, run_parts, run_perideal, run_scene, scene_text
from scene_texts import body_of_bonds

SOON = 20  # steps after the first growth
TOLD = "'Action = stop' in section 'Guards'"  # in notes of what would have ended the run

PLATE = scene_text("""
Models = peridynamics
Domain/Cells = 20, 20
Boundary conditions/Dirichlet = left: 0; right: 0
""")

# The source has no value after t = 0.05.
SOURCE_ENDS = PLATE + scene_text("""
Initial and source/Source = 10*sqrt(0.05 - t)
Time/End time = 0.2
Time/Stepper = euler
Output/Write every = 0.02
""")

# A step of forward Euler that is stable at the start.
WARMING = PLATE + scene_text("""
Material/Conductivity = 1 + 10*T
Initial and source/Source = 10
Time/End time = 2
Time/Stepper = euler
Time/Time step = 4e-4
Output/Write every = 0.004
""")

# A given value that becomes infinite at t = 0.05.
VALUE_EXPLODES = scene_text("""
Dimension = 1
Models = finite elements
Domain/Lower corner = 0
Domain/Upper corner = 1
Domain/Cells = 40
Boundary conditions/Dirichlet = left: 1/(0.05 - t); right: 0
Time/End time = 0.2
Output/Write every = 0.02
""")

# A source that begins at 0, in a body at rest.
SLOW_START = VALUE_EXPLODES.replace("left: 1/(0.05 - t); right: 0", "left: 0").replace("End time = 0.2", "End time = 8\n  set Stepper  = crank nicolson").replace(
    "subsection Time", "subsection Initial and source\n  set Source = 1000*sin(40*t)\nend\nsubsection Time").replace("Write every = 0.02", "Write every = 2")

BODY = body_of_bonds("", young=100)


def held_motion(kinematics, end_time):
    """The motion of a body that is held on the left."""
    return scene_text(f"""
Boundary conditions/Displacement = left: 0, 0
Elasticity/Solver = dynamics
Elasticity/Kinematics = {kinematics}
Time/End time = {end_time}
""")


# Half of a strip flies away from the half that is held.
FLYING = BODY + held_motion("linear", 15) + scene_text("""
Material/Fracture energy = 0.001
Domain/Upper corner = 2, 0.5
Domain/Cells = 32, 8
Initial and source/Initial velocity = if(x > 1, 2, 0), 0
Output/Write every = 1
""")

# A strip is pulled until a step that was stable at the start is not any more.
PULLED = BODY + scene_text("""
Domain/Upper corner = 1, 0.25
Domain/Cells = 16, 4
Boundary conditions/Displacement = left: 0, 0; right: 2.5*(t/4)^2, 0
Elasticity/Solver = dynamics
Elasticity/Kinematics = full
Peridynamics/Surface correction = none
Time/End time = 4
Time/Stepper = verlet
Time/Time step = STEP
Output/Write every = 0.25
""")

# Half way the traction has no value any more.
TRACTION_ENDS = BODY + scene_text("""
Domain/Upper corner = 1, 0.25
Domain/Cells = 16, 4
Boundary conditions/Displacement = left: 0, 0
Boundary conditions/Traction = right: 0.1*sqrt(1 - t), 0
Elasticity/Solver = dynamics
Time/End time = 2
Output/Write every = 0.25
""")

# A plate that holds less heat the warmer it is: at the same conductivity it becomes faster.
LESS_CAPACITY = WARMING.replace("Conductivity = 1 + 10*T", "Heat capacity = 1 - 0.9*T").replace("Time step = 4e-4", "Time step = 8e-4")


# A displacement that has no value after half of the load steps.
PULL_ENDS = BODY.replace("peridynamics", "finite elements, peridynamics") + scene_text("""
Domain/Cells = 20, 20
Boundary conditions/Displacement = left: 0, 0; right: sqrt(0.5 - t), 0
Time/End time = 1
Time/Time step = 0.1
""")

# What conducts less the warmer it is, and nothing at 0.5, which the left side has at t = 0.5.
CONDUCTS_NO_MORE = PLATE.replace("left: 0;", "left: t;") + scene_text("""
Material/Conductivity = 1 - 2*T
Time/End time = 2
""")

STEADY = PLATE.replace("left: 0;", "left: 1;").replace("peridynamics", "finite elements, peridynamics") + scene_text("Time/Steady = true")

# Pushed down so fast that it folds.
FOLDED = BODY + held_motion("full", 1) + scene_text("""
Domain/Cells = 20, 20
Initial and source/Body force = 0, -50*if(t < 0.2, 1, 0)
""")

# The support jumps by a hundredth of the body.
JUMPING = FOLDED.replace("set Body force = 0, -50*if(t < 0.2, 1, 0)", "").replace("left: 0, 0", "left: if(t < 0.3, 0, 0.01), 0")


def step_of(run, model="peridynamics"):
    """The mean length of the steps."""
    guard = run.summary["guard"]
    return guard["time"] / guard["step"]


def formula_ends(t):
    """The first step that ends after a time."""
    return lambda run: math.ceil(t / step_of(run))


def limit_is_passed(run):
    """The run is refused the first step above its limit; that of a motion is looked for every 25 steps."""
    guard = run.summary["guard"]
    check(1 < guard["value"] / guard["bound"] < 1.1, f"a step that has just become too long: {guard}")
    check(f"{guard['value']:g}" in guard["cause"], f"the cause has the step: {guard['cause']}")
    return guard["step"]


def has_flown_off(run):
    """The step at which it was as far as the bound, by the speed with which it flies: about 2, that of its start."""
    guard = run.summary["guard"]
    check_less(guard["bound"], guard["value"], "how far it has flown")
    check(1.0 < guard["place"][0] <= 2.0, f"what flies is right of the middle: {guard['place']}")
    return guard["step"] - math.ceil((guard["value"] - guard["bound"]) / (1.5 * step_of(run)))


# Scene, monitor, words of the message, the step at which the growth begins.
RUNS = {
    "source without a value": (SOURCE_ENDS, "finite values", ["'Source'", "sqrt(0.05 - t)", "is not finite at ("], formula_ends(0.05)),
    "traction without a value": (TRACTION_ENDS, "finite values", ["'Traction'", "sqrt(1 - t)", "is not finite at (1, "], formula_ends(1)),
    "conductor that warms": (WARMING, "time step", ["'Time step'", "'euler'"], limit_is_passed),
    "less and less capacity": (LESS_CAPACITY, "time step", ["'Time step'", "'euler'"], limit_is_passed),
    "strip that is pulled": (PULLED.replace("STEP", "0.0090"), "time step", ["'Time step'", "'verlet'", "stiffer"], limit_is_passed),
    "fragment that flies": (FLYING, "parts flying off", ["'Kinematics = linear'", "have broken"], has_flown_off),
}


def check_readable(run, name, until):
    """Whole files of finite numbers, none of them later than that."""
    files = glob.glob(os.path.join(run.folder, "fields", "*.h5"))
    check(len(files) > 0, f"{name}: no fields are left")
    for path in files:
        with h5py.File(path) as file:
            file.visititems(lambda key, item: check(not isinstance(item, h5py.Dataset) or numpy.all(numpy.isfinite(item[()])), f"{name}: {path} {key}"))
    for path in glob.glob(os.path.join(run.folder, "*.xdmf")) + glob.glob(os.path.join(run.folder, "*.pvd")):
        xml.parse(path)
    times = [row["time"] for row in run.totals]
    check(len(times) > 0 and max(times) < until, f"{name}: the last totals are of t = {max(times, default=None)}, the run was stopped at {until}")
    check(all(math.isfinite(row["value"]) for row in run.totals), f"{name}: totals that are not finite")


def stopped():
    rows = []
    for name, (scene, monitor, words, first_growth) in RUNS.items():
        steps = []
        for ranks in (1, 2):
            run = run_scene(scene, {"Checkpoint/Every": "1 s"}, ranks, expect_error=True)
            check(run.summary["status"] == "diverged", f"{name}: {run.summary['status']}")
            if not check("guard" in run.summary, f"{name}: no guard has found it: {run.stderr}"):
                continue
            guard = run.summary["guard"]
            check(guard["monitor"] == monitor, f"{name}: {guard}")
            check_message(run, *words, what=name)
            check(run.summary["message"] in run.stderr, f"{name}: the summary's message is another one")
            check_readable(run, name, guard["time"])
            first = first_growth(run)
            check(first <= guard["step"] <= first + SOON, f"{name}: stopped after {guard['step']} steps, growing from step {first} on")
            steps.append(guard["step"])
            if ranks == 1:
                rows.append((name, guard["monitor"], guard["time"], guard["step"], guard["step"] - first))
        check(len(set(steps)) == 1, f"{name}: on 1 and 2 processes after {steps} steps")
    print_table("Stopped", ("run", "monitor", "at t", "step", "steps after the first growth"), rows)


def actions():
    # it flies on, and is told once
    run = run_scene(FLYING, {"Guards/Action": "warn", "Output/Fields": "none"})
    notes = [note for note in run.summary["notes"] if "flown off" in note]
    check(run.summary["status"] == "complete" and len(notes) == 1 and "'Action = stop'" in notes[0], f"warn: {run.summary['notes']}")
    silent = run_scene(FLYING, {"Guards/Action": "off", "Output/Fields": "none"})
    check(not any("flown off" in note for note in silent.summary["notes"]), f"off: {silent.summary['notes']}")
    check([row["value"] for row in run.totals] == [row["value"] for row in silent.totals], "guards change no result")
    # what has no value is an error in any case
    for action in ("warn", "off"):
        run = run_scene(SOURCE_ENDS, {"Guards/Action": action}, expect_error=True)
        check(run.summary["status"] == "diverged" and "sqrt(0.05 - t)" in run.stderr, f"{action}: {run.stderr}")
    findings_of_solvers()
    # a first step that is short since nothing changes yet is none that leads nowhere
    run = run_scene(SLOW_START)
    check(run.summary["status"] == "complete" and run.model("finite elements")["steps"] > 100, f"slow start: {run.summary['status']}")


def findings_of_solvers():
    """Where solvers notice something by themselves `warn` and `off` go on, too, until nothing is finite.

    When that is depends on the last digits of an inverted body: from t = 3.6 to beyond 4 on different processors.
    """
    scene = PULLED.replace("STEP", "0.0090")
    words = ("'verlet' is stable up to", "the body is inside out", "The energy of the motion is not kept")
    numbers = {}
    for action, ranks in (("warn", 1), ("warn", 2), ("off", 1)):
        what = f"strip that is pulled, {action} on {ranks}"
        run = run_scene(scene, {"Guards/Action": action, "Output/Fields": "none", "Time/End time": "2"}, ranks)
        notes = told_by(run)
        check(run.summary["status"] == "complete" and "guard" not in run.summary, f"{what}: {run.summary['status']}")
        check_told(notes, words if action == "warn" else (), what)
        numbers[what] = [row["value"] for row in run.totals], [note.split(": ")[0] for note in notes]
    whole, two, silent = numbers.values()
    check(whole[0] == silent[0], "guards change no result of a solver")
    check(whole[1] == two[1], f"notes of {whole[1]}, and of {two[1]} on two processes")
    # until that, and nothing is told again by a run that is resumed
    for action in ("warn", "off"):
        settings = {"Guards/Action": action, "Time/End time": "8", "Checkpoint/Times": "2"}
        run = run_scene(scene, settings, expect_error=True)
        for what in (f"{action}, until nothing is finite", f"{action}, resumed"):
            is_resumed = "resumed" in what
            guard = run.summary.get("guard", {})
            check(run.summary["status"] == "diverged" and guard.get("monitor") == "finite values", f"{what}: {run.summary['status']}, {guard}")
            check(2 < guard["time"] < 8, f"{what}: at t = {guard['time']}")
            check(("resumed at t = 2," in run.stdout) == is_resumed, f"{what}: {run.stdout}")
            told = [line for line in run.stdout.splitlines() if TOLD in line]  # summary.json may be that of an earlier time of output
            check_told(told, words if action == "warn" and not is_resumed else (), what)
            if not is_resumed:
                arguments = ["run", os.path.join(os.path.dirname(run.folder), "scene.prm"), "--resume", "-s", f"Output directory={run.folder}"]
                result = run_perideal(arguments + [word for entry, value in settings.items() for word in ("-s", f"{entry}={value}")])
                run = Run(run.folder, *result)


def told_by(run):
    return [note for note in run.summary["notes"] if TOLD in note]


def check_told(notes, words, what):
    """One note with each of the words, in their order."""
    check(len(notes) == len(words) and all(word in note for word, note in zip(words, notes)), f"{what}: {notes}")


def check_told_of(what, run, monitor, words, first=0, last=math.inf):
    """The run has ended between two times, and says so in its summary; returns the guard."""
    check(run.summary["status"] == "diverged", f"{what}: {run.summary['status']}")
    guard = run.summary.get("guard", {})
    check(guard.get("monitor") == monitor, f"{what}: {guard}, {run.stderr}")
    check_message(run, *words, what=what)
    check(first <= guard.get("time", -1) <= last, f"{what}: {guard}")
    return guard


def told():
    # a formula that fails on one process only, in the load steps of a body at rest
    messages = [run_scene(PULL_ENDS, {"Output/Fields": "none", **more}, ranks, expect_error=True)
                for more, ranks in (({}, 1), ({}, 2), ({"Models": "peridynamics"}, 2))]
    for run in messages:
        check_told_of("pull without a value", run, "finite values", ["'Displacement'", "sqrt(0.5 - t)", "t = 0.6"], 0.59, 0.61)
    check(messages[0].stderr == messages[1].stderr, f"{messages[0].stderr} on two processes: {messages[1].stderr}")
    # a material that is none any more, with and without results before that
    for model in ("finite elements", "peridynamics"):
        for more in ({}, {"Output/Write at": "0.2"}, {"Time/Stepper": "sdirk2"}):
            run = run_scene(CONDUCTS_NO_MORE, {"Models": model, "Output/Fields": "none", **more}, expect_error=True)
            guard = check_told_of(f"conducts no more, {model}", run, "formulas", [f"{model}, t = 0.", "'Conductivity'", "T = 0.5", "at (0"], 0.45, 0.7)
            check(guard["value"] is not None and -0.2 < guard["value"] <= 0 and guard["place"][0] < 0.05, f"conducts no more, {model}: {guard}")
    run = run_scene(CONDUCTS_NO_MORE, {"Material/Conductivity": "sqrt(0.5 - T)", "Output/Fields": "none"}, expect_error=True)
    check_told_of("root of the temperature", run, "formulas", ["peridynamics, t = 0.", "sqrt(0.5 - T)", "T = 0.5"], 0.45, 0.7)
    check("t = 0," not in run.stderr, f"a time that is none: {run.stderr}")
    # a solver that does not converge, behind another run
    run = run_scene(STEADY)
    again = ["run", os.path.join(os.path.dirname(run.folder), "scene.prm"), "-s", f"Output directory={run.folder}"]
    for entry, is_mistake in (("Material/Conductivity=x - 0.5", True), ("Material/Conductivity=if((x-0.5)^2+(y-0.5)^2<0.04,1e12,1e-12)", False)):
        failed = Run(run.folder, *run_perideal(again + ["-s", entry, "-s", "Solver/Direct solver up to=10"]))
        check(failed.returncode == 1, f"{entry}: {failed.returncode}")
        check(failed.summary["status"] == ("complete" if is_mistake else "diverged"), f"{entry}: {failed.summary['status']}")
    check_told_of("steady contrast", failed, "solver", ["peridynamics: The linear solver", "1e+12"])
    run = run_scene(PULL_ENDS, {"Boundary conditions/Displacement": "left: 0, 0", "Boundary conditions/Traction": "right: 1e300, 0"}, expect_error=True)
    check_told_of("results beyond all numbers", run, "finite values", ["1e308"])
    # the place of the message
    run = run_scene(FOLDED, {"Output/Fields": "none"}, expect_error=True)
    guard = check_told_of("folded", run, "inversion", ["worst at (" + ", ".join(f"{x:g}" for x in run.summary["guard"]["place"]) + ")"])
    check(len(guard["place"]) == 2, f"folded: {guard}")
    # a jump whose work is none
    for stepper, step in (("verlet", "0.003"), ("newmark", "0.003")):
        run = run_scene(JUMPING, {"Output/Fields": "none", "Time/Stepper": stepper, "Time/Time step": step})
        check(run.summary["status"] == "complete", f"jump with {stepper}: {run.summary['status']}")


def share():
    """Of the wall time; printed, since timings are no tests. That the guards looked is one."""
    rows = []
    for name, scene, more in (("plate, euler", SOURCE_ENDS, {"Initial and source/Source": "10", "Domain/Cells": "100, 100", "Time/End time": "0.02"}),
                              ("strip, verlet", TRACTION_ENDS, {"Boundary conditions/Traction": "right: 0.1, 0", "Domain/Cells": "160, 40", "Time/End time": "0.5"})):
        run = run_scene(scene, {**more, "Output/Fields": "none", "Output/Write every": ""})
        spent = run.summary["wall time"]["guards"]
        whole = run.model("peridynamics")["wall time"]["time stepping"]
        check(spent > 0, f"{name}: the guards have looked")
        rows.append((name, run.model("peridynamics")["steps"], whole, spent, f"{100 * spent / whole:.2f} %"))
    print_table("What guards take", ("run", "steps", "time stepping, s", "guards, s", "share"), rows)


if __name__ == "__main__":
    run_parts(stopped, actions, share, told)
