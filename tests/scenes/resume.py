# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Runs that are stopped and go on give what an uninterrupted run gives.

    resume.py heat | cracks | motion | loading      stopped by the limit of their wall time, after the first step and later
    resume.py running                               the same, while a crack runs through a blended zone that follows it
    resume.py ranks                                 the same, resumed on another number of processes
    resume.py mistakes                              nothing to resume, other scenes, damaged files
    resume.py interrupted                           SIGINT to the whole process group within a step of seconds, on 1 and 2 processes
    resume.py signals                               stopped by SIGTERM and SIGKILL at random moments, on 1 and 2 processes (long)

On the same number of processes all is the same to the last bit, also with solvers, whose preconditioner is made for what it was made for; there 1e-12 of
the largest value of a column is allowed (5e-14 seen by hand: `newmark` beside a growing crack, which is cut out of the matrix in one go; a zone that follows
cracks is put into the matrix anew).
"""

import csv
import functools
import glob
import json
import math
import os
import random
import shutil
import signal
import subprocess
import time

import h5py

from scene_test import SOURCE_DIR, Run, check, check_clean_error, check_message, run_parts, temporary_folder
from scene_test import EXECUTABLE, environment, on_processes  # signals need the process itself

IMPLICIT = 1e-12

HEAT = {"Domain/Cells": "24, 24"}
IMAGE = {"Domain/Pixels per cell": "4", "Peridynamics/Horizon ratio": "2", "Elasticity/Solver": "dynamics", "Material/Density": "1",
         "Time/End time": "1", "Output/Write every": "0.5"}
YIELDING = {"Domain/Cells": "24, 24", "Elasticity/Solver": "dynamics", "Material/Density": "1", "Boundary conditions/Displacement": "", "Boundary conditions/Symmetry": "",
            "Boundary conditions/Velocity": "right: 0.3*min(t, 0.1), free ; left: 0, free", "Time/Time step": "auto", "Time/End time": "0.6", "Output/Write at": "0.3"}
NOTCHED = {"Domain/Cells": "8, 4, 4", "Elasticity/Contact": "false", "Cracks/Polygons": "1,0.5,-1 ; 1,2,-1 ; 1,2,2 ; 1,0.5,2", "Solver/Tolerance": "1e-13"}
STRUCK = {**NOTCHED, "Elasticity/Solver": "dynamics", "Material/Density": "1.0", "Boundary conditions/Displacement": "", "Boundary conditions/Velocity": "right: 0.3*min(1, 20*t), free, free",
          "Time/Time step": "auto", "Time/End time": "0.3", "Output/Write every": "0.1"}
YIELDING_BONDS = {"Elasticity/Solver": "dynamics", "Material/Density": "1.0", "Boundary conditions/Displacement": "left: 0", "Boundary conditions/Velocity": "right: 0.1*min(1, 20*t)",
                  "Time/Time step": "auto", "Time/End time": "0.3", "Output/Write every": "0.1"}
RUBBER = {"Domain/Cells": "24, 6", "Elasticity/Solver": "dynamics", "Material/Density": "1.0", "Boundary conditions/Displacement": "bottom: 0, 0", "Initial and source/Initial displacement": "0, 0.1*y", "Time/Time step": "auto",
          "Time/End time": "1", "Output/Write at": "0.5"}
NODAL = {"Elasticity/Model": "correspondence", "Peridynamics/Horizon ratio": "2", "Peridynamics/Kernel exponent": "auto"}
BLENDED = {**NODAL, "Models": "coupled", "Domain/Nodes": "vertices", "Coupling/Scheme": "blending", "Coupling/Zone": "1.15 - sqrt(x^2 + y^2)", "Coupling/Overlap": "1"}
STRETCHED = {"Domain/Cells": "4, 2, 2", "Material/User properties": "1000, 0.3, 1000, 0, 100", "Elasticity/Kinematics": "full", "Solver/Tolerance": "1e-13", "Boundary conditions/Symmetry": "", "Boundary conditions/Displacement": "left: 0, 0, 0 ; right: 0.1*t, 0.1*t, 0.05*t",
             "Time/End time": "4", "Output/Line": ""}
# Bodies that yield: in a spot that warms up; in a temperature that stays, by what pulls at them.
HEATED = {"Domain/Cells": "8, 8", "Initial and source/Source": "if(t < 5, 7e8*exp(-(x^2 + y^2)/0.02^2), 0)", "Time/End time": "20", "Time/Time step": "2", "Output/Write at": "6, 12",
          "Solver/Tolerance": "1e-13"}
PULLED = {"Domain/Cells": "8, 8", "Initial and source/Source": "0", "Boundary conditions/Convection": "", "Boundary conditions/Dirichlet": "right: 320 ; top: 20",
          "Boundary conditions/Displacement": "right: 2e-4*t, free", "Time/Steady": "true", "Time/End time": "1", "Time/Time step": "0.1", "Output/Write at": "0.5", "Solver/Tolerance": "1e-13"}
# Moduli that follow the temperature, without sides whose forces are round-off. The preconditioner of a resumed run is that of the reference temperature; measured: 3e-12.
FOLLOWING = 1e-11
SOFTENS = {**HEATED, "Material/Young modulus": "210e9*(1 - (T/900)^2)", "Material/Thermal expansion": "1.2e-5 + 4e-9*(T - 20)", "Boundary conditions/Displacement": "right: 1e-5*t, free"}
GETS_HOT = {"Domain/Cells": "8, 4", "Boundary conditions/Symmetry": "bottom", "Boundary conditions/Displacement": "left: 0, 0 ; top: 0, 1e-4", "Time/Steady": "false", "Time/End time": "1e5", "Output/Write at": "2e4, 5e4", "Output/Line": "",
            "Output/Probes": "0.1,0.1 ; 0.3,0.13", "Solver/Tolerance": "1e-14"}
SCENES = {
    "heat": [("heat/convection.prm", {**HEAT, "Time/Stepper": stepper}, tolerance)
             for stepper, tolerance in (("euler", 0), ("rk4", 0), ("rkc2", 0), ("chebyshev", 0), ("crank nicolson", IMPLICIT),
                                        ("bdf2", IMPLICIT), ("sdirk2", IMPLICIT))]
    + [("heat/temperature_dependent.prm", {}, 0)],
    "cracks": [("coupling/growing_cracks.prm", {}, 0), ("coupling/growing_cracks.prm", {"Domain/Cells": "24, 24", "Time/Stepper": "bdf2"}, IMPLICIT),
               ("heat/closing_crack.prm", {}, 0),
               ("coupling/adaptive_zone.prm", {"Domain/Cells": "24, 24"}, 0)],
    "motion": [("fracture/branching_crack.prm", {"Time/End time": "2.5e-5", "Domain/Cells": "60, 24"}, 0), ("fracture/struck_pieces.prm", {}, 0),
               ("fracture/branching_crack.prm", {"Time/End time": "2.5e-5", "Domain/Cells": "60, 24", "Elasticity/Plane": "strain", "Material/Law": "viscoelastic", "Material/Relaxation": "0.5, 1e-5"}, 0),
               ("fracture/branching_crack.prm", {"Time/End time": "2.5e-5", "Domain/Cells": "60, 24", "Elasticity/Plane": "strain", "Material/Law": "viscoelastic", "Material/Relaxation": "0.5, 1e-5", **NODAL}, 0),
               ("fracture/branching_crack.prm", {"Time/End time": "2.5e-5", "Domain/Cells": "61, 25", "Domain/Nodes": "cell centers", "Elasticity/Kinematics": "full", "Material/Rate factor": "1 + 1e-5*rate"}, 0),
               ("elasticity/yielding_plate.prm", YIELDING, 0), ("elasticity/yielding_plate.prm", {**YIELDING, **NODAL}, 0), ("elasticity/yielding_plate.prm", {**YIELDING, **BLENDED}, IMPLICIT), ("elasticity/user_law.prm", STRUCK, 0), ("elasticity/hyperelastic_block.prm", RUBBER, 0),
               ("elasticity/user_law.prm", {**STRUCK, **NODAL, "Models": "peridynamics"}, 0), ("fracture/branching_crack.prm", {"Time/End time": "2.5e-5", "Domain/Cells": "60, 24", **NODAL}, 0),
               ("fracture/branching_crack.prm", {"Time/End time": "2.5e-5", "Domain/Cells": "60, 24", "Material/Law": "softening", "Material/Tensile strength": "3e7"}, IMPLICIT), # what is left of a bond is a product of shares
               ("elasticity/user_bonds.prm", YIELDING_BONDS, 0),
               ("fracture/colliding_bars.prm", {}, 0), ("fracture/branching_crack.prm", {"Time/End time": "2.5e-5", "Models": "coupled", "Domain/Cells": "60, 25", "Domain/Nodes": "vertices", "Coupling/Zone": "follow"}, IMPLICIT),
               ("elasticity/impact_on_strip.prm", {}, 0), ("papers/le_2014/cooling.prm", IMAGE, 0)],
    "loading": [("elasticity/yielding_ring.prm", {"Domain/Refinements": "2", "Time/Time step": "0.5", "Solver/Tolerance": "1e-13"}, IMPLICIT), ("elasticity/hyperelastic_block.prm", {"Domain/Cells": "24, 6", "Solver/Tolerance": "1e-13", "Output/Write at": "1"}, IMPLICIT), ("elasticity/user_law.prm", NOTCHED, IMPLICIT), ("elasticity/user_law.prm", {**NOTCHED, **NODAL, "Models": "peridynamics"}, IMPLICIT), ("elasticity/user_law.prm", STRETCHED, IMPLICIT), ("elasticity/user_law.prm", {**STRETCHED, **NODAL, "Models": "peridynamics"}, IMPLICIT), ("elasticity/heated_spot.prm", HEATED, IMPLICIT), ("elasticity/heated_spot.prm", PULLED, IMPLICIT), ("elasticity/heated_spot.prm", SOFTENS, FOLLOWING), ("elasticity/hot_wall.prm", GETS_HOT, IMPLICIT), ("elasticity/creeping_plate.prm", {"Domain/Cells": "16, 8", "Time/Time step": "0.5", "Solver/Tolerance": "1e-13"}, IMPLICIT), ("elasticity/creeping_plate.prm", {"Models": "peridynamics, coupled", "Domain/Cells": "16, 8", "Time/Time step": "0.5", "Solver/Tolerance": "1e-13", **NODAL}, IMPLICIT), ("elasticity/yielding_plate.prm", {"Domain/Cells": "16, 16", "Solver/Tolerance": "1e-12"}, IMPLICIT),
                ("elasticity/yielding_plate.prm", {"Domain/Cells": "12, 12", "Time/Time step": "0.1", "Solver/Tolerance": "1e-12", **NODAL}, IMPLICIT),
                ("elasticity/yielding_plate.prm", {"Domain/Cells": "12, 12", "Time/Time step": "0.1", "Time/End time": "1", "Output/Write at": "0.5", "Solver/Tolerance": "1e-12", **BLENDED}, IMPLICIT), ("fracture/following_zone.prm", {"Domain/Cells": "17, 25", "Solver/Tolerance": "1e-13"}, IMPLICIT),
                ("fracture/softening_zone.prm", {"Domain/Lower corner": "-0.0925, 0", "Domain/Upper corner": "0.0925, 0.05", "Domain/Cells": "37, 10", "Solver/Tolerance": "1e-13", "Time/End time": "0.6",
                                                 "Boundary conditions/Parts": "load: top if abs(x) < 0.0055 ; left foot: bottom if abs(x + 0.0625) < 0.00275 ; right foot: bottom if abs(x - 0.0625) < 0.00275"}, 10 * IMPLICIT), # what softens lets round-off grow
                ("fracture/snap_back.prm", {"Output/Probes": "", "Solver/Tolerance": "1e-13", "Time/End time": "0.7"}, 10 * IMPLICIT),
                ("fracture/blended_zone.prm", {"Domain/Cells": "25, 37", "Solver/Tolerance": "1e-13", "Time/Time step": "0.05", "Time/End time": "0.5"}, IMPLICIT),
                ("fracture/centre_crack.prm", {"Domain/Cells": "20, 40", "Peridynamics/Horizon ratio": "3", "Solver/Tolerance": "1e-13"}, IMPLICIT), ("elasticity/thermal_stress.prm", {"Domain/Cells": "12, 48"}, IMPLICIT),
                ("elasticity/heat_of_deformation.prm", {"Domain/Cells": "12, 12", "Time/End time": "1", "Output/Write at": "0.1"}, IMPLICIT),
                ("fracture/centre_crack.prm", {"Domain/Cells": "20, 40", "Peridynamics/Horizon ratio": "3", "Solver/Tolerance": "1e-13", "Elasticity/Breaking": "at rest"}, IMPLICIT),
                ("fracture/oblique_crack_growth.prm", {"Domain/Cells": "24, 24", "Peridynamics/Horizon ratio": "3", "Solver/Tolerance": "1e-13", "Elasticity/Crack direction": "mean tension"}, IMPLICIT),
                ("fracture/scattered_strength.prm", {"Domain/Cells": "16, 16", "Solver/Tolerance": "1e-13"}, IMPLICIT),
                ("fracture/critical_stress.prm", {"Domain/Cells": "16, 32", "Solver/Tolerance": "1e-13", "Material/Critical stress": "1 - 0.2*t"}, IMPLICIT),
                ("elasticity/growing_crack.prm", {"Domain/Cells": "66, 11", "Solver/Tolerance": "1e-13"}, IMPLICIT),
                ("fracture/branching_crack.prm", {"Time/End time": "2.5e-5", "Domain/Cells": "60, 24", "Time/Stepper": "newmark", "Time/Time step": "2e-7", "Solver/Tolerance": "1e-13"}, IMPLICIT)],
}
# Runs of some seconds, which signals can meet on their way.
LONGER = {
    "euler": {"Domain/Cells": "60, 60"}, "rk4": {"Domain/Cells": "60, 60"}, "rkc2": {"Domain/Cells": "96, 96"}, "chebyshev": {"Domain/Cells": "240, 240"},
    "crank nicolson": {"Domain/Cells": "40, 40"}, "bdf2": {"Domain/Cells": "40, 40"}, "sdirk2": {"Domain/Cells": "40, 40"},
    "coupling/adaptive_zone.prm": {"Domain/Cells": "96, 96"}, "elasticity/impact_on_strip.prm": {"Time/End time": "30"},
    "papers/le_2014/cooling.prm": {"Time/End time": "20"}, "fracture/branching_crack.prm": {"Domain/Cells": "121, 49"}, "heat/closing_crack.prm": {"Domain/Cells": "121, 121"},
}


def command(scene, folder, overrides, more, ranks):
    words = [EXECUTABLE, "run", os.path.join(SOURCE_DIR, "prm", scene), "-s", f"Output directory={folder}"]
    for entry, value in overrides.items():
        words += ["-s", f"{entry}={value}"]
    return on_processes(words + list(more), ranks)


def run(scene, folder, overrides, more=(), ranks=1):
    """A run in a folder; the exit status is the caller's."""
    return subprocess.run(command(scene, folder, overrides, more, ranks), env=environment(), capture_output=True, text=True, timeout=900, check=False)


