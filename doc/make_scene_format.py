#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Write the entries of doc/scene_format.md from the program itself.

    python3 doc/make_scene_format.py [--program PERIDEAL] [--check]

Everything above the mark in that file is written by hand and stays; below it comes the output of
`perideal parameters markdown`. With --check nothing is written, and a page that is not up to date
is an error.
"""

import argparse
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "doc" / "scene_format.md"
MARK = "<!-- below: written by doc/make_scene_format.py -->\n"


def main():
    """Command line."""
    parser = argparse.ArgumentParser(description="Write the entries of doc/scene_format.md.")
    parser.add_argument("--program", default=str(ROOT / "build/release/applications/perideal"))
    parser.add_argument("--check", action="store_true", help="only say whether it is up to date")
    options = parser.parse_args()
    manual = subprocess.run([options.program, "parameters", "markdown"],
                            check=True, capture_output=True, text=True).stdout
    # The headline of the manual becomes one of the page, its sections one deeper.
    manual = "".join("#" + line if line.startswith("#") else line
                     for line in manual.splitlines(keepends=True))
    old = PAGE.read_text(encoding="utf-8")
    if MARK not in old:
        sys.exit(f"{PAGE}: the line '{MARK.strip()}' is missing")
    new = old[:old.index(MARK)] + MARK + "\n" + manual
    if options.check:
        if new != old:
            print("doc/scene_format.md is not up to date: run python3 doc/make_scene_format.py")
        return int(new != old)
    PAGE.write_text(new, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
