# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Compute the maps of a scene and write them down."""

import dataclasses
import tempfile
import time
from pathlib import Path
from typing import List, Sequence, Type

from ..drivers import mistake_in, require_scene, write_text
from ..program import Error
from ..server import Server
from ..words import did_you_mean, split_list
from ..work_precision.lattice import name_of
from .coupling import EigenvalueMap, HeatMap
from .iterations import IterationsMap
from .scene import Map, MappedScene, Random
from .steps import GrowthMap, StepLimitMap
from .strip import ConductionMap, SurfaceMap
from .tables import RandomPoint, Result, describe, stability_csv, stability_json

# In the order in which they are computed.
MAPS: List[Type[Map]] = [StepLimitMap, GrowthMap, ConductionMap, SurfaceMap, EigenvalueMap, IterationsMap, HeatMap]


@dataclasses.dataclass
class Options:
    """Which maps of a scene are wanted."""

    overrides: Sequence[str] = ()  # "Section/Entry=value", of all points
    maps: str = ""  # names with commas between them; empty: all that apply
    output: str = ""  # empty: output/studies/<scene>_stability
    n_random: int = 0  # points inside, and as many outside, of safe regions
    seed: int = 1
    quick: bool = False  # few points of each map
    quiet: bool = False  # print nothing but errors
    processes: int = 1


def wanted_maps(text: str) -> List[Type[Map]]:
    """Those that --maps names, or all. Raises Error."""
    if not text:
        return MAPS
    known = {one.name: one for one in MAPS}
    names = split_list(text, ",")
    for name in names:
        if name not in known:
            raise Error(f"--maps names '{name}', which is no map.{did_you_mean(name, known)} Known: {', '.join(known)}.")
    if not names:
        raise Error(f"--maps names none. Known: {', '.join(known)}.")
    return [known[name] for name in names]


def _random_points(of_map: Map, options: Options, result: Result) -> None:
    """Points that lie anywhere in and outside of the safe region."""
    random = Random(options.seed)
    for inside in (True, False):
        for _ in range(options.n_random):
            # What a scene cannot have, for instance a horizon wider than the body, is no point.
            for _ in range(20):
                try:
                    point = of_map.random_point(inside, random)
                except Error as error:
                    result.left_out.append(f"random point: {mistake_in(error)}")
                    continue
                if point is not None:
                    result.random.append(RandomPoint(inside, point))
                    break


def _compute(kind: Type[Map], scene: MappedScene, options: Options) -> Result:
    of_map = kind(scene)
    result = Result(of_map, of_map.obstacle())
    if result.obstacle:
        return result
    start = time.monotonic()
    result.points = of_map.points(options.quick)
    result.left_out = of_map.left_out
    _random_points(of_map, options, result)
    result.left_out = sorted(set(result.left_out))  # each reason once
    result.wall_time = time.monotonic() - start
    return result


def run(file: str, options: Options = Options()) -> None:
    """Compute the maps of a scene and write them.

    Maps that a scene cannot have are named with the reason. Raises Error: unknown maps, none of those wanted can be had, or one of them has no
    points, which is said when all have been computed.
    """
    def say(text):
        if not options.quiet:
            print(text, flush=True)

    wanted = wanted_maps(options.maps)
    require_scene(file)
    folder = options.output or f"output/studies/{Path(file).stem}_stability"
    results: List[Result] = []
    with Server(options.processes) as server, tempfile.TemporaryDirectory(prefix="perideal_") as temporary:
        scene = MappedScene(server, file, options.overrides, folder, temporary)
        say(f"{scene.facts['title']}: stability" +
            ("" if scene.coarse == scene.cells else f", on a lattice of {name_of(scene.coarse)} cells"))
        try:
            Path(folder).mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise Error(f"--output: cannot use '{folder}': {error.strerror}. Choose a directory that you may write to.") from None

        def write():
            write_text(f"{folder}/stability.csv", stability_csv(results))
            write_text(f"{folder}/stability.json", stability_json(scene, options.seed, results))

        for kind in wanted:
            results.append(_compute(kind, scene, options))
            for line in describe(results[-1]):
                say(line)
            if not results[-1].obstacle:
                write()
        if all(result.obstacle for result in results):
            raise Error("The scene has none of the maps of stability:" + "".join(f"\n  {one.map.name}: {one.obstacle}" for one in results))
        write()
        say(f"Results: {folder}")
    without = "".join(f"\n  {one.map.name}" + (f": {one.left_out[0]}" if one.left_out else "") for one in results
                      if not one.obstacle and not one.points)
    if without:
        raise Error(f"No point of these maps could be computed:{without}")