def new_folder():
    return os.path.join(temporary_folder(), "results")


def tables_of(folder):
    found = {}
    for path in sorted(glob.glob(os.path.join(folder, "*.csv"))):
        with open(path, newline="") as file:
            found[os.path.basename(path)] = list(csv.reader(file))
    return found


def fields_of(folder):
    found = {}
    for path in sorted(glob.glob(os.path.join(folder, "fields", "*.h5"))):
        with h5py.File(path) as file:
            file.visititems(lambda name, item, key=os.path.basename(path): found.__setitem__(f"{key}: {name}", item[()].tobytes())
                            if isinstance(item, h5py.Dataset) else None)
    return found


def number(word):
    try:
        return float(word)
    except ValueError:
        return None


def group(row):
    """Values of a group of rows are compared with the largest of all of them: forces with forces, energies with energies."""
    words = row[2] if len(row) == 4 else ""
    return next((word for word in ("force", "stress", "energy") if word in words), "other")


def difference(rows, others):
    """The largest of numbers over the largest value of their group and column; infinite where texts differ."""
    if len(rows) != len(others):
        return math.inf
    largest, worst = {}, {}
    for row, other in zip(rows, others):
        for column, (word, found) in enumerate(zip(row, other)):
            a, b = number(word), number(found)
            if a is None or b is None or math.isnan(a) or math.isnan(b):
                if word != found:
                    return math.inf
                continue
            key = (group(row), column)
            largest[key] = max(largest.get(key, 0.), abs(a))
            worst[key] = max(worst.get(key, 0.), abs(a - b))
    return max((worst[key] / largest[key] if largest[key] > 0. else math.inf) for key in worst if worst[key] > 0.) if any(worst.values()) else 0.


