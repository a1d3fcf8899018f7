# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Writes doc/reproduction.md from values; the only text typed by hand is in this package."""

import math

from results import Study

INTRODUCTION = """# Reproduction of published results

Each table and figure of four papers on peridynamic diffusion, and of one on elasticity, beside what PeriDeal computes, in the settings of the paper and in ours. Written by
[make_reproduction.py](make_reproduction.py); numbers are those of the runs.

    python3 doc/make_reproduction.py                            # everything, about {minutes}; finished runs are kept
    python3 doc/make_reproduction.py --quick                    # the runs that take seconds; the others keep their values
    python3 doc/make_reproduction.py --line tan_2020/table_1/3  # one line of a table again, by the name in its last column
    python3 doc/make_reproduction.py --line tan_2020/table_1    # a table
    ./run prm/papers/tan_2020/example_1_paper.prm               # a scene as it is, with a report

- *published*: as printed. Where a paper has a picture only, the line says so, and the comparison is with the exact series (independent closed forms in
  [closed_forms.py](reproduce/closed_forms.py)) or with finite elements on finer meshes.
- *gap*: obtained over published minus one in percent, or the difference where the table says degrees.
- *bonds*, *seconds*: of the run itself, not of its reference (of a rate: the finest run); set-up and time stepping of one model on one core of a
  shared machine.
- *run again*: the argument of `--line`. The runs are rows of the study of the paper, `prm/papers/PAPER/study.json`.
"""


def number(value, digits):
    """A number of a table."""
    if value is None or not math.isfinite(value):
        return ""
    if value == 0:
        return "0"
    size = math.floor(math.log10(abs(value)))
    if size < -4 or size > 5:
        mantissa, exponent = f"{value:.{max(digits - 1, 0)}e}".split("e")
        return f"{mantissa}e{int(exponent)}"
    return f"{value:.{max(digits - 1 - size, 0)}f}" if digits - 1 - size > 0 else f"{round(value)}"


def list_of(values, digits):
    return ", ".join(number(v, digits) or "-" for v in values)


def printed(values):
    """Published numbers with the digits they have."""
    return ", ".join("-" if v is None else f"{v:.10g}".replace("e-0", "e-") for v in values)


def gaps(table, obtained, published):
    """The gaps of a line, of the values that are published."""
    texts = []
    for found, wanted in zip(obtained, published):
        if wanted is None:
            continue
        texts.append(f"{100 * (found / wanted - 1):+.2g} %" if table.gap == "relative" else f"{found - wanted:+.1e}")
    return ", ".join(texts)


def of_table(paper, table, values, scenes):
    """The lines of one table."""
    heading = ", ".join(table.columns)
    published = table.kind == "numbers"
    columns = ["", "published", f"obtained: {heading}", "gap"] if published else ["", f"obtained: {heading}"]
    columns += ["bonds", "seconds", "scene", "run again"]
    out = [f"### {table.source}\n", table.text + "\n", "| " + " | ".join(columns) + " |", "|" + "---|" * len(columns)]
    earlier = False
    for place, line in enumerate(table.lines, 1):
        entry = values.get(f"{paper.key} / {table.key} / {line.what}")
        if entry is None:
            continue
        mark = " *" if entry.get("earlier") else ""
        earlier = earlier or bool(mark)
        cells = [line.what + mark]
        if published:
            wanted = line.published or [None] * len(entry["values"])
            cells.append(printed(wanted) if any(w is not None for w in wanted) else "")
        cells.append(list_of(entry["values"], table.digits))
        if published:
            cells.append(gaps(table, entry["values"], wanted))
        scene = scenes[line.needs[0]]
        cells += [f"{entry['bonds']:,}" if entry["bonds"] else "", f"{entry['seconds']:g}",
                  f"[{scene.rsplit('/', 1)[-1][:-4]}](../{scene})", f"`{paper.key}/{table.key}/{place}`"]
        out.append("| " + " | ".join(cells) + " |")
    if earlier:
        out.append("\n\\* not computed this time: from the last full computation.")
    if table.after:
        out.append("\n" + table.after)
    return "\n".join(out) + "\n"


def of_paper(paper, values):
    """One section."""
    scenes = {row["name"]: row["scene"] for row in Study(paper.key).listed()}
    out = [f"## {paper.title}\n", paper.reference + "\n", paper.text + "\n",
           f"Rows: [prm/papers/{paper.key}/study.json](../prm/papers/{paper.key}/study.json).\n"]
    out += [of_table(paper, table, values, scenes) for table in paper.tables]
    out.append("### Figures\n")
    for picture in paper.pictures:
        out.append(f"{picture.text}\n\n![{picture.text}](figures/reproduction/{picture.name}.png)\n")
    if paper.after:
        out.append(paper.after + "\n")
    return "\n".join(out)


def text(papers, values):
    """The whole page."""
    out = [INTRODUCTION.replace("{minutes}", "a quarter of an hour")]
    out += [of_paper(paper, values) for paper in papers]
    return "\n".join(out)
