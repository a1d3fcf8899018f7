# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Bodies that yield: limit loads, what is left of strains, energy, any number of processes.

    yielding.py ring | plate | motion | ranks | resume

Bounds that follow from no theory are about 1.5 times the gap that was measured; the comment beside them gives it.
"""

import math

from scene_test import PD, Comparison, check, run_parts, run_scene, scene_text
from scene_texts import grid_mesh

QUIET = {"Output/Fields": "none", "Solver/Tolerance": "1e-10"}

RING = scene_text("""
Dimension = 2
Physics = elasticity
Models = peridynamics
Domain/Shape = mesh file
Material/Young modulus = 1000
Material/Poisson ratio = 0.3
Material/Law = plastic
Material/Yield stress = 1
Elasticity/Plane = strain
Elasticity/Solver = newton
Boundary conditions/Symmetry = 1, 2
Boundary conditions/Displacement = 3: x*t, y*t
Peridynamics/Horizon = 0.1
Peridynamics/Kernel exponent = 1
Time/End time = 0.01
Time/Time step = 0.00025
Output/Fields = none
Solver/Tolerance = 1e-10
""")


def ring_mesh(n=20):
    """A quarter of a ring between the radii 1 and 2, n cells across: sides 1 and 2 on the axes, 3 inside, 4 outside."""
    around = round(math.pi / 2 * 1.5 * n)

    def place(i, j):
        r, angle = 1 + i / n, math.pi / 2 * j / around
        return r * math.cos(angle), r * math.sin(angle)

    return grid_mesh((n, around), place, ((1, 1, 0), (2, 1, -1), (3, 0, 0), (4, 0, -1)))


def imbalance(run):
    """Of energy, over what went in."""
    work, gap = (run.total(quantity, PD) for quantity in ("work of loads and supports", "energy imbalance"))
    return abs(gap) / abs(work)


def ring():
    """The limit pressure of a thick ring in plane strain, 2/sqrt(3) ln 2, without hardening."""
    table = Comparison("Thick ring, b/a = 2: limit pressure over the yield stress")
    limit = 2 / math.sqrt(3) * math.log(2)
    mesh = ring_mesh()
    for horizon, bound in (("0.1", 0.06), ("0.15", 0.06)):
        run = run_scene(RING, {"Domain/Mesh file": mesh, "Peridynamics/Horizon": horizon})
        pressure = -run.total("force on 3 in x", PD) if run.total("force on 3 in x", PD) < 0 else run.total("force on 3 in x", PD)
        table.add(f"horizon {horizon}", pressure, limit, relative=bound)
        table.add_limit(f"horizon {horizon}: imbalance of energy", imbalance(run), 1e-8)
    table.show()


if __name__ == "__main__":
    run_parts(ring)
