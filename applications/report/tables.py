# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""The tables of the report as HTML."""

from html import escape

import findings
from curves import probe_name, probe_points
from style import minus, name, plain
from words import with_unit


def cell(value, digits=4):
    """A number or text of a table."""
    if value is None:
        return "–"
    if isinstance(value, (int, float)):
        return escape(plain(value, digits))
    return escape(str(value))


def table(header, rows, kind=""):
    """An HTML table; a row of one entry is a heading over the rows that follow."""
    lines = [f'<table class="{kind}">' if kind else "<table>", "<thead><tr>"]
    lines += [f"<th scope=\"col\">{escape(h)}</th>" for h in header]
    lines.append("</tr></thead><tbody>")
    for row in rows:
        if len(row) == 1:
            lines.append(f'<tr class="group"><th colspan="{len(header)}">{row[0]}</th></tr>')
            continue
        lines.append("<tr>" + f'<th scope="row">{row[0]}</th>'
                     + "".join(f"<td>{entry}</td>" for entry in row[1:]) + "</tr>")
    lines.append("</tbody></table>")
    return "\n".join(lines)


def memory(value):
    """Bytes as MB or GB."""
    if not isinstance(value, (int, float)):
        return None
    return f"{plain(value / 1e9, 3)} GB" if value >= 1e9 else f"{plain(value / 1e6, 3)} MB"


def seconds(value):
    """A wall time."""
    return None if value is None else f"{plain(value, 3)} s"


def model_rows(run, title, value):
    """One row of the cost table, or none where no model has the number."""
    values = [value(run.summary["models"][m]) for m in run.models]
    if all(v is None for v in values):
        return []
    return [[escape(title)] + [cell(v) for v in values]]


def entry(*path):
    """Reader of an entry of a model."""
    def read(model):
        for key in path:
            model = model.get(key) if isinstance(model, dict) else None
        return model
    return read


def final(*path):
    """Reader of the last value of a series of a model."""
    return lambda model: findings.last(entry(*path)(model))


def size_rows(run, words):
    """Sizes and methods."""
    rows = []
    for title, key in (("Unknowns", "unknowns"), ("Bonds", "bonds"), ("Nonzeros", "nonzeros"),
                       ("Operator form", "operator form"), ("Time stepper", "stepper"),
                       ("Time steps", "steps"),
                       ("Operator applications", "operator applications"),
                       ("Solver iterations", "iterations")):
        rows += model_rows(run, title, entry(key))
    rows += model_rows(run, with_unit("Stable step, sharp", words.time),
                       entry("stable step", "sharp"))
    rows += model_rows(run, with_unit("Stable step, safe bound", words.time),
                       entry("stable step", "safe"))
    return rows


def certificate_rows(run):
    """What is known of the coupling of a coupled model."""
    rows = []
    for title, path in (("Share of the body in the zone", ("share of the body",)),
                        ("Share of the bonds' conductance kept", ("share of the conductance kept",)),
                        ("Share of the bonds' stiffness kept", ("share of the stiffness kept",)),
                        ("Patch error, linear field", ("patch error", "linear")),
                        ("Patch error, quadratic field", ("patch error", "quadratic")),
                        ("Patch error, cubic field", ("patch error", "cubic")),
                        ("Asymmetry of the matrix", ("asymmetry",)),
                        ("Unbalanced forces", ("unbalanced forces",)),
                        ("Lowest eigenvalue", ("lowest eigenvalue",)),
                        ("Lowest eigenvalue of a cell", ("lowest eigenvalue of a cell",)),
                        ("Bonds of full peridynamics", ("full peridynamics", "bonds")),
                        ("Nonzeros of full peridynamics", ("full peridynamics", "nonzeros"))):
        rows += model_rows(run, title, entry("certificate", *path))
    return rows


