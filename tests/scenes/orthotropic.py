# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Orthotropic bodies in finite elements: moduli of a lamina off its axes, the isotropic body among them, phases, processes, messages.

    orthotropic.py lamina      stiffness and shear coupling by the angle, in plane stress and turned in space
    orthotropic.py bodies      the isotropic law, other solvers, phases, angles that vary
    orthotropic.py hole        a round hole in a wide plate, against Lekhnitskii
    orthotropic.py motion      a bar that swings along itself
"""

import math

import numpy as np

from scene_test import FE, Comparison, check_less, run_parts, run_scene, scene_text

E1, E2, G12, NU12 = 150.0, 10.0, 5.0, 0.3
E3, G13, G23, NU13, NU23 = 8.0, 4.0, 3.0, 0.25, 0.4
PAIRS = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))

# Displacements are those of a uniform stress 1 along x, on all sides.
BODY = """
Dimension = {dimension}
Physics = elasticity
Models = finite elements
Domain/Lower corner = {zeros}
Domain/Upper corner = {ones}
Domain/Cells = {cells}
Elasticity/Solver = linear
Boundary conditions/Displacement = {sides}
Output/Probes = {probe}
Output/Fields = none
Output/Line =
"""


def pulled(strain, overrides):
    """Run a square or a cube with this uniform strain, a matrix."""
    n = len(strain)
    where = ("left", "right", "bottom", "top", "back", "front")[: 2 * n]
    field = ", ".join(" + ".join(f"{value:.17g}*{x}" for value, x in zip(row, "xyz")) for row in strain)
    scene = BODY.format(dimension=n, zeros=", ".join("0" * n), ones=", ".join("1" * n), cells=", ".join("3" * n), probe=", ".join(["0.4"] * n),
                        sides=" ; ".join(f"{side}: {field}" for side in where))
    return run_scene(scene_text(scene), {**overrides, **TIGHT})


def turn(degrees, a, b):
    """Rotation that takes axis a towards axis b."""
    matrix = np.eye(3)
    matrix[a, a] = matrix[b, b] = math.cos(math.radians(degrees))
    matrix[b, a] = math.sin(math.radians(degrees))
    matrix[a, b] = -matrix[b, a]
    return matrix


def compliance():
    """Of the body in its own axes, a tensor of rank 4."""
    tensor = np.zeros((3, 3, 3, 3))
    for a, modulus in enumerate((E1, E2, E3)):
        tensor[a, a, a, a] = 1 / modulus
    for (a, b), modulus, ratio, shear in (((0, 1), E1, NU12, G12), ((0, 2), E1, NU13, G13), ((1, 2), E2, NU23, G23)):
        tensor[a, a, b, b] = tensor[b, b, a, a] = -ratio / modulus
        tensor[a, b, a, b] = tensor[a, b, b, a] = tensor[b, a, a, b] = tensor[b, a, b, a] = 0.25 / shear
    return tensor


def lamina():
    table = Comparison("stress of bodies with the strains that belong to 1 along x, by the angles of their axes")
    plane = {"Elasticity/Plane": "stress", "Material/Young moduli": "150, 10", "Material/Shear moduli": "5", "Material/Poisson ratios": "0.3"}
    for angle in (0, 15, 30, 45, 90):
        c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
        # Jones, Mechanics of Composite Materials, 2.8: S_xx, S_xy, S_xs
        along = c**4 / E1 + s**4 / E2 + (1 / G12 - 2 * NU12 / E1) * c**2 * s**2
        across = (1 / E1 + 1 / E2 - 1 / G12) * c**2 * s**2 - NU12 / E1 * (c**4 + s**4)
        shear = (2 / E1 + 2 * NU12 / E1 - 1 / G12) * s * c**3 - (2 / E2 + 2 * NU12 / E1 - 1 / G12) * s**3 * c
        run = pulled([[along, shear / 2], [shear / 2, across]], {**plane, "Material/Material angle": str(angle)})
        at = run.rows(FE)[0]
        table.add(f"lamina, {angle} degrees, xx", at["sxx"], 1, relative=1e-9)
        for column in ("syy", "sxy", "szz"):
            table.add(f"lamina, {angle} degrees, {column[1:]}", at[column], 0, absolute=1e-9)
        table.add(f"lamina, {angle} degrees, energy", run.total("strain energy", FE), along / 2, relative=1e-9)
    for angles in ((0, 0, 0), (90, 0, 0), (0, 90, 0), (20, 30, 40), (-50, 110, 200)):
        R = turn(angles[0], 0, 1) @ turn(angles[1], 1, 2) @ turn(angles[2], 0, 1)
        strain = np.einsum("ia,jb,kc,ld,abcd->ijkl", R, R, R, R, compliance())[:, :, 0, 0]
        at = pulled(strain, {**WOOD, "Material/Material angle": ", ".join(map(str, angles))}).rows(FE)[0]
        table.add(f"cube, {angles}, xx", at["sxx"], 1, relative=1e-9)
        for column in ("syy", "szz", "sxy", "sxz", "syz"):
            table.add(f"cube, {angles}, {column[1:]}", at[column], 0, absolute=1e-9)
    # Plane strain: what is left of the body turned about z where nothing strains along z
    R = turn(35, 0, 1)
    stiffness = np.linalg.inv(np.array([[np.einsum("ia,jb,kc,ld,abcd->ijkl", R, R, R, R, compliance())[i, j, k, l] * (1 if k == l else 2) for k, l in PAIRS] for i, j in PAIRS]))
    strain = np.array([1e-3, -2e-3, 0, 5e-4, 0, 0])
    stress = stiffness @ strain
    at = pulled([[1e-3, 5e-4], [5e-4, -2e-3]], {**WOOD, "Elasticity/Plane": "strain", "Material/Material angle": "35"}).rows(FE)[0]
    for column, k in (("sxx", 0), ("syy", 1), ("szz", 2), ("sxy", 3)):
        table.add(f"plane strain, 35 degrees, {column[1:]}", at[column], stress[k], relative=1e-9)
    table.show()


# A console that bends, with what an isotropic body makes of it.
CONSOLE = """
Dimension = {dimension}
Physics = elasticity
Models = finite elements
Domain/Lower corner = 0, 0{zero}
Domain/Upper corner = 2, 1{one}
Domain/Cells = 8, 4{two}
Elasticity/Solver = {solver}
Boundary conditions/Displacement = left: 0, 0{zero}
Boundary conditions/Traction = right: 0, -0.01{zero}
Output/Probes = 2, 1{one} ; 1, 0.75{half}
Output/Fields = none
Output/Line =
"""


def console(dimension, solver="linear", overrides=None, ranks=1):
    more = {"zero": ", 0", "one": ", 1", "two": ", 4", "half": ", 0.5"} if dimension == 3 else {"zero": "", "one": "", "two": "", "half": ""}
    return run_scene(scene_text(CONSOLE.format(dimension=dimension, solver=solver, **more)), overrides, ranks=ranks)


ALIKE = {"Material/Young moduli": "10, 10, 10", "Material/Shear moduli": "4, 4, 4", "Material/Poisson ratios": "0.25, 0.25, 0.25"}
SAME = {"Material/Young modulus": "10", "Material/Poisson ratio": "0.25"}
WOOD = {"Material/Young moduli": "150, 10, 8", "Material/Shear moduli": "5, 4, 3", "Material/Poisson ratios": "0.3, 0.25, 0.4"}
TIGHT = {"Solver/Tolerance": "1e-13"}


def compare(table, name, found, expected, columns, bound):
    for k, (a, b) in enumerate(zip(found.rows(FE), expected.rows(FE))):
        for column in columns:
            table.add(f"{name}, place {k + 1}, {column}", a[column], b[column], relative=bound)


def bodies():
    table = Comparison("a console: orthotropic, and the same in another way")
    for name, dimension, plane in (("plane stress", 2, {"Elasticity/Plane": "stress"}), ("plane strain", 2, {"Elasticity/Plane": "strain"}), ("3D", 3, {})):
        turned = {"Material/Material angle": "20, 30, 40" if dimension == 3 else "20"}
        expected = console(dimension, overrides={**SAME, **plane, **TIGHT})
        found = console(dimension, overrides={**ALIKE, **plane, **turned, **TIGHT})
        compare(table, f"{name}, isotropic", found, expected, ("ux", "uy"), 1e-10)
        energy = "strain energy"
        table.add(f"{name}, {energy}", found.total(energy, FE), expected.total(energy, FE), relative=1e-10)
    varying = {**WOOD, "Elasticity/Plane": "strain", "Material/Material angle": "20*x + 10*y", **TIGHT}
    once = console(2, overrides=varying)
    for solver in ("newton", "conjugate gradients"):
        compare(table, solver, console(2, solver, varying), once, ("ux", "uy", "sxx"), 1e-7)
    for ranks in (2, 4):
        compare(table, f"{ranks} processes", console(2, overrides=varying, ranks=ranks), once, ("ux", "uy", "sxx", "von_mises"), 1e-9)
    halves = {"Material/Phases/Regions": "end: rectangle(1, 0, 2, 1)", "Elasticity/Plane": "strain", **TIGHT}
    formula = {**WOOD, "Material/Young moduli": "if(x > 1, 20, 150), 10, 8", "Material/Material angle": "if(x > 1, 50, 10)"}
    phases = {**WOOD, "Material/Material angle": "10", "Material/Phases/Young moduli": "end: 20, 10, 8", "Material/Phases/Material angle": "end: 50"}
    compare(table, "phases", console(2, overrides={**phases, **halves}), console(2, overrides={**formula, "Elasticity/Plane": "strain", **TIGHT}), ("ux", "uy"), 1e-9)
    table.show()


def hole():
    """It becomes an ellipse: half axes grow by k/E along the pull and shrink by 1/sqrt(E1 E2) across (Lekhnitskii, Anisotropic Plates, 1968)."""
    table = Comparison("half axes of a hole of radius 1 in a plate of 100 x 100, pulled by 1 along x")
    for angle, along, across, ratio in ((0, E1, E2, NU12), (90, E2, E1, NU12 * E2 / E1)):
        at = run_scene("prm/elasticity/orthotropic_hole.prm", {"Material/Material angle": str(angle), "Output/Fields": "none"}).rows(FE)
        factor = 1 + math.sqrt(2 * (math.sqrt(along / across) - ratio) + along / G12)
        table.add(f"{angle} degrees, along", at[1]["ux"] - at[0]["ux"], factor / along, relative=2e-3)
        table.add(f"{angle} degrees, across", at[0]["uy"] - at[1]["uy"], -1 / math.sqrt(along * across), relative=5e-3)
        table.add(f"{angle} degrees, sxx above the hole", at[0]["sxx"], factor, relative=0.1)
    table.show()


WAVE = """
Dimension = 2
Physics = elasticity
Models = finite elements
Domain/Lower corner = 0, 0
Domain/Upper corner = 2, 0.25
Domain/Cells = 32, 4
Material/Young moduli = 150, 10
Material/Shear moduli = 5
Material/Poisson ratios = 0
Material/Density = 1.0
Elasticity/Solver = dynamics
Boundary conditions/Symmetry = left, bottom
Initial and source/Initial velocity = 0.01*sin(pi*x/4), 0
Time/End time = {period}
Output/Probes = 2, 0
Output/Fields = none
Output/Line =
"""


def motion():
    """A free end of a bar whose first mode is set going: x = 0 holds, u = v T/(2 pi) sin(2 pi t/T) sin(pi x/4), T = 8 sqrt(rho/E)."""
    table = Comparison("a bar that swings along itself, after an eighth of a period")
    for angle, modulus in ((0, E1), (90, E2)):
        period = 8 / math.sqrt(modulus)
        run = run_scene(scene_text(WAVE.format(period=period / 8)), {"Material/Material angle": str(angle)})
        table.add(f"{angle} degrees", run.rows(FE)[-1]["ux"], 0.01 * period / (2 * math.pi) * math.sin(math.pi / 4), relative=2e-3)
        check_less(abs(run.model(FE)["energy balance"]["drift"]), 1e-3, "drift of energy")
    table.show()


if __name__ == "__main__":
    run_parts(lamina, bodies, hole, motion)
