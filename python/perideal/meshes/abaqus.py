# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Input files of Abaqus and CalculiX (.inp): nodes, elements, *NSET, *ELSET, *SURFACE, parts and instances. What is no mesh is passed over."""

import os
import re
from dataclasses import dataclass, field

import numpy as np

from .mesh import Block, Fault, HEXAHEDRON, LINE, Mesh, Numbering, PYRAMID, QUADRILATERAL, TETRAHEDRON, TRIANGLE, WEDGE

_SOLID = re.compile(r"(C3D|DC3D|DCC3D|AC3D|Q3D|COH3D|SC|CSS|F3D)(\d+)")
_PLANE = re.compile(r"(CPS|CPE|CPEG|CAX|CGAX|DC2D|DCC2D|DCAX|AC2D|ACAX|Q2D|STRI|S|DS|M3D|R3D|R2D|SFM3D|COH2D|F2D|WARP2D)(\d+)")
_LINE = re.compile(r"(B2|B3|T2D|T3D|PIPE2|PIPE3|DC1D|SAX|RAX|R2D|AC1D|FAX|F2D|MAX)(\d)")
_SOLIDS = {4: TETRAHEDRON, 10: TETRAHEDRON, 5: PYRAMID, 13: PYRAMID, 6: WEDGE, 15: WEDGE, 8: HEXAHEDRON, 20: HEXAHEDRON, 27: HEXAHEDRON}
_PLANES = {3: TRIANGLE, 6: TRIANGLE, 4: QUADRILATERAL, 8: QUADRILATERAL, 9: QUADRILATERAL}
_MAKERS = {"NGEN", "NFILL", "NCOPY", "ELGEN", "ELCOPY", "NMAP"}
_MOST_INCLUDED = 50


def shape_of(kind: str):
    """The shape of an element type and its number of nodes, or nothing for what has no shape (springs, masses)."""
    kind = kind.upper()
    if match := _SOLID.match(kind):
        n = int(match[2])
        return (_SOLIDS[n], n) if n in _SOLIDS else None
    if kind.startswith("STRI65"):
        return TRIANGLE, 6
    if kind == "R2D2" or kind.startswith("F2D2"):
        return LINE, 2
    if match := _PLANE.match(kind):
        n = int(match[2][0])
        return (_PLANES[n], n) if n in _PLANES else None
    if match := _LINE.match(kind):
        n = int(match[2])
        if kind.startswith(("B", "PIPE")):  # B21 has 2 nodes, B22 3
            n += 1
        return (LINE, n) if n in (2, 3) else None
    return None


@dataclass
class Scope:
    """What stands within a part or an instance, or outside all of them."""

    nodes: list = field(default_factory=list)  # tables of number, x, y, z
    elements: list = field(default_factory=list)  # shape, table of number and corners
    node_sets: dict = field(default_factory=dict)  # numbers, names of sets, or (instance, numbers)
    element_sets: dict = field(default_factory=dict)
    surfaces: dict = field(default_factory=dict)  # "element" or "node", and words
    matrix: np.ndarray = None
    shift: np.ndarray = None


def read(name: str) -> Mesh:
    """Raises Fault."""
    return _Reader().read(name)


