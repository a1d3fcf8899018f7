# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Curves of elastic bodies: displacements and stresses along the line and at probes."""

import numpy as np
from matplotlib.lines import Line2D

import curves
import series
import style
from curves import probe_name, probe_points

ROUND_OFF = 1e-9


def values_of(table):
    """All values of a column."""
    return np.concatenate([v for of_model in table.data.values() for _, v in of_model.values()]
                          or [np.zeros(1)])


def kind(column):
    """Columns that are measured by the same scale: displacements, stresses, others alone."""
    return "displacement" if column in ("ux", "uy", "uz") else \
        "stress" if column == "von_mises" or column.startswith("s") else column


def worth_drawing(columns):
    """(columns to draw, those that are zero but for round-off beside others of their kind)."""
    sizes = {c: float(np.abs(v[np.isfinite(v)]).max(initial=0))
             for c, v in ((c, values_of(t)) for c, t in columns.items())}
    shown, silent = [], []
    for column, size in sizes.items():
        among = max(s for c, s in sizes.items() if kind(c) == kind(column))
        (shown if size > ROUND_OFF * among else silent).append(column)
    return shown, silent


def line_figure(run, words, cracks, at_most=6):
    """Every column of line.csv in axes of its own, all models in each: (figure, silent columns)."""
    shown, silent = worth_drawing(run.line_columns)
    times = run.line.times()
    if not times or not shown:
        return None, silent
    if len(times) > at_most:
        times = [times[int(round(i))] for i in np.linspace(0, len(times) - 1, at_most)]
    colors, models = curves.time_colors(len(times)), run.line.models()
    rows = -(-len(shown) // 2)
    height = 2.6 * rows + 0.45
    figure = style.figure(10, height)
    for k, column in enumerate(shown):
        bottom = height - 0.45 - 2.6 * (k // 2) - 1.75
        axes = figure.add_axes([(0.75 + 5.0 * (k % 2)) / 10, bottom / height, 4.1 / 10,
                                1.75 / height])
        table = run.line_columns[column]
        for i, time in enumerate(times):
            for model in models:
                if table.at(model, time) is None:
                    continue
                points, values = table.at(model, time)
                x, label = curves.line_coordinate(points, words)
                curves.draw_curve(axes, *curves.broken(points, cracks, x, values), model,
                                  None if colors is None else colors[i])
        curves.draw_cracks(axes, points, x, cracks)
        axes.set_title(words.column(column).label(), loc="left", fontsize=8.5)
        style.tidy(axes)
        if k >= len(shown) - 2:
            axes.set_xlabel(label, labelpad=1)
    legend = figure.add_axes([0.07, 0.0, 0.92, 0.3 / height])
    legend.axis("off")
    first = curves.model_legend(legend, models, colors is None, loc="center left", ncol=4,
                                borderaxespad=0)
    if colors is not None:
        legend.add_artist(first)
        legend.legend(handles=[Line2D([], [], color=colors[i], linewidth=2.5,
                                      label=words.at_time(t)) for i, t in enumerate(times)],
                      loc="center right", ncol=len(times), borderaxespad=0)
    return figure, silent


def probe_figure(run, words, at_most=9):
    """Displacements and von Mises stress at the probes over time: (figure or None, silent)."""
    columns = {c: t for c, t in run.probe_columns.items()
               if kind(c) == "displacement" or c in ("von_mises", "damage", "temperature")}
    if len(run.probes.times()) < 3 or not columns:
        return None, []
    shown, silent = [], []
    for k, point in enumerate(probe_points(run.probes)):
        for column, table in columns.items():
            of_models = series.probe_series(table, k)
            target = silent if series.is_zero(of_models.values(), values_of(table)) else shown
            target.append((f"{words.column(column).label(column)} at {probe_name(point)}",
                           of_models))
    if not shown:
        return None, [title for title, _ in silent]
    panels = series.Panels(min(len(shown), at_most))
    for k, (title, of_models) in enumerate(shown[:at_most]):
        axes = panels.axes(k, title, words)
        for model, values in of_models.items():
            panels.draw(axes, model, values)
    return panels.finish(), [title for title, _ in silent]
