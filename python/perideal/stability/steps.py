# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Maps of the steps of explicit methods: the longest stable one, and growth beyond it."""

import dataclasses
from typing import List, Optional

from ..drivers import mistake_in
from ..program import Error
from ..words import full_precision
from .scene import ELEMENTS, Map, Point, Random

KERNELS = ["constant", "conical", "gaussian"]
NEVER, MAY, BROKEN = "never break", "may break", "some broken"  # what may happen to bonds in a motion


@dataclasses.dataclass
class Method:
    """An explicit method with fixed steps."""

    name: str
    stages: int = 0  # of rkc2; 0: as many as a step needs


@dataclasses.dataclass
class Body:
    """What steps depend on, but for their length and the method."""

    model: str
    kernel: str
    exponent: int
    ratio: float
    bonds: str  # of motions; empty elsewhere

    @property
    def has_bonds(self) -> bool:
        return self.model != ELEMENTS

    def text(self) -> str:
        """For readers."""
        return (self.model + (f", kernel {self.kernel}, m = {self.ratio}" if self.has_bonds else "") +
                (f", bonds {self.bonds}" if self.bonds else ""))

    def parameters(self, method: Method) -> dict:
        """Of a point."""
        has = self.has_bonds
        return {"model": self.model, "method": method.name, "stages": method.stages or None, "kernel": self.kernel if has else None,
                "kernel exponent": self.exponent if has else None, "m": self.ratio if has else None, "bonds": self.bonds or None}


class StepMap(Map):
    """Base of the maps of steps."""

    def obstacle(self):
        facts = self.scene.facts
        if facts["deforms"] and not facts["moves"]:
            return "the body is in equilibrium ('Solver' in section 'Elasticity'): there are no steps"
        if facts["steady"]:
            return "'Steady' in section 'Time' is true: there are no steps"
        if facts["depends on the solution"]:
            return "the material depends on the temperature, and with it the limit of each step"
        if not facts["lumped"]:
            return "'Capacity = consistent' in section 'Finite elements' has no explicit steps"
        return ""

    def bodies(self, kernels: List[str], ratios: List[float]) -> List[Body]:
        """Of the scene's models with the kernels and m of a map."""
        exponent = self.scene.bonds["kernel exponent"]
        return [Body(model, kernel, exponent, ratio, bonds) for model in self.scene.facts["models"] for bonds in self.fates(model)
                for kernel, ratio in ([(self.scene.bonds["kernel"], 0.0)] if model == ELEMENTS else
                                      [(kernel, ratio) for kernel in kernels for ratio in ratios])]

    def methods(self, quick: bool, with_chebyshev: bool) -> List[Method]:
        """chebyshev has no limit, and is not for every operator."""
        if self.scene.facts["moves"]:
            return [Method("verlet")]
        methods = []
        for name in self.scene.facts["explicit steppers"]:
            if name == "rkc2":
                methods += [Method(name, stages) for stages in ((5,) if quick else (2, 3, 5, 10))]
            elif with_chebyshev or name != "chebyshev":
                methods.append(Method(name))
        return methods

    def fates(self, model: str) -> List[str]:
        """What may happen to the bonds of a model."""
        if not self.scene.facts["moves"]:
            return [""]
        if model == ELEMENTS:
            return [NEVER]
        return [NEVER, MAY, BROKEN] if self.scene.bonds["break"] else [NEVER, BROKEN]

    def ask(self, body: Body, runs: List[dict]) -> List[Optional[dict]]:
        """What steps of a body do. Raises Error where it cannot be had."""
        settings = {}
        if body.has_bonds:
            settings = {"Peridynamics/Kernel": body.kernel, "Peridynamics/Kernel exponent": body.exponent,
                        "Peridynamics/Horizon ratio": full_precision(body.ratio)}
        if body.bonds == NEVER:
            settings.update({"Material/Fracture energy": "", "Material/Critical stretch": ""})
        elif body.bonds == BROKEN and not self.scene.bonds["break"]:
            settings["Material/Critical stretch"] = "0.01"
        if body.bonds == BROKEN:  # cracks that go on growing are not the steps' fault
            settings.update({f"Boundary conditions/{entry}": "" for entry in ("Traction", "Displacement", "Velocity")})
        return self.scene.ask(body.model, settings, {"ask": "steps", "bonds": body.bonds, "runs": runs})["answers"]