def compare(whole, resumed, tolerance, what):
    """Tables within the tolerance; fields to the last bit where that is 0."""
    tables, others = tables_of(whole), tables_of(resumed)
    check(sorted(tables) == sorted(others), f"{what}: tables {sorted(others)} in place of {sorted(tables)}")
    found = max((difference(rows, others[name]) for name, rows in tables.items()), default=math.inf)
    check(found <= tolerance, f"{what}: tables differ by {found:.2e}, allowed {tolerance:.0e}")
    fields, others = fields_of(whole), fields_of(resumed)
    check(sorted(fields) == sorted(others), f"{what}: files of fields differ")
    if tolerance == 0:
        different = [name for name, values in fields.items() if values != others[name]]
        check(not different, f"{what}: {len(different)} of {len(fields)} fields differ, first {different[:1]}")
    return found


def check_stopped(result, folder, what):
    check(result.returncode == 3, f"{what}: exit status {result.returncode}, expected 3\n{result.stderr[-500:]}")
    check("--resume" in result.stderr, f"{what}: no line that resumes")
    check(bool(glob.glob(os.path.join(folder, "checkpoints", "*.h5"))), f"{what}: no checkpoint")


def check_scene(scene, overrides, tolerance):
    """Stopped after the first step, after about a third of its time, and then not at all."""
    overrides = {"Output/Fields": "hdf5", **overrides}
    whole, resumed = new_folder(), new_folder()
    start = time.monotonic()
    result = run(scene, whole, overrides)
    took = time.monotonic() - start
    what = f"{scene} {overrides.get('Time/Stepper', '')}"
    check(result.returncode == 0, f"{what}: exit status {result.returncode}\n{result.stderr[-500:]}")
    result = run(scene, resumed, {**overrides, "Checkpoint/Wall time limit": "0.001 s"})
    check_stopped(result, resumed, what)
    result = run(scene, resumed, {**overrides, "Checkpoint/Wall time limit": f"{0.3 * took:.3f} s"}, ["--resume"])
    stopped = result.returncode == 3
    if stopped:
        result = run(scene, resumed, overrides, ["--resume"])
    check(result.returncode == 0, f"{what}: resumed, exit status {result.returncode}\n{result.stderr[-500:]}")
    check(not os.path.exists(os.path.join(resumed, "checkpoints")) or not os.listdir(os.path.join(resumed, "checkpoints")),
          f"{what}: a complete run leaves checkpoints")
    found = compare(whole, resumed, tolerance, what)
    print(f"{what}: stopped {1 + stopped} times, difference {found:.1e}")


