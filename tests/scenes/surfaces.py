# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Elastic peridynamics with cut families (`Surface correction = none`) and with those that go on beyond the sides (`auto`), against closed forms.

    surfaces.py part | halves | mesh | table

`table` computes what doc/elasticity.md shows, in some minutes; the others are the tests.
"""

import math

from scene_test import PD, Comparison, check, run_parts, run_scene

SCENE = "prm/elasticity/completed_sides.prm"


def torsion_constants():
    """Torque and largest stress of a square bar, over G theta a^4 and G theta a."""
    odd = range(1, 60, 2)
    return ((1 - 192 / math.pi ** 5 * sum(math.tanh(n * math.pi / 2) / n ** 5 for n in odd)) / 3,
            1 - 8 / math.pi ** 2 * sum(1 / (n * n * math.cosh(n * math.pi / 2)) for n in odd))


class Problem:
    """A scene, a point where it is compared, a component of the displacement and of the stress, and what they are there."""

    def __init__(self, name, more, point, displacement, stress, cells="2D"):
        self.name, self.more, self.point, self.displacement, self.stress, self.cells = name, more, point, displacement, stress, cells

    def gaps(self, m, law, more=None):
        """Relative errors of displacement and stress."""
        if self.cells == "2D":
            numbers, horizon = f"{10 * m}, {10 * m}", "0.1"
        else:
            numbers, horizon = f"{3 * m}, {3 * m}, {3 * m}", str(1 / 3)
        run = run_scene(SCENE, {
            "Domain/Cells": numbers, "Peridynamics/Horizon": horizon, "Peridynamics/Surface correction": law,
            "Output/Probes": ",".join(str(x) for x in self.point), "Output/Fields": "none", **self.more, **(more or {})})
        row = run.rows(PD)[0]
        return [row[column] / value - 1 for column, value in (self.displacement, self.stress)]


BENT = "Boundary conditions/Displacement"
PROBLEMS = [
    Problem("stretched", {}, (1, 0.5), ("ux", 1), ("sxx", 1)),
    Problem("stretched, plane strain", {"Elasticity/Plane": "strain"}, (1, 0.5), ("ux", 0.91), ("sxx", 1)),
    Problem("under its own weight", {"Boundary conditions/Symmetry": "bottom", BENT: "left: -0.15*y^2, free", "Boundary conditions/Traction": "",
                                     "Initial and source/Body force": "1, 0"}, (0.5, 0.5), ("ux", 0.3375), ("sxx", 0.5)),
    Problem("sheared", {"Boundary conditions/Symmetry": "", BENT: "bottom: 0, 0",
                        "Boundary conditions/Traction": "left: 0, -1 ; right: 0, 1 ; top: 1, 0"}, (0.5, 1), ("ux", 2.6), ("sxy", 1)),
    Problem("bent", {"Boundary conditions/Symmetry": "left", "Boundary conditions/Traction": "",
                     BENT: "bottom: 0, free ; right: x*y, -(x^2 + 0.3*y^2)/2"}, (0.5, 1), ("uy", -0.275), ("sxx", 1)),
    Problem("stretched in 3D", {"Dimension": "3", "Domain/Lower corner": "0, 0, 0", "Domain/Upper corner": "1, 1, 1",
                                "Boundary conditions/Symmetry": "left, bottom, back", "Boundary conditions/Traction": "right: 1, 0, 0"},
            (1, 0.5, 0.5), ("ux", 1), ("sxx", 1), "3D"),
]


def twisted(cells, horizon, law):
    """Saint-Venant's square bar, edge 1, G = 80, twist 0.01: relative errors of torque and largest stress."""
    torque, shear = (0.8 * c for c in torsion_constants())
    run = run_scene("prm/elasticity/torsion.prm", {
        "Models": PD, "Domain/Cells": f"{cells}, {cells}, {cells}", "Peridynamics/Horizon": horizon, "Peridynamics/Horizon ratio": "3",
        "Peridynamics/Surface correction": law, "Output/Fields": "none"})
    return [8 * run.model(PD)["strain energy"] / 0.005 / torque - 1, run.probe(PD, (0.5, 0, 0.25), column="syz") / shear - 1]


