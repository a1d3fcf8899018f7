# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Print numbers under the names they have in a scene test and, if asked, compare them with what is held there."""

import argparse
import importlib.util
import os
import sys

import numpy as np

SCENES = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "scenes")


def load_scene_test(name):
    """The module tests/scenes/NAME.py, without running its tests."""
    sys.path.append(SCENES)
    spec = importlib.util.spec_from_file_location(f"scenes_{name}", os.path.join(SCENES, f"{name}.py"))
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class Constants:
    """The numbers of one scene test: reads the command line, prints, compares, ends the program."""

    def __init__(self, name, description):
        parser = argparse.ArgumentParser(description=description.splitlines()[0])
        parser.add_argument("--check", action="store_true", help=f"compare with the constants in tests/scenes/{name}.py")
        parser.add_argument("--cells", type=int, default=10 ** 9, metavar="N", help="leave out lattices with more cells a side")
        options = parser.parse_args()
        self.most_cells = options.cells
        self.held = load_scene_test(name) if options.check else None
        self.n_compared = self.n_gaps = 0
        self.worst = 0.0

    def wanted(self, *cells):
        """Whether all these numbers of cells are to be run."""
        return max(cells) <= self.most_cells

    def show(self, name, keys, found, form, relative=0.0):
        """Print the number or numbers of the constant name[key][key]... in this format, and compare them.

        form: as in format(), with the digits that the scene test holds. A unit of the last digit is allowed, or a
        relative gap where round-off reaches farther.
        """
        numbers = np.atleast_1d(found)
        place = name + "".join(f"[{key!r}]" for key in keys)
        texts = [f"{number if abs(number) > 1e-12 else 0.0:{form}}" for number in numbers]
        print(f"{place} = {', '.join(texts)}", flush=True)
        if self.held is None:
            return
        held = getattr(self.held, name)
        for key in keys:
            held = held[key]
        held = np.atleast_1d(held)
        if len(held) != len(numbers):
            self.complain(f"{place}: {len(numbers)} numbers where the scene test holds {len(held)}")
            return
        for number, other in zip(numbers, held):
            allowed = max(unit_of_last_digit(f"{number:#{form}}"), relative * abs(other))
            self.compare(place, number, other, allowed)

    def compare(self, place, number, held, allowed):
        """Count a comparison, and a gap if there is one."""
        self.n_compared += 1
        share = abs(number - held) / allowed
        self.worst = max(self.worst, share)
        if not share <= 1:
            self.complain(f"{place}: {number:.15g} where the scene test holds {held:.15g}")

    def complain(self, text):
        """Print and count a gap."""
        self.n_gaps += 1
        print(f"GAP: {text}", flush=True)

    def finish(self):
        """End the program, with exit status 1 if there was a gap."""
        if self.held is not None:
            print(f"{self.n_compared} numbers compared, {self.n_gaps} gaps; largest difference {self.worst:.2g} of what is allowed")
        sys.exit(1 if self.n_gaps else 0)


def unit_of_last_digit(text):
    """0.01 for '1.23', 0.001 for '1.23e-01'."""
    mantissa, _, exponent = text.partition("e")
    decimals = len(mantissa.partition(".")[2])
    return 10.0 ** (int(exponent or 0) - decimals)
