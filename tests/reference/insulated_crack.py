# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Example 3 of Bobaru and Duangpanya, J. Comput. Phys. 231 (2012): the constants of tests/scenes/insulated_crack.py.

A square plate from -1 to 1, 100 on top and -100 below, initially 0, with an insulated crack from (-0.5, 0) to (0.5, 0).
The numbers of cells a side are multiples of 4, so that the crack runs through a row of nodes from one node to another.
Finite elements: bilinear squares, doubled vertices within the crack, lumped capacity. Peridynamics: default settings, m = 3;
nodes on the crack belong to its left (upper) side, and bonds that pass through it or through its very tips are cut.
"""

import numpy as np
import scipy.sparse as sparse
from scipy.sparse.linalg import splu

from constants import Constants
from peridynamics import Family, bond_matrix, eigenvalue_bound, exponential, rate_matrix

KAPPA = 1.14
TIME = 0.5
PROBES = ((0, 0.1), (0, -0.1), (0.25, 0.05), (0.6, 0), (0.5, 0.2))
COUNTS = (60, 120, 240)
FINEST = 480


def at_probes(temperatures, n_cells):
    """Bilinear interpolation between the vertices; numbers beyond theirs are not looked at."""
    values = temperatures[:(n_cells + 1) ** 2].reshape(n_cells + 1, n_cells + 1)
    found = []
    for point in PROBES:
        column, row = [(x + 1) * n_cells / 2 for x in point]
        i, j = [min(int(np.floor(s + 1e-9)), n_cells - 1) for s in (column, row)]
        a, b = column - i, row - j
        found.append((1 - b) * ((1 - a) * values[j, i] + a * values[j, i + 1]) + b * ((1 - a) * values[j + 1, i] + a * values[j + 1, i + 1]))
    return found


def steady_and_transient(rates, is_top, is_bottom):
    """Steady temperatures, and those at the end of the transient, of dT/dt = A T with the top at 100 and the bottom at -100."""
    steady = 100.0 * is_top - 100.0 * is_bottom
    free = np.flatnonzero(~(is_top | is_bottom))
    reduced = rates[free][:, free]
    load = rates[free] @ steady
    steady[free] = splu(reduced.tocsc(), permc_spec="MMD_AT_PLUS_A").solve(-load)
    transient = steady.copy()
    transient[free] += exponential(reduced.dot, -steady[free], [TIME], eigenvalue_bound(rates))[0]
    return steady, transient


def is_cut_by_crack(n_cells):
    """The rule for bonds from nodes i at an offset (row, column): one end above or on the crack's line, the other below."""
    def is_cut(i, offset):
        rows, columns = offset
        y, x = i // (n_cells + 1) - n_cells // 2, i % (n_cells + 1) - n_cells // 2
        # The bond meets the line at x - y columns/rows; all numbers are integers, and a tip is met
        # exactly or not at all.
        is_across = (y >= 0) != (y + rows >= 0)
        return is_across & (abs(x * rows - y * columns) <= n_cells // 4 * abs(rows))
    return is_cut


def peridynamics(n_cells):
    """Steady and transient temperatures at the probes, heat through the top, number of bonds."""
    family = Family(2, 3, 2 / n_cells, conductivity=KAPPA)
    counts = (n_cells + 1, n_cells + 1)
    widths = np.full(n_cells + 1, family.spacing)
    widths[[0, -1]] /= 2
    volumes = np.outer(widths, widths).ravel()
    bonds = bond_matrix(counts, family.offsets, family.weights, volumes, is_cut=is_cut_by_crack(n_cells))
    rates = rate_matrix(bonds)
    row = np.arange(len(volumes)) // (n_cells + 1)
    steady, transient = steady_and_transient(rates, row == n_cells, row == 0)
    heat = -(volumes * (rates @ steady))[row == n_cells].sum()
    return at_probes(steady, n_cells), at_probes(transient, n_cells), heat, bonds.nnz // 2


def split_elements(n_cells):
    """The four vertices of all elements, row by row, and the row of each vertex; those below the crack have vertices of their own."""
    n, middle, half = n_cells + 1, n_cells // 2, n_cells // 4
    column, row = (index.ravel() for index in np.meshgrid(np.arange(n_cells), np.arange(n_cells)))
    lower_left = row * n + column
    elements = np.stack([lower_left, lower_left + 1, lower_left + n, lower_left + n + 1], axis=1)
    inside = middle * n + np.arange(middle - half + 1, middle + half)
    copy = np.arange(n * n)
    copy[inside] = n * n + np.arange(len(inside))
    below = row == middle - 1
    elements[below] = copy[elements[below]]
    return elements, np.concatenate([np.arange(n * n) // n, np.full(len(inside), middle)])


def finite_elements(n_cells):
    """Steady and transient temperatures at the probes, heat through the top."""
    elements, row = split_elements(n_cells)
    conductance = KAPPA / 6 * np.array([[4, -1, -1, -2], [-1, 4, -2, -1], [-1, -2, 4, -1], [-2, -1, -1, 4]])
    entries = np.tile(conductance.ravel(), len(elements)), (np.repeat(elements, 4, axis=1).ravel(), np.tile(elements, (1, 4)).ravel())
    stiffness = sparse.csr_matrix(entries, shape=(len(row), len(row)))
    capacity = np.bincount(elements.ravel()) / n_cells ** 2
    rates = (sparse.diags(-1 / capacity) @ stiffness).tocsr()
    steady, transient = steady_and_transient(rates, row == n_cells, row == 0)
    heat = (stiffness @ steady)[row == n_cells].sum()
    return at_probes(steady, n_cells), at_probes(transient, n_cells), heat


def extrapolated(coarse, middle, fine):
    """The limit of values whose errors have parts of first and second order in the spacing, which is halved twice."""
    coarse, middle, fine = (np.asarray(values) for values in (coarse, middle, fine))
    return (4 * (2 * fine - middle) - (2 * middle - coarse)) / 3


def show_peridynamics(constants, n_cells):
    steady, transient, heat, n_bonds = peridynamics(n_cells)
    constants.show("PD_STEADY", [n_cells], steady, ".10f")
    constants.show("PD_HALF", [n_cells], transient, ".10f")
    constants.show("PD_FLUX", [n_cells], heat, ".8f")
    constants.show("PD_BONDS", [n_cells], n_bonds, "d")


def show_finite_elements(constants, counts):
    found = []
    for n_cells in counts:
        found.append(finite_elements(n_cells))
        if n_cells != FINEST:
            constants.show("FEM_STEADY", [n_cells], found[-1][0], ".10f")
            constants.show("FEM_HALF", [n_cells], found[-1][1], ".10f")
    if FINEST in counts:
        for name, values in zip(("STEADY", "HALF_SECOND", "FLUX"), zip(*found[-3:])):
            constants.show(name, [], extrapolated(*values), ".4f")


def main():
    constants = Constants("insulated_crack", __doc__)
    for n_cells in COUNTS:
        if constants.wanted(n_cells):
            show_peridynamics(constants, n_cells)
    show_finite_elements(constants, [n for n in COUNTS + (FINEST,) if constants.wanted(n)])
    constants.finish()


if __name__ == "__main__":
    main()