def hole(cells, law):
    """Of a plate with a hole, horizon 0.375 radii: the end's displacement against finite elements, the stress 0.56 radii above the hole against Kirsch."""
    run = run_scene("prm/elasticity/hole_in_tension.prm", {
        "Domain/Cells": f"{cells}, {cells}", "Peridynamics/Horizon": "0.375", "Peridynamics/Horizon ratio": "3",
        "Peridynamics/Surface correction": law, "Output/Fields": "none", "Output/Line": "", "Output/Probes": "10,0 ; 0.0625,1.5625"})
    r2 = 0.0625 ** 2 + 1.5625 ** 2
    return [run.rows(PD)[0]["ux"] / run.rows("finite elements")[0]["ux"] - 1, run.rows(PD)[1]["sxx"] / (1 + 0.5 / r2 + 1.5 / r2 ** 2) - 1]


def print_row(name, none, auto):
    print(f"| {name} |" + "".join(f" {100 * value:+.2f} |" for pair in zip(none, auto) for value in pair), flush=True)


def part():
    """A square within 2 % for each m, and what it is without completed families."""
    table = Comparison("A square in tension, horizon 0.1")
    stretched = PROBLEMS[0]
    # The probe of a side between cell centres has the value half a cell inside.
    for nodes in ("vertices", "cell centers"):
        for m in (3, 6):
            displacement, stress = stretched.gaps(m, "auto", {"Domain/Nodes": nodes})
            inside = 1 - (0.05 / m if nodes == "cell centers" else 0)
            table.add(f"{nodes}, m = {m}: displacement of the right side", 1 + displacement, inside, relative=3e-5)
            table.add(f"{nodes}, m = {m}: stress there", 1 + stress, 1, absolute=1e-4)
    cut = stretched.gaps(6, "none")
    check(cut[0] > 0.1 and cut[1] > 1, f"cut families are off by 19 % and 220 %: {cut}")
    run = run_scene(SCENE, {"Output/Fields": "none"})
    setting = run.model(PD)["settings"]["surface correction"]
    check("fictitious nodes beyond" in setting and "left" in setting, f"the report names what is done: {setting}")
    check(run.summary["notes"] == [], f"no note where families go on: {run.summary['notes']}")
    # Planes of symmetry hold finite elements, whatever beside them the cell centres of peridynamics
    # do.
    both = run_scene(SCENE, {"Output/Fields": "none", "Models": "finite elements, peridynamics", "Domain/Nodes": "cell centers"})
    table.add("finite elements beside cell centers: displacement of the right side", both.rows("finite elements")[0]["ux"], 1, relative=1e-9)
    for more, words in (({"Peridynamics/Surface correction": "none"}, ("'Surface correction = none'", "on 'right'", "With 'auto'", "'Traction layer'")),
                        ({"Peridynamics/Nodal volume": "full"}, ("'Nodal volume = full'", "on 'right'", "'Nodal volume = partial'"))):
        found = run_scene(SCENE, {"Output/Fields": "none", **more}).summary["notes"]
        check(any(all(word in note for word in words) for note in found), f"a note on {more}: {found}")
    layer = run_scene(SCENE, {"Output/Fields": "none", "Peridynamics/Surface correction": "none", "Boundary conditions/Traction layer": "0.1"})
    check(layer.summary["notes"] == [], f"no note on a row where a layer bears the traction: {layer.summary['notes']}")
    table.show()