RUNNING = {"Models": "coupled", "Domain/Cells": "60, 25", "Domain/Nodes": "vertices", "Peridynamics/Horizon ratio": "3", "Coupling/Scheme": "blending",
           "Coupling/Overlap": "1", "Coupling/Zone": "follow", "Boundary conditions/Traction": "top: 0, 18e6; bottom: 0, -18e6", "Time/Time step": "2e-7",
           "Time/End time": "1.4e-5", "Output/Write every": "4e-7", "Output/Fields": "hdf5"}


def last_broken(folder):
    rows = [row for row in tables_of(folder).get("totals.csv", []) if len(row) == 4 and row[2] == "broken bonds"]
    return max((number(row[3]) or 0. for row in rows), default=0.)


def last_values(folder):
    """The fields of the last output."""
    found = {}
    with h5py.File(max(glob.glob(os.path.join(folder, "fields", "*.h5")), key=os.path.getmtime)) as file:
        file.visititems(lambda name, item: found.__setitem__(name, item[()]) if isinstance(item, h5py.Dataset) else None)
    return found


def check_running():
    """Stopped by SIGTERM once some of the bonds that break have broken, and the zone has grown."""
    scene, whole, resumed = "fracture/branching_crack.prm", new_folder(), new_folder()
    check(run(scene, whole, RUNNING).returncode == 0, scene)
    all_broken = last_broken(whole)
    check(all_broken > 200, f"bonds break: {all_broken}")
    process = subprocess.Popen(command(scene, resumed, RUNNING, (), 1), env=environment(), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    while process.poll() is None and not last_broken(resumed) > 0.1 * all_broken:
        time.sleep(0.02)
    process.send_signal(signal.SIGTERM)
    _, stderr = process.communicate(timeout=120)
    until_then = last_broken(resumed)
    check_stopped(Run("", process.returncode, "", stderr), resumed, scene)
    check(0 < until_then < 0.9 * all_broken, f"stopped with {until_then} of {all_broken} broken bonds")
    check(run(scene, resumed, RUNNING, ["--resume"]).returncode == 0, "resumed")
    found = compare(whole, resumed, IMPLICIT, scene)
    fields, others = last_values(whole), last_values(resumed)
    check(sorted(fields) == sorted(others) and any("displacement" in name for name in fields), f"fields {sorted(fields)}, {sorted(others)}")
    for name, values in fields.items():
        gap, size = abs(values - others[name]).max(), abs(values).max()
        check(gap <= IMPLICIT * size, f"{name}: differs by {gap:.2e} of {size:.2e}")
    print(f"{scene}, blended: stopped with {until_then:.0f} of {all_broken:.0f} broken bonds, difference {found:.1e}")


def check_ranks():
    """Explicit peridynamics does not ask how many processes there are; others do by round-off."""
    for scene, overrides, tolerance in (("coupling/growing_cracks.prm", {"Domain/Cells": "24, 24"}, 1e-10),
                                        ("elasticity/yielding_ring.prm", {"Domain/Refinements": "3", "Time/Time step": "2", "Time/End time": "10", "Output/Write at": "2, 10", "Solver/Tolerance": "1e-13"}, 1e-10),
                                        ("elasticity/user_law.prm", NOTCHED, 1e-10),
                                        ("fracture/branching_crack.prm", {"Domain/Cells": "60, 24", "Time/Time step": "2e-7"}, 1e-10)):
        whole, resumed = new_folder(), new_folder()
        check(run(scene, whole, overrides).returncode == 0, scene)
        check_stopped(run(scene, resumed, {**overrides, "Checkpoint/Wall time limit": "0.1 s"}), resumed, scene)
        result = run(scene, resumed, overrides, ["--resume"], ranks=2)
        check(result.returncode == 0, f"{scene} on 2 processes: exit status {result.returncode}\n{result.stderr[-500:]}")
        found = max(difference(rows, tables_of(resumed)[name]) for name, rows in tables_of(whole).items())
        check(found <= tolerance, f"{scene}: resumed on 2 processes, tables differ by {found:.2e}")
        print(f"{scene}: resumed on 2 processes, difference {found:.1e}")


def check_mistakes():
    scene, overrides = "heat/convection.prm", {**HEAT}

    def refused(result, *words):
        one = Run("", result.returncode, result.stdout, result.stderr)
        check_clean_error(one, f"expected {words}")
        check_message(one, *words)

    folder = new_folder()
    refused(run(scene, folder, overrides, ["--resume"]), "resume")
    check(not os.path.exists(folder) or not os.listdir(folder), "nothing to resume: a folder is left")
    stop = {"Checkpoint/Wall time limit": "0.001 s"}
    check_stopped(run(scene, folder, {**overrides, **stop}), folder, scene)
    before = {name: os.path.getmtime(name) for name in glob.glob(os.path.join(folder, "**"), recursive=True) if os.path.isfile(name)}
    refused(run(scene, folder, overrides), "--resume", "--overwrite")
    refused(run(scene, folder, {**overrides, "Material/Density": "3"}, ["--resume"]), "Density", "Material")
    refused(run(scene, folder, {**overrides, "Domain/Cells": "25, 24"}, ["--resume"]), "Cells", "Domain")
    after = {name: os.path.getmtime(name) for name in before if os.path.exists(name)}
    lost = [name for name in before if name not in after and ".perideal" not in name]
    check(not lost, f"a refused run has lost {lost}")

    # An image that has changed since.
    image = os.path.join(new_folder() + ".png")
    shutil.copy(os.path.join(SOURCE_DIR, "prm/papers/le_2014/images/cross_section.png"), image)
    of_image, other = {**IMAGE, "Domain/Image": image}, new_folder()
    check_stopped(run("papers/le_2014/cooling.prm", other, {**of_image, **stop}), other, "image")
    with open(image, "ab") as file:
        file.write(b"\n")
    refused(run("papers/le_2014/cooling.prm", other, of_image, ["--resume"]), "'Image' in section 'Domain'", "changed")

    # Bonds are numbered by the crack of the start, which depends on the steps of its growth and these on the end.
    growth, other = {"Models": "peridynamics", "Domain/Cells": "30, 5", "Cracks/Growth": "2: 0, 2,0", "Cracks/Growth step": "0.3", "Output/Write at": ""}, new_folder()
    check_stopped(run("elasticity/growing_crack.prm", other, {**growth, **stop}), other, "a crack that grows")
    refused(run("elasticity/growing_crack.prm", other, {**growth, "Time/End time": "1.1"}, ["--resume"]), "'End time' in section 'Time'", "grow")
    check(run("elasticity/growing_crack.prm", other, growth, ["--resume"]).returncode == 0, "a crack that grows, with the same end")

    # A torn file is named, the one before is taken.
    check(run(scene, folder, {**overrides, **stop}, ["--resume"]).returncode == 3, "a second stop")
    files = sorted(glob.glob(os.path.join(folder, "checkpoints", "*.h5")), key=lambda name: int(os.path.basename(name)[:-3]))
    check(len(files) == 2, f"{len(files)} checkpoints are kept, expected 2")
    with open(files[1], "r+b") as file:
        file.truncate(os.path.getsize(files[1]) // 2)
    result = run(scene, folder, overrides, ["--resume"])
    check(result.returncode == 0, f"resumed from the one before: {result.stderr[-500:]}")
    check(os.path.basename(files[1]) in result.stdout + result.stderr, "the torn file is not named")
    whole = new_folder()
    check(run(scene, whole, overrides).returncode == 0, "whole")
    compare(whole, folder, 0, "after a torn file")

    # What may differ. This stepper takes more than one step to the first time of output.
    overrides["Time/Stepper"] = "rkc2"
    folder = new_folder()
    check_stopped(run(scene, folder, {**overrides, **stop}), folder, scene)
    refused(run(scene, folder, {**overrides, "Time/End time": "0.01", "Output/Write at": ""}, ["--resume"]), "End time",
            "on its way to t = 0.05")
    others = {"Title": "Another", "Checkpoint/Keep": "5", "Time/End time": "2.2", "Output/Write at": "0.02, 0.5, 1.7"}
    result = run(scene, folder, {**overrides, **others}, ["--resume"])
    check(result.returncode == 0, f"other times: {result.stderr[-500:]}")
    times = sorted({float(row[0]) for row in tables_of(folder)["totals.csv"][1:]})
    check(times == [0.5, 1.7, 2.2], f"other times of output: {times}")
    check("no results are written at t = 0.02" in result.stdout, "a time that was passed over is told")


# Steps of about a second, and one of several.
LONG_STEPS = {
    "chebyshev": ("quick_start.prm", {"Models": "peridynamics", "Domain/Cells": "500, 500", "Output/Write at": "", "Output/Fields": "none", "Time/End time": "4"}, 0),
    "sdirk2": ("quick_start.prm", {"Models": "peridynamics", "Domain/Cells": "500, 500", "Output/Write at": "", "Output/Fields": "none", "Time/Stepper": "sdirk2",
                                   "Time/Time step": "0.5", "Time/End time": "2.5", "Solver/Tolerance": "1e-13"}, IMPLICIT),
}


def long_enough(scene, settings):
    """With an end time that 2 processes do not reach before mpirun tells them of an interrupt, on fast machines too: the settings and the folder of the whole run."""
    for attempt in range(6):
        folder, start = new_folder(), time.monotonic()
        check(run(scene, folder, settings).returncode == 0, scene)
        if time.monotonic() - start > 6 or attempt == 5:
            return settings, folder
        settings = {**settings, "Time/End time": f"{2 * float(settings['Time/End time']):g}"}


def check_interrupted():
    """An interrupt is acknowledged at once, and the step is left: nothing of it is lost or counted."""
    for name, (scene, settings, tolerance) in LONG_STEPS.items():
        settings, whole = long_enough(scene, settings)
        for ranks in (1, 2):
            what, folder = f"{name} on {ranks}", new_folder()
            process = subprocess.Popen(command(scene, folder, settings, (), ranks), env=environment(), stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                       text=True, start_new_session=True)
            while "stepper" not in process.stdout.readline() and process.poll() is None:
                pass
            time.sleep(0.7)
            os.killpg(process.pid, signal.SIGINT)
            start, said = time.monotonic(), ""
            while "stopping" not in said and process.poll() is None:
                said += process.stderr.readline()
            acknowledged = time.monotonic() - start
            _, rest = process.communicate(timeout=60)
            # mpirun tells its processes after a second, and hands on what they say when it has killed them, another second later.
            check(acknowledged < (1. if ranks == 1 else 3.), f"{what}: acknowledged after {acknowledged:.1f} s")
            with open(os.path.join(folder, "summary.json")) as file:
                check(json.load(file)["status"] == "stopped", f"{what}: the summary does not say stopped")
            if ranks == 1:
                check_stopped(Run("", process.returncode, "", said + rest), folder, what)
            else:  # the launcher has a status of its own
                check(process.returncode in (1, 3), f"{what}: exit status {process.returncode}")
                check(bool(glob.glob(os.path.join(folder, "checkpoints", "*.h5"))), f"{what}: no checkpoint\n{said}{rest}")
            check(run(scene, folder, settings, ["--resume"], ranks=ranks).returncode == 0, f"{what}: resumed")
            # On two processes heat contents of halves that cancel differ in their last digits.
            found = compare(whole, folder, tolerance if ranks == 1 else 1e-8, what)
            print(f"{what}: acknowledged after {acknowledged:.2f} s, difference {found:.1e}")


def run_with_signals(kind, start, took, scene, settings, ranks):
    """A run that is ended at up to 5 random moments, after there is something to keep at start, and goes on each time: its folder and how often."""
    folder, more, n_stops = new_folder(), [], 0
    for attempt in range(8):
        process = subprocess.Popen(command(scene, folder, settings, more, ranks), env=environment(), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            process.wait(start + random.uniform(0., 0.4) * max(took - start, 0.5) if attempt < 5 else 900)
        except subprocess.TimeoutExpired:
            if kind == signal.SIGKILL and ranks > 1:
                subprocess.run(["pkill", "-KILL", "-f", folder], check=False)
            process.send_signal(kind)
            process.wait(120)
        if complete(folder):
            return folder, n_stops
        resumes = bool(glob.glob(os.path.join(folder, "checkpoints", "*.h5")))
        n_stops += resumes
        more = ["--resume"] if resumes else ["--overwrite"]
    check(False, f"{scene} on {ranks}, {kind.name}: exit status {process.returncode}")
    return folder, n_stops


def seconds_of(scene, folder, settings, ranks, status):
    """What a run takes that is to end with an exit status."""
    begin = time.monotonic()
    found = run(scene, folder, settings, ranks=ranks).returncode
    check(found == status, f"{scene} on {ranks}: exit status {found}, expected {status}")
    return time.monotonic() - begin


def complete(folder):
    """By its summary: mpirun has an exit status of its own where it is told to end."""
    path = os.path.join(folder, "summary.json")
    if not os.path.exists(path):
        return False
    with open(path) as file:
        return json.load(file)["status"] == "complete"


def check_signals():
    """At random moments, on 1 and 2 processes."""
    random.seed(4)
    for scene, overrides, tolerance in [one for part in SCENES.values() for one in part]:
        n_of_scene = 0
        for ranks in (1, 2):
            settings = {"Output/Fields": "hdf5", **overrides, **LONGER.get(scene, LONGER.get(overrides.get("Time/Stepper"), {}))}
            whole = new_folder()
            start = seconds_of(scene, new_folder(), {**settings, "Checkpoint/Wall time limit": "0.001 s"}, ranks, 3)
            took = seconds_of(scene, whole, settings, ranks, 0)
            start = min(start, 0.6 * took)  # mpirun takes a while to end with a status that is not 0
            for kind in (signal.SIGTERM, signal.SIGKILL):
                settings["Checkpoint/Every"] = "0.05 s" if kind == signal.SIGKILL else "0"
                folder, n_stops = run_with_signals(kind, start, took, scene, settings, ranks)
                n_of_scene += n_stops
                found = compare(whole, folder, tolerance, f"{scene} on {ranks}, {kind.name}")
                print(f"{scene} {overrides.get('Time/Stepper', '')} on {ranks}, {kind.name}: stopped {n_stops} times, difference {found:.1e}", flush=True)
        check(n_of_scene > 0, f"{scene}: no run went on from a checkpoint")


def check_scenes(part):
    for one in SCENES[part]:
        check_scene(*one)


if __name__ == "__main__":
    run_parts(running=check_running, interrupted=check_interrupted, ranks=check_ranks, mistakes=check_mistakes, signals=check_signals,
              **{part: functools.partial(check_scenes, part) for part in SCENES})
