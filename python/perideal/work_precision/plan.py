# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""What is computed of a scene, and what is not, with the reason."""

import dataclasses
import math
from typing import Dict, List, Optional

from ..program import Error
from . import growth, lattice
from .families import FAMILIES, Family
from .lattice import Cells
from ..words import did_you_mean, full_precision, number_text, readable_count

MEASURES = ("field", "opening", "stress intensity", *growth.MEASURES)
N_RUNGS = 4
PICKED = ("3e-2", "1e-2", "1e-3")


@dataclasses.dataclass
class Row:
    """A run of a plan.

    role: "reference"; "method"; "pick", by `Models = auto`, for what it costs; "pick values", the same with the values that are compared,
    since to read them takes long; "exact in time", the same in space with hardly an error in time; "in time", of which only the error in time
    counts.
    """

    name: str
    role: str
    cells: Cells  # of a pick: on whose vertices it is compared
    settings: Dict[str, str]
    family: Optional[Family] = None  # none for the reference and for picks
    stepper: str = ""
    tolerance: float = 0.0  # of a pick, or of a stepper that adapts its steps

    @property
    def is_chosen(self) -> bool:
        """The program chooses the model and the mesh."""
        return self.role in ("pick", "pick values") or "Accuracy/Measure" in self.settings

    @property
    def may_fail(self) -> bool:
        """A choice of the program, or a step that is not stable, may turn out to be impossible only as it is computed."""
        return self.is_chosen or self.role == "in time" or (self.family is not None and self.family.courant > 0)


@dataclasses.dataclass
class Plan:
    """All rows, the reference first."""

    measure: str
    comparison: str  # one of FAMILIES
    ladder: List[Cells] = dataclasses.field(default_factory=list)
    reference: List[Cells] = dataclasses.field(default_factory=list)  # empty: the scene has a solution
    rows: List[Row] = dataclasses.field(default_factory=list)
    left_out: List[str] = dataclasses.field(default_factory=list)  # sentences
    no_picks: str = ""  # why there are none, if there are none
    probes: str = ""  # opening: points right and left of cracks by turns

    def lattices(self) -> List[Cells]:
        """Those whose vertices the reference is needed at: all of the rows, each once."""
        return sorted({row.cells for row in self.rows if row.role in ("method", "pick values")})


def comparison_of(facts: dict, measure: str = "field") -> str:
    """Among which methods a scene lets one choose."""
    if measure in growth.MEASURES:
        return "growth"
    if facts.get("mesh file"):
        return "mesh"
    if facts["cracks"]:
        return "solid cracks" if facts["deforms"] else "cracks"
    return "field" if not facts["deforms"] else "motion" if facts["moves"] else "solid"


def require_comparable(facts: dict) -> None:
    """Raises Error where methods and lattices cannot be compared."""
    if facts["holes"]:
        raise Error("work_precision: 'Holes' in section 'Domain' has to be empty: a body with holes changes with the lattice.")
    if facts.get("mesh file"):
        if facts["cracks"] or facts["deforms"] or not facts["exact solution"] or not facts["steady"]:
            raise Error("work_precision: a body from a mesh file ('Shape' in section 'Domain') is compared where its state is steady, has no cracks, and "
                        "'Solution' in section 'Reference' is given: heat, moisture and electricity.")
        return
    if not facts["box"]:
        raise Error("work_precision: 'Shape' in section 'Domain' has to be box: other bodies change with the lattice, or have none.")
    if facts["cracks conduct"] and facts["contact conductance"] < 0:
        raise Error("work_precision: 'Transmission' in section 'Cracks' is a share of bonds of one horizon, another crack on each lattice. "
                    "Give 'Contact conductance' in its place.")
    if facts["cracks conduct"] and not facts["exact solution"]:
        raise Error("work_precision: the cracks conduct ('Contact conductance' in section 'Cracks'), and cannot be cut into the mesh of the "
                    "reference then. Give 'Solution' in section 'Reference'.")


