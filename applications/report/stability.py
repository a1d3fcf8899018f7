# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Where a scene is computed well: the maps of `./run study stability`, from stability.json."""

import json
import math
from html import escape
from pathlib import Path

from matplotlib.colors import Normalize, TwoSlopeNorm
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
# `only` leaves points out. Shaded is what lies below the predicted numbers (`safe`), or within the
# `band`, or in a plane what lies before the limit. Numbers below the `floor` are drawn on it.
# `same`: all panels have the same scale; `signed`: it is symmetric.
DRAWINGS = {
    "step limit": [{"kind": "curves", "x": "m", "panels": ("method", "stages"), "lines": ("model", "bonds", "kernel"), "log": "y",
                    "label": "step", "safe": "below"}],
    "growth": [{"kind": "plane", "x": "step", "y": "m", "panels": ("model", "method", "stages", "bonds"), "log": "x",
                "label": "growth in a step", "limit": "step over limit"}],
    "error": [{"kind": "curves", "x": "m", "panels": ("volume fraction", "calibration"), "lines": ("kernel",), "log": "", "only": "kernel exponent",
               "label": "error of the conductivity", "band": (-5e-3, 5e-3), "signed": True}],
    "surface error": [{"kind": "curves", "x": "cells across", "panels": ("treatment",), "lines": ("m",), "log": "xy", "floor": 1e-6,
                       "label": "share of the heat missing", "band": (1e-9, 5e-3), "same": True}],
    "lowest eigenvalue": [{"kind": "curves", "x": "contrast", "panels": ("scheme",), "lines": ("zone",), "log": "x", "only": "distortion",
                           "label": "lowest eigenvalue", "band": (0, 1e9), "no line": True, "same": True},
                          {"kind": "plane", "x": "contrast", "y": "distortion", "panels": ("scheme", "zone"), "log": "x", "where": ("scheme", "exchange"),
                           "label": "lowest eigenvalue"}],
    "iterations": [{"kind": "curves", "x": ("contrast", "Poisson ratio"), "panels": ("model", "cracks"), "lines": ("aspect ratio",), "log": "y",
                    "label": "iterations", "safe": "below"}],
    "heat lost by splice": [{"kind": "curves", "x": "time", "panels": ("scheme",), "lines": ("m",), "log": "y", "floor": 1e-16,
                             "label": "share of the heat gained or lost", "band": (1e-17, 1e-10), "same": True}],
}
UNITS = {"stages": "{} stages", "m": "m = {}", "cracks": "{} cracks", "aspect ratio": "cells 1 : {}"}


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
            raise StudyError(f"'{path}' has no '{key}': it is not from './run study stability'")
    return data


def number(value):
    """A number of the file, where infinity is a word."""
    return math.inf if value == "infinite" else math.nan if value is None else float(value)


def text_of(point, name):
    """A parameter as panels and lines name it."""
    value = point[name]
    return UNITS.get(name, "{}").format(style.plain(value, 3) if isinstance(value, (int, float)) else value)


def group_of(point, names):
    """The values of some parameters, of those that the point has."""
    return tuple(text_of(point, n) for n in names if point.get(n) not in (None, ""))


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
    """Ticks at 1, 2, 5 of a logarithmic axis that spans little, else at some powers of ten."""
    low, high = min(values), max(values)
    axis = axes.xaxis if which == "x" else axes.yaxis
    first, last = math.floor(math.log10(low)), math.ceil(math.log10(high))
    if last - first > 3:
        step = -(-(last - first) // 5)
        axis.set_major_locator(FixedLocator([10.0 ** e for e in range(first, last + 1, step)]))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"$10^{{{round(math.log10(value))}}}$"))
    else:
        places = [m * 10.0 ** e for e in range(first - 1, last + 1) for m in (1, 2, 5)]
        axis.set_major_locator(FixedLocator([p for p in places if low / 2 <= p <= high * 2]))
        axis.set_major_formatter(FuncFormatter(lambda value, _: style.plain(value, 2)))
    axis.set_minor_locator(FixedLocator([]))
    axis.set_minor_formatter(NullFormatter())


def chosen(points, how):
    """Those that a figure shows: of one entry alone the one most common."""
    if "where" in how:
        points = [p for p in points if p.get(how["where"][0]) == how["where"][1]]
    if "only" in how and points:
        values = [p.get(how["only"]) for p in points]
        points = [p for p in points if p.get(how["only"]) == max(set(values), key=values.count)]
    return points


def axis_of(points, how):
    """The parameter along x: the first of several that these points have."""
    names = (how["x"],) if isinstance(how["x"], str) else how["x"]
    return next((n for n in names if any(p.get(n) is not None for p in points)), names[0])


