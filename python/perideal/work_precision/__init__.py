# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Accuracy against cost of a scene by many methods on several lattices.

Rows of a study, which the program computes, and for each what it costs and how wrong it is: work_precision.csv and work_precision.json beside
the files of the study. What `Models = auto` chooses for errors of 3e-2, 1e-2 and 1e-3 is compared in the same way; of what changes in time
one method is computed with all steppers, too.

The error is that of the nodal values, against `Reference/Solution` or, without one, against finite elements, with cracks on cell faces, on
three fine lattices, extrapolated. Cost is the number of nonzeros that are applied times the number of applications of the operator. Of bodies
with cracks the openings of the cracks or the stress intensities may be measured instead.
"""

from .driver import Options, run

__all__ = ["Options", "run"]
