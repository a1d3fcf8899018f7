# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""J and stress intensities along crack fronts in three dimensions, against infinite bodies whose displacement is given on all sides.

    front_intensities.py disc | through | table
"""

import math
import sys

from cracked_block import Disc, Through
from scene_test import COUPLED, FE, PD, Comparison, check, check_close, finish, run_scene, scene_text

CENTERS, VERTICES = "cell centers", "vertices"
SCENE = scene_text("""
Dimension = 3
Physics = elasticity
Domain/Lower corner = -1, -1, -1
Domain/Upper corner = 1, 1, 1
Material/Young modulus = 1
Elasticity/Contact = false
Output/Fields = none
""")

# Of K_I, K_II, K_III and the intensity of J, over the whole intensity.
DISC_BOUNDS = (0.03, 0.03, 0.03, 0.03)
THROUGH_BOUNDS = (0.02, 0.02, 0.02, 0.02)


def body(n, nodes, m, models=PD):
    """A block of edge 2. Between cell centers two rows have to be held for uniform strains to be exact (doc/elasticity.md)."""
    return {"Models": models, "Domain/Cells": f"{n}, {n}, {n}", "Domain/Nodes": nodes, "Peridynamics/Horizon ratio": str(m),
            "Peridynamics/Surface correction": "auto" if models == PD else "none",
            "Boundary conditions/Displacement layer": repr(4 / n) if nodes == CENTERS else ""}


def errors(run, model, crack):
    """Of K_I, K_II, K_III and sqrt(E' J), the largest of all places over the largest whole intensity."""
    ends = run.model(model)["stress intensity"]
    exact = {name: crack.intensities(values["place"]) for name, values in ends.items()}
    size = max(math.hypot(*values) for values in exact.values())
    young, shear = 1 / (1 - crack.nu**2), 1 / (2 * (1 + crack.nu))
    worst = [0.0] * 4
    for name, values in ends.items():
        K = exact[name]
        for k, mode in enumerate(("I", "II", "III")):
            worst[k] = max(worst[k], abs(values[mode] - K[k]) / size)
        whole = math.sqrt(K[0]**2 + K[1]**2 + K[2]**2 * young / 2 / shear)
        worst[3] = max(worst[3], abs(math.sqrt(max(0, values["J-integral"]) * young) - whole) / size)
    return worst, len(ends)


def compare(run, model, crack, bounds, name, table):
    found, n_places = errors(run, model, crack)
    for what, error, bound in zip(("K_I", "K_II", "K_III", "K from J"), found, bounds):
        table.add_limit(f"{name}: {what}", error, bound)
    return n_places


def same_on(first, second, model):
    for end, values in first.model(model)["stress intensity"].items():
        for name in ("J-integral", "I", "II", "III"):
            check_close(second.model(model)["stress intensity"][end][name], values[name], absolute=1e-7, what=f"{model}: {name} at {end} on 2 processes")


def disc():
    """A penny-shaped crack under tension and shear."""
    crack = Disc(0.2, 0.55, 1, 0.6)
    runs = [run_scene(SCENE, {**crack.entries(), **body(30, CENTERS, 3), "Solver/Tolerance": "1e-10"}, ranks=n) for n in (1, 2)]
    result = Comparison("Disc, peridynamics")
    check(compare(runs[0], PD, crack, DISC_BOUNDS, "cell centers, m = 3", result) == 4, "four places")
    same_on(*runs, PD)
    # A quarter of it, without shear: places on planes of symmetry, with half of a ring. Measured: K_I at most 4.6e-3, J 1.5e-2.
    pulled = Disc(0.2, 0.55, 1, 0)
    held = " ; ".join(side for side in pulled.entries()["Boundary conditions/Displacement"].split(" ; ") if side.split(":")[0] not in ("left", "bottom"))
    for models, cells in ((PD, "15, 15, 30"), (f"{FE}, {COUPLED}", "15, 15, 31")):
        run = run_scene(SCENE, {**pulled.entries(), **body(30, CENTERS if models == PD else VERTICES, 3, models), "Domain/Lower corner": "0, 0, -1", "Domain/Cells": cells,
                                "Boundary conditions/Displacement": held, "Boundary conditions/Symmetry": "left ; bottom"})
        for model in models.split(", "):
            check(compare(run, model, pulled, DISC_BOUNDS, f"{model}, a quarter", result) == 2, f"{model}: two places on planes of symmetry")
    result.show()


def thin(crack, nodes, cells, models, more=None, ranks=1):
    """Plane strain in a thin plate, whose front goes from side to side; a layer of two rows would hold all of its thickness."""
    return run_scene(SCENE, {**crack.entries(slides=True), **body(cells, nodes, 3, models), "Domain/Lower corner": "-1, -1, 0", "Domain/Upper corner": "1, 1, 0.2",
                             "Domain/Cells": f"{cells}, {cells}, 3", "Cracks/Polygons": crack.polygon(0, 0.2), "Boundary conditions/Displacement layer": "",
                             "Solver/Tolerance": "1e-10", **(more or {})}, ranks=ranks)


def through():
    """A crack through a plate in plane strain, as a whole; all models."""
    crack = Through(0.2, 1, 0.5, 0)
    result = Comparison("Crack through a plate")
    for nodes, cells, models in ((CENTERS, 30, PD), (VERTICES, 31, f"{FE}, {COUPLED}")):
        run = thin(crack, nodes, cells, models)
        for model in models.split(", "):
            check(compare(run, model, crack, THROUGH_BOUNDS, f"{model}, {nodes}", result) == 2, "two places")
    result.show()
    on_two = thin(crack, VERTICES, 31, f"{FE}, {COUPLED}", ranks=2)
    for model in (FE, COUPLED):
        same_on(run, on_two, model)


def table():
    """What doc/fracture.md shows: errors in %."""
    def row(name, found):
        print(f"| {name} | " + " | ".join(f"{100 * e:.2f}" for e in found[0]) + f" | ({found[1]} places)", flush=True)

    wanted = sys.argv[2:] or ["30", "40"]
    for n in (int(w) for w in wanted):
        for crack, title, polygon in ((Disc(0.2, 0.55, 1, 0), "disc, tension", None), (Disc(0.2, 0.55, 0, 1), "disc, shear", None),
                                      (Through(0.2, 1, 0.5, 0.7), "through, three modes", "-1,1")):
            def of(models, nodes, m, cells):
                more = body(cells, nodes, m, models)
                if polygon:
                    more["Cracks/Polygons"] = crack.polygon(-1, 1)
                run = run_scene(SCENE, {**crack.entries(), **more})
                for model in models.split(", "):
                    row(f"{title}: {model}, {nodes}, m = {m}, {cells}", errors(run, model, crack))

            of(PD, CENTERS, 3, n)
            of(f"{FE}, {COUPLED}", VERTICES, 3, n + 1)
            of(PD, VERTICES, 3, n + 1)
            if n >= 40:
                of(PD, CENTERS, 4, n)


if __name__ == "__main__":
    {"disc": disc, "through": through, "table": table}[sys.argv[1]]()
    finish()
