#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Run a command of ctest, print its slowest tests and what all took; ask for no more than the budget.

    slowest_tests.py [--budget PROGRAM] JUNIT_FILE SECONDS_OF_BUILD COMMAND...

The command is one of `ctest --output-junit JUNIT_FILE`, whose exit status is that of this script. The budget is one of processor time
of the tests and all that they start: other work on the machine hardly counts, and two cores or twenty do not. Machines differ, so that
it is in units of what PROGRAM, the built perideal, takes for two scenes. With --budget the exit status is 1 where more was spent.
"""

import os
import resource
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

SHOWN = 10
ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))

# Tests `quick` and `full`: 46 minutes (CONTRIBUTING.md) where the scenes below take 4.3 s.
BUDGET = 46 * 60 / 4.3
SCENES = [["prm/heat/closing_crack.prm"], ["prm/fracture/centre_crack.prm", "-s", "Domain/Cells=30, 60"]]


def processor_time():
    """Of all children that have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def unit_of_machine(program):
    """The least processor time of three runs of the scenes."""
    found = []
    with tempfile.TemporaryDirectory(prefix="perideal_") as folder:
        for _ in range(3):
            before = processor_time()
            for scene in SCENES:
                subprocess.run([program, "run", "-q", "--overwrite", *scene, "-s", f"Output directory={folder}/results", "-s", "Output/Fields=none"],
                               cwd=ROOT, check=True, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
            found.append(processor_time() - before)
    return min(found)


def read_times(path):
    """(seconds, name, status) of each test that ran, the slowest first."""
    try:
        cases = ElementTree.parse(path).getroot().iter("testcase")
    except (OSError, ElementTree.ParseError):
        return []  # interrupted
    ran = [(float(case.get("time", 0)), case.get("name"), case.get("status")) for case in cases if case.get("status") in ("run", "fail")]
    return sorted(ran, reverse=True)


def in_words(seconds):
    return f"{seconds:.0f} s" if seconds < 100 else f"{seconds // 60:.0f} min {seconds % 60:.0f} s"


def main(arguments):
    program = None
    if arguments[0] == "--budget":
        program, arguments = arguments[1], arguments[2:]
    path, build, command = arguments[0], int(arguments[1]), arguments[2:]
    start, before = os.times().elapsed, processor_time()
    status = subprocess.run(command, check=False).returncode
    tests, used = os.times().elapsed - start, processor_time() - before
    slowest = read_times(path)
    if len(slowest) > 1:
        print(f"\nSlowest of {len(slowest)} tests:")
        for seconds, name, end in slowest[:SHOWN]:
            print(f"{seconds:8.1f} s  {name}{'  (failed)' if end == 'fail' else ''}")
    print(f"Build {in_words(build)}, tests {in_words(tests)}, together {in_words(build + tests)}.")
    if program and status == 0:
        allowed = BUDGET * unit_of_machine(program)
        print(f"Processor time of the tests: {in_words(used)} of {in_words(allowed)} that they may take on this machine.")
        if used > allowed:
            print("The tests take too long: make the slowest of them shorter, or `long` (CONTRIBUTING.md, what tests may take).", file=sys.stderr)
            return 1
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
