# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""What finished rows have cost, and how wrong they are."""

import dataclasses
import json
import math
from pathlib import Path
from typing import Dict, List, Optional

import numpy as np

from ..program import Error
from ..results import Results, select
from . import growth, lattice, pareto
from .families import Family
from .lattice import Cells, sum_in_turn
from .plan import Plan, Row
from .pareto import Point


class ComputedRow:
    """What has become of a row: an entry of study.json, and the files of its folder."""

    def __init__(self, entry: dict, directory: Path):
        self.name = entry["name"]
        self.status = entry["status"]  # finished, failed, or empty where it was not computed
        self.message = entry["message"]
        self.folder = directory / entry["folder"]
        self.results = Results(self.folder)

    @property
    def is_finished(self) -> bool:
        return self.status == "finished"

    @property
    def summary(self) -> dict:
        """summary.json."""
        return self.results.summary

    def record(self) -> dict:
        """row.json: the smallest times of all repeats."""
        return json.loads((self.folder / "row.json").read_text(encoding="utf-8", errors="replace"))

    def grid(self, model: str) -> np.ndarray:
        """The values of one model in grid.csv at the last time, all components of a point together."""
        values, time = [], None
        try:
            with open(self.folder / "grid.csv", encoding="utf-8") as file:
                header = file.readline().rstrip("\n").split(",")
                columns = [k for k, name in enumerate(header) if name in ("value", "ux", "uy", "uz")]
                for line in file:
                    cells = line.rstrip("\n").split(",")
                    if len(cells) < len(header) or cells[1] != model:
                        continue
                    if cells[0] != time:
                        values, time = [], cells[0]
                    values.extend(float(cells[k]) for k in columns)
        except (OSError, ValueError):
            values = []
        if not values:
            raise Error(f"work_precision: '{self.folder}/grid.csv' of the row '{self.name}' cannot be read. Compute it again with --redo.")
        return np.array(values)

    def numbers(self, model: str, measure: str) -> np.ndarray:
        """What the run has found at its last time: both components of the openings at the probes, which stand right and left of cracks by
        turns, or the stress intensities at all ends. Nothing where it has none."""
        if measure == "stress intensity":
            ends = self.summary["models"].get(model, {}).get("stress intensity", {})
            return np.array([end[mode] for end in ends.values() for mode in ("I", "II", "III") if mode in end])
        probes = select(self.results.probes, model=model)
        if not probes or not len(probes["time"]):
            return np.array([])
        last = probes["time"] == probes["time"][-1]
        values = np.stack([probes["ux"][last], probes["uy"][last]], axis=1)
        n_pairs = len(values) // 2
        return (values[1:2 * n_pairs:2] - values[:2 * n_pairs:2]).ravel()


def relative_difference(a, b) -> float:
    """|a - b|/|b|, in the Euclidean norm. Raises Error if they are not equally many."""
    if len(a) != len(b):
        raise Error("work_precision: the rows do not have the same numbers. Compute them again with --redo.")
    difference, size = sum_in_turn((a - b) * (a - b)), sum_in_turn(b * b)
    return math.sqrt(difference / size) if size > 0 else math.inf if difference > 0 else math.nan


@dataclasses.dataclass
class WorkRow:
    """What a finished row has cost, and how wrong it is."""

    name: str
    family: Family
    cells: Cells
    unknowns: int
    bonds: int
    nonzeros: int
    applied: int  # nonzeros that one application of the operator multiplies
    iterations: int
    applications: int
    work: float
    set_up: float  # seconds, the smallest of all repeats, as those that follow
    solve: float
    wall_time: float
    memory: float
    peak_memory: float
    spacing: float  # the largest of the directions
    error: float = math.nan


@dataclasses.dataclass
class Reference:
    """Solutions on three lattices and what they say about their limit."""

    exact: bool = True
    cracked: bool = True  # the cracks lie on cell faces; else of degree 2
    observed_order: float = math.nan
    order: float = 0.0
    chosen: bool = False  # by the program, for a small tolerance
    own_error: float = 0.0  # of the extrapolated solution, relative like all errors


@dataclasses.dataclass
class Pick:
    """What `Models = auto` has chosen, what it has cost, and how wrong it really is."""

    name: str
    tolerance: float
    error: float
    estimate: float
    met: bool
    wall_time: float  # of the whole run, with all tries
    tries: int
    model: str
    settings: str  # "Cells = 16, 16; Degree = 2"


