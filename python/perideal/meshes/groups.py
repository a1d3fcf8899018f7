# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Sets of nodes, elements and faces as what a Gmsh file has: each cell and each face of the surface is in one group, points are named."""

import re

import numpy as np

from .mesh import Fault, Mesh, SIDES

MOST_POINTS = 100  # of a set that lies on no face
_ENTITY = re.compile(r"(Point|Line|Curve|Surface|Volume)\d+")  # names that Gmsh gives its entities beside those that people give


def _order(sizes: dict) -> list:
    """Names of sets, those first that others take things from."""
    return sorted(sizes, key=lambda name: (not _ENTITY.fullmatch(name), -sizes[name], name))


class Groups:
    """Numbers of groups by dimension and name, of cells, faces and points."""

    def __init__(self, mesh: Mesh, dimension: int):
        self.mesh, self.dimension = mesh, dimension
        self.names = {}
        self.cells = {}  # group, by block
        self.sides = []  # corners and group
        self.points = []  # node and group
        self._take_cells()
        self._take_sides()

    def _number(self, dimension: int, name: str) -> int:
        """Of a group; a name that is a number keeps it."""
        if (dimension, name) not in self.names:
            used = set(self.names.values())
            own = int(name) if name.isascii() and name.isdigit() and len(name) < 10 else 0
            self.names[(dimension, name)] = own if own and own not in {n for (of, _), n in self.names.items() if of == dimension} else max(used, default=0) + 1
        return self.names[(dimension, name)]

    def _settle(self, owners: dict, what: str) -> dict:
        """Which set each thing is in: the smallest of those that have it. @param owners things by name of the set"""
        owner, sizes = {}, {name: len(things) for name, things in owners.items()}
        for name in _order(sizes):
            for thing in owners[name]:
                owner[thing] = name
        kept = dict.fromkeys(owners, 0)
        for name in owner.values():
            kept[name] += 1
        for name, n in kept.items():
            if 0 < n < sizes[name]:
                self.mesh.notes.append(f"'{name}' keeps {n} of its {sizes[name]} {what}: the others are in smaller sets, too, and each is in one.")
            elif n == 0 and sizes[name] > 0:
                self.mesh.notes.append(f"'{name}' is left out: all of its {sizes[name]} {what} are in other sets, too.")
        return owner

    def _take_cells(self) -> None:
        first = 0
        sizes = []
        for block in self.mesh.blocks:
            sizes.append((first, block))
            first += len(block.numbers)
        group = np.zeros(first, dtype=np.int64)
        for dimension in (self.dimension, self.dimension - 1):
            inside = np.zeros(first, dtype=bool)
            for start, block in sizes:
                inside[start:start + len(block.numbers)] = block.shape.dimension == dimension
            sets = {name: np.unique(rows[inside[rows]]) for name, rows in self.mesh.element_sets.items()}
            sets = {name: rows for name, rows in sets.items() if len(rows)}
            names = _order({name: len(rows) for name, rows in sets.items()})
            for name in names:
                group[sets[name]] = self._number(dimension, name)
            for name in names:
                if _ENTITY.fullmatch(name) and len(names) > 1 and not (group[sets[name]] == self._number(dimension, name)).any():
                    del self.names[(dimension, name)]
                    continue
                kept = int((group[sets[name]] == self._number(dimension, name)).sum())
                if kept == 0:
                    self.mesh.notes.append(f"'{name}' is left out: all of its {len(sets[name])} elements are in smaller sets, too, and each is in one.")
                    del self.names[(dimension, name)]
                elif kept < len(sets[name]):
                    self.mesh.notes.append(f"'{name}' keeps {kept} of its {len(sets[name])} elements: the others are in smaller sets, too, and each is in one.")
        for start, block in sizes:
            self.cells[id(block)] = group[start:start + len(block.numbers)]

    def _surface(self):
        """Faces of one cell only, as rows of corners with -1 behind those of a triangle; and the corners as they follow each other."""
        faces = []
        for block in self.mesh.blocks:
            if block.shape.dimension == self.dimension:
                for corners in block.shape.abaqus:
                    piece = np.full((len(block.nodes), 4), -1, dtype=np.int64)
                    piece[:, :len(corners)] = block.nodes[:, corners]
                    faces.append(piece)
        if not faces:
            return np.zeros((0, 4), dtype=np.int64)
        faces = np.concatenate(faces)
        key = np.sort(faces, axis=1)
        _, first, n = np.unique(key, axis=0, return_index=True, return_counts=True)
        return faces[np.sort(first[n == 1])]

    def _take_sides(self) -> None:
        owners = {}
        for name, faces in self.mesh.face_sets.items():
            owners.setdefault(name, {}).update((tuple(sorted(face)), face) for face in faces)
        cells = [block.nodes for block in self.mesh.blocks if block.shape.dimension == self.dimension]
        surface = self._surface() if self.mesh.node_sets and self.dimension > 1 else np.zeros((0, 4), dtype=np.int64)
        for name, rows in self.mesh.node_sets.items():
            within = np.zeros(len(self.mesh.points) + 1, dtype=bool)
            within[rows] = True
            within[-1] = True  # of the corner that a triangle has not
            if self.dimension > 1 and any(within[nodes].all(axis=1).any() for nodes in cells):
                if name not in self.mesh.element_sets:
                    self.mesh.notes.append(f"the set of nodes '{name}' has whole cells: it is no side and left out; give a set of elements for a region.")
                continue
            faces = surface[within[surface].all(axis=1)] if self.dimension > 1 else surface
            if len(faces):
                found = [tuple(corner for corner in face if corner >= 0) for face in faces.tolist()]
                owners.setdefault(name, {}).update((tuple(sorted(face)), face) for face in found)
            elif len(rows) <= MOST_POINTS:
                number = self._number(0 if self.dimension > 1 else self.dimension - 1, name)
                self.points += [(int(row), number) for row in np.unique(rows)]
            else:
                self.mesh.notes.append(f"the set of nodes '{name}' has no face of the surface: it is left out.")
        owner = self._settle(owners, "faces")
        for face, name in owner.items():
            corners = owners[name][face]
            if len(corners) not in SIDES:
                raise Fault(f"has a face of {len(corners)} corners in '{name}'")
            self.sides.append((corners, self._number(self.dimension - 1, name)))
