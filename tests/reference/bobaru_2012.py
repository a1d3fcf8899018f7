# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Examples 1 and 2 of Bobaru and Duangpanya, J. Comput. Phys. 231 (2012): the constants of tests/scenes/bobaru_2012.py.

Nodes are the vertices of a unit square; those on its sides have a half or a quarter of a cell. The numbers are relative differences
from classical heat conduction along y = 0.5 (equation 13).
Paper settings: prefactor of the integral, self term, nodes on insulated sides extrapolated. Defaults: discrete calibration only.
"""

from math import pi

import numpy as np
import scipy.sparse as sparse
from scipy.sparse.linalg import splu

from constants import Constants
from peridynamics import Family, bond_matrix, eigenvalue_bound, exponential, kernel, rate_matrix

TIMES_1 = (0.025,)
TIMES_2 = (0.05, 0.1, 0.2)
KAPPA = {1: 1.14, 2: 1.0}


class Square:
    """Nodes and bonds of the unit square with this many cells a side."""

    def __init__(self, n_cells, ratio, conductivity, as_published):
        calibration = "analytic" if as_published else "discrete"
        family = Family(2, ratio, 1 / n_cells, calibration=calibration, conductivity=conductivity)
        counts = (n_cells + 1, n_cells + 1)
        widths = np.full(n_cells + 1, family.spacing)
        widths[[0, -1]] /= 2
        self.volumes = np.outer(widths, widths).ravel()
        axis = np.arange(n_cells + 1)
        self.row, self.column = (index.ravel() for index in np.meshgrid(axis, axis, indexing="ij"))
        self.n_cells = n_cells
        self.bonds = bond_matrix(counts, family.offsets, family.weights, self.volumes)
        own = self_term(counts, family, self.volumes) if as_published else 0 * self.bonds
        self.rates = rate_matrix(self.bonds + own)

    def depth(self, side):
        """Distance of all nodes from a side, in spacings."""
        return {"left": self.column, "right": self.n_cells - self.column,
                "bottom": self.row, "top": self.n_cells - self.row}[side]

    def middle_line(self):
        """Numbers of the nodes on y = 0.5, from left to right."""
        return np.flatnonzero(2 * self.row == self.n_cells)


def self_term(counts, family, volumes):
    """What stands for the node itself: 0.5 k(r/2)/r^2 times its own area for each of the eight touching neighbours."""
    offsets, r = family.touching()
    weights = 0.5 * family.prefactor * kernel(family.shape, r / 2, family.horizon) / r ** family.n
    return bond_matrix(counts, offsets, weights, volumes, own_volume=True)


def extrapolation(square, sides, is_fixed):
    """Nodes on insulated sides, and for them the weights w_ij V_j L_j, which add up to 1; L_j is the distance of j from the side.

    A corner belongs to the side named first.
    """
    side_of = np.full(len(is_fixed), -1)
    for number in reversed(range(len(sides))):
        side_of[square.depth(sides[number]) == 0] = number
    side_of[is_fixed] = -1
    slaves = np.flatnonzero(side_of >= 0)
    bonds = square.bonds[slaves].tocoo()
    depths = np.array([square.depth(side) for side in sides])
    weights = bonds.data * depths[side_of[slaves][bonds.row], bonds.col]
    matrix = sparse.csr_matrix((weights, (bonds.row, bonds.col)), shape=bonds.shape)
    return slaves, sparse.diags(1 / np.asarray(matrix.sum(axis=1)).ravel()) @ matrix


def evolve(square, is_fixed, start, times, insulated=()):
    """Temperatures of all nodes, counted from that of the fixed ones, which is the same everywhere; the others begin with `start`."""
    bound = eigenvalue_bound(square.rates)
    slaves, weights = extrapolation(square, insulated, is_fixed) if insulated else (np.array([], dtype=int), None)
    is_free = ~is_fixed
    is_free[slaves] = False
    free = np.flatnonzero(is_free)
    rates = square.rates[free][:, free]
    found = np.zeros((len(times), len(is_fixed)))
    if not insulated:
        found[:, free] = exponential(rates.dot, np.full(len(free), start), times, bound)
        return found
    # Slaves lie in each other's families: S = W_ss S + W_sf F.
    among = splu((sparse.eye(len(slaves)) - weights[:, slaves]).tocsc())
    to_slaves, from_slaves = weights[:, free].tocsr(), square.rates[free][:, slaves]
    ends = exponential(lambda v: rates @ v + from_slaves @ among.solve(to_slaves @ v), np.full(len(free), start), times, bound)
    found[:, free] = ends
    found[:, slaves] = [among.solve(to_slaves @ end) for end in ends]
    return found


def cooled_square(x, t):
    """Classical temperature of Example 1 on y = 0.5."""
    k = np.arange(1, 400, 2)
    factors = 4 / (k * pi) * np.exp(-KAPPA[1] * (k * pi) ** 2 * t)
    return 40 * (np.sin(pi * np.outer(x, k)) @ factors) * (np.sin(k * pi / 2) @ factors)


def heated_square(x, t):
    """Classical temperature of Example 2, which does not depend on y."""
    q = (np.arange(1, 400) - 0.5) * pi
    return 1 - np.sin(np.outer(x, q)) @ (2 / q * np.exp(-q ** 2 * t))


def differences(square, found, times, classical):
    """Relative differences along y = 0.5, one for each time."""
    line = square.middle_line()
    exact = [classical(square.column[line] / square.n_cells, t) for t in times]
    return [np.linalg.norm(one[line] - wanted) / np.linalg.norm(wanted) for one, wanted in zip(found, exact)]


def example_1(n_cells, ratio, as_published):
    """A square at 40 with all sides held at 0."""
    square = Square(n_cells, ratio, KAPPA[1], as_published)
    is_fixed = np.any([square.depth(side) == 0 for side in ("left", "right", "bottom", "top")], axis=0)
    found = evolve(square, is_fixed, 40.0, TIMES_1)
    return differences(square, found, TIMES_1, cooled_square)[0]


def example_2(n_cells, ratio, as_published):
    """A square at 0 with the left side held at 1, the others insulated."""
    square = Square(n_cells, ratio, KAPPA[2], as_published)
    insulated = ("right", "bottom", "top") if as_published else ()
    found = 1 + evolve(square, square.depth("left") == 0, -1.0, TIMES_2, insulated)
    return differences(square, found, TIMES_2, heated_square)


def main():
    constants = Constants("bobaru_2012", __doc__)
    counts = [n for n in (60, 120, 240) if constants.wanted(n)]
    for n_cells in counts:
        constants.show("PROGRAM", [n_cells], example_2(n_cells, 6.5, True), ".8f")
    for ratio, n_cells in [(6.5, n) for n in counts] + [(3, n) for n in counts if n == 120]:
        constants.show("PROGRAM_OURS", [(ratio, n_cells)], example_2(n_cells, ratio, False), ".10f")
    for ratio, n_cells in [(ratio, n) for ratio in (6.5, 3) for n in counts]:
        constants.show("RATES_OURS", [(ratio, n_cells)], example_1(n_cells, ratio, False), ".10f")
    for ratio, coarsest in ((5.2, 48), (6.5, 60), (104 / 15, 64), (10.4, 96)):
        for n_cells in (coarsest, 2 * coarsest, 4 * coarsest):
            if constants.wanted(n_cells):
                constants.show("RATES", [ratio, 1, n_cells], example_1(n_cells, ratio, True), ".10f")
    constants.finish()


if __name__ == "__main__":
    main()
