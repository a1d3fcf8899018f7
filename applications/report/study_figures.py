# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""The line plots of a study: one column over another, lines labelled where they end."""

import numpy as np
from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, NullFormatter

import style
from words import Words, with_unit

ENTRY_MARK = "/"  # between the section and the name of an entry
COLORS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#b07d00", "#56b4e9", "#4d4d4d")  # Okabe-Ito, dark enough for text
MARKERS = ("o", "s", "D", "^", "v", "P", "X")
SECONDS = ("set-up time", "stepping time", "wall time")
BYTES = ("memory", "peak memory")
NO_ENTRIES = {"Models"}  # entries without a section

# What the convergence order is the slope of: with a minus where a larger number is a finer mesh.
SIGN_OF_ORDER = {"Domain/Cells": -1, "Domain/Node spacing": 1, "Peridynamics/Horizon": 1, "Time/Time step": 1}
ERRORS = ("relative l2 error", "maximum error")


class StudyError(Exception):
    """What is wrong with a file of a study."""


def number(value):
    """A value as a number: of '60, 60' the first. None if it is none."""
    if isinstance(value, bool) or value is None:
        return None
    if isinstance(value, str):
        value = value.replace(";", ",").split(",")[0].strip()
    try:
        value = float(value)
    except ValueError:
        return None
    return value if np.isfinite(value) else None


def last_lines(study):
    """The last line of each row and model."""
    last = {(line["name"], line.get("model")): line for line in study["table"]}
    return list(last.values())


def words_of(study):
    """Words and units of the first finished row, if all have the same."""
    runs = [row["run"] for row in study["rows"] if "run" in row]
    if not runs or any(run.get("units") != runs[0].get("units") or run.get("physics") != runs[0].get("physics") for run in runs):
        return None
    return Words(runs[0])


def label_of(study, column, bare=False):
    """How an axis names a column, with its unit; bare: without, for tables that write units into their cells."""
    if column in study["entries"]:
        text = column.split(ENTRY_MARK)[-1]
        lists = any("," in str(row["entries"].get(column)) for row in study["rows"])
        return text if bare or not lists else f"{text} in x" if text in ("Cells", "Upper corner") else f"{text} (first number)"
    text = title_of(column)
    words = words_of(study)
    if bare and column != "maximum error" or words is None and column not in SECONDS + BYTES:
        return text
    if words is not None and column in study.get("quantities", ()):
        return with_unit(text, unit_of_quantity(words, column))
    units = {"maximum error": words and words.solution.unit, "time": words and words.time,
             **{c: "s" for c in SECONDS}, **{c: "MB" for c in BYTES}}
    return with_unit(text, units.get(column))


def title_of(column):
    """A column at the start of a line."""
    first, *place = column.split(" at ")
    title = {"ux": "displacement in x", "uy": "displacement in y", "uz": "displacement in z",
             "von_mises": "von Mises stress"}.get(first, first)
    return style.name(" at ".join([title] + place)).replace(" l2 ", " L2 ")


def unit_of_quantity(words, column):
    """The unit of what runs have found."""
    first = column.split(" at ")[0]
    if first in ("K_I", "K_II"):
        return words.units.intensity
    if first == "largest force":
        return words.units.force
    if " at " in column:
        return words.column("value" if first == words.solution.name else first).unit
    return words.units.of_total(column)


def value_of(line, column):
    """The number that is drawn."""
    value = number(line.get(column))
    return value / 1e6 if value is not None and column in BYTES else value


def line_columns(study, wanted, lines):
    """The columns that tell the lines of a figure apart."""
    if wanted["lines"]:
        return wanted["lines"]
    candidates = ["model"] + study["entries"] + (["scene"] if len({row["scene"] for row in study["rows"]}) > 1 else [])
    return [c for c in candidates if c != wanted["x"] and len({str(line.get(c)) for line in lines}) > 1] or ["model"]


def line_name(key, columns, study):
    """What a line is called: values, those of entries with the entry's name."""
    parts = []
    for column, value in zip(columns, key):
        brief = column.split(ENTRY_MARK)[-1]
        if value is None:
            continue
        parts.append(f"{brief} = {value}" if column in study["entries"] and column not in NO_ENTRIES else str(value))
    return ", ".join(p for p in parts if p) or "all rows"


# Sections whose entries a model may not use; whether it does not is seen from its results.
FOREIGN = {"finite elements": ("Peridynamics/", "Coupling/"), "peridynamics": ("Finite elements/", "Coupling/")}
COSTS = ("name", "scene", "group", "x", "repeats", "message") + SECONDS + BYTES


