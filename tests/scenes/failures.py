# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""The scenes of prm/failures: each fails as its comment says, is diagnosed with cause and remedy, and its healthy twin runs."""

import glob
import math
import os
from collections import namedtuple

from scene_test import QUIET, SOURCE_DIR, TRACES, check, check_message, finish, print_table, run_scene

# Refused, or stopped: words of the message.
REFUSED = {
    "chebyshev_with_changing_values.prm": ["'Stepper", "chebyshev", "rkc2"],
    "conductor_that_warms.prm": ["'Time step'", "at these temperatures", "'Time step = auto'"],
    "distorted_zone.prm": ["not sound", "eigenvalue", "below 0", "less distorted cells"],
    "euler_above_limit.prm": ["'Time step'", "Lanczos", "Gershgorin"],
    "explicit_for_too_long.prm": ["'End time'", "'Steady = true'", "sdirk2"],
    "explicit_with_consistent_capacity.prm": ["'Stepper", "'Capacity", "lumped"],
    "flat_cells.prm": ["'Horizon ratio'", "0.03", "0.1", "no neighbours"],
    "hanging_nodes_in_zone.prm": ["'Coarsening'", "peridynamics", "'coupled'"],
    "island.prm": ["not determined", "'Cracks'", "'Transmission'"],
    "isolated_node.prm": ["isolated", "(0.5", "'Cracks'"],
    "loaded_island.prm": ["Nothing holds", "(1.1", "'Displacement'"],
    "nearly_isolated_node.prm": ["'Surface correction = energy'", "reaches out in y", "'Horizon ratio'"],
    "open_circuit.prm": ["not determined", "(1.05", "'Cracks'"],
    "perfect_conductor.prm": ["of the heat that has come in since the start is not in the body", "'Conductivity' in section 'Material' is 1e+12", "at (0.2, ", "round-off"],
    "rigid_inclusion.prm": ["stopped after 1000 iterations", "The Young modulus in section 'Material' is 1e+06", "iterations hardly get across"],
    "rough_equilibrium.prm": ["do not balance", "'Tolerance' in section 'Solver' is 0.1"],
    "rough_steps.prm": ["t = 0.06, after 12 steps", "has not come in since the start", "'Tolerance' in section 'Solver' is 0.1"],
    "rk4_above_limit.prm": ["'Time step'", "Lanczos", "Gershgorin"],
    "source_that_ends.prm": ["'Source'", "sqrt(0.05 - t)", "is not finite at ("],
    "thin_body.prm": ["narrower than the horizon", "'Horizon'"],
    "torn_by_traction.prm": ["No equilibrium", "bonds had broken", "'Displacement'", "'Solver = dynamics'"],
    "verlet_above_limit.prm": ["'Time step'", "2/omega", "'Stepper = newmark'"],
}

# Stopped on the way, so that tables and fields until then stay: the status in the summary.
STOPPED = {name: "diverged" for name in ("perfect_conductor.prm", "rough_steps.prm", "source_that_ends.prm", "torn_by_traction.prm")}

# Words of one note, what is looked at, what it is in the failing scene, by what share of that it may
# be off, what it should be (a number, or a function of the twin), and by how much it may be off that
# in the twin.
Wrong = namedtuple("Wrong", "words measure wrong share right good")


def flow(side="left", model="peridynamics"):
    return lambda run: run.model(model)["boundary flux"][side]


def error(model, kind="relative l2"):
    return lambda run: run.error(model, kind=kind)


def last(quantity, model):
    return lambda run: run.total(quantity, model)


def strain(column, along="ux"):
    """Of a plate that is pulled along x: between the two probes, (0.4, 0.4) and (0.5, 0.5)."""
    return lambda run: (run.probe("peridynamics", (0.5, 0.5), column=column) - run.probe("peridynamics", (0.4, 0.4), column=column)) / 0.1


def contraction(run):
    return -strain("uy")(run) / strain("ux")(run)


def diagonal(run):
    """The distance of two corners over that at the start."""
    ends = [[at[0] + run.probe("peridynamics", at, column="ux"), at[1] + run.probe("peridynamics", at, column="uy")]
            for at in ((-0.5, -0.5), (0.5, 0.5))]
    return math.dist(*ends) / math.sqrt(2)


def deflection(run):
    at = (10, 0)
    return run.probe("finite elements", at, column="uy") / run.probe("exact", at, column="uy")


