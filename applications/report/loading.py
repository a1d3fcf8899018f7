# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""How an elastic body was loaded and broke: forces on its sides, broken bonds, energies over time.

A body is loaded slowly where its loads depend on t and it is at rest at every time: its run is not
steady, and yet no model has a time stepper.
"""

import re
from dataclasses import dataclass

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

import style
from words import with_unit

BROKEN, DISSIPATED, RELEASED = "broken bonds", "energy dissipated", "energy released by broken bonds"
WORK = "work of loads and supports"
# Colour and dashes of each energy; the work is dashed, as it hides the strain energy of a whole
# body.
ENERGIES = {WORK: ("#000000", (0, (4, 2))), "strain energy": ("#0072b2", "-"),
            "kinetic energy": ("#009e73", "-"), DISSIPATED: ("#d55e00", "-")}
SIDE_COLORS = ("#d55e00", "#0072b2", "#009e73", "#cc79a7", "#e69f00", "#56b4e9")
ROUND_OFF = 1e-6  # of solvers: forces of two sides that agree to this are equal and opposite
SMALL = 1e-9  # of the size of forces in the body (summary.json, `force balance`): round-off
FEW = 45  # up to so many points are marked


@dataclass
class Force:
    """The force on a side in the direction in which it is largest, {model: [(time, value)]}."""

    side: str
    axis: str
    of_models: dict
    condition: str = ""

    @property
    def quantity(self):
        """Its name in totals.csv."""
        return f"force on {self.side} in {self.axis}"

    def peak(self, model=None):
        """(time, value) where its magnitude is largest, of one model or of all."""
        found = [max(s, key=lambda pair: abs(pair[1])) for m, s in self.of_models.items()
                 if model in (None, m)]
        return max(found, key=lambda pair: abs(pair[1]))

    def is_constant(self, model):
        """Whether it is the same at all times."""
        values = [v for _, v in self.of_models[model]]
        return np.ptp(values) <= ROUND_OFF * np.abs(values).max()

    def is_opposite(self, other):
        """Whether it balances another one at all times."""
        if self.axis != other.axis or self.of_models.keys() != other.of_models.keys():
            return False
        slack = ROUND_OFF * abs(self.peak()[1])
        pairs = ((self.of_models[m], other.of_models[m]) for m in self.of_models)
        return all(len(a) == len(b) and all(abs(v + w) <= slack for (_, v), (_, w) in zip(a, b))
                   for a, b in pairs)


def is_slow(run):
    """Whether the body went from one equilibrium to the next."""
    return run.words.elastic and not run.get("steady", default=False) \
        and not any("stepper" in entry for entry in run.summary["models"].values())


def can_break(run):
    """Whether bonds could break."""
    return BROKEN in run.totals


def is_loaded(condition):
    """Whether a condition of a side moves or pulls it: some component is not 0."""
    parts = re.split("[,;]", re.sub(r"\b(displacement|traction|symmetry|free)\b", "", condition))
    for part in filter(None, map(str.strip, parts)):
        try:
            if float(part) != 0:
                return True
        except ValueError:
            return True
    return False


def in_time(series):
    """Pairs (time, value) in the order of time; of a time at which bonds break that before comes first."""
    return sorted(series, key=lambda pair: pair[0])


def largest_component(run, side, condition=""):
    """The force on a side in its largest component, or None where it is 0 or unknown."""
    found = [Force(side, axis, of_models, condition) for axis in "xyz"[:run.dimension]
             for of_models in [{m: in_time(s) for m, s in
                                run.totals.get(f"force on {side} in {axis}", {}).items()
                                if m in run.models}] if of_models]
    force = max(found, key=lambda f: abs(f.peak()[1]), default=None)
    return force if force is not None and force.peak()[1] != 0 else None


def forces(run):
    """([forces on the sides that move or are loaded], [those that are equal and opposite to one]).

    Where none of them ever changes, no force is among the first.

    Where no side is loaded (a body force, an initial velocity), those on all sides. What is round-off beside the size of forces in
    the body, as where two arms cancel, is none.
    """
    sides = [f for s, c in run.sides().items() if (f := largest_component(run, s, c)) is not None]
    scale = max(((run.summary["models"][m].get("force balance") or {}).get("scale", 0) for m in run.models), default=0)
    real = [f for f in sides if abs(f.peak()[1]) > SMALL * scale]
    found = [f for f in real if is_loaded(f.condition)] or real
    shown, opposite = [], []
    for force in sorted(found, key=lambda f: f.peak()[1] < 0):  # a pull, rather than its support
        mirrored = any(force.is_opposite(other) for other in shown)
        (opposite if mirrored else shown).append(force)
    if all(f.is_constant(m) for f in shown for m in f.of_models):
        return [], shown + opposite
    return shown, opposite


def first_break(run):
    """{model: time at which the first bonds broke, that of the first row with broken bonds in older results}."""
    found = {m: [t for t, v in in_time(s) if v > 0] for m, s in run.totals.get(BROKEN, {}).items()}
    return {m: run.summary["models"].get(m, {}).get("first broken bonds", times[0]) for m, times in found.items() if times}


def n_times(run):
    """How many times totals.csv has."""
    return max((len(s) for of_model in run.totals.values() for s in of_model.values()), default=0)


def draw(axes, series, color, dashes="-", marker="o"):
    """One curve; its points are marked where they are few."""
    time, value = np.array(in_time(series)).T
    axes.plot(time, value, color=color, linestyle=dashes, linewidth=1.5, zorder=3,
              marker=marker if len(time) <= FEW else None, markersize=3.2,
              markerfacecolor="white", markeredgewidth=0.9)


def model_look(model, run):
    """Arguments of draw() that tell a model from others."""
    return {"dashes": style.MODEL_DASHES.get(model, "-") if len(run.models) > 1 else "-",
            "marker": style.MODEL_MARKER.get(model) or "^"}


def panel(figure, left, bottom, width, height, **shared):
    """Axes in inches."""
    axes = figure.add_axes([left / figure.get_figwidth(), bottom / figure.get_figheight(),
                            width / figure.get_figwidth(), height / figure.get_figheight()],
                           **shared)
    style.tidy(axes)
    axes.xaxis.set_major_locator(MaxNLocator(nbins=6, steps=[1, 2, 2.5, 5, 10]))
    return axes


def legend_below(figure, handles):
    """The legend at the foot."""
    axes = figure.add_axes([0.07, 0.0, 0.92, 0.3 / figure.get_figheight()])
    axes.axis("off")
    axes.legend(handles=handles, loc="center left", ncol=5, borderaxespad=0)


def force_legend(run, shown):
    """Colours are models, or sides where there are several; then dashes are models."""
    drawn = [f.of_models for f in shown] + [run.totals.get(BROKEN, {})]
    models = [m for m in run.models if any(m in of_models for of_models in drawn)]
    look = {m: model_look(m, run) for m in models}
    if len(shown) < 2:
        return [Line2D([], [], label=m, color=style.MODEL_COLOR.get(m, "#7b3294"), markersize=4,
                       linestyle=look[m]["dashes"], markerfacecolor="white",
                       marker=look[m]["marker"] if n_times(run) <= FEW else None) for m in models]
    sides = [Line2D([], [], label=f"{f.side}, in {f.axis}", color=SIDE_COLORS[k % 6], linewidth=2.5)
             for k, f in enumerate(shown)]
    return sides + [Line2D([], [], label=m, color="#52606d", linestyle=look[m]["dashes"])
                    for m in models]


def draw_forces(axes, run, shown):
    """The panel of the forces."""
    for k, force in enumerate(shown):
        for model, series in force.of_models.items():
            color = style.MODEL_COLOR.get(model, "#7b3294") if len(shown) == 1 \
                else SIDE_COLORS[k % 6]
            draw(axes, series, color, **model_look(model, run))
    axes.margins(y=0.08)
    axes.axhline(0, color="#9aa5b1", linewidth=0.8, zorder=1)
    axes.set_title(force_title(run, shown), loc="left", fontsize=8.5)


def force_title(run, shown):
    """What the axis of forces is."""
    return run.words.total(shown[0].quantity) if len(shown) == 1 else \
        with_unit("Forces on the sides", run.words.units.force)


def draw_broken(axes, run):
    """The panel of the broken bonds."""
    axes.set_title("Broken bonds", loc="left", fontsize=8.5)
    axes.yaxis.set_major_locator(MaxNLocator(nbins=4, integer=True))
    for model, series in run.totals[BROKEN].items():
        draw(axes, series, style.MODEL_COLOR.get(model, "#7b3294"), **model_look(model, run))


def force_figure(run, words, shown):
    """Forces over time, and the broken bonds below; None with less than three times."""
    if n_times(run) < 3 or not (shown or can_break(run)):
        return None
    height = (3.0 if shown else 0.0) + (1.4 if can_break(run) else 0.0) + 0.75
    figure, panels = style.figure(10, height), []
    if shown:
        panels.append(panel(figure, 0.95, height - 2.95, 8.7, 2.45))
        draw_forces(panels[0], run, shown)
    if can_break(run):
        panels.append(panel(figure, 0.95, 0.8, 8.7, 1.05, **({"sharex": panels[0]} if shown else {})))
        draw_broken(panels[-1], run)
    for time in first_break(run).values():
        for axes in panels:
            axes.axvline(time, color="#52606d", linewidth=0.9, linestyle=(0, (1, 2)), zorder=2)
    from_zero(panels[-1])
    panels[-1].set_xlabel(words.time_axis(), labelpad=1)
    for axes in panels[:-1]:
        axes.tick_params(labelbottom=False)
        axes.xaxis.get_offset_text().set_visible(False)
    legend_below(figure, force_legend(run, shown))
    return figure


def from_zero(axes):
    """Time starts at 0, though a motion has its first row at its first time of output."""
    low, high = axes.get_xlim()
    axes.set_xlim(min(low, -0.02 * high), high)


def travel(run, force):
    """{model: [(displacement, force)]} of a side in the direction of its force, in the order of time.

    Empty where the displacement is not known at the same times or hardly changes.
    """
    moved = run.totals.get(f"displacement of {force.side} in {force.axis}", {})
    found = {}
    for model, series in force.of_models.items():
        at = dict(moved.get(model, []))
        pairs = [(at[t], v) for t, v in series if t in at]
        if len(pairs) == len(series) >= 3 and np.ptp([u for u, _ in pairs]) > 0:
            found[model] = pairs
    return found


def travel_figure(run, words, shown):
    """Forces over the displacements of their sides: (figure or None, the forces drawn)."""
    drawn = [(force, travel(run, force)) for force in shown]
    drawn = [(force, of_models) for force, of_models in drawn if of_models]
    if not drawn:
        return None, []
    figure = style.figure(10, 3.75)
    axes = panel(figure, 0.95, 0.8, 8.7, 2.45)
    for k, (force, of_models) in enumerate(drawn):
        for model, pairs in of_models.items():
            color = style.MODEL_COLOR.get(model, "#7b3294") if len(drawn) == 1 else SIDE_COLORS[k % 6]
            look = model_look(model, run)
            u, value = np.array(pairs).T
            axes.plot(u, value, color=color, linestyle=look["dashes"], linewidth=1.5, zorder=3,
                      marker=look["marker"] if len(u) <= FEW else None, markersize=3.2,
                      markerfacecolor="white", markeredgewidth=0.9)
    axes.margins(y=0.08)
    axes.axhline(0, color="#9aa5b1", linewidth=0.8, zorder=1)
    forces_drawn = [force for force, _ in drawn]
    axes.set_title(force_title(run, forces_drawn), loc="left", fontsize=8.5)
    only = forces_drawn[0]
    text = f"Displacement of {only.side} in {only.axis}" if len(drawn) == 1 else \
        "Displacement of the side in the direction of its force"
    axes.set_xlabel(with_unit(text, words.length), labelpad=1)
    legend_below(figure, force_legend(run, forces_drawn))
    return figure, forces_drawn


def energies(run):
    """{model: {energy: series}} of the energies that are drawn and not all zero."""
    found = {m: {q: run.totals[q][m] for q in ENERGIES if m in run.totals.get(q, {})}
             for m in run.models}
    largest = max((abs(v) for of_model in found.values() for s in of_model.values() for _, v in s),
                  default=0.0)
    found = {m: {q: s for q, s in of_model.items() if max(abs(v) for _, v in s) > 1e-12 * largest}
             for m, of_model in found.items()}
    return {m: of_model for m, of_model in found.items() if of_model}


def energy_figure(run, words):
    """The energies over time, the models beside each other on one scale; None with less than three times."""
    found = energies(run)
    if not found or n_times(run) < 3:
        return None
    figure, height = style.figure(10, 3.75), 2.45
    width, first = (8.7 - 0.35 * (len(found) - 1)) / len(found), None
    for k, (model, of_model) in enumerate(found.items()):
        axes = panel(figure, 0.95 + k * (width + 0.35), 0.8, width, height,
                     **({} if first is None else {"sharey": first}))
        first = first or axes
        if axes is not first:
            axes.tick_params(labelleft=False)
            axes.yaxis.get_offset_text().set_visible(False)
        for quantity in reversed(ENERGIES):  # the work last, above the others
            if quantity in of_model:
                draw(axes, of_model[quantity], *ENERGIES[quantity])
        axes.set_title(with_unit(style.name(model), words.units.amount), loc="left", fontsize=8.5)
        from_zero(axes)
        axes.set_xlabel(words.time_axis(), labelpad=1)
    drawn = [q for q in ENERGIES if any(q in of_model for of_model in found.values())]
    legend_below(figure, [Line2D([], [], label=q, color=ENERGIES[q][0], linewidth=2,
                                 linestyle=ENERGIES[q][1]) for q in drawn])
    return figure


def drawn_quantities(run):
    """Names in totals.csv of all that the two figures show."""
    if n_times(run) < 3:
        return set()
    shown, opposite = forces(run)
    moved = {q for q in run.totals if q.startswith("displacement of ")}
    return {f.quantity for f in shown + opposite} | {BROKEN} | moved | {
        q for of_model in energies(run).values() for q in of_model}


def force_caption(run, shown, opposite):
    """How to read the figure of the forces."""
    if not shown:
        text = "The bonds that have broken; the forces on the sides do not change."
    else:
        text = "Above, the" if can_break(run) else "The"
        text += " force on " + " and on ".join(f"{f.side} in {f.axis}" for f in shown)
        if opposite:
            listed = " and ".join(f.side for f in opposite)
            text += f"; that on {listed} is equal and opposite"
        text += "; below, the bonds that have broken." if can_break(run) else "."
    if first_break(run):
        text += " The dotted line is the first time with broken bonds."
    return text


def energy_caption(run):
    """How to read the figure of the energies."""
    slow, broken = is_slow(run), can_break(run)
    stored = "the strain energy" + ("" if slow else " and the kinetic energy")
    text = f"The work of loads and supports is {stored}"
    if not broken:
        # Cracks that grow release energy, too.
        return text + (" and the energy dissipated, which the growing cracks have released." if DISSIPATED in run.totals else ".")
    return text + (" and the energy dissipated: what broken bonds had stored, and what a real body "
                   "turns into motion before it is at rest again." if slow else
                   " and the energy dissipated, which is what broken bonds had stored.")
