# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Maps of heat through a strip of bonds: what complete families conduct, and what is missing at free sides."""

import dataclasses
import math
from typing import Dict, List

from ..drivers import mistake_in
from ..program import Error
from ..words import full_precision
from ..work_precision.lattice import to_text
from .scene import BONDS, Map, MappedScene, Point, Random

TOLERABLE = 5e-3  # of the heat; beyond, a run says so in a note
KERNELS, FRACTIONS, CALIBRATIONS, EXPONENTS = ["constant", "conical", "gaussian"], ["none", "linear", "exact"], ["discrete", "analytic"], [0, 1, 2]


@dataclasses.dataclass
class Lattice:
    """Bonds of a lattice of unit spacing."""

    kernel: str
    fraction: str
    calibration: str
    exponent: int
    ratio: float

    def settings(self) -> Dict[str, str]:
        return {"Peridynamics/Kernel": self.kernel, "Peridynamics/Kernel exponent": self.exponent,
                "Peridynamics/Horizon ratio": full_precision(self.ratio), "Peridynamics/Volume fraction": self.fraction,
                "Peridynamics/Calibration": self.calibration}

    def predicted(self, scene: MappedScene) -> dict:
        """What families conduct by their sums, and what they lack at a side."""
        return scene.ask_body(BONDS, {**self.settings(), **_box([100] * scene.dim)}, {"ask": "families", "m": [self.ratio]})["answers"][0]


def _box(cells: List[int]) -> Dict[str, str]:
    """Of unit cells."""
    return {"Domain/Lower corner": to_text([0] * len(cells)), "Domain/Upper corner": to_text(cells), "Domain/Cells": to_text(cells),
            "Boundary conditions/Dirichlet": "left: 1; right: 0", "Time/Steady": "true"}


def conduction_error(scene: MappedScene, bonds: Lattice, cells: List[int], more: Dict[str, str]) -> float:
    """Heat through a strip of unit cells from its left end at 1 to its right end at 0, over what it should be, minus one."""
    heat = float(scene.ask_body(BONDS, {**bonds.settings(), **_box(cells), **more}, {"ask": "flow", "side": "left"})["flow"])
    return heat * cells[0] / math.prod(map(float, cells[1:])) - 1.0


def lies(error: float, inside: bool, bound: float) -> bool:
    """Of a random point, away from the bound by a tenth of it, on which nothing can be told."""
    return error < 0.9 * bound if inside else error > 1.1 * bound


class ConductionMap(Map):
    """The strip as wide as families between mirrors: what bonds conduct of a linear field."""

    name = "error"
    predicted = "by how much complete families conduct too much (or too little), from their sum"
    observed = "by how much more heat than it should flows through a strip between mirrors"
    bound = "'safe' where the heat is right to 0.5 %; beyond, a run says so in a note ('warned')"

    def obstacle(self):
        return self.scene.no_diffusion_with(BONDS)

    def points(self, quick):
        ratios = [2.0, 2.5, 3.0] if self.scene.dim == 3 else [2.0, 3.0, 6.0] if quick else [2.0, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0]
        kernels = [self.scene.bonds["kernel"]] if quick else KERNELS
        exponents = [self.scene.bonds["kernel exponent"]] if quick else EXPONENTS
        points = []
        for bonds in (Lattice(kernel, fraction, calibration, exponent, ratio) for calibration in CALIBRATIONS for fraction in FRACTIONS
                      for kernel in kernels for exponent in exponents for ratio in ratios):
            try:
                points.append(self._point(bonds))
            except Error as error:
                self.left_out.append(mistake_in(error))
        return points

    def random_point(self, inside, random: Random):
        largest = 3.0 if self.scene.dim == 3 else 6.0
        for _ in range(1000):
            bonds = Lattice(*map(random.any_of, (KERNELS, FRACTIONS, CALIBRATIONS, EXPONENTS)), random.uniform(1.6, largest))
            if lies(abs(self._predicted(bonds)), inside, TOLERABLE):
                return self._point(bonds)
        return None

    def _predicted(self, bonds: Lattice) -> float:
        return float(bonds.predicted(self.scene)["effective conductivity"]) - 1.0

    def _point(self, bonds: Lattice) -> Point:
        dim = self.scene.dim
        predicted = self._predicted(bonds)
        more = {"Peridynamics/Boundary treatment": "fictitious mirror"}
        if dim > 1:
            more["Boundary conditions/Symmetry"] = "bottom, top" if dim == 2 else "bottom, top, back, front"
        observed = conduction_error(self.scene, bonds, [8 if dim == 3 else 12] + [8] * (dim - 1), more)
        verdict = "safe" if abs(observed) <= TOLERABLE else "warned" if abs(predicted) > TOLERABLE else "fails"
        return Point({"m": bonds.ratio, "kernel": bonds.kernel, "kernel exponent": bonds.exponent, "volume fraction": bonds.fraction,
                      "calibration": bonds.calibration}, predicted, observed, verdict)


