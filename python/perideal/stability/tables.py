# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""stability.csv, stability.json, and what the reader is told."""

import collections
import dataclasses
import json
import math
from typing import List, Tuple

from ..words import full_precision, readable_duration
from .scene import Map, MappedScene, Point


@dataclasses.dataclass
class RandomPoint:
    """A random point, and on which side of the bound it was chosen."""

    inside: bool
    point: Point

    @property
    def confirms(self) -> bool:
        """It is as the bound says."""
        return self.inside == self.point.is_healthy


@dataclasses.dataclass
class Result:
    """What has become of a map."""

    map: Map
    obstacle: str  # why there are no points
    points: List[Point] = dataclasses.field(default_factory=list)
    random: List[RandomPoint] = dataclasses.field(default_factory=list)
    left_out: List[str] = dataclasses.field(default_factory=list)
    wall_time: float = 0.0

    def confirmed(self, inside: bool) -> Tuple[int, int]:
        """How many random points of a side there are, and how many are as the bound says."""
        found = [one.confirms for one in self.random if one.inside == inside]
        return len(found), sum(found)

    def samples(self):
        """All points with their kind."""
        for point in self.points:
            yield "grid", point
        for one in self.random:
            yield "inside" if one.inside else "outside", one.point


def _cell(value) -> str:
    if value is None:
        return ""
    if isinstance(value, float):
        return full_precision(value)
    text = str(value)
    return '"' + text.replace('"', '""') + '"' if any(letter in text for letter in ',"\n') else text


def stability_csv(results: List[Result]) -> str:
    """`map`, `sample` (grid, inside or outside), the parameters of all maps, and `predicted`, `observed`, `verdict`."""
    names = list(dict.fromkeys(name for result in results for _, point in result.samples() for name in point.parameters))
    lines = [["map", "sample", *names, "predicted", "observed", "verdict"]]
    for result in results:
        for sample, point in result.samples():
            lines.append([result.map.name, sample, *(_cell(point.parameters.get(name)) for name in names), full_precision(point.predicted),
                          full_precision(point.observed), point.verdict])
    return "".join(",".join(line) + "\n" for line in lines)


def _number(value: float):
    """JSON has no infinity."""
    return value if math.isfinite(value) else None if math.isnan(value) else "infinite"


def _entry(point: Point) -> dict:
    return {**point.parameters, "predicted": _number(point.predicted), "observed": _number(point.observed), "verdict": point.verdict}


def _ranges(points: List[Point]) -> dict:
    """The least and the largest value of parameters that are numbers, else all texts."""
    found = {}
    for point in points:
        for name, value in point.parameters.items():
            if value is not None:
                found.setdefault(name, []).append(value)
    return {name: list(dict.fromkeys(values)) if isinstance(values[0], str) else [float(min(values)), float(max(values))]
            for name, values in found.items()}


def stability_json(scene: MappedScene, seed: int, results: List[Result]) -> str:
    """stability.json."""
    maps, left_out = [], {}
    for result in results:
        if result.obstacle:
            left_out[result.map.name] = result.obstacle
            continue
        of_map = result.map
        entry = {"name": of_map.name, "predicted": of_map.predicted, "observed": of_map.observed, "bound": of_map.bound,
                 "ranges": _ranges(result.points), "wall time": result.wall_time, "left out": result.left_out,
                 "points": [_entry(point) for point in result.points],
                 "random": [{**_entry(one.point), "inside": one.inside, "confirmed": one.confirms} for one in result.random]}
        for side in ("inside", "outside"):
            n, n_confirmed = result.confirmed(side == "inside")
            entry[side] = {"points": n, "confirmed": n_confirmed}
        maps.append(entry)
    content = {"scene": scene.file, "title": scene.facts["title"], "set": scene.overrides, "cells": scene.coarse, "cells of the scene": scene.cells,
               "seed": seed, "maps": maps, "left out": left_out}
    return json.dumps(content, indent=2, ensure_ascii=False) + "\n"


def describe(result: Result) -> List[str]:
    """What the reader is told when a map is done."""
    name = result.map.name
    if result.obstacle:
        return [f"  {name}: left out, {result.obstacle}"]
    verdicts = sorted(collections.Counter(point.verdict for point in result.points).items())
    counts = "".join(f", {n} {verdict}" for verdict, n in verdicts)
    lines = [f"  {name}: {len(result.points)} points{counts} ({readable_duration(result.wall_time)})"]
    ratios = [point.observed / point.predicted for point in result.points
              if math.isfinite(point.predicted) and math.isfinite(point.observed) and point.predicted > 0]
    if name == "step limit" and max(ratios, default=0) > 0:
        lines.append(f"    observed over predicted: {min(ratios):.4g} to {max(ratios):.4g}")
    for inside in (True, False):
        n, n_confirmed = result.confirmed(inside)
        if n:
            lines.append(f"    {n_confirmed} of {n} random points " + ("inside are healthy" if inside else "outside are not healthy"))
    return lines + [f"    left out: {what}" for what in result.left_out]
