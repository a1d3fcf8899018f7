# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Lattices of a box with cracks: ladders from coarse to fine, those with the cracks on cell faces, and errors at their vertices.

Cells are tuples of numbers of cells, one per direction; a box is the facts of a scene, perideal.describe().
"""

import itertools
import math
from typing import List, Optional, Tuple

import numpy as np

from ..program import Error
from ..words import split_list

Cells = Tuple[int, ...]


def to_text(cells: Cells) -> str:
    """"21, 21", as the entry `Cells` has it."""
    return ", ".join(map(str, cells))


def name_of(cells: Cells) -> str:
    """"21 x 21"."""
    return " x ".join(map(str, cells))


def parse_ladder(text: str, option: str, dim: int, at_least: int) -> List[Cells]:
    """"21, 21 | 41, 41" taken apart. Raises Error naming the option: another form, a count of zero, lattices that do not become finer in every
    direction, fewer than at_least of them."""
    where = f"command line: {option} '{text}'"
    needed = (f"; needs lattices as 'Cells' has them, {dim} number{'' if dim == 1 else 's'} each, from coarse to fine, separated by '|': "
              f'"{to_text((20,) * dim)} | {to_text((40,) * dim)}".')
    ladder: List[Cells] = []
    for lattice in split_list(text, "|"):
        counts = split_list(lattice, ",")
        for count in counts:
            if not (count.isascii() and count.isdigit() and len(count) < 9 and int(count) > 0):
                raise Error(f"{where}: '{count}' is no number of cells{needed}")
        if len(counts) != dim:
            raise Error(f"{where}: '{lattice}' has {len(counts)} number{'' if len(counts) == 1 else 's'}{needed}")
        cells = tuple(map(int, counts))
        if ladder and not all(n > before for n, before in zip(cells, ladder[-1])):
            raise Error(f"{where}: '{lattice}' is not finer than '{to_text(ladder[-1])}' in every direction{needed}")
        ladder.append(cells)
    if len(ladder) < at_least:
        raise Error(f"{where}: found {len(ladder)}, needs {at_least} or more{needed}")
    return ladder


def nearest_whole(x: float) -> int:
    """Halves are rounded up; x is not negative."""
    return math.floor(x + 0.5)


def default_ladder(cells: Cells, n_rungs: int) -> List[Cells]:
    """Up to n_rungs lattices, each about twice as fine as the one before, the last one cells itself; odd counts stay odd and even ones even,
    since a row of nodes on a crack makes another discretisation than none. None has fewer than eight cells in a direction."""
    ladder = []
    for k in reversed(range(n_rungs)):
        rung = tuple(2 * nearest_whole(max(0.0, 0.5 * (n / 2 ** k - n % 2))) + n % 2 for n in cells)
        if min(rung) >= 8 or k == 0:
            ladder.append(rung)
    return ladder


def corners_on_planes(box: dict, d: int, n: int) -> bool:
    """Whether the corners of all cracks lie on planes of a lattice of n cells in this direction; beyond the box a crack may end anywhere."""
    lower, length = box["lower"][d], box["upper"][d] - box["lower"][d]
    places = (min(max((corner[d] - lower) / length, 0.0), 1.0) * n for crack in box["cracks"] for corner in crack)
    return all(abs(s - round(s)) <= 1e-7 for s in places)


def nearest_fitting(box: dict, cells: Cells, on_faces: bool, multiple: int) -> Optional[Cells]:
    """The counts nearest to cells, the smaller of two, that are divisible by multiple and, with on_faces, put all corners of all cracks on
    vertices of the lattice of cells so many times as large. None if there is none within a fifth of a count, or multiple, or two."""
    if on_faces and not box["cracks along axes"]:
        return None

    def fits(d, count):
        return count > 0 and count % multiple == 0 and (not on_faces or corners_on_planes(box, d, count // multiple))

    fitting = []
    for d, n in enumerate(cells):
        nearest = (count for k in range(max(2, n // 5, multiple) + 1) for count in (n - k, n + k) if fits(d, count))
        found = next(nearest, None)
        if found is None:
            return None
        fitting.append(found)
    return tuple(fitting)


def estimated_bonds(box: dict, cells: Cells, ratio: float) -> float:
    """About how many bonds peridynamics in the whole box has on this lattice at m = ratio: all pairs of nodes nearer than the horizon and half
    a spacing, edges neglected."""
    h = [(upper - lower) / n for lower, upper, n in zip(box["lower"], box["upper"], cells)]
    reach = (ratio + 0.5) * min(h)
    offsets = itertools.product(*(range(-int(reach / spacing), int(reach / spacing) + 1) for spacing in h))
    n_near = sum(sum(i * spacing * i * spacing for i, spacing in zip(offset, h)) < reach * reach for offset in offsets)
    return 0.5 * n_vertices(cells) * (n_near - 1)  # without the node itself


def n_vertices(cells: Cells) -> int:
    """Of the lattice."""
    return math.prod(n + 1 for n in cells)


def sum_in_turn(values) -> float:
    """Added one after the other, so that the last digit is the same wherever it is computed."""
    return float(np.cumsum(values)[-1]) if len(values) else 0.0


def nodal_error(values, reference, cells: Cells, with_gaps: bool = False) -> float:
    """sqrt(sum V (u - r)^2 / sum V r^2) over the vertices of a lattice, x fastest, V their share of the cells around them; all components of a
    point are together. Without a reference that differs from zero the root of sum V u^2/sum V.

    with_gaps: what has no number in the reference does not count: an exact solution on a crack, where it has two values.
    """
    values, reference = np.asarray(values, float), np.asarray(reference, float)
    volume = np.ones(1)
    for n in reversed(cells):
        share = np.ones(n + 1)
        share[[0, -1]] = 0.5
        volume = np.multiply.outer(volume, share).ravel()
    volume = np.repeat(volume, len(values) // len(volume))
    if with_gaps:
        known = ~np.isnan(reference)
        values, reference, volume = values[known], reference[known], volume[known]
    difference, size = volume * (values - reference) * (values - reference), volume * reference * reference
    total = sum_in_turn(size)
    return math.sqrt(sum_in_turn(difference) / (total if total > 0 else sum_in_turn(volume)))
