# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Runs that may not take all the memory that they need: a limit on addresses at a random place between what the program takes to
start and what the run takes.

Each has to end with exit status 1 and one message that speaks of memory and says what to do, or complete.
"""

import os

from campaign import COMPLETE, GOOD, REFUSED, WRONG, Campaign, Process, limit_memory, run
from result_folder import wrong_results
from scene_test import scene_text

SCENE = """
Output directory = results
Time/Steady = true
"""
HEAT = SCENE + "Boundary conditions/Dirichlet = left: 0; right: 1\n"
ELASTIC = SCENE + """
Physics = elasticity
Material/Young modulus = 1
Material/Poisson ratio = 0.25
Boundary conditions/Displacement = left: 0, 0{zero}
Boundary conditions/Traction = right: 0.001, 0{zero}
"""
BLOCK = """
Dimension = 3
Domain/Lower corner = 0, 0, 0
Domain/Upper corner = 1, 1, 1
"""
TINY = scene_text(HEAT + "Domain/Cells = 4, 4")

SCENES = {what: scene_text(lines) for what, lines in {
    "stored bonds": HEAT + """
Models = peridynamics
Domain/Cells = 250, 250
Peridynamics/Horizon ratio = 6
Peridynamics/Operator form = stored
Peridynamics/Boundary treatment = none
""",
    "block": HEAT + BLOCK + "Domain/Cells = 40, 40, 40",
    "elements": HEAT + "Models = finite elements\nDomain/Cells = 600, 600",
    "elastic plate": ELASTIC.format(zero="") + "Domain/Cells = 100, 100",
    "elastic block": ELASTIC.format(zero=", 0") + BLOCK + "Domain/Cells = 28, 28, 28\nModels = finite elements",
    "crack": SCENE + """
Models = coupled
Domain/Cells = 250, 250
Coupling/Zone = everywhere
Cracks/Segments = 0.3, 0.5 ; 0.7, 0.5
Boundary conditions/Dirichlet = bottom: 0; top: 1
""",
}.items()}


def peak_of(process):
    """The largest address space of any of the run's processes, looked at until it ends."""
    peak = 0
    while process.running:
        for rank in process.ranks():
            try:
                with open(f"/proc/{rank}/status") as file:
                    peak = max([peak] + [int(line.split()[1]) * 1024 for line in file if line.startswith("VmPeak")])
            except OSError:
                pass
        try:
            process.popen.wait(0.02)
        except Exception:  # the time is over, and the run goes on
            pass
    return peak


def need_of(case, name, text, ranks, known):
    """Address space of an unlimited run, found once."""
    if (name, ranks) not in known:
        path = case.write("free.prm", text)
        process = Process(["run", path, "-q", "-s", "Output directory=free"], case, ranks)
        peak = peak_of(process)
        end = process.wait(10)
        if end.kind != COMPLETE:
            raise SystemExit(f"{name} does not run: {end.detail}\n{end.text[-2000:]}")
        known[name, ranks] = peak
    return known[name, ranks]


def main():
    campaign = Campaign(__doc__, cases=10)
    known = {}
    for case in campaign:
        name = sorted(SCENES)[case.number % len(SCENES)]
        ranks = case.random.choice([1, 1, 2])
        least = need_of(case, "start", TINY, ranks, known)
        most = need_of(case, name, SCENES[name], ranks, known)
        limit = round(least + case.random.uniform(0, 1) * (most - least))
        end = run(["run", case.write("scene.prm", SCENES[name]), "-q"], case, ranks, 120, prepare=lambda: limit_memory(limit))
        kind, detail = end.kind, end.detail
        problems = list(wrong_results(os.path.join(case.folder, "results"), end.status == 0))
        if kind in GOOD and problems:
            kind, detail = WRONG, "; ".join(problems[:4])
        elif kind == REFUSED and not ("memory" in end.stderr and "check" in end.stderr):
            kind = "says nothing of it"
        case.count(f"{name}, {ranks} process{'es' if ranks > 1 else ''}", kind,
                   f"{limit >> 20} MB, of {least >> 20} to start and {most >> 20} in all: {detail}")
    campaign.finish()


if __name__ == "__main__":
    main()
