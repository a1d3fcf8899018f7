# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Cracks that ran through breaking bonds: their length and the speed of their tips over time."""

from matplotlib.lines import Line2D

import style
from loading import draw, from_zero, legend_below, model_look, n_times, panel

LENGTH, AREA, DAMAGED, NUMBER = "crack length", "crack area", "damaged volume", "number of tips"
OF_TIP = ("tip x at ", "tip y at ", "tip z at ", "crack length at ", "tip speed at ")
TIP_COLORS = ("#d55e00", "#0072b2", "#009e73", "#cc79a7", "#e69f00", "#56b4e9")


def is_of_cracks(quantity):
    """Whether a quantity of totals.csv tells of new cracks."""
    return quantity in (LENGTH, AREA, DAMAGED, NUMBER) or quantity.startswith(OF_TIP)


def measure(run):
    """The name of what the new cracks have: a length or an area; None where nothing broke."""
    for name in (LENGTH, AREA):
        if any(v > 0 for series in run.totals.get(name, {}).values() for _, v in series):
            return name
    return None


def tips(run, before):
    """[name of a tip] of those with a quantity of the form `tip speed at NAME`."""
    return [q[len(before):] for q in run.totals if q.startswith(before)]


def drawn_quantities(run):
    """Names in totals.csv of all that the figure shows, and of places, which it leaves out."""
    return {q for q in run.totals if is_of_cracks(q)}


def ways(run, name):
    """{where: of_models} of the curves of lengths: of all cracks, and of the path of each tip."""
    found = {"all": run.totals[name]}
    found.update((tip, run.totals[f"{LENGTH} at {tip}"]) for tip in tips(run, f"{LENGTH} at ")[:len(TIP_COLORS)]
                 if name == LENGTH)
    return found


def draw_curves(axes, run, curves, colors):
    """Each curve in its colour, models by their dashes."""
    for where, of_models in curves.items():
        for model, series in of_models.items():
            draw(axes, series, colors[where], **model_look(model, run))
    axes.margins(y=0.08)
    axes.axhline(0, color="#9aa5b1", linewidth=0.8, zorder=1)


def figure(run, words):
    """Length over time and below it the speeds of the tips, in motion; None with less than three times."""
    name = measure(run)
    if name is None or n_times(run) < 3:
        return None
    listed = list(dict.fromkeys(tips(run, f"{LENGTH} at ") + tips(run, "tip speed at ")))[:len(TIP_COLORS)]
    colors = {"all": "#000000", **{tip: TIP_COLORS[k] for k, tip in enumerate(listed)}}
    speeds = {tip: run.totals[f"tip speed at {tip}"] for tip in listed if f"tip speed at {tip}" in run.totals}
    height = 3.4 + (1.9 if speeds else 0.0)
    drawn = style.figure(10, height)
    panels = [panel(drawn, 0.95, height - 2.6, 8.7, 2.1)]
    draw_curves(panels[0], run, ways(run, name), colors)
    panels[0].set_title(words.total(name), loc="left", fontsize=8.5)
    if speeds:
        panels.append(panel(drawn, 0.95, 0.8, 8.7, 1.5, sharex=panels[0]))
        draw_curves(panels[1], run, speeds, colors)
        panels[1].set_title(words.total("tip speed"), loc="left", fontsize=8.5)
        panels[0].tick_params(labelbottom=False)
        panels[0].xaxis.get_offset_text().set_visible(False)
    from_zero(panels[-1])
    panels[-1].set_xlabel(words.time_axis(), labelpad=1)
    shown = ["all"] + [tip for tip in listed if tip in speeds or name == LENGTH]
    handles = [Line2D([], [], label="all new cracks" if where == "all" else f"from {where}", color=colors[where], linewidth=2)
               for where in shown]
    if len(run.models) > 1:
        handles += [Line2D([], [], label=style.name(m), color="#52606d", linestyle=model_look(m, run)["dashes"])
                    for m in run.totals[name]]
    legend_below(drawn, handles)
    return drawn


def caption(run):
    """How to read the figure."""
    name = measure(run)
    text = f"The {name.split()[1]} of new cracks: the shares of all broken bonds"
    if name == LENGTH and tips(run, f"{LENGTH} at "):
        text += "; in colour the path from the end of a crack to its tip"
    text += "."
    if tips(run, "tip speed at "):
        text += " Below, the speed of the tips: the slope over the last four horizons of their path."
    return text
