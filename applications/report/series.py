# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Plots over time: probes and totals. Only the marked points are computed."""

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

import style
from curves import probe_name, probe_points
from read_run import EXACT

MARKER_SIZE = 4.5


class Panels:
    """A figure of small plots, three in a row, with one legend at its foot."""

    def __init__(self, n):
        self.columns = min(n, 3)
        self.height = 2.5 * -(-n // self.columns) + 0.3
        self.figure = style.figure(10, self.height)
        self.models, self.started = [], False

    def axes(self, k, title, words):
        """Axes of plot k."""
        axes = self.figure.add_axes(
            [(0.8 + (k % self.columns) * 9.1 / self.columns) / 10,
             (self.height - 0.3 - 2.5 * (k // self.columns) - 1.75) / self.height,
             (9.1 / self.columns - 0.75) / 10, 1.75 / self.height])
        axes.set_title(title, loc="left", fontsize=8.5)
        style.tidy(axes)
        axes.set_xlabel(words.time_axis(), labelpad=1)
        return axes

    def draw(self, axes, model, series, start=None):
        """One series of (time, value); start: the initial value."""
        series = sorted(series, key=lambda pair: pair[0])  # of one time in the order told
        if start is not None and series[0][0] > 0:
            axes.plot(0, start, linestyle="none", marker="D", markersize=MARKER_SIZE,
                      color="#52606d", zorder=6, clip_on=False)
            series, self.started = [(0.0, start)] + series, True
        time, value = np.array(series).T
        first = 1 if start is not None and self.started and time[0] == 0 else 0
        axes.plot(time, value, color=style.MODEL_COLOR.get(model, "#7b3294"), linewidth=1.0,
                  alpha=0.55, linestyle=style.MODEL_DASHES.get(model, "-"), zorder=3)
        axes.plot(time[first:], value[first:], **marker(model), zorder=5)
        self.models.append(model)

    def finish(self):
        """Time starts at 0 in every plot; the legend below all."""
        for axes in self.figure.axes:
            low, high = axes.get_xlim()
            axes.set_xlim(min(low, -0.02 * high), high)
            axes.xaxis.set_major_locator(MaxNLocator(nbins=5, steps=[1, 2, 5, 10]))
        handles = [Line2D([], [], label="exact solution" if m == EXACT else m, **marker(m))
                   for m in dict.fromkeys(self.models)]
        if self.started:
            handles.append(Line2D([], [], linestyle="none", marker="D", markersize=MARKER_SIZE,
                                  color="#52606d", label="initial value"))
        axes = self.figure.add_axes([0.08, 0.0, 0.9, 0.3 / self.height])
        axes.axis("off")
        axes.legend(handles=handles, loc="center left", ncol=5, borderaxespad=0)
        return self.figure


def marker(model):
    """The look of a computed point."""
    color = style.MODEL_COLOR.get(model, "#7b3294")
    if model == EXACT:
        return {"linestyle": "none", "marker": "+", "markersize": 6, "color": color}
    return {"linestyle": "none", "marker": style.MODEL_MARKER.get(model, "^"), "color": color,
            "markersize": MARKER_SIZE + (1 if model == "finite elements" else 0),
            "markerfacecolor": "white", "markeredgewidth": 1.1}


def is_zero(series_of_models, among):
    """Whether all values of all models are zero but for round-off."""
    return style.is_nothing(np.array([v for s in series_of_models for _, v in s]), among)


def probe_series(table, k):
    """{model: [(time, value)]} at probe k."""
    found = {m: [(t, v[1][k]) for t, v in table.data[m].items() if len(v[1]) > k]
             for m in table.models()}
    return {m: s for m, s in found.items() if s}


def probe_figure(run, words, at_most=9):
    """The probes over time: (figure or None, names of the probes that stay at zero)."""
    table = run.probes
    points = probe_points(table)
    if len(table.times()) < 3 or not len(points):
        return None, []
    shown, silent = [], []
    everything = np.array([v for m in table.data.values() for p in m.values() for v in p[1]])
    for k, point in enumerate(points):
        series = probe_series(table, k)
        target = silent if is_zero(series.values(), everything) else shown
        target.append((point, series))
    names = [probe_name(point) for point, _ in silent]
    if not shown:
        return None, names
    panels = Panels(min(len(shown), at_most))
    for k, (point, series) in enumerate(shown[:at_most]):
        axes = panels.axes(k, f"Probe {probe_name(point)}", words)
        for model, values in series.items():
            panels.draw(axes, model, values, run.initial_value(point))
        if k % panels.columns == 0:
            axes.set_ylabel(words.solution.label())
    return panels.finish(), names


def apart_figure(totals, words, quantity):
    """One quantity of totals.csv over time, drawn large; None with less than three times."""
    of_model = totals.get(quantity, {})
    if max(map(len, of_model.values()), default=0) < 3:
        return None
    panels = Panels(1)
    axes = panels.axes(0, "", words)
    axes.set_ylabel(words.total(quantity))
    for model, values in of_model.items():
        panels.draw(axes, model, values)
    return panels.finish()


def totals_figure(totals, words, at_most=6):
    """The other quantities over time: (figure or None, names of those that are zero)."""
    everything = np.array([v for q in totals.values() for s in q.values() for _, v in s])
    long = {q: of_model for q, of_model in totals.items()
            if max(len(series) for series in of_model.values()) >= 3
            and q not in words.plotted_apart}
    silent = [q for q, of_model in long.items() if is_zero(of_model.values(), everything)]
    shown = [q for q in long if q not in silent][:at_most]
    if not shown:
        return None, silent
    panels = Panels(len(shown))
    for k, quantity in enumerate(shown):
        axes = panels.axes(k, words.total(quantity), words)
        for model, values in totals[quantity].items():
            panels.draw(axes, model, values)
    return panels.finish(), silent