class _Reader:
    def __init__(self):
        self.mesh = Mesh()
        self.outside, self.scope = Scope(), None
        self.parts, self.instances = {}, {}
        self.passed_over, self.skipped = {}, set()
        self.n_included = 0

    def read(self, name: str) -> Mesh:
        self.scope = self.outside
        self._read_file(name)
        self._join()
        for kind, n in self.passed_over.items():
            self.mesh.notes.append(f"{n} elements of type {kind} are left out, which have no shape.")
        return self.mesh

    def _read_file(self, name: str) -> None:
        with open(name, encoding="latin-1") as file:
            lines = file.read().splitlines()
        keyword, options, data, began = None, {}, [], 0
        at = 0
        while at < len(lines):
            line = lines[at].strip()
            at += 1
            if line.startswith("*") and not line.startswith("**"):
                self._take(keyword, options, data, began, name)
                while line.endswith(",") and at < len(lines) and not lines[at].startswith("*"):
                    line += lines[at].strip()
                    at += 1
                keyword, options = _keyword(line)
                data, began = [], at
            elif line and not line.startswith("**"):
                if keyword is None:
                    raise Fault(f"is no input file of Abaqus or CalculiX: line {at} comes before all keywords")
                data.append(line)
        self._take(keyword, options, data, began, name)

    def _take(self, keyword, options, data, line, name) -> None:
        """What a keyword and its lines say."""
        if keyword is None:
            return
        if keyword in _MAKERS:
            self.skipped.add(keyword)
        elif keyword == "INCLUDE" and options.get("INPUT"):
            self.n_included += 1
            if self.n_included > _MOST_INCLUDED:
                raise Fault("includes files without end (*INCLUDE)")
            inner = os.path.join(os.path.dirname(name), options["INPUT"].strip('"'))
            if not os.path.isfile(inner):
                raise Fault(f"includes '{options['INPUT']}' (line {line}), which is not there")
            self._read_file(inner)
        elif take := {"NODE": self._nodes, "ELEMENT": self._elements, "NSET": self._set, "ELSET": self._set, "SURFACE": self._surface,
                      "PART": self._begin, "INSTANCE": self._begin, "ENDPART": self._end, "ENDINSTANCE": self._end}.get(keyword):
            try:
                take(keyword, options, data)
            except (ValueError, OverflowError) as error:
                raise Fault(f"has something else than numbers below *{keyword} in line {line}: {error}") from None

    def _begin(self, keyword, options, data) -> None:
        given = options.get("NAME", "")
        self.scope = Scope()
        if keyword == "PART":
            self.parts[given.upper()] = self.scope
            return
        part = self.parts.get(options.get("PART", "").upper())
        if part is not None:
            self.scope.nodes, self.scope.elements = list(part.nodes), list(part.elements)
            self.scope.node_sets, self.scope.element_sets, self.scope.surfaces = dict(part.node_sets), dict(part.element_sets), dict(part.surfaces)
        if data:
            self.scope.shift = np.array([float(word) for word in _words(data[0])][:3])
        if len(data) > 1:
            numbers = [float(word) for word in _words(data[1])]
            if len(numbers) == 7:
                self.scope.matrix = numbers
        self.instances[given] = self.scope

    def _end(self, keyword, options, data) -> None:
        self.scope = self.outside

    def _nodes(self, keyword, options, data) -> None:
        if not data:
            return
        if options.get("SYSTEM", "R").upper()[:1] != "R":
            raise Fault("gives nodes in cylindrical or spherical coordinates (*NODE, SYSTEM), which are not read")
        width = len(_words(data[0]))
        numbers = _numbers(data, float)
        if len(numbers) == width * len(data) and 2 <= width:
            table = numbers.reshape(-1, width)[:, :4]
        else:
            rows = [[float(word) for word in _words(line)][:4] for line in data]
            if min(map(len, rows)) < 2:
                raise ValueError(f"'{data[0][:40]}' is no node")
            table = np.zeros((len(rows), 4))
            for row, numbers in zip(table, rows):
                row[:len(numbers)] = numbers
        full = np.zeros((len(table), 4))
        full[:, :table.shape[1]] = table
        self.scope.nodes.append(full)
        if options.get("NSET"):
            self.scope.node_sets.setdefault(options["NSET"], []).extend(full[:, 0].astype(np.int64).tolist())

    def _elements(self, keyword, options, data) -> None:
        kind = options.get("TYPE", "")
        found = shape_of(kind)
        if found is None:
            self.passed_over[kind or "?"] = self.passed_over.get(kind or "?", 0) + len(data)
            return
        shape, n = found
        numbers = _numbers(data, np.int64)
        if len(numbers) % (n + 1):
            n_last = len(_words(data[-1])) - 1
            raise Fault(f"has elements of type {kind}, of {n} nodes each, that lack some" + (
                f": the last one has {n_last} (is the file cut short?)" if n_last < n and len(_words(data[0])) == n + 1 else ""))
        table = numbers.reshape(-1, n + 1)
        if n > shape.corners:
            self.mesh.curved += len(table)
        self.scope.elements.append((shape, table[:, :shape.corners + 1]))
        if options.get("ELSET"):
            self.scope.element_sets.setdefault(options["ELSET"], []).extend(table[:, 0].tolist())

    def _set(self, keyword, options, data) -> None:
        name = options.get(keyword, "")
        members = []
        for line in data:
            words = _words(line)
            if "GENERATE" in options:
                first, last, *step = (int(word) for word in words)
                if last - first > 10 ** 9:
                    raise ValueError(f"'{line[:40]}' generates too many")
                members.extend(range(first, last + 1, max(1, step[0] if step else 1)))
            else:
                members.extend(int(word) if word.isascii() and word.isdigit() else word for word in words)
        if options.get("INSTANCE"):
            members = [(options["INSTANCE"], members)]
        sets = self.scope.node_sets if keyword == "NSET" else self.scope.element_sets
        sets.setdefault(name, []).extend(members)

    def _surface(self, keyword, options, data) -> None:
        kind = options.get("TYPE", "ELEMENT").upper()
        if kind in ("ELEMENT", "NODE") and options.get("NAME"):
            self.scope.surfaces[options["NAME"]] = (kind, [_words(line) for line in data])

    def _join(self) -> None:
        """One mesh of all instances; without any, of the parts."""
        scopes = [("", self.outside)]
        scopes += list(self.instances.items()) or list(self.parts.items())
        scopes = [(name, scope) for name, scope in scopes if scope.nodes or scope.elements or scope is self.outside]
        several = sum(bool(scope.elements) for _, scope in scopes) > 1
        joined = {}
        for name, scope in scopes:
            joined[name.upper()] = _Joined(self, scope, "" if not several else name)
        for piece in joined.values():
            piece.take_sets(joined)
        if several:  # numbers of one instance are those of another, too
            self.mesh.numbers = np.arange(1, len(self.mesh.points) + 1)


