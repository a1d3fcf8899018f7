# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Every scene of prm/ on a coarse lattice, with its fields written, some on two processes: it ends as it should and nothing complains.

Numbers are not looked at: this is for builds that watch themselves (./check --sanitize), where a run takes ten times as long.
Any report of a sanitizer and any failed Assert is a failure, printed with its scene.

    coarse_scenes.py [FOLDER of prm ...]      # all by default
"""

import glob
import math
import os
import re
import subprocess
import sys
import time

from failures import REFUSED
from scene_test import SOURCE_DIR, check, check_clean_error, finish, print_table, run_scene

CELLS = {1: 40, 2: 400, 3: 500}  # at most

# What a coarse lattice needs beside fewer cells.
IMAGE = {"Domain/Pixels per cell": "8", "Peridynamics/Horizon ratio": "2", "Domain/Extra layers": "3"}
CORNER = {"Domain/Upper corner": "0.6, 0.6, 0.6", "Domain/Cells": "9, 9, 9"}  # the horizon is a length
OVERRIDES = {
    "coupling/adaptive_zone.prm": {"Domain/Cells": "24, 24"},  # halved three times
    "coupling/graded_mesh.prm": {"Domain/Cells": "24, 24"},
    "elasticity/graded_crack.prm": {"Domain/Cells": "40, 40"},
    "fracture/cracked_block.prm": {"Domain/Cells": "16, 32, 2"},  # two layers, or bonds would lie in a plane
    "fracture/eccentric_notch.prm": {"Domain/Cells": "70, 20"},  # the load is on a part of a side
    "fracture/kalthoff_winkler_3d.prm": {"Domain/Cells": "13, 27, 2", "Peridynamics/Horizon": "0.016"},
    "fracture/struck_pieces.prm": {"Time/Time step": "auto"},  # not of a load
    "papers/diyaroglu_2017/example_d.prm": CORNER,
    "papers/diyaroglu_2017/example_d_paper.prm": CORNER,
    # Edges are larger, and so is the hole that cells leave.
    "papers/le_2014/example_1_paper.prm": {"Peridynamics/Horizon": "9", "Output/Line": "70,25 ; 98,25 ; 9"},
    "papers/le_2014/example_2_paper.prm": {"Peridynamics/Horizon": "9"},
}

LIMITED = {"euler": 2, "rk4": 2, "verlet": 1}  # steppers whose limit grows with a power of the edge

TIMEOUT = 300  # seconds a scene; with sanitizers they take up to 20

FIELDS = ("vtu, hdf5", "vtu", "hdf5", "none")

# What sanitizers, deal.II and the standard library print. Their own exit status is 99
# (tests/CMakeLists.txt).
COMPLAINTS = re.compile(r"runtime error:|AddressSanitizer|LeakSanitizer|UndefinedBehaviorSanitizer|An error occurred in line"
                        r"|Assertion .* failed|terminate called|Signal:")


def entries_of(path):
    """The entries of a scene: {"Section/Entry": value}."""
    with open(path) as file:
        text = re.sub(r"\\\n", " ", re.sub(r"#.*", "", file.read()))
    sections, entries = [], {}
    for line in text.splitlines():
        words = line.split(None, 1)
        if line.strip() == "end":
            sections.pop()
        elif words and words[0] == "subsection":
            sections.append(words[1].strip())
        elif words and words[0] == "set":
            name, value = words[1].split("=", 1)
            entries["/".join(sections + [name.strip()])] = value.strip()
    return entries


def coarse(cells):
    """The same shape of lattice with fewer cells: by a common divisor if one gives nearly as many as wanted, else rounded, odd as odd."""
    wanted = CELLS[len(cells)]
    for divisor in range(1, min(cells) + 1):
        total = math.prod(cells) // divisor ** len(cells)
        if all(n % divisor == 0 for n in cells) and wanted / 4 <= total <= wanted:
            return [n // divisor for n in cells]
    if math.prod(cells) <= wanted:
        return cells
    share = (wanted / math.prod(cells)) ** (1 / len(cells))
    return [max(1, 2 * int(n * share / 2) + n % 2) for n in cells]


def overrides_for(name, entries):
    """What makes a scene small."""
    found = {}
    ratio = 1  # of the new edges to the old ones
    if "Domain/Cells" in entries:
        cells = [int(n) for n in entries["Domain/Cells"].split(",")]
        found["Domain/Cells"] = ", ".join(str(n) for n in coarse(cells))
        ratio = cells[0] / coarse(cells)[0]
    if entries.get("Domain/Shape") == "image" and entries.get("Physics") == "elasticity":
        found.update(IMAGE)
    if entries.get("Time/Stepper") in LIMITED and "Time/Time step" in entries:
        found["Time/Time step"] = repr(float(entries["Time/Time step"]) * ratio ** LIMITED[entries["Time/Stepper"]])
    elif "Time/Time step" in entries:  # loads, in ten steps
        found["Time/Time step"] = repr(float(entries.get("Time/End time", "1")) / 10)
    if "Time/Tolerance" in entries:
        found["Time/Tolerance"] = "1e-4"
    found.update(OVERRIDES.get(name, {}))
    return found


def run_coarse(number, name, path):
    """Run a scene, check how it ended, and return its row of the table."""
    refused = os.path.dirname(name) == "failures" and os.path.basename(name) in REFUSED
    overrides = {} if refused else overrides_for(name, entries_of(path))
    overrides["Output/Fields"] = FIELDS[number % len(FIELDS)]
    ranks = 2 if number % 3 == 0 else 1
    what = f"{name} {overrides} on {ranks} process(es)"
    begin = time.time()
    try:
        run = run_scene(path, overrides, ranks, check_status=False, timeout=TIMEOUT)
    except subprocess.TimeoutExpired:
        check(False, f"{what}: not done in {TIMEOUT} s")
        return (name, overrides.get("Domain/Cells", ""), overrides["Output/Fields"], str(ranks), "none", f"{TIMEOUT:.1f}")
    text = run.stdout + run.stderr
    complaint = COMPLAINTS.search(text)
    check(not complaint, f"{what}:\n{text[max(0, complaint.start() - 200):][:6000] if complaint else ''}")
    if refused:
        check_clean_error(run, name)
    else:
        check(run.returncode == 0, f"{what}: exit status {run.returncode}\n{text[-2000:]}")
    return (name, overrides.get("Domain/Cells", ""), overrides["Output/Fields"], str(ranks), str(run.returncode),
            f"{time.time() - begin:.1f}")


def main():
    root = os.path.join(SOURCE_DIR, "prm")
    paths = sorted(glob.glob(os.path.join(root, "**", "*.prm"), recursive=True))
    rows = []
    for number, path in enumerate(paths):
        name = os.path.relpath(path, root)
        if len(sys.argv) == 1 or any(name.startswith(wanted) for wanted in sys.argv[1:]):
            rows.append(run_coarse(number, name, path))
    print_table(f"{len(rows)} scenes", ("scene", "cells", "fields", "processes", "status", "seconds"), rows)
    finish()


if __name__ == "__main__":
    main()
