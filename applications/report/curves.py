# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Line plots: along the line and over 1D bodies."""

import matplotlib
import numpy as np
from matplotlib.lines import Line2D

import style
from crossings import crossed
from read_run import EXACT, Table
from words import with_unit

FEM, PD = "finite elements", "peridynamics"


def time_colors(n):
    """Colours of the times: a dark-to-bright scale that survives greyscale printing."""
    return matplotlib.colormaps["viridis"](np.linspace(0.0, 0.82, n)) if n > 1 else None


def line_coordinate(points, words):
    """(values along the line, label of the axis)."""
    spread = np.ptp(points, axis=0)
    moving = np.flatnonzero(spread > 1e-12 * max(spread.max(), 1e-300))
    if len(moving) == 1:
        axis = int(moving[0])
        fixed = [f"{'xyz'[d]} = {style.plain(points[0, d])}" for d in range(points.shape[1])
                 if d != axis]
        label = words.axis("xyz"[axis])
        return points[:, axis], label + (f"   at {', '.join(fixed)}" if fixed else "")
    distance = np.linalg.norm(points - points[0], axis=1)
    ends = " to ".join("(" + ", ".join(style.plain(v) for v in p) + ")"
                       for p in (points[0], points[-1]))
    return distance, with_unit(f"Distance from {ends}", words.length)


def broken(points, cracks, *columns):
    """Columns of numbers with a gap wherever a crack lies between two points."""
    gaps = crossed(points, cracks)[0] + 1
    return [np.insert(c.astype(float), gaps, np.nan) for c in columns]


def draw_cracks(axes, points, x, cracks):
    """Thin upright lines where a line of points crosses cracks."""
    for i, share in zip(*crossed(points, cracks)):
        axes.axvline(x[i] + share * (x[i + 1] - x[i]), color="black", linewidth=0.9, zorder=1.5)


