#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Print the slowest tests of a run of ctest, and how long all took.

    slowest_tests.py JUNIT_FILE SECONDS_OF_BUILD SECONDS_OF_TESTS

The file is that of `ctest --output-junit`. Times are wall times. Always ends with exit status 0: the judgement is ctest's.
"""

import sys
import xml.etree.ElementTree as ElementTree

SHOWN = 10


def read_times(path):
    """(seconds, name, status) of each test that ran, the slowest first."""
    try:
        cases = ElementTree.parse(path).getroot().iter("testcase")
    except (OSError, ElementTree.ParseError):
        return []  # interrupted
    ran = [(float(case.get("time", 0)), case.get("name"), case.get("status")) for case in cases if case.get("status") in ("run", "fail")]
    return sorted(ran, reverse=True)


def in_words(seconds):
    return f"{seconds} s" if seconds < 100 else f"{seconds // 60} min {seconds % 60} s"


def main():
    path, build, tests = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    slowest = read_times(path)
    if len(slowest) > 1:
        print(f"\nSlowest of {len(slowest)} tests:")
        for seconds, name, status in slowest[:SHOWN]:
            print(f"{seconds:8.1f} s  {name}{'  (failed)' if status == 'fail' else ''}")
    print(f"Build {in_words(build)}, tests {in_words(tests)}, together {in_words(build + tests)}.")


if __name__ == "__main__":
    main()