@dataclasses.dataclass
class TimeRow:
    """A stepper with its tolerance on one lattice, against the same with hardly an error in time."""

    name: str
    stepper: str
    tolerance: float  # 0: fixed steps, the largest that are stable
    steps: int
    iterations: int
    applications: int
    work: float
    error: float
    wall_time: float


@dataclasses.dataclass
class WorkResults:
    """All rows that finished, without the reference."""

    reference: Reference
    rows: List[WorkRow] = dataclasses.field(default_factory=list)
    steady: bool = True
    picks: List[Pick] = dataclasses.field(default_factory=list)
    in_time: List[TimeRow] = dataclasses.field(default_factory=list)
    method_in_time: str = ""  # the method and the lattice of in_time
    error_in_space: float = math.nan  # of these
    without: List[str] = dataclasses.field(default_factory=list)  # rows that do not have what is measured

    def points(self, family: Optional[Family] = None, in_time: bool = False) -> List[Point]:
        """Work and error, or wall time and error; of one family from coarse to fine."""
        return [Point(row.wall_time if in_time else row.work, row.error) for row in (self.of_family(family) if family else self.rows)]

    def of_family(self, family: Family) -> List[WorkRow]:
        """From coarse to fine."""
        return [row for row in self.rows if row.family is family]

    def front(self, in_time: bool = False) -> List[WorkRow]:
        """By rising cost."""
        return [self.rows[k] for k in pareto.front(self.points(in_time=in_time))]

    def dominating(self, in_time: bool = False) -> List[Optional[WorkRow]]:
        """For each row the cheapest of the front that dominates it, or None."""
        return [None if k is None else self.rows[k] for k in pareto.dominating(self.points(in_time=in_time))]


@dataclasses.dataclass
class Limit:
    """What errors are found from: values at the vertices of each lattice, or numbers. Neither: an exact solution that rows have."""

    values: Dict[Cells, np.ndarray] = dataclasses.field(default_factory=dict)
    numbers: Optional[np.ndarray] = None


def evaluate(facts: dict, plan: Plan, computed: List[ComputedRow]) -> WorkResults:
    """Read the rows' values and compare them. Raises Error if the reference or the values of a finished row are missing."""
    results = WorkResults(Reference(cracked=bool(facts["cracks"])))
    if plan.comparison == "growth":
        return _evaluate_growth(facts, plan, computed, results)
    if plan.comparison == "mesh":
        return _evaluate_mesh(facts, plan, computed, results)
    limit = Limit()
    if plan.reference:
        solutions = _solutions(plan, computed)
        if plan.measure == "field":
            limit.values = _extrapolate(plan, solutions, results.reference)
        else:
            limit.numbers = _extrapolate_numbers(solutions, results.reference)
    for k, (planned, row) in enumerate(zip(plan.rows, computed)):
        if not row.is_finished:
            continue
        if planned.role == "pick values" and computed[k - 1].is_finished:  # before it: its cost
            results.picks.append(_pick(plan.rows[k - 1], computed[k - 1], _error(plan, planned, row, "auto", limit)))
        if planned.role != "method":
            continue
        results.steady = row.summary["steady"]
        entry = _costs(planned, row, facts, results.steady)
        entry.error = _error(plan, planned, row, planned.family.model, limit)
        if math.isfinite(entry.error):
            results.rows.append(entry)
        else:
            results.without.append(planned.name)
    _compare_in_time(facts, plan, computed, results)
    return results


def _evaluate_growth(facts: dict, plan: Plan, computed: List[ComputedRow], results: WorkResults) -> WorkResults:
    """Strengths and paths against those of the first row, which the program has chosen for a small tolerance."""
    if not computed[0].is_finished:
        raise Error(f"work_precision: the row '{plan.rows[0].name}' is not there, and without the reference nothing is known of errors" +
                    (f": {computed[0].message}" if computed[0].message else ". Compute it, too: --only has to name 'reference'."))
    expected = computed[0].summary
    longest = max(upper - lower for lower, upper in zip(facts["lower"], facts["upper"]))
    results.reference.exact, results.reference.chosen, results.steady = False, True, False
    results.reference.own_error = float(expected["accuracy"]["estimate"])

    def error(row, model):
        if plan.measure == "path":
            found = growth.chosen_path(row.summary) if model == "auto" else growth.grown_path(row.folder, model)
            return growth.distance(found, growth.chosen_path(expected), longest)
        return abs(growth.strength(row.summary, model) / growth.strength(expected, "auto") - 1)

    for planned, row in zip(plan.rows, computed):
        if not row.is_finished or planned.role == "reference":
            continue
        if planned.role == "pick":
            results.picks.append(_pick(planned, row, error(row, "auto")))
            continue
        entry = _costs(planned, row, facts, results.steady)
        entry.error = error(row, planned.family.model)
        if math.isfinite(entry.error):
            results.rows.append(entry)
        else:
            results.without.append(planned.name)
    return results


