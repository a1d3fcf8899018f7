# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Where a scene is computed well: the maps of `perideal study stability`, from stability.json."""

import json
import math
from html import escape
from pathlib import Path

from matplotlib.colors import TwoSlopeNorm
from matplotlib.ticker import FixedLocator, FuncFormatter, NullFormatter

import style
import tables
from page import Page
from study_figures import StudyError

FILE = "stability.json"
SAFE, FAILS, WARNED = "#dcefe3", "#b3261e", "#c77700"
VERDICT = {"safe": "#1b7f4b", "warned": WARNED, "refused": WARNED, "fails": FAILS}
MARKER = {"safe": "o", "warned": "^", "refused": "s", "fails": "X"}
LINES = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00"]

# How each map is drawn: "curves" of the observed numbers over x, one panel for each combination of
# `panels` and one line for each of `lines`; or the "plane" of x and y, coloured by what was observed.
# `safe`: on which side of the predicted numbers a point is safe.
DRAWINGS = {
    "step limit": {"kind": "curves", "x": "m", "panels": ("method", "stages"), "lines": ("model", "bonds", "kernel"), "log": "y",
                   "label": "step", "safe": "below"},
    "growth": {"kind": "plane", "x": "step", "y": "m", "panels": ("model", "method", "stages", "bonds"), "log": "x",
               "label": "growth in a step", "limit": "step over limit"},
}


def read(directory):
    """stability.json of a directory, or None."""
    path = Path(directory) / FILE
    if not path.is_file():
        return None
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
    except ValueError as fault:
        raise StudyError(f"'{path}' is no JSON: {fault}") from None
    for key in ("title", "maps", "left out", "cells"):
        if key not in data:
            raise StudyError(f"'{path}' has no '{key}': it is not from 'perideal study stability'")
    return data


def number(value):
    """A number of the file, where infinity is a word."""
    return math.inf if value == "infinite" else math.nan if value is None else float(value)


def group_of(point, names):
    """The values of some parameters, of those that the point has."""
    return tuple(str(point[n]) if n != "stages" else f"{point[n]} stages" for n in names if point.get(n) not in (None, ""))


def groups(points, names):
    """Points by the values of some parameters, in their order."""
    result = {}
    for point in points:
        result.setdefault(group_of(point, names), []).append(point)
    return result


def title_of(group):
    """What tells a panel from the others."""
    return ", ".join(group)


