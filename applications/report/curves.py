# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Line plots: along the line, over 1D bodies, at the probes, totals and errors over time."""

import matplotlib
import numpy as np
from matplotlib.lines import Line2D

import style
from read_run import EXACT

FEM, PD = "finite elements", "peridynamics"


def time_colors(n):
    """Colours of the times: a dark-to-bright scale that survives greyscale printing."""
    return matplotlib.colormaps["viridis"](np.linspace(0.0, 0.82, n)) if n > 1 else None


def line_coordinate(points, units):
    """(values along the line, label of the axis)."""
    spread = np.ptp(points, axis=0)
    moving = np.flatnonzero(spread > 1e-12 * max(spread.max(), 1e-300))
    if len(moving) == 1:
        axis = int(moving[0])
        fixed = [f"{'xyz'[d]} = {style.plain(points[0, d])}" for d in range(points.shape[1])
                 if d != axis]
        label = units.axis("xyz"[axis])
        return points[:, axis], label + (f"   at {', '.join(fixed)}" if fixed else "")
    distance = np.linalg.norm(points - points[0], axis=1)
    ends = " to ".join("(" + ", ".join(style.plain(v) for v in p) + ")"
                       for p in (points[0], points[-1]))
    return distance, units.with_unit(f"Distance from {ends}", units.length)


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


def value_panel(axes, table, times, units, steady):
    """The values of all models at all times."""
    models, colors = table.models(), time_colors(len(times))
    for i, time in enumerate(times):
        for model in models:
            if table.at(model, time) is None:
                continue
            points, values = table.at(model, time)
            x, label = line_coordinate(points, units)
            draw_curve(axes, x, values, model, None if colors is None else colors[i])
            axes.set_xlabel(label)
    axes.set_ylabel(units.value())
    style.tidy(axes)
    first = model_legend(axes, models, colors is None, loc="upper left",
                         bbox_to_anchor=(1.01, 1.0))
    if colors is not None:
        axes.add_artist(first)
        axes.legend(handles=[Line2D([], [], color=colors[i], linewidth=2.5,
                                    label=units.at_time(t, steady)) for i, t in enumerate(times)],
                    loc="lower left", bbox_to_anchor=(1.01, 0.0))


def difference_panel(axes, table, times, units):
    """Against the exact solution where there is one, else peridynamics minus finite elements."""
    models, colors = table.models(), time_colors(len(times))
    if EXACT in models:
        pairs = [(m, EXACT) for m in models if m != EXACT]
    elif FEM in models and PD in models:
        pairs = [(PD, FEM)]
    else:
        return False
    for i, time in enumerate(times):
        for model, other in pairs:
            a, b = table.at(model, time), table.at(other, time)
            if a is None or b is None or len(a[1]) != len(b[1]):
                continue
            x, label = line_coordinate(a[0], units)
            draw_curve(axes, x, a[1] - b[1], model, None if colors is None else colors[i])
            axes.set_xlabel(label)
    axes.axhline(0, color="#9aa5b1", linewidth=0.8, zorder=1)
    title = "Model − exact" if pairs[0][1] == EXACT else "PD − FEM"
    axes.set_ylabel(units.with_unit(title, units.temperature))
    style.tidy(axes)
    return True


def line_figure(table, units, steady, at_most=6):
    """The temperature along the line, and differences below; None without rows."""
    times = table.times()
    if not times:
        return None
    if len(times) > at_most:
        times = [times[int(round(i))] for i in np.linspace(0, len(times) - 1, at_most)]
    models = table.models()
    two = EXACT in models or (FEM in models and PD in models)
    height = 5.6 if two else 3.7
    figure = style.figure(10, height)
    top = figure.add_axes([0.85 / 10, (2.35 if two else 0.6) / height, 7.35 / 10, 3.0 / height])
    value_panel(top, table, times, units, steady)
    if two:
        bottom = figure.add_axes([0.85 / 10, 0.55 / height, 7.35 / 10, 1.6 / height], sharex=top)
        difference_panel(bottom, table, times, units)
        top.set_xlabel("")
        top.tick_params(labelbottom=False)
    return figure


