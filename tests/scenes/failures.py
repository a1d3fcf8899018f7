# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""The scenes of prm/failures: each fails as its comment says, is diagnosed with cause and remedy, and its healthy twin runs."""

import glob
import os

from scene_test import SOURCE_DIR, Comparison, check, finish, print_table, run_perideal, run_scene

# Refused: words of the message, and the overrides of the twin.
REFUSED = {
    "euler_above_limit.prm": (["'Time step'", "Lanczos", "Gershgorin"], {"Time/Time step": "5.6e-4"}),
    "rk4_above_limit.prm": (["'Time step'", "Lanczos", "Gershgorin"], {"Time/Time step": "7.9e-4"}),
    "isolated_node.prm": (["isolated", "(0.5", "'Cracks'"], {"Cracks/Transmission": "0.1"}),
    "island.prm": (["not determined", "'Cracks'", "'Transmission'"], {"Boundary conditions/Dirichlet": "left: 1; right: 0"}),
    "explicit_with_consistent_capacity.prm": (["'Stepper", "'Capacity", "lumped"], {"Finite elements/Capacity": "lumped"}),
    "chebyshev_with_changing_values.prm": (["'Stepper", "chebyshev", "rkc2"], {"Time/Stepper": "auto"}),
    "explicit_for_too_long.prm": (["'End time'", "'Steady = true'", "sdirk2"], {"Time/Steady": "true"}),
}

DISCRETE = {"Peridynamics/Calibration": "discrete"}

# Wrong: words of the note, the overrides of the twin, what is looked at, its value, and that of the
# twin.
WRONG = {
    "small_m_analytic.prm": (["0.9306", "'Calibration = discrete'"], DISCRETE, "heat", 0.930627, 1),
    "no_volume_fraction_1d.prm": (["1.320", "'Calibration = discrete'"], DISCRETE, "heat", 1.320099, 1),
    "no_volume_fraction_3d.prm": (["1.2996", "'Calibration = discrete'"], DISCRETE, "heat", 1.299636, 1),
    "paper_self_term.prm": (["1.066", "'Self term = none'"], {"Peridynamics/Self term": "none", **DISCRETE}, "error", 0.032, 0.003),
    "constant_layer.prm": (["first order", "'fictitious mirror'"], {"Peridynamics/Boundary treatment": "fictitious mirror"}, "error", None, None),
}


def refused():
    rows = []
    for name, (words, twin) in REFUSED.items():
        status, _, message = run_perideal(["run", f"prm/failures/{name}", "-s", "Output/Fields=none"], 1, 120, cwd=SOURCE_DIR)
        check(status == 1, f"{name}: exit status {status}")
        for word in words:
            check(word in message, f"{name}: the message does not say {word!r}: {message}")
        check("Stacktrace" not in message and message.count("perideal: error") == 1, f"{name}: one message and no trace")
        run_scene(f"prm/failures/{name}", {"Output/Fields": "none", **twin})  # fails the test if it does not run
        rows.append((name, message.strip().split("error: ")[-1][:150]))
    print_table("Refused", ("scene", "message"), rows)


def wrong():
    table = Comparison("Wrong, and said so")
    rows = []
    for name, (words, twin, what, value, healthy) in WRONG.items():
        found = []
        for overrides in ({}, twin):
            run = run_scene(f"prm/failures/{name}", {"Output/Fields": "none", "Solver/Tolerance": "1e-12", "Time/Tolerance": "1e-8",
                                                         **overrides})
            found.append(run.model("peridynamics")["boundary flux"]["left"] if what == "heat" else run.error("peridynamics"))
            notes = " ".join(run.summary["notes"])
            said = all(word in notes for word in words)
            check(said != bool(overrides), f"{name}: {'healthy twin' if overrides else 'failing scene'} notes: {notes}")
            if not overrides:
                rows.append((name, notes[:150]))
        if what == "heat":
            table.add(f"{name}: heat", found[0], value, relative=1e-5)
            table.add(f"{name}: heat of the twin", found[1], healthy, relative=1e-9)
        else:
            table.add_limit(f"{name}: error of the twin over its own ({found[0]:.2e})", found[1] / found[0], 0.25)
    table.show()
    print_table("Notes", ("scene", "note"), rows)


def main():
    listed = {os.path.basename(path) for path in glob.glob(os.path.join(SOURCE_DIR, "prm", "failures", "*.prm"))}
    check(listed == set(REFUSED) | set(WRONG), f"every scene of prm/failures is tested: {sorted(listed ^ (set(REFUSED) | set(WRONG)))}")
    refused()
    wrong()
    finish()


if __name__ == "__main__":
    main()