def halves():
    """Half a body with a crack that crosses its plane of symmetry breaks as the whole one, in motion."""
    table = Comparison("A cracked plate pulled apart: half of it, and the whole one")
    moving = {
        "Boundary conditions/Traction": "left: -0.006, 0 ; right: 0.006, 0", "Elasticity/Solver": "dynamics", "Time/End time": "2",
        "Material/Density": "1", "Material/Fracture energy": "1e-5", "Peridynamics/Horizon": "0.075", "Domain/Upper corner": "1, 0.5",
        "Output/Fields": "none", "Output/Probes": "1, 0.5"}
    for nodes in ("vertices", "cell centers"):
        half, whole = (run_scene(SCENE, {**moving, "Domain/Nodes": nodes, **more}, ranks=ranks) for more, ranks in (
            ({"Domain/Cells": "40, 20", "Boundary conditions/Symmetry": "bottom", "Cracks/Segments": "0.4876,0 ; 0.4876,0.15"}, 2),
            ({"Domain/Cells": "40, 40", "Domain/Lower corner": "0, -0.5", "Boundary conditions/Symmetry": "",
              "Cracks/Segments": "0.4876,-0.15 ; 0.4876,0.15"}, 1)))
        a, b = (run.model(PD)["energy balance"] for run in (half, whole))
        check(b["broken bonds"] > 1000, f"{nodes}: bonds break: {b['broken bonds']}")
        for what in ("kinetic", "strain", "work", "dissipated"):
            table.add(f"{nodes}: {what} energy of the half", a[what], 0.5 * b[what], relative=1e-8)
    table.show()


def mesh():
    """A thick ring under pressure on an irregular mesh from a file, against Lame: a curved side with a load."""
    table = Comparison("A ring under pressure, a = 0.5, b = 1")
    opening, hoop = (0.7 * 0.5 + 1.3 / 0.5) / 3, 5 / 3
    gaps = {}
    for law in ("none", "auto"):
        run = run_scene("prm/elasticity/thick_ring.prm", {"Models": PD, "Peridynamics/Surface correction": law, "Output/Fields": "none", "Output/Line": ""})
        right, top = run.rows(PD)[:2]
        gaps[law] = [max(abs(value / exact - 1) for value in values) for values, exact in (
            ((right["ux"], top["uy"]), opening), ((right["syy"], top["sxx"]), hoop))]
    check("in part at free sides of thin parts" in run.model(PD)["settings"]["surface correction"], "the report names what is done")
    table.add("auto: the bore opens by 1.6 % less", gaps["auto"][0], 0, absolute=0.018)
    table.add("auto: stress along its rim", gaps["auto"][1], 0, absolute=0.07)
    check(gaps["none"][0] > 0.08 and gaps["none"][1] > 0.6, f"cut families are off by 9 % and 67 %: {gaps['none']}")
    table.show()


def table():
    print("| problem | m | displacement, `none` | `auto` | stress, `none` | `auto` |")
    print("|---|---|---|---|---|---|")
    for problem in PROBLEMS:
        for m in (3, 6, 12) if problem.cells == "2D" else (2, 3, 4):
            print_row(f"{problem.name} | {m}", *(problem.gaps(m, law) for law in ("none", "auto")))
    for m in (2, 3, 4):
        print_row(f"twisted: torque | {m}", *(twisted(4 * m, "0.125", law) for law in ("none", "auto")))
    for m in (3, 6):
        print_row(f"with a hole | {m}", *(hole(160 * m // 3, law) for law in ("none", "auto")))
    print("\n| horizon, m = 6 | under its own weight: displacement | stress | bent: displacement | stress |\n|---|---|---|---|---|")
    for n in (30, 60, 120):
        more = {"Domain/Cells": f"{n}, {n}", "Peridynamics/Horizon": str(6 / n)}
        found = [gap for k in (2, 4) for gap in PROBLEMS[k].gaps(6, "auto", more)]
        print(f"| {6 / n} |" + "".join(f" {100 * gap:+.2f} |" for gap in found), flush=True)


if __name__ == "__main__":
    run_parts(part, halves, mesh, table=table)
