# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""The files of the study, and the same in lines for the reader."""

import json
import math
from typing import List

from . import lattice
from .evaluation import Pick, Reference, TimeRow, WorkResults
from .families import FAMILIES, Family
from .pareto import Cost, cost_at_error, observed_order
from .plan import Plan
from ..words import full_precision

TARGET_ERRORS = (1e-2, 1e-3)
TARGETS_OF_GROWTH = (1e-1, 5e-2)
COLUMNS = ("name", "family", "model", "cells", "node spacing", "unknowns", "bonds", "nonzeros", "nonzeros applied", "iterations",
           "operator applications", "work", "error", "set-up time", "solution time", "wall time", "memory", "peak memory", "tolerance", "front",
           "dominated by", "front in wall time", "dominated in wall time by")
COLUMNS_IN_TIME = ("name", "stepper", "tolerance", "steps", "iterations", "operator applications", "work", "error", "wall time")


def target_errors(plan: Plan):
    """Whose costs are told."""
    return TARGETS_OF_GROWTH if plan.comparison == "growth" else TARGET_ERRORS


def _number(value: float):
    """Not a number becomes null, which JSON knows."""
    return value if math.isfinite(value) else None


def _lines(results: WorkResults) -> List[dict]:
    """Of all rows."""
    lines = []
    for row, by, by_in_time in zip(results.rows, results.dominating(), results.dominating(in_time=True)):
        lines.append({
            "name": row.name, "family": row.family.name, "model": row.family.model, "cells": lattice.to_text(row.cells),
            "node spacing": row.spacing, "unknowns": row.unknowns, "bonds": row.bonds, "nonzeros": row.nonzeros,
            "nonzeros applied": row.applied, "iterations": row.iterations, "operator applications": row.applications, "work": row.work,
            "error": row.error, "set-up time": row.set_up, "solution time": row.solve, "wall time": row.wall_time, "memory": row.memory,
            "peak memory": row.peak_memory, "front": by is None, "dominated by": by.name if by else "",
            "front in wall time": by_in_time is None, "dominated in wall time by": by_in_time.name if by_in_time else ""})
    return lines


def _csv_of(header, lines: List[dict]) -> str:
    """Lines as objects with these keys; what a line does not have stays empty."""
    def cell(value):
        if value is None:
            return ""
        if isinstance(value, str):
            return f'"{value}"'
        return full_precision(value) if isinstance(value, float) else json.dumps(value)

    return "".join(",".join(cells) + "\n" for cells in (header, *([cell(line.get(name)) for name in header] for line in lines)))


def work_csv(results: WorkResults) -> str:
    """work_precision.csv: a line for each finished row, and for what the program has chosen."""
    return _csv_of(COLUMNS, _lines(results) + [
        {"name": pick.name, "family": "auto", "model": pick.model, "error": pick.error, "wall time": pick.wall_time,
         "tolerance": pick.tolerance} for pick in results.picks])


def in_time_csv(results: WorkResults) -> str:
    """work_precision_in_time.csv: a line for each stepper and tolerance."""
    return _csv_of(COLUMNS_IN_TIME, [_entry_in_time(row) for row in results.in_time])


def _entry_in_time(row: TimeRow) -> dict:
    return {"name": row.name, "stepper": row.stepper, "tolerance": row.tolerance if row.tolerance > 0 else None, "steps": row.steps,
            "iterations": row.iterations, "operator applications": row.applications, "work": row.work, "error": _number(row.error),
            "wall time": row.wall_time}


def _entry_of_pick(pick: Pick) -> dict:
    return {"name": pick.name, "tolerance": pick.tolerance, "error": _number(pick.error), "estimate": pick.estimate, "met": pick.met,
            "wall time": pick.wall_time, "tries": pick.tries, "model": pick.model, "settings": pick.settings}


def _entry_of_cost(cost: Cost) -> dict:
    entry = {"kind": cost.kind}
    if cost.kind != "none":
        entry["cost"] = cost.cost
    if cost.kind == "extrapolated":
        entry["finest error over target"] = cost.beyond
    return entry


def _entry_of_family(plan: Plan, results: WorkResults, family: Family) -> dict:
    rows = results.of_family(family)
    return {
        "name": family.name, "model": family.model, "set": family.settings,
        "observed order": _number(observed_order([row.spacing for row in rows], [row.error for row in rows])),
        "rows": [row.name for row in rows],
        "at error": [{"error": error,
                      "work": _entry_of_cost(cost_at_error(results.points(family), error)),
                      "wall time": _entry_of_cost(cost_at_error(results.points(family, in_time=True), error))} for error in target_errors(plan)]}


def _entry_of_reference(plan: Plan, reference: Reference) -> dict:
    if reference.exact:
        return {"kind": "exact solution"}
    if reference.chosen:
        return {"kind": "what Models = auto finds for a small tolerance", "tolerance": plan.rows[0].tolerance, "own error": reference.own_error}
    return {"kind": "finite elements with the cracks on cell faces, extrapolated" if reference.cracked else
                    "finite elements of degree 2, extrapolated",
            "cells": [lattice.to_text(cells) for cells in plan.reference], "observed order": _number(reference.observed_order),
            "order": reference.order, "own error": reference.own_error}


def _left_out(plan: Plan, results: WorkResults) -> List[str]:
    return plan.left_out + [f"{name}: no such number can be found on it." for name in results.without]


