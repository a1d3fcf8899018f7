# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Reads what a run of PeriDeal wrote: summary.json, the tables and the fields.

Nothing here draws. Every fault of the files is a ReportError whose message names the file.
"""

import csv
import json
from pathlib import Path

import h5py
import numpy as np

from words import PHYSICS, Words

MODEL_ORDER = ("finite elements", "peridynamics", "coupled")
EXACT = "exact"
ROUND_OFF = 1e-12  # of coordinates, of the largest of them
BOX_SIDES = ("left", "right", "bottom", "top", "back", "front")
DIFFERENCE = "peridynamics_minus_finite_elements"


class ReportError(Exception):
    """A fault of the files a report is made from; the message is one line."""


class Mesh:
    """Cells with their own copies of the vertices, so that jumps at cracks are kept."""

    def __init__(self, nodes, cells):
        self.nodes = nodes
        self.cells = cells
        self._boxes = None

    @property
    def dimension(self):
        """1, 2 or 3, from the number of vertices of a cell."""
        return {2: 1, 4: 2, 8: 3}[self.cells.shape[1]]

    def boxes(self, chunk=250_000):
        """Lower and upper corners of the boxes around the cells, (M x dim) each."""
        if self._boxes is None:
            lower = np.empty((len(self.cells), self.nodes.shape[1]))
            upper = np.empty_like(lower)
            for start in range(0, len(self.cells), chunk):
                part = slice(start, start + chunk)
                corners = self.nodes[self.cells[part]]
                lower[part] = corners.min(axis=1)
                upper[part] = corners.max(axis=1)
            self._boxes = lower, upper
        return self._boxes

    def same_as(self, other):
        """Whether the other mesh is this one."""
        return (other.nodes.shape == self.nodes.shape and other.cells.shape == self.cells.shape
                and np.array_equal(other.nodes, self.nodes)
                and np.array_equal(other.cells, self.cells))


class Table:
    """Rows of line.csv or probes.csv: value[model][time] = (points, values)."""

    def __init__(self):
        self.data = {}
        self.dimension = 0

    def models(self):
        """Names of the models in the order of the report, the exact solution last."""
        order = {name: i for i, name in enumerate(MODEL_ORDER + (EXACT,))}
        return sorted(self.data, key=lambda name: order.get(name, len(MODEL_ORDER)))

    def times(self):
        """All times, ascending."""
        return sorted({t for of_model in self.data.values() for t in of_model})

    def at(self, model, time):
        """(points, values) of one model at one time, or None."""
        return self.data.get(model, {}).get(time)


def without_round_off(points):
    """Coordinates with zeros where they are zero but for the round-off of the others."""
    return np.where(np.abs(points) <= ROUND_OFF * np.abs(points).max(initial=0), 0.0, points)


def read_scene(path):
    """The entries of a scene file without a file's own errors: {(section, name): text}."""
    try:
        lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return {}
    entries, sections = {}, []
    for line in map(str.strip, lines):
        if line.startswith("subsection "):
            sections.append(line[len("subsection "):].strip())
        elif line == "end":
            del sections[-1:]
        elif line.startswith("set ") and "=" in line:
            name, value = line[len("set "):].split("=", 1)
            entries["/".join(sections), name.strip()] = value.strip()
    return entries