def _evaluate_mesh(facts: dict, plan: Plan, computed: List[ComputedRow], results: WorkResults) -> WorkResults:
    """Each on its own mesh against the exact solution, as the program has found it."""
    def error(row, model):
        return row.summary["models"][model]["errors"]["relative l2"][-1][1]

    for planned, row in zip(plan.rows, computed):
        if not row.is_finished:
            continue
        if planned.role == "pick":
            results.picks.append(_pick(planned, row, error(row, "auto")))
            continue
        entry = _costs(planned, row, facts, steady=True)
        entry.error = error(row, planned.family.model)
        results.rows.append(entry)
    return results


def _solutions(plan: Plan, computed: List[ComputedRow]) -> List[np.ndarray]:
    """Of the reference, from coarse to fine: values, or numbers."""
    solutions = []
    for planned, row in zip(plan.rows, computed):
        if planned.role != "reference":
            continue
        if not row.is_finished:
            raise Error(f"work_precision: the row '{planned.name}' is not there, and without the reference nothing is known of errors" +
                        (f": {row.message}" if row.message else ". Compute it, too: --only has to name 'reference'."))
        solutions.append(row.grid("finite elements") if plan.measure == "field" else row.numbers("finite elements", plan.measure))
        if not len(solutions[-1]):
            raise Error("work_precision: the reference has no stress intensities: there is no room around the ends of the cracks.")
    return solutions


def _split(values: np.ndarray, lattices: List[Cells]) -> Dict[Cells, np.ndarray]:
    """The values at the vertices of each lattice."""
    n_components = len(values) // sum(map(lattice.n_vertices, lattices))
    ends = np.cumsum([lattice.n_vertices(cells) * n_components for cells in lattices])
    return dict(zip(lattices, np.split(values, ends[:-1])))


def _likely_order(observed: float) -> float:
    """Near a crack's end finite elements are of first order at the nodes, without one of second: such an order is taken for what it is."""
    return next((order for order in (1.0, 2.0) if abs(observed - order) < 0.15), observed)


def _extrapolate(plan: Plan, solutions: List[np.ndarray], reference: Reference) -> Dict[Cells, np.ndarray]:
    """The limit at the vertices of all lattices."""
    lattices = plan.lattices()
    n_values = sum(map(lattice.n_vertices, lattices))
    if any(len(values) % n_values or len(values) != len(solutions[0]) for values in solutions):
        raise Error("work_precision: the reference belongs to other lattices. Compute it again with --redo.")

    def difference(a, b):
        parts = zip(lattices, _split(a, lattices).values(), _split(b, lattices).values())
        return max(lattice.nodal_error(u, v, cells) for cells, u, v in parts)

    coarse, fine = difference(solutions[0], solutions[1]), difference(solutions[1], solutions[2])
    reference.exact = False
    reference.observed_order = pareto.order_of_differences(coarse, fine)
    round_off = 1e-8  # of solvers: no order is seen in it
    reference.order = 2.0 if fine < round_off else _likely_order(reference.observed_order)
    if not reference.order > 0.2:
        raise Error("work_precision: finite elements on the three lattices of the reference do not converge; observed order "
                    f"{reference.observed_order:f}. Name finer ones with --reference.")
    limit = pareto.richardson(solutions[1], solutions[2], reference.order)
    reference.own_error = difference(pareto.richardson(solutions[0], solutions[1], reference.order), limit)
    return _split(limit, lattices)


def _extrapolate_numbers(solutions: List[np.ndarray], reference: Reference) -> np.ndarray:
    """The limit of such numbers."""
    reference.exact = False
    reference.observed_order = pareto.order_of_differences(relative_difference(solutions[0], solutions[1]),
                                                           relative_difference(solutions[1], solutions[2]))
    # Where the error is small the numbers do not settle on one order.
    reference.order = min(max(reference.observed_order, 1.0), 2.0) if math.isfinite(reference.observed_order) else 1.0
    limit = pareto.richardson(solutions[1], solutions[2], reference.order)
    reference.own_error = relative_difference(pareto.richardson(solutions[0], solutions[1], reference.order), limit)
    return limit