class StepLimitMap(StepMap):
    """The longest stable step of each method."""

    name = "step limit"
    predicted = ("the longest stable step, from the largest eigenvalue as the program estimates it (with the bonds that are left where the load "
                 "breaks some); infinite: any")
    observed = "the step from which on a disturbance grows in runs of the stepper"
    bound = ("'safe' where steps up to the limit of the program, which is that of the whole body, do not grow: 2/lambda (euler), 2.785/lambda "
             "(rk4), about 0.65 (s^2 - 1)/lambda (rkc2 with s stages), 2/omega (verlet)")

    def points(self, quick):
        points = []
        bodies = self.bodies([self.scene.bonds["kernel"]] if quick else KERNELS, [2.0, 3.0] if quick else [2.0, 3.0, 4.0, 6.0])
        methods = self.methods(quick, with_chebyshev=True)
        runs = [{"method": method.name, "stages": method.stages} for method in methods]
        for body in bodies:
            try:
                answers = self.ask(body, runs)
            except Error as error:
                self.left_out.append(f"{body.text()}: {mistake_in(error)}")
                continue
            for method, answer in zip(methods, answers):
                if answer is None:
                    self.left_out.append(f"{body.model}, {method.name}: it needs loads and values at sides that do not change with time, and a "
                                         "symmetric operator")
                    continue
                predicted, refused, limit = (float(answer[key]) for key in ("predicted", "refused", "observed"))
                points.append(Point(body.parameters(method), predicted, limit, "safe" if limit >= refused * (1.0 - 1e-3) else "fails"))
        return points

    def random_point(self, inside, random):
        return None  # those of the map of growth are on both sides of these limits


class GrowthMap(StepMap):
    """What steps below and above the limit do."""

    name = "growth"
    predicted = "the factor by which the fastest field grows in a step by theory; 1 where no field grows"
    observed = "the factor by which a disturbance grows or decays in a step, in a run of the stepper"
    bound = "'safe' up to the limit of the step, which the program refuses to exceed; 'fails' where the disturbance grows"

    def points(self, quick):
        shares = [0.5, 0.97, 1.03, 1.5] if quick else [0.3, 0.5, 0.7, 0.9, 0.97, 1.03, 1.1, 1.3, 1.6, 2.0]
        points = []
        for body in self.bodies([self.scene.bonds["kernel"]], [2.0, 4.0] if quick else [2.0, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0]):
            try:
                points += self._points(body, [(method, share) for method in self.methods(True, False) for share in shares])
            except Error as error:
                self.left_out.append(f"{body.text()}: {mistake_in(error)}")
        return points

    def random_point(self, inside, random: Random):
        model = random.any_of(self.scene.facts["models"])
        kernel = random.any_of(KERNELS)
        ratio = random.uniform(2.0, 3.0 if self.scene.dim == 3 else 5.0)
        body = Body(model, kernel, self.scene.bonds["kernel exponent"], ratio, random.any_of(self.fates(model)))
        method = random.any_of(self.methods(False, False))
        # The limit of the program is up to 3 % on the safe side.
        share = random.uniform(0.1, 1.0) if inside else random.uniform(1.03, 2.0)
        return self._points(body, [(method, share)])[0]

    def _points(self, body: Body, runs) -> List[Point]:
        answers = self.ask(body, [{"method": method.name, "stages": method.stages, "share": share} for method, share in runs])
        return [Point({**body.parameters(method), "step": answer["step"], "step over limit": share}, float(answer["predicted"]),
                      float(answer["observed"]), "fails" if answer["grows"] else "safe") for (method, share), answer in zip(runs, answers)]
