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

    @property
    def shell(self) -> tuple:
        """Of a shell: its faces in front and behind, and its edges."""
        return (tuple(range(self.corners)),) * 2 + self.abaqus if self.dimension == 2 else ()


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
    is_shell: bool = False  # sides are numbered as Shape.shell


@dataclass
class Mesh:
    """Rows of nodes are counted from 0, elements through all blocks."""

    points: np.ndarray = field(default_factory=lambda: np.zeros((0, 3)))
    numbers: np.ndarray = field(default_factory=lambda: np.zeros(0, dtype=np.int64))  # of the nodes
    blocks: list = field(default_factory=list)
    node_sets: dict = field(default_factory=dict)  # rows of nodes, by name
    element_sets: dict = field(default_factory=dict)  # counted through all blocks
    face_sets: dict = field(default_factory=dict)  # lists of tuples of corners
    shell_sets: dict = field(default_factory=dict)  # elements of which a set has the face
    free_sets: dict = field(default_factory=dict)  # elements of which a set has the faces around the body
    regions: dict = field(default_factory=dict)  # sets of elements that the file gives a material, and that
    ids: dict = field(default_factory=dict)  # numbers that the file gives to sets, by whether they are of elements, and name
    notes: list = field(default_factory=list)
    curved: int = 0  # elements whose middle nodes are left out

    @property
    def n_elements(self) -> int:
        return sum(len(block.numbers) for block in self.blocks)

    def dimension(self) -> int:
        return max((block.shape.dimension for block in self.blocks), default=0)

    def add_faces(self, name: str, elements, sides, numbering: str) -> None:
        """Faces of elements, given by the element and the number of its face from 1, as `abaqus`, `exodus` or `shell` numbers them; shells have
        their own numbers with all of them."""
        elements, sides = np.asarray(elements, dtype=np.int64), np.asarray(sides, dtype=np.int64)
        first, faces = 0, self.face_sets.setdefault(name, [])
        for block in self.blocks:
            table = getattr(block.shape, "shell" if block.is_shell else numbering)
            here = (elements >= first) & (elements < first + len(block.numbers))
            for side in np.unique(sides[here]):
                if block.shape.dimension > 1 and not 1 <= side <= len(table):
                    raise Fault(f"names face {side} of a {block.shape.name} in '{name}', which has {len(table) or 'none of that kind'}")
                rows = elements[here & (sides == side)]
                if table and len(table[side - 1]) == block.shape.corners and block.shape.dimension == 2:
                    self.shell_sets[name] = np.union1d(self.shell_sets.get(name, np.zeros(0, dtype=np.int64)), rows)
                elif table:
                    faces += [tuple(face) for face in block.nodes[np.ix_(rows - first, table[side - 1])].tolist()]
            first += len(block.numbers)


def text_of(data: bytes) -> str:
    """UTF-8, with or without its mark at the beginning, or else Latin 1."""
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")


def lines_of(name: str) -> list:
    """The lines of a text file, whatever ends them."""
    with open(name, "rb") as file:
        return text_of(file.read()).replace("\r\n", "\n").replace("\r", "\n").split("\n")


class Numbering:
    """Rows of numbers that a file gives to nodes or elements."""

    def __init__(self, numbers, what: str):
        self._order = np.argsort(numbers, kind="stable")
        self._sorted = np.asarray(numbers)[self._order]
        self._what = what
        twice = np.flatnonzero(self._sorted[1:] == self._sorted[:-1])
        if len(twice):
            raise Fault(f"gives {what} {self._sorted[twice[0]]} twice")

    def known(self, numbers) -> tuple:
        """Rows of the numbers that are there, and the other numbers."""
        numbers = np.asarray(numbers)
        if len(self._sorted) == 0:
            return np.zeros(0, dtype=np.int64), numbers
        at = np.minimum(np.searchsorted(self._sorted, numbers), len(self._sorted) - 1)
        is_there = self._sorted[at] == numbers
        return self._order[at[is_there]], numbers[~is_there]

    def rows(self, numbers, where: str) -> np.ndarray:
        """Raises Fault where one is not there."""
        numbers = np.asarray(numbers)
        rows, missing = self.known(numbers)
        if len(missing):
            raise Fault(f"has no {self._what} {missing.flat[0]}, which {where} names")
        return rows.reshape(numbers.shape)
