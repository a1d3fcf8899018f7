# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Runs that cannot write: a full disk, a limit on the size of files, a folder of results that is removed, made read-only or replaced by
a file while the run goes on, and a temporary folder without space.

Each has to end with exit status 1 and one message that names the place, or complete; what is in the folder has to be whole. Disks are small file
systems in memory, in a name space of this script's own; where that is not allowed the cases that need one are left out.
"""

import os
import resource
import shutil
import signal
import subprocess
import sys
import time

from campaign import COMPLETE, GOOD, REFUSED, WRONG, Campaign, Process, run
from kills import FRAME, HEAT, LOADING, MOTION, files_in
from result_folder import status_of, wrong_results

SCENES = {"heat": (HEAT, 0.01, 0.15), "motion": (MOTION, 0.1, 2), "loading": (LOADING, 0.05, 0.5)}

OWN_SPACE = "PERIDEAL_CAMPAIGN_OWN_SPACE"


def enter_own_space():
    """Start this script again where it may mount file systems that nobody else sees. Returns whether it may."""
    if OWN_SPACE in os.environ:
        return os.environ[OWN_SPACE] == "yes"
    unshare = shutil.which("unshare")
    for options in (["-m"], ["-r", "-m"]):
        if unshare and subprocess.run([unshare, *options, "sh", "-c", "mount -t tmpfs -o size=64k tmpfs /mnt"], stdin=subprocess.DEVNULL,
                                      capture_output=True, check=False).returncode == 0:
            environment = dict(os.environ, **{OWN_SPACE: "yes"})
            os.execve(unshare, [unshare, *options, sys.executable, *sys.argv], environment)
    os.environ[OWN_SPACE] = "no"
    return False


def mount(folder, kilobytes):
    os.makedirs(folder, exist_ok=True)
    subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={kilobytes}k", "tmpfs", folder], check=True)


def unmount(folder):
    subprocess.run(["umount", "-l", folder], check=False, capture_output=True)


def fill(folder):
    """Take all the space that is left in a folder."""
    with open(os.path.join(folder, "filler"), "wb", buffering=0) as file:
        try:
            while True:
                file.write(b"\0" * 4096)
        except OSError:
            pass


def small_disk(case, ranks):
    """The results lie on a disk that has some of the space that they take."""
    results = os.path.join(case.folder, "results")
    amount = case.random.randint(0, case.needed // 1024)
    mount(results, max(4, amount))
    try:
        end = run(["run", case.scene, "-q"], case, ranks, 240)
        problems = list(wrong_results(results, end.status == 0))
    finally:
        unmount(results)
    return f"{amount} of {case.needed // 1024} kB", end, problems


def small_files(case, ranks):
    """No file may be larger than some size from some moment on, as with a quota. What Open MPI keeps for itself was written by then."""
    results = os.path.join(case.folder, "results")
    amount = case.random.randint(0, case.largest)
    process = Process(["run", case.scene, "-q"], case, ranks, prepare=lambda: signal.signal(signal.SIGXFSZ, signal.SIG_IGN))
    until = time.monotonic() + 60
    while process.running and time.monotonic() < until and not files_in(results):
        time.sleep(0.01)
    for rank in process.ranks():
        resource.prlimit(rank, resource.RLIMIT_FSIZE, (amount, amount))
    end = process.wait(240)
    return f"files of {amount} of {case.largest} bytes", end, list(wrong_results(results, end.status == 0))


def disturbed(case, ranks, what, disturb):
    """Do something to the folder of results when the run has been writing for a while."""
    results = os.path.join(case.folder, "results")
    process = Process(["run", case.scene, "-q"], case, ranks)
    until = time.monotonic() + 60
    wanted = case.random.randint(1, case.files)
    while process.running and time.monotonic() < until and len(files_in(results)) < wanted:
        time.sleep(0.01)
    # A process that has written all still takes some time to leave.
    went_on = process.running and status_of(results) != "complete"
    undo = disturb(results)
    end = process.wait(240)
    if undo:
        undo()
    problems = list(wrong_results(results, end.status == 0)) if os.path.isdir(results) and what != "removed" else []
    if what == "removed" and went_on and end.status == 0 and not os.path.exists(os.path.join(results, "summary.json")):
        problems.append("exit status 0 without a summary")
    return f"{what} at {wanted} of {case.files} files", end, problems


def removed(case, ranks):
    return disturbed(case, ranks, "removed", lambda results: shutil.rmtree(results, ignore_errors=True))


def replaced(case, ranks):
    def disturb(results):
        moved = results + "_moved"
        os.makedirs(results, exist_ok=True)
        os.rename(results, moved)
        with open(results, "w"):
            pass

        def undo():
            if os.path.isfile(results):
                os.remove(results)
                os.rename(moved, results)

        return undo

    return disturbed(case, ranks, "replaced by a file", disturb)


def read_only(case, ranks):
    def disturb(results):
        folders = [folder for folder in (results, os.path.join(results, "fields")) if os.path.isdir(folder)]
        if os.geteuid() == 0:  # to whom modes say nothing
            subprocess.run(["chattr", "+i", *folders], check=False, capture_output=True)
            return lambda: subprocess.run(["chattr", "-i", *folders], check=False, capture_output=True)
        for folder in folders:
            os.chmod(folder, 0o555)
        return lambda: [os.chmod(folder, 0o755) for folder in folders]

    return disturbed(case, ranks, "read-only", disturb)


def full_temporary(case, ranks):
    """The temporary folder, where Open MPI keeps its session, has next to no space."""
    folder = os.path.join(case.base, "full")
    amount = case.random.choice([16, 64, 256, 1024, 4096])
    mount(folder, amount)
    fill(folder)
    try:
        end = run(["run", case.scene, "-q"], case, ranks, 240, environment={"TMPDIR": folder})
    finally:
        unmount(folder)
    return f"{amount} kB, all taken", end, list(wrong_results(os.path.join(case.folder, "results"), end.status == 0))


def need_of(case, scene, known):
    """Space and files of an undisturbed run, found once."""
    if scene not in known:
        end = run(["run", case.scene, "-q", "-s", "Output directory=whole"], case, 1, 300)
        if end.kind != COMPLETE:
            raise SystemExit(f"{scene} does not run: {end.detail}\n{end.text[-2000:]}")
        whole = os.path.join(case.folder, "whole")
        sizes = [os.path.getsize(os.path.join(whole, name)) for name in files_in(whole)]
        known[scene] = sum((size + 4095) // 4096 * 4096 for size in sizes), len(sizes), max(sizes)
    return known[scene]


def main():
    kinds = [small_disk, small_files, removed, small_disk, replaced, full_temporary, read_only, small_disk]
    may_mount = enter_own_space()
    campaign = Campaign(__doc__, cases=20)
    if not may_mount:
        print("Mounting file systems is not allowed here: no small disks.")
        kinds = [kind for kind in kinds if kind not in (small_disk, full_temporary)]
    known = {}
    for case in campaign:
        kind = kinds[case.number % len(kinds)]
        scene = case.random.choice(sorted(SCENES))
        ranks = case.random.choice([1, 2])
        text, every, until = SCENES[scene]
        case.scene = case.write("scene.prm", text + FRAME.format(every=every, end=until))
        case.needed, case.files, case.largest = need_of(case, scene, known)
        where, end, problems = kind(case, ranks)
        outcome, detail = end.kind, end.detail
        if outcome in GOOD and problems:
            outcome, detail = WRONG, "; ".join(problems[:4])
        elif outcome == REFUSED and not names_the_place(end.stderr, kind):
            outcome, detail = "says nothing of it", end.detail
        elif outcome in GOOD and case.left_behind():
            outcome, detail = "left behind", ", ".join(case.left_behind())
        case.count(kind.__name__.replace("_", " "), outcome, f"{scene}, {ranks} process(es), {where}: {detail}")
    campaign.finish()


def names_the_place(message, kind):
    """The message says where nothing could be written; that temporary space is lacking if it is that."""
    return "TMPDIR" in message if kind is full_temporary else "results" in message and "writ" in message


if __name__ == "__main__":
    main()
