# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Where a scene, on a lattice coarse enough to be computed a thousand times, is computed well and where not.

Each map varies what decides on that, and has for each point what the program says beforehand (predicted), what a computation finds (observed),
and a verdict: stability.csv and stability.json.
"""

from .driver import Options, run

__all__ = ["Options", "run"]