def without_effect(study):
    """{model: entries that change nothing in its results}."""
    found = {}
    lines = [line for line in last_lines(study) if line.get("model") in FOREIGN]
    for model, sections in FOREIGN.items():
        own = [line for line in lines if line["model"] == model]
        idle = set()
        for entry in (e for e in study["entries"] if e.startswith(sections)):
            results = {}
            for line in own:
                rest = tuple(str(line.get(e)) for e in study["entries"] if e != entry and e not in idle)
                told = tuple((c, line.get(c)) for c in sorted(line) if c not in COSTS and c not in study["entries"])
                results.setdefault(rest + (line["scene"],), set()).add(str(told))
            if own and all(len(told) == 1 for told in results.values()):
                idle.add(entry)
        found[model] = idle
    return found


def collect(study, wanted):
    """({name: [(x, y)]} in the order of the rows, the names of x where it has no numbers)."""
    columns = [wanted["x"], wanted["y"]] + list(wanted["lines"])
    lines = study["table"] if "time" in columns else last_lines(study)
    lines = [line for line in lines if value_of(line, wanted["y"]) is not None and line.get(wanted["x"]) not in (None, "")]
    names = []
    if any(value_of(line, wanted["x"]) is None for line in lines):
        names = list(dict.fromkeys(str(line[wanted["x"]]) for line in lines))
    apart = line_columns(study, wanted, lines)
    found, idle = {}, without_effect(study)
    for line in lines:
        key = tuple(None if c in idle.get(line.get("model"), ()) else line.get(c) for c in apart)
        x = names.index(str(line[wanted["x"]])) if names else value_of(line, wanted["x"])
        settings = settings_of(study, line, idle.get(line.get("model"), ()))
        found.setdefault(line_name(key, apart, study), []).append((settings, x, value_of(line, wanted["y"])))
    found = {n: only_smallest(points) for n, points in found.items()}
    measured = wanted["x"] not in study["entries"] + ["x", "time"]
    return {n: points if measured else sorted(points) for n, points in found.items()}, names


def settings_of(study, line, idle):
    """What makes the results of a line where some entries are idle, so that other lines have the same; else None."""
    if not idle:
        return None
    return (line["scene"], line["model"], line.get("time")) + tuple(str(line.get(e)) for e in study["entries"] if e not in idle)


def only_smallest(points):
    """(x, y) of (settings, x, y); of the same that was computed again the smallest: times and memory differ."""
    smallest = {}
    for k, (settings, x, y) in enumerate(points):
        which = (k if settings is None else settings, x)
        smallest[which] = min(y, smallest.get(which, y))
    return [(x, y) for (_, x), y in smallest.items()]


def slope(points):
    """The least-squares slope of log y over log x, or None."""
    x, y = np.array(points, dtype=float).T
    if len(set(x)) < 2 or min(x) <= 0 or min(y) <= 0:
        return None
    return float(np.polyfit(np.log(x), np.log(y), 1)[0])


def slope_text(wanted, points, names):
    """', order 1.98' of an error over the fineness of the mesh, ', slope 1.98' of all else; only in log-log figures."""
    value = slope(points) if wanted["log"] and not names else None
    if value is None:
        return ""
    sign = SIGN_OF_ORDER.get(wanted["x"]) if wanted["y"] in ERRORS else None
    kind, value = ("order", sign * value) if sign else ("slope", value)
    return f", {kind} {f'{value:.2f}'.replace('-', '−')}"


def spread(positions, gap):
    """Positions from 0 to 1 moved as little as needed to be a gap apart; their order stays."""
    order = np.argsort(positions, kind="stable")
    moved = np.array(positions, dtype=float)
    gap = min(gap, 1.0 / max(len(moved) - 1, 1))
    for before, here in zip(order, order[1:]):
        moved[here] = max(moved[here], moved[before] + gap)
    excess = max(moved.max(initial=0) - 1.0, 0.0)
    if excess:
        moved[order[-1]] = 1.0
        for here, after in zip(order[-2::-1], order[::-1]):
            moved[here] = min(moved[here], moved[after] - gap)
    return moved


def add_labels(axes, ends, height):
    """The name of each line beside the right edge, joined with the line's end. ends: (x, y, text, colour)."""
    axes.set_xlim(axes.get_xlim())  # the limits are settled only when somebody asks for them
    axes.set_ylim(axes.get_ylim())
    to_axes = axes.transData + axes.transAxes.inverted()
    places = [to_axes.transform((x, y)) for x, y, _, _ in ends]
    gap = 0.33 if any("\n" in text for _, _, text, _ in ends) else 0.19  # inches
    moved = spread([min(max(p[1], 0.0), 1.0) for p in places], gap / height)
    for (_, _, text, color), place, y in zip(ends, places, moved):
        axes.plot([place[0], 1.02, 1.04], [place[1], y, y], transform=axes.transAxes, color=color, linewidth=0.6, alpha=0.6,
                  clip_on=False, zorder=2)
        axes.text(1.05, y, text, transform=axes.transAxes, color=color, fontsize=8, va="center", ha="left")


