# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""A physics that a program brings (applications/scalar_wave): its scene, report and mistakes, on 1 and 2 processes, stopped and resumed.

A product of sines is a wave of one frequency w in both models: in peridynamics by one sum over the family (tests/reference/harmonics.py), in finite
elements with lumped masses by the symbol of their stencil. Its amplitude at first is 1, and that of the lumped projection of the initial value in finite
elements, with Gauss' rule of two points. Central differences oscillate with W, sin(W dt/2) = w dt/2, and their energy falls short of that
of the start by (w dt/2)^2 sin(W t)^2 of it: all to round-off.
"""

import math
import os
import subprocess
import sys

from scene_test import SOURCE_DIR, Run, check, check_clean_error, check_message, finish, temporary_folder
from scene_test import environment, on_processes

sys.path.insert(0, os.path.join(SOURCE_DIR, "tests", "reference"))

from harmonics import CELLS, rate  # noqa: E402

PROGRAM = os.environ["PERIDEAL_SCALAR_WAVE"]
SCENE = os.path.join(SOURCE_DIR, "applications", "scalar_wave", "standing_wave.prm")
STEP = 0.0175  # divides the times of output


def run(*overrides, ranks=1, folder=None):
    if folder is None:
        folder = temporary_folder()
    words = [PROGRAM, SCENE, f"Output directory={folder}", f"Time/Time step={STEP}", *overrides]
    result = subprocess.run(on_processes(words, ranks), env=environment(), capture_output=True, text=True, timeout=300, check=False)
    return Run(folder, result.returncode, result.stdout, result.stderr)


def exact_rates():
    c = math.cos(math.pi / CELLS)
    return {"finite elements": 2 * CELLS ** 2 * (2 - 2 * c) * (4 + 2 * c) / 6, "peridynamics": rate(2, 3, "conical", 2)}


def amplitudes():
    """At first: the product of two means of cos(pi x) over the hat function of a node, or 1."""
    points = [(1 - 1 / math.sqrt(3)) / 2, (1 + 1 / math.sqrt(3)) / 2]
    mean = sum((1 - x) * math.cos(math.pi * x / CELLS) for x in points)
    return {"finite elements": mean ** 2, "peridynamics": 1.0}


def check_waves(found, what):
    check(found.returncode == 0, f"{what}: exit status {found.returncode}\n{found.stderr[-500:]}")
    for model, square in exact_rates().items():
        amplitude = amplitudes()[model]
        frequency = 2 / STEP * math.asin(STEP * math.sqrt(square) / 2)
        for t in (0.7, 1.4):
            for point, shape in (((0.5, 0.5), 1), ((0.25, 0.5), math.sqrt(0.5))):
                value, wanted = found.probe(model, point, t), shape * amplitude * math.cos(frequency * t)
                check(abs(value - wanted) < 1e-11, f"{what}: {model} at {point}, t = {t}: {value}, exact {wanted}")
        energy = [row["value"] for row in found.totals if row["model"] == model and row["quantity"] == "energy"]
        check(len(energy) == 2, f"{what}: {model}, energies {energy}")
        start, share = square * amplitude ** 2 / 8, square * STEP ** 2 / 4
        for t, total in zip((0.7, 1.4), energy):
            wanted = start * (1 - share * math.sin(frequency * t) ** 2)
            check(abs(total - wanted) < 1e-11 * square, f"{what}: {model}, energy {total} at t = {t}, exact {wanted}")


def main():
    whole = run()
    check_waves(whole, "1 process")
    check(whole.summary["physics"] == "wave" and whole.summary["names"]["field"] == "displacement", "names in the summary")
    check_waves(run(ranks=2), "2 processes")
    drawn = subprocess.run([sys.executable, os.path.join(SOURCE_DIR, "applications", "report", "report.py"), whole.folder], capture_output=True, text=True,
                           timeout=300, check=False)
    check(drawn.returncode == 0 and os.path.exists(os.path.join(whole.folder, "report.html")), f"its report: {drawn.stderr[-500:]}")

    stopped = run("Checkpoint/Wall time limit=0.001 s")  # after its first step
    check(stopped.returncode == 3, f"stopped: exit status {stopped.returncode}\n{stopped.stderr[-500:]}")
    resumed = run("--resume", folder=stopped.folder)
    check(resumed.returncode == 0, f"resumed: {resumed.stderr[-500:]}")
    for name in ("probes.csv", "totals.csv"):
        check(resumed.table(name) == whole.table(name), f"{name} of the resumed run differs")

    for override, words in (("Time/Steady=true", ["Steady"]), ("Time/Time step=1", ["Time step", "at most"]),
                            ("Boundary conditions/Dirichlet=left: 1", ["Dirichlet", "left"]), ("Physics=waves", ["Physics", "wave", "heat"])):
        refused = run(override)
        check_clean_error(refused, override)
        check_message(refused, *words)


if __name__ == "__main__":
    main()
    finish()
