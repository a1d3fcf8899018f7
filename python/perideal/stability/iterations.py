# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""The map of iterations: steady states and equilibria that are hard to find."""

import dataclasses
import math
from typing import Dict, List

from ..drivers import mistake_in
from ..program import Error
from ..words import full_precision
from ..work_precision.lattice import to_text
from .scene import COUPLED, ELEMENTS, Map, Point, Random

DIRECT = 50  # unknowns of the coarsest level, of 1000: multigrid has levels


@dataclasses.dataclass
class Body:
    """A body that is hard to solve for."""

    model: str
    contrast: float = 1.0
    poisson: float = 0.3
    aspect: float = 1.0
    n_cracks: int = 0


class IterationsMap(Map):
    """Contrasts, cracks, slender cells, bodies that are nearly incompressible."""

    name = "iterations"
    predicted = "the most iterations that a run allows ('Maximum iterations' by default): beyond, it ends with an error"
    observed = "the iterations to a relative residual of 1e-10, without a direct solution; infinite if they do not suffice"
    bound = ("'safe' where the iterations converge within those allowed, else the run ends with an error; random points are chosen inside by what "
             "the map has found: cells up to 10 times (diffusion: 100 times) as long as wide, Poisson ratios up to 0.498")

    def obstacle(self):
        return "it is of bodies in two and three dimensions" if self.scene.dim == 1 else ""

    @property
    def _deforms(self) -> bool:
        return self.scene.facts["deforms"]

    def points(self, quick):
        return [self._point(body) for model in self.scene.facts["models"]
                for body in (self._bodies(model, quick) if self._deforms else self._plates(model, quick))]

    def random_point(self, inside, random: Random):
        # Where iterations suffice was found by this map: the program has no bound of its own.
        slim, flat = 10.0, 100.0
        body = Body(random.any_of(self.scene.facts["models"]))
        can_fail = self._deforms or body.model == ELEMENTS
        body.aspect = math.pow(min(self._largest_aspect(body.model), slim if self._deforms else flat), random.uniform(0.0, 1.0))
        if self._deforms:
            body.poisson = 0.5 - 0.3 * math.pow(10.0, random.uniform(-2.4, 0.0))
        else:
            body.contrast = math.pow(10.0, random.uniform(0.0, 8.0))
            body.n_cracks = random.next() % 5 if self.scene.dim == 2 else 0
        if inside:
            return self._point(body)
        if not can_fail or self.scene.dim == 3:  # 10 cells in a direction are few
            return None
        body.contrast = max(body.contrast, 100.0)
        if body.model == ELEMENTS:
            body.aspect = flat * random.uniform(1.0 if self._deforms else 20.0, 40.0)
        else:
            body.poisson = 0.5 - 1e-5 * random.uniform(1.0, 10.0)
        return self._point(body)

    def _largest_aspect(self, model: str) -> float:
        """Horizons cannot be shorter than the longest edge of a cell."""
        return 100.0 if model == ELEMENTS else max(1.0, self.scene.bonds["m"] - 1.0)

    def _aspects(self, model: str, quick: bool) -> List[float]:
        largest = self._largest_aspect(model)
        return [1.0, largest] if quick else [1.0, math.sqrt(largest), largest]

    def _plates(self, model: str, quick: bool) -> List[Body]:
        return [Body(model, contrast, 0.3, aspect, n_cracks) for contrast in ((1.0, 1e8) if quick else (1.0, 1e2, 1e4, 1e6, 1e8))
                for n_cracks in ((0, 4) if self.scene.dim == 2 else (0,)) for aspect in self._aspects(model, quick)]

    def _bodies(self, model: str, quick: bool) -> List[Body]:
        return [Body(model, 1.0, poisson, aspect)
                for poisson in ((0.2, 0.4999) if quick else (0.0, 0.2, 0.3, 0.4, 0.45, 0.49, 0.499, 0.4999))
                for aspect in self._aspects(model, quick)]

    def _settings(self, body: Body) -> Dict[str, str]:
        dim = self.scene.dim
        n = 10 if dim == 3 else 32
        settings = {"Domain/Lower corner": to_text([0] * dim), "Domain/Cells": to_text([n] * dim),
                    "Domain/Upper corner": ", ".join([full_precision(body.aspect)] + ["1"] * (dim - 1))}
        if body.model != ELEMENTS:
            settings["Peridynamics/Horizon ratio"] = full_precision(self.scene.bonds["m"])
        if body.model == COUPLED:
            settings["Coupling/Zone"] = "0.3 - abs(y - 0.5)"
        if self._deforms:
            return {**settings, "Material/Young modulus": "1", "Material/Poisson ratio": full_precision(body.poisson), "Elasticity/Plane": "strain",
                    "Boundary conditions/Displacement": f"left: {', '.join(['0'] * dim)}; right: 1e-3{', free' * (dim - 1)}"}
        settings.update({
            "Boundary conditions/Dirichlet": "left: 1; right: 0", "Time/Steady": "true",
            "Material/Conductivity": f"if(sin(9*x/{full_precision(body.aspect)})*sin(9*y) > 0, 1, {full_precision(body.contrast)})"})
        cracks = []
        for k in range(body.n_cracks):
            x, y = body.aspect * (0.21 + 0.19 * k), 0.23 + 0.17 * (2 * k % 4)
            cracks.append(f"{full_precision(x)}, {full_precision(y)} ; {full_precision(x + 0.11 * body.aspect)}, {full_precision(y + 0.21)}")
        if cracks:
            settings["Cracks/Segments"] = " ; ".join(cracks)
        return settings

    def _point(self, body: Body) -> Point:
        parameters = {"model": body.model, "aspect ratio": body.aspect}
        parameters.update({"Poisson ratio": body.poisson} if self._deforms else {"contrast": body.contrast, "cracks": body.n_cracks})
        try:
            answer = self.scene.ask_body(body.model, self._settings(body), {"ask": "iterations", "direct up to": DIRECT})
        except Error as error:  # the coupling is refused, for instance
            return Point({**parameters, "fault": mistake_in(error)}, math.nan, math.inf, "refused")
        if "fault" in answer:
            return Point({**parameters, "fault": answer["fault"]}, float(answer["allowed"]), math.inf, "fails")
        return Point(parameters, float(answer["allowed"]), float(answer["iterations"]), "safe")
