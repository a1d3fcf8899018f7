# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Accuracy against cost: the charts and tables of `perideal study work_precision`, from work_precision.json."""

import json
from html import escape
from pathlib import Path

import numpy as np
from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, NullFormatter

import style
import tables
from study_figures import StudyError, add_labels

FILE = "work_precision.json"

# What is drawn in full and named at its end; all other families are thin lines of their model's
# colour.
SHOWN = {
    "FEM, crack on faces": ("o", "-"), "FEM, pairs": ("v", "-"), "FEM, pairs, scaled": ("^", "-"), "FEM, cells removed": ("X", "-"),
    "PD raw, m = 2": ("v", "-"), "PD raw, m = 6.5": ("X", "-"), "PD energy-corrected, m = 2": ("P", "-"), "PD exchange, m = 3": ("s", "-"),
    "PD exchange, scaled, m = 2": ("^", "-"),
    "coupled, m = 3, c = 1": ("v", "-"), "coupled, m = 3, c = 1, scaled": ("D", "-"), "coupled, m = 2, c = 1, scaled": ("^", "-"),
    "FEM, crack on faces, graded 3": ("o", "--"), "FEM, pairs, scaled, graded 3": ("^", "--"),
    "coupled, m = 3, c = 1, scaled, graded 3": ("D", "--"), "coupled on faces, m = 3, c = 1": ("o", "-"),
    "coupled on faces, m = 3, c = 0.5, graded 3": ("o", "--"),
}
FRONT = "#9aa5b1"
AXES = {"work": "nonzeros × {}", "wall time": "wall time of the model, s"}


def read(directory):
    """work_precision.json of a directory, or None."""
    path = Path(directory) / FILE
    if not path.is_file():
        return None
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
    except ValueError as fault:
        raise StudyError(f"'{path}' is no JSON: {fault}") from None
    for key in ("rows", "families", "front", "reference", "left out"):
        if key not in data:
            raise StudyError(f"'{path}' has no '{key}': it is not from 'perideal study work_precision'")
    return data


def applications(data):
    """What the nonzeros are multiplied with."""
    return "iterations" if data["steady"] else "operator applications"


def reference_text(data):
    """What errors are measured against."""
    reference = data["reference"]
    if "cells" not in reference:
        return "Errors of the nodal values against the exact solution, relative L2 norm."
    lattices = ", ".join(" × ".join(cells.split(", ")) for cells in reference["cells"])
    return (f"Errors of the nodal values, relative L2 norm, against finite elements with the cracks on cell faces ({lattices} cells, extrapolated "
            f"with order {style.plain(reference['order'], 2)}, observed {style.plain(reference['observed order'], 3)}), which are wrong by "
            f"{style.plain(reference['own error'], 2)} themselves.")


def points_of(data, family, x):
    """Cost and error of a family from coarse to fine."""
    rows = {row["name"]: row for row in data["rows"]}
    return [(rows[name][x], rows[name]["error"]) for name in family["rows"] if rows[name]["error"] > 0]


def percent(value, _=None):
    """An error as it is read: 0.1 %."""
    return f"{style.plain(100 * value, 3)} %"


def draw_front(axes, data, x):
    """The steps of the front, behind everything else."""
    rows = {row["name"]: row for row in data["rows"]}
    names = data["front" if x == "work" else "front in wall time"]
    front = np.array([(rows[n][x], rows[n]["error"]) for n in names if rows[n]["error"] > 0])
    if not len(front):
        return
    right = max(row[x] for row in data["rows"]) * 3
    top = max(row["error"] for row in data["rows"]) * 3
    steps_x = np.concatenate(([front[0, 0]], front[:, 0], [right]))
    steps_y = np.concatenate(([top], front[:, 1], [front[-1, 1]]))
    axes.step(steps_x, steps_y, where="post", color=FRONT, linewidth=5, alpha=0.45, zorder=1, solid_joinstyle="miter")
    axes.plot(front[:, 0], front[:, 1], "o", markersize=11, markerfacecolor="none", markeredgecolor=FRONT, markeredgewidth=1.6, zorder=2)


def log_axis(axis, formatter=None):
    """Ticks at powers of ten, or at 1, 2, 5 of errors."""
    if formatter:
        axis.set_major_locator(LogLocator(subs=(1, 2, 5), numticks=30))
        axis.set_major_formatter(FuncFormatter(formatter))
        axis.set_minor_locator(FixedLocator([]))
    axis.set_minor_formatter(NullFormatter())