def cost_rows(run):
    """Wall times and memory."""
    cost, phases = [], []
    for model in run.models:
        times = run.summary["models"][model].get("wall time")
        phases += [p for p in times if p not in phases] if isinstance(times, dict) else []
    for phase in phases:
        if phase != "total":
            cost += model_rows(run, name(phase), lambda m, p=phase: seconds(
                entry("wall time", p)(m)))
    cost += [["<strong>Total wall time</strong>"]
             + [f"<strong>{cell(seconds(findings.wall_time(run.summary['models'][m])))}</strong>"
                for m in run.models]] if phases else []
    return cost + model_rows(run, "Memory", lambda m: memory(m.get("memory")))


def shared_cost(run):
    """A sentence on what no model has alone, or ''."""
    phases = run.get("wall time", default={})
    parts = [f"{name} {seconds(t)}" for name, t in phases.items()
             if isinstance(t, (int, float))]
    text = f"Beside the models, wall time: {', '.join(parts)}." if parts else ""
    mesh = memory(run.get("memory of mesh"))
    if mesh:
        text += f" Memory of the mesh: {mesh}."
    peaks = [m["peak memory"] for m in run.summary["models"].values()
             if isinstance(m.get("peak memory"), (int, float))]
    if peaks:
        text += " Peak memory of the program with all it holds: " \
            f"{memory(max(peaks))}."
    return text.strip()


def error_rows(run, words):
    """Errors at the end."""
    when = "" if run.get("steady", default=False) else " at the end"
    errors = model_rows(run, f"Relative L2 error{when}", final("errors", "relative l2"))
    errors += model_rows(run, words.solution.label(f"Largest error{when}"),
                         final("errors", "maximum"))
    errors += model_rows(run, with_unit(f"{name(words.effective)} of the whole",
                                        words.units.of_total(words.effective)),
                         lambda m: m.get("effective conductivity"))
    for part in ("throughput", "imbalance"):
        errors += model_rows(run, with_unit(f"{name(words.quantity)} {part}", words.units.rate),
                             lambda m, p=part: findings.balance(m, words).get(p))
    for part, title in (("entered", "entered since the start"), ("stored", "stored since the start"),
                        ("imbalance", "missing since the start")):
        errors += model_rows(run, with_unit(f"{name(words.quantity)} {title}", words.units.amount),
                             lambda m, p=part: entry("cumulative", p)(findings.balance(m, words)))
    return errors


def cost_table(run, words):
    """Cost and error of each model."""
    groups = (("Size and method", size_rows(run, words)), ("Cost", cost_rows(run)),
              ("Error", error_rows(run, words)), ("Coupling", certificate_rows(run)))
    listed = []
    for title, part in groups:
        if part:
            listed += [[title]] + part
    return table([""] + [name(m) for m in run.models], listed, "numbers")


def boundary_table(run):
    """What enters through each side."""
    sides = []
    for model in run.models:
        sides += [s for s in entry("boundary flux")(run.summary["models"][model]) or {}
                  if s not in sides]
    if not sides:
        return ""
    conditions = run.sides()
    rows = []
    for side in sides:
        values = [entry("boundary flux", side)(run.summary["models"][m]) for m in run.models]
        rows.append([escape(side), escape(minus(conditions.get(side, "")))]
                    + [cell(v, 6) for v in values])
    sums = []
    for model in run.models:
        fluxes = entry("boundary flux")(run.summary["models"][model])
        sums.append(f"<strong>{cell(sum(fluxes.values()), 6)}</strong>" if fluxes else "–")
    rows.append(["<strong>Sum</strong>", ""] + sums)
    unit = run.words.units.rate
    return table([with_unit("Side", unit), "Condition"] + [name(m) for m in run.models], rows,
                 "numbers second-text")


def sides_table(run):
    """The boundary conditions in full."""
    sides = run.sides()
    if not sides:
        return ""
    return table(["Side", "Condition"], [[escape(s), escape(minus(c))] for s, c in sides.items()])


