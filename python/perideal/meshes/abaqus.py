# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Input files of Abaqus and CalculiX (.inp): nodes, elements, *NSET, *ELSET, *SURFACE, sections, parts and instances. What is no mesh is passed over."""

import os
import re
from dataclasses import dataclass, field

import numpy as np

from .abaqus_sets import join
from .abaqus_types import is_axisymmetric, is_shell, shape_of
from .mesh import Fault, Mesh, lines_of

_MAKERS = {"NGEN", "NFILL", "NCOPY", "ELGEN", "ELCOPY", "NMAP"}
_JOINTS = {"TIE", "MPC", "EQUATION", "EMBEDDEDELEMENT", "SHELLTOSOLIDCOUPLING"}
_WITH_INPUT = {"NODE", "ELEMENT", "NSET", "ELSET", "SURFACE"}
_DEEPEST = 20  # *INCLUDE within *INCLUDE
_OF_PROGRAMS = re.compile(r"_|INTERNAL_SELECTION|INTERNAL-\d")  # how names that no person gave begin
_EMPTY = re.compile(r",[ \t]*,|^[ \t]*,", re.MULTILINE)  # a field that holds nothing
_OUTSIDE_QUOTES = re.compile(r'(?:[^,"]|"[^"]*"?)+|(?<=,)(?=,)|^(?=,)')


@dataclass
class Scope:
    """What stands within a part or an instance, or outside all of them. Names of sets and surfaces are in capital letters: case does not
    tell them apart."""

    nodes: list = field(default_factory=list)  # tables of number, x, y, z
    elements: list = field(default_factory=list)  # shape, table of number and corners, whether they are shells
    left_out: list = field(default_factory=list)  # numbers of elements of other types
    # By "node" and "element": arrays of numbers, names of sets, and what abaqus_sets makes members of
    sets: dict = field(default_factory=lambda: {"node": {}, "element": {}})
    surfaces: dict = field(default_factory=dict)  # "ELEMENT", "NODE" or "UNION", and fields of lines
    internal: set = field(default_factory=set)  # "node", "element" or "surface", and a name that no person gave
    sections: list = field(default_factory=list)  # set of elements and material
    placing: list = field(default_factory=list)  # the lines of an instance: shift; two points of an axis and an angle
    of_part: str = ""

    def members(self, kind: str, name: str) -> list:
        return self.sets[kind].setdefault(name, [])

    def copy(self) -> "Scope":
        sets = {kind: {name: list(members) for name, members in own.items()} for kind, own in self.sets.items()}
        return Scope(list(self.nodes), list(self.elements), list(self.left_out), sets, dict(self.surfaces), set(self.internal), list(self.sections))


def read(name: str) -> Mesh:
    """Raises Fault."""
    return _Reader().read(name)


