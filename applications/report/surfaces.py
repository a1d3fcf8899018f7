# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""The surface of a body, whatever its shape: sides, holes, boundaries of meshes from files."""

from itertools import product

import numpy as np

# The corners of the faces of a cell, by the order of its vertices in files (VTK's).
FACES = {2: ((0,), (1,)),
         4: ((0, 1), (1, 2), (2, 3), (3, 0)),
         8: ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))}


def numbers_of_places(nodes):
    """One number for all nodes at one place: cells have their own copies of their vertices."""
    low, size = nodes.min(axis=0), np.ptp(nodes, axis=0).max()
    grid = np.round((nodes - low) / (np.pi * 1e-8 * size if size > 0 else 1.0)).astype(np.int64)
    return np.unique(grid, axis=0, return_inverse=True)[1].reshape(-1)


def surface_points(mesh):
    """Corners and middles of the faces that only one cell has, (n x dim)."""
    places = numbers_of_places(mesh.nodes)
    faces = np.array(FACES[mesh.cells.shape[1]])
    corners = mesh.cells[:, faces].reshape(-1, faces.shape[1])
    _, first, count = np.unique(np.sort(places[corners], axis=1), axis=0, return_index=True,
                                return_counts=True)
    corners = mesh.nodes[corners[first[count == 1]]]
    return np.unique(np.concatenate((corners.reshape(-1, mesh.nodes.shape[1]),
                                     corners.mean(axis=1))), axis=0)


def near_surface(mesh, distance, planes=()):
    """Which nodes lie within a distance of the surface, but for planes (axis, coordinate)."""
    near = np.zeros(len(mesh.nodes), dtype=bool)
    if not distance > 0 or not len(near):
        return near
    low = mesh.nodes.min(axis=0)

    def boxes(points):
        """Indices of points by the box of the size of the distance that they are in."""
        keys = np.floor((points - low) / distance).astype(np.int64)
        order = np.lexsort(keys.T)
        cuts = np.flatnonzero((np.diff(keys[order], axis=0) != 0).any(axis=1)) + 1
        return {tuple(keys[part[0]]): part for part in np.split(order, cuts)}

    surface = surface_points(mesh)
    slack = 1e-9 * np.ptp(mesh.nodes, axis=0).max()
    for axis, at in planes:
        surface = surface[np.abs(surface[:, axis] - at) > slack]
    if not len(surface):
        return near
    of_surface = boxes(surface)
    for key, nodes in boxes(mesh.nodes).items():
        around = [of_surface[other] for step in product((-1, 0, 1), repeat=len(key))
                  if (other := tuple(k + s for k, s in zip(key, step))) in of_surface]
        if around:
            points = surface[np.concatenate(around)]
            for part in np.array_split(nodes, 1 + len(nodes) * len(points) // 2_000_000):
                squares = ((mesh.nodes[part][:, None] - points) ** 2).sum(axis=2)
                near[part] = squares.min(axis=1) < distance ** 2
    return near
