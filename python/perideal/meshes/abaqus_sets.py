# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""One mesh of the parts and instances of an input file of Abaqus or CalculiX, with its sets, surfaces and sections."""

import re

import numpy as np

from .mesh import Block, Fault, Mesh, Numbering

_DEEPEST = 20  # sets of sets


def join(mesh: Mesh, outside, instances: dict, spelled: dict) -> None:
    """Fills the mesh. @param outside,instances scopes, the latter by their names in capital letters, as is @p spelled, which has names as they
    were given. Raises Fault."""
    scopes = [("", outside)] + list(instances.items())
    several = sum(bool(scope.elements) for _, scope in scopes) > 1
    joined = {}
    for name, scope in scopes:
        joined[name] = _Joined(mesh, scope, name, several and name != "", joined, spelled)
    for piece in joined.values():
        piece.take_sets()
    for piece in joined.values():
        piece.take_sections()
    if several:  # numbers of one instance are those of another, too
        mesh.numbers = np.arange(1, len(mesh.points) + 1)


class _Joined:
    """A scope in the mesh: where its nodes and elements are."""

    def __init__(self, mesh: Mesh, scope, own_name: str, is_prefixed: bool, joined: dict, spelled: dict):
        self.mesh, self.scope, self.joined, self.spelled = mesh, scope, joined, spelled
        self.own_name, self.is_prefixed, self.told = own_name, is_prefixed, set()
        nodes = _without_twins(np.concatenate(scope.nodes) if scope.nodes else np.zeros((0, 4)))
        numbers = nodes[:, 0].astype(np.int64)
        self.first = {"node": len(mesh.points), "element": mesh.n_elements}
        self.numbering = {"node": Numbering(numbers, "node")}
        mesh.points = np.concatenate([mesh.points, _moved(nodes[:, 1:], scope.placing)])
        mesh.numbers = np.concatenate([mesh.numbers, numbers])
        for shape, table, is_shell in scope.elements:
            rows = self.numbering["node"].rows(table[:, 1:], "an element") + self.first["node"]
            mesh.blocks.append(Block(shape, table[:, 0], rows, is_shell))
        self.numbering["element"] = Numbering(np.concatenate([table[:, 0] for _, table, _ in scope.elements]) if scope.elements else np.zeros(0, dtype=np.int64), "element")
        self.left_out = np.concatenate(scope.left_out) if scope.left_out else np.zeros(0, dtype=np.int64)

    def _title(self, name: str) -> str:
        """As people wrote it; with its instance where another one has that name."""
        outer = self.joined[""].scope
        taken = self.own_name and any(name in names for names in (outer.sets["node"], outer.sets["element"], outer.surfaces))
        title = self.spelled.get(name, name)
        return f"{self.spelled[self.own_name]}.{title}" if self.own_name and (self.is_prefixed or taken) else title

    def _find(self, given: str, has) -> tuple:
        """The scope that has a name, which may begin with that of an instance, and the name there."""
        name = given.upper()
        if has(self, name):
            return self, name
        for instance, piece in self.joined.items():
            if instance and name.startswith(instance + ".") and has(piece, name[len(instance) + 1:]):
                return piece, name[len(instance) + 1:]
        return None, name

    def _rows_of_numbers(self, kind: str, numbers: np.ndarray, name: str) -> np.ndarray:
        """Those that are not there are told once."""
        rows, missing = self.numbering[kind].known(numbers)
        is_left_out = np.isin(missing, self.left_out) if kind == "element" else np.zeros(len(missing), dtype=bool)
        if len(missing) and (kind, name) not in self.told:
            self.told.add((kind, name))
            lost = missing[~is_left_out]
            if len(lost):
                self.mesh.notes.append(f"'{self.spelled.get(name, name)}' names {len(lost)} {kind}s that are not there, the first is {lost[0]}.")
            if is_left_out.any():
                self.mesh.notes.append(f"'{self.spelled.get(name, name)}' names {is_left_out.sum()} elements that are left out for their type.")
        return rows + self.first[kind]

    def _rows(self, kind: str, given: str, where: str, depth: int = 0) -> np.ndarray:
        """Rows of a set, or of one node or element by its number."""
        has = lambda piece, name: name in piece.scope.sets[kind] or name.isdigit()
        piece, name = self._find(given, has)
        if piece is None:
            raise Fault(f"has no set of {kind}s '{given}', which {where} names")
        if depth > _DEEPEST:
            raise Fault(f"has sets that name each other in a ring: '{given}' is one of them")
        if name not in piece.scope.sets[kind]:
            return piece._rows_of_numbers(kind, np.array([int(name)]), where.strip("'"))
        return piece._rows_of_members(kind, piece.scope.sets[kind][name], name, depth)

    def _rows_of_members(self, kind: str, members: list, name: str, depth: int) -> np.ndarray:
        rows, where = [np.zeros(0, dtype=np.int64)], f"'{self.spelled.get(name, name)}'"
        for member in members:
            if isinstance(member, np.ndarray):
                rows.append(self._rows_of_numbers(kind, member, name))
            elif isinstance(member, str):
                rows.append(self._rows(kind, member, where, depth + 1))
            elif member[0] == "elements":
                rows.append(self._nodes_of(self._rows("element", member[1], where, depth + 1)))
            else:
                other = self.joined.get(member[1].upper())
                if other is None:
                    raise Fault(f"has no instance '{member[1]}', which {where} names")
                rows.append(other._rows_of_members(kind, member[2], name, depth + 1))
        return np.unique(np.concatenate(rows))

    def _nodes_of(self, elements: np.ndarray) -> np.ndarray:
        first, found = 0, [np.zeros(0, dtype=np.int64)]
        for block in self.mesh.blocks:
            here = elements[(elements >= first) & (elements < first + len(block.numbers))] - first
            found.append(block.nodes[here].ravel())
            first += len(block.numbers)
        return np.unique(np.concatenate(found))

    def take_sets(self) -> None:
        for kind, target in (("node", self.mesh.node_sets), ("element", self.mesh.element_sets)):
            for name, members in self.scope.sets[kind].items():
                rows = self._rows_of_members(kind, members, name, 0)
                if name and len(rows) and (kind, name) not in self.scope.internal:
                    target[self._title(name)] = rows
        for name in self.scope.surfaces:
            if ("surface", name) not in self.scope.internal:
                self._take_surface(name, self._title(name), 0)

    def take_sections(self) -> None:
        """Sets that sections name are regions; those that no person named have the name of their material."""
        for given, material in self.scope.sections:
            rows = self._rows("element", given, "a section")
            piece, name = self._find(given, lambda one, key: key in one.scope.sets["element"])
            if piece is None:  # one element by its number
                continue
            title = piece._title(name)
            if ("element", name) in piece.scope.internal and len(rows):
                title = material if material and (material not in self.mesh.element_sets or material in self.mesh.regions) else title
                self.mesh.element_sets[title] = np.union1d(self.mesh.element_sets.get(title, np.zeros(0, dtype=np.int64)), rows)
            if title in self.mesh.element_sets:
                self.mesh.regions[title] = material.upper()

    def _take_surface(self, name: str, title: str, depth: int) -> None:
        kind, lines = self.scope.surfaces[name]
        if depth > _DEEPEST:
            raise Fault(f"has surfaces that name each other in a ring: '{title}' is one of them")
        if kind not in ("ELEMENT", "NODE", "UNION"):
            self.mesh.notes.append(f"the surface '{title}' is left out: it is a {kind.lower()} of surfaces.")
            return
        if kind == "UNION":
            for given in (one for fields in lines for one in fields if one):
                piece, other = self._find(given, lambda one, key: key in one.scope.surfaces)
                if piece is None:
                    raise Fault(f"has no surface '{given}', which '{title}' names")
                piece._take_surface(other, title, depth + 1)
            return
        left_out = set()
        for fields in lines:
            given, label = (fields + ["", ""])[:2]
            if kind == "NODE":
                known = self.mesh.node_sets.get(title, np.zeros(0, dtype=np.int64))
                self.mesh.node_sets[title] = np.union1d(known, self._rows("node", given, f"'{title}'"))
                continue
            rows = self._rows("element", given, f"'{title}'") if given else np.arange(self.mesh.n_elements)
            if not self._take_faces(title, rows, label.upper()):
                left_out.add(label)
        if left_out:
            self.mesh.notes.append(f"of the surface '{title}' what is on {', '.join(sorted(left_out))} is left out: it names no faces (S1, S2, ...).")

    def _take_faces(self, title: str, rows: np.ndarray, label: str) -> bool:
        """Whether the label is one of faces."""
        if not label:
            known = self.mesh.free_sets.get(title, np.zeros(0, dtype=np.int64))
            self.mesh.free_sets[title] = np.union1d(known, rows)
        elif label in ("SPOS", "SNEG", "POS", "NEG", "P", "N"):
            self.mesh.add_faces(title, rows, np.ones(len(rows)), "shell")
        elif re.fullmatch(r"S\d", label):
            self.mesh.add_faces(title, rows, np.full(len(rows), int(label[1])), "abaqus")
        elif re.fullmatch(r"E\d|EDGE\d", label):
            self.mesh.add_faces(title, rows, np.full(len(rows), int(label[-1]) + 2), "shell")
        else:
            return False
        return True