def shade(axes, here, how, x, span):
    """The safe region of a panel."""
    if "band" in how:
        axes.axhspan(*how["band"], color=SAFE, zorder=0, linewidth=0)
    elif how.get("safe"):
        least = {}
        for p in here:
            for place in [p[x]] if p.get(x) is not None else span:
                least[place] = min(least.get(place, math.inf), number(p["predicted"]))
        places = sorted(least)
        axes.fill_between(places, [least[q] for q in places], 1e-300, color=SAFE, zorder=0, linewidth=0)


def limits_of(here, how):
    """From where to where the numbers of a panel go."""
    values = [number(p["observed"]) for p in here] + ([] if how.get("no line") else [number(p["predicted"]) for p in here])
    values = [v for v in values if math.isfinite(v)]
    if "y" not in how["log"]:
        reach = max([abs(v) for v in values] + [2 * how["band"][1] if how.get("signed") else 1e-300]) * 1.15
        return (-reach if how.get("signed") else 0), reach
    values = [max(v, how.get("floor", 0)) for v in values]
    values = [v for v in values if v > 0] or [1]
    return min(values) / 1.6, max(values) * 1.6


def draw_line(axes, own, how, x, span, limits, color, label):
    """Predicted numbers as a line, observed ones as markers."""
    own = sorted(own, key=lambda p: p.get(x) or 0)
    has_x = own[0].get(x) is not None
    places = [p[x] for p in own] if has_x else list(span)
    predicted = [number(p["predicted"]) for p in own] if has_x else [number(own[0]["predicted"])] * 2
    observed = [min(max(number(p["observed"]), how.get("floor", -math.inf)), limits[1] / 1.1) for p in own]
    if how.get("no line") or not all(v > 0 or "y" not in how["log"] for v in predicted):
        axes.plot(places, observed if has_x else observed[:1] * 2, color=color, linewidth=1, alpha=0.7, zorder=2, label=label)
    else:
        axes.plot(places, predicted, color=color, linewidth=1.3, zorder=2, label=label)
    for place, value, p in zip(places if has_x else [max(span)], observed, own):
        axes.plot(place, value, MARKER[p["verdict"]], color=color, markersize=5, markerfacecolor="white", markeredgewidth=1.2, zorder=3)


