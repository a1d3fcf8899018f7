# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""python3 -m perideal.meshes [--dimension 2] FILE OUT.msh: writes a mesh of any format as a Gmsh file; notes go to standard output, a fault as
one line, which goes on behind the file's name, to standard error."""

import argparse
import sys
import warnings

from .convert import convert
from .mesh import Fault


def main() -> int:
    parser = argparse.ArgumentParser(prog="python3 -m perideal.meshes", description="Writes a mesh of any format as a Gmsh file (.msh)")
    parser.add_argument("file")
    parser.add_argument("out")
    parser.add_argument("--dimension", type=int, choices=(0, 1, 2, 3), default=0, help="of the cells (0: the highest)")
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    try:
        notes = convert(options.file, options.out, options.dimension)
    except Fault as fault:
        print(f"{' '.join(str(fault).split())}.", file=sys.stderr)
        return 1
    for note in notes:
        print(" ".join(note.split()))
    return 0


if __name__ == "__main__":
    sys.exit(main())