def panels_of(n, height=3.2):
    """A figure with n panels in rows of at most three."""
    columns = min(3, n)
    rows = -(-n // columns)
    figure = style.figure(max(4.6, 3.6 * columns), height * rows + 0.3)
    grid = figure.subplots(rows, columns, squeeze=False)
    for axes in grid.flat[n:]:
        axes.set_visible(False)
    return figure, list(grid.flat[:n])


def few_ticks(axes, which, values):
    """Ticks at 1, 2, 5 of a logarithmic axis that spans little."""
    low, high = min(values), max(values)
    axis = axes.xaxis if which == "x" else axes.yaxis
    places = [m * 10.0 ** e for e in range(math.floor(math.log10(low)) - 1, math.ceil(math.log10(high)) + 1) for m in (1, 2, 5)]
    if high > 1e3 * low:
        places = [p for p in places if f"{p:e}".startswith("1.0")]
    axis.set_major_locator(FixedLocator([p for p in places if low / 2 <= p <= high * 2]))
    axis.set_major_formatter(FuncFormatter(lambda value, _: style.plain(value, 2)))
    axis.set_minor_formatter(NullFormatter())


def draw_curves(entry, how):
    """Observed numbers as markers, predicted ones as lines, the safe side of the first of these shaded."""
    points = [p for p in entry["points"] if math.isfinite(number(p["observed"]))]
    panels = groups(points, how["panels"])
    if not panels:
        return None
    figure, all_axes = panels_of(len(panels))
    every_line = list(groups(points, how["lines"]))
    for axes, (name, here) in zip(all_axes, panels.items()):
        values = [v for p in here for v in (number(p["observed"]), number(p["predicted"])) if math.isfinite(v) and (v > 0 or "y" not in how["log"])]
        xs = [p[how["x"]] for p in here if p.get(how["x"]) is not None] or [0, 1]
        if "x" in how["log"]:
            axes.set_xscale("log")
        if "y" in how["log"]:
            axes.set_yscale("log")
        low, high = (min(values) / 1.6, max(values) * 1.6) if "y" in how["log"] else (min(values + [0]), max(values) * 1.1 or 1)
        shaded = False
        for line, own in groups(here, how["lines"]).items():
            color = LINES[every_line.index(line) % len(LINES)]
            own = sorted(own, key=lambda p: p.get(how["x"]) or 0)
            has_x = own[0].get(how["x"]) is not None
            x = [p[how["x"]] for p in own] if has_x else [min(xs), max(xs)]
            predicted = [number(p["predicted"]) for p in own] if has_x else [number(own[0]["predicted"])] * 2
            if not shaded and how.get("safe") and (has_x or len(panels[name]) == 1) and all(map(math.isfinite, predicted)):
                edge = low if how["safe"] == "below" else high
                axes.fill_between(x, predicted, edge, color=SAFE, zorder=0, linewidth=0)
                shaded = True
            axes.plot(x, predicted, color=color, linewidth=1.3, zorder=2, label=title_of(line))
            for p in own if has_x else []:
                axes.plot(p[how["x"]], number(p["observed"]), MARKER[p["verdict"]], color=color, markersize=5, markerfacecolor="white",
                          markeredgewidth=1.2, zorder=3)
            if not has_x:
                axes.plot(max(xs), number(own[0]["observed"]), MARKER[own[0]["verdict"]], color=color, markersize=5,
                          markerfacecolor="white", markeredgewidth=1.2, zorder=3)
        axes.set_ylim(low, high)
        if "y" in how["log"]:
            few_ticks(axes, "y", [low, high])
        if "x" in how["log"]:
            few_ticks(axes, "x", xs)
        axes.set_title(title_of(name), loc="left")
        axes.set_xlabel(how["x"])
        axes.set_ylabel(how["label"])
        style.tidy(axes)
    if len(every_line) > 1:
        handles = {}
        for axes in all_axes:
            for handle, label in zip(*axes.get_legend_handles_labels()):
                handles.setdefault(label, handle)
        figure.legend(handles.values(), handles.keys(), loc="lower center", ncols=min(3, len(handles)))
        figure.tight_layout(rect=(0, 0.06 + 0.04 * ((len(handles) - 1) // 3), 1, 1))
    else:
        figure.tight_layout()
    return figure


def limit_line(here, how):
    """Where the limit runs through the plane: pairs (y, x)."""
    line = {p[how["y"]]: p[how["x"]] / p[how["limit"]] for p in here if p.get(how["y"]) is not None}
    return sorted(line.items())


def draw_plane(entry, how):
    """Points coloured by what was observed; crosses are those that fail; the safe region shaded."""
    points = entry["points"]
    panels = groups(points, how["panels"])
    if not panels:
        return None
    figure, all_axes = panels_of(len(panels))
    finite = [number(p["observed"]) for p in points if math.isfinite(number(p["observed"]))]
    norm = TwoSlopeNorm(1.0, min(0.5, min(finite)), min(2.0, max(max(finite), 1.01)))
    shown = None
    for axes, (name, here) in zip(all_axes, panels.items()):
        has_y = here[0].get(how["y"]) is not None
        ys = [p[how["y"]] if has_y else 0 for p in here]
        xs = [p[how["x"]] for p in here]
        axes.set_xscale("log")
        left, right = min(xs) / 1.15, max(xs) * 1.15
        limit = limit_line(here, how) if has_y else [(0, here[0][how["x"]] / here[0][how["limit"]])]
        span = [y for y, _ in limit]
        if len(span) == 1:
            limit = [(span[0] - 0.5, limit[0][1]), (span[0] + 0.5, limit[0][1])]
        axes.fill_betweenx([y for y, _ in limit], left, [x for _, x in limit], color=SAFE, zorder=0, linewidth=0)
        axes.plot([x for _, x in limit], [y for y, _ in limit], color=style.INK, linewidth=1.3, zorder=2)
        for verdict, marker in MARKER.items():
            own = [k for k, p in enumerate(here) if p["verdict"] == verdict]
            if own:
                colors = [min(2.0, number(here[k]["observed"])) for k in own]
                shown = axes.scatter([xs[k] for k in own], [ys[k] for k in own], c=colors, cmap=style.DIFFERENCE, norm=norm, marker=marker,
                                     s=34, edgecolors=style.INK, linewidths=0.6, zorder=3)
        axes.set_xlim(left, right)
        few_ticks(axes, "x", [left, right])
        axes.set_title(title_of(name), loc="left")
        axes.set_xlabel(how["x"])
        if has_y:
            axes.set_ylabel(how["y"])
        else:
            axes.set_yticks([])
            axes.set_ylim(-1, 1)
        style.tidy(axes)
    figure.tight_layout(rect=(0, 0, 0.9, 1))
    box = all_axes[0].get_position()
    bar = figure.colorbar(shown, cax=figure.add_axes([0.915, box.y0, 0.015, box.height]), extend="max")
    bar.set_label(how["label"])
    return figure


def draw(entry):
    """The figure of a map, or None if it has no point that can be drawn."""
    how = DRAWINGS.get(entry["name"])
    if how is None or not entry["points"]:
        return None
    return (draw_curves if how["kind"] == "curves" else draw_plane)(entry, how)


def caption(entry):
    """What is to be seen."""
    how = DRAWINGS[entry["name"]]
    if how["kind"] == "curves":
        return f"Lines: {entry['predicted']}. Circles: {entry['observed']}; crosses where a point fails, triangles where the program warns. Shaded: safe."
    return f"Colours: {entry['observed']}. Circles are safe, crosses fail. Line: the predicted limit; shaded: safe."


def confirmed(entry):
    """What random points say."""
    parts = []
    for side, word in (("inside", "healthy"), ("outside", "not healthy")):
        if entry.get(side, {}).get("points"):
            parts.append(f"{entry[side]['confirmed']} of {entry[side]['points']} random points {side} the safe region are {word}")
    return "; ".join(parts)


def ratio_table(entry):
    """Least and largest ratio of what is observed to what is predicted, by method."""
    lines = []
    for name, own in groups(entry["points"], DRAWINGS[entry["name"]]["panels"]).items():
        both = [(number(p["observed"]), number(p["predicted"])) for p in own]
        ratios = [o / p for o, p in both if math.isfinite(o) and math.isfinite(p) and p > 0]
        if ratios:
            lines.append([escape(title_of(name)), str(len(ratios)), style.plain(min(ratios)), style.plain(max(ratios))])
    return tables.table(["Method", "Points", "Least observed over predicted", "Largest"], lines, "numbers study") if lines else ""


def verdict_table(data):
    """Maps with the counts of verdicts."""
    lines = []
    for entry in data["maps"]:
        counts = {}
        for point in entry["points"]:
            counts[point["verdict"]] = counts.get(point["verdict"], 0) + 1
        sides = [f"{entry[s]['confirmed']} of {entry[s]['points']}" if entry.get(s, {}).get("points") else "–" for s in ("inside", "outside")]
        lines.append([escape(entry["name"]), str(len(entry["points"])), ", ".join(f"{n} {v}" for v, n in counts.items()), *sides])
    return tables.table(["Map", "Points", "Verdicts", "Confirmed inside", "Confirmed outside"], lines, "study")


def page_of(data, directory):
    """Draws the figures and returns the page."""
    page = Page(directory)
    page.section("The study", "problem")
    cells = " × ".join(map(str, data["cells"]))
    page.add(f"<p>Each map varies what decides on how well the scene is computed{f', on a lattice of {cells} cells' if cells else ''}: what the program says "
             "beforehand (predicted), what a computation finds (observed), and the verdict.</p>")
    page.add(verdict_table(data))
    if data["left out"]:
        page.add('<ul class="notes">' + "".join(f"<li>No map of {escape(n)}: {escape(r)}.</li>" for n, r in data["left out"].items()) + "</ul>")
    for entry in data["maps"]:
        page.section(entry["name"].capitalize(), entry["name"].replace(" ", "_"))
        page.add(f"<p>{escape(entry['bound'])}. {escape(confirmed(entry))}</p>")
        figure = draw(entry)
        if figure:
            page.figure(figure, entry["name"].replace(" ", "_"), caption(entry), True, entry["name"].capitalize())
        if entry["name"] == "step limit":
            page.add(ratio_table(entry))
        if entry["left out"]:
            page.add('<ul class="notes">' + "".join(f"<li>{escape(reason)}</li>" for reason in entry["left out"]) + "</ul>")
    page.section("Files", "files")
    page.add('<ul class="files"><li><a href="stability.csv">stability.csv</a></li><li><a href="stability.json">stability.json</a></li></ul>')
    title = f"{data['title']}: stability"
    return page.html(title, f"<h1>{escape(title)}</h1><p><span>{escape(str(data['scene']))}</span></p>")
