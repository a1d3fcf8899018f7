# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Runs the studies of the papers and reads what their rows left behind."""

import csv
import json
import math
import os
import subprocess
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parent.parent.parent
FEM, PD = "finite elements", "peridynamics"


class Missing(Exception):
    """A row of a study that has not been computed."""


class Row:
    """One finished row of a study: its tables, totals and fields."""

    def __init__(self, entry, folder):
        self.name, self.scene, self.entry, self.folder = entry["name"], entry["scene"], entry, folder
        self._tables = {}

    def model(self, name=None):
        """The summary of a model; of the only one if none is named."""
        models = self.entry["models"]
        return models[name or (PD if PD in models else next(iter(models)))]

    def _table(self, name):
        if name not in self._tables:
            data = {}
            with open(self.folder / name, newline="", encoding="utf-8") as file:
                for row in csv.DictReader(file):
                    point = tuple(float(row[a]) for a in "xyz" if a in row)
                    data.setdefault((row["model"], float(row["time"])), []).append((point, float(row["value"])))
            self._tables[name] = data
        return self._tables[name]

    def _at(self, name, time, model):
        data = self._table(name)
        model = model or (PD if any(m == PD for m, _ in data) else FEM)
        times = [t for m, t in data if m == model]
        chosen = max(times) if time is None else min(times, key=lambda t: abs(t - time))
        if time is not None and not math.isclose(chosen, time, rel_tol=1e-9):
            raise Missing(f"{self.name}: {name} has no time {time}")
        return data[model, chosen]

    def line(self, time=None, model=None):
        """(points, values) along the line of the scene; at the last time if none is given."""
        rows = self._at("line.csv", time, model)
        return np.array([p for p, _ in rows]), np.array([v for _, v in rows])

    def probes(self, time=None, model=None):
        """(points, values) at the probes."""
        rows = self._at("probes.csv", time, model)
        return np.array([p for p, _ in rows]), np.array([v for _, v in rows])

    def probe(self, point, time=None, model=None):
        """The value at one probe."""
        for where, value in self._at("probes.csv", time, model):
            if np.allclose(where, point, atol=1e-9):
                return value
        raise Missing(f"{self.name} has no probe at {point}")

    def columns(self, name, columns, model):
        """Arrays of columns of probes.csv or line.csv of one model, in the order of the file."""
        with open(self.folder / name, newline="", encoding="utf-8") as file:
            rows = [row for row in csv.DictReader(file) if row["model"] == model]
        return [np.array([float(row[column]) for row in rows]) for column in columns]

    def totals(self, quantity, model=PD):
        """(times, values) of a quantity in totals.csv."""
        with open(self.folder / "totals.csv", newline="", encoding="utf-8") as file:
            rows = [(float(r["time"]), float(r["value"])) for r in csv.DictReader(file)
                    if r["quantity"] == quantity and r["model"] == model]
        return np.array([t for t, _ in rows]), np.array([v for _, v in rows])

    def field(self, name, time, model=PD):
        """(vertices of cells, values) of a field at a written time."""
        for entry in self.entry.get("fields") or json.loads((self.folder / "summary.json").read_text())["fields"]:
            if math.isclose(entry["time"], time, rel_tol=1e-9):
                with h5py.File(self.folder / entry["files"][model]) as file:
                    return file["nodes"][()].astype(float), file[name][()]
        raise Missing(f"{self.name} has no field at {time}")

    def seconds(self, model=None):
        """Set-up and time stepping of one model."""
        return sum(self.model(model)["wall time"].values())


class Study:
    """The study of one paper: where its file is, and the rows that are finished."""

    def __init__(self, paper, output=None):
        self.paper = paper
        self.file = f"prm/papers/{paper}/study.json"
        self.output = Path(output) / paper if output else ROOT / "output" / "papers" / paper
        self.rows = {}

    def compute(self, program, quick=False, only=(), redo=True):
        """Compute the rows that are not finished yet, of those named here if any (again, with redo), and read them."""
        command = [program, "study", self.file, "--output", str(self.output)]
        command += ["--quick"] if quick else []
        command += [*(["--redo"] if redo else []), "--only", *only] if only else []
        environment = dict(os.environ, OMP_NUM_THREADS="1", OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
        done = subprocess.run(command, cwd=ROOT, env=environment, stdin=subprocess.DEVNULL, check=False)
        if done.returncode != 0:
            raise SystemExit(f"'{' '.join(command)}' ended with exit status {done.returncode}")
        self.read(quick)
        if only and not redo:
            self.rows = {name: row for name, row in self.rows.items() if name in only}

    def read(self, quick):
        """The finished rows; with quick only those that are marked so."""
        marked = {row["name"]: row.get("quick", False) for row in self.listed()}
        data = json.loads((self.output / "study.json").read_text(encoding="utf-8"))
        self.rows = {entry["name"]: Row(entry, self.output / entry["folder"]) for entry in data["rows"]
                     if entry["status"] == "finished" and (not quick or marked.get(entry["name"], False))}

    def listed(self):
        """The rows as the study file lists them."""
        lines = (ROOT / self.file).read_text(encoding="utf-8").splitlines()
        return json.loads("\n".join(line for line in lines if not line.lstrip().startswith("//")))["rows"]

    def __getitem__(self, name):
        if name not in self.rows:
            raise Missing(f"{self.paper}: row '{name}'")
        return self.rows[name]

    def __contains__(self, name):
        return name in self.rows


# ---- measures

def relative_difference(found, exact):
    """||found - exact|| / ||exact|| in the 2-norm: equation 13 of Bobaru (2012), equation 30 of Tan (2020)."""
    found, exact = np.asarray(found), np.asarray(exact)
    return float(np.linalg.norm(found - exact) / np.linalg.norm(exact))


def largest(found, exact):
    """The largest absolute difference."""
    return float(np.max(np.abs(np.asarray(found) - np.asarray(exact))))


def fitted_order(sizes, errors):
    """The exponent of the least-squares line through logarithms, as the papers report rates."""
    return float(np.polyfit(np.log(sizes), np.log(errors), 1)[0])


def extrapolated(coarse, fine):
    """What values at spacings h and h/2 tend to if their error is of first order, as it is at the tips of cracks."""
    return 2 * np.asarray(fine) - np.asarray(coarse)
