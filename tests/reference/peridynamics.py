# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Bond-based peridynamic heat conduction on lattices: family, weights, matrix, exponential.

    dT_i/dt = sum_j w_ij V_j (T_j - T_i),    w_ij = kappa c k(r) f(r)/r^n

with the kernel k, the volume fraction f and the prefactor c. Density and heat capacity are 1.
"""

from math import fsum, pi

import numpy as np
import scipy.sparse as sparse
from scipy.special import ive


def kernel(shape, r, horizon):
    """Shape k(r) of the micro-conductivity; only the conical one ends at the horizon by itself."""
    if shape == "constant":
        return np.ones_like(r)
    if shape == "conical":
        return np.maximum(0.0, 1 - r / horizon)
    if shape == "gaussian":
        return np.exp(-(2 * r / horizon) ** 2)
    raise ValueError(f"no kernel '{shape}'")


def analytic_prefactor(dim, shape, n, horizon):
    """Prefactor c for which the integral of c k/r^n x^2 over a full horizon is 2 (constant and conical kernel)."""
    # x^2 is r^2/dim in the mean over all directions; radial is the integral of r^(dim+1-n) k(r)
    # from 0 to the horizon.
    surface = {1: 2.0, 2: 2 * pi, 3: 4 * pi}[dim]
    radial = horizon ** (dim + 2 - n) / (dim + 2 - n)
    if shape == "conical":
        radial /= dim + 3 - n
    elif shape != "constant":
        raise ValueError(f"no closed form for the kernel '{shape}'")
    return 2 * dim / (surface * radial)


def volume_fraction(rule, r, horizon, spacing):
    """Share of a neighbour's volume that counts: a ramp one spacing wide about the horizon, or all of it up to the horizon."""
    if rule == "linear":
        share = np.clip((horizon + spacing / 2 - r) / spacing, 0, 1)
        return np.where(share < 1e-9, 0, share)
    return np.where(r <= horizon * (1 + 1e-9), 1.0, 0.0)


def shifted_distance(r, share, horizon, spacing):
    """Distance to the middle of the part that counts (in one dimension), where the conical kernel is evaluated."""
    partial = np.where(r <= horizon * (1 + 1e-12), r - (1 - share) * spacing / 2, horizon - share * spacing / 2)
    return np.where(r < horizon - spacing / 2, r, partial)


class Family:
    """Full family of a node on a lattice of square cells: offsets (in spacings), distances r and weights w_ij.

    fraction: linear or none. calibration: discrete (the sum of w x^2 over the family is 2 kappa) or analytic (the integral is).
    """

    def __init__(self, dim, ratio, spacing, shape="conical", n=2, fraction="linear", calibration="discrete", conductivity=1.0):
        self.horizon, self.spacing, self.shape, self.n = ratio * spacing, spacing, shape, n
        reach = int(np.ceil(ratio + 0.5)) + 1
        axis = np.arange(-reach, reach + 1)
        offsets = np.stack(np.meshgrid(*[axis] * dim, indexing="ij"), axis=-1).reshape(-1, dim)
        r = spacing * np.sqrt((offsets ** 2).sum(axis=1))
        share = volume_fraction(fraction, r, self.horizon, spacing)
        near = (r > 0) & (share > 0)
        self.offsets, self.r, share = offsets[near], r[near], share[near]
        shift = shape == "conical" and fraction == "linear"
        at = shifted_distance(self.r, share, self.horizon, spacing) if shift else self.r
        weights = kernel(shape, at, self.horizon) * share / self.r ** n
        if calibration == "discrete":
            prefactor = 2 / fsum(weights * (self.offsets[:, 0] * spacing) ** 2 * spacing ** dim)
        else:
            prefactor = analytic_prefactor(dim, shape, n, self.horizon)
        self.prefactor = conductivity * prefactor
        self.weights = self.prefactor * weights
        some = self.weights > 0
        self.offsets, self.r, self.weights = self.offsets[some], self.r[some], self.weights[some]

    def touching(self):
        """Offsets and distances of the touching neighbours, diagonal ones included."""
        touch = abs(self.offsets).max(axis=1) == 1
        return self.offsets[touch], self.r[touch]


def pairs(counts, offset):
    """Numbers of all nodes i with a neighbour at this offset, and of those neighbours j. The last axis runs fastest."""
    numbers = np.arange(np.prod(counts), dtype=np.int32).reshape(counts)
    here = tuple(slice(max(0, -o), max(0, n - max(0, o))) for o, n in zip(offset, counts))
    there = tuple(slice(max(0, o), max(0, n - max(0, -o))) for o, n in zip(offset, counts))
    return numbers[here].ravel(), numbers[there].ravel()


def bond_matrix(counts, offsets, weights, volumes, own_volume=False, is_cut=None):
    """Sparse matrix of w_ij V_j (or w_ij V_i) over all bonds of a box of nodes, without those for which is_cut(i, offset) holds."""
    rows, columns, values = [], [], []
    for offset, weight in zip(offsets, weights):
        i, j = pairs(counts, offset)
        if is_cut is not None:
            intact = ~is_cut(i, offset)
            i, j = i[intact], j[intact]
        rows.append(i)
        columns.append(j)
        values.append(weight * volumes[i if own_volume else j])
    entries = np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))
    return sparse.csr_matrix(entries, shape=(len(volumes), len(volumes)))


def rate_matrix(bonds):
    """Matrix A with dT/dt = A T: the bonds, and minus their sum on the diagonal."""
    return (bonds - sparse.diags(np.asarray(bonds.sum(axis=1)).ravel())).tocsr()


def eigenvalue_bound(rates):
    """The eigenvalues of A lie between minus this and 0 (Gershgorin)."""
    return 2 * abs(rates.diagonal()).max()


def exponential(apply, start, times, bound):
    """exp(t A) start at these times by Chebyshev polynomials; apply(v) is A v, the eigenvalues of A lie in [-bound, 0].

    With B = 1 + 2 A/bound, z = t bound/2 and modified Bessel functions I_k:
    exp(t A) = exp(-z) (I_0(z) + 2 sum_k I_k(z) T_k(B)). The terms left out are below round-off.
    """
    z = 0.5 * bound * np.asarray(times)
    n_terms = int(np.sqrt(100 * z.max())) + 40
    factors = ive(np.arange(n_terms)[:, np.newaxis], z)
    factors[1:] *= 2
    before, now = start, start + apply(start) * (2 / bound)
    sums = [factor * before for factor in factors[0]]
    for row in factors[1:]:
        for one, factor in zip(sums, row):
            one += factor * now
        before, now = now, 2 * (now + apply(now) * (2 / bound)) - before
    return sums
