# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Every scene of prm/ but those of prm/failures as it is, but without field files: it runs to its end, keeps its heat or its forces in balance, and its comment teaches."""

import glob
import os
import re
import time

from scene_test import SOURCE_DIR, check, check_less, finish, print_table, run_scene

# Slaves of extrapolated fluxes and the papers' self term do not conserve heat (doc/theory.md).
NOT_CONSERVING = re.compile(r"bobaru_20\d\d/example_\d_paper\.prm")

FORCE_LOST = 9e-8  # measured: 5.7e-8, the bimetal strip; solvers stop at 1e-10 of the loads


def comment_of(path):
    """The paragraphs at the top of a scene."""
    lines = []
    with open(path) as file:
        for line in file:
            if not line.startswith("#"):
                break
            lines.append(line[1:].strip())
    return " ".join(lines)


def main():
    rows = []
    for path in sorted(glob.glob(os.path.join(SOURCE_DIR, "prm", "**", "*.prm"), recursive=True)):
        name = os.path.relpath(path, SOURCE_DIR)
        if name.startswith(os.path.join("prm", "failures")):
            continue  # they fail on purpose: failures.py
        comment = comment_of(path)
        check(len(comment) > 150 and "What to look for" in comment, f"{name}: the comment says what to look for")
        begin = time.time()
        run = run_scene(name, {"Output/Fields": "none"})
        seconds = time.time() - begin
        for model in run.summary["models"]:
            entry = run.model(model)
            if "energy balance" in entry:  # an elastic body in motion, or loaded slowly
                lost = abs(entry["energy balance"]["imbalance"]) / (entry["energy balance"]["start"] + abs(entry["energy balance"]["work"]))
                check_less(lost, 2.4e-3 if "branching" in name else 1e-3, f"{name}, {model}: energy lost, over what there was and came in")  # measured: 1.5e-3
                rows.append((name, model, entry["unknowns"], entry.get("bonds", ""), entry.get("stepper", "none"), f"{lost:.1e}", f"{seconds:.1f}"))
                continue
            if "force balance" in entry:  # the energy stands for forces that balance each other inside
                forces, inside = entry["force balance"], entry["strain energy"]
                line = os.path.join(run.folder, "line.csv")
                warm = [row for row in run.rows(model, table="line.csv") if "temperature" in row] if os.path.exists(line) else []
                if warm:  # free of stress in the end: the largest stress on the way, times the shortest edge
                    box = run.summary["domain"]
                    inside += max(abs(row["syy"]) for row in warm) * min(b - a for a, b in zip(box["lower"], box["upper"]))
                lost = forces["imbalance"] / (forces["throughput"] + inside)
                check_less(lost, FORCE_LOST, f"{name}, {model}: force lost")
            else:
                moved = sum(abs(flux) for flux in entry["boundary flux"].values())
                lost = abs(entry["heat balance"]["imbalance"]) / moved
                conserving = model == "finite elements" or not NOT_CONSERVING.search(name)
                if conserving:
                    check_less(lost, 1e-8, f"{name}, {model}: heat lost, over what passes through the sides")
            rows.append((name, model, entry["unknowns"], entry.get("bonds", ""), entry.get("stepper", "none"), f"{lost:.1e}", f"{seconds:.1f}"))
    print_table("All scenes", ("scene", "model", "unknowns", "bonds", "stepper", "heat or force lost", "seconds, both"), rows)
    finish()


if __name__ == "__main__":
    main()
