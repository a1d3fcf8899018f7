# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""The three bars of Bobaru and Duangpanya, Int. J. Heat Mass Transfer 53 (2010): the constants of tests/scenes/bobaru_2010.py.

Nodes are cell centres; the outermost one of a heated or cooled end has the given temperature, an insulated end needs nothing.
The prefactor is that of the integral. Neighbours at r = horizon count half with the constant kernel and nothing with the conical one.
"""

from math import pi

import numpy as np
import scipy.sparse as sparse
from scipy.sparse.linalg import spsolve

from constants import Constants
from peridynamics import Family, bond_matrix, eigenvalue_bound, exponential, rate_matrix

KAPPA = 1.14
TIME = 8.0
RATIOS = (2, 4, 8, 16)
FINENESS = (200, 400, 800)
KERNELS = ("constant", "conical")
LENGTH = {1: 10.0, 2: 10.0, 3: pi}
IS_FIXED = {1: (True, True), 2: (False, True), 3: (True, False)}
END_VALUE = {1: 0.0, 2: 100.0, 3: 20.0}
FLUX_SLOPE = 3.0
# Relative gap between two programs: sums of a row are 0 to 1e-16 of its diagonal only, and that
# acts over 10^6 of its time constants.
ROUND_OFF = {1: 1e-9, 2: 5e-8}


def initial(example, x):
    """Initial temperature; a node on the jump of Example 2 starts from the mean."""
    if example == 1:
        return np.full(len(x), 100.0)
    if example == 2:
        return 30.0 - 30.0 * np.where(abs(x - 5) < 1e-9, 0, np.sign(x - 5))
    return np.zeros(len(x))


def classical(example, x, t=TIME):
    """Temperature of classical heat conduction: Fourier series (equations 33 and 38; Example 3 by the same separation)."""
    length, k = LENGTH[example], np.arange(1, 401)
    q = (2 * k - 1) * pi / length if example == 1 else (k - 0.5) * pi / length
    if example == 1:
        base, factors, waves = 0.0, 400 / (2 * k - 1) / pi, np.sin(np.outer(x, q))
    elif example == 2:
        middle, end = np.sin(q * length / 2), np.sin(q * length)
        base, factors, waves = 100.0, 2 / (q * length) * (-40 * middle - 100 * (end - middle)), np.cos(np.outer(x, q))
    else:
        base, waves = 20 + FLUX_SLOPE * x, np.sin(np.outer(x, q))
        factors = -2 / length * (20 / q + FLUX_SLOPE * np.sin(q * length) / q ** 2)
    return base + waves @ (factors * np.exp(-KAPPA * q ** 2 * t))


def self_term(n_cells, family, shape):
    """What stands for the node itself: the mean of its neighbours' terms, or the term of the only neighbour that is there.

    The conical kernel is taken at r = 0, the constant one at the neighbour.
    """
    offsets, r = family.touching()
    bonds = bond_matrix((n_cells,), offsets, family.prefactor / r ** 2, np.full(n_cells, family.spacing))
    n_neighbors = np.diff(bonds.indptr)
    return sparse.diags(1 / n_neighbors) @ bonds


def bar_rates(n_cells, ratio, shape, length):
    """Matrix A of the whole bar."""
    fraction = "linear" if shape == "constant" else "none"
    family = Family(1, ratio, length / n_cells, shape, fraction=fraction, calibration="analytic", conductivity=KAPPA)
    bonds = bond_matrix((n_cells,), family.offsets, family.weights, np.full(n_cells, family.spacing))
    return rate_matrix(bonds + self_term(n_cells, family, shape))


def dependence(example, n_cells, ratio, spacing):
    """Free nodes, and the matrix P and vector g of T = P u + g for all nodes; T is counted from the value of the fixed ends.

    In Example 3 the nodes of the horizon layer beside the right end lie on a line of the given slope (equation 22).
    """
    left, right = IS_FIXED[example]
    first, last = (1 if left else 0), n_cells - (1 if right else ratio)
    nodes, given = np.arange(n_cells), np.zeros(n_cells)
    master = nodes
    if not right:
        master = np.minimum(nodes, last - 1)
        given = FLUX_SLOPE * spacing * (nodes - master)
    rows = np.flatnonzero((master >= first) & (master < last))
    entries = np.ones(len(rows)), (rows, master[rows] - first)
    return nodes[first:last], sparse.csr_matrix(entries, shape=(n_cells, last - first)), given


def temperatures(example, n_cells, ratio, shape):
    """Nodes and their temperatures at the end: the steady state, and what the exponential leaves of the difference to it."""
    spacing = LENGTH[example] / n_cells
    x = (np.arange(n_cells) + 0.5) * spacing
    rates = bar_rates(n_cells, ratio, shape, LENGTH[example])
    free, prolongation, given = dependence(example, n_cells, ratio, spacing)
    reduced = (rates[free] @ prolongation).tocsr()
    steady = spsolve(reduced.tocsc(), -rates[free] @ given)
    start = initial(example, x[free]) - END_VALUE[example] - steady
    end = steady + exponential(reduced.dot, start, [TIME], eigenvalue_bound(rates))[0]
    return x, END_VALUE[example] + prolongation @ end + given


def average_difference(example, x, found):
    """1/N times the 2-norm of the relative differences: what the published rates are of."""
    return np.linalg.norm(found / classical(example, x) - 1) / len(x)


def main():
    constants = Constants("bobaru_2010", __doc__)
    for example in (1, 2):
        constants.show("MIDDLE", [example], classical(example, np.array([5.0])), ".3f")
        for shape in KERNELS:
            for ratio in RATIOS:
                counts = [round(ratio * fineness / 3) for fineness in FINENESS]
                if constants.wanted(*counts):
                    ends = [temperatures(example, n, ratio, shape) for n in counts]
                    differences = [average_difference(example, *end) for end in ends]
                    constants.show("PROGRAM", [(example, shape, ratio), 0], differences, ".10e",
                                   relative=ROUND_OFF[example])
                    constants.show("PROGRAM", [(example, shape, ratio), 1], [end[1][len(end[1]) // 2] for end in ends], ".6f")
    n_cells = round(4 * FINENESS[-1] / 3)
    for shape in KERNELS:
        if constants.wanted(n_cells):
            constants.show("FLUX", [shape, 1], average_difference(3, *temperatures(3, n_cells, 4, shape)), ".1e")
    constants.finish()


if __name__ == "__main__":
    main()