def field_table(run, indices):
    """1D: the nodal values of the fields as a table of the kind of line.csv."""
    from read_run import Table
    table = Table()
    table.dimension = 1
    for index in indices:
        time = run.written_times()[index]
        for model in run.models:
            if run.field_file(index, model) is None:
                continue
            mesh = run.mesh(index, model)
            order = mesh.cells[np.argsort(mesh.nodes[mesh.cells].mean(axis=1)[:, 0])].ravel()
            values = run.field(index, model, "temperature")
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


def probe_figure(table, units, at_most=9):
    """The probes over time; None for fewer than three times."""
    times, points = table.times(), probe_points(table)
    if len(times) < 3 or not len(points):
        return None
    n = min(len(points), at_most)
    columns = min(n, 3)
    rows = -(-n // columns)
    height = 2.5 * rows + 0.3
    figure = style.figure(10, height)
    for k in range(n):
        box = [(0.8 + (k % columns) * 9.1 / columns) / 10,
               (height - 0.3 - 2.5 * (k // columns) - 1.75) / height,
               (9.1 / columns - 0.75) / 10, 1.75 / height]
        axes = figure.add_axes(box)
        for model in table.models():
            series = sorted((t, v[1][k]) for t, v in table.data[model].items() if len(v[1]) > k)
            draw_curve(axes, *np.array(series).T, model)
        axes.set_title(f"Probe {probe_name(points[k])}", loc="left", fontsize=8.5)
        style.tidy(axes)
        axes.set_xlabel(units.with_unit("Time", units.time), labelpad=1)
        if k % columns == 0:
            axes.set_ylabel(units.value())
    place_legend_below(figure, table.models(), height)
    return figure


def place_legend_below(figure, models, height):
    """One legend of the models at the foot of a figure."""
    axes = figure.add_axes([0.08, 0.0, 0.9, 0.3 / height])
    axes.axis("off")
    model_legend(axes, models, True, loc="center left", ncol=4, borderaxespad=0)


def totals_figure(totals, units, at_most=6):
    """The quantities of totals.csv over time; None where none has three times."""
    shown = [q for q, of_model in totals.items()
             if max(len(series) for series in of_model.values()) >= 3][:at_most]
    if not shown:
        return None
    columns = min(len(shown), 3)
    rows = -(-len(shown) // columns)
    height = 2.5 * rows + 0.3
    figure = style.figure(10, height)
    models = []
    for k, quantity in enumerate(shown):
        axes = figure.add_axes([(0.8 + (k % columns) * 9.1 / columns) / 10,
                                (height - 0.3 - 2.5 * (k // columns) - 1.75) / height,
                                (9.1 / columns - 0.75) / 10, 1.75 / height])
        for model, series in totals[quantity].items():
            draw_curve(axes, *np.array(sorted(series)).T, model)
            models.append(model)
        axes.set_title(quantity, loc="left", fontsize=8.5)
        style.tidy(axes)
        axes.set_xlabel(units.with_unit("Time", units.time), labelpad=1)
    place_legend_below(figure, list(dict.fromkeys(models)), height)
    return figure


def flux_figure_1d(run, index, units):
    """The heat flux over a 1D body, or None without such a field."""
    from contours import flux_parts
    figure = style.figure(10, 3.2)
    axes = figure.add_axes([0.085, 0.19, 0.735, 0.74])
    drawn = []
    for model in run.models:
        values = flux_parts(run, index, model) if run.field_file(index, model) else None
        if values is None:
            continue
        mesh = run.mesh(index, model)
        order = mesh.cells[np.argsort(mesh.nodes[mesh.cells].mean(axis=1)[:, 0])].ravel()
        draw_curve(axes, mesh.nodes[order, 0], values[order, 0], model)
        drawn.append(model)
    if not drawn:
        return None
    axes.set_xlabel(units.axis("x"))
    axes.set_ylabel("Heat flux")
    style.tidy(axes)
    model_legend(axes, drawn, True, loc="upper left", bbox_to_anchor=(1.01, 1.0))
    return figure