def strength(run):
    """The largest force over that at which a crack of 0.4 in a plate 1 wide has K = sqrt(E G), with Tada's formula for its width."""
    share = 0.4
    width = math.sqrt(1 / math.cos(math.pi * share / 2)) * (1 - 0.025 * share**2 + 0.06 * share**4)
    return run.model("peridynamics")["largest force"]["value"] * math.sqrt(math.pi * 0.2) * width / math.sqrt(200 * 0.01)


def crack_energy(run):
    """What an edge crack of 0.2 in a strip 1 wide adds to its strain energy, over the integral of K^2/E with Tada's formula for K."""
    def rate(a):
        return math.pi * a * (1.122 - 0.231 * a + 10.55 * a**2 - 21.71 * a**3 + 30.382 * a**4)**2

    n, a = 1000, 0.2
    exact = sum(rate(a * (k + 0.5) / n) for k in range(n)) * a / n
    return (run.model("finite elements")["strain energy"] - 1.5) / exact


def from_erfc(run):
    """The largest error at the probes, of a jump that spreads into a half-space."""
    rows = run.rows("finite elements", time=0.01)
    return max(abs(row["value"] - math.erfc(row["x"] / math.sqrt(4 * 0.01))) for row in rows)


def from_erfc_along_line(run):
    values = run.along_line("finite elements")
    return max(abs(value - math.erfc(k / (len(values) - 1) / math.sqrt(4 * 0.01))) for k, value in enumerate(values))


def wetness_of_series(t):
    """Crank (1975), equation 4.18: of a plate 1 thick, dry at first, with wet sides."""
    return 1 - 8 / math.pi**2 * sum(math.exp(-(k * math.pi)**2 * t) / k**2 for k in range(1, 400, 2))


def leap_reference(_):
    """With four times as many growth steps as the twin."""
    run = run_scene("prm/failures/healthy/growth_in_leaps.prm", {"Output/Fields": "none", "Cracks/Growth step": "0.0015"})
    return ahead(run)


def ahead(run):
    return run.probe("coupled", (0.25, 0.55), time=0.04)


def added_heat(run):
    stored = run.total("heat stored since start", "coupled")
    return stored / (run.total("heat content", "coupled") - stored)


def largest_force(run):
    return run.model("peridynamics")["largest force"]["value"]


def beside_load(run):
    """Bonds that broke beside the loaded side before any did elsewhere; of the twin all of them."""
    return run.model("peridynamics").get("broken beside loads", {}).get("right", run.total("broken bonds", "peridynamics"))


def sum_beside_crack(run):
    return run.probe("peridynamics", (0, 0.1)) + run.probe("peridynamics", (0, -0.1))