@dataclasses.dataclass
class Treatment:
    """Of free sides."""

    name: str
    cuts: bool  # families there, and nothing makes up for it
    settings: Dict[str, str]


_ENTRY = "Peridynamics/Boundary treatment"
TREATMENTS = [Treatment("fictitious mirror", True, {_ENTRY: "fictitious mirror"}),
              Treatment("fictitious mirror, symmetry", False, {_ENTRY: "fictitious mirror", "Boundary conditions/Symmetry": "bottom, top"}),
              Treatment("fictitious mirror, energy", False, {_ENTRY: "fictitious mirror", "Peridynamics/Surface correction": "energy"}),
              Treatment("exchange", False, {_ENTRY: "exchange", "Domain/Nodes": "vertices"})]


class SurfaceMap(Map):
    """The strip with free sides: what is missing there."""

    name = "surface error"
    predicted = ("the share of the width of a strip that its free sides seem to lack, from the families cut there; 0 for treatments that cut "
                 "none")
    observed = "the share of the heat through the strip that is missing (or too much), either sign"
    bound = "'safe' where the heat is right to 0.5 %; beyond, a run says so in a note ('warned')"

    def obstacle(self):
        return "it is of plane bodies" if self.scene.dim != 2 else self.scene.no_diffusion_with(BONDS)

    def points(self, quick):
        points = []
        for treatment in TREATMENTS:
            for width in (20, 200) if quick else (10, 20, 50, 100, 200, 400):
                for ratio in (2.0, 4.0) if quick else (2.0, 2.5, 3.0, 4.0, 5.0, 6.0):
                    try:
                        points.append(self._point(treatment, self._bonds(ratio), width))
                    except Error as error:
                        self.left_out.append(f"{treatment.name}, m = {ratio}: {mistake_in(error)}")
        return points

    def random_point(self, inside, random: Random):
        for _ in range(1000):
            treatment = random.any_of(TREATMENTS)
            bonds = self._bonds(random.uniform(1.6, 5.0))
            width = int(math.exp(random.uniform(math.log(8.0), math.log(400.0))))
            if lies(self._predicted(treatment, bonds, width), inside, TOLERABLE):
                return self._point(treatment, bonds, width)
        return None

    def _bonds(self, ratio: float) -> Lattice:
        bonds = self.scene.bonds
        return Lattice(bonds["kernel"], bonds["volume fraction"], bonds["calibration"], bonds["kernel exponent"], ratio)

    def _predicted(self, treatment: Treatment, bonds: Lattice, width: int) -> float:
        return 2.0 * float(bonds.predicted(self.scene)["missing width"]) / width if treatment.cuts else 0.0

    def _point(self, treatment: Treatment, bonds: Lattice, width: int) -> Point:
        predicted = self._predicted(treatment, bonds, width)
        observed = abs(conduction_error(self.scene, bonds, [12, width], treatment.settings))
        verdict = "safe" if observed <= TOLERABLE else "warned" if predicted > TOLERABLE else "fails"
        return Point({"treatment": treatment.name, "m": bonds.ratio, "cells across": width}, predicted, observed, verdict)
