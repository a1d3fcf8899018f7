# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""The output directory of a run through its life: what is there afterwards, file by file.

Arguments: parts. `mixing`: runs one after the other, refused runs, a user's own files. `together`: two runs at once, in one folder and in two, and
leftovers in shared memory. `ends`: signals, kills, a folder that goes away or turns read-only, full folders for temporary files.
"""

import csv
import ctypes
import ctypes.util
import json
import os
import shutil
import signal
import subprocess
import tempfile
import time
import xml.etree.ElementTree as xml

from scene_test import EXECUTABLE, SOURCE_DIR, check, check_message, check_no_traces, command_and_environment, run_parts
from scene_test import run_perideal, scene_text, temporary_folder, write_file

SCENE = scene_text("""
Dimension = 2
Domain/Cells = 12, 10
Boundary conditions/Dirichlet = left: 1; right: 0
Time/End time = 0.3
Output/Write every = 0.1
Output/Probes = 0.1,0.9
""")
SLOW = {"Domain/Cells": "48, 40", "Time/Stepper": "euler", "Time/Time step": "1e-5", "Time/End time": "20", "Output/Write every": "0.002"}
BROKEN = {"Time/Stepper": "euler", "Time/Time step": "1"}  # refused when the operators are there

FOLDER = temporary_folder()


def scene_file(name="own.prm", text=SCENE):
    return write_file(name, text, FOLDER)


def arguments(scene, results, settings=None):
    words = ["run", scene]
    for entry, value in {"Output directory": results, **(settings or {})}.items():
        words += ["-s", f"{entry}={value}"]
    return words


def run(results, settings=None, scene=None, ranks=1, cwd=None):
    return run_perideal(arguments(scene or scene_file(), results, settings), ranks, timeout=120, cwd=cwd)


def start(results, settings=None, ranks=1, **more):
    """A run in the background, in a process group of its own."""
    words, variables = command_and_environment(arguments(scene_file(), results, settings), ranks)
    return subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                            start_new_session=True, env=variables, **more)


def listing(folder):
    """All files of a folder but those of its list: {relative name: content}."""
    found = {}
    for where, _, names in os.walk(folder):
        for name in names:
            path = os.path.join(where, name)
            relative = os.path.relpath(path, folder)
            if not relative.startswith(".perideal"):
                with open(path, "rb") as file:
                    found[relative] = file.read()
    return found


def status_of(results):
    with open(os.path.join(results, "summary.json")) as file:
        return json.load(file)["status"]


def check_whole(results, what, killed=False):
    """Whatever the run has come to, what it names is there and whole."""
    names = os.listdir(results)
    for name in names:
        path = os.path.join(results, name)
        if name.endswith((".pvd", ".xdmf")):
            root = xml.parse(path).getroot()
            for one in root.iter("DataSet"):
                check(os.path.exists(os.path.join(results, one.get("file"))), f"{what}: {name} names {one.get('file')}")
            for item in root.iter("DataItem"):
                if item.get("Format") == "HDF":
                    check(os.path.exists(os.path.join(results, item.text.strip().split(":")[0])), f"{what}: {name} names {item.text}")
        if name.endswith(".csv"):
            with open(path) as file:
                text = file.read()
            lines = text.splitlines()
            check(text.endswith("\n") and len({line.count(",") for line in lines}) == 1, f"{what}: whole lines in {name}")
        if not killed:
            check(not name.endswith(".part"), f"{what}: {name} is left")
    return names


def wait_for(condition, seconds=60):
    end = time.time() + seconds
    while time.time() < end:
        if condition():
            return True
        time.sleep(0.02)
    return False


def wait_for_rows(process, results):
    path = os.path.join(results, "probes.csv")
    return wait_for(lambda: process.poll() is not None or os.path.exists(path) and open(path).read().count("\n") > 3)


def check_end(status, stderr, expected, *words):
    check(status == expected, f"exit status {status}, expected {expected}:\n{stderr}")
    check_message(stderr, *words)
    check_no_traces(stderr, "the run", "*** Process", "internal error", "PMIX ERROR", "HDF5-DIAG")


def mixing():
    results = os.path.join(FOLDER, "results")
    status, stdout, _ = run(results)
    check(status == 0 and status_of(results) == "complete", "a first run")
    for words in ("of memory at its peak", f"Results: {results}\n", f"To draw {results}/report.html: python3 ", "report.py "):
        check(words in stdout, f"the last lines do not say '{words}':\n{stdout}")
    names = set(listing(results))
    check({"peridynamics.pvd", "fields/peridynamics_0002.h5", "probes.csv"} <= names, f"files: {sorted(names)}")

    # another run writes less: nothing of the first stays, and what is the user's does
    with open(os.path.join(results, "notes.txt"), "w") as file:
        file.write("mine")
    check(run(results, {"Models": "finite elements", "Output/Fields": "hdf5", "Output/Write every": "", "Output/Probes": ""})[0] == 0, "a second run")
    names = set(listing(results))
    check(names == {"finite_elements.xdmf", "fields/finite_elements_0000.h5", "notes.txt", "scene.prm", "summary.json", "totals.csv"},
          f"after a second run that writes less: {sorted(names)}")

    # a run that is refused, early or late, changes nothing
    before = listing(results)
    for settings in (BROKEN, {"Domain/Cells": "0, 1"}, {"Boundary conditions/Dirichlet": "left: 1/(t-0)"}):
        status, _, stderr = run(results, settings)
        check(status == 1 and listing(results) == before, f"after a run that was refused with\n{stderr}: {sorted(listing(results))}")
    nowhere = os.path.join(FOLDER, "not", "yet", "there")
    check(run(nowhere, BROKEN)[0] == 1 and not os.path.exists(os.path.join(FOLDER, "not")), "a refused run makes no folders")

    # a failed run, then another: nothing of the failed one
    half = {"Output/Write every": "", "Output/Write at": "0.1, 0.2",
            "Boundary conditions/Dirichlet": "left: if(t < 0.15, 1, sqrt(-1)); right: 0"}
    status, _, stderr = run(results, half)
    check_end(status, stderr, 1, "Dirichlet")
    check(status_of(results) == "diverged" and "peridynamics.pvd" in listing(results), "a run that failed half way keeps what it has")
    check_whole(results, "failed half way")
    check(run(results, {"Models": "finite elements", "Output/Fields": "vtu"})[0] == 0 and not [n for n in listing(results) if "peridynamics" in n],
          f"after a failed run: {sorted(listing(results))}")

    # the folder with the user's own files
    for name in ("scene.prm", "peridynamics.pvd", "totals.csv", os.path.join("fields", "peridynamics_0007.h5")):
        here = tempfile.mkdtemp(dir=FOLDER)
        os.makedirs(os.path.join(here, "fields"))
        with open(os.path.join(here, name), "w") as file:
            file.write("mine")
        before = listing(here)
        status, _, stderr = run(".", cwd=here)
        check_end(status, stderr, 1, "Output directory", name)
        check(listing(here) == before, f"'Output directory = .' beside an own {name}: {sorted(listing(here))}")
    here = tempfile.mkdtemp(dir=FOLDER)
    for name in ("scene.prm", "data.csv"):
        shutil.copy(scene_file(), os.path.join(here, name))
    status, _, stderr = run(".", scene=os.path.join(here, "scene.prm"), cwd=here)
    check_end(status, stderr, 1, "scene file itself")
    os.rename(os.path.join(here, "scene.prm"), os.path.join(here, "my.prm"))
    for _ in range(2):
        check(run(".", scene=os.path.join(here, "my.prm"), cwd=here)[0] == 0, "'Output directory = .'")
    with open(os.path.join(here, "data.csv")) as file:
        check(file.read() == SCENE and "summary.json" in listing(here), "the user's own files stay")


def stale_semaphores(names):
    """What a run of Open MPI 4 that died with files open in parallel leaves on the machine."""
    library = ctypes.CDLL(ctypes.util.find_library("pthread") or ctypes.util.find_library("c"), use_errno=True)
    library.sem_open.restype = ctypes.c_void_p
    for name in names:
        library.sem_open(f"/{name}".encode(), os.O_CREAT, 0o600, 0)
    return library


def together():
    scene = os.path.join(SOURCE_DIR, "prm", "elasticity", "bar_2d.prm")
    names = [f"OMPIO_{series}_0000.{ending}" for series in ("finite_elements", "peridynamics") for ending in ("0.vtu", "h5")]
    library = stale_semaphores(names)
    for ranks in (1, 2):
        try:
            status = run_perideal(arguments(scene, os.path.join(FOLDER, f"bar{ranks}")), ranks, timeout=100)[0]
        except subprocess.TimeoutExpired:
            status = "a hang"
        check(status == 0, f"stale semaphores, {ranks} process(es): {status}")
    for name in names:
        library.sem_unlink(f"/{name}".encode())

    two = [start(os.path.join(FOLDER, f"side{k}"), ranks=2) for k in range(2)]
    for k, process in enumerate(two):
        check(process.wait(timeout=100) == 0 and status_of(os.path.join(FOLDER, f"side{k}")) == "complete", "two runs at once in two folders")
        check_whole(os.path.join(FOLDER, f"side{k}"), "two runs at once")

    results = os.path.join(FOLDER, "one")
    first = start(results, SLOW)
    check(wait_for_rows(first, results), "the first run writes")
    for ranks in (1, 2):
        status, _, stderr = run(results, ranks=ranks)
        check_end(status, stderr, 1, "another run", str(first.pid))
    check(first.poll() is None and status_of(results) == "running", "the first run goes on")
    first.kill()
    first.wait()
    check(run(results)[0] == 0 and status_of(results) == "complete", "a run after one that was killed")
    check("fields/peridynamics_0004.h5" not in listing(results), f"files of the killed run: {sorted(listing(results))}")


def ends():
    for ranks, kind in ((1, signal.SIGTERM), (1, signal.SIGINT), (2, signal.SIGTERM)):
        results = os.path.join(FOLDER, f"{kind.name}{ranks}")
        process = start(results, SLOW, ranks)
        check(wait_for_rows(process, results), "rows before the signal")
        process.send_signal(kind)
        _, stderr = process.communicate(timeout=60)
        if ranks == 1:  # mpirun has words and a status of its own
            check_end(process.returncode, stderr, 3, "stopped", kind.name, results)
        check(process.returncode != 0 and status_of(results) == "stopped", f"{kind.name}: status {process.returncode}")
        check_whole(results, kind.name)
    results = os.path.join(FOLDER, "killed")
    process = start(results, SLOW)
    check(wait_for_rows(process, results), "rows before the kill")
    process.kill()
    process.wait()
    check(status_of(results) == "running", "SIGKILL")
    check_whole(results, "SIGKILL", killed=True)
    written = max(name for name in os.listdir(os.path.join(results, "fields")) if not name.endswith(".part"))
    for name in ("peridynamics.pvd", os.path.join("fields", written)):  # what a kill in the midst of these files leaves
        open(os.path.join(results, name + ".part"), "w").close()
    status, _, stderr = run(results)
    check(status == 0 and status_of(results) == "complete", f"a run after a kill:\n{stderr}")
    check_whole(results, "a run after a kill")
    check(not [name for name in listing(results) if name.endswith(".part")], f"left after a run after a kill: {sorted(listing(results))}")

    results = os.path.join(FOLDER, "removed")
    process = start(results, SLOW)
    check(wait_for_rows(process, results), "rows before the folder goes")
    shutil.rmtree(results, ignore_errors=True)
    shutil.rmtree(results, ignore_errors=True)
    _, stderr = process.communicate(timeout=60)
    check_end(process.returncode, stderr, 1, "cannot write", "No such file")

    # half of the runs write into a folder of limited room: a limit on the size of files does the
    # same as a full disk
    big = {"Domain/Cells": "60, 60", "Output/Fields": "vtu, hdf5", "Output/Write every": "0.1"}
    for size in (3000, 30000, 300000, 1000000):
        limited = os.path.join(FOLDER, f"limit{size}")
        process = start(limited, big, preexec_fn=lambda most=size: __import__("resource").setrlimit(1, (most, most)))
        _, stderr = process.communicate(timeout=60)
        check_end(process.returncode, stderr, 1, "cannot write", "too large")
        if os.path.exists(limited):
            check_whole(limited, f"files of at most {size} bytes")

    # a study goes on after a row for which memory does not suffice
    study = os.path.join(FOLDER, "study")
    words = [EXECUTABLE, "study", scene_file(), "--vary", "Domain/Cells=12, 10 | 900, 900 | 13, 11", "-s", "Time/Steady=true", "-s",
             "Output/Write every=", "-s", "Output/Fields=none", "--output", study]
    done = subprocess.run(words, capture_output=True, text=True, timeout=100,
                          preexec_fn=lambda: __import__("resource").setrlimit(__import__("resource").RLIMIT_AS, (800 << 20, 800 << 20)))
    check_end(done.returncode, done.stderr, 1, "1 of 3 rows", "memory")
    with open(os.path.join(study, "study.csv"), newline="") as file:
        states = {row["Domain/Cells"]: row["status"] for row in csv.DictReader(file)}
    check(states == {"12, 10": "finished", "900, 900": "failed", "13, 11": "finished"}, f"the rows of the study: {states}\n{done.stdout}")

    # a full folder for temporary files
    temporary = os.path.join(FOLDER, "tmp")
    os.makedirs(temporary)
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=100k", "tmpfs", temporary], capture_output=True).returncode == 0:
        with open(os.path.join(temporary, "fill"), "wb") as file:
            file.write(bytes(90 * 1024))
        process = subprocess.run([EXECUTABLE] + arguments(scene_file(), os.path.join(FOLDER, "full")), capture_output=True, text=True,
                                 env={**{k: v for k, v in os.environ.items() if "tmpdir" not in k}, "TMPDIR": temporary}, timeout=60)
        subprocess.run(["umount", temporary], check=False)
        check(process.returncode == 0 and process.stderr == "", f"a full TMPDIR: {process.returncode}\n{process.stderr}")


if __name__ == "__main__":
    run_parts(mixing, together, ends)