def set_axis(axis, values, logarithmic, names, given):
    """Ticks: words where there are no numbers; given numbers themselves where they are few."""
    short = FuncFormatter(lambda v, _: style.plain(v, 3))
    if names:
        axis.set_major_locator(FixedLocator(range(len(names))))
        axis.set_major_formatter(FuncFormatter(lambda v, _: names[int(round(v))] if 0 <= round(v) < len(names) else ""))
        return
    distinct = sorted(set(values))
    if given and len(distinct) <= 8 and (not logarithmic or np.all(np.diff(np.log(distinct)) > 0.25)):
        axis.set_major_locator(FixedLocator(distinct))
        axis.set_minor_locator(FixedLocator([]))
        axis.set_major_formatter(short)
    elif logarithmic and max(distinct) < 30 * min(distinct):  # too few powers of ten to read the axis by them
        axis.set_major_locator(LogLocator(subs=(1, 2, 3, 5)))
        axis.set_major_formatter(short)
        axis.set_minor_formatter(NullFormatter())
    elif logarithmic:
        axis.set_minor_formatter(NullFormatter())


def colors_of(lines):
    """A colour for each line: models have their own, the others share what is left."""
    taken = {style.MODEL_COLOR[line] for line in lines if line in style.MODEL_COLOR}
    free = [c for c in COLORS if c not in taken]
    others = [line for line in lines if line not in style.MODEL_COLOR]
    return {line: style.MODEL_COLOR[line] if line in style.MODEL_COLOR else free[others.index(line) % len(free)]
            for line in lines}


def wrapped(text, length=50):
    """A long name in two lines at most, at a comma."""
    if len(text) <= length or ", " not in text:
        return text
    parts = text.split(", ")
    cut = min(range(1, len(parts)), key=lambda k: abs(len(", ".join(parts[:k])) - len(text) / 2))
    return ", ".join(parts[:cut]) + ",\n" + ", ".join(parts[cut:])


def draw(study, wanted):
    """(figure, caption), or (None, why there is nothing to draw)."""
    lines, names = collect(study, wanted)
    if not lines:
        return None, f"no row has both '{wanted['x']}' and a number as '{wanted['y']}'."
    caption = "Orders and slopes are least-squares fits through all points of a line." if wanted["log"] and not names else ""
    y_label = label_of(study, wanted["y"])
    if wanted["log"] and any(y < 0 for points in lines.values() for _, y in points):
        lines = {n: [(x, abs(y)) for x, y in points] for n, points in lines.items()}
        y_label += ", absolute value"
    log_x = wanted["log"] and not names and all(x > 0 for points in lines.values() for x, _ in points)
    log_y = wanted["log"] and any(y > 0 for points in lines.values() for _, y in points)
    if log_y:
        kept = {n: [(x, y) for x, y in points if y > 0] for n, points in lines.items()}
        if any(len(kept[n]) < len(points) for n, points in lines.items()):
            caption += " Values of zero are not drawn."
        lines = {n: points for n, points in kept.items() if points}
    height = max(4.2, 0.42 * len(lines) + 0.9)
    figure = style.figure(10, height)
    axes = figure.add_axes([0.95 / 10, 0.6 / height, 5.6 / 10, (height - 0.8) / height])
    axes.set_xscale("log" if log_x else "linear")
    axes.set_yscale("log" if log_y else "linear")
    ends, colors = [], colors_of(list(lines))
    for k, (line, points) in enumerate(lines.items()):
        x, y = np.array(points, dtype=float).T
        color = colors[line]
        axes.plot(x, y, color=color, linewidth=1.5, marker=MARKERS[k % len(MARKERS)], markersize=4.5, markerfacecolor="white",
                  markeredgewidth=1.1, zorder=4)
        last = int(np.argmax(x))
        ends.append((x[last], y[last], wrapped(line + (slope_text(wanted, points, names) if log_x and log_y else "")), color))
    axes.set_xlabel(label_of(study, wanted["x"]))
    axes.set_ylabel(y_label)
    set_axis(axes.xaxis, [x for points in lines.values() for x, _ in points], log_x, names, wanted["x"] in study["entries"] + ["x"])
    set_axis(axes.yaxis, [y for points in lines.values() for _, y in points], log_y, [], False)
    style.tidy(axes)
    add_labels(axes, ends, height - 0.8)
    return figure, caption.strip()

