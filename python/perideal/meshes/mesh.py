# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""A mesh as other programs describe it: nodes, cells by their corners, sets of nodes, elements and faces."""

from dataclasses import dataclass, field

import numpy as np


class Fault(Exception):
    """What is wrong with a file: how the sentence goes on that begins with its name."""


@dataclass(frozen=True)
class Shape:
    """A kind of element: its corners in Gmsh's order, and its faces as other programs number them."""

    name: str
    dimension: int
    corners: int
    gmsh: int  # its number of the first order
    abaqus: tuple = ()
    exodus: tuple = ()


POINT = Shape("point", 0, 1, 15)
LINE = Shape("line", 1, 2, 1)
_AROUND_3 = ((0, 1), (1, 2), (2, 0))
_AROUND_4 = ((0, 1), (1, 2), (2, 3), (3, 0))
TRIANGLE = Shape("triangle", 2, 3, 2, _AROUND_3, _AROUND_3)
QUADRILATERAL = Shape("quadrilateral", 2, 4, 3, _AROUND_4, _AROUND_4)
TETRAHEDRON = Shape("tetrahedron", 3, 4, 4, ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)), ((0, 1, 3), (1, 2, 3), (0, 3, 2), (0, 2, 1)))
PYRAMID = Shape("pyramid", 3, 5, 7, ((0, 1, 2, 3), (0, 4, 1), (1, 4, 2), (2, 4, 3), (3, 4, 0)),
                ((0, 1, 4), (1, 2, 4), (2, 3, 4), (0, 4, 3), (0, 3, 2, 1)))
WEDGE = Shape("wedge", 3, 6, 6, ((0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)),
              ((0, 1, 4, 3), (1, 2, 5, 4), (0, 3, 5, 2), (0, 2, 1), (3, 4, 5)))
HEXAHEDRON = Shape("hexahedron", 3, 8, 5, ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)),
                   ((0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (0, 4, 7, 3), (0, 3, 2, 1), (4, 5, 6, 7)))
SIDES = {1: POINT, 2: LINE, 3: TRIANGLE, 4: QUADRILATERAL}


@dataclass
class Block:
    """Elements of one kind: their numbers in the file, and the rows of their corners."""

    shape: Shape
    numbers: np.ndarray
    nodes: np.ndarray


@dataclass
class Mesh:
    """Rows of nodes are counted from 0, elements through all blocks."""

    points: np.ndarray = field(default_factory=lambda: np.zeros((0, 3)))
    numbers: np.ndarray = field(default_factory=lambda: np.zeros(0, dtype=np.int64))  # of the nodes
    blocks: list = field(default_factory=list)
    node_sets: dict = field(default_factory=dict)  # rows of nodes, by name
    element_sets: dict = field(default_factory=dict)  # counted through all blocks
    face_sets: dict = field(default_factory=dict)  # lists of tuples of corners
    notes: list = field(default_factory=list)
    curved: int = 0  # elements whose middle nodes are left out

    @property
    def n_elements(self) -> int:
        return sum(len(block.numbers) for block in self.blocks)

    def dimension(self) -> int:
        return max((block.shape.dimension for block in self.blocks), default=0)

    def add_faces(self, name: str, elements, sides, numbering: str) -> None:
        """Faces of elements, given by the element and the number of its face from 1, as `abaqus` or `exodus` numbers them."""
        elements, sides = np.asarray(elements, dtype=np.int64), np.asarray(sides, dtype=np.int64)
        first, faces = 0, self.face_sets.setdefault(name, [])
        for block in self.blocks:
            table = getattr(block.shape, numbering)
            here = (elements >= first) & (elements < first + len(block.numbers))
            for side in np.unique(sides[here]):
                if block.shape.dimension > 1 and not 1 <= side <= len(table):
                    raise Fault(f"names face {side} of a {block.shape.name} in '{name}', which has {len(table)}")
                if table:
                    rows = elements[here & (sides == side)] - first
                    faces += [tuple(face) for face in block.nodes[np.ix_(rows, table[side - 1])].tolist()]
            first += len(block.numbers)


class Numbering:
    """Rows of numbers that a file gives to nodes or elements."""

    def __init__(self, numbers, what: str):
        self._order = np.argsort(numbers, kind="stable")
        self._sorted = np.asarray(numbers)[self._order]
        self._what = what
        twice = np.flatnonzero(self._sorted[1:] == self._sorted[:-1])
        if len(twice):
            raise Fault(f"gives {what} {self._sorted[twice[0]]} twice")

    def rows(self, numbers, where: str, forgiving: bool = False) -> np.ndarray:
        """Raises Fault where one is not there, unless those are left out."""
        numbers = np.asarray(numbers)
        if len(self._sorted) == 0:
            if forgiving or numbers.size == 0:
                return np.zeros(0, dtype=np.int64)
            raise Fault(f"has no {self._what} {numbers.flat[0]}, which {where} names")
        at = np.minimum(np.searchsorted(self._sorted, numbers), len(self._sorted) - 1)
        missing = self._sorted[at] != numbers
        if forgiving:
            return self._order[at[~missing]]
        if missing.any():
            raise Fault(f"has no {self._what} {numbers[missing].flat[0]}, which {where} names")
        return self._order[at]
