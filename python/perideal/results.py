# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""What a run has written: summary.json, tables, fields (doc/results.md)."""

import csv
import json
from functools import cached_property
from pathlib import Path
from typing import Dict, Optional

import numpy as np

from .vtu import read_vtu

Table = Dict[str, np.ndarray]


def read_table(path) -> Table:
    """The columns of a csv file: numbers where all of them are, else texts. Of a file that is not there, none."""
    path = Path(path)
    if not path.is_file():
        return {}
    with open(path, newline="", encoding="utf-8", errors="replace") as file:
        lines = list(csv.reader(file))
    columns = {}
    for k, name in enumerate(lines[0] if lines else ()):
        texts = [line[k] for line in lines[1:] if len(line) == len(lines[0])]  # the last one may not be whole
        try:
            columns[name] = np.array([float(text or "nan") for text in texts])
        except ValueError:
            columns[name] = np.array(texts)
    return columns


def select(table: Table, **wanted) -> Table:
    """The rows in which columns have these values: select(totals, model="peridynamics", quantity="heat content").

    Numbers are compared up to round-off.
    """
    if not table:
        return {}
    rows = np.ones(len(next(iter(table.values()))), dtype=bool)
    for name, value in wanted.items():
        column = table[name]
        rows &= np.isclose(column, value, rtol=1e-9, atol=1e-12) if column.dtype.kind == "f" else column == value
    return {name: column[rows] for name, column in table.items()}


class Results:
    """A folder with the results of a run; each part is read when it is asked for."""

    def __init__(self, folder):
        self.folder = Path(folder)
        self.output = ""  # what the program has said, of perideal.run()
        self.temporary = None  # keeps a temporary folder
        self._fields = {}

    def __repr__(self):
        return f"Results({str(self.folder)!r})"

    @cached_property
    def summary(self) -> dict:
        """summary.json."""
        with open(self.folder / "summary.json", encoding="utf-8", errors="replace") as file:
            return json.load(file)

    @property
    def models(self) -> list:
        """The names of the models that were computed."""
        return list(self.summary["models"])

    def table(self, name: str) -> Table:
        """The columns of NAME.csv."""
        return read_table(self.folder / f"{name}.csv")

    @cached_property
    def probes(self) -> Table:
        """probes.csv: the columns time, model, coordinates and values."""
        return self.table("probes")

    @cached_property
    def line(self) -> Table:
        """line.csv, with the columns of probes.csv."""
        return self.table("line")

    @cached_property
    def totals(self) -> Table:
        """totals.csv: the columns time, model, quantity and value."""
        return self.table("totals")

    @property
    def times(self) -> np.ndarray:
        """The times at which fields were written."""
        return np.array([entry["time"] for entry in self.summary["fields"]], dtype=float)

    def fields(self, model: Optional[str] = None, index: int = -1) -> Dict[str, np.ndarray]:
        """The fields of a model (the first one, if none is named) at one of the times, as they were written.

        "nodes" are the vertices, which each cell has copies of, (N x dim) from HDF5, (N x 3) from vtu; "cells" their numbers; all else is
        values at the vertices, (N) or (N x components). HDF5 is read where there is both. Empty where no fields were written.
        """
        if not self.summary["fields"]:
            return {}
        model = model or self.models[0]
        index = range(len(self.summary["fields"]))[index]
        if (model, index) not in self._fields:
            self._fields[model, index] = self._read_fields(model, index)
        return self._fields[model, index]

    def field(self, name: str, model: Optional[str] = None, index: int = -1) -> np.ndarray:
        """One of fields(). Raises KeyError with the names that there are."""
        fields = self.fields(model, index)
        if name not in fields:
            raise KeyError(f"no field '{name}' of '{model or self.models[0]}'; there are: {', '.join(fields) or 'none'}")
        return fields[name]

    def _read_fields(self, model: str, index: int) -> Dict[str, np.ndarray]:
        path = self.summary["fields"][index]["files"].get(model)
        if path is not None:
            import h5py
            with h5py.File(self.folder / path, "r") as file:
                found = {name: file[name][()] for name in file}
        else:
            path = self.folder / "fields" / f"{model.replace(' ', '_')}_{index:04d}.0.vtu"
            found = read_vtu(path) if path.is_file() else {}
        return {name: values[:, 0] if values.ndim == 2 and values.shape[1] == 1 and name not in ("nodes", "cells") else values
                for name, values in found.items()}


def read(folder) -> Results:
    """The results in a folder that `perideal run` has written. Raises FileNotFoundError where there are none."""
    results = Results(folder)
    if not (results.folder / "summary.json").is_file():
        raise FileNotFoundError(f"'{folder}' has no summary.json: it is not the output directory of a run")
    return results
