# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Pieces that have broken off a body and fly away: scales and views leave them out, and say so.

A tear is an edge between two nodes that have lost bonds and part by far more than nodes of the
whole material do. What is connected without tears is a piece; a small one that has gone much
farther than the body is a fragment.
"""

from dataclasses import dataclass

import numpy as np

from raster import is_constant_per_cell
from style import plain

DAMAGED = 0.2  # share of broken bonds of one node at a tear
TOUCHED = 0.05  # and of the other
PARTED = 3.0  # times what nine tenths of the edges of whole material part at most
SMALL = 0.1  # share of the nodes that a fragment has at most
FAR = 1.5  # times the largest displacement of the body, from which a small piece is a fragment
EDGES = {4: ((0, 1), (1, 2), (2, 3), (3, 0)),
         8: ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4),
             (0, 4), (1, 5), (2, 6), (3, 7))}
FACES = {4: ((0, 1), (1, 2), (2, 3), (3, 0)),
         8: ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))}


@dataclass
class Fragments:
    """Those of one model at one time; `mask` is true at their vertices in the files."""

    mask: np.ndarray
    count: int
    share: float  # of the nodes
    farthest: float  # the largest displacement among them

    def text(self, amount):
        """'3 fragments (0.4 % of the nodes), which have moved by up to 12 mm'; amount() adds the unit."""
        which = "a fragment" if self.count == 1 else f"{plain(self.count)} fragments"
        verb = "has" if self.count == 1 else "have"
        return (f"{which} ({plain(100 * self.share, 2)} % of the nodes) that {verb} moved by up to "
                f"{amount(self.farthest)}")


def components(n, first, second):
    """Number of the piece of each of n nodes that such pairs join."""
    label = np.arange(n)
    while True:
        low = np.minimum(label[first], label[second])
        new = label.copy()
        np.minimum.at(new, label[first], low)
        np.minimum.at(new, label[second], low)
        while not np.array_equal(new, new[new]):
            new = new[new]
        if np.array_equal(new, label):
            return np.unique(label, return_inverse=True)[1]
        label = new


def numbered(rows):
    """A number for each row, equal ones the same."""
    return np.unique(np.ascontiguousarray(rows), axis=0, return_inverse=True)[1].ravel()


def nodes_of(mesh, displacement):
    """Number of the node of each vertex of the files: those at one place that move alike are one."""
    grain = 1e-5 * np.ptp(mesh.nodes[mesh.cells[0]], axis=0).max()
    place = np.round((mesh.nodes - mesh.nodes.min(axis=0)) / grain)
    return numbered(np.concatenate([place, displacement], axis=1))


def neighbours(mesh, displacement):
    """(node of each vertex, first, second node of each pair of neighbours)."""
    n_corners = mesh.cells.shape[1]
    if any(is_constant_per_cell(mesh, u) for u in displacement.T):  # nodes are cells
        node = np.empty(len(mesh.nodes), int)
        node[mesh.cells] = np.arange(len(mesh.cells))[:, None]
        corner = nodes_of(mesh, np.zeros((len(mesh.nodes), 1)))[mesh.cells]
        faces = np.concatenate([np.sort(corner[:, face], axis=1) for face in FACES[n_corners]])
        owner = np.tile(np.arange(len(mesh.cells)), len(FACES[n_corners]))
        key = numbered(faces)
        order = np.argsort(key, kind="stable")
        same = np.flatnonzero(key[order][1:] == key[order][:-1])
        return node, owner[order[same]], owner[order[same + 1]]
    node = nodes_of(mesh, displacement)
    pairs = np.concatenate([node[mesh.cells[:, edge]] for edge in EDGES[n_corners]])
    return node, pairs[:, 0], pairs[:, 1]


def parting(gap, damage_at_ends):
    """How far the two ends of an edge may part without a tear."""
    whole = gap[damage_at_ends < 0.5 * DAMAGED]
    return PARTED * float(np.quantile(whole, 0.9)) if len(whole) else np.inf


def torn(gap, first, second):
    """Which edges are torn: by how far their ends have parted, and the damage of both ends."""
    lower, upper = np.minimum(first, second), np.maximum(first, second)
    return (upper > DAMAGED) & (lower > TOUCHED) & (gap > parting(gap, upper))


def look_for(mesh, displacement, damage):
    """Fragments, or None where nothing has come off."""
    if not np.isfinite(displacement).all() or not (damage > DAMAGED).any():
        return None
    node, first, second = neighbours(mesh, displacement)
    n = int(node.max()) + 1
    u, d = np.empty((n, displacement.shape[1])), np.empty(n)
    u[node], d[node] = displacement, damage
    gap = np.linalg.norm(u[first] - u[second], axis=1)
    held = ~torn(gap, d[first], d[second])
    piece = components(n, first[held], second[held])
    size, moved = np.bincount(piece) / n, np.linalg.norm(u, axis=1)
    farthest = np.zeros(len(size))
    np.maximum.at(farthest, piece, moved)
    large = size >= min(SMALL, size.max())
    flying = ~large & (farthest > FAR * farthest[large].max())
    if not flying.any():
        return None
    return Fragments(flying[piece][node], int(flying.sum()), float(size[flying].sum()),
                     float(farthest[flying].max()))


def find(run, index, model):
    """The fragments of a model at a written time, or None; looked for once."""
    key = ("fragments", index, model)
    if key not in run.found:
        displacement = run.displacement(index, model) if run.dimension > 1 else None
        damage = None if displacement is None else run.field(index, model, "damage", required=False)
        run.found[key] = None if damage is None else look_for(run.mesh(index, model), displacement, damage)
    return run.found[key]


def of_body(run, index, model, values):
    """Values at the vertices of a model, without those of fragments."""
    found = find(run, index, model)
    return values if found is None else values[~found.mask]


def broke(run, index):
    """Whether some model has fields of damage at that time that are not zero."""
    key = ("broke", index)
    if key not in run.found:
        fields = [run.field(index, m, "damage", required=False) for m in run.models
                  if run.field_file(index, m) is not None]
        run.found[key] = any(f is not None and (f > DAMAGED).any() for f in fields)
    return run.found[key]
