# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Scenes of prm/ made small and changed at random: lines deleted, doubled, moved, values that are none, words that do not exist,
sections of other scenes, bytes that are no text.

Each run has to end with exit status 1 and one message, or with 0 and finite numbers in every result. A run that takes too
long has to stop when it is asked to.
"""

import glob
import os
import re

from campaign import COMPLETE, NO_MESSAGE, REFUSED, STOPPED, WRONG, Campaign, limit_memory, run
from mutations import Mutator, make_small, read_lines, value_of
from result_folder import nulls_in, read_summary, wrong_numbers, wrong_results
from scene_test import SOURCE_DIR, run_perideal

TIME = 20  # seconds
MEMORY = 3 << 30  # bytes of addresses


def all_entries():
    """{(section, entry): (default, choices)} of the program's own manual."""
    _, manual, _ = run_perideal(["parameters", "markdown"])
    entries, section = {}, ""
    for line in manual.splitlines():
        if line.startswith("## "):
            section = "" if line.startswith("## Outside") else line[3:].strip()
        cells = [cell.strip() for cell in line.replace("\\|", "\0").strip("|").split("|")]
        if line.startswith("| ") and len(cells) >= 5 and cells[0] != "Entry":
            kind, default = cells[1], cells[2].strip("`")
            choices = kind.split(": ", 1)[1].split(", ") if kind.startswith(("one of:", "list of:")) else []
            if kind == "true or false":
                choices = ["true", "false"]
            entries[section, cells[0]] = (default, choices)
    return entries


def small_scenes():
    """Every scene of prm/, made small; those whose lattice cannot be made small are left out."""
    scenes = []
    for path in sorted(glob.glob(os.path.join(SOURCE_DIR, "prm", "**", "*.prm"), recursive=True)):
        lines = read_lines(path)
        if value_of(lines, "Domain", "Node spacing"):
            continue
        make_small(lines, os.path.dirname(path))
        scenes.append((os.path.relpath(path, os.path.join(SOURCE_DIR, "prm")), lines))
    return scenes


def says_nothing(text):
    """Nothing but comments."""
    return not any(line.split(b"#", 1)[0].strip() for line in re.split(b"[\r\n]", text))


def judge(case, end, text):
    """The kind of end, with what its results say."""
    results = os.path.join(case.folder, "results")
    if end.kind == COMPLETE and says_nothing(text):
        return WRONG, "a file without entries ran the default scene"
    if end.kind == COMPLETE:
        found = list(wrong_numbers(results)) + list(wrong_results(results, complete=True))
        if not found:
            found = [f"summary.json: {where} is null" for where in nulls_in(read_summary(results))]
        if found:
            return WRONG, "; ".join(found[:4])
        return end.kind, ""
    if end.kind in (REFUSED, STOPPED):
        found = list(wrong_results(results, complete=False))
        if found:
            return WRONG, "; ".join(found[:4])
        if end.kind == REFUSED and len(end.stderr.split("perideal: error:")[-1].strip()) < 10:
            return NO_MESSAGE, end.stderr
    return end.kind, end.detail


def main():
    campaign = Campaign(__doc__, cases=1000)
    scenes = small_scenes()
    mutator = Mutator(all_entries())
    for case in campaign:
        name, lines = case.random.choice(scenes)
        text, changes = mutator.mutate(lines, case.random, [other for _, other in scenes])
        ranks = 2 if case.random.random() < 0.04 else 1
        path = case.write("scene.prm", text)
        end = run(["run", path, "-q", "-s", "Output directory=results"], case, ranks, TIME, prepare=lambda: limit_memory(MEMORY))
        kind, detail = judge(case, end, text)
        case.count(f"{ranks} process{'es' if ranks > 1 else ''}", kind, f"{name}, {'+'.join(changes)}, {end.seconds:.1f} s: {detail}")
    campaign.finish()


if __name__ == "__main__":
    main()
