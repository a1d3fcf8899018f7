# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""A scene of which maps are made, points of maps, and random numbers."""

import dataclasses
import json
import math
import os
from pathlib import Path
from typing import Dict, List, Optional, Sequence

import numpy as np

from ..program import arguments_of, require_success
from ..server import Server
from ..words import full_precision
from ..work_precision.lattice import to_text

ELEMENTS, BONDS, COUPLED = "finite elements", "peridynamics", "coupled"


@dataclasses.dataclass
class Point:
    """One point of a map.

    verdict: safe, fails; warned or refused where the program says so itself before it computes.
    """

    parameters: dict  # numbers and texts by name; None where one does not apply
    predicted: float  # infinite: no limit
    observed: float
    verdict: str

    @property
    def is_healthy(self) -> bool:
        return self.verdict == "safe"


class Random:
    """The same numbers everywhere: those of std::mt19937."""

    def __init__(self, seed: int):
        self._numbers = np.random.RandomState(seed)

    def next(self) -> int:
        """From 0 to 2^32 - 1."""
        return int.from_bytes(self._numbers.bytes(4), "little")

    def uniform(self, begin: float, end: float) -> float:
        return begin + (end - begin) * (self.next() / 4294967296.0)

    def any_of(self, values: Sequence):
        return values[self.next() % len(values)]


class Map:
    """One question, asked at many points. Base class."""

    name = ""
    predicted = ""  # what the two numbers of a point are, for readers
    observed = ""
    bound = ""  # where points are safe, in a sentence

    def __init__(self, scene: "MappedScene"):
        self.scene = scene
        self.left_out: List[str] = []  # what points() could not compute, and why

    def obstacle(self) -> str:
        """Why the scene has no such map; empty if it has."""
        raise NotImplementedError

    def points(self, quick: bool) -> List[Point]:
        """quick: few of them."""
        raise NotImplementedError

    def random_point(self, inside: bool, random: Random) -> Optional[Point]:
        """A point anywhere inside or outside of the safe region; None if there is no such place."""
        raise NotImplementedError


def coarse_cells(cells: Sequence[int], n_halvings: int) -> List[int]:
    """Cells of the same shape, as far as whole numbers allow, so many that a map is computed in minutes; odd counts stay odd, and those that
    are halved n_halvings times can be."""
    unit = 2 ** n_halvings
    most = {1: 60.0, 2: 450.0, 3: 512.0}[len(cells)]
    share = min(1.0, math.pow(most / math.prod(map(float, cells)), 1.0 / len(cells)))
    coarse = []
    for n in cells:
        least = min(n, 4 + n % 2)
        fewer = int(share * n)
        fewer += fewer % 2 != n % 2
        fewer = max(1, fewer // unit) * unit
        coarse.append(min(max(fewer, least), n))
    return coarse


class MappedScene:
    """A scene on a coarse lattice with the same m, and a running program that answers questions about it."""

    def __init__(self, server: Server, file: str, overrides: Sequence[str], output: str, temporary: str):
        """temporary: a folder. Raises Error for a scene that is wrong."""
        self.server, self.file, self.overrides, self.output = server, file, list(overrides), output
        self.facts = server.describe(file, overrides)
        self.bonds = self.facts["bonds"]
        self.dim = self.facts["dimension"]
        self.cells = self.facts["cells"] if self.facts["lattice"] else []
        self.coarse = coarse_cells(self.cells, self.facts["coarsening"]) if self.cells else []
        self._bare = os.path.join(temporary, "stability")  # a scene that overrides alone describe
        Path(self._bare).write_text(f"set Dimension = {self.dim}\n", encoding="utf-8")

    def ask(self, model: str, changes: Dict[str, str], question: dict) -> dict:
        """A question about a model of the scene with these changes, which are stronger than those of the coarse lattice. Raises Error for
        changes that the scene cannot have."""
        all_changes = {f"Output/{entry}": "" for entry in ("Write at", "Write every", "Probes", "Line", "Grid")}
        if self.cells:
            all_changes.update({"Domain/Node spacing": "", "Domain/Cells": to_text(self.coarse),
                                "Cracks/Nodes on cracks": "left"})  # these very cells
            if model != ELEMENTS:
                all_changes.update({"Peridynamics/Horizon": "", "Peridynamics/Horizon ratio": full_precision(self.bonds["m"])})
        return self._ask(self.file, [*arguments_of(self.overrides), *arguments_of(all_changes), *arguments_of({"Models": model}),
                                     *arguments_of(changes)], question)

    def ask_body(self, model: str, settings: Dict[str, str], question: dict) -> dict:
        """The same of a scene that these settings alone describe, of the dimension, and with the kernel and the nodes, of this one: a body for
        a question, in which nothing else differs from theory."""
        common = {"Physics": "elasticity" if self.facts["deforms"] else "heat", "Models": model,
                  "Domain/Nodes": self.facts["nodes"] if model == BONDS else "vertices"}
        if model != ELEMENTS:
            common.update({"Peridynamics/Kernel": self.bonds["kernel"], "Peridynamics/Kernel exponent": self.bonds["kernel exponent"]})
        if model != ELEMENTS and "Peridynamics/Horizon" not in settings:  # one of two entries
            common["Peridynamics/Horizon ratio"] = full_precision(self.bonds["m"])
        return self._ask(self._bare, [*arguments_of(common), *arguments_of(settings)], question)

    def _ask(self, file: str, arguments: List[str], question: dict) -> dict:
        return json.loads(require_success(self.server.call(["check", file, *arguments, "--ask", json.dumps(question)])).output)

    def no_diffusion_with(self, model: str) -> str:
        """Why diffusion in a model does not occur here; or empty."""
        if self.facts["deforms"]:
            return "it is of diffusion, and this scene is of elasticity"
        return "" if model in self.facts["models"] else f"'Models' has no {model}"
