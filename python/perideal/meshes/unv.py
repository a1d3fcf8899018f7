# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Universal files (.unv) of I-DEAS, Salome and others: nodes, elements and groups."""

import numpy as np

from .mesh import Block, Fault, HEXAHEDRON, LINE, Mesh, Numbering, QUADRILATERAL, TETRAHEDRON, TRIANGLE, WEDGE

_ALL = slice(None)
# By descriptor: the shape, its number of nodes, where the corners are among them.
_KINDS = {kind: (LINE, 2, _ALL) for kind in (11, 21, 22, 23)}
_KINDS.update({kind: (LINE, 3, [0, 2]) for kind in (24,)})
_KINDS.update({kind: (TRIANGLE, 3, _ALL) for kind in (41, 51, 61, 74, 81, 91)})
_KINDS.update({kind: (TRIANGLE, 6, [0, 2, 4]) for kind in (42, 52, 62, 72, 82, 92)})
_KINDS.update({kind: (QUADRILATERAL, 4, _ALL) for kind in (44, 54, 64, 71, 84, 94)})
_KINDS.update({kind: (QUADRILATERAL, 8, [0, 2, 4, 6]) for kind in (45, 55, 65, 75, 85, 95)})
_KINDS.update({111: (TETRAHEDRON, 4, _ALL), 118: (TETRAHEDRON, 10, [0, 2, 4, 9]), 112: (WEDGE, 6, _ALL), 113: (WEDGE, 15, [0, 2, 4, 9, 11, 13]),
               115: (HEXAHEDRON, 8, _ALL), 116: (HEXAHEDRON, 20, [0, 2, 4, 6, 12, 14, 16, 18])})
_BEAMS = (11, 21, 22, 23, 24)
_GROUPS = ("2467", "2477", "2452", "2435", "2432", "2430", "2429", "2428")


def read(name: str) -> Mesh:
    """Raises Fault."""
    with open(name, encoding="latin-1") as file:
        lines = file.read().splitlines()
    reader, at, any_set = _Reader(), 0, False
    try:
        while at < len(lines):
            if lines[at].strip() != "-1":
                at += 1
                continue
            end = at + 2
            while end < len(lines) and lines[end].strip() != "-1":
                end += 1
            if end >= len(lines):
                raise Fault(f"is damaged: the dataset in line {at + 1} has no end")
            any_set = True
            reader.take(lines[at + 1].strip(), lines[at + 2:end])
            at = end + 1
    except (ValueError, IndexError, OverflowError):
        raise Fault(f"is damaged: the dataset in line {at + 1} makes no sense") from None
    if not any_set:
        raise Fault("is no universal file: it has no datasets between lines of -1")
    return reader.mesh()


class _Reader:
    def __init__(self):
        self.nodes, self.points, self.elements, self.groups, self.unknown = [], [], {}, [], {}

    def take(self, dataset: str, lines: list) -> None:
        if dataset in ("2411", "781"):
            for k in range(0, len(lines), 2):
                self.nodes.append(int(lines[k].split()[0]))
                self.points.append([float(word) for word in lines[k + 1].replace("D", "E").replace("d", "e").split()[:3]])
        elif dataset == "2412":
            self._take_elements(lines)
        elif dataset in _GROUPS:
            self._take_groups(lines)

    def _take_elements(self, lines: list) -> None:
        at = 0
        while at < len(lines):
            number, kind, *_, n = (int(word) for word in lines[at].split()[:6])
            at += 2 if kind in _BEAMS else 1
            words = []
            while len(words) < n:
                words += lines[at].split()
                at += 1
            if kind in _KINDS and _KINDS[kind][1] == n:
                self.elements.setdefault(kind, []).append((number, [int(word) for word in words[:n]]))
            else:
                self.unknown[kind] = self.unknown.get(kind, 0) + 1

    def _take_groups(self, lines: list) -> None:
        at = 0
        while at < len(lines):
            head = [int(word) for word in lines[at].split()]
            name, n = lines[at + 1].strip(), head[7]
            at += 2
            words = []
            while len(words) < 4 * n:
                words += lines[at].split()
                at += 1
            entries = np.array(words[:4 * n], dtype=np.int64).reshape(-1, 4)
            self.groups.append((name or f"group_{head[0]}", entries[entries[:, 0] == 7, 1], entries[entries[:, 0] == 8, 1]))

    def mesh(self) -> Mesh:
        mesh = Mesh(points=np.zeros((len(self.points), 3)), numbers=np.array(self.nodes, dtype=np.int64))
        for row, point in zip(mesh.points, self.points):
            row[:len(point)] = point
        nodes = Numbering(mesh.numbers, "node")
        for kind, rows in self.elements.items():
            shape, n, corners = _KINDS[kind]
            table = np.array([row[1] for row in rows], dtype=np.int64)[:, corners]
            mesh.curved += len(rows) if n > shape.corners else 0
            mesh.blocks.append(Block(shape, np.array([row[0] for row in rows], dtype=np.int64), nodes.rows(table, "an element")))
        if mesh.blocks:
            elements = Numbering(np.concatenate([block.numbers for block in mesh.blocks]), "element")
            for name, of_nodes, of_elements in self.groups:
                if len(of_nodes):
                    mesh.node_sets[name] = nodes.rows(of_nodes, f"'{name}'", forgiving=True)
                if len(of_elements):
                    mesh.element_sets[name] = elements.rows(of_elements, f"'{name}'", forgiving=True)
        for kind, n in self.unknown.items():
            mesh.notes.append(f"{n} elements of the descriptor {kind} are left out, which have no shape that is read.")
        return mesh