def parse_measure(text: str) -> str:
    """Raises Error for words that are no measure."""
    if text not in MEASURES:
        raise Error(f"command line: --measure '{text}': needs one of field, opening, stress intensity, strength, path." + did_you_mean(text, MEASURES))
    return text


def make_plan(facts: dict, measure: str, cells: str = "", reference: str = "", budget: float = 2e6, picks: bool = True,
              no_choice: str = "") -> Plan:
    """The plan for a scene in a box, with these facts. Raises Error.

    cells, reference: lattices as of the command line. budget: bonds of peridynamics in the whole body. no_choice: why `Models = auto` does not
    choose for the scene.
    """
    dim = facts["dimension"]
    plan = Plan(parse_measure(measure), comparison_of(facts, measure))
    if plan.comparison == "mesh":
        _add_halvings(plan, facts, cells, picks, no_choice)
        return plan
    plan.ladder = lattice.parse_ladder(cells, "--cells", dim, 2) if cells else lattice.default_ladder(tuple(facts["cells"]), N_RUNGS)
    if len(plan.ladder) < 2:
        raise Error(f"work_precision needs at least two lattices, but 'Cells' in section 'Domain', {lattice.to_text(facts['cells'])}, is too "
                    "coarse to be halved. Give more cells, or name lattices with --cells.")
    if measure in growth.MEASURES:
        _add_growth(plan, facts, budget, picks, no_choice)
        return plan
    if facts["exact solution"] and reference and measure != "stress intensity":
        raise Error("command line: --reference: the scene has a 'Solution' in section 'Reference', with which it is compared.")
    if measure != "field" and (plan.comparison != "solid cracks" or dim != 2):
        raise Error("command line: --measure: 'opening' and 'stress intensity' are of cracks in elastic bodies, in two dimensions. Use 'field'.")
    if measure == "opening":
        plan.probes = _beside_sides(facts, plan.ladder[0])
    if not facts["exact solution"] or measure == "stress intensity":
        _add_reference(plan, facts, reference)
    for family in FAMILIES[plan.comparison]:
        if measure == "stress intensity" and family.model == "peridynamics":
            plan.left_out.append(f"{family.name}: no stress intensities.")
        elif facts["zone by a formula"] or not family.given_zone:
            _add_rows(plan, facts, family, budget)
    if picks:
        _add_picks(plan, facts, no_choice)
    if not facts["steady"] and plan.comparison in ("cracks", "field"):
        _add_steppers(plan)
    return plan


def _add_halvings(plan: Plan, facts: dict, cells: str, picks: bool, no_choice: str) -> None:
    """The cells of the file, halved ever more often; the scene's horizon is that of its `Refinements`."""
    if plan.measure != "field":
        raise Error(f"command line: --measure '{plan.measure}': of a body from a mesh file fields are compared. Use 'field'.")
    plan.ladder = lattice.parse_ladder(cells, "--cells", 1, 2) if cells else [(2 ** k,) for k in range(N_RUNGS)]
    if any(n & (n - 1) for n, in plan.ladder):
        raise Error(f"command line: --cells '{cells}': of a mesh file needs into how many an edge is divided, powers of two: '1 | 2 | 4 | 8'.")
    for family in FAMILIES[plan.comparison]:
        if family.model == "peridynamics" and not facts["horizon"] > 0:
            plan.left_out.append(f"{family.name}: 'Horizon' in section 'Peridynamics' is no length.")
            continue
        for rung in plan.ladder:
            times = rung[0].bit_length() - 1
            if times == 0 and family.halvings > 1:
                continue  # nothing is halved
            own = {"Domain/Refinements": str(family.halvings * times), "Domain/Coarsening": str((family.halvings - 1) * times)}
            if family.model == "peridynamics":
                own["Peridynamics/Horizon"] = full_precision(facts["horizon"] * 2.0 ** (facts["refinements"] - times))
            plan.rows.append(Row(f"{family.name}, edges in {rung[0]}", "method", rung, {**family.settings, **own}, family))
    plan.no_picks = no_choice
    for tolerance in PICKED if picks and not no_choice else ():
        plan.rows.append(Row(f"auto, {tolerance}", "pick", plan.ladder[-1], {
            "Models": "auto", "Peridynamics/Horizon": "", "Accuracy/Measure": "field", "Accuracy/Tolerance": tolerance}, tolerance=float(tolerance)))


