# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Every number of every scene of prm/, recorded by one build and compared with those of another: for changes that must not change results.

    baseline.py record FILE [FOLDER of prm ...]      run the scenes on a coarse lattice, write their numbers to FILE (.json.gz)
    baseline.py compare FILE OTHER [TOLERANCE]       what differs by more than TOLERANCE (1e-12), scene by scene
    baseline.py selftest                             the same scene twice is the same to the last bit, another number is found

The numbers are those of summary.json (but for times, memory and versions), probes.csv, totals.csv and the other tables, and the sum, the extremes
and the norm of each field at the end. Relative differences are to the largest absolute value of the same column, block or field. The program is
$PERIDEAL_EXECUTABLE; scenes are made small as in coarse_scenes.py. Exit status 1 if anything differs.
"""

import csv
import glob
import gzip
import json
import math
import os
import sys
import tempfile

import h5py

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "scenes"))

from coarse_scenes import TIMEOUT, entries_of, overrides_for  # noqa: E402
from scene_test import SOURCE_DIR, run_scene  # noqa: E402

TIMED = ("wall time", "memory", "peak memory", "memory of mesh", "program", "scene file", "files", "seconds")


def numbers_of(value, path=""):
    """{path: number or text} of a nest of lists and dictionaries, without what depends on the machine."""
    if isinstance(value, dict):
        pairs = [(str(key), item) for key, item in value.items() if key not in TIMED]
    elif isinstance(value, list):
        pairs = [(str(number), item) for number, item in enumerate(value)]
    else:
        return {path: value.replace(SOURCE_DIR, "") if isinstance(value, str) else value}
    found = {}
    for key, item in pairs:
        found.update(numbers_of(item, f"{path}/{key}" if path else key))
    return found


def table_of(path):
    """{column: list of numbers} of a table."""
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    columns = {}
    for k, name in enumerate(rows[0]):
        if not any(word in name for word in TIMED):
            columns[name] = [number_or_text(row[k]) for row in rows[1:]]
    return columns


def number_or_text(word):
    try:
        return float(word)
    except ValueError:
        return word


def fields_of(path):
    """Sum, extremes and norm of each dataset of a file of fields: independent of the numbering of nodes."""
    found = {}

    def visit(name, item):
        if isinstance(item, h5py.Dataset) and item.dtype.kind == "f" and item.size:
            values = item[()].ravel()
            found[name] = [float(values.sum()), float(values.min()), float(values.max()), float(math.sqrt((values * values).sum()))]

    with h5py.File(path) as file:
        file.visititems(visit)
    return found


def results_of(run):
    """All that is recorded of a run."""
    record = {"status": run.returncode}
    if run.returncode != 0:
        record["message"] = run.stderr.strip().splitlines()[-1:]
    if not os.path.isdir(run.folder):
        return record
    for path in sorted(glob.glob(os.path.join(run.folder, "*.csv"))):
        record[os.path.basename(path)] = table_of(path)
    last = {}
    for path in sorted(glob.glob(os.path.join(run.folder, "fields", "*.h5"))):
        last[os.path.basename(path).rsplit("_", 1)[0]] = path
    for model, path in last.items():
        record[f"fields of {model}"] = fields_of(path)
    summary = os.path.join(run.folder, "summary.json")
    if os.path.exists(summary):
        with open(summary) as file:
            record["summary.json"] = numbers_of(json.load(file))
    return record


def record(path, wanted):
    root = os.path.join(SOURCE_DIR, "prm")
    found = {}
    for scene in sorted(glob.glob(os.path.join(root, "**", "*.prm"), recursive=True)):
        name = os.path.relpath(scene, root)
        if wanted and not any(name.startswith(one) for one in wanted):
            continue
        overrides = {} if name.startswith("failures") else overrides_for(name, entries_of(scene))
        overrides["Output/Fields"] = "hdf5"
        run = run_scene(scene, overrides, check_status=False, timeout=TIMEOUT)
        found[name] = results_of(run)
        print(f"{name}: exit status {run.returncode}", flush=True)
    with gzip.open(path, "wt") as file:
        json.dump(found, file)
    print(f"{len(found)} scenes recorded in {path}")


def differences(first, second, tolerance, place=""):
    """Lines that tell what differs; lists of numbers by their largest difference over the largest absolute value."""
    if isinstance(first, dict) and isinstance(second, dict):
        lines = []
        for key in list(first) + [key for key in second if key not in first]:
            where = f"{place}: {key}" if place else key
            if key not in first or key not in second:
                lines.append(f"{where}: only in the {'second' if key not in first else 'first'}")
            else:
                lines += differences(first[key], second[key], tolerance, where)
        return lines
    if isinstance(first, list) and isinstance(second, list):
        if len(first) != len(second):
            return [f"{place}: {len(first)} and {len(second)} values"]
        numbers = [(a, b) for a, b in zip(first, second) if isinstance(a, float) and isinstance(b, float)]
        scale = max((abs(value) for pair in numbers for value in pair if math.isfinite(value)), default=0.)
        lines = [line for a, b in zip(first, second) for line in one_difference(a, b, scale, tolerance, place)]
        return lines[:1]
    scale = max((abs(value) for value in (first, second) if isinstance(value, (int, float))), default=0.)
    return one_difference(first, second, scale, tolerance, place)


def one_difference(a, b, scale, tolerance, place):
    if a == b:
        return []
    if not all(isinstance(value, (int, float)) and math.isfinite(value) for value in (a, b)):
        return [f"{place}: {a!r} and {b!r}"] if repr(a) != repr(b) else []
    if abs(a - b) <= tolerance * scale:
        return []
    return [f"{place}: {a:.17g} and {b:.17g}, {abs(a - b) / scale:.2e} of the largest"]


def compare(first, second, tolerance):
    with gzip.open(first, "rt") as file:
        one = json.load(file)
    with gzip.open(second, "rt") as file:
        other = json.load(file)
    n_different = 0
    for name in sorted(set(one) | set(other)):
        lines = differences(one.get(name, {}), other.get(name, {}), tolerance)
        n_different += bool(lines)
        for line in lines[:20]:
            print(f"{name}: {line}")
        if len(lines) > 20:
            print(f"{name}: ... and {len(lines) - 20} more")
    print(f"{n_different} of {len(set(one) | set(other))} scenes differ by more than {tolerance:g}")
    return n_different


def selftest():
    """A recording equals another one of the same build; a number changed by 1e-11 of its block is named."""
    wanted = ["heat/convection.prm", "elasticity/bar_1d.prm"]
    with tempfile.TemporaryDirectory() as folder:
        first, second = (os.path.join(folder, name) for name in ("first.json.gz", "second.json.gz"))
        for path in (first, second):
            record(path, wanted)
        assert compare(first, second, 0.) == 0, "two recordings of one build differ"
        with gzip.open(second, "rt") as file:
            changed = json.load(file)
        assert len(changed) == len(wanted), f"of {wanted} only {list(changed)} were recorded"
        values = changed[wanted[0]]["totals.csv"]["value"]
        at = max(range(len(values)), key=lambda k: abs(values[k]))
        values[at] *= 1. + 1e-11
        with gzip.open(second, "wt") as file:
            json.dump(changed, file)
        assert compare(first, second, 1e-12) == 1, "a changed number was not found"
        assert compare(first, second, 1e-10) == 0, "the tolerance was not used"
    print("baseline: passed")


def main():
    words = sys.argv[1:]
    if len(words) >= 2 and words[0] == "record":
        record(words[1], words[2:])
    elif len(words) in (3, 4) and words[0] == "compare":
        sys.exit(1 if compare(words[1], words[2], float(words[3]) if len(words) == 4 else 1e-12) else 0)
    elif words == ["selftest"]:
        selftest()
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()
