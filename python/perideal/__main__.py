# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""The command line: `python3 -m perideal study work_precision SCENE.prm`; all other words go to the program perideal.

    python3 -m perideal ARGUMENTS [-n PROCESSES]
"""

import argparse
import os
import sys

from . import program
from .program import Error

HELP = " `perideal --help` and `perideal study --help` explain the arguments."
KIND = ["study", "work_precision"]


class _Parser(argparse.ArgumentParser):
    """Says what is wrong as the program does."""

    def error(self, message):
        raise Error(message.removeprefix("argument ") + "." + HELP)


def _whole(text: str) -> int:
    if not (text.isascii() and text.isdigit() and 1 <= int(text) <= 1000):
        raise argparse.ArgumentTypeError(f"Value {text} not in range 1 to 1000")
    return int(text)


def _positive(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"Value {text} is no positive number")
    return value


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(prog="python3 -m perideal study work_precision", allow_abbrev=False,
                     description="Charts accuracy against cost over methods and lattices (doc/study.md).")
    add = parser.add_argument
    add("files", nargs="*", metavar="SCENE", help="scene (.prm)")
    add("-n", "-np", "--ranks", type=_whole, default=1, metavar="PROCESSES", help="compute with this many processes (1)")
    add("-s", "--set", action="append", default=[], metavar='"Section/Entry=value"', help="override an entry in all rows")
    add("--output", default="", help="directory of the results")
    add("--cells", default="", help='the lattices, from coarse to fine: "21, 21 | 41, 41 | 81, 81"')
    add("--reference", default="", help="the three lattices of the reference solution")
    add("--budget", type=_positive, default=2e6, help="leave out peridynamics in the whole body with more bonds (2e6)")
    add("--measure", default="field", help="the error of the field, of the opening of cracks, or of stress intensity (field)")
    add("--no-auto", action="store_true", help="leave out what `Models = auto` chooses")
    add("--only", nargs="+", action="extend", default=[], metavar="NAME", help="compute the rows or groups of these names only")
    add("--quick", action="store_true", help='compute the rows marked "quick" only')
    add("--redo", action="store_true", help="compute finished rows again")
    add("--repeat", type=_whole, default=1, metavar="N", help="run every row so often and keep the smallest times")
    add("-q", "--quiet", action="store_true", help="print nothing but errors")
    for name in ("--vary", "--maps", "--random", "--seed"):  # of other studies
        add(name, help=argparse.SUPPRESS)
    return parser


def _parse(words):
    """The options. Raises Error."""
    from .work_precision.words import did_you_mean

    parser = _parser()
    options, unknown = parser.parse_known_intermixed_args(words)
    unknown = [word for word in unknown if word.startswith("-")] or unknown
    if unknown:
        names = [name for action in parser._actions for name in action.option_strings if name.startswith("--")]
        hint = did_you_mean(unknown[0].split("=")[0], names) if unknown[0].startswith("--") else ""
        several = "s were" if len(unknown) > 1 else " was"
        raise Error(f"The following argument{several} not expected: {' '.join(unknown)}.{hint}{HELP}")
    if len(options.files) != 1 or options.files[0].endswith(".json"):
        raise Error(f"perideal study work_precision needs one scene (.prm), found {', '.join(options.files) or 'none'}.")
    if options.vary is not None:
        raise Error("--vary is not for work_precision, which varies methods and lattices; --cells names the lattices.")
    if any(value is not None for value in (options.maps, options.random, options.seed)):
        raise Error("--maps, --random and --seed are for `perideal study stability SCENE.prm`.")
    return options


def _work_precision(words) -> int:
    from . import work_precision
    from .work_precision.driver import Ended

    options = _parse(words)
    study = [*(["--only", *options.only] if options.only else []), *(["--quick"] if options.quick else []),
             *(["--redo"] if options.redo else []), "--repeat", str(options.repeat)]
    try:
        mistake = work_precision.run(options.files[0], work_precision.Options(
            overrides=options.set, cells=options.cells, reference=options.reference, budget=options.budget, picks=not options.no_auto,
            measure=options.measure, output=options.output, study=study, quiet=options.quiet, processes=options.ranks))
    except Ended as ended:
        return ended.status
    print(mistake, end="", file=sys.stderr)
    return 1 if mistake else 0


def main(words) -> int:
    """Exit status."""
    try:
        if words[:2] == KIND:
            return _work_precision(words[2:])
        processes = 1
        if len(words) > 2 and words[-2] == "-n":
            processes, words = _whole(words[-1]), words[:-2]
        command = program.command(words, processes)
        os.execvpe(command[0], command, program.environment())
    except Error as error:
        print(f"\nperideal: {'error: ' if error.status == 1 else ''}{error}", file=sys.stderr)
        return error.status
    except KeyboardInterrupt:
        return 3  # the program has said so
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