CALIBRATION = ["'Calibration = discrete'"]
WRONG = {
    "blended_tension.prm": Wrong(["'Scheme = blending'", "'exchange'"], lambda run: run.error("coupled", kind="maximum") / 1e-3, 0.0144, 0.01, 0, 1e-12),
    "bridged_void.prm": Wrong(["11 places", "'Bonds across voids = cut'"], flow(), 0.359, 0.01, 0, 1e-9),
    "brittle_softening.prm": Wrong(["break at once, and do not soften", "0.0345", "shorter horizon"], lambda run: largest_force(run) / (9e-4 * 0.25), 0.312, 0.01, 1, 0.13),
    "cells_removed.prm": Wrong(["takes away 41 cells", "'pairs'"], error("finite elements"), 0.0199, 0.01, 0, 0.002),
    "constant_layer.prm": Wrong(["first order", "'fictitious mirror'"], error("peridynamics"), 0.0289, 0.01, 0, 0.003),
    "contrast_arithmetic.prm": Wrong(["100 : 1", "'Interface rule = harmonic'"], flow(), 1.0686, 0.01, 0.5 / (0.5 + 0.5 / 100), 1e-8),
    "crushed_bar.prm": Wrong(["inside out at 85 nodes", "'Kinematics = linear'"],
                             lambda run: 1 + run.probe("finite elements", (1, 0), column="ux"), -0.5, 1e-8, 0.985, 1e-9),
    "energy_in_one_direction.prm": Wrong(["'Correction direction = y'", "'both'"], flow(), 0.5337, 0.01, 0.5, 0.006),
    "families_cut_off.prm": Wrong(["families end at the sides 'bottom', 'top'", "'Boundary treatment = exchange'"], flow(), 0.2288, 0.01, 0.25, 1e-9),
    "few_bonds_in_shear.prm": Wrong(["m = 2", "shear modulus", "'Calibration = isotropic'"], lambda run: strain("ux")(run) / 1e-3, 0.853, 0.01, 1, 1e-4),
    "film_beside_faces.prm": Wrong(["in 2 cells materials meet", "'Cells'"], lambda run: flow(model="finite elements")(run) * (0.9 + 0.1e6), 2, 1e-4, 1, 1e-6),
    "flying_fragment.prm": Wrong(["has turned by up to 1 ", "'Kinematics = full'"], diagonal, math.sqrt(2), 1e-9, 1, 1e-3),
    "forgotten_density.prm": Wrong(["'Density'", "its default", "4.47e+05"], error("finite elements"), 0.719, 0.01, 0, 1e-4),
    "growth_in_leaps.prm": Wrong(["leap over", "'Growth step'"], ahead, 0.570, 0.01, leap_reference, 0.004),
    "incompressible_elements.prm": Wrong(["cannot bend", "'Degree = 2'"], deflection, 0.096, 0.01, 1, 1e-6),
    "lattice_trapping.prm": Wrong(["26 bonds that hold it back", "'Horizon ratio'"], strength, 1.11, 0.01, 0.946, 0.03),
    "loaded_row.prm": Wrong(["one row of nodes", "'Surface correction = none'", "'auto'"],
                            lambda run: run.probe("peridynamics", (1, 0.5), column="ux") / 1e-3, 1.19, 0.01, 1, 0.01),
    "no_volume_fraction_1d.prm": Wrong(["1.320", *CALIBRATION], flow(), 1.320099, 1e-5, 1, 1e-9),
    "no_volume_fraction_3d.prm": Wrong(["1.2996", *CALIBRATION], flow(), 1.299636, 1e-5, 1, 1e-9),
    "nodes_on_crack.prm": Wrong(["along a row of nodes", "belong to its left side", "Without 'Nodes on cracks = left'"], sum_beside_crack, -2.79, 0.01, 0, 1e-8),
    "paper_self_term.prm": Wrong(["1.066", "'Self term = none'"], error("peridynamics"), 0.032, 0.05, 0, 0.008),
    "percent_for_wetness.prm": Wrong(["wetness of 85", "percent by 100"], last("weight", "finite elements"), 1062.5, 1e-8, 10.625, 1e-6),
    "poisson_of_bonds.prm": Wrong(["0.333333333333", "which is 0", "'state-based'"], contraction, 0.333, 0.002, 0, 1e-4),
    "quenched_at_once.prm": Wrong(["59 bonds broke at t = 0", "'Convection'"], lambda run: run.total("broken bonds", "peridynamics", time=0), 59, 1e-9, 0, 0),
    "rkc2_in_few_steps.prm": Wrong(["'rkc2' leaves up to 0.951", "'Time step = auto'"], from_erfc, 0.43, 0.01, 0, 0.01),
    "small_m_analytic.prm": Wrong(["0.9306", *CALIBRATION], flow(), 0.930627, 1e-5, 1, 1e-9),
    "smooth_peridynamics.prm": Wrong(["no crack, one material", "'Models = finite elements'"],
                                     lambda run: run.error(list(run.summary["models"])[0]), 0.032, 0.01, 0, 0.005),
    "source_between_points.prm": Wrong(["0.00136 of it", "'Source'", "'Cells'"],
                                       lambda run: -(flow("left")(run) + flow("right")(run)) / (0.01 * math.sqrt(math.pi)), 0.00136, 0.01, 1, 1e-6),
    "spliced_pulse.prm": Wrong(["a linear field comes out wrong", "'Scheme = exchange'"], added_heat, 0.0047, 0.01, 0, 1e-10),
    "textbook_stretch.prm": Wrong(["'Critical stretch'", "fracture energy of 0.0107", "'Fracture energy'"], largest_force, 1.966, 0.01, largest_force, 0),
    "thermal_shock_in_large_steps.prm": Wrong(["'crank nicolson' leaves up to 0.975", "'Stepper = sdirk2'"],
                                              from_erfc_along_line, 0.021, 0.01, 0, 1e-3),
    "tip_inside_cell.prm": Wrong(["0.4 of a cell", "shorter", "'Mesh = faces'"], crack_energy, 0.89, 0.01, 1, 0.03),
    "torn_row.prm": Wrong(["bonds broke beside the loaded side 'right' before any did elsewhere", "'Surface correction = auto'"], beside_load, 32, 1e-3, 0, 0),
    "transmission_of_a_horizon.prm": Wrong(["'Transmission = 0.5'", "16.8", "'Contact conductance'"], flow(model="finite elements"), 0.472, 0.01, 1 / 3, 1e-8),
    "wetting_layer.prm": Wrong(["first order", "'fictitious mirror'"], last("weight", "peridynamics"), 0.84 * wetness_of_series(0.04), 0.01, wetness_of_series(0.04), 0.01),
}