def draw_curves(entry, how):
    """One panel for each combination of some parameters."""
    points = [p for p in chosen(entry["points"], how) if math.isfinite(number(p["observed"])) or (p["verdict"] == "fails")]
    panels = groups(points, how["panels"])
    if not panels:
        return None
    figure, all_axes = panels_of(len(panels))
    every_line = list(groups(points, how["lines"]))
    x = axis_of(points, how)
    for axes, (name, here) in zip(all_axes, panels.items()):
        xs = [p[x] for p in here if p.get(x) is not None] or [0, 1]
        span = (min(xs), max(xs))
        if "x" in how["log"] or span[1] > 1e3 * span[0] > 0:
            axes.set_xscale("log")
            few_ticks(axes, "x", xs)
        if "y" in how["log"]:
            axes.set_yscale("log")
        limits = limits_of(points if how.get("same") else here, how)
        shade(axes, here, how, x, span)
        for line, own in groups(here, how["lines"]).items():
            draw_line(axes, own, how, x, span, limits, LINES[every_line.index(line) % len(LINES)], title_of(line))
        axes.set_ylim(*limits)
        if "y" in how["log"]:
            few_ticks(axes, "y", limits)
        axes.set_title(title_of(name), loc="left")
        axes.set_xlabel(x)
        axes.set_ylabel(how["label"])
        style.tidy(axes)
    handles = {label: handle for axes in all_axes for handle, label in zip(*axes.get_legend_handles_labels())}
    if len(every_line) > 1:
        rows = -(-len(handles) // 4)
        figure.legend(handles.values(), handles.keys(), loc="lower center", ncols=4)
        figure.tight_layout(rect=(0, (0.1 + 0.2 * rows) / figure.get_figheight(), 1, 1))
    else:
        figure.tight_layout()
    return figure


def limit_line(here, how):
    """Where the limit runs through the plane: pairs (y, x)."""
    line = {p[how["y"]]: p[how["x"]] / p[how["limit"]] for p in here if p.get(how["y"]) is not None}
    return sorted(line.items())


def shade_plane(axes, here, how, left):
    """What lies before the predicted limit, or below the first point that is not safe."""
    if "limit" not in how:
        bad = [p[how["y"]] for p in here if p["verdict"] != "safe"]
        good = [p[how["y"]] for p in here if p["verdict"] == "safe" and p[how["y"]] < min(bad, default=math.inf)]
        if good:
            axes.axhspan(min(good), max(good), color=SAFE, zorder=0, linewidth=0)
        return
    limit = limit_line(here, how) or [(0, here[0][how["x"]] / here[0][how["limit"]])]
    if len(limit) == 1:
        limit = [(limit[0][0] - 0.5, limit[0][1]), (limit[0][0] + 0.5, limit[0][1])]
    axes.fill_betweenx([y for y, _ in limit], left, [x for _, x in limit], color=SAFE, zorder=0, linewidth=0)
    axes.plot([x for _, x in limit], [y for y, _ in limit], color=style.INK, linewidth=1.3, zorder=2)


def norm_of(points, how):
    """White is neither growth nor decay; or else all values."""
    finite = [number(p["observed"]) for p in points if math.isfinite(number(p["observed"]))] or [0, 1]
    if "limit" in how:
        return TwoSlopeNorm(1.0, min(0.5, min(finite)), 2.0)
    return Normalize(0, max(finite))


def draw_plane(entry, how):
    """Points coloured by what was observed; crosses are those that fail; the safe region shaded."""
    points = chosen(entry["points"], how)
    panels = groups(points, how["panels"])
    if not panels:
        return None
    figure, all_axes = panels_of(len(panels))
    norm, shown = norm_of(points, how), None
    colors = style.DIFFERENCE if "limit" in how else style.FLUX
    for axes, (name, here) in zip(all_axes, panels.items()):
        has_y = here[0].get(how["y"]) is not None
        xs = [p[how["x"]] for p in here]
        axes.set_xscale("log")
        margin = max(1.15, (max(xs) / min(xs)) ** 0.05)
        left, right = min(xs) / margin, max(xs) * margin
        shade_plane(axes, here, how, left)
        for verdict, marker in MARKER.items():
            own = [p for p in here if p["verdict"] == verdict]
            if own:
                values = [min(norm.vmax, number(p["observed"])) if math.isfinite(number(p["observed"])) else norm.vmax for p in own]
                shown = axes.scatter([p[how["x"]] for p in own], [p[how["y"]] if has_y else 0 for p in own], c=values, cmap=colors, norm=norm,
                                     marker=marker, s=34, edgecolors=style.INK if verdict == "safe" else FAILS, linewidths=0.6, zorder=3)
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
    figure.tight_layout(rect=(0, 0, 0.88, 1))
    box = all_axes[0].get_position()
    bar = figure.colorbar(shown, cax=figure.add_axes([0.9, box.y0, 0.015, box.height]), extend="max" if "limit" in how else "neither")
    bar.set_label(how["label"])
    return figure


def draw(entry, how):
    """A figure of a map, or None if it has no point that can be drawn."""
    return (draw_curves if how["kind"] == "curves" else draw_plane)(entry, how)


def caption(entry, how):
    """What is to be seen."""
    marks = "circles are safe, crosses fail, triangles are warned of, squares refused"
    if how["kind"] == "curves":
        only = ""
        if "only" in how:
            only = f" Of all points those with {how['only']} {style.plain(chosen(entry['points'], how)[0][how['only']])}."
        line = "" if how.get("no line") else f"Lines: {entry['predicted']}. "
        return f"{line}Markers: {entry['observed']}; {marks}. Shaded: safe.{only}"
    return f"Colours: {entry['observed']}; {marks}.{' Line: the predicted limit.' if 'limit' in how else ''} Shaded: safe."


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
    for name, own in groups(entry["points"], DRAWINGS[entry["name"]][0]["panels"]).items():
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
        for k, how in enumerate(DRAWINGS.get(entry["name"], []) if entry["points"] else []):
            figure = draw(entry, how)
            if figure:
                file = entry["name"].replace(" ", "_") + (f"_{k + 1}" if k else "")
                page.figure(figure, file, caption(entry, how), True, entry["name"].capitalize())
        if entry["name"] == "step limit":
            page.add(ratio_table(entry))
        if entry["left out"]:
            page.add('<ul class="notes">' + "".join(f"<li>{escape(reason)}</li>" for reason in entry["left out"]) + "</ul>")
    page.section("Files", "files")
    page.add('<ul class="files"><li><a href="stability.csv">stability.csv</a></li><li><a href="stability.json">stability.json</a></li></ul>')
    title = f"{data['title']}: stability"
    return page.html(title, f"<h1>{escape(title)}</h1><p><span>{escape(str(data['scene']))}</span></p>")
