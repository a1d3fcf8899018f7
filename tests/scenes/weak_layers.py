# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""A layer that is weak, and thinner than the horizon or than a cell, takes its own energy to break: what a plate wholly of it takes.

    weak_layers.py bonds | coupled | table
"""

from scene_test import COUPLED, PD, Comparison, run_parts, run_scene

SCENE = "prm/fracture/double_cantilever.prm"
QUIET = {"Output/Fields": "none", "Output/Write at": "", "Time/Time step": "0.05"}
STRONG = {"Material/Fracture energy": "0.1"}


def phase(half_width):
    return {**STRONG, "Material/Phases/Regions": f"glue: {half_width} - abs(y)", "Material/Phases/Fracture energy": "glue: 0.01"}


FORMULA = {"Material/Fracture energy": "if(abs(y) < 0.014, 0.01, 0.1)"}


def rate(model, more):
    """Energy dissipated per length of new crack: a crack in a plate may turn or fork, one in a layer does not."""
    run = run_scene(SCENE, {**QUIET, "Models": model, **more})
    return run.model(model)["energy balance"]["dissipated"] / run.model(model)["new cracks"]["length"]


def compare(table, model, what, lattice, layers):
    whole = rate(model, lattice)
    for name, layer in layers:
        table.add(f"{model}, {what}, {name}: dissipated per length, over that of a plate of the layer's energy", rate(model, {**lattice, **layer}) / whole, 1, absolute=0.15)


def bonds():
    table = Comparison("Weak layers, peridynamics")
    coarse = {"Domain/Cells": "100, 20"}  # measured: 0.954 to 0.969 (m = 3), 0.939 (m = 6); on 150 x 30 cells, m = 4: 1.000
    for m in ("3", "4"):
        compare(table, PD, f"m = {m}", {**coarse, "Peridynamics/Horizon ratio": m}, (("phase", phase(0.014)), ("formula", FORMULA))[:2 if m == "3" else 1])
    compare(table, PD, "m = 3, nodes at vertices", {"Domain/Cells": "100, 21", "Domain/Nodes": "vertices", "Peridynamics/Horizon ratio": "3"}, (("phase", phase(0.014)),))
    table.show()


def coupled():
    table = Comparison("Weak layers, coupled")
    compare(table, COUPLED, "m = 3", {"Domain/Cells": "100, 21", "Domain/Nodes": "vertices", "Peridynamics/Horizon ratio": "3", "Coupling/Zone": "follow"}, (("phase", phase(0.01)),))
    table.show()


def table():
    """More lattices, horizons and widths."""
    shown = Comparison("Weak layers, 150 x 30 cells")
    for m in ("3", "4", "6"):
        compare(shown, PD, f"m = {m}", {"Peridynamics/Horizon ratio": m}, ((f"width {w}", phase(w)) for w in (0.003, 0.014)))
    shown.show()


if __name__ == "__main__":
    run_parts(bonds, coupled, table=table)
