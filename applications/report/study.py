#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Draws the figures of a study and makes DIRECTORY/index.html from DIRECTORY/study.json.

    python3 study.py DIRECTORY

Each figure is DIRECTORY/NAME.png and stands in the page, too. A study that names no figures gets the error, or
without a reference what the runs have found and the wall time, over the first entry that varies; one of `work_precision` gets charts of accuracy against cost, one of `stability` its maps. A fault of the file is told in one line, with
exit status 1.
"""

import argparse
import json
import re
import sys
from html import escape
from pathlib import Path

try:
    import stability
    import tables
    import work_precision
    from page import Page, paragraphs, write_page
    from style import name, plain, prose
    from study_figures import ENTRY_MARK, StudyError, draw, label_of, last_lines, number, title_of
except ImportError as fault:
    sys.exit(f"study: a Python package is missing ({fault}); the figures need numpy, matplotlib and h5py")

# Columns of the table, with how they are written; entries that vary stand before them.
SECONDS, BYTES, NUMBER = tables.seconds, tables.memory, None
COLUMNS = (("model", NUMBER), ("unknowns", NUMBER), ("bonds", NUMBER), ("steps", NUMBER),
           ("operator applications", NUMBER), ("iterations", NUMBER), ("set-up time", SECONDS), ("stepping time", SECONDS),
           ("wall time", SECONDS), ("memory", BYTES), ("peak memory", BYTES), ("relative l2 error", NUMBER),
           ("maximum error", NUMBER), ("imbalance", NUMBER))


def read_study(directory):
    """study.json of a directory."""
    path = Path(directory) / "study.json"
    try:
        study = json.loads(path.read_text(encoding="utf-8"))
    except OSError as fault:
        raise StudyError(f"'{path}' cannot be read: {fault.strerror}") from None
    except ValueError as fault:
        raise StudyError(f"'{path}' is no JSON: {fault}") from None
    for key in ("title", "table", "rows", "entries", "figures"):
        if not isinstance(study, dict) or key not in study:
            raise StudyError(f"'{path}' has no '{key}': it is not from 'perideal study'")
    return study


def varying(study):
    """Entries that differ between rows."""
    return [e for e in study["entries"] if len({str(row["entries"].get(e)) for row in study["rows"]}) > 1]


def default_figures(study):
    """What is drawn where the study names nothing."""
    entries = varying(study)
    if not entries:
        return []
    over = entries[0].split(ENTRY_MARK)[-1]
    has_error = any(number(line.get("relative l2 error")) is not None for line in study["table"])
    charted = [("relative l2 error", True)] if has_error else \
        [(q, False) for q in worth_charting(study)] + [("wall time", True)]
    return [{"name": file_name(y), "title": f"{title_of(y)} over {over}", "x": entries[0], "y": y, "log": log, "lines": []}
            for y, log in charted]


def file_name(column):
    """The column with letters and digits alone."""
    return re.sub(r"[^A-Za-z0-9.]+", "_", column.replace("-", "minus_")).strip("_")


SMALL = {"displacement": 1e-9, "intensity": 0.01}  # beside the largest of the kind


def worth_charting(study, at_most=10):
    """What runs have found, the stresses last, but for what is zero in all of them beside others of its kind."""
    sizes = {}
    for quantity in study.get("quantities", []):
        values = [number(line.get(quantity)) for line in last_lines(study)]
        sizes[quantity] = max((abs(v) for v in values if v is not None), default=0.0)

    def kind(quantity):
        first = quantity.split(" at ")[0]
        return "displacement" if first in ("ux", "uy", "uz") else "intensity" if first.startswith("K_") else quantity

    largest = {k: max(s for q, s in sizes.items() if kind(q) == k) for k in map(kind, sizes)}
    found = [q for q, s in sizes.items() if s > SMALL.get(kind(q), 0.0) * largest[kind(q)]]
    return sorted(found, key=lambda q: q.startswith("von_mises"))[:at_most]


def rows_table(study):
    """The table of all rows, the lines of each under its name."""
    lines = [line for line in last_lines(study) if line["status"] in ("finished", "did not fail")]
    if not lines:
        return ""
    entries = [e for e in varying(study) if e != "Models"]  # the column of the model says it
    found = [(q, NUMBER) for q in worth_charting(study)]
    shown = [(c, kind) for c, kind in COLUMNS + tuple(found) if any(line.get(c) not in (None, "") for line in lines)]
    rows = []
    of_row = {row["name"]: row for row in study["rows"]}
    heading = None
    for line in lines:
        row = of_row[line["name"]]
        if row["row"] != heading:
            heading = row["row"]
            rows.append([escape(heading)])
        text = row["name"][len(heading):].lstrip(", ") or row["name"]
        link = f'<a href="{escape(row["folder"], quote=True)}/summary.json">{escape(text)}</a>'
        cells = [escape(str(line.get(e) or "")) for e in entries]
        for column, kind in shown:
            value = line.get(column)
            value = None if value == "" else value
            cells.append(tables.cell(kind(value) if kind and value is not None else value))
        rows.append([link] + cells)
    header = ["Row"] + [e.split(ENTRY_MARK)[-1] for e in entries] + [label_of(study, c, bare=True) for c, _ in shown]
    return tables.table(header, rows, "numbers study")


def notes(study):
    """Rows that did not end as they should, and those that have not been computed."""
    items = []
    for row in study["rows"]:
        if row["status"] in ("failed", "did not fail"):
            text = f"{row['name']}: {row['status']}" + (f": {row['message']}" if row["message"] else "")
            items.append(f'<li class="warning">{escape(prose(text))}</li>')
        elif row["status"] == "failed as expected":
            items.append(f"<li>{escape(prose(row['name'] + ', failed as expected: ' + row['message']))}</li>")
    missing = [row["name"] for row in study["rows"] if not row["status"]]
    if missing:
        items.append(f"<li>Not computed: {escape('; '.join(missing))}.</li>")
    return f'<ul class="notes">{"".join(items)}</ul>' if items else ""


def header(study):
    """Title and the facts of the study in one line."""
    done = sum(row["status"] in ("finished", "failed as expected") for row in study["rows"])
    processes = sorted({row["processes"] for row in study["rows"] if row.get("processes")})
    facts = [study.get("source"), study.get("program"), f"{plain(done)} of {plain(len(study['rows']))} rows"]
    if processes:
        several = processes[-1] != 1
        facts.append(f"{', '.join(map(str, processes))} process{'es' if several else ''}")
    spans = "".join(f"<span>{escape(str(f))}</span>" for f in facts if f)
    return f"<h1>{escape(study['title'])}</h1><p>{spans}</p>"


def page_of(study, directory):
    """Draws the figures and returns the page."""
    page = Page(directory)
    if about := paragraphs(prose(study.get("text", ""))) + notes(study):
        page.section("The study", "problem")
        page.add(about)
    chart = work_precision.read(directory)
    if chart:
        work_precision.add_to(page, chart)
    figures = study["figures"] or (default_figures(study) if not chart else [])
    drawn = 0
    for wanted in figures:
        figure, remark = draw(study, wanted)
        if figure is None:
            page.add(f"<p>{escape(wanted['title'])}: {escape(remark)}</p>")
            continue
        if not drawn:
            page.section("Figures", "figures")
        page.figure(figure, wanted["name"], remark, True, wanted["title"])
        drawn += 1
    table = rows_table(study)
    if table:
        page.section("Results" if not chart else "All rows", "results")
        page.add("<p>At the end of each run. Times are the smallest of all repeats; memory is that of nodes, bonds and matrices, peak "
                 "memory that of the whole program with all models of a row and what earlier rows have left.</p>")
        page.add(f'<div class="wide">{table}</div>')
    page.section("Files", "files")
    items = "".join(f'<li><a href="{file}">{file}</a></li>' for file in ("study.csv", "study.json", "work_precision.csv", "work_precision.json", "work_precision_in_time.csv")
                    if (Path(directory) / file).is_file())
    page.add(f'<ul class="files">{items}</ul><p>The files of each row are in its folder in rows/.</p>')
    page.add(f"<footer>Written by {escape(study.get('program', 'PeriDeal'))}.</footer>")
    return page.html(study["title"], header(study))


def main(arguments=None):
    """Command line."""
    parser = argparse.ArgumentParser(description="Draws the figures of a study and makes index.html.")
    parser.add_argument("directory", metavar="DIRECTORY")
    options = parser.parse_args(arguments)
    try:
        maps = stability.read(options.directory)
        html = stability.page_of(maps, options.directory) if maps else page_of(read_study(options.directory), options.directory)
        target = Path(options.directory) / "index.html"
        write_page(target, html)
    except (StudyError, OSError) as fault:
        print(f"study: {fault}".replace("\n", " "), file=sys.stderr)
        return 1
    print(target)
    return 0


if __name__ == "__main__":
    sys.exit(main())
