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
            self._note_loss(name, n, sizes[name], what)
        return owner

    def _blocks(self, dimension: int):
        """Blocks of this dimension, with the number of their first element."""
        first = 0
        for block in self.mesh.blocks:
            if block.shape.dimension == dimension:
                yield first, block
            first += len(block.numbers)

    def _take_cells(self) -> None:
        group = np.zeros(self.mesh.n_elements, dtype=np.int64)
        inside = np.zeros(len(group), dtype=bool)
        for first, block in self._blocks(self.dimension):
            inside[first:first + len(block.numbers)] = True
        sets = {name: np.unique(rows[inside[rows]]) for name, rows in self.mesh.element_sets.items()}
        sets = {name: rows for name, rows in sets.items() if len(rows)}
        names = _order({name: len(rows) for name, rows in sets.items()})
        for name in names:
            group[sets[name]] = self._number(self.dimension, name)
        for name in names:
            kept = int((group[sets[name]] == self._number(self.dimension, name)).sum())
            self._note_loss(name, kept, len(sets[name]), "elements")
            if kept == 0:
                del self.names[(self.dimension, name)]
        for first, block in self._blocks(self.dimension):
            self.cells[id(block)] = group[first:first + len(block.numbers)]

    def _note_loss(self, name: str, kept: int, n: int, what: str) -> None:
        if kept == 0 and not _ENTITY.fullmatch(name):
            self.mesh.notes.append(f"'{name}' is left out: all of its {n} {what} are in smaller sets, too, and each is in one.")
        elif 0 < kept < n:
            self.mesh.notes.append(f"'{name}' keeps {kept} of its {n} {what}: the others are in smaller sets, too, and each is in one.")

    def _faces(self):
        """Faces of the cells as their corners follow each other, with -1 behind those of a triangle; their sorted corners; how many have each."""
        faces = [np.zeros((0, 4), dtype=np.int64)]
        for _, block in self._blocks(self.dimension):
            for corners in block.shape.abaqus or ((0,), (1,)):
                piece = np.full((len(block.nodes), 4), -1, dtype=np.int64)
                piece[:, :len(corners)] = block.nodes[:, corners]
                faces.append(piece)
        faces = np.concatenate(faces)
        key, first, n = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
        return faces[first], key, n

    def _sides_of_elements(self, key) -> dict:
        """Elements of one dimension less in sets, as faces by the name of the set; those that are no faces of cells are left out."""
        owners, lost = {}, 0
        for first, block in self._blocks(self.dimension - 1):
            padded = np.full((len(block.nodes), 4), -1, dtype=np.int64)
            padded[:, :block.shape.corners] = block.nodes
            padded = np.sort(padded, axis=1)
            both, n = np.unique(np.concatenate([key, np.unique(padded, axis=0)]), axis=0, return_counts=True)
            known = {tuple(row) for row in both[n == 2].tolist()}
            tuples = [tuple(row) for row in padded.tolist()]
            for name, rows in self.mesh.element_sets.items():
                for row in rows[(rows >= first) & (rows < first + len(tuples))] - first:
                    if tuples[row] in known:
                        corners = block.nodes[row].tolist()
                        owners.setdefault(name, {})[tuple(sorted(corners))] = corners
                    else:
                        lost += 1
        if lost:
            self.mesh.notes.append(f"{lost} elements of dimension {self.dimension - 1} in sets are no faces of cells: they are left out.")
        return owners

    def _take_sides(self) -> None:
        sets_of_sides = any(True for _ in self._blocks(self.dimension - 1)) and self.mesh.element_sets
        corners, key, n = self._faces() if self.mesh.node_sets or sets_of_sides else (np.zeros((0, 4), dtype=np.int64),) * 2 + (np.zeros(0),)
        owners = self._sides_of_elements(key) if sets_of_sides else {}
        for name, faces in self.mesh.face_sets.items():
            owners.setdefault(name, {}).update((tuple(sorted(face)), face) for face in faces)
        surface = corners[n == 1]
        cells = [block.nodes for block in self.mesh.blocks if block.shape.dimension == self.dimension]
        for name, rows in self.mesh.node_sets.items():
            within = np.zeros(len(self.mesh.points) + 1, dtype=bool)
            within[rows] = True
            within[-1] = True  # of the corner that a triangle has not
            if self.dimension > 1 and any(within[nodes].all(axis=1).any() for nodes in cells):
                if name not in self.mesh.element_sets:
                    self.mesh.notes.append(f"the set of nodes '{name}' has whole cells: it is no side and left out; give a set of elements for a region.")
                continue
            faces = surface[within[surface].all(axis=1)]
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