DIGITS = {**QUIET, "Solver/Tolerance": "1e-12", "Time/Tolerance": "1e-8"}  # for what comments give to many of them


# Notes of healthy twins: what was done, and advice that is not about what failed.
ADVICE = ("the image has", "reaches out of the body", "are taken as", "the cracks grow in", "finite elements solve the same problem", "of this horizon",
          "a crack along the rows", "shear modulus", "divides the stiffness of a bond", "holds the outermost row",
          "conducts as if it was")


def twin_of(name, overrides, words):
    """Runs clean: to its end, and without that note or others that something is wrong."""
    run = run_scene(f"prm/failures/healthy/{name}", overrides)  # fails the test if it does not run
    check(run.summary["status"] == "complete" and run.stderr == "", f"{name}: the twin is {run.summary['status']}: {run.stderr}")
    check(note_with(run, words) is None, f"{name}: the twin has the note, too")
    for note in run.summary["notes"]:
        check(any(words in note for words in ADVICE), f"{name}: a note of the twin: {note}")
    return run


def note_with(run, words):
    return next((note for note in run.summary["notes"] if all(word in note for word in words)), None)


def refused():
    rows = []
    for name, words in REFUSED.items():
        run = run_scene(f"prm/failures/{name}", QUIET, check_status=False)
        check(run.returncode == 1, f"{name}: exit status {run.returncode}")
        check_message(run, *words, what=name)
        check(not any(trace in run.stderr for trace in TRACES) and run.stderr.count("error:") == 1, f"{name}: one message and no trace: {run.stderr}")
        if name in STOPPED:
            check(run.summary["status"] == STOPPED[name] and len(run.totals) > 0, f"{name}: {run.summary['status']}")
        twin_of(name, QUIET, words)
        rows.append((name, run.stderr.strip().split("error: ")[-1][:150]))
    print_table("Refused", ("scene", "message"), rows)


def wrong():
    rows, notes = [], []
    for name, case in WRONG.items():
        overrides = DIGITS if case.share <= 1e-5 else QUIET
        run = run_scene(f"prm/failures/{name}", overrides)
        twin = twin_of(name, overrides, case.words)
        note = note_with(run, case.words)
        if check(note is not None, f"{name}: no note says {case.words}: {run.summary['notes']}"):
            notes.append((name, note[:150]))
        right = case.right(twin) if callable(case.right) else case.right
        values = case.measure(run), case.measure(twin)
        check(abs(values[0] - case.wrong) <= case.share * abs(case.wrong), f"{name}: {values[0]:.8g} where its comment says {case.wrong:.8g}")
        check(abs(values[1] - right) <= case.good, f"{name}: {values[1]:.10g} of the twin where {right:.10g} is right, to {case.good}")
        check(abs(values[0] - right) > 4 * abs(values[1] - right), f"{name}: {values[0]:.8g} is not worse than the twin's {values[1]:.8g}, beside {right:.8g}")
        rows.append((name, values[0], case.wrong, values[1], right))
    print_table("Wrong, and said so", ("scene", "failing", "as its comment says", "twin", "right"), rows)
    print_table("Notes", ("scene", "note"), notes)


def main():
    folder = os.path.join(SOURCE_DIR, "prm", "failures")
    listed = {os.path.basename(path) for path in glob.glob(os.path.join(folder, "*.prm"))}
    twins = {os.path.basename(path) for path in glob.glob(os.path.join(folder, "healthy", "*.prm"))}
    tested = set(REFUSED) | set(WRONG)
    check(listed == tested, f"every scene of prm/failures is tested: {sorted(listed ^ tested)}")
    check(twins == tested, f"every scene of prm/failures has a healthy twin: {sorted(twins ^ tested)}")
    refused()
    wrong()
    finish()


if __name__ == "__main__":
    main()
