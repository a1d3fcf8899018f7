# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Runs that are ended at random moments: SIGKILL, SIGTERM and SIGINT, to all processes, to one of two, or to mpirun.

Afterwards every list of fields has to be whole and refer to whole files only, tables have to consist of whole lines, and the summary may
not say that the run is complete. SIGTERM and SIGINT leave a summary that says `stopped`, one message (which mpirun may keep to itself
when it is told to end), and nothing in temporary folders and shared memory. A run in the same folder then has to work, and leave the files of a run in a fresh one.
"""

import os
import signal
import time

from campaign import COMPLETE, CRASH, GOOD, HANG, KILLED, STOPPED, TRACE, WRONG, WRONG_STATUS, Campaign, Process, run
from campaign import shared_memory, signal_processes
from result_folder import status_of, wrong_results
from scene_test import scene_text

FRAME = scene_text("""
Output directory = results
Output/Fields = vtu, hdf5
Output/Write every = {every}
Output/Probes = 0.5, 0.5 ; 0.9, 0.2
Output/Line = 0, 0.5 ; 1, 0.5 ; 11
Time/End time = {end}
""")

HEAT = scene_text("""
Domain/Cells = 14, 14
Boundary conditions/Dirichlet = left: sin(t); right: 0
Cracks/Segments = 0.5, 0.3 ; 0.5, 0.7
""")

BODY = """
Physics = elasticity
Domain/Cells = 14, 14
Material/Young modulus = 1
Material/Poisson ratio = 0.25
"""
MOTION = scene_text(BODY + """
Elasticity/Solver = dynamics
Boundary conditions/Displacement = left: 0, 0
Boundary conditions/Traction = right: 0.001, 0
""")
LOADING = scene_text(BODY + "Boundary conditions/Displacement = left: 0, 0 ; right: 0.01*t, free")

# Name: scene, time between outputs, end, end of the run that follows.
SCENES = {"heat": (HEAT, 0.005, 0.2, 0.01), "motion": (MOTION, 0.1, 4, 0.2), "loading": (LOADING, 0.05, 1, 0.1)}

SIGNALS = {signal.SIGKILL: "SIGKILL", signal.SIGTERM: "SIGTERM", signal.SIGINT: "SIGINT"}


def files_in(folder):
    return sorted(os.path.relpath(os.path.join(path, name), folder) for path, _, names in os.walk(folder) for name in names)


class Bench:
    """What a run takes that nobody disturbs, and the files that one in a fresh folder leaves; found when first asked for."""

    def __init__(self):
        self.seconds, self.files = {}, {}

    def measure(self, case, scene, ranks):
        text, every, end, short = SCENES[scene]
        path = case.write("scene.prm", text + FRAME.format(every=every, end=end))
        if (scene, ranks) in self.seconds:
            return path, self.seconds[scene, ranks], self.files[scene, ranks]
        times = []
        for what, until in (("fresh", short), ("whole", end)):
            found = run(["run", path, "-q", "-s", f"Output directory={what}", "-s", f"Time/End time={until}"], case, ranks, 300)
            if found.kind != COMPLETE:
                raise SystemExit(f"{scene} does not run: {found.kind}: {found.detail}\n{found.text[-2000:]}")
            times.append(found.seconds)
        self.seconds[scene, ranks] = times[-1]
        self.files[scene, ranks] = files_in(os.path.join(case.folder, "fresh"))
        return path, self.seconds[scene, ranks], self.files[scene, ranks]


def disturb(process, target, number, random):
    """Send the signal. Returns whether the run was still going on, and the shared memory that it had."""
    ranks = process.ranks()
    memory = shared_memory(ranks)
    if not process.running:
        return False, memory
    signal_processes({"all": process.members(), "starter": [process.pid], "one": ranks and [random.choice(ranks)] or [process.pid]}[target],
                     number)
    return True, memory


def judge(case, end, number, memory, may_be_silent):
    """The kind of end, and what is wrong with what was left."""
    results = os.path.join(case.folder, "results")
    if end.kind == HANG:
        return HANG, end.detail
    # The starter may be ended when the run has written all: then it returns 1, and the results have
    # to be whole.
    complete = end.status == 0 or status_of(results) == "complete"
    problems = list(wrong_results(results, complete))
    if problems:
        return WRONG, "; ".join(problems[:4])
    if complete:
        return COMPLETE, ""
    if number == signal.SIGKILL:
        return KILLED, ""
    left = case.left_behind() + [name for name in memory if os.path.exists("/dev/shm/" + name)]
    if left:
        return "left behind", ", ".join(left)
    if end.kind in (CRASH, TRACE) and not (end.status < 0 and -end.status == number):
        return end.kind, end.detail
    status = status_of(results)
    if status is None and all(name.startswith(".perideal") for name in files_in(results)):
        return KILLED, "before it wrote anything but its list of files"
    if status != "stopped":
        return WRONG, f"exit status {end.status}, the summary says {status!r}"
    said = "stopped" in end.text.lower() or may_be_silent and end.text.strip() == ""
    if end.status <= 0 or end.messages > 1 or not said:
        return WRONG_STATUS, f"exit status {end.status}: {' '.join(end.stderr.split())[-300:]}"
    return STOPPED, ""


def follow(case, path, scene, ranks, fresh):
    """A run in the same folder. What is wrong with it."""
    end = run(["run", path, "-q", "--overwrite", "-s", f"Time/End time={SCENES[scene][3]}"], case, ranks, 180)
    if end.kind != COMPLETE:
        return f"the run that follows: {end.kind}: {end.detail}"
    results = os.path.join(case.folder, "results")
    problems = list(wrong_results(results, complete=True))
    found = files_in(results)
    if found != fresh:
        more, less = sorted(set(found) - set(fresh)), sorted(set(fresh) - set(found))
        problems.append(f"{len(more)} files more than a fresh run leaves: {more[:3]}, {len(less)} less: {less[:3]}")
    return "; ".join(["the run that follows: " + problem for problem in problems[:4]])


def main():
    campaign = Campaign(__doc__, cases=30)
    bench = Bench()
    for case in campaign:
        random = case.random
        scene, ranks = random.choice(sorted(SCENES)), random.choice([1, 2])
        number = random.choice([signal.SIGKILL, signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
        target = random.choice(["all", "starter", "one"]) if ranks > 1 else "starter"
        share = random.uniform(0, 1)
        path, seconds, fresh = bench.measure(case, scene, ranks)
        process = Process(["run", path, "-q"], case, ranks)
        time.sleep(share * seconds)
        _, memory = disturb(process, target, number, random)
        kind, detail = judge(case, process.wait(30 + 4 * seconds), number, memory, ranks > 1 and target == "starter")
        what = f"{SIGNALS[number]}, {ranks} process{'es' if ranks > 1 else ''}"
        if kind in GOOD:
            problem = follow(case, path, scene, ranks, fresh)
            if problem:
                kind, detail = WRONG, problem
        case.count(what, kind, f"{scene}, {target}, at {share:.0%} of {seconds:.1f} s: {detail}")
    campaign.finish()


if __name__ == "__main__":
    main()
