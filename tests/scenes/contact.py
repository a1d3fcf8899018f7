# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Faces of cracks that press on each other: at rest, in motion, on several processes.

    contact.py rest | motion | breaking | ranks | mistakes

Bounds that follow from no theory are at most 1.6 times the gap that was measured; the comment beside them says which.
"""

import sys

from fracture import history
from scene_test import Comparison, check, check_close, check_less, check_message, finish, run_scene

PRESSED, PIECES = "prm/fracture/pressed_crack.prm", "prm/fracture/struck_pieces.prm"
QUIET = {"Output/Fields": "none"}
MODELS = ("peridynamics", "coupled")


def force(run, model, side="top", component="y"):
    return history(run, f"force on {side} in {component}", model=model)[-1][1]