def work_json(study: dict, scene: str, plan: Plan, results: WorkResults) -> str:
    """work_precision.json: the rows, families with observed orders and costs at given errors, fronts, and how the errors were found.

    study: study.json.
    """
    content = {
        "title": study["title"], "text": study["text"], "scene": scene, "program": study["program"], "measure": plan.measure,
        "steady": results.steady, "work": "nonzeros applied x " + ("iterations" if results.steady else "operator applications"),
        "reference": _entry_of_reference(plan, results.reference), "left out": _left_out(plan, results), "columns": COLUMNS,
        "rows": _lines(results), "front": [row.name for row in results.front()],
        "front in wall time": [row.name for row in results.front(in_time=True)],
        "families": [_entry_of_family(plan, results, family) for family in FAMILIES[plan.comparison] if results.of_family(family)],
        "picks": [_entry_of_pick(pick) for pick in results.picks], "no picks": plan.no_picks}
    if results.in_time:
        content["in time"] = {"method": results.method_in_time, "error in space": _number(results.error_in_space),
                              "rows": [_entry_in_time(row) for row in results.in_time]}
    return json.dumps(content, indent=1, ensure_ascii=False) + "\n"


def _percent(error: float) -> str:
    return f"{100.0 * error:g} %"


def _line_of_reference(plan: Plan, reference: Reference) -> str:
    if reference.exact:
        return "Errors against the exact solution."
    if reference.chosen:
        return f"Errors against what Models = auto finds for {plan.rows[0].tolerance:g}, estimated to be wrong by {reference.own_error:.1e} itself."
    observed = f"{reference.observed_order:.2f}" if math.isfinite(reference.observed_order) else "none"
    return ("Errors against finite elements " + ("with the cracks on cell faces, " if reference.cracked else "of degree 2, ") +
            ", ".join(map(lattice.name_of, plan.reference)) +
            f" cells, extrapolated with order {reference.order:.3g} (observed: {observed}); own error {reference.own_error:.1e}.")


def _report_target(plan: Plan, results: WorkResults, error: float) -> str:
    """What a given error costs each family, cheapest first."""
    families = [family for family in FAMILIES[plan.comparison] if results.of_family(family)]
    costs = [(family, cost_at_error(results.points(family), error), cost_at_error(results.points(family, in_time=True), error))
             for family in families]
    lines = sorted((line for line in costs if line[1].kind != "none"), key=lambda line: line[1].cost)
    text = (f"\nAt an error of {_percent(error)} (interpolated along each family; < the coarsest lattice is better already; * extrapolated, "
            "finest error as given)\n        work  relative   wall time  family\n")
    marks = {"extrapolated": "*", "at most": "<", "interpolated": " "}
    for family, work, time in lines:
        relative = work.cost / lines[0][1].cost if lines[0][1].cost > 0 else math.nan
        text += f"  {marks[work.kind]}{work.cost:9.3g} {relative:9.3g}  "
        text += "        -   " if time.kind == "none" else f"{marks[time.kind]}{time.cost:7.3g} s  "
        text += family.name
        if work.kind == "extrapolated":
            text += f" ({_percent(lattice.nearest_whole(work.beyond * error * 1e5) / 1e5)})"
        text += "\n"
    none = "; ".join(family.name for family, work, _ in costs if work.kind == "none")
    return text + (f"  not seen, or too far to extrapolate: {none}\n" if none else "")


def _report_picks(plan: Plan, results: WorkResults) -> str:
    if plan.no_picks:
        return f"\nModels = auto: no choice. {plan.no_picks}\n"
    if not results.picks:
        return ""
    return "\nModels = auto\n  asked for     error  estimate  wall time  tries  choice\n" + "".join(
        f"  {pick.tolerance:9.0e} {pick.error:9.2e} {pick.estimate:9.2e} {pick.wall_time:8.3g} s {pick.tries:6d}  {pick.model}: "
        f"{pick.settings[:200]}\n" for pick in results.picks)


def _report_in_time(results: WorkResults) -> str:
    if not results.in_time:
        return ""
    return (f"\nError in time alone, {results.method_in_time} (error in space: {results.error_in_space:.2e})\n"
            "      work     error  wall time   steps  stepper\n") + "".join(
                f"  {row.work:8.3g} {row.error:9.2e} {row.wall_time:7.3g} s {row.steps:8d}  {row.name}\n" for row in results.in_time)


def work_report(plan: Plan, results: WorkResults) -> str:
    """For the reader: the front, what is dominated by what, and the cost of errors of 1 and 0.1 percent."""
    text = "\n" + _line_of_reference(plan, results.reference) + "\n"
    n_uncertain = sum(row.error < 3.0 * results.reference.own_error for row in results.rows)
    if n_uncertain:
        text += (f"Less than three times that are the errors of {n_uncertain}" +
                 (" setting, which is" if n_uncertain == 1 else " settings, which are") + " uncertain: --reference takes finer lattices.\n")
    text += "".join(f"Left out: {sentence}\n" for sentence in _left_out(plan, results))
    text += f"\nPareto front (work: nonzeros x {'iterations' if results.steady else 'operator applications'})\n"
    text += "      work     error  wall time  setting\n"
    text += "".join(f"  {row.work:8.3g} {row.error:9.2e} {row.wall_time:7.3g} s  {row.name}\n" for row in results.front())
    text += "\nDominated (x: work over that of the cheapest setting that is as good)\n      work     error       x  setting < by\n"
    for row, by in zip(results.rows, results.dominating()):
        if by is not None:
            text += f"  {row.work:8.3g} {row.error:9.2e} {row.work / by.work if by.work else math.inf:7.3g}  {row.name} < {by.name}\n"
    text += _report_picks(plan, results) + _report_in_time(results)
    return text + "".join(_report_target(plan, results, error) for error in target_errors(plan))