def _without_twins(nodes: np.ndarray) -> np.ndarray:
    """Nodes that are given again at the same place count once."""
    order = np.argsort(nodes[:, 0], kind="stable")
    ordered = nodes[order]
    again = np.flatnonzero((ordered[1:] == ordered[:-1]).all(axis=1)) + 1
    return np.delete(nodes, order[again], axis=0) if len(again) else nodes


def _moved(points: np.ndarray, placing: list) -> np.ndarray:
    """Of an instance that is shifted, and then turned about the axis through two points by an angle in degrees."""
    for numbers in placing:
        if len(numbers) <= 3:
            points = points + np.pad(np.array(numbers, dtype=float), (0, 3 - len(numbers)))
        elif len(numbers) == 7:
            a, b, angle = np.array(numbers[:3]), np.array(numbers[3:6]), np.radians(numbers[6])
            if not np.linalg.norm(b - a) > 0:
                raise Fault("has an instance that is turned about an axis of no length (*INSTANCE)")
            axis = (b - a) / np.linalg.norm(b - a)
            way = points - a
            points = a + way * np.cos(angle) + np.cross(axis, way) * np.sin(angle) + np.outer(way @ axis, axis) * (1 - np.cos(angle))
        else:
            raise Fault(f"has an instance whose place is given by {len(numbers)} numbers in a line, expected 3 of a shift or 7 of a turn (*INSTANCE)")
    return points
