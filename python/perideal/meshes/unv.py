# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Universal files (.unv) of I-DEAS, Salome and others: nodes, elements and groups."""

import numpy as np

from .mesh import Block, Fault, HEXAHEDRON, LINE, Mesh, Numbering, PYRAMID, QUADRILATERAL, TETRAHEDRON, TRIANGLE, WEDGE, lines_of

_ALL = slice(None)
# By descriptor and number of nodes: the shape, where the corners are among the nodes.
_KINDS = {(kind, 2): (LINE, _ALL) for kind in (11, 21, 22, 23, 24)}
_KINDS.update({(kind, 3): (LINE, [0, 2]) for kind in (11, 21, 22, 23, 24)})
_KINDS.update({(kind, 3): (TRIANGLE, _ALL) for kind in (41, 51, 61, 74, 81, 91)})
_KINDS.update({(kind, 6): (TRIANGLE, [0, 2, 4]) for kind in (42, 52, 62, 72, 82, 92)})
_KINDS.update({(kind, 4): (QUADRILATERAL, _ALL) for kind in (44, 54, 64, 71, 84, 94)})
_KINDS.update({(kind, 8): (QUADRILATERAL, [0, 2, 4, 6]) for kind in (45, 55, 65, 75, 85, 95)})
_KINDS.update({(111, 4): (TETRAHEDRON, _ALL), (118, 10): (TETRAHEDRON, [0, 2, 4, 9]), (112, 6): (WEDGE, _ALL), (113, 15): (WEDGE, [0, 2, 4, 9, 11, 13]),
               (115, 8): (HEXAHEDRON, _ALL), (116, 20): (HEXAHEDRON, [0, 2, 4, 6, 12, 14, 16, 18]), (312, 5): (PYRAMID, _ALL)})
_BEAMS = (11, 21, 22, 23, 24)
_GROUPS = {"2467": 4, "2477": 4, "2452": 4, "2435": 4, "2432": 2, "2430": 2, "2429": 2}  # numbers of each member: its kind, its number, ...


def read(name: str) -> Mesh:
    """Raises Fault."""
    lines = lines_of(name)
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
        self.notes, self.left_out = [], []

    def take(self, dataset: str, lines: list) -> None:
        if dataset in ("2411", "781"):
            for k in range(0, len(lines), 2):
                self.nodes.append(int(lines[k].split()[0]))
                self.points.append([_real(word) for word in lines[k + 1].split()[:3]])
        elif dataset == "15":
            for words in (line.split() for line in lines):
                self.nodes.append(int(words[0]))
                self.points.append([_real(word) for word in words[4:7]])
        elif dataset in ("2412", "780"):
            self._take_elements(lines, dataset == "780")
        elif dataset in ("71", "2428", "2417", "752"):
            raise Fault(f"has the dataset {dataset}, an old kind of elements or groups, which is not read: save it by a program of our time")
        elif dataset in _GROUPS:
            self._take_groups(lines, _GROUPS[dataset])
        elif dataset == "164" and len(lines) > 1 and abs(_real(lines[1].split()[0]) - 1) > 1e-9:
            self.notes.append("the file has units of its own (dataset 164): coordinates are taken as they stand there.")

    def _take_elements(self, lines: list, is_old: bool) -> None:
        at = 0
        while at < len(lines):
            head = [int(word) for word in lines[at].split()]
            number, kind, n = head[0], head[1], head[7 if is_old else 5]
            at += 2 if kind in _BEAMS else 1
            words = []
            while len(words) < n:
                words += lines[at].split()
                at += 1
            if (kind, n) in _KINDS:
                self.elements.setdefault((kind, n), []).append((number, [int(word) for word in words[:n]]))
            else:
                self.unknown[kind] = self.unknown.get(kind, 0) + 1
                self.left_out.append(number)

    def _take_groups(self, lines: list, width: int) -> None:
        at = 0
        while at < len(lines):
            head = [int(word) for word in lines[at].split()]
            name, n = lines[at + 1].strip(), head[7]
            at += 2
            words = []
            while len(words) < width * n:
                words += lines[at].split()
                at += 1
            entries = np.array(words[:width * n], dtype=np.int64).reshape(-1, width)
            self.groups.append((name or f"group_{head[0]}", entries[entries[:, 0] == 7, 1], entries[entries[:, 0] == 8, 1]))

    def mesh(self) -> Mesh:
        mesh = Mesh(points=np.zeros((len(self.points), 3)), numbers=np.array(self.nodes, dtype=np.int64))
        for row, point in zip(mesh.points, self.points):
            row[:len(point)] = point
        nodes = Numbering(mesh.numbers, "node")
        for (kind, n), rows in self.elements.items():
            shape, corners = _KINDS[kind, n]
            table = np.array([row[1] for row in rows], dtype=np.int64)[:, corners]
            mesh.curved += len(rows) if n > shape.corners else 0
            mesh.blocks.append(Block(shape, np.array([row[0] for row in rows], dtype=np.int64), nodes.rows(table, "an element")))
        for kind, n in self.unknown.items():
            self.notes.append(f"{n} elements of the descriptor {kind} are left out, which have no shape that is read.")
        mesh.notes = self.notes
        if mesh.blocks:
            elements = Numbering(np.concatenate([block.numbers for block in mesh.blocks]), "element")
            for name, of_nodes, of_elements in self.groups:
                for numbering, members, sets in ((nodes, of_nodes, mesh.node_sets), (elements, of_elements, mesh.element_sets)):
                    rows, missing = numbering.known(members)
                    lost = missing[~np.isin(missing, self.left_out)] if sets is mesh.element_sets else missing
                    if len(lost):
                        mesh.notes.append(f"'{name}' names {len(lost)} nodes or elements that are not there, the first is {lost[0]}.")
                    if len(rows):
                        sets[name] = np.union1d(sets.get(name, np.zeros(0, dtype=np.int64)), rows)
        return mesh


def _real(word: str) -> float:
    return float(word.upper().replace("D", "E"))
