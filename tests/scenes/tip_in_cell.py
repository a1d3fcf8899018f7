# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""An edge crack whose tip moves through a cell: stress intensity and opening of the mouth over those of a handbook."""

import math

from intensities import tada_edge
from scene_test import COUPLED, FE, PD, Comparison, finish, print_table, run_scene

SCENE = "prm/elasticity/tip_in_cell.prm"
PLACES = (0, 0.1, 0.25, 0.4, 0.5, 0.6, 0.75, 0.9)  # of the tip in its cell


def mouth(a):
    """Opening at the edge, width 1, modulus 200 (Tada, Paris and Irwin 2000)."""
    t = math.pi * a / 2
    return 4 * a / 200 * (1.46 + 3.42 * (1 - math.cos(t))) / math.cos(t) ** 2


def errors(more):
    """Of the models, relative errors of K_I (peridynamics: of the opening) for each place of the tip."""
    found = {FE: [], COUPLED: [], PD: []}
    for place in PLACES:
        a = 0.5 + place / 40
        run = run_scene(SCENE, {"Output/Fields": "none", "Cracks/Segments": f"0,0 ; {a!r},0", **more})
        for model in (FE, COUPLED):
            found[model].append(run.model(model)["stress intensity"]["crack 1 end 2"]["I"] / tada_edge(a) - 1)
        up, down = (row["uy"] for row in run.rows(PD))
        found[PD].append((up - down) / mouth(a) - 1)
    return found


def main():
    table = Comparison("Edge crack, tip in a cell, 40 x 121 cells")
    in_part, whole = errors({}), errors({"Cracks/Bonds through tips": "auto"})
    rows = []
    for model in in_part:
        for name, found in (("in part", in_part[model]), ("whole", whole[model])):
            rows.append((model, name, *(f"{100 * e:+.2f}" for e in found)))
    print_table("Relative errors in %", ("model", "cut", *map(str, PLACES)), rows)
    spread = {model: max(e) - min(e) for model, e in in_part.items()}
    for model in in_part:
        table.add_limit(f"{model}: spread over the places", spread[model], SPREAD[model])
        table.add_limit(f"{model}: spread over that of whole bonds and cells", spread[model] / (max(whole[model]) - min(whole[model])), 0.4)
    table.add_limit(f"{FE}: largest error of K_I", max(map(abs, in_part[FE])), 2e-2)
    table.add_limit(f"{COUPLED}: largest error of K_I", max(map(abs, in_part[COUPLED])), 1.5e-2)
    table.show()


# Measured: 3.5e-3, 6.3e-3 and 1.3e-2; with whole bonds and cells 0.12, 0.04 and 0.057.
SPREAD = {FE: 5e-3, COUPLED: 1e-2, PD: 2e-2}

if __name__ == "__main__":
    main()
    finish()
