# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Runs of PeriDeal in Python.

    import perideal

    plate = perideal.run("prm/quick_start.prm", {"Peridynamics/Horizon ratio": 4}, processes=2)
    plate.summary["models"]["peridynamics"]["bonds"]
    plate.probes["value"]                              # a column of probes.csv
    plate.field("temperature", "peridynamics")         # at the vertices, at the last time

    with perideal.Server() as server:                  # many runs for one start of the program
        for m in (2, 3, 4):
            server.run("prm/quick_start.prm", {"Peridynamics/Horizon ratio": m})

Needs numpy, and h5py for fields; see doc/python.md.
"""

from .program import Error, describe, find_program, run
from .results import Results, read, select
from .server import Server

__all__ = ["Error", "Results", "Server", "describe", "find_program", "read", "run", "select"]