class _Reader:
    def __init__(self):
        self.mesh = Mesh()
        self.outside = self.scope = Scope()
        self.parts, self.instances = {}, {}  # by names in capital letters
        self.spelled = {}  # names as they were given first
        self.passed_over, self.joints, self.axisymmetric = {}, set(), 0
        self.keyword, self.options, self.data, self.began = None, {}, [], 0

    def read(self, name: str) -> Mesh:
        self._read_file(name, 0)
        self._take()
        self._note()
        join(self.mesh, self.outside, self.instances or self.parts, self.spelled)
        return self.mesh

    def _note(self) -> None:
        notes = self.mesh.notes
        for name, scope in self.instances.items():  # Abaqus/CAE also writes instances with nodes of their own
            if scope.of_part not in self.parts and not scope.nodes:
                raise Fault(f"has an instance '{self.spelled[name]}' of a part '{scope.of_part}', which is not in the file")
        for kind, n in self.passed_over.items():
            notes.append(f"{n} elements of type {kind} are left out, which have no shape.")
        if self.axisymmetric:
            notes.append(f"{self.axisymmetric} elements are axisymmetric in the file: here they are a plane body.")
        if self.joints:
            notes.append(f"{', '.join(sorted('*' + one for one in self.joints))} of the file joins nodes or parts: that is not read, and what has no nodes in common is apart.")
        used = {scope.of_part for scope in self.instances.values()}
        for part, scope in self.parts.items():
            if self.instances and part not in used and scope.elements:
                notes.append(f"the part '{self.spelled[part]}' has no instance: it is left out.")

    def _read_file(self, name: str, depth: int) -> None:
        """An included file goes on with the lines of the keyword before it."""
        lines, at = lines_of(name), 0
        while at < len(lines):
            line = lines[at].strip()
            at += 1
            if line.startswith("*"):
                if line.startswith("**"):
                    continue
                while line.endswith(",") and at < len(lines) and _goes_on(lines[at]):
                    line += lines[at].strip()
                    at += 1
                keyword, options = _keyword(line)
                if keyword == "INCLUDE" and options.get("INPUT"):
                    if depth == _DEEPEST:
                        raise Fault("includes files without end (*INCLUDE)")
                    self._read_file(_beside(name, options["INPUT"], at), depth + 1)
                    continue
                self._take()
                self.keyword, self.options, self.data, self.began = keyword, options, [], at
                if keyword in _WITH_INPUT and options.get("INPUT"):
                    self._read_file(_beside(name, options["INPUT"], at), depth + 1)
            elif line:
                if self.keyword is None:
                    raise Fault(f"is no input file of Abaqus or CalculiX: line {at} comes before all keywords")
                self.data.append(line)

    def _take(self) -> None:
        """What a keyword and its lines say."""
        keyword, options = self.keyword, self.options
        if keyword is None:
            return
        if keyword in _MAKERS or (keyword == "SYSTEM" and self.data):
            raise Fault(f"makes or moves nodes or elements by *{keyword} (line {self.began}), which is not read: let the program that made it write all of them")
        if keyword in _JOINTS:
            self.joints.add(keyword)
        elif keyword.endswith("SECTION") and keyword != "SURFACESECTION" and options.get("ELSET"):
            self.scope.sections.append((options["ELSET"], options.get("MATERIAL", "")))
        elif take := {"NODE": self._nodes, "ELEMENT": self._elements, "NSET": self._set, "ELSET": self._set, "SURFACE": self._surface,
                      "PART": self._part, "INSTANCE": self._instance, "ENDPART": self._end, "ENDINSTANCE": self._end}.get(keyword):
            try:
                take(keyword, options, self.data)
            except (ValueError, OverflowError) as error:
                raise Fault(f"has something else than numbers below *{keyword} in line {self.began}: {error}") from None

    def _named(self, name: str) -> str:
        """The name of a set, a surface, a part or an instance in capital letters."""
        self.spelled.setdefault(name.upper(), name)
        return name.upper()

    def _part(self, keyword, options, data) -> None:
        self.scope = self.parts[self._named(options.get("NAME", ""))] = Scope()

    def _instance(self, keyword, options, data) -> None:
        part = options.get("PART", "").upper()
        self.scope = self.parts[part].copy() if part in self.parts else Scope()
        self.scope.of_part = part
        self.scope.placing = [[_real(word) for word in _fields(line)] for line in data]
        self.instances[self._named(options.get("NAME", ""))] = self.scope

    def _end(self, keyword, options, data) -> None:
        self.scope = self.outside

    def _nodes(self, keyword, options, data) -> None:
        if not data:
            return
        if options.get("SYSTEM", "R").upper()[:1] != "R":
            raise Fault("gives nodes in cylindrical or spherical coordinates (*NODE, SYSTEM), which are not read")
        width = len(_fields(data[0]))
        text = "\n".join(data)
        are_alike = len({line.count(",") for line in data}) == 1 and not _EMPTY.search(text)
        numbers = _numbers(text, float) if are_alike else []
        if len(numbers) == width * len(data) and 2 <= width:
            table = numbers.reshape(-1, width)[:, :4]
        else:
            rows = [[_real(word) for word in _fields(line)][:4] for line in data]
            if min(map(len, rows)) < 2:
                raise ValueError(f"'{data[0][:40]}' is no node")
            table = np.zeros((len(rows), 4))
            for row, numbers in zip(table, rows):
                row[:len(numbers)] = numbers
        full = np.zeros((len(table), 4))
        full[:, :table.shape[1]] = table
        self.scope.nodes.append(full)
        if options.get("NSET"):
            self.scope.members("node", self._named(options["NSET"])).append(full[:, 0].astype(np.int64))

    def _elements(self, keyword, options, data) -> None:
        kind = options.get("TYPE", "")
        found = shape_of(kind)
        if found is None:
            numbers = np.array([int(first) for first in (line.split(",")[0].strip() for line in data) if first.isdigit()], dtype=np.int64)
            self.passed_over[kind or "?"] = self.passed_over.get(kind or "?", 0) + len(data)
            self.scope.left_out.append(numbers)
        else:
            shape, n = found
            _check_lengths(data, n + 1, kind, self.began)
            numbers = _numbers("\n".join(data), np.int64)
            if len(numbers) % (n + 1):
                raise ValueError(f"'{data[0][:40]}' is no element of {n} nodes")
            table = numbers.reshape(-1, n + 1)
            self.mesh.curved += len(table) if n > shape.corners else 0
            self.axisymmetric += len(table) if is_axisymmetric(kind) else 0
            self.scope.elements.append((shape, table[:, :shape.corners + 1], is_shell(kind)))
            numbers = table[:, 0]
        if options.get("ELSET"):
            self.scope.members("element", self._named(options["ELSET"])).append(numbers)

    def _set(self, keyword, options, data) -> None:
        kind = "node" if keyword == "NSET" else "element"
        name = self._named(options.get(keyword, ""))
        members = []
        if kind == "node" and options.get("ELSET"):
            members.append(("elements", options["ELSET"]))
        elif "GENERATE" in options:
            for line in data:
                first, last, *step = (int(word) for word in _fields(line) if word)
                if len(step) > 1 or last - first > 10 ** 9:
                    raise ValueError(f"'{line[:40]}' is no range of numbers")
                members.append(np.arange(first, last + 1, max(1, step[0] if step else 1)))
        else:
            words = [word for line in data for word in _fields(line) if word]
            members.append(np.array([word for word in words if word.isascii() and word.isdigit()], dtype=np.int64))
            members += [word for word in words if not (word.isascii() and word.isdigit())]
        if options.get("INSTANCE"):
            members = [("instance", options["INSTANCE"], members)]
        known = name in self.scope.sets[kind]
        self.scope.members(kind, name).extend(members)
        if not known and _is_internal(name, options):
            self.scope.internal.add((kind, name))

    def _surface(self, keyword, options, data) -> None:
        kind = options.get("TYPE", "ELEMENT").upper()
        kind = options.get("COMBINE", kind).upper()
        if kind in ("ELEMENT", "NODE", "UNION", "INTERSECTION", "DIFFERENCE") and options.get("NAME"):
            name = self._named(options["NAME"])
            self.scope.surfaces[name] = (kind, [_fields(line) for line in data])
            if _is_internal(name, options):
                self.scope.internal.add(("surface", name))