class _Joined:
    """A scope in the mesh: where its nodes and elements are."""

    def __init__(self, reader: _Reader, scope: Scope, prefix: str):
        self.mesh, self.scope, self.prefix, self.reader = reader.mesh, scope, prefix, reader
        mesh = reader.mesh
        nodes = np.concatenate(scope.nodes) if scope.nodes else np.zeros((0, 4))
        self.first_node, self.first_element = len(mesh.points), mesh.n_elements
        numbers = nodes[:, 0].astype(np.int64)
        self.nodes = Numbering(numbers, "node")
        mesh.points = np.concatenate([mesh.points, _moved(nodes[:, 1:], scope)])
        mesh.numbers = np.concatenate([mesh.numbers, numbers])
        hint = f" (nodes and elements that *{sorted(reader.skipped)[0]} makes are not read)" if reader.skipped else ""
        for shape, table in scope.elements:
            try:
                rows = self.nodes.rows(table[:, 1:], "an element") + self.first_node
            except Fault as fault:
                raise Fault(f"{fault}{hint}") from None
            mesh.blocks.append(Block(shape, table[:, 0], rows))
        self.elements = Numbering(np.concatenate([table[:, 0] for _, table in scope.elements]) if scope.elements else np.zeros(0, dtype=np.int64),
                                  "element")

    def _members(self, sets: dict, numbering: Numbering, first: int, name: str, joined: dict, depth: int = 0):
        """Rows of a set."""
        by_upper = {key.upper(): value for key, value in sets.items()}
        numbers, rows = [], []
        for member in by_upper.get(name.upper(), []):
            if isinstance(member, int):
                numbers.append(member)
            elif isinstance(member, tuple):
                other = joined.get(member[0].upper())
                if other is not None:
                    within = {"": [one for one in member[1]]}
                    own = other.scope.node_sets if numbering is self.nodes else other.scope.element_sets
                    rows.append(other._members({**own, **within}, other.nodes if numbering is self.nodes else other.elements,
                                               other.first_node if numbering is self.nodes else other.first_element, "", joined, depth + 1))
            elif depth < 20:
                rows.append(self._members(sets, numbering, first, member, joined, depth + 1))
        rows.append(numbering.rows(np.array(numbers, dtype=np.int64), f"the set '{name}'", forgiving=True) + first)
        return np.unique(np.concatenate(rows))

    def _named(self, name: str) -> str:
        return f"{self.prefix}.{name}" if self.prefix else name

    def take_sets(self, joined: dict) -> None:
        for name in self.scope.node_sets:
            rows = self._members(self.scope.node_sets, self.nodes, self.first_node, name, joined)
            if name and len(rows):
                self.mesh.node_sets[self._named(name)] = rows
        for name in self.scope.element_sets:
            rows = self._members(self.scope.element_sets, self.elements, self.first_element, name, joined)
            if name and len(rows):
                self.mesh.element_sets[self._named(name)] = rows
        for name, (kind, lines) in self.scope.surfaces.items():
            self._take_surface(name, kind, lines, joined)

    def _take_surface(self, name: str, kind: str, lines: list, joined: dict) -> None:
        for words in lines:
            if not words:
                continue
            of_nodes = kind == "NODE"
            target, given = self, words[0]
            if "." in given and given.split(".")[0].upper() in joined:
                target, given = joined[given.split(".")[0].upper()], given.split(".", 1)[1]
            sets = target.scope.node_sets if of_nodes else target.scope.element_sets
            sets = {**sets, "": [int(given) if given.isdigit() else given]}
            rows = target._members(sets, target.nodes if of_nodes else target.elements, target.first_node if of_nodes else target.first_element, "", joined)
            if of_nodes:
                known = self.mesh.node_sets.get(self._named(name), np.zeros(0, dtype=np.int64))
                self.mesh.node_sets[self._named(name)] = np.union1d(known, rows)
            elif len(words) > 1 and re.fullmatch(r"[Ss]\d", words[1]):
                self.mesh.add_faces(self._named(name), rows, np.full(len(rows), int(words[1][1:])), "abaqus")
            elif len(words) > 1 and words[1].upper() in ("SPOS", "SNEG"):
                known = self.mesh.element_sets.get(self._named(name), np.zeros(0, dtype=np.int64))
                self.mesh.element_sets[self._named(name)] = np.union1d(known, rows)
            else:
                self.mesh.notes.append(f"the surface '{name}' is left out: it names no faces (S1, S2, ...).")
                return


