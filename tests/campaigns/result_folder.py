# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""What is wrong with the files in a folder of results, as sentences: torn files, lists of files that are not there, numbers that
are none. Nothing is wrong with a folder in which a run has not yet written anything."""

import csv
import glob
import json
import math
import os
import xml.etree.ElementTree as ElementTree

import h5py

TABLES = ("probes.csv", "line.csv", "grid.csv", "totals.csv")


def _refuse(word):
    raise ValueError(f"{word} is no number")


def read_summary(folder):
    """The summary, or None where there is none. Raises ValueError where it is torn or says nan or inf."""
    path = os.path.join(folder, "summary.json")
    if not os.path.exists(path):
        return None
    with open(path) as file:
        return json.load(file, parse_constant=_refuse)


def status_of(folder):
    summary = read_summary(folder)
    return None if summary is None else summary.get("status")


def nulls_in(value, path=""):
    """Where a summary says null, which stands for a number that is none. Components that are free have no given value, a first solution no estimate."""
    if value is None:
        if not (path.startswith("/values on sides/") and "/displacement/" in path) and path != "/accuracy/steps/0/estimate":
            yield path
    elif isinstance(value, dict):
        for key, part in value.items():
            yield from nulls_in(part, f"{path}/{key}")
    elif isinstance(value, list):
        for k, part in enumerate(value):
            yield from nulls_in(part, f"{path}/{k}")


def _may_be_none(name, row, column):
    """Points of lines outside the body have no values, exact displacements by formulas without a gradient no stresses (doc/results.md)."""
    if row["model"] == "exact" and column in ("sxx", "syy", "szz", "sxy", "sxz", "syz", "von_mises"):
        return True
    return name == "line.csv" and all(text == "nan" for other, text in row.items() if other not in ("time", "model", "x", "y", "z"))


def wrong_numbers(folder):
    """Numbers in the summary and the tables that are not finite, and should be."""
    try:
        read_summary(folder)
    except ValueError as problem:
        yield f"summary.json: {problem}"
    for name in TABLES:
        path = os.path.join(folder, name)
        if not os.path.exists(path):
            continue
        with open(path, newline="") as file:
            for row in csv.DictReader(file):
                for column, text in row.items():
                    if column in ("model", "quantity", "phase"):
                        continue
                    try:
                        finite = math.isfinite(float(text))
                    except (TypeError, ValueError):
                        continue
                    if not finite and not _may_be_none(name, row, column):
                        yield f"{name}: {column} = {text} in {row}"
                        break


def _entries(path, kind, wrong_of):
    """What wrong_of finds in the entries of this kind of a file, or that the file is torn."""
    try:
        root = ElementTree.parse(path).getroot()
    except (ElementTree.ParseError, OSError) as problem:
        yield f"{os.path.basename(path)} ({os.path.getsize(path)} bytes): {problem}"
        return
    for entry in root.iter(kind):
        yield from wrong_of(entry)


def _wrong_pieces(path, seen):
    """A file of pieces (.vtu, .pvtu) that something refers to."""
    if path in seen:
        return
    seen.add(path)
    if not os.path.isfile(path):
        yield f"{os.path.basename(path)} is listed and does not exist"
        return
    beside = os.path.dirname(path)
    yield from _entries(path, "Piece", lambda piece: _wrong_pieces(os.path.join(beside, piece.get("Source")), seen) if piece.get("Source") else ())


def _wrong_data_set(item, folder, files):
    name, _, inside = (item.text or "").strip().partition(":")
    if not name.endswith(".h5"):
        return
    path = os.path.join(folder, name)
    if path not in files:
        files[path] = None
        if not os.path.isfile(path):
            yield f"{name} is listed and does not exist"
            return
        try:
            files[path] = h5py.File(path, "r")
        except OSError as problem:
            yield f"{name} ({os.path.getsize(path)} bytes): {problem}"
            return
    if files[path] is None:
        return
    if inside not in files[path]:
        yield f"{name} has no data set {inside}"
        return
    found = files[path][inside].shape
    files[path][inside][()]
    if math.prod(found) != math.prod(int(number) for number in item.get("Dimensions").split()):
        yield f"{name}{inside} has {found} numbers where {item.get('Dimensions')} are listed"


def wrong_files(folder):
    """What is wrong with the lists of fields and what they refer to, and with the tables."""
    seen, files = set(), {}
    for path in sorted(glob.glob(os.path.join(folder, "*.pvd"))):
        yield from _entries(path, "DataSet", lambda entry: _wrong_pieces(os.path.join(folder, entry.get("file")), seen))
    for path in sorted(glob.glob(os.path.join(folder, "*.xdmf"))):
        yield from _entries(path, "DataItem", lambda item: _wrong_data_set(item, folder, files))
    for file in files.values():
        if file is not None:
            file.close()
    for name in TABLES:
        yield from _torn_table(os.path.join(folder, name))


def _torn_table(path):
    if not os.path.exists(path):
        return
    name = os.path.basename(path)
    with open(path) as file:
        text = file.read()
    if not text:
        return
    if not text.endswith("\n"):
        yield f"{name} ends within a line: {text[-60:]!r}"
    lines = text.splitlines()
    columns = len(next(csv.reader([lines[0]])))
    for line in lines[1:]:
        cells = next(csv.reader([line]))
        if len(cells) != columns:
            yield f"{name}: {len(cells)} cells where the head has {columns}: {line!r}"
            return
        try:
            float(cells[0])
        except ValueError:
            yield f"{name}: no time: {line!r}"
            return


def reaches_its_end(folder):
    """Whether totals.csv has rows of the end time that summary.json names, of every model."""
    with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
        summary = json.load(file)
    with open(os.path.join(folder, "totals.csv"), newline="", encoding="utf-8") as file:
        found = {row["model"] for row in csv.DictReader(file) if float(row["time"]) == summary["end time"]}
    return bool(found) and found == set(summary["models"])


def wrong_results(folder, complete):
    """All of it. complete: whether the run may say that it finished."""
    try:
        status = status_of(folder)
    except ValueError as problem:
        yield f"summary.json: {problem}"
        status = None
    if complete and status not in (None, "complete"):
        yield f"summary.json says {status!r} of a complete run"
    if not complete and status == "complete" and not reaches_its_end(folder):  # else the signal came when all was written
        yield "summary.json says 'complete' of a run that was not"
    if complete and not os.path.exists(os.path.join(folder, "summary.json")):
        yield "no summary.json"
    yield from wrong_files(folder)