def _is_internal(name: str, options: dict) -> bool:
    """Made by Abaqus/CAE or PrePoMax for what a person picked, and not named by one."""
    return "INTERNAL" in options or _OF_PROGRAMS.match(name) is not None


def _check_lengths(data: list, n: int, kind: str, began: int) -> None:
    """Elements have so many numbers each, in one line or in several. Raises Fault."""
    lengths = [line.count(",") + (not line.endswith(",")) for line in data]
    if lengths.count(n) == len(lengths) and not _EMPTY.search("\n".join(data)):
        return
    so_far = 0
    for line, length in zip(data, lengths):
        so_far += length
        if so_far > n or _EMPTY.search(line):
            raise Fault(f"has elements of type {kind}, of {n - 1} nodes each: '{line[:60]}' (below line {began}) is none, or lacks the end of the one before it")
        so_far %= n
    if so_far:
        raise Fault(f"has elements of type {kind}, of {n - 1} nodes each, that lack some: the last one has {max(so_far - 1, 0)} (is the file cut short?)")


def _beside(name: str, given: str, line: int) -> str:
    """The path of a file that another one names."""
    for one in (given, given.replace("\\", "/")):
        path = os.path.join(os.path.dirname(name), one)
        if os.path.isfile(path):
            return path
    raise Fault(f"includes '{given}' (line {line}), which is not there")


def _goes_on(line: str) -> bool:
    """Whether a line goes on with the options of the keyword before it, whose line ends with a comma; data has no such words."""
    first = line.split(",")[0].strip()
    return not line.startswith("*") and ("=" in first or first.upper() in ("GENERATE", "INTERNAL", "UNSORTED"))


def _keyword(line: str):
    """"*Nset, nset=left, generate": its name without blanks, and its options."""
    name, *rest = _fields(line[1:], keep_quotes=True)
    options = {}
    for piece in rest:
        key, _, value = piece.partition("=")
        options[key.replace(" ", "").strip().upper()] = value.strip().strip('"')
    return name.replace(" ", "").strip().upper(), options


def _fields(line: str, keep_quotes: bool = False) -> list:
    """What stands between commas, also nothing; a comma at the end of a line ends nothing."""
    pieces = line.split(",") if '"' not in line else _OUTSIDE_QUOTES.findall(line)
    if pieces and not pieces[-1].strip():
        pieces.pop()
    return [piece.strip() if keep_quotes else piece.strip().strip('"') for piece in pieces]


def _real(word: str) -> float:
    return float(word.upper().replace("D", "E")) if word else 0.0


def _numbers(text: str, kind) -> np.ndarray:
    text = text.replace(",", " ")
    if kind is float:
        text = text.replace("D", "E").replace("d", "e")
    return np.array(text.split(), dtype=kind)