def _add_growth(plan: Plan, facts: dict, budget: float, picks: bool, no_choice: str) -> None:
    """Bonds that break, against what the program chooses for a small tolerance."""
    growth.require_growth(facts, plan.measure)
    if no_choice:
        raise Error(f"work_precision has nothing to compare with: {no_choice}")
    least = growth.REFERENCE[plan.measure]
    plan.rows.append(Row(f"reference, auto, {least}", "reference", plan.ladder[-1], growth.settings_of_choice(plan.measure, least), tolerance=float(least)))
    for family in FAMILIES[plan.comparison]:
        _add_rows(plan, facts, family, budget)
    for tolerance in growth.PICKED if picks else ():
        plan.rows.append(Row(f"auto, {tolerance}", "pick", plan.ladder[-1], growth.settings_of_choice(plan.measure, tolerance), tolerance=float(tolerance)))


def _add_reference(plan: Plan, facts: dict, given: str) -> None:
    if plan.comparison == "motion":
        raise Error("work_precision has nothing to compare a motion with: 'Solution' in section 'Reference' is empty. Give the exact solution.")
    if not facts["cracks change"]:
        plan.reference = _reference_lattices(facts, plan.ladder, given)
    if not plan.reference:
        why = ("the cracks grow" if facts["cracks change"] else "not all cracks run along the axes" if not facts["cracks along axes"] else
               "no lattice of similar cells has the ends of all cracks on its vertices")
        raise Error("work_precision has nothing to compare with: 'Solution' in section 'Reference' is empty, and no reference can be computed "
                    f"by finite elements with the cracks on cell faces, because {why}. Give the exact solution.")
    # As the finite elements it is compared with, without cracks of degree 2.
    family = FAMILIES[plan.comparison][0 if facts["cracks"] else 1]
    for cells in plan.reference:
        plan.rows.append(Row(f"reference, {lattice.name_of(cells)}", "reference", cells, family.settings))


def _reference_lattices(facts: dict, ladder: List[Cells], given: str) -> List[Cells]:
    """Three, each twice as fine as the one before, with the cracks on faces; none where there are none."""
    if given:
        lattices = lattice.parse_ladder(given, "--reference", facts["dimension"], 3)
        if len(lattices) != 3 or not all(lattice.nearest_fitting(facts, cells, True, 1) == cells for cells in lattices) or not all(
                tuple(2 * n for n in coarse) == fine for coarse, fine in zip(lattices, lattices[1:])):
            raise Error(f"command line: --reference '{given}': needs three lattices, each with twice the cells of the one before, on whose cell "
                        "faces all cracks lie.")
        return lattices
    # The finest is six times as fine as the finest of the study, in 3D twice; of degree 2, where
    # there are no cracks, twice, in 3D as fine.
    is_3d = facts["dimension"] == 3
    factor = (0.25 if is_3d else 0.5) if not facts["cracks"] else 1.5 if facts["dimension"] == 2 else 0.5
    finest = lattice.nearest_fitting(facts, ladder[-1], True, 1) or ladder[-1]
    coarsest = lattice.nearest_fitting(facts, tuple(max(2, lattice.nearest_whole(factor * n)) for n in finest), True, 1)
    return [tuple(k * n for n in coarsest) for k in (1, 2, 4)] if coarsest else []


