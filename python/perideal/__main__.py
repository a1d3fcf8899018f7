# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""The command line: `python3 -m perideal study work_precision | stability SCENE.prm`; all other words go to the program perideal.

    python3 -m perideal ARGUMENTS [-n PROCESSES]
"""

import argparse
import os
import signal
import sys

from . import program
from .program import Error
from .words import did_you_mean

HELP = " `perideal --help` and `perideal study --help` explain the arguments."
KINDS = {"work_precision": "Charts accuracy against cost over methods and lattices",
         "stability": "Maps where a scene is computed well and where not"}


class _Parser(argparse.ArgumentParser):
    """Says what is wrong as the program does."""

    def error(self, message):
        raise Error(message.removeprefix("argument ") + "." + HELP)


def _whole(least: int, most: int):
    """A whole number of this range."""
    def parse(text: str) -> int:
        if not (text.isascii() and text.isdigit() and least <= int(text) <= most):
            raise argparse.ArgumentTypeError(f"Value {text} not in range {least} to {most}")
        return int(text)

    return parse


def _positive(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"Value {text} is no positive number")
    return value


def _parser(kind: str) -> argparse.ArgumentParser:
    """Options of both kinds of studies; those of others are known, to be refused."""
    parser = _Parser(prog=f"python3 -m perideal study {kind}", allow_abbrev=False, description=KINDS[kind] + " (doc/study.md).")
    add = parser.add_argument
    add("files", nargs="*", metavar="SCENE", help="scene (.prm)")
    add("-n", "-np", "--ranks", type=_whole(1, 10000), default=1, metavar="PROCESSES", help="compute with this many processes (1)")
    add("-s", "--set", action="append", default=[], metavar='"Section/Entry=value"', help="override an entry in all runs")
    add("--output", default="", help="directory of the results")
    add("--quick", action="store_true", help='compute the rows marked "quick" only; stability: few points of each map')
    add("-q", "--quiet", action="store_true", help="print nothing but errors")
    add("--vary", help=argparse.SUPPRESS)
    rows = parser.add_argument_group("work_precision")
    rows.add_argument("--cells", help='the lattices, from coarse to fine: "21, 21 | 41, 41 | 81, 81"')
    rows.add_argument("--reference", help="the three lattices of the reference solution")
    rows.add_argument("--budget", type=_positive, help="leave out peridynamics in the whole body with more bonds (2e6)")
    rows.add_argument("--measure", help="the error of the field, of the opening of cracks, of stress intensity, or of the strength or path of cracks that grow (field)")
    rows.add_argument("--no-auto", action="store_true", default=None, help="leave out what `Models = auto` chooses")
    rows.add_argument("--only", nargs="+", action="extend", metavar="NAME", help="compute the rows or groups of these names only")
    rows.add_argument("--redo", action="store_true", default=None, help="compute finished rows again")
    rows.add_argument("--repeat", type=_whole(1, 1000), metavar="N", help="run every row so often and keep the smallest times")
    maps = parser.add_argument_group("stability")
    maps.add_argument("--maps", help='the maps wanted, with commas between them: "step limit, growth"')
    maps.add_argument("--random", type=_whole(0, 10000), metavar="N", help="so many random points inside each safe region, and outside")
    maps.add_argument("--seed", type=_whole(0, 2 ** 32 - 1), help="of the random points (1)")
    return parser


def _parse(kind: str, words):
    """The options. Raises Error."""
    parser = _parser(kind)
    options, unknown = parser.parse_known_intermixed_args(words)
    unknown = [word for word in unknown if word.startswith("-")] or unknown
    if unknown:
        names = [name for action in parser._actions for name in action.option_strings if name.startswith("--")]
        hint = did_you_mean(unknown[0].split("=")[0], names) if unknown[0].startswith("--") else ""
        several = "s were" if len(unknown) > 1 else " was"
        raise Error(f"The following argument{several} not expected: {' '.join(unknown)}.{hint}{HELP}")
    if len(options.files) != 1 or options.files[0].endswith(".json"):
        raise Error(f"perideal study {kind} needs one scene (.prm), found {', '.join(options.files) or 'none'}.")
    return options


def _given(options, *names) -> dict:
    """Those of the options that were given."""
    return {name: getattr(options, name) for name in names if getattr(options, name) is not None}


def _work_precision(options) -> int:
    from . import work_precision
    from .work_precision.driver import Ended

    if options.vary is not None:
        raise Error("--vary is not for work_precision, which varies methods and lattices; --cells names the lattices.")
    if _given(options, "maps", "random", "seed"):
        raise Error("--maps, --random and --seed are for `./run study stability SCENE.prm`.")
    study = [*(["--only", *options.only] if options.only else []), *(["--quick"] if options.quick else []),
             *(["--redo"] if options.redo else []), "--repeat", str(options.repeat or 1)]
    try:
        mistake = work_precision.run(options.files[0], work_precision.Options(
            overrides=options.set, picks=not options.no_auto, output=options.output, study=study, quiet=options.quiet, processes=options.ranks,
            **_given(options, "cells", "reference", "budget", "measure")))
    except Ended as ended:
        return ended.status
    print(mistake, end="", file=sys.stderr)
    return 1 if mistake else 0


def _stability(options) -> int:
    from . import stability

    if options.vary is not None:
        raise Error("--vary is not for stability, whose maps say what they vary; --maps chooses them.")
    if options.only or options.redo or (options.repeat or 1) != 1:
        raise Error("--only, --redo and --repeat are not for stability, which has no rows; --maps chooses maps.")
    if _given(options, "cells", "reference", "budget", "measure", "no_auto"):
        raise Error("--cells, --reference, --budget, --measure and --no-auto are for `./run study work_precision SCENE.prm`.")
    stability.run(options.files[0], stability.Options(
        overrides=options.set, output=options.output, n_random=options.random or 0, quick=options.quick, quiet=options.quiet,
        processes=options.ranks, **_given(options, "maps", "seed")))
    return 0


def _stop(number, _):
    """A signal ends a study as Ctrl-C does."""
    raise KeyboardInterrupt({signal.SIGTERM: "a request to end (SIGTERM)", signal.SIGHUP: "the end of the terminal (SIGHUP)", signal.SIGUSR1: "a request to stop (SIGUSR1)"}[number])


def main(words) -> int:
    """Exit status."""
    for number in (signal.SIGTERM, signal.SIGHUP, signal.SIGUSR1):
        signal.signal(number, _stop)
    try:
        if words[:1] == ["study"] and words[1:2] and words[1] in KINDS:
            options = _parse(words[1], words[2:])
            return _work_precision(options) if words[1] == "work_precision" else _stability(options)
        processes = 1
        if len(words) > 2 and words[-2] == "-n":
            processes, words = _whole(1, 10000)(words[-1]), words[:-2]
        command = program.command(words, processes)
        os.execvpe(command[0], command, program.environment())
    except Error as error:
        print(f"\nperideal: {'error: ' if error.status == 1 else ''}{error}", file=sys.stderr)
        return error.status
    except FileNotFoundError as error:  # the launcher, or what PERIDEAL_EXECUTABLE names
        print(f"\nperideal: error: '{error.filename}' was not found.", file=sys.stderr)
        return 1
    except KeyboardInterrupt as stop:
        print(f"\nperideal: stopped by {str(stop) or 'an interrupt (SIGINT)'}.", file=sys.stderr)
        return 3
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