def draw(data, x):
    """The figure of the error over "work" or "wall time"."""
    shown = [f for f in data["families"] if f["name"] in SHOWN]
    height = max(5.4, 0.3 * len(shown) + 1.2)
    figure = style.figure(10, height)
    axes = figure.add_axes([0.85 / 10, 0.6 / height, 6.1 / 10, (height - 0.8) / height])
    axes.set_xscale("log")
    axes.set_yscale("log")
    draw_front(axes, data, x)
    ends = []
    for family in data["families"]:
        points = np.array(points_of(data, family, x), dtype=float)
        if not len(points):
            continue
        color = style.MODEL_COLOR[family["model"]]
        marker, dashes = SHOWN.get(family["name"], (None, "-"))
        if marker is None:
            axes.plot(points[:, 0], points[:, 1], color=color, linewidth=0.7, alpha=0.28, zorder=2)
            continue
        axes.plot(points[:, 0], points[:, 1], color=color, linestyle=dashes, linewidth=1.4, marker=marker, markersize=4.8,
                  markerfacecolor="white", markeredgewidth=1.1, zorder=4)
        ends.append((points[-1, 0], points[-1, 1], family["name"], color))
    costs = [row[x] for row in data["rows"]]
    errors = [row["error"] for row in data["rows"] if row["error"] > 0]
    axes.set_xlim(min(costs) / 1.5, max(costs) * 1.5)
    axes.set_ylim(min(errors) / 1.5, max(errors) * 1.5)
    log_axis(axes.xaxis)
    log_axis(axes.yaxis, percent)
    axes.set_xlabel(AXES[x].format(applications(data)))
    axes.set_ylabel("relative L2 error of the nodal values")
    style.tidy(axes)
    add_labels(axes, ends, height - 0.8)
    return figure


def caption(data, x):
    """What the lines are."""
    what = "work" if x == "work" else "wall time"
    return (f"Each line is a method on finer and finer lattices. Blue: finite elements; orange: peridynamics in the whole body; green: coupled. Grey: the "
            f"Pareto front, the settings (circles) that none beats in {what} and error at once. Thin lines: the other families of the tables below.")


def front_table(data):
    """The front by rising work."""
    rows = {row["name"]: row for row in data["rows"]}
    lines = [[escape(n)] + [tables.cell(v) for v in (style.plain(rows[n]["work"], 3), percent(rows[n]["error"]), rows[n]["unknowns"],
                                                     rows[n]["bonds"] or None, rows[n]["iterations"], tables.seconds(rows[n]["wall time"]),
                                                     tables.memory(rows[n]["peak memory"]))] for n in data["front"]]
    return tables.table(["Setting", "Work", "Error", "Unknowns", "Bonds", "Iterations", "Wall time", "Peak memory"], lines, "numbers study")


def dominated_table(data):
    """What is dominated, and by which setting."""
    rows = {row["name"]: row for row in data["rows"]}
    lines = []
    for row in data["rows"]:
        if row["front"]:
            continue
        by = rows[row["dominated by"]]
        lines.append([escape(row["name"])] + [tables.cell(v) for v in (style.plain(row["work"], 3), percent(row["error"]), by["name"],
                                                                       style.plain(row["work"] / by["work"], 3), percent(by["error"]))])
    return tables.table(["Setting", "Work", "Error", "Dominated by", "Work over its", "Its error"], lines, "numbers study")


def amount(entry, unit=""):
    """A cost at an error with how it was found."""
    if "cost" not in entry:
        return "–"
    mark = {"at most": "≤ ", "extrapolated": "≈ "}.get(entry["kind"], "")
    note = f" (extrapolated by {style.plain(entry['finest error over target'], 2)})" if entry["kind"] == "extrapolated" else ""
    return f"{mark}{style.plain(entry['cost'], 3)}{unit}{note}"


def target_table(data):
    """What given errors cost along each family."""
    targets = [entry["error"] for entry in data["families"][0]["at error"]]
    header = ["Family", "Observed order"]
    for target in targets:
        header += [f"Work at {percent(target)}", f"Time at {percent(target)}"]
    lines = []
    for family in data["families"]:
        line = [escape(family["name"]), tables.cell(family["observed order"], 3)]
        for entry in family["at error"]:
            line += [escape(amount(entry["work"])), escape(amount(entry["wall time"], " s"))]
        lines.append(line)
    return tables.table(header, lines, "numbers study")


def add_to(page, data):
    """Figures and tables."""
    page.section("Work and precision", "figures")
    page.add(f"<p>{escape(reference_text(data))} Work is the number of nonzeros that one application of the operator multiplies, times "
             f"{applications(data)}.</p>")
    if not data["families"]:
        page.add("<p>Only the reference was computed.</p>")
        return
    for x in ("work", "wall time"):
        page.figure(draw(data, x), f"error_over_{x.replace(' ', '_')}", caption(data, x), True, f"Error over {x}")
    if data["left out"]:
        page.add('<ul class="notes">' + "".join(f"<li>Left out: {escape(s)}</li>" for s in data["left out"]) + "</ul>")
    page.section("What errors cost", "costs")
    page.add("<p>Interpolated along each family in logarithms; ≤: the coarsest lattice is better already; ≈: extrapolated beyond the finest lattice, "
             "whose error is so many times the target (no more than ten).</p>")
    page.add(f'<div class="wide">{target_table(data)}</div>')
    page.section("The Pareto front", "front")
    page.add(f'<div class="wide">{front_table(data)}</div>')
    page.section("Dominated settings", "dominated")
    page.add("<p>Each beside the cheapest setting that is as good and no dearer.</p>")
    page.add(f'<div class="wide">{dominated_table(data)}</div>')
