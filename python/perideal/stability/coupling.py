# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Maps of couplings: the lowest eigenvalue of a coupled square, and the heat that stays in one."""

import dataclasses
import math
from pathlib import Path
from typing import Dict, List

from ..drivers import mistake_in, write_text
from ..program import Error
from ..words import full_precision
from .scene import COUPLED, Map, MappedScene, Point, Random

SCHEMES = ["exchange", "splice", "blending"]
# Where there are bonds in the unit square.
ZONES = {"half": "0.5 - x", "disc": "0.3 - sqrt((x - 0.5)^2 + (y - 0.5)^2)", "L": "0.6 - max(x, y) + 0.4*(x < 0.3 || y < 0.3)",
         "two squares": "0.14 - min(max(abs(x - 0.3), abs(y - 0.3)), max(abs(x - 0.7), abs(y - 0.7)))",
         "ring": "0.1 - abs(sqrt((x - 0.5)^2 + (y - 0.5)^2) - 0.3)"}
N = 16  # cells along an edge


def obstacle(scene: MappedScene) -> str:
    """Of both maps."""
    return scene.no_diffusion_with(COUPLED) if scene.dim == 2 or scene.facts["deforms"] else "it is of plane bodies"


def mesh_text(n: int, share: float) -> str:
    """The unit square of n x n cells as a file of Gmsh; every other vertex is moved up by a share of an edge, the others down."""
    def node(i, j):
        return j * (n + 1) + i + 1

    nodes, elements = [], []
    for j in range(n + 1):
        for i in range(n + 1):
            moved = 0.0 if j in (0, n) else share if (i + j) % 2 == 0 else -share
            nodes.append(f"{node(i, j)} {full_precision(i / n)} {full_precision((j + moved) / n)} 0")
    for j in range(n):
        elements += [f"1 2 1 1 {node(0, j)} {node(0, j + 1)}", f"1 2 2 2 {node(n, j)} {node(n, j + 1)}"]
    elements += [f"3 2 9 9 {node(i, j)} {node(i + 1, j)} {node(i + 1, j + 1)} {node(i, j + 1)}" for j in range(n) for i in range(n)]
    return "\n".join(["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(nodes)), *nodes, "$EndNodes", "$Elements", str(len(elements)),
                      *(f"{number} {element}" for number, element in enumerate(elements, 1)), "$EndElements", ""])


@dataclasses.dataclass
class Square:
    """A coupled body."""

    scheme: str
    zone: str
    contrast: float
    distortion: float


class EigenvalueMap(Map):
    """What bonds leave of cells."""

    name = "lowest eigenvalue"
    predicted = ("the lowest eigenvalue of what bonds leave of a cell, in units of its conductivity: not below 0, no field grows; infinite where "
                 "no cell is divided")
    observed = "the lowest eigenvalue of the whole body with its surface held, the rate of the slowest decay"
    bound = ("'safe' where the certificate of the coupling finds no fault; with one, 'exchange' is refused, and of the others the user is told "
             "('warned')")

    def obstacle(self):
        return obstacle(self.scene)

    def points(self, quick):
        points = []
        for scheme in SCHEMES:
            distortions = [0.0] if scheme != "exchange" else [0.0, 0.4, 0.51] if quick else [0.0, 0.2, 0.4, 0.49, 0.499, 0.51]
            for zone in ("half", "L") if quick else ZONES:
                for contrast in (1.0, 1e4) if quick else (1.0, 1e2, 1e4, 1e6, 1e8):
                    for distortion in distortions:
                        try:
                            points.append(self._point(Square(scheme, zone, contrast, distortion)))
                        except Error as error:
                            self.left_out.append(f"{scheme}, zone {zone}: {mistake_in(error)}")
        return points

    def random_point(self, inside, random: Random):
        zone = random.any_of(list(ZONES))
        contrast = math.pow(10.0, random.uniform(0.0, 6.0))
        # At 0.5 of an edge cells are triangles.
        return self._point(Square("exchange", zone, contrast, random.uniform(0.0, 0.45) if inside else random.uniform(0.5, 0.8)))

    @property
    def _mesh_file(self) -> str:
        return self.scene.output + "/.stability_mesh.msh"

    def _settings(self, square: Square) -> Dict[str, str]:
        ratio = min(max(self.scene.bonds["m"], 2.0), 4.0)
        settings = {"Material/Conductivity": f"if(y < 0.5, 1, {full_precision(square.contrast)})",
                    "Peridynamics/Horizon": full_precision(ratio / N), "Coupling/Scheme": square.scheme, "Coupling/Zone": ZONES[square.zone],
                    "Coupling/Certificate": "false",  # which would end here
                    "Time/Steady": "true"}
        if square.distortion == 0:
            return {**settings, "Domain/Lower corner": "0, 0", "Domain/Upper corner": "1, 1", "Domain/Cells": f"{N}, {N}",
                    "Boundary conditions/Dirichlet": "left: 1; right: 0"}
        return {**settings, "Domain/Shape": "mesh file", "Domain/Mesh file": self._mesh_file, "Boundary conditions/Dirichlet": "1: 1; 2: 0"}

    def _point(self, square: Square) -> Point:
        parameters = {"scheme": square.scheme, "zone": square.zone, "contrast": square.contrast, "distortion": square.distortion}
        if square.distortion != 0:  # only distorted cells come from a file: bonds of a lattice are calibrated
            write_text(self._mesh_file, mesh_text(N, square.distortion))
        try:
            found = self.scene.ask_body(COUPLED, self._settings(square), {"ask": "certificate"})
        except Error as error:
            if square.distortion < 0.5:  # only cells that are inside out are part of the map
                raise
            return Point({**parameters, "fault": mistake_in(error)}, -math.inf, math.nan, "refused")
        finally:
            if square.distortion != 0:
                Path(self._mesh_file).unlink(missing_ok=True)
        lowest, fault = float(found["lowest eigenvalue"]), found["fault"]
        verdict = ("safe" if lowest > 0 else "fails") if not fault else "refused" if square.scheme == "exchange" else "warned"
        return Point({**parameters, **({"fault": fault} if fault else {})}, float(found["lowest remainder"]), lowest, verdict)


