# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Rates of decay of products of sines on a lattice: the constants of tests/scenes/harmonics.py.

On an unbounded lattice every wave keeps its shape and decays with sum_j w_ij V_j (1 - cos(q.x_ij)). Fictitious layers that
mirror about T = 0 continue a product of sines to such a lattice.
"""

from math import fsum, pi, sin

from constants import Constants
from peridynamics import Family

CELLS = 20
LATTICES = ((1, 4), (2, 3), (2, 6.5), (3, 3))


def rate(dim, ratio, shape, n):
    """Rate of the product of sines with one half wave on a side of length 1; kappa = 1, discrete calibration."""
    # Lengths are counted in spacings. A product of sines is a sum of waves (1, 1), (1, -1), ...,
    # with the same rate each.
    family = Family(dim, ratio, 1.0, shape, n)
    phases = pi / CELLS * family.offsets.sum(axis=1)
    return CELLS ** 2 * fsum(w * 2 * sin(phase / 2) ** 2 for w, phase in zip(family.weights, phases))


def main():
    constants = Constants("harmonics", __doc__)
    for dim, ratio in LATTICES:
        for shape in ("constant", "conical", "gaussian"):
            constants.show("RATES", [(dim, ratio, shape)], [rate(dim, ratio, shape, n) for n in (0, 1, 2)], ".15g")
    constants.finish()


if __name__ == "__main__":
    main()