def _error(plan: Plan, planned: Row, row: ComputedRow, model: str, limit: Limit) -> float:
    """In the measure of the plan; not a number where a row does not have it."""
    if plan.measure != "field":
        found = row.numbers(model, plan.measure)
        if not len(found):
            return math.nan
        return relative_difference(found, row.numbers("exact", plan.measure) if limit.numbers is None else limit.numbers)
    values = row.grid(model)
    expected = limit.values[planned.cells] if limit.values else row.grid("exact")
    if len(values) % lattice.n_vertices(planned.cells) or len(expected) != len(values):
        raise Error(f"work_precision: '{row.folder}/grid.csv' is not whole. Compute the row again with --redo.")
    return lattice.nodal_error(values, expected, planned.cells, with_gaps=not limit.values)


def _costs(planned: Row, row: ComputedRow, facts: dict, steady: bool) -> WorkRow:
    model, record = row.summary["models"][planned.family.model], row.record()
    times = record["models"][planned.family.model]["times"]
    form, unknowns, bonds, nonzeros = model["operator form"], model["unknowns"], model.get("bonds", 0), model["nonzeros"]
    # The entries of a matrix; of bonds that are kept apart what a matrix of them would have, two for
    # each bond and one for each unknown, and what is stored besides.
    applied = nonzeros if form == "matrix" else nonzeros + unknowns + (2 * bonds if form == "lattice" else 0)
    iterations, applications = model.get("iterations", 0), model["operator applications"]
    return WorkRow(
        planned.name, planned.family, planned.cells, unknowns, bonds, nonzeros, applied, iterations, applications,
        work=float(applied) * float(iterations if steady else applications), set_up=float(times["set-up"]), solve=float(times["stepping"]),
        wall_time=float(times["total"]), memory=float(model.get("memory", 0)), peak_memory=float(record.get("peak memory", 0)),
        spacing=max((upper - lower) / n for lower, upper, n in zip(facts["lower"], facts["upper"], planned.cells)))


def _text_of_settings(settings: dict, model: str) -> str:
    """"Cells = 16, 16; Degree = 2": what the model takes, but for what is switched off."""
    told = ["Domain/Cells", "Domain/Coarsening", "Domain/Fine where", "Cracks/Mesh", "Peridynamics/Surface correction", "Time/Tolerance"]
    if model != "peridynamics":
        told.append("Finite elements/Degree")
    if model != "finite elements":
        told += ["Peridynamics/Horizon ratio", "Peridynamics/Boundary treatment"]
    if model == "coupled":
        told.append("Coupling/Zone")
    return "; ".join(f"{entry.split('/', 1)[1]} = {settings[entry]}" for entry in told
                     if settings.get(entry, "") not in ("", "0", "auto", "none"))


def _pick(planned: Row, row: ComputedRow, error: float) -> Pick:
    accuracy = row.summary.get("accuracy", {})
    model = accuracy.get("model", "")
    return Pick(planned.name, planned.tolerance, error, float(accuracy.get("estimate", -1)), accuracy.get("met", False),
                float(row.record().get("wall time", 0)), len(accuracy.get("steps", [])), model,
                _text_of_settings(accuracy.get("settings", {}), model))


def _compare_in_time(facts: dict, plan: Plan, computed: List[ComputedRow], results: WorkResults) -> None:
    """Rows in which only the stepper differs, against one that has hardly an error in time."""
    exact = None
    for planned, row in zip(plan.rows, computed):
        if not row.is_finished:
            continue
        if planned.role == "exact in time":
            exact = row.grid(planned.family.model)
            results.method_in_time = f"{planned.family.name}, {lattice.name_of(planned.cells)}"
            for other in results.of_family(planned.family):
                if other.cells == planned.cells:
                    results.error_in_space = other.error
        if planned.role == "in time" and exact is not None:
            cost = _costs(planned, row, facts, steady=False)
            steps = row.summary["models"][planned.family.model].get("steps", 0)
            error = lattice.nodal_error(row.grid(planned.family.model), exact, planned.cells)
            results.in_time.append(TimeRow(planned.name, planned.stepper, planned.tolerance, steps, cost.iterations, cost.applications,
                                           cost.work, error, cost.wall_time))
