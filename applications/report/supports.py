# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Marks at the sides in the sketch of an elastic body: what holds it, what pulls at it.

Arrows point where a traction pulls or a displacement goes, the longest of each kind equally long.
Where a side may not move, it is hatched; where it may slide, it stands on circles.
"""

import numpy as np
from matplotlib.patches import FancyArrowPatch

import solids

DISPLACEMENT, TRACTION, SYMMETRY = "#c0392b", "#d98200", "#5e60ce"
NORMALS = {"left": (0, -1), "right": (0, 1), "bottom": (1, -1), "top": (1, 1), "back": (2, -1),
           "front": (2, 1)}


def values_at(run, side, kind):
    """(points, vectors) of a traction or displacement on a side; NaN: free. None if unknown."""
    found = run.get("values on sides", side, kind)
    if not isinstance(found, dict) or not found.get("at"):
        return None
    points = np.array(found["at"], float)
    vectors = np.array([[np.nan if v is None else v for v in row] for row in found["values"]],
                       float)
    return (points, vectors) if vectors.shape == points.shape else None


def names_of(run):
    """All sides and parts that have displacements or tractions."""
    return list(dict.fromkeys(list(NORMALS) + list(run.get("values on sides", default={}))))


def is_side_of_box(run, side):
    """Whether a name is that of a whole side of a box; parts and sides of meshes may have such names, too."""
    return side in list(NORMALS)[:2 * run.dimension] and not run.get("places", side)


def normals_at(run, side, n):
    """Outward normals at the n points of a side or part; none of a region or a point."""
    if is_side_of_box(run, side):
        return [normal_of(side, run.dimension)] * n
    found = run.get("places", side, "normals", default=[])
    return np.array(found, float) if len(found) == n else np.zeros((n, run.dimension))


def normal_of(side, dimension):
    """Outward unit normal of a side of a box."""
    axis, sign = NORMALS[side]
    normal = np.zeros(dimension)
    normal[axis] = sign
    return normal


def longest(run, kind):
    """Length of the largest vector of a kind on any side."""
    sizes = [np.linalg.norm(np.nan_to_num(found[1]), axis=1).max() for found in
             (values_at(run, side, kind) for side in names_of(run)) if found is not None]
    return max(sizes, default=0.0)


def longest_of(run, side):
    """Length of the largest vector of all kinds on a side or part."""
    found = [values_at(run, side, kind) for kind in ("displacement", "traction")]
    return max((np.linalg.norm(np.nan_to_num(f[1]), axis=1).max() for f in found if f is not None), default=0.0)


class Marks:
    """Draws in inches from points given in the coordinates of the body."""

    def __init__(self, axes, to_paper, directions, inch):
        """to_paper: of points; directions: rows are x, y, z on paper; inch: in data units."""
        self.axes, self.to_paper, self.inch = axes, to_paper, inch
        self.directions = np.asarray(directions, float)

    def arrow(self, point, vector, normal, color, length):
        """An arrow of so many inches that pulls at, presses on or runs along the side."""
        on_paper = vector @ self.directions
        size = np.linalg.norm(on_paper)
        if not size > 0:
            return
        step = on_paper / size * length * self.inch
        out = normal @ self.directions
        out = out / max(np.linalg.norm(out), 1e-300) * self.inch
        across = vector @ normal / np.linalg.norm(vector)
        if not np.any(normal):  # of a region or a point: the arrow begins there
            across = 1.0
        foot = self.to_paper(point)
        if across < -0.2:  # presses: the head is on the side
            start, end = foot - step, foot
        elif across > 0.2:
            start, end = foot, foot + step
        else:
            start, end = foot + 0.1 * out - 0.5 * step, foot + 0.1 * out + 0.5 * step
        self.axes.add_patch(FancyArrowPatch(
            start, end, arrowstyle="-|>", mutation_scale=7, linewidth=1.2, color=color,
            shrinkA=0, shrinkB=0, clip_on=False, zorder=7))

    def arrows(self, run, side, kind, color, full, length=0.34):
        """The arrows of a side; full: the size of the longest of all."""
        found = values_at(run, side, kind)
        if found is None or not full > 0:
            return
        for point, vector, normal in zip(*found, normals_at(run, side, len(found[0]))):
            vector = np.nan_to_num(vector)
            share = np.linalg.norm(vector) / full
            if share > 1e-9:
                self.arrow(point, vector, normal, color, length * max(share, 0.3))


def kind_of_support(run, side):
    """'held', 'slides' or '' from the displacement and the symmetry of a side."""
    if "symmetry" in run.sides().get(side, ""):
        return "slides"
    found = values_at(run, side, "displacement")
    if found is None:
        return ""
    if np.abs(np.nan_to_num(found[1])).max(initial=0) > 0:
        return ""  # moved: arrows tell
    fixed = np.isfinite(found[1]).all(axis=0)
    axis = NORMALS[side][0]
    if fixed.all():
        return "held"
    return "slides" if fixed[axis] and not np.delete(fixed, axis).any() else ""


def draw_support(axes, run, side, ends, inch):
    """Hatching or circles along a side of a rectangle."""
    kind = kind_of_support(run, side)
    if not kind:
        return
    color = SYMMETRY if "symmetry" in run.sides().get(side, "") else DISPLACEMENT
    a, b = ends
    out = normal_of(side, 2) * inch
    along = (b - a) / max(np.linalg.norm(b - a), 1e-300) * inch
    n = max(3, int(np.linalg.norm(b - a) / inch / (0.1 if kind == "held" else 0.22)))
    for share in (np.arange(n) + 0.5) / n:
        p = a + share * (b - a)
        if kind == "held":
            q = p + 0.09 * out - 0.07 * along
            axes.plot([p[0], q[0]], [p[1], q[1]], color=color, linewidth=0.9, clip_on=False,
                      zorder=3)
        else:
            q = p + 0.055 * out
            axes.plot(*q, marker="o", markersize=5, markerfacecolor="white", markeredgecolor=color,
                      markeredgewidth=1.0, clip_on=False, zorder=3)


def draw_2d(axes, run, lower, extent, inch, sides):
    """Supports and arrows at the sides of a rectangle; sides: {side: two corners as shares}."""
    marks = Marks(axes, lambda p: np.asarray(p, float), np.eye(2), inch)
    for side, corners in sides.items():
        draw_support(axes, run, side, lower + np.array(corners) * extent, inch)
        for kind, color in (("displacement", DISPLACEMENT), ("traction", TRACTION)):
            marks.arrows(run, side, kind, color, longest(run, kind))


def color_of(run, side):
    """The colour of what holds a side or part of an elastic body, or loads it."""
    text = run.sides().get(side, "")
    return SYMMETRY if "symmetry" in text else TRACTION if "traction" in text and "displacement" not in text \
        else DISPLACEMENT


def is_held(run, side):
    """'held' where no component may move, 'slides' where some may, '' where nothing is held or all is moved."""
    if "symmetry" in run.sides().get(side, ""):
        return "slides"
    found = values_at(run, side, "displacement")
    if found is None or np.abs(np.nan_to_num(found[1])).max(initial=0) > 0:
        return ""
    return "held" if np.isfinite(found[1]).all() else "slides" if np.isfinite(found[1]).any() else ""


def draw_place(axes, run, side, inch):
    """Marks and arrows of a part, or of a side of a mesh from a file, in two dimensions."""
    marks = Marks(axes, lambda p: np.asarray(p, float), np.eye(2), inch)
    points = np.array(run.get("places", side, "at", default=[]), float).reshape(-1, 2)
    kind, color = is_held(run, side), color_of(run, side)
    for point, normal in zip(points, normals_at(run, side, len(points))):
        if kind:
            at = point + 0.07 * inch * (normal if np.any(normal) else np.array([0.0, -1.0]))
            axes.plot(*at, marker="^" if kind == "held" else "o", markersize=5, markerfacecolor="white",
                      markeredgecolor=color, markeredgewidth=1.0, clip_on=False, zorder=7)
    for what, arrow_color in (("displacement", DISPLACEMENT), ("traction", TRACTION)):
        marks.arrows(run, side, what, arrow_color, longest(run, what))


def draw_3d(axes, run, inch):
    """Held sides in colour, arrows at all sides: pale where they are hidden."""
    lower, upper = run.domain
    marks = Marks(axes, solids.project, solids.ISOMETRIC, inch)
    for side, (axis, sign) in NORMALS.items():
        kind = kind_of_support(run, side) if is_side_of_box(run, side) else ""
        if kind:
            color = SYMMETRY if "symmetry" in run.sides().get(side, "") else DISPLACEMENT
            corners = []
            for i, j in ((0, 0), (1, 0), (1, 1), (0, 1)):
                point = np.empty(3)
                point[axis] = (upper if sign > 0 else lower)[axis]
                u, v = (d for d in range(3) if d != axis)
                point[u], point[v] = (lower, upper)[i][u], (lower, upper)[j][v]
                corners.append(solids.project(point))
            axes.fill(*np.array(corners).T, facecolor=color, alpha=0.22 if sign > 0 else 0.14,
                      edgecolor="none", hatch="////" if kind == "held" else "oo", zorder=2)
    for side in names_of(run):
        for what, color in (("displacement", DISPLACEMENT), ("traction", TRACTION)):
            marks.arrows(run, side, what, color, longest(run, what), 0.22)


def draw_1d(axes, run, inch):
    """Arrows at the ends of a bar."""
    marks = Marks(axes, lambda p: np.array([float(p[0]), 0.5]), [[1.0, 0.0]], inch)
    for side in ("left", "right"):
        for kind, color in (("displacement", DISPLACEMENT), ("traction", TRACTION)):
            marks.arrows(run, side, kind, color, longest(run, kind))


def room(run):
    """Inches that marks take at each side of a sketch in two dimensions."""
    found = {}
    apart = any(not is_side_of_box(run, side) and longest_of(run, side) > 0 for side in run.get("values on sides", default={}))
    for side in ("left", "right", "bottom", "top"):
        needs = 0.12 if is_side_of_box(run, side) and kind_of_support(run, side) else 0.0
        for kind in ("displacement", "traction"):
            values = values_at(run, side, kind) if is_side_of_box(run, side) else None
            if values is not None and np.abs(np.nan_to_num(values[1])).max(initial=0) > 0:
                needs = 0.38
        found[side] = max(needs, 0.38 if apart else 0.0)
    return found