def _keyword(line: str):
    """"*Nset, nset=left, generate": its name without blanks, and its options."""
    name, *rest = line[1:].split(",")
    options = {}
    for piece in rest:
        key, _, value = piece.partition("=")
        options[key.strip().upper()] = value.strip().strip('"')
    return name.replace(" ", "").strip().upper(), options


def _words(line: str) -> list:
    return [word.strip().strip('"') for word in line.split(",") if word.strip()]


def _numbers(data: list, kind) -> np.ndarray:
    text = " ".join(data).replace(",", " ")
    if kind is float:
        text = text.replace("D", "E").replace("d", "e")
    return np.array(text.split(), dtype=kind)


def _moved(points: np.ndarray, scope: Scope) -> np.ndarray:
    """Of an instance that is shifted, and then turned about the axis through two points by an angle in degrees."""
    if scope.shift is not None and len(scope.shift):
        points = points + np.pad(scope.shift, (0, 3 - len(scope.shift)))
    if scope.matrix is None:
        return points
    a, b, angle = np.array(scope.matrix[:3]), np.array(scope.matrix[3:6]), np.radians(scope.matrix[6])
    axis = (b - a) / max(np.linalg.norm(b - a), 1e-300)
    way = points - a
    return a + way * np.cos(angle) + np.cross(axis, way) * np.sin(angle) + np.outer(way @ axis, axis) * (1 - np.cos(angle))