class HeatMap(Map):
    """A pulse of heat in an insulated plate, half of which has bonds."""

    name = "heat lost by splice"
    predicted = ("the heat that may be lost: none but round-off where the matrix is symmetric and its rows sum to zero; infinite where nothing "
                 "keeps it")
    observed = "the change of the heat in the plate since the start, over what there was, either sign"
    bound = "'safe' where heat stays to 1e-10; 'splice' does not conserve it, which its certificate says ('warned')"

    def obstacle(self):
        return obstacle(self.scene)

    def points(self, quick):
        points = []
        for scheme in SCHEMES:
            for ratio in (3.0,) if quick else (2.0, 3.0, 4.0):
                try:
                    points += self._points(scheme, ratio, 0.4, 3 if quick else 10)
                except Error as error:
                    self.left_out.append(f"{scheme}, m = {ratio}: {mistake_in(error)}")
        return points

    def random_point(self, inside, random: Random):
        scheme = ("exchange" if random.next() % 2 == 0 else "blending") if inside else "splice"
        n, place, ratio = 1 + random.next() % 3, random.uniform(0.3, 0.7), random.uniform(2.0, 4.0)
        return self._points(scheme, ratio, place, n)[-1]

    def _points(self, scheme: str, ratio: float, place: float, n: int) -> List[Point]:
        """At n equal times until heat from the middle of the pulse has come to the sides."""
        end, kept = 0.05, 1e-10
        times = [k * end / n for k in range(1, n + 1)]
        settings = {"Domain/Lower corner": "0, 0", "Domain/Upper corner": "1, 1", "Domain/Cells": "24, 24",
                    "Initial and source/Initial value": f"exp(-((x - {full_precision(place)})^2 + (y - 0.5)^2)/0.005)",
                    "Boundary conditions/Flux": "left: 0; right: 0; bottom: 0; top: 0", "Peridynamics/Horizon ratio": full_precision(ratio),
                    "Coupling/Scheme": scheme, "Coupling/Zone": "0.5 - x", "Coupling/Certificate": "false", "Time/End time": full_precision(end)}
        before, *contents = map(float, self.scene.ask_body(COUPLED, settings, {"ask": "heat", "times": times})["contents"])
        points = []
        for time, content in zip(times, contents):
            change = abs(content / before - 1.0)
            verdict = "safe" if change <= kept else "warned" if scheme == "splice" else "fails"
            points.append(Point({"scheme": scheme, "m": ratio, "place": place, "time": time}, math.inf if scheme == "splice" else kept, change,
                                verdict))
        return points
