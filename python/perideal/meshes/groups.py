# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Sets of nodes, elements and faces as what a Gmsh file has: each cell and each face of the surface is in one group, points are named."""

import re

import numpy as np

from .mesh import Fault, Mesh, SIDES

MOST_POINTS = 100  # of a set that lies on no face
_ENTITY = re.compile(r"(Point|Line|Curve|Surface|Volume)\d+")  # names that Gmsh gives its entities beside those that people give


class Groups:
    """Numbers of groups by dimension and name, of cells, faces and points."""

    def __init__(self, mesh: Mesh, dimension: int):
        self.mesh, self.dimension = mesh, dimension
        self.names = {}
        self.cells = {}  # group, by block
        self.sides = []  # corners and group
        self.points = []  # node and group
        # Where a file names several materials, these are its regions; one for all of the body says nothing of them.
        self._regions = set(mesh.regions if len(set(mesh.regions.values())) > 1 else ())
        self._beside = set()  # sets of elements that Abaqus/CAE writes for a side
        self._take_cells()
        self._take_sides()

    def _number(self, dimension: int, name: str) -> int:
        """Of a group; a name that is a number keeps it, and one that the file numbers the file's."""
        if (dimension, name) not in self.names:
            used = set(self.names.values())
            own = int(name) if name.isascii() and name.isdigit() and len(name) < 10 else self.mesh.ids.get((dimension == self.dimension, name), 0)
            is_free = own > 0 and own not in {n for (of, _), n in self.names.items() if of == dimension}
            self.names[(dimension, name)] = own if is_free else max(used | set(self.mesh.ids.values()), default=0) + 1
        return self.names[(dimension, name)]

    def _order(self, sizes: dict) -> list:
        """Names of sets, those first that others take things from."""
        return sorted(sizes, key=lambda name: (not _ENTITY.fullmatch(name), name in self._regions, name not in self._beside, -sizes[name], name))

    def _settle(self, owners: dict, what: str) -> dict:
        """Which set each thing is in: the smallest of those that have it. @param owners things by name of the set"""
        owner, sizes = {}, {name: len(things) for name, things in owners.items()}
        for name in self._order(sizes):
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
        mesh = self.mesh
        group = np.zeros(mesh.n_elements, dtype=np.int64)
        inside = np.zeros(len(group), dtype=bool)
        for first, block in self._blocks(self.dimension):
            inside[first:first + len(block.numbers)] = True
        sets = {name: np.unique(rows[inside[rows]]) for name, rows in mesh.element_sets.items()}
        sets = {name: rows for name, rows in sets.items() if len(rows)}
        self._beside = {name for name, rows in sets.items() if name not in mesh.regions and self._lies_beside_nodes(name, rows)}
        names = self._order({name: len(rows) for name, rows in sets.items()})
        for name in names:
            group[sets[name]] = self._number(self.dimension, name)
        for name in names:
            kept = int((group[sets[name]] == self._number(self.dimension, name)).sum())
            self._note_loss(name, kept, len(sets[name]), "elements")
            if kept == 0:
                del self.names[(self.dimension, name)]
        flat = {}
        for block in mesh.blocks:
            if 0 < block.shape.dimension < self.dimension:
                flat[block.shape.name] = flat.get(block.shape.name, 0) + len(block.numbers)
        if flat:
            text = " and ".join(f"{n} {name}s" for name, n in sorted(flat.items()))
            mesh.notes.append(f"{text} are no cells of a mesh of dimension {self.dimension}: they are sides where sets name them.")
        for first, block in self._blocks(self.dimension):
            self.cells[id(block)] = group[first:first + len(block.numbers)]

    def _lies_beside_nodes(self, name: str, rows) -> bool:
        """Whether a set of elements has the name of a set of nodes that has not all of their nodes: Abaqus/CAE writes both for a side that is
        picked, and for a volume both with all nodes."""
        if self.dimension == 1 or name not in self.mesh.node_sets:
            return False
        within = np.zeros(len(self.mesh.points), dtype=bool)
        within[self.mesh.node_sets[name]] = True
        return any(not within[block.nodes[rows[(rows >= first) & (rows < first + len(block.numbers))] - first]].all()
                   for first, block in self._blocks(self.dimension))

    def _note_loss(self, name: str, kept: int, n: int, what: str) -> None:
        others = "in other sets, too, and each is in one: " + ("that of a section, or the smallest." if self._regions and what == "elements" else "the smallest.")
        if kept == 0 and n and not _ENTITY.fullmatch(name):
            self.mesh.notes.append(f"'{name}' is left out: all of its {n} {what} are {others}")
        elif 0 < kept < n:
            self.mesh.notes.append(f"'{name}' keeps {kept} of its {n} {what}: the rest are {others}")

    def _faces(self):
        """Faces of the cells as their corners follow each other, with -1 behind those of a triangle; the element of each; how many have it."""
        faces, elements = [np.zeros((0, 4), dtype=np.int64)], [np.zeros(0, dtype=np.int64)]
        for start, block in self._blocks(self.dimension):
            for corners in block.shape.abaqus or ((0,), (1,)):
                piece = np.full((len(block.nodes), 4), -1, dtype=np.int64)
                piece[:, :len(corners)] = block.nodes[:, corners]
                faces.append(piece)
                elements.append(np.arange(start, start + len(piece)))
        faces, elements = np.concatenate(faces), np.concatenate(elements)
        key = np.sort(faces, axis=1) + 1
        width = len(self.mesh.points) + 2
        one, two = key[:, 0] * width + key[:, 1], key[:, 2] * width + key[:, 3]
        order = np.lexsort((two, one))
        is_first = np.ones(len(order), dtype=bool)
        is_first[1:] = (one[order[1:]] != one[order[:-1]]) | (two[order[1:]] != two[order[:-1]])
        first = np.flatnonzero(is_first)
        return faces[order[first]], elements[order[first]], np.diff(np.append(first, len(order)))

    def _sides_of_elements(self, faces) -> dict:
        """Elements of one dimension less in sets, as faces by the name of the set; those that are no faces of cells are left out."""
        owners, lost = {}, 0
        for first, block in self._blocks(self.dimension - 1):
            within = np.zeros(len(self.mesh.points) + 1, dtype=bool)
            within[block.nodes.ravel()] = True
            within[-1] = True
            near = faces[within[faces].all(axis=1)]
            known = {tuple(corner for corner in row if corner >= 0) for row in np.sort(near, axis=1).tolist()}
            tuples = [tuple(row) for row in np.sort(block.nodes, axis=1).tolist()]
            for sets in (self.mesh.element_sets, self.mesh.shell_sets):
                for name, rows in sets.items():
                    for row in rows[(rows >= first) & (rows < first + len(tuples))] - first:
                        if tuples[row] in known:
                            owners.setdefault(name, {})[tuples[row]] = block.nodes[row].tolist()
                        else:
                            lost += 1
        if lost:
            self.mesh.notes.append(f"{lost} elements of dimension {self.dimension - 1} in sets are no faces of cells: they are left out.")
        return owners

    def _take_sides(self) -> None:
        mesh = self.mesh
        sets_of_sides = any(True for _ in self._blocks(self.dimension - 1)) and (mesh.element_sets or mesh.shell_sets)
        needs_faces = mesh.node_sets or mesh.free_sets or sets_of_sides
        corners, elements, n = self._faces() if needs_faces else (np.zeros((0, 4), dtype=np.int64), np.zeros(0, dtype=np.int64), np.zeros(0))
        owners = self._sides_of_elements(corners) if sets_of_sides else {}
        for name, faces in mesh.face_sets.items():
            kept = [face for face in faces if SIDES[len(face)].dimension == self.dimension - 1]
            if len(kept) < len(faces):
                mesh.notes.append(f"'{name}' names {len(faces) - len(kept)} edges or faces that are no sides of cells of dimension {self.dimension}: they are left out.")
            owners.setdefault(name, {}).update((tuple(sorted(face)), face) for face in kept)
        surface, elements = corners[n == 1], elements[n == 1]
        for name, rows in mesh.free_sets.items():
            _add_faces(owners, name, surface[np.isin(elements, rows)])
        self._take_node_sets(surface, owners)
        self._take_other_elements()
        self._beside = set()
        owner = self._settle(owners, "faces")
        for face, name in owner.items():
            self.sides.append((owners[name][face], self._number(self.dimension - 1, name)))

    def _take_node_sets(self, surface, owners: dict) -> None:
        cells = [block.nodes for _, block in self._blocks(self.dimension)]
        is_corner = np.zeros(len(self.mesh.points), dtype=bool)
        for nodes in cells:
            is_corner[nodes.ravel()] = True
        for name, given in self.mesh.node_sets.items():
            rows = given[is_corner[given]]
            if not len(rows):
                self.mesh.notes.append(f"the set of nodes '{name}' is left out: its nodes are corners of no cell.")
                continue
            within = np.zeros(len(self.mesh.points) + 1, dtype=bool)
            within[rows] = True
            within[-1] = True  # of the corner that a triangle has not
            if self.dimension > 1 and any(within[nodes].all(axis=1).any() for nodes in cells):
                if (self.dimension, name) not in self.names:
                    self.mesh.notes.append(f"the set of nodes '{name}' has whole cells: it is no side and left out; give a set of elements for a region.")
                continue
            faces = surface[within[surface].all(axis=1)]
            if len(faces):
                _add_faces(owners, name, faces)
            elif len(rows) <= MOST_POINTS:
                number = self._number(0 if self.dimension > 1 else self.dimension - 1, name)
                self.points += [(int(row), number) for row in np.unique(rows)]
            else:
                self.mesh.notes.append(f"the set of nodes '{name}' has no face of the surface: it is left out.")

    def _take_other_elements(self) -> None:
        """Sets of elements that are neither cells nor sides: points are named, others are told."""
        lost = {}
        for dimension in range(4):
            for first, block in self._blocks(dimension):
                for sets in (self.mesh.element_sets, self.mesh.shell_sets):
                    for name, rows in sets.items():
                        rows = rows[(rows >= first) & (rows < first + len(block.numbers))] - first
                        if dimension == 0 and self.dimension > 1 and len(rows):
                            number = self._number(0, name)
                            self.points += [(int(row), number) for row in np.unique(block.nodes[rows])]
                        elif (dimension > 0 and dimension < self.dimension - 1) or (sets is self.mesh.shell_sets and dimension >= self.dimension):
                            lost[name] = lost.get(name, 0) + len(rows)
        for name, n in lost.items():
            if n:
                self.mesh.notes.append(f"'{name}' names {n} elements that are neither cells nor sides of cells: they are left out.")


def _add_faces(owners: dict, name: str, faces) -> None:
    found = [tuple(corner for corner in face if corner >= 0) for face in faces.tolist()]
    owners.setdefault(name, {}).update((tuple(sorted(face)), face) for face in found)