def _add_rows(plan: Plan, facts: dict, family: Family, budget: float) -> None:
    why = ": no similar lattice" + (f" divisible by {family.multiple}" if family.multiple > 1 else "") + (
        "." if not family.on_faces else " has all cracks on cell faces." if family.multiple == 1 else
        " has all cracks on faces of the largest cells.")
    last = None
    for rung in plan.ladder:
        cells = lattice.nearest_fitting(facts, rung, family.on_faces, family.multiple)
        moving = family.on_faces and facts["cracks change"]
        if cells is None or moving:
            plan.left_out.append(f"{family.name}, near {lattice.name_of(rung)}" + (": the cracks grow." if moving else why))
            continue
        if cells == last:
            continue
        name = f"{family.name}, {lattice.name_of(cells)}"
        n_bonds = lattice.estimated_bonds(facts, cells, family.ratio) if family.ratio > 0 else 0.0
        if n_bonds > budget:
            plan.left_out.append(f"{name}: about {readable_count(int(n_bonds))} bonds, more than --budget {number_text(budget)}.")
            continue
        plan.rows.append(Row(name, "method", cells, family.settings, family))
        last = cells


def _beside_cracks(facts: dict, cells: Cells) -> Cells:
    """Vertices on a crack have two values: where it runs along them, one more cell has none."""
    counts = list(cells)
    for crack in facts["cracks"]:
        for d in range(facts["dimension"]):
            length = facts["upper"][d] - facts["lower"][d]
            s = (crack[0][d] - facts["lower"][d]) / length * counts[d]
            if all(abs(corner[d] - crack[0][d]) <= 1e-9 * length for corner in crack) and abs(s - round(s)) < 1e-7:
                counts[d] += 1
    return tuple(counts)


def _beside_sides(facts: dict, coarsest: Cells) -> str:
    """Nine points along each crack, a spacing of the coarsest lattice to the right and left."""
    off = max((upper - lower) / n for lower, upper, n in zip(facts["lower"], facts["upper"], coarsest))
    points = []
    for (x, y), (end_x, end_y), *_ in facts["cracks"]:
        along_x, along_y = end_x - x, end_y - y
        length = math.hypot(along_x, along_y)
        for s in (0.1 * k for k in range(1, 10)):
            for side in (off, -off):
                points.append(number_text(x + s * along_x + side * along_y / length) + ", " +
                              number_text(y + s * along_y - side * along_x / length))
    return " ; ".join(points)


def _add_picks(plan: Plan, facts: dict, no_choice: str) -> None:
    plan.no_picks = no_choice
    if no_choice:
        return
    compared = _beside_cracks(facts, plan.ladder[-1])
    for tolerance in PICKED:
        for role, what in (("pick", ""), ("pick values", ", values")):
            plan.rows.append(Row(f"auto, {tolerance}{what}", role, compared, {
                "Models": "auto", "Peridynamics/Horizon": "",  # the classical solution, as all
                "Accuracy/Measure": "stress intensity" if plan.measure == "stress intensity" else "field",
                "Accuracy/Tolerance": tolerance}, tolerance=float(tolerance)))


def _add_steppers(plan: Plan) -> None:
    """One method on the finest lattice but one with all steppers; those with fixed steps take the largest that are stable."""
    wanted = "FEM, pairs, scaled" if plan.comparison == "cracks" else "FEM, degree 1"
    family = next(family for family in FAMILIES[plan.comparison] if family.name == wanted)

    def add(name, role, stepper, tolerance=""):
        settings = {**family.settings, "Time/Stepper": stepper, "Time/Time step": "auto"}
        if tolerance:
            settings["Time/Tolerance"] = tolerance
        plan.rows.append(Row(f"in time: {name}", role, plan.ladder[-2], settings, family, stepper,
                             float(tolerance) if tolerance else 0.0))

    add("reference", "exact in time", "auto", "1e-9")
    for stepper in ("euler", "rk4"):
        add(stepper, "in time", stepper)
    for stepper in ("rkc2", "chebyshev", "crank nicolson", "bdf2", "sdirk2"):
        for tolerance in ("1e-2", "1e-3", "1e-4", "1e-5"):
            add(f"{stepper}, {tolerance}", "in time", stepper, tolerance)
