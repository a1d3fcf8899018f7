# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""The tables of the report that only elastic bodies have."""

import re
from html import escape

import numpy as np

import fragments
import loading
from curves import probe_name, probe_points
from style import minus, name
from surfaces import near_surface
from tables import cell, entry, table
from words import with_unit

FEM, PD = "finite elements", "peridynamics"


def place(run, point):
    """(x, y) of a node."""
    extent = np.ptp(np.array(run.domain), axis=0).max()
    return probe_name(np.where(np.abs(point) < 1e-12 * extent, 0.0, point))


def side_plane(run, name):
    """(axis, coordinate) of a side of a box, None for other names."""
    names = ("left", "right", "bottom", "top", "back", "front")
    return (names.index(name) // 2, run.domain[names.index(name) % 2][names.index(name) // 2]) if name in names else None


def made_by_surfaces(run, model, field, mesh):
    """Nodes whose stress a surface alone may make: within a horizon of the surface of the body, its
    sides, planes of symmetry and holes, as far as families of peridynamics end there. None if that is the whole body."""
    none = np.zeros(len(mesh.nodes), dtype=bool)
    if model != PD or not field.name.startswith(("stress", "von_mises")):
        return none
    settings = run.get("models", PD, "settings", default={})
    correction = settings.get("surface correction", "")
    completed = "auto: fictitious nodes beyond "
    if correction == completed + "the whole boundary" or (correction and not correction.startswith(("none", "auto"))):
        return none
    planes = [side_plane(run, name) for name in re.split(", | and ", correction[len(completed):])] if correction.startswith(completed) else []
    key = ("near surface", id(mesh))
    if key not in run.found:
        run.found[key] = near_surface(mesh, float(settings.get("horizon", 0)), [plane for plane in planes if plane])
    return none if run.found[key].all() else run.found[key]


def extreme(run, index, model, field, which, with_surfaces=True, of_body=False):
    """(value, node) of the largest or smallest value of a field, or None; with or without what a
    surface alone makes of stresses; of_body: without fragments."""
    if run.field_file(index, model) is None:
        return None
    values = run.field(index, model, field.name, required=False)
    flying = fragments.find(run, index, model) if of_body else None
    if flying is not None and values is not None:
        values = np.where(flying.mask, np.nan, values)
    if values is None or not np.isfinite(values).any():
        return None
    mesh = run.mesh(index, model)
    if not with_surfaces:
        inner = np.where(made_by_surfaces(run, model, field, mesh), np.nan, values)
        values = inner if np.isfinite(inner).any() else values
    at = int((np.nanargmax if which == "largest" else np.nanargmin)(values))
    point = mesh.nodes[at]
    if model == PD and run.at_cell_centers():
        point = mesh.nodes[mesh.cells[np.flatnonzero((mesh.cells == at).any(axis=1))[0]]].mean(0)
    return float(values[at]), point


def extremes_table(run, index, fields):
    """Largest and smallest values of fields at a written time, and where they are."""
    rows = []
    for field in fields:
        for which in ("largest",) if field.name in ("displacement_magnitude", "von_mises",
                                                    "damage") else ("largest", "smallest"):
            found = [extreme(run, index, m, field, which) for m in run.models]
            if any(f is not None for f in found):
                rows.append([escape(f"{name(which)} {field.label(field.text)}")] + [
                    "–" if f is None else f"{cell(f[0], 6)} at {escape(place(run, f[1]))}"
                    for f in found])
    return table([""] + [name(m) for m in run.models], rows, "numbers") if rows else ""


def probe_table(run, words, at_most=90):
    """All columns of probes.csv: (html, whether only the last time is in it)."""
    columns = run.probe_columns
    if not columns:
        return "", False
    models, points = run.probes.models(), probe_points(run.probes)
    times = run.probes.times()
    both = FEM in models and PD in models
    cut = len(points) * len(times) * len(columns) > at_most
    steady, rows = run.get("steady", default=False), []
    for k, point in enumerate(points):
        for time in times[-1:] if cut else times:
            when = "" if steady else f", {words.at_time(time)}"
            rows.append([escape(f"Probe {probe_name(point)}{when}")])
            for column, values in columns.items():
                found = {m: None if values.at(m, time) is None else
                         float(values.at(m, time)[1][k]) for m in models}
                gap = [found[PD] - found[FEM]] if both and None not in found.values() else \
                    [None] if both else []
                title = column.replace("von_mises", "von Mises").replace("_", " ")
                rows.append([escape(words.column(column).label(title))]
                            + [cell(found[m], 6) for m in models] + [cell(g, 3) for g in gap])
    header = [""] + [name(m) for m in models] + ["PD − FEM"] * both
    return table(header, rows, "numbers"), cut and len(times) > 1


def forces(run, model):
    """{side: components} of a model."""
    found = entry("boundary force")(run.summary["models"][model]) or {}
    return {side: (list(f) if isinstance(f, (list, tuple)) else [f]) for side, f in found.items()}


def force_table(run):
    """Forces on the sides, the body's own, and their sum."""
    of_model = {m: forces(run, m) for m in run.models}
    sides = list(dict.fromkeys(s for f in of_model.values() for s in f))
    if not sides:
        return ""
    conditions, rows = run.sides(), []
    axes = "xyz"[:run.dimension]
    for side in sides:
        for d, axis in enumerate(axes):
            values = [of_model[m][side][d] if d < len(of_model[m].get(side, ())) else None
                      for m in run.models]
            rows.append([f"{escape(side)}, in {axis}",
                         escape(minus(conditions.get(side, ""))) if d == 0 else ""]
                        + [cell(v, 6) for v in values])
    body = {axis: {m: v for m, v in last_totals(run, f"body force in {axis}").items()}
            for axis in axes}
    if any(v for of_axis in body.values() for v in of_axis.values()):
        rows += [[f"body force, in {axis}", ""] + [cell(body[axis].get(m), 6) for m in run.models]
                 for axis in axes]
    for d, axis in enumerate(axes):
        sums = [sum(f[d] for f in of_model[m].values() if d < len(f)) + body[axis].get(m, 0.0)
                for m in run.models]
        rows.append([f"<strong>Sum in {axis}</strong>", ""]
                    + [f"<strong>{cell(v, 6)}</strong>" for v in sums])
    return table([with_unit("Side", run.words.units.force), "Condition"]
                 + [name(m) for m in run.models], rows, "numbers second-text")


def last_totals(run, quantity):
    """{model: last value} of a quantity of totals.csv."""
    return {m: max(series)[1] for m, series in run.totals.get(quantity, {}).items()}


ELSEWHERE = ("force on ", "body force in ", "throughput", "imbalance", "displacement of ")


def energy_table(run):
    """Energies, mean stress and all other totals at the end that no other table has."""
    rows = []
    order = sorted(run.totals, key=lambda q: q.startswith("mean stress")) \
        if loading.is_slow(run) or loading.can_break(run) else run.totals
    for quantity in order:
        if not quantity.startswith(ELSEWHERE):
            values = last_totals(run, quantity)
            rows.append([escape(run.words.total(quantity))]
                        + [cell(values.get(m), 6) for m in run.models])
    stress = [entry("mean stress", "von mises")(run.summary["models"][m]) for m in run.models]
    if any(s is not None for s in stress):
        rows.append([escape(with_unit("Von Mises stress of the mean stress", run.words.units.stress))] + [cell(s, 6) for s in stress])
    if not rows:
        return ""
    first = "" if run.get("steady", default=False) else "At the end"
    return table([first] + [name(m) for m in run.models], rows, "numbers")


def flat(values, before=""):
    """{"mean": 1} of {"mean": 1}, {"von mises mean": 1} of {"von mises": {"mean": 1}}."""
    found = {}
    for key, value in values.items():
        title = f"{before} {key}".strip()
        if isinstance(value, dict):
            found.update(flat(value, title))
        elif isinstance(value, (int, float)) or value is None:
            found[title] = value
    return found


def phases_of(model):
    """{phase: {statistic: number}} of a model's entry, however it is nested."""
    found = model.get("phases")
    if isinstance(found, list):
        found = {str(p.get("name", i)): p for i, p in enumerate(found) if isinstance(p, dict)}
    if not isinstance(found, dict):
        return {}
    return {phase: flat(values) for phase, values in found.items() if isinstance(values, dict)}


def phase_table(run):
    """Statistics of each phase, the models below one another."""
    of_model = {m: phases_of(run.summary["models"][m]) for m in run.models}
    phases = list(dict.fromkeys(p for found in of_model.values() for p in found))
    titles = list(dict.fromkeys(t for found in of_model.values() for values in found.values()
                                for t in values))
    if not titles:
        return ""
    rows = []
    for phase in phases:
        rows.append([escape(phase)])
        rows += [[escape(name(m))] + [cell(found[phase].get(t), 6) for t in titles]
                 for m, found in of_model.items() if phase in found]
    return table(["Phase"] + [escape(name(t)) for t in titles], rows, "numbers")
