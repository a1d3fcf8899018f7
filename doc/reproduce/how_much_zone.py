#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""The tables of doc/coupling.md, section "How much zone?": an insulated crack with more and less of a zone around it, steady and at t = 0.5 s.

    python3 doc/reproduce/how_much_zone.py [--program PERIDEAL] [--output FOLDER] [--coarse]

Example 3 of Bobaru and Duangpanya 2012 on 121 x 121 cells (prm/coupling/insulated_crack.prm). The errors are relative L2 norms over the nodes, weighted by their
volumes, against finite elements with the crack on faces on 240, 480 and 960 cells, extrapolated with the first order that the crack's tips
leave; the difference of the extrapolations from 240 and 480 and from 480 and 960 cells bounds the error of the reference. --coarse
leaves out 960. Time steps are exact to a tolerance of 1e-10; the difference from 1e-8 is printed.
Results are kept in FOLDER and not computed again.
"""

import argparse
import csv
import json
import math
import re
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
SCENE = ROOT / "prm" / "coupling" / "insulated_crack.prm"
FEM, PD, BOTH = "finite elements", "peridynamics", "coupled"
N = 121
PLAIN, SCALED = "none", "crack scaling"


class Runs:
    """Runs of the scene with other entries, kept in a folder."""

    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def __call__(self, name, model, steady, tolerance="1e-10", **entries):
        folder = self.folder / f"{name}_{'steady' if steady else 'transient'}"
        if not (folder / "summary.json").exists():
            ticks = [-1 + 2 * i / N for i in range(N + 1)]
            text = re.sub(r"set Probes *=.*", "set Probes = " + " ; ".join(f"{x!r},{y!r}" for y in ticks for x in ticks),
                          SCENE.read_text(encoding="utf-8"))
            self.folder.mkdir(parents=True, exist_ok=True)
            scene = self.folder / f"{folder.name}.prm"
            scene.write_text(text, encoding="utf-8")
            chosen = {"Models": model, "Output directory": str(folder), "Output/Fields": "none", "Output/Line": "", "Output/Write at": "",
                      "Solver/Tolerance": "1e-10", "Time/Tolerance": tolerance, "Coupling/Certificate": "false",
                      **({"Time/Steady": "true"} if steady else {}),
                      **{key.replace("__", "/").replace("_", " "): value for key, value in entries.items()}}
            command = [self.program, "run", str(scene), "-q"]
            for entry, value in chosen.items():
                command += ["-s", f"{entry}={value}"]
            subprocess.run(command, check=True)
        summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))["models"][model]
        with open(folder / "probes.csv", newline="", encoding="utf-8") as file:
            values = [float(row["value"]) for row in csv.DictReader(file)]
        return summary, values


def distance(found, exact):
    """Relative L2 difference of nodal values."""
    total = size = 0.0
    for k, (a, b) in enumerate(zip(found, exact)):
        weight = (0.5 if k % (N + 1) in (0, N) else 1) * (0.5 if k // (N + 1) in (0, N) else 1)
        total += weight * (a - b) ** 2
        size += weight * b ** 2
    return math.sqrt(total / size)


def extrapolated(coarse, fine):
    return [2 * b - a for a, b in zip(coarse, fine)]


def cases():
    """Name, model and entries of each line."""
    for correction in (PLAIN, SCALED):
        scaling = {"Peridynamics__Surface_correction": correction}
        mark = ", scaled" if correction == SCALED else ""
        yield "finite elements, pairs" + mark, FEM, scaling
        for c in ("0.5", "1", "2"):
            yield f"coupled, c = {c}{mark}", BOTH, {"Coupling__Zone": f"cracks: {c}", **scaling}
        yield "peridynamics, exchange" + mark, PD, scaling
    yield "peridynamics, cut off, m = 6.5", PD, {"Peridynamics__Surface_correction": PLAIN, "Peridynamics__Horizon_ratio": "6.5",
                                                  "Peridynamics__Boundary_treatment": "none"}


def table(run, steady, finest):
    """One table in Markdown, and what is known of its reference."""
    counts = [n for n in (240, 480, 960) if n <= finest]
    fine = [run(f"fine_{n}", FEM, steady, Domain__Cells=f"{n}, {n}", Cracks__Mesh="faces", Peridynamics__Surface_correction=PLAIN)
            for n in counts]
    values = [v for _, v in fine]
    heats = [summary["boundary flux"]["top"] for summary, _ in fine]
    exact, heat = extrapolated(values[-2], values[-1]), 2 * heats[-1] - heats[-2]
    lines = []
    if len(counts) > 2:
        own, own_heat = distance(extrapolated(*values[:2]), exact), abs(2 * heats[1] - heats[0] - heat) / heat
        lines.append(f"Reference: heat {heat:.3f}; its own error at most {own:.1e}, of the heat {own_heat:.1e}")
    if not steady:
        other = run("loose", FEM, steady, tolerance="1e-8", Peridynamics__Surface_correction=PLAIN)[1]
        tight = run("finite_elements__pairs", FEM, steady, Peridynamics__Surface_correction=PLAIN)[1]
        lines.append(f"Difference between tolerances of 1e-8 and 1e-10 in time: {distance(other, tight):.1e}")
    lines += ["", "| model | L2 error | heat through the top | its error | bonds | numbers stored | seconds |", "|---|---|---|---|---|---|---|"]
    for what, model, entries in cases():
        summary, found = run(re.sub(r"[^a-z0-9.]", "_", what), model, steady, **entries)
        flux = summary["boundary flux"]["top"]
        seconds = summary["wall time"]["solve" if steady else "time stepping"]
        lines.append(f"| {what} | {distance(found, exact):.1e} | {flux:.2f} | {abs(flux - heat) / heat:.1e} | {summary.get('bonds', 0):,} | "
                     f"{summary['nonzeros']:,} | {seconds:.2f} |")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default=str(ROOT / "build" / "release" / "applications" / "perideal"))
    parser.add_argument("--output", type=Path, default=ROOT / "output" / "how_much_zone")
    parser.add_argument("--coarse", action="store_true", help="a reference on 480 cells at most")
    options = parser.parse_args()
    run = Runs(options.program, options.output)
    for steady in (False, True):
        print("\n" + ("Steady:" if steady else "At t = 0.5 s:") + "\n")
        print(table(run, steady, 480 if options.coarse else 960), flush=True)


if __name__ == "__main__":
    main()