def what_moisture_counts(run):
    """What flows and amounts of moisture are, or ''."""
    counts = run.get("moisture counts", default="")
    if counts == "mass":
        return "Flows and stored amounts are those of Density times wetness: masses, if Density is the saturated concentration."
    if counts != "wetness":
        return ""
    saturated = run.scene_entry("Material", "Saturated concentration")
    try:
        factor = f"the saturated concentration, {with_its_unit(plain(float(saturated)), run.words.units.of_material('Saturated concentration'))}," \
            if not run.scene_entry("Material/Phases", "Saturated concentration") else "the saturated concentration"
    except ValueError:
        factor = "the saturated concentration"
    return (f"Flows and stored amounts are those of the wetness times the volume; times {factor} they are masses. "
            "The weight is a mass already.")


def with_its_unit(text, unit):
    """A number with its unit."""
    return f"{text} {unit}".strip()


def error_table(run, words):
    """Difference and errors at every written time; empty with nothing to tell."""
    columns = []
    for key, title in (("relative l2", "relative L2"), ("maximum", "largest")):
        series = run.get("comparison", key)
        if series:
            columns.append((f"PD − FEM, {title}", dict(map(tuple, series))))
    for pair, entries in (run.get("comparisons") or {}).items():
        first, second = (name(m) for m in pair.split(" minus "))
        for key, title in (("relative l2", "relative L2"), ("maximum", "largest")):
            columns.append((f"{first} − {second}, {title}", dict(map(tuple, entries[key]))))
    for model in run.models:
        for key, title in (("relative l2", "relative L2"), ("maximum", "largest")):
            series = entry("errors", key)(run.summary["models"][model])
            if series:
                columns.append((f"{name(model)} − exact, {title}", dict(map(tuple, series))))
    if not columns:
        return ""
    times = sorted({t for _, series in columns for t in series})
    steady = run.get("steady", default=False)
    rows = [[escape(name(words.at_time(t, True)) if steady else plain(t))]
            + [cell(series.get(t)) for _, series in columns] for t in times]
    first = "" if steady else words.time_axis()
    return table([first] + [title for title, _ in columns], rows, "numbers")


def probe_table(run, words, at_most=60):
    """Values at the probes."""
    probes = run.probes
    times, points = probes.times(), probe_points(probes)
    models = probes.models()
    rows, steady = [], run.get("steady", default=False)
    for k, point in enumerate(points):
        for time in times:
            values = []
            for model in models:
                pair = probes.at(model, time)
                values.append(None if pair is None or len(pair[1]) <= k else float(pair[1][k]))
            lead = [escape(probe_name(point))] + ([] if steady else [escape(plain(time))])
            rows.append(lead + [cell(v, 6) for v in values])
    if not rows:
        return "", 0
    header = ["Probe"] + ([] if steady else [words.time_axis()])
    header += [name(m) for m in models]
    return table(header, rows[:at_most], "numbers"), max(0, len(rows) - at_most)


def totals_table(run):
    """Quantities of totals.csv at the end."""
    rows = []
    for quantity, of_model in run.totals.items():
        values = [max(of_model[m])[1] if m in of_model else None for m in run.models]
        rows.append([escape(run.words.total(quantity))] + [cell(v, 6) for v in values])
    if not rows:
        return ""
    first = "" if run.get("steady", default=False) else "At the end"
    return table([first] + [name(m) for m in run.models], rows, "numbers")


def setting(title, value):
    """A setting; numbers are written as elsewhere."""
    if title == "kernel" and value is not None:
        return escape(findings.kernel_name(value, ""))
    try:
        return cell(float(value), 6)
    except (TypeError, ValueError):
        return cell(value)


def settings_table(run):
    """Settings of each model, as the program used them."""
    names = []
    for model in run.models:
        names += [s for s in run.summary["models"][model].get("settings") or {} if s not in names]
    if not names:
        return ""
    rows = [[escape(s)] + [setting(s, (run.summary["models"][m].get("settings") or {}).get(s))
                           for m in run.models] for s in names]
    return table(["Setting"] + [name(m) for m in run.models], rows)
