# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""What `perideal check --estimate` says beside what runs take, and scenes that no machine can hold.

    estimates.py runs     # unknowns, bonds and memory within a factor of two
    estimates.py refused  # large lattices, without taking memory or time
    estimates.py steps    # steps and applications of the operator where the material depends on T
"""

import os
import re
import tempfile
import time

from scene_test import Run, check, check_clean_error, check_message, print_table, run_parts, run_perideal, run_scene, scene_text, write_file

# Scene, settings that leave it short, and a lattice that is small.
SCENES = [
    ("prm/quick_start.prm", {"Domain/Cells": "240, 240", "Time/End time": "2e-4", "Output/Write at": "", "Output/Line": ""}, "20, 20"),
    ("prm/elasticity/bar_2d.prm", {"Domain/Cells": "320, 160", "Output/Line": "", "Output/Fields": "none"}, "20, 10"),
    ("prm/heat/block_with_crack.prm", {"Domain/Cells": "33, 33, 33", "Time/End time": "1e-4", "Time/Steady": "false", "Output/Fields": "none",
                                       "Output/Write at": "", "Output/Write every": "", "Output/Line": ""}, "8, 8, 8"),
]

UNITS = {"B": 1, "kB": 1e3, "MB": 1e6, "GB": 1e9, "TB": 1e12}


def numbers_of(text):
    """{model: (unknowns, bonds)}, and bytes beyond those that the program has anyway."""
    models = {}
    for name, unknowns, bonds in re.findall(r"^(finite elements|peridynamics|coupled): about ([\d,]+) unknowns(?:, about ([\d,]+) bonds)?",
                                            text, re.MULTILINE):
        models[name] = (int(unknowns.replace(",", "")), int((bonds or "0").replace(",", "")))
    found = re.search(r"^memory: (?:about|at least) ([\d.]+) (\w+) at its peak, ([\d.]+) (\w+) of it taken already", text, re.MULTILINE)
    if not check(found is not None, f"no memory in:\n{text}"):
        return models, 0
    return models, float(found[1]) * UNITS[found[2]] - float(found[3]) * UNITS[found[4]]


def peak(run):
    return max(model["peak memory"] for model in run.summary["models"].values())


def within(what, estimate, true, factor, rows):
    check(true / factor <= estimate <= true * factor, f"{what}: estimated {estimate:.4g}, found {true:.4g}")
    rows.append((what, f"{estimate:.4g}", f"{true:.4g}", f"{estimate / true:.2f}" if true else ""))


def runs():
    rows = []
    for scene, settings, small in SCENES:
        options = [word for entry, value in settings.items() for word in ("-s", f"{entry}={value}")]
        status, stdout, stderr = run_perideal(["check", scene, "--estimate", *options], cwd=os.environ.get("PERIDEAL_SOURCE_DIR"))
        if not check(status == 0 and "two coarse lattices" in stdout, f"{scene}: {stdout}{stderr}"):
            continue
        models, memory = numbers_of(stdout)
        run, tiny = run_scene(scene, settings), run_scene(scene, {**settings, "Domain/Cells": small})
        check(set(models) == set(run.summary["models"]), f"{scene}: {sorted(models)}")
        for name, (unknowns, bonds) in models.items():
            model = run.model(name)
            within(f"{scene}: unknowns of {name}", unknowns, model["unknowns"], 1.05, rows)
            within(f"{scene}: bonds of {name}", bonds, model.get("bonds", 0), 1.5, rows)
        within(f"{scene}: memory", memory, peak(run) - peak(tiny), 2, rows)
    print_table("Estimates", ("what", "estimated", "found", "ratio"), rows)


def refused():
    """Each within some seconds and with hardly any memory; the program would need far more than is there to build them."""
    large = [("prm/quick_start.prm", {"Domain/Cells": "60000, 60000"}, ["memory", "'Cells'", "perideal check"]),
             ("prm/elasticity/bar_3d.prm", {"Domain/Cells": "1000, 1000, 1000", "Output/Line": ""}, ["memory", "'Cells'"]),
             ("prm/elasticity/bar_3d.prm", {"Domain/Cells": "3000, 3000, 3000", "Output/Line": ""}, ["'Cells'", "deal.II can number"]),
             ("prm/quick_start.prm", {"Domain/Cells": "60000, 60000", "Peridynamics/Horizon ratio": "500"}, ["memory", "'Horizon ratio'"])]
    rows = []
    for scene, settings, words in large:
        options = [word for entry, value in settings.items() for word in ("-s", f"{entry}={value}")]
        with tempfile.TemporaryDirectory() as folder:
            for command in (["run", scene, *options, "-s", f"Output directory={folder}/results"], ["check", scene, *options]):
                begin = time.monotonic()
                status, stdout, stderr = run_perideal(command, timeout=120, cwd=os.environ.get("PERIDEAL_SOURCE_DIR"))
                rows.append((" ".join(command[:4]), f"{time.monotonic() - begin:.1f} s", (stderr or stdout).strip().splitlines()[-1][:150]))
                if command[0] == "check" and "deal.II can number" not in words:
                    check(status == 0 and "a run is refused" in stdout, f"{command}: {stdout}{stderr}")
                    continue
                run = Run(folder, status, stdout, stderr)
                check_clean_error(run, str(settings))
                check_message(run, *words)
                check(not os.path.exists(f"{folder}/results"), f"{settings}: a folder was made")
    print_table("Refused", ("command", "time", "answer"), rows)


def steps():
    """The steps adapt to a solution that nobody knows yet; forecast from the first ones. Where these sum up to less than some seconds of
    processor time a forecast is the run itself, so that these bounds hold on slower machines, too."""
    scene = scene_text("""
Dimension = 2
Domain/Cells = 60, 60
Boundary conditions/Dirichlet = left: 1 ; right: 0
Time/End time = 0.05
Output/Fields = none
""")
    rows = []
    for what, settings in (("rkc2, conductivity 1 + T", {"Material/Conductivity": "1 + T", "Time/Stepper": "rkc2"}),
                           ("euler, conductivity 1 + 9 T^2", {"Material/Conductivity": "1 + 9*T^2", "Time/Stepper": "euler"}),
                           ("default, conductivity 1 + 9 T^2", {"Material/Conductivity": "1 + 9*T^2"}),
                           ("bdf2, heat capacity 1 + 5 T", {"Material/Heat capacity": "1 + 5*T", "Time/Stepper": "bdf2"})):
        options = [word for entry, value in settings.items() for word in ("-s", f"{entry}={value}")]
        stdout = run_perideal(["check", write_file("scene.prm", scene), *options])[1]
        found = re.findall(r"estimated: ([\d,]+) steps, ([\d,]+) operator applications", stdout)
        run = run_scene(scene, settings)
        check(len(found) == len(run.summary["models"]), f"{what}: {stdout}")
        for (name, model), numbers in zip(run.summary["models"].items(), found):
            for entry, number in zip(("steps", "operator applications"), numbers):
                within(f"{what}: {entry} of {name}", float(number.replace(",", "")), model[entry], 2, rows)
    print_table("Forecasts of steps", ("what", "estimated", "found", "ratio"), rows)


if __name__ == "__main__":
    run_parts(runs, refused, steps)