class Run:
    """One output directory."""

    def __init__(self, directory):
        self.directory = Path(directory)
        if not self.directory.is_dir():
            raise ReportError(f"'{directory}' is not a directory")
        self.summary = self._read_summary()
        self.dimension = self._dimension()
        self.words = self._words()
        present = self.summary["models"]
        self.models = [m for m in MODEL_ORDER if m in present]
        self.models += [m for m in present if m not in self.models]
        self.line_columns = self._read_tables("line.csv")
        self.probe_columns = self._read_tables("probes.csv")
        self.line, self.probes = (next(iter(columns.values()), Table())
                                  for columns in (self.line_columns, self.probe_columns))
        self.totals = self._read_totals("totals.csv")
        self.not_finite = {}  # model: first shown time with values that are no numbers
        self._meshes = {}
        self.found = {}  # what others looked for in its fields, by keys of theirs
        self._domain = None
        self._scene = None

    # ---- summary.json ------------------------------------------------------------------

    def _read_summary(self):
        path = self.directory / "summary.json"
        try:
            text = path.read_text(encoding="utf-8")
        except FileNotFoundError:
            raise ReportError(f"'{path}' is missing: is this the output directory of a "
                              "run?") from None
        except (OSError, UnicodeDecodeError) as error:
            raise ReportError(f"'{path}' cannot be read: {error}") from None
        try:
            summary = json.loads(text)
        except json.JSONDecodeError as error:
            raise ReportError(f"'{path}' is not valid JSON: {error}") from None
        if not isinstance(summary, dict):
            raise ReportError(f"'{path}' must hold an object, found {type(summary).__name__}")
        for entry, kind in (("models", dict), ("dimension", int), ("fields", list)):
            if not isinstance(summary.get(entry), kind):
                raise ReportError(f"'{path}' has no proper entry '{entry}'")
        for entry in summary["fields"]:
            if not isinstance(entry, dict) or not isinstance(entry.get("files"), dict) \
                    or not isinstance(entry.get("time"), (int, float)):
                raise ReportError(f"'{path}': every entry of 'fields' needs a 'time' and 'files', "
                                  f"found {json.dumps(entry)[:80]}")
        for model, entry in summary["models"].items():
            if not isinstance(entry, dict):
                raise ReportError(f"'{path}': the model '{model}' must hold an object")
        if not summary["models"] and summary.get("status", "complete") == "complete":
            raise ReportError(f"'{path}' names no model")
        return summary

    @property
    def unfinished(self):
        """What a reader has to know of a run that is not complete, as a sentence; empty if it is."""
        status, message = self.get("status", default="complete"), self.get("message", default="")
        if status == "complete":
            return ""
        if status == "running":
            return "This run is not finished: it goes on, or it was killed. The page shows what it had written."
        start = "This run ended early" if status == "diverged" else "This run was stopped before its end"
        return f"{start}: {message.rstrip('.') or status}. The page shows what it had written until then."

    @property
    def end_time(self):
        """Up to when there are results: the end time of the scene, or the last time of a run that did not get there."""
        end = self.get("end time")
        times = [pair[0] for of_quantity in self.totals.values() for pairs in of_quantity.values() for pair in pairs]
        return max(times) if self.unfinished and times else end

    def _dimension(self):
        dimension = self.summary["dimension"]
        if dimension not in (1, 2, 3):
            raise ReportError(f"'{self.directory / 'summary.json'}': dimension must be 1, 2 or 3, "
                              f"found {dimension}")
        return dimension

    def _words(self):
        physics = self.summary.get("physics") or "heat"
        if physics not in PHYSICS and not self.get("names", "field"):
            raise ReportError(f"'{self.directory / 'summary.json'}': physics must be one of "
                              f"{', '.join(PHYSICS)}, found {json.dumps(physics)}")
        return Words(self.summary)

    def get(self, *path, default=None):
        """An entry of summary.json by its path, or the default where it is absent or null."""
        value = self.summary
        for key in path:
            if not isinstance(value, dict) or value.get(key) is None:
                return default
            value = value[key]
        return value

    @property
    def domain(self):
        """Lower and upper corner of the body: of its mesh, or without fields of the summary."""
        if self._domain is None:
            self._domain = self._find_domain()
        return self._domain

    def _find_domain(self):
        for index, entry in enumerate(self.summary["fields"]):
            for model in entry["files"]:
                nodes = self.mesh(index, model).nodes
                if len(nodes):
                    return without_round_off(np.array([nodes.min(axis=0), nodes.max(axis=0)]))
        lower, upper = self.get("domain", "lower"), self.get("domain", "upper")
        if lower and upper:
            return without_round_off(np.array([lower, upper], float))
        raise ReportError(f"'{self.directory / 'summary.json'}' has neither domain nor fields")

    def cracks(self, index=None):
        """Cracks as arrays of points; those of one written time where the run recorded them."""
        cracks = self.get("cracks", default=[])
        if index is not None:
            cracks = self.summary["fields"][index].get("cracks", cracks)
        return [np.array(c, float) for c in cracks if len(c) >= 2]

    def n_cracks(self):
        """Segments that go on where the one before ends are one crack."""
        cracks = self.cracks()
        return len(cracks) - sum(len(a) == len(b) == 2 and bool((a[1] == b[0]).all()) for a, b in zip(cracks, cracks[1:]))

    def cracks_text(self, index):
        """What tells the cracks of one written time from those of another."""
        return json.dumps(self.summary["fields"][index].get("cracks"))

    def sides(self, brief=False):
        """What holds on each side: {side: text}, in the words of the physics."""
        return {side: self.words.condition(text, brief)
                for side, text in self.get("sides", default={}).items()}

    def scene_entry(self, section, name):
        """An entry of the scene as used (scene.prm) as text, empty where it is absent."""
        if self._scene is None:
            self._scene = read_scene(self.directory / "scene.prm")
        return self._scene.get((section, name), "")

    def cracks_on_faces(self):
        """Whether cracks are cut into the mesh."""
        return self.scene_entry("Cracks", "Mesh") == "faces"

    def at_cell_centers(self):
        """Whether nodes lie at cell centres."""
        return any((entry.get("settings") or {}).get("nodes") == "cell centers"
                   for entry in self.summary["models"].values())

    def initial_value(self, point):
        """The initial value at a point of a box where it is a plain number, else None: on sides with given values these hold."""
        try:
            value = float(self.scene_entry("Initial and source", "Initial value"))
        except ValueError:
            return None
        lower, upper = self.domain
        slack = 1e-9 * (upper - lower)
        sides = self.get("sides", default={})
        parts = any(text.startswith("Dirichlet") for side, text in sides.items()
                    if side not in BOX_SIDES[:2 * self.dimension])
        within = any(text.startswith("Dirichlet") and self.get("places", side, "kind") in ("region", "point")
                     for side, text in sides.items())
        given = within or any("Dirichlet" in sides.get(BOX_SIDES[2 * d + k], "") or parts
                    for d in range(self.dimension) for k, end in enumerate((lower, upper))
                    if abs(point[d] - end[d]) <= slack[d])
        return value if not given and self.get("domain", "shape") == "box" else None

    # ---- fields ------------------------------------------------------------------------

    def field_file(self, index, model):
        """Path of the fields of a model at the written time of that index, or None."""
        name = self.summary["fields"][index].get("files", {}).get(model)
        return None if name is None else self.directory / name

    def _open(self, path):
        if not path.is_file():
            raise ReportError(f"'{path}' is missing, though summary.json names it")
        try:
            return h5py.File(path, "r")
        except OSError as error:
            raise ReportError(f"'{path}' is not a readable HDF5 file: {error}") from None

    def mesh(self, index, model):
        """The mesh of a model; read once if it never changes, and shared between models where it is the same."""
        key = (model, index if self.mesh_changes else None)
        if key in self._meshes:
            return self._meshes[key]
        path = self.field_file(index, model)
        with self._open(path) as file:
            for name in ("nodes", "cells"):
                if name not in file:
                    raise ReportError(f"'{path}' has no dataset '{name}'")
            nodes = file["nodes"][()][:, :self.dimension].astype(float, copy=False)
            cells = file["cells"][()]
        if cells.ndim != 2 or cells.shape[1] != 2 ** self.dimension:
            raise ReportError(f"'{path}': cells of a {self.dimension}D run have "
                              f"{2 ** self.dimension} vertices, found shape {cells.shape}")
        if cells.size and cells.max() >= len(nodes):
            raise ReportError(f"'{path}': a cell names vertex {cells.max()} of {len(nodes)}")
        mesh = Mesh(nodes, cells)
        for other in self._meshes.values():
            if other.same_as(mesh):
                mesh = other
                break
        self._meshes[key] = mesh
        return mesh

    @property
    def mesh_is_graded(self):
        """Whether some cells of the lattice are merged."""
        return "mesh" in self.summary

    @property
    def mesh_changes(self):
        """Whether each written time may have a mesh of its own."""
        return self.summary.get("mesh", {}).get("adaptations", 0) > 0

    def field(self, index, model, name, required=True):
        """Values of a field at the vertices, (N) or (N x 3); None if absent and not required."""
        if name in self.words.parts:
            return self._part(index, model, *self.words.parts[name], required)
        path = self.field_file(index, model)
        if path is None:
            return None
        with self._open(path) as file:
            if name not in file:
                if required:
                    raise ReportError(f"'{path}' has no dataset '{name}'")
                return None
            values = file[name][()]
        if len(values) != len(self.mesh(index, model).nodes):
            raise ReportError(f"'{path}': dataset '{name}' has {len(values)} rows, "
                              f"the mesh {len(self.mesh(index, model).nodes)} vertices")
        finite = np.isfinite(values)
        if not finite.all():
            values = np.where(finite, values, np.nan)
            if name in (self.words.solution.name, *self.words.solution_parts()):
                self.not_finite.setdefault(model, self.written_times()[index])
        return values[:, 0] if values.ndim == 2 and values.shape[1] == 1 else values

    def _part(self, index, model, name, component, required):
        """A component of a vector, or its length (None)."""
        vectors = self.field(index, model, name, required)
        if vectors is None:
            return None
        vectors = vectors.reshape(len(vectors), -1)
        return np.linalg.norm(vectors, axis=1) if component is None else vectors[:, component]

    def displacement(self, index, model):
        """The displacement at the vertices, (N x dim); None where there is none."""
        if not self.words.elastic:
            return None
        values = self.field(index, model, "displacement", required=False)
        return None if values is None else values.reshape(len(values), -1)[:, :self.dimension]

    def has_field(self, index, name):
        """Whether some model wrote a field at that time."""
        return any(self.field_file(index, m) is not None
                   and self.field(index, m, name, required=False) is not None
                   for m in self.models)

    def solution(self, index, model):
        """The temperature, wetness or potential at the vertices."""
        return self.field(index, model, self.words.solution.name)

    def written_times(self):
        """Times of the written fields."""
        return [float(entry["time"]) for entry in self.summary["fields"]]

    def shown_indices(self, at_most):
        """Indices of up to so many written times, spread evenly, the last one included."""
        n = len(self.summary["fields"])
        first = 1 if n > 1 and self.written_times()[0] == 0 else 0  # the start is for films
        if n - first <= at_most:
            return list(range(first, n))
        return sorted({int(round(i)) for i in np.linspace(first, n - 1, at_most)})

    # ---- tables ------------------------------------------------------------------------

    def _rows(self, name, columns):
        """Rows of a csv file that may be absent, with its header checked for the columns."""
        path = self.directory / name
        if not path.is_file():
            return [], []
        with open(path, newline="", encoding="utf-8") as file:
            lines = file.read().splitlines(keepends=True)
        if lines and not lines[-1].endswith("\n"):  # the run was killed while it wrote the last one
            lines.pop()
        rows = list(csv.reader(lines))
        if not rows:
            return [], []
        header = [h.strip() for h in rows[0]]
        for column in columns:
            if column not in header:
                raise ReportError(f"'{path}' has no column '{column}'; its header is "
                                  f"'{','.join(header)}'")
        for number, row in enumerate(rows[1:], 2):
            if row and len(row) != len(header):
                raise ReportError(f"'{path}' line {number}: {len(row)} entries, "
                                  f"the header has {len(header)}")
        return header, [row for row in rows[1:] if row]

    def _read_tables(self, name):
        """{column: Table} of the columns that hold values; scalar physics have `value` alone."""
        header, rows = self._rows(name, ("time", "model", "x"))
        if not rows:
            return {}
        axes = [header.index(a) for a in "xyz" if a in header]
        columns = [i for i, h in enumerate(header) if h not in ("time", "model", "x", "y", "z")]
        time, model = header.index("time"), header.index("model")
        collected = {}
        for number, row in enumerate(rows, 2):
            try:
                numbers = [float(row[a]) for a in axes + columns]
                key = (row[model].strip(), float(row[time]))
            except ValueError as error:
                raise ReportError(f"'{self.directory / name}' line {number}: {error}") from None
            collected.setdefault(key, []).append(numbers)
        tables = {header[column]: Table() for column in columns}
        for (of_model, when), numbers in collected.items():
            numbers = np.array(numbers)
            numbers[:, :len(axes)] = without_round_off(numbers[:, :len(axes)])
            for i, table in enumerate(tables.values(), len(axes)):
                table.dimension = len(axes)
                table.data.setdefault(of_model, {})[when] = (numbers[:, :len(axes)], numbers[:, i])
        return tables

    def _read_totals(self, name):
        """totals[quantity][model] = list of (time, value)."""
        header, rows = self._rows(name, ("time", "model", "quantity", "value"))
        totals = {}
        for number, row in enumerate(rows, 2):
            entry = dict(zip(header, row))
            try:
                pair = (float(entry["time"]), float(entry["value"]))
            except ValueError as error:
                raise ReportError(f"'{self.directory / name}' line {number}: {error}") from None
            of_quantity = totals.setdefault(entry["quantity"].strip(), {})
            of_quantity.setdefault(entry["model"].strip(), []).append(pair)
        return totals