def draw_curve(axes, x, y, model, color=None, label=None):
    """One curve in the style of its model."""
    color = style.MODEL_COLOR.get(model, "#7b3294") if color is None else color
    if model == EXACT:
        axes.plot(x, y, color="black", linewidth=1.3, linestyle=(0, (1, 1.5)), zorder=5,
                  label=label)
        return
    marked = model != FEM
    axes.plot(x, y, color=color, linewidth=1.6, linestyle=style.MODEL_DASHES.get(model, "-"),
              marker=style.MODEL_MARKER.get(model, "^") if marked else None, markersize=4,
              markerfacecolor="white", markeredgewidth=1.0,
              markevery=max(1, len(x) // 24) if marked else None, zorder=3, label=label)


def model_legend(axes, models, colored, **kwargs):
    """Legend of the models; grey lines where colour stands for time."""
    handles = []
    for model in models:
        color = style.MODEL_COLOR.get(model, "#7b3294") if colored else "#52606d"
        if model == EXACT:
            color = "black"
        marked = model not in (FEM, EXACT)
        handles.append(Line2D([], [], color=color, linewidth=1.5,
                              linestyle=style.MODEL_DASHES.get(model, "-"),
                              marker=style.MODEL_MARKER.get(model, "^") if marked else None,
                              markersize=4, markerfacecolor="white",
                              label=model if model != EXACT else "exact solution"))
    return axes.legend(handles=handles, **kwargs)


def value_panel(axes, table, times, words, field, steady, cracks):
    """The values of all models at all times."""
    models, colors = table.models(), time_colors(len(times))
    for i, time in enumerate(times):
        for model in models:
            if table.at(model, time) is None:
                continue
            points, values = table.at(model, time)
            x, label = line_coordinate(points, words)
            draw_curve(axes, *broken(points, cracks, x, values), model,
                       None if colors is None else colors[i])
            axes.set_xlabel(label)
    draw_cracks(axes, points, x, cracks)
    axes.set_ylabel(field.label())
    if field.span:
        low, high = field.span
        axes.set_ylim(low - 0.03 * (high - low), high + 0.03 * (high - low))
    style.tidy(axes)
    first = model_legend(axes, models, colors is None, loc="upper left",
                         bbox_to_anchor=(1.01, 1.0))
    if colors is not None:
        axes.add_artist(first)
        axes.legend(handles=[Line2D([], [], color=colors[i], linewidth=2.5,
                                    label=words.at_time(t, steady)) for i, t in enumerate(times)],
                    loc="lower left", bbox_to_anchor=(1.01, 0.0))


def difference_pairs(table):
    """The pairs (model, what it is compared with) that differ by more than round-off."""
    models = table.models()
    pairs = [(m, EXACT) for m in models if m != EXACT] if EXACT in models else \
        [(PD, FEM)] if FEM in models and PD in models else []

    def differ(model, other):
        for time, (_, values) in table.data[model].items():
            compared = table.at(other, time)
            if compared is not None and len(compared[1]) == len(values) \
                    and not style.is_nothing(values - compared[1], values):
                return True
        return False

    return pairs if any(differ(*pair) for pair in pairs) else []


def difference_panel(axes, table, times, words, field, cracks):
    """Against the exact solution where there is one, else peridynamics minus finite elements."""
    pairs, colors = difference_pairs(table), time_colors(len(times))
    for i, time in enumerate(times):
        for model, other in pairs:
            a, b = table.at(model, time), table.at(other, time)
            if a is None or b is None or len(a[1]) != len(b[1]):
                continue
            x, label = line_coordinate(a[0], words)
            draw_curve(axes, *broken(a[0], cracks, x, a[1] - b[1]), model,
                       None if colors is None else colors[i])
            axes.set_xlabel(label)
    axes.axhline(0, color="#9aa5b1", linewidth=0.8, zorder=1)
    title = "Model − exact" if pairs[0][1] == EXACT else "PD − FEM"
    axes.set_ylabel(field.label(title))
    style.tidy(axes)


def line_figure(table, words, field, steady, cracks=(), at_most=6):
    """A field along the line, and differences below; None without rows.

    Curves have a gap at each crack (those of the last time) that the line crosses.
    """
    times = table.times()
    if not times:
        return None
    if len(times) > at_most:
        times = [times[int(round(i))] for i in np.linspace(0, len(times) - 1, at_most)]
    two = bool(difference_pairs(table))
    height = 5.6 if two else 3.7
    figure = style.figure(10, height)
    top = figure.add_axes([0.85 / 10, (2.35 if two else 0.6) / height, 7.35 / 10, 3.0 / height])
    value_panel(top, table, times, words, field, steady, cracks)
    if two:
        bottom = figure.add_axes([0.85 / 10, 0.55 / height, 7.35 / 10, 1.6 / height], sharex=top)
        difference_panel(bottom, table, times, words, field, cracks)
        top.set_xlabel("")
        top.tick_params(labelbottom=False)
    return figure


def field_table(run, indices, field):
    """1D: the nodal values of a field as a table of the kind of line.csv."""
    table = Table()
    table.dimension = 1
    for index in indices:
        time = run.written_times()[index]
        for model in run.models:
            if run.field_file(index, model) is None:
                continue
            mesh = run.mesh(index, model)
            order = mesh.cells[np.argsort(mesh.nodes[mesh.cells].mean(axis=1)[:, 0])].ravel()
            values = run.field(index, model, field.name, not run.words.elastic)
            if values is None:
                continue
            table.data.setdefault(model, {})[time] = (mesh.nodes[order], values[order])
    return table


def probe_points(table):
    """The distinct probes, in the order of the file."""
    for of_model in table.data.values():
        for points, _ in of_model.values():
            return points
    return np.empty((0, table.dimension))


def probe_name(point):
    """'(0, 0.1)', or 'x = 1' in one dimension."""
    if len(point) == 1:
        return f"x = {style.plain(point[0])}"
    return "(" + ", ".join(style.plain(v) for v in point) + ")"
