# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Where a line of points crosses cracks."""

import numpy as np

from raster import crosses


def crack_normal(polygon):
    """Unit normal of a plane polygon (right-hand rule), by Newell's sum."""
    following = np.roll(polygon, -1, axis=0)
    normal = np.cross(polygon, following).sum(axis=0)
    return normal / max(np.linalg.norm(normal), 1e-300)


def crosses_polygon(p, q, polygon):
    """Whether the straight lines p-q (P x 3 each) cross a plane polygon."""
    normal = crack_normal(polygon)
    a, b = (p - polygon[0]) @ normal, (q - polygon[0]) @ normal
    through = a * b < 0
    share = np.where(through, a / np.where(through, a - b, 1), 0)
    plane = np.argsort(np.abs(normal))[:2]  # the projection in which the polygon is largest
    x, y = (p + share[:, None] * (q - p))[:, plane].T
    inside = np.zeros(len(p), bool)  # by the number of edges to the right
    for u, v in zip(polygon[:, plane], np.roll(polygon, -1, axis=0)[:, plane]):
        if u[1] == v[1]:
            continue
        spans = (u[1] > y) != (v[1] > y)
        inside ^= spans & (x < u[0] + (y - u[1]) * (v[0] - u[0]) / (v[1] - u[1]))
    return through & inside


def left_of(crack):
    """Pairs (unit normal to the left, piece) of a crack: segments in 2D, a polygon in 3D."""
    if crack.shape[1] == 3:
        return [(crack_normal(crack), crack)] if len(crack) >= 3 else []
    if crack.shape[1] == 1:
        return []
    along = np.diff(crack, axis=0)
    normals = np.stack([-along[:, 1], along[:, 0]], axis=1)
    normals /= np.maximum(np.linalg.norm(along, axis=1), 1e-300)[:, None]
    return [(n, crack[i:i + 2]) for i, n in enumerate(normals)]


def crossed(points, cracks):
    """(i, share): a crack lies between the points i and i + 1, at that share of the way.

    A point on a crack belongs to its left side, as everywhere in PeriDeal.
    """
    found, share = np.zeros(max(len(points) - 1, 0), bool), np.zeros(max(len(points) - 1, 0))
    slack = 1e-7 * max(np.ptp(points, axis=0).max(initial=0), 1e-300)
    for crack in cracks:
        for normal, piece in left_of(crack):
            moved = points + slack * normal
            between = crosses_polygon if points.shape[1] == 3 else crosses
            new = np.flatnonzero(between(moved[:-1], moved[1:], piece))
            height = (points - piece[0]) @ normal
            share[new] = np.clip(height[new] / (height[new] - height[new + 1]), 0, 1)
            found[new] = True
    return np.flatnonzero(found), share[found]
