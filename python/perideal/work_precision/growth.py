# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Strengths of bodies whose bonds break, and paths of their cracks: which rows there are, and how wrong what they have found is."""

import math
from pathlib import Path
from typing import List
from xml.etree import ElementTree

import numpy as np

from ..program import Error
from ..vtu import read_vtu

MEASURES = ("strength", "path")
PICKED = ("1e-1", "5e-2", "2e-2")
REFERENCE = {"strength": "1e-3", "path": "5e-3"}  # what Models = auto is asked for
PARTED = 0.3  # damage of a node beside a crack that has run through: 0.4 on a plane


def require_growth(facts: dict, measure: str) -> None:
    """Raises Error where nothing grows."""
    if facts["dimension"] != 2 or not facts["deforms"] or facts["moves"] or facts["steady"] or not facts["bonds"]["break"]:
        raise Error(f"command line: --measure '{measure}': is of elastic bodies in two dimensions, at rest under loads that depend on t, whose bonds break "
                    "('Fracture energy' in section 'Material').")


def settings_of_choice(measure: str, tolerance: str) -> dict:
    """Of the rows in which the program chooses."""
    return {"Models": "auto", "Accuracy/Measure": measure, "Accuracy/Tolerance": tolerance}


def strength(summary: dict, model: str) -> float:
    """The largest force, not a number where there is none."""
    found = summary["models"].get(model, {}).get("largest force")
    return abs(found["value"]) if found else math.nan


def chosen_path(summary: dict) -> List[np.ndarray]:
    """The cracks that `Models = auto` has found, as lines."""
    return [np.array(line) for line in summary.get("accuracy", {}).get("path", {}).get("lines", [])]


def grown_path(folder: Path, model: str) -> List[np.ndarray]:
    """The pieces of the cracks at the end of a run, between nodes that have lost their neighbours."""
    series = folder / f"cracks_{model.replace(' ', '_')}.pvd"
    if not series.is_file():
        return []
    files = [entry.get("file") for entry in ElementTree.parse(series).getroot().iter("DataSet")]
    if not files:
        return []
    found = read_vtu(folder / files[-1])
    if not found or "damage" not in found:
        return []
    return [found["nodes"][cell][:, :2] for cell, damage in zip(found["cells"], found["damage"]) if damage > PARTED]


def _points(lines: List[np.ndarray], spacing: float) -> np.ndarray:
    """On all lines, no farther from each other."""
    points = []
    for line in lines:
        for a, b in zip(line, line[1:]):
            n = max(1, math.ceil(np.hypot(*(b - a)) / spacing))
            points += [a + (b - a) * k / n for k in range(n + 1)]
    return np.array(points)


def distance(one: List[np.ndarray], other: List[np.ndarray], longest: float) -> float:
    """The farthest from one to the other or back, over the longest edge; not a number where nothing has grown."""
    a, b = _points(one, longest / 400), _points(other, longest / 400)
    if not len(a) or not len(b):
        return math.nan
    apart = np.hypot(a[:, None, 0] - b[None, :, 0], a[:, None, 1] - b[None, :, 1])
    return float(max(apart.min(axis=0).max(), apart.min(axis=1).max())) / longest
