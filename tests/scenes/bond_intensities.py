# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""J and stress intensities of peridynamics alone, and of all models with heat and weight.

    bond_intensities.py plates | heat | table
"""

import math

from cracked_plate import HeatedPlate, Plate
from scene_test import COUPLED, FE, PD, Comparison, check, check_close, run_parts, run_scene
from scene_texts import PULLED_STRIP

SCENE = "prm/elasticity/coupled_crack.prm"
BARE = {"Output/Fields": "none", "Output/Probes": "", "Reference/Solution": "", "Peridynamics/Kernel exponent": "auto"}
CENTERS, VERTICES = "cell centers", "vertices"


def body(n, nodes, m, models=PD):
    return {**BARE, "Models": models, "Domain/Cells": f"{n}, {n}", "Domain/Nodes": nodes, "Peridynamics/Horizon ratio": str(m),
            "Peridynamics/Surface correction": "auto" if models == PD else "none"}


def errors(run, model, exact, young):
    """Of K_I, K_II and sqrt(E' J) over the whole intensity, the largest of both ends."""
    size = math.hypot(*exact)
    ends = run.model(model)["stress intensity"].values()
    return [max((abs(abs(end[mode]) - value) / size for end in ends)) for mode, value in zip(("I", "II"), exact)] + \
           [max(abs(math.sqrt(max(0, end["J-integral"]) * young) / size - 1) for end in ends)]


def oblique(angle, nu, n, nodes, m, more=None, models=PD):
    plate = Plate(nu, angle)
    run = run_scene(SCENE, {**body(n, nodes, m, models), **plate.entries(), **(more or {})})
    return {model: errors(run, model, plate.intensities, plate.young) for model in models.split(", ")}


def heated(nu, n, nodes, m, more=None, models=PD, plane="stress"):
    plate = HeatedPlate(nu, plane)
    run = run_scene(SCENE, {**body(n, nodes, m, models), **plate.entries(), **(more or {})})
    return {model: errors(run, model, (0, plate.intensity), plate.young) for model in models.split(", ")}


BONDS = {"Elasticity/Model": "bond-based"}


def plates():
    """An inclined crack in a plate under tension; a crack in a hanging strip under its own weight."""
    table = Comparison("Crack at 30 degrees, peridynamics")
    for name, found in (("state-based, cell centers, m = 3", oblique(30, 0.2, 60, CENTERS, 3)),
                        ("state-based, vertices, m = 4", oblique(30, 0.2, 61, VERTICES, 4)),
                        ("bond-based, cell centers, m = 3", oblique(30, 1 / 3, 60, CENTERS, 3, BONDS))):
        for what, error in zip(("K_I", "K_II", "K from J"), found[PD]):
            table.add_limit(f"{name}: {what}", error, 0.015)
    table.show()
    # Quadratic elements whose edges the crack is on.
    weight = {"Boundary conditions/Traction": "", "Boundary conditions/Displacement": "top: 0, 0", "Initial and source/Body force": "0.2*x, -1",
              "Cracks/Segments": "0.2,0 ; 0.8,0", "Output/Fields": "none"}
    hung = run_scene(PULLED_STRIP, {**weight, "Models": FE, "Domain/Cells": "80, 240", "Cracks/Mesh": "faces", "Finite elements/Degree": "2"})
    bonds = run_scene(PULLED_STRIP, {**weight, "Models": PD, "Domain/Cells": "40, 120", "Domain/Nodes": CENTERS, "Peridynamics/Horizon ratio": "3",
                                     "Peridynamics/Surface correction": "auto"})
    for end, exact in hung.model(FE)["stress intensity"].items():
        check_close(bonds.model(PD)["stress intensity"][end]["I"], exact["I"], relative=0.04, what=f"weight, K_I at {end}")
        check_close(bonds.model(PD)["stress intensity"][end]["J-integral"], exact["J-integral"], relative=0.06, what=f"weight, J at {end}")
    check(not hung.summary.get("no stress intensity") and not bonds.summary.get("no stress intensity"), "nothing is missing")


def heat():
    """An insulated crack in a plate that heat flows through."""
    table = Comparison("Insulated crack in a flow of heat")
    rows = [(f"{model}", found) for model, found in heated(0.3, 61, VERTICES, 3, models=f"{FE}, {COUPLED}, {PD}").items()]
    rows.append(("finite elements on faces", heated(0.3, 60, VERTICES, 3, {"Cracks/Mesh": "faces"}, FE)[FE]))
    rows.append(("peridynamics, plane strain", heated(0.3, 60, CENTERS, 3, plane="strain")[PD]))
    for name, found in rows:
        # Measured: 3.1 and 5.8 % where cells are removed, at whose place heat strains the body, too;
        # else up to 2.8 and 0.5 %.
        removed = name == FE
        table.add_limit(f"{name}: K_I", found[0], 1e-6)
        table.add_limit(f"{name}: K_II", found[1], 0.04 if removed else 0.035)
        table.add_limit(f"{name}: K from J", found[2], 0.07 if removed else 0.01)
    table.show()


def table():
    """What doc/fracture.md shows: errors in %."""
    def row(name, found):
        print(f"| {name} | " + " | ".join(f"{100 * e:.2f}" for e in found) + " |", flush=True)

    print("| crack at 30 degrees | K_I | K_II | K from J |\n|---|---|---|---|")
    for n in (40, 80):
        for m in (3, 4, 6):
            row(f"state-based, nu = 0.2, centers, m = {m}, {n}", oblique(30, 0.2, n, CENTERS, m)[PD])
            row(f"state-based, nu = 0.2, vertices, m = {m}, {n + 1}", oblique(30, 0.2, n + 1, VERTICES, m)[PD])
            row(f"bond-based, nu = 1/3, centers, m = {m}, {n}", oblique(30, 1 / 3, n, CENTERS, m, BONDS)[PD])
        for model, found in oblique(30, 0.2, n + 1, VERTICES, 3, models=f"{FE}, {COUPLED}").items():
            row(f"{model}, nu = 0.2, m = 3, {n + 1}", found)
    print("| insulated crack | K_I | K_II | K from J |\n|---|---|---|---|")
    for n in (40, 80):
        for m in (3, 4):
            row(f"centers, m = {m}, {n}", heated(0.3, n, CENTERS, m)[PD])
        for model, found in heated(0.3, n + 1, VERTICES, 3, models=f"{FE}, {COUPLED}, {PD}").items():
            row(f"{model}, m = 3, {n + 1}", found)
        row(f"finite elements on faces, {n}", heated(0.3, n, VERTICES, 3, {"Cracks/Mesh": "faces"}, FE)[FE])


if __name__ == "__main__":
    run_parts(plates, heat, table=table)
