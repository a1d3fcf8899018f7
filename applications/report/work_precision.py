# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Accuracy against cost: the charts and tables of `./run study work_precision`, from work_precision.json."""

import json
from html import escape
from pathlib import Path

import numpy as np
from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, NullFormatter

import interactive
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
FEW = 20  # families, all of which are drawn in full then
CYCLE = ("o", "s", "^", "D", "v", "P", "X")
CHOSEN = "#7b2d8b"  # what `Models = auto` picks
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
            raise StudyError(f"'{path}' has no '{key}': it is not from './run study work_precision'")
    return data


def applications(data):
    """What the nonzeros are multiplied with."""
    return "iterations" if data["steady"] else "operator applications"


MEASURES = {"field": "of the nodal values", "opening": "of the opening of cracks", "stress intensity": "of the stress intensities", "strength": "of the largest force",
            "path": "of the cracks' path"}


def error_label(data):
    """What the error is that of."""
    measure = data.get("measure", "field")
    return {"strength": "relative error of the largest force", "path": "farthest distance of the crack, over the longest edge"}.get(measure) or f"relative L2 error {MEASURES[measure]}"


def reference_text(data):
    """What errors are measured against."""
    of_what = MEASURES[data.get("measure", "field")]
    reference = data["reference"]
    if "tolerance" in reference:
        return (f"Errors {of_what} against what Models = auto finds, asked for {style.plain(reference['tolerance'], 1)}, which is estimated to be wrong by "
                f"{style.plain(reference['own error'], 2)} itself.")
    if "cells" not in reference:
        return f"Errors {of_what} against the exact solution, relative L2 norm."
    against = "finite elements with the cracks on cell faces" if "crack" in reference["kind"] else "finite elements of degree 2"
    lattices = ", ".join(" × ".join(cells.split(", ")) for cells in reference["cells"])
    return (f"Errors {of_what}, relative L2 norm, against {against} ({lattices} cells, extrapolated "
            f"with order {style.plain(reference['order'], 2)}, observed {'none' if reference['observed order'] is None else style.plain(reference['observed order'], 3)}), which are wrong by "
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


def log_axis(axis, formatter=None, decades=2.0):
    """Ticks at powers of ten, or at 1, 2, 5 of errors where there are few decades."""
    if formatter:
        axis.set_major_locator(LogLocator(subs=(1, 2, 5) if decades < 4 else (1,), numticks=30))
        axis.set_major_formatter(FuncFormatter(formatter))
        axis.set_minor_locator(FixedLocator([]))
    axis.set_minor_formatter(NullFormatter())


def look_of(data, family):
    """Marker and dashes of a family that is drawn in full; None of the others."""
    if family["name"] in SHOWN:
        return SHOWN[family["name"]]
    if len(data["families"]) > FEW:
        return None
    alike = [f["name"] for f in data["families"] if f["model"] == family["model"]]
    place = alike.index(family["name"])
    return CYCLE[place % len(CYCLE)], ("-", "--", ":")[place // len(CYCLE) % 3]


def picks_of(data):
    """What `Models = auto` has chosen, with an error that a logarithm has."""
    return [pick for pick in data.get("picks", []) if pick["error"]]


def draw_picks(axes, data):
    """Stars with the tolerance that was asked for; labels of stars at one place stand below each other."""
    picks = picks_of(data)
    if not picks:
        return
    axes.plot([p["wall time"] for p in picks], [p["error"] for p in picks], "*", color=CHOSEN, markersize=14, markeredgecolor="white", markeredgewidth=0.6,
              zorder=6)
    to_axes = axes.transData + axes.transAxes.inverted()
    places = [to_axes.transform((p["wall time"], p["error"])) for p in picks]
    groups = []
    for k, place in enumerate(places):
        near = next((g for g in groups if any(abs(places[j][0] - place[0]) < 0.2 and abs(places[j][1] - place[1]) < 0.04 for j in g)), None)
        if near is None:
            groups.append([k])
        else:
            near.append(k)
    for group in groups:
        text = "auto " + ", ".join(f"{picks[k]['tolerance']:.0e}".replace("e-0", "e-") for k in group)
        left = max(places[k][0] for k in group) > 0.7  # the names of lines are on the right
        k = (min if left else max)(group, key=lambda j: places[j][0])
        axes.annotate(text, (picks[k]["wall time"], picks[k]["error"]), xytext=(-9 if left else 9, 6), textcoords="offset points", fontsize=8.5, color=CHOSEN,
                      fontweight="bold", ha="right" if left else "left", zorder=7)


def draw(data, x):
    """The figure of the error over "work" or "wall time"."""
    shown = [f for f in data["families"] if look_of(data, f)]
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
        marker, dashes = look_of(data, family) or (None, "-")
        if marker is None:
            axes.plot(points[:, 0], points[:, 1], color=color, linewidth=0.7, alpha=0.28, zorder=2)
            continue
        axes.plot(points[:, 0], points[:, 1], color=color, linestyle=dashes, linewidth=1.4, marker=marker, markersize=4.8,
                  markerfacecolor="white", markeredgewidth=1.1, zorder=4)
        ends.append((points[-1, 0], points[-1, 1], family["name"], color))
    chosen = picks_of(data) if x == "wall time" else []
    costs = [row[x] for row in data["rows"] + chosen]
    errors = [row["error"] for row in data["rows"] + chosen if row["error"] > 0]
    axes.set_xlim(min(costs) / 1.5, max(costs) * 1.5)
    axes.set_ylim(min(errors) / 1.5, max(errors) * 1.5)
    log_axis(axes.xaxis)
    log_axis(axes.yaxis, percent, decades=np.log10(max(errors) / min(errors)))
    axes.set_xlabel(AXES[x].format(applications(data)))
    axes.set_ylabel(error_label(data))
    style.tidy(axes)
    add_labels(axes, ends, height - 0.8)
    if chosen:
        draw_picks(axes, data)
    return figure


def caption(data, x):
    """What the lines are."""
    what = "work" if x == "work" else "wall time"
    return (f"Each line is a method on finer and finer lattices. Blue: finite elements; orange: peridynamics in the whole body; green: coupled. Grey: the "
            f"Pareto front, the settings (circles) that none beats in {what} and error at once."
            + (" Stars: what Models = auto picks, with all tries." if x != "work" and picks_of(data) else "")
            + (" Thin lines: the other families of the tables below." if any(look_of(data, f) is None for f in data["families"]) else ""))


NUMBERS = [{"key": "work", "title": "work"}, {"key": "wall time", "title": "wall time", "unit": " s"}, {"key": "set-up time", "title": "of it set-up", "unit": " s"},
           {"key": "unknowns", "title": "unknowns"}, {"key": "bonds", "title": "bonds"}, {"key": "nonzeros", "title": "nonzeros"},
           {"key": "iterations", "title": "iterations"}, {"key": "operator applications", "title": "operator applications"}, {"key": "steps", "title": "steps"},
           {"key": "memory", "title": "memory", "unit": " MB"}, {"key": "asked", "title": "asked for"}, {"key": "estimated", "title": "estimated error"},
           {"key": "tries", "title": "tries"}, {"key": "choice", "title": "choice:"}]


def point_of(row):
    """A row as the interactive chart tells of it."""
    keys = ("name", "error", "work", "wall time", "set-up time", "unknowns", "bonds", "nonzeros", "iterations", "operator applications", "steps")
    point = {key: row[key] for key in keys if row.get(key) is not None}
    if row.get("memory"):
        point["memory"] = row["memory"] / 1e6
    return point


def interactive_lines(data):
    """All families, those that the figures do not name hidden at first, and the picks."""
    rows = {row["name"]: row for row in data["rows"]}
    lines = []
    for family in data["families"]:
        look = look_of(data, family)
        marker, dashes = look or (None, "-")
        lines.append({"name": family["name"], "color": style.MODEL_COLOR[family["model"]], "marker": interactive.MARKERS[marker],
                      "dashes": {"-": [], "--": [6, 4], ":": [2, 3]}[dashes], "hidden": look is None, "stars": False,
                      "points": [point_of(rows[name]) for name in family["rows"] if rows[name]["error"]]})
    if picks_of(data):
        points = [{"name": f"Models = auto, asked for {p['tolerance']:g}", "label": f"{p['tolerance']:g}", "error": p["error"], "wall time": p["wall time"],
                   "asked": percent(p["tolerance"]), "estimated": percent(p["estimate"]), "tries": p["tries"], "choice": f"{p['model']}: {p['settings']}"}
                  for p in picks_of(data)]
        lines.append({"name": "auto", "color": CHOSEN, "marker": "star", "dashes": [], "hidden": False, "stars": True, "points": points})
    return lines


def add_interactive(page, data):
    """The chart whose points tell their names, if its library is there."""
    if not interactive.add_library(page):
        return
    axes = [{"key": "wall time", "name": "wall time", "title": AXES["wall time"]}, {"key": "work", "name": "work", "title": AXES["work"].format(applications(data))},
            {"key": "memory", "name": "memory", "title": "memory of nodes, bonds and matrices, MB"}]
    lines = interactive_lines(data)
    page.add("<h3>All settings</h3>")
    interactive.add_chart(page, "all-settings", {"lines": lines, "axes": axes, "numbers": NUMBERS, "y_title": error_label(data)},
                          "The pointer at a point names the setting and tells its numbers; a click on a name hides or shows a family. Stars: what Models = auto "
                          "picks.", max(560, 19 * len(lines) + 60))


def picks_table(data):
    """What was asked for, and what has come of it."""
    lines = [[escape(f"{p['tolerance']:g}")] + [tables.cell(v) for v in (percent(p["error"]) if p["error"] is not None else None, percent(p["estimate"]),
                                                                        tables.seconds(p["wall time"]), p["tries"], f"{p['model']}: {p['settings']}")]
             for p in data["picks"]]
    return tables.table(["Tolerance", "Error", "Estimate", "Wall time", "Tries", "Choice"], lines, "numbers study")


def add_picks(page, data):
    """A table, or why there is none."""
    if data.get("no picks"):
        page.section("What auto picks", "picks")
        page.add(f"<p>Nothing: {escape(style.prose(data['no picks']))}</p>")
    elif data.get("picks"):
        page.section("What auto picks", "picks")
        if data.get("measure") in ("strength", "path"):
            page.add("<p>Models = auto, asked for so much; the wall time is that of the whole run with all tries.</p>")
        else:
            page.add("<p>Models = auto, asked for an error of so much of the range of the values. The error is measured like all others here, in the relative L2 norm, at "
                     "the vertices of the finest lattice, between the vertices of its own mesh, too; the wall time is that of the whole run with all tries.</p>")
        page.add(f'<div class="wide">{picks_table(data)}</div>')


STEPPER_COLORS = {"euler": "#4d4d4d", "rk4": "#b07d00", "rkc2": "#d55e00", "chebyshev": "#cc79a7", "crank nicolson": "#0072b2", "bdf2": "#009e73",
                  "sdirk2": "#56b4e9"}


def draw_in_time(data, x):
    """The error in time alone over work or wall time, beside the error in space."""
    of_time = data["in time"]
    rows = [row for row in of_time["rows"] if row["error"]]
    figure = style.figure(10, 5.4)
    axes = figure.add_axes([0.085, 0.11, 0.66, 0.84])
    axes.set_xscale("log")
    axes.set_yscale("log")
    ends = []
    for k, stepper in enumerate(dict.fromkeys(row["stepper"] for row in rows)):
        points = np.array([(row[x], row["error"]) for row in rows if row["stepper"] == stepper])
        color = STEPPER_COLORS.get(stepper, "#000000")
        axes.plot(points[:, 0], points[:, 1], color=color, linewidth=1.4, marker=CYCLE[k % len(CYCLE)], markersize=5.5, markerfacecolor="white")
        fixed = " (fixed steps)" if len(points) == 1 else ""
        ends.append((points[-1, 0], points[-1, 1], stepper + fixed, color))
    if of_time["error in space"]:
        axes.axhline(of_time["error in space"], color=FRONT, linewidth=4, alpha=0.6, zorder=1)
        axes.text(0.01, of_time["error in space"], "error in space", transform=axes.get_yaxis_transform(), va="bottom", fontsize=8.5, color="#52606d")
    log_axis(axes.xaxis)
    log_axis(axes.yaxis, percent, decades=9)
    axes.set_xlabel("nonzeros × operator applications" if x == "work" else AXES[x])
    axes.set_ylabel("relative L2 error in time")
    style.tidy(axes)
    add_labels(axes, ends, 4.5)
    return figure


def add_in_time(page, data):
    """Steppers on one lattice."""
    if not data.get("in time"):
        return
    page.section("Error in time", "in-time")
    page.add(f"<p>{escape(data['in time']['method'])}, at the end time, with each stepper at tolerances from 1e-2 to 1e-5, against the same with a tolerance of 1e-9. "
             "What lies far below the error in space is paid for in vain.</p>")
    for x in ("work", "wall time"):
        page.figure(draw_in_time(data, x), f"error_in_time_over_{x.replace(' ', '_')}", "Grey: the error in space on this lattice.", True, f"Error in time over {x}")
    lines = [[escape(row["name"].removeprefix("in time: "))] + [tables.cell(v) for v in (
        style.plain(row["work"], 3), style.plain(row["error"], 3), row["steps"], row["operator applications"], row["iterations"], tables.seconds(row["wall time"]))]
        for row in data["in time"]["rows"]]
    page.add(f'<div class="wide">{tables.table(["Stepper", "Work", "Error", "Steps", "Applications", "Iterations", "Wall time"], lines, "numbers study")}</div>')


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
    add_interactive(page, data)
    if data["left out"]:
        page.add('<ul class="notes">' + "".join(f"<li>Left out: {escape(s)}</li>" for s in data["left out"]) + "</ul>")
    add_picks(page, data)
    add_in_time(page, data)
    page.section("What errors cost", "costs")
    page.add("<p>Interpolated along each family in logarithms; ≤: the coarsest lattice is better already; ≈: extrapolated beyond the finest lattice, "
             "whose error is so many times the target (no more than ten).</p>")
    page.add(f'<div class="wide">{target_table(data)}</div>')
    page.section("The Pareto front", "front")
    page.add(f'<div class="wide">{front_table(data)}</div>')
    page.section("Dominated settings", "dominated")
    page.add("<p>Each beside the cheapest setting that is as good and no dearer.</p>")
    page.add(f'<div class="wide">{dominated_table(data)}</div>')
