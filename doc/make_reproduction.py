#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Compute the published tables and figures of papers, and write doc/reproduction.md.

    python3 doc/make_reproduction.py                 computes what is not computed yet; writes page, figures, kept values
    python3 doc/make_reproduction.py --quick         only the quick rows; the others keep the values of doc/reproduction.json
    python3 doc/make_reproduction.py --quick --check compares with the kept values and the page, writes nothing
    python3 doc/make_reproduction.py --sample --check the same with the quickest of the quick rows
    python3 doc/make_reproduction.py --page          writes the page from the kept values, computes nothing
    python3 doc/make_reproduction.py --line PAPER/TABLE[/NUMBER]    computes a line or a table again and prints it

The rows are in prm/papers/PAPER/study.json, published numbers in prm/papers/published.json, what is compared with what in
doc/reproduce/PAPER.py. --check allows each number to differ by the tolerance of its table, a share of the largest number of
its line (1e-3 unless the table says otherwise); lines of round-off are held below 1e-9. Times are never compared.
"""

import argparse
import json
import math
import os
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "doc" / "reproduce"))

import bobaru_2010  # noqa: E402
import bobaru_2012  # noqa: E402
import diyaroglu_2017  # noqa: E402
import document  # noqa: E402
import le_2014  # noqa: E402
import tan_2020  # noqa: E402
from results import Missing, Study  # noqa: E402

MODULES = (bobaru_2010, bobaru_2012, tan_2020, diyaroglu_2017, le_2014)
KEPT, PAGE, FIGURES = ROOT / "doc" / "reproduction.json", ROOT / "doc" / "reproduction.md", ROOT / "doc" / "figures" / "reproduction"
ROUND_OFF = 1e-9

# Quick rows that take seconds and are like others: not in the sample.
SLOWER = {
    "bobaru_2010": r"example_2_\w+_m4_\d+|example_1_\w+_m4_[24]00|example_3_(conical_\d+|constant_400)",
    "bobaru_2012": r"example_3_elements_480|example_1_m(5\.2|3\.9)_\d+|table_1_120",
    "tan_2020": r"ours_200|example_2_elements_400|example_3(_uncorrected)?|convergence_100_m\d",
    "diyaroglu_2017": r"example_b(_elements)?|example_c_elements_[12]_400",
    "le_2014": r"hole_2_m5|corner_3|influence_conical_[01]|wire_(single_filament|cross_section)|(soft|hard)_irregular|void_delamination",
}


def sections():
    """The papers, in the order of the page."""
    published = json.loads((ROOT / "prm" / "papers" / "published.json").read_text(encoding="utf-8"))
    return [module.section(published[module.__name__]) for module in MODULES]


def keys(papers):
    """(key, paper, table, line) of every line of the page."""
    return [(f"{paper.key} / {table.key} / {line.what}", paper, table, line)
            for paper in papers for table in paper.tables for line in table.lines]


def sample_of(paper, study):
    """The rows of the lines that need quick rows alone, none of them slower."""
    quick = {row["name"] for row in study.listed() if row.get("quick", False) and not re.fullmatch(SLOWER[paper.key], row["name"])}
    return sorted({name for table in paper.tables for line in table.lines if quick.issuperset(line.needs) for name in line.needs})


def compare(new, old, table):
    """Whether values agree within the tolerance of their table."""
    if len(new) != len(old):
        return False
    if table.tolerance is None:  # nothing but errors of solvers: only their size matters
        return all(abs(value) <= max(ROUND_OFF, 10 * abs(kept)) for value, kept in zip(new, old))
    scale = max((abs(v) for v in old), default=0.0)
    return all(math.isfinite(a) and abs(a - b) <= table.tolerance * scale for a, b in zip(new, old))


def check(papers, found, kept, text):
    """Print what differs; the number of differences."""
    faults = 0
    for key, _, table, _ in keys(papers):
        if key not in kept:
            print(f"FAILED: {key}: no kept value; run doc/make_reproduction.py")
            faults += 1
        elif key in found and not compare(found[key]["values"], kept[key]["values"], table):
            print(f"FAILED: {key}: {found[key]['values']} where {kept[key]['values']} was kept, tolerance {table.tolerance}")
            faults += 1
    if not PAGE.is_file() or PAGE.read_text(encoding="utf-8") != text:
        print("FAILED: doc/reproduction.md is not what doc/make_reproduction.py --page writes")
        faults += 1
    print(f"{len(found)} of {len(kept)} lines computed and compared, {faults} differences")
    return faults


def again(papers, wanted, program, output):
    """Compute the runs of a line or of a table and print published and obtained numbers."""
    paper_key, table_key, *place = wanted.split("/")
    paper = next((p for p in papers if p.key == paper_key), None)
    table = next((t for t in paper.tables if t.key == table_key), None) if paper else None
    if table is None or len(place) > 1 or (place and not (place[0].isdigit() and 0 < int(place[0]) <= len(table.lines))):
        names = [f"{p.key}/{t.key}" for p in papers for t in p.tables]
        raise SystemExit(f"make_reproduction: '--line {wanted}' names no line; tables are\n  " + "\n  ".join(names))
    lines = [table.lines[int(place[0]) - 1]] if place else table.lines
    study = Study(paper.key, output)
    study.compute(program, only=sorted({name for line in lines for name in line.needs}))
    print(f"{table.source}: {', '.join(table.columns)}")
    for line in lines:
        entry = line.evaluate(study)
        published = document.printed(line.published) if line.published else "a picture"
        print(f"  {line.what}: published {published}; obtained {document.list_of(entry['values'], table.digits)}; {entry['bonds']:,} bonds, "
              f"{entry['seconds']:g} s")


def draw(papers, studies):
    """Figures whose rows are there."""
    for paper, study in zip(papers, studies):
        for picture in paper.pictures:
            if picture.draw is None or any(name not in study for name in picture.needs):
                continue
            picture.draw(study, FIGURES / f"{picture.name}.png")
            print(f"doc/figures/reproduction/{picture.name}.png", flush=True)


def main():
    """Command line."""
    parser = argparse.ArgumentParser(description="Compute the published tables and figures, and write doc/reproduction.md.")
    parser.add_argument("--program", default=os.environ.get("PERIDEAL_EXECUTABLE", str(ROOT / "build/release/applications/perideal")))
    parser.add_argument("--output", help="folder of the studies; output/papers unless given")
    parser.add_argument("--quick", action="store_true", help="only rows marked quick")
    parser.add_argument("--sample", action="store_true", help="only the quickest of these")
    parser.add_argument("--check", action="store_true", help="compare with the kept values, write nothing")
    parser.add_argument("--page", action="store_true", help="only write the page from the kept values")
    parser.add_argument("--line", metavar="PAPER/TABLE[/NUMBER]", help="compute one line or table again and print it")
    parser.add_argument("--only", nargs="+", default=[module.__name__ for module in MODULES], metavar="PAPER", help="of these papers")
    options = parser.parse_args()
    papers = sections()
    if options.line:
        again(papers, options.line, options.program, options.output)
        return 0
    kept = json.loads(KEPT.read_text(encoding="utf-8")) if KEPT.is_file() else {}
    found, studies = {}, []
    if not options.page:
        for paper in papers:
            study = Study(paper.key, options.output)
            if paper.key in options.only:
                study.compute(options.program, quick=options.quick, only=sample_of(paper, study) if options.sample else (), redo=False)
            studies.append(study)
        for key, paper, _, line in keys(papers):
            try:
                values = line.evaluate(studies[papers.index(paper)])
            except Missing:
                values = None
            if values is not None:
                found[key] = values
    if options.check:
        return 1 if check(papers, found, kept, document.text(papers, kept)) else 0
    current = {key: dict(found.get(key) or kept[key]) for key, *_ in keys(papers) if key in found or key in kept}
    if options.quick or options.sample:  # what was not computed now is marked in the page
        for key in current:
            current[key]["earlier"] = key not in found
    elif found:
        KEPT.write_text("{\n" + ",\n".join(f" {json.dumps(k)}: {json.dumps(v)}" for k, v in sorted(current.items())) + "\n}\n", encoding="utf-8")
        draw(papers, studies)
    PAGE.write_text(document.text(papers, current), encoding="utf-8")
    absent = [key for key, *_ in keys(papers) if key not in current]
    print(f"{PAGE.relative_to(ROOT)}: {len(found)} lines computed, {len(current) - len(found)} kept, {len(absent)} absent")
    for key in absent:
        print(f"  absent: {key}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
