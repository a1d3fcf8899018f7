# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Cracks along rows of nodes and tips on edges of cells: symmetric where the scene is, and no jump where a crack moves by 1e-9.

    crack_rows.py heat | elasticity | fracture | mesh | table

`table` computes the jumps that doc/theory.md shows.
"""

import math

from scene_test import COUPLED, FE, PD, Comparison, check, check_close, run_parts, run_scene, scene_text
from scene_texts import PULLED_STRIP, grid_mesh

SHIFT = 1e-9
POINTS = [(0, 0.1), (0, -0.1), (0.3, 0.07), (0.3, -0.07)]
PROBES = " ; ".join(f"{x!r},{y!r}" for x, y in POINTS)
QUIET = {"Output/Fields": "none", "Output/Line": "", "Output/Write at": "", "Time/Tolerance": "1e-9", "Output/Probes": PROBES}


def heat_content(run, model):
    return run.total("heat content", model)


def temperatures(run, model, points=POINTS):
    return [run.probe(model, point) for point in points]


def is_antisymmetric(run, model, what):
    check_close(heat_content(run, model), 0, absolute=1e-9, what=f"{what}, {model}: heat content")
    found = temperatures(run, model)
    check_close(found[0::2], [-T for T in found[1::2]], absolute=1e-8, what=f"{what}, {model}: above and below")


def plate(cells, crack="-0.5,0 ; 0.5,0", models=f"{FE}, {PD}, {COUPLED}", ranks=1, **more):
    return run_scene("prm/quick_start.prm", {**QUIET, "Models": models, "Domain/Cells": cells, "Cracks/Segments": crack, **more}, ranks=ranks)


def heat():
    """A plate that is hot above and cold below; the crack on a row of nodes, beside it, and between rows."""
    models = (FE, PD, COUPLED)
    on, between = plate("20, 20"), plate("20, 21")
    check(any("Crack 1" in note and "20, 21" in note for note in on.summary["notes"]), f"a note names the cells: {on.summary['notes']}")
    beside = [plate("20, 20", f"-0.5,{y} ; 0.5,{y}") for y in (SHIFT, -SHIFT)]
    left = plate("20, 20", **{"Cracks/Nodes on cracks": "left"})
    fine = plate("81, 81", models=COUPLED)
    for model in models:
        check_close(temperatures(plate("20, 20", models=model, ranks=2), model), temperatures(on, model), relative=1e-10, what=f"{model}: two processes")
    for model in models:
        is_antisymmetric(on, model, "crack on a row")
        check_close(temperatures(on, model), temperatures(between, model), relative=1e-12, what=f"{model}: the lattice that is taken")
        for run in beside:
            check_close(temperatures(run, model), temperatures(on, model), relative=1e-6, what=f"{model}: 1e-9 beside a row")
        check(abs(heat_content(left, model)) > 0.5, f"{model}: nodes of the left side alone are not symmetric")
    wanted = temperatures(fine, COUPLED)
    error = {name: max(abs(a - b) for a, b in zip(temperatures(run, COUPLED), wanted)) for name, run in (("on", on), ("left", left))}
    check(error["on"] < 0.75 * error["left"], f"more accurate than nodes of one side: {error}")

    # One end grows along a row, and reaches over the middle.
    growth = {"Cracks/Growth": "2: 0, 2,0", "Time/End time": "0.2"}
    first = plate("20, 20", "-0.5,0 ; -0.4,0", **growth)
    second = plate("20, 20", f"-0.5,{-SHIFT} ; -0.4,{-SHIFT}", **growth)
    for model in models:
        is_antisymmetric(first, model, "growing")
        check_close(temperatures(first, model), temperatures(second, model), relative=1e-6, what=f"{model}: growing, 1e-9 beside a row")

    # Along a diagonal of the cells, and a tip on the edge of a cell.
    diagonal = [plate("20, 20", f"-0.4,{-0.4 + y} ; 0.4,{0.4 + y}") for y in (0, SHIFT, -SHIFT)]
    tips = [plate("20, 21", f"{-0.5 - x},0 ; {0.5 + x},0") for x in (0, SHIFT, -SHIFT)]
    for model in models:
        check_close(heat_content(diagonal[0], model), 0, absolute=1e-9, what=f"{model}, diagonal: heat content")
        for name, runs in (("diagonal", diagonal), ("tips", tips)):
            for run in runs[1:]:
                check_close(temperatures(run, model), temperatures(runs[0], model), relative=1e-6, what=f"{model}, {name}: moved by 1e-9")

    # A lattice that cannot give way says what that means.
    fixed = plate("16, 16", models=COUPLED, **{"Domain/Coarsening": "1", "Domain/Fine where": "1"})
    check(any("left side" in note for note in fixed.summary["notes"]), f"a note where cells are fixed: {fixed.summary['notes']}")

    # Three dimensions.
    block = {"Domain/Cells": "8, 8, 8", "Output/Fields": "none", "Output/Write at": "", "Output/Line": "", "Time/Steady": "true", "Models": f"{FE}, {COUPLED}"}
    square = "0.25,{0},0.25 ; 0.75,{0},0.25 ; 0.75,{0},0.75 ; 0.25,{0},0.75"
    solved = [run_scene("prm/heat/block_with_crack.prm", {**block, "Cracks/Polygons": square.format(y)}) for y in (0.5, 0.5 + SHIFT)]
    for model in (FE, COUPLED):
        first, second = ([row["value"] for row in run.rows(model)] for run in solved)
        check(len(first) > 0, "the block has probes")
        check_close(first, second, relative=1e-6, what=f"{model}: block, moved by 1e-9")
        check(any("8, 9, 8" in note for note in solved[0].summary["notes"]), "a note names the cells of the block")


HELD = {"Material/Young modulus": "1", "Boundary conditions/Traction": "top: 0, 1", "Boundary conditions/Displacement": "bottom: 0, 0", "Output/Fields": "none"}


def edge_crack(cells, end, y=0.0, models=f"{FE}, {COUPLED}"):
    return run_scene(PULLED_STRIP, {**HELD, "Domain/Cells": cells, "Cracks/Segments": f"0,{y!r} ; {end!r},{y!r}", "Cracks/Mesh": "removed", "Models": models})


def intensity(run, model):
    return run.model(model)["stress intensity"]["crack 1 end 2"]["I"]


def handbook(a):
    """Single edge notch in tension, width 1 (Tada, Paris and Irwin 2000): 0.5 % for a up to 0.6."""
    return (1.12 - 0.231 * a + 10.55 * a**2 - 21.72 * a**3 + 30.39 * a**4) * math.sqrt(math.pi * a)


def elasticity():
    """An edge crack whose tip is on the edge of a cell: K_I beside the handbook, and no jump."""
    table = Comparison("K_I over that of the handbook")
    on = edge_crack("40, 121", 0.5)
    rows = [edge_crack("40, 120", 0.5, y) for y in (0.0, SHIFT)]
    for model, limit in ((FE, 0.02), (COUPLED, 0.01)):
        K = intensity(on, model)
        table.add(f"{model}, 40 x 121 cells", K / handbook(0.5), 1, relative=limit)
        for x in (SHIFT, -SHIFT):
            check_close(intensity(edge_crack("40, 121", 0.5 + x, models=model), model), K, relative=1e-6, what=f"{model}: the tip moved by {x}")
        for run in rows:
            check_close(intensity(run, model), K, relative=1e-6, what=f"{model}: along a row of nodes")
    table.show()


def fracture():
    """A plate torn from an edge crack along a row of cell centres stays symmetric."""
    plate = {"Domain/Cells": "40, 17", "Peridynamics/Horizon ratio": "3", "Output/Fields": "none", "Output/Write every": "1e-5", "Time/End time": "2e-5",
             "Output/Probes": "0.0511,0.0061 ; 0.0511,-0.0061 ; 0.02,0.0101 ; 0.02,-0.0101"}
    runs = [run_scene("prm/fracture/branching_crack.prm", {**plate, "Cracks/Segments": f"0,{y!r} ; 0.05,{y!r}"}) for y in (0.0, SHIFT)]
    bonds = [run.model(PD)["energy balance"]["broken bonds"] for run in runs]
    check(bonds[0] > 20 and bonds[0] == bonds[1], f"as many bonds break: {bonds}")
    check(any("row of cell centres" in note and "40, 18" in note for note in runs[0].summary["notes"]), "a note names the cells")
    rows = runs[0].rows(PD, time=2e-5)
    size = max(abs(row["uy"]) for row in rows)
    for above, below in zip(rows[0::2], rows[1::2]):
        check_close([above["ux"], above["uy"]], [below["ux"], -below["uy"]], absolute=1e-6 * size, what="above and below")


def write_mesh(x, y):
    """The file of rectangles between the lines x and y."""
    return grid_mesh((len(x) - 1, len(y) - 1), lambda i, j: (x[i], y[j]))


def mesh():
    """`Fracture energy` on a mesh from a file: the lattice's stretch on equal cells, near it on others; the work of tearing."""
    bar = scene_text("""
Dimension = 2
Physics = elasticity
Models = peridynamics
Material/Young modulus = 1
Material/Poisson ratio = 0.3
Material/Fracture energy = 1e-4
Elasticity/Solver = dynamics
Peridynamics/Horizon = 0.125
Peridynamics/Volume fraction = none
Peridynamics/Kernel exponent = 0
Time/End time = 0.2
Output/Fields = none
""")
    n = 24
    even = [i / n for i in range(n + 1)]
    uneven = [(i + 0.2 * math.sin(2.7 * i) * (0 < i < n)) / n for i in range(n + 1)]
    stretch = {}
    for name, lines in (("even", even), ("uneven", uneven)):
        on_mesh = {"Domain/Shape": "mesh file", "Domain/Mesh file": write_mesh(lines, lines), "Boundary conditions/Displacement": "1: 0, 0"}
        runs = [run_scene(bar, on_mesh, ranks=ranks) for ranks in (1, 2)]
        found = [run.model(PD)["settings"]["critical stretch"] for run in runs]
        check(found[0] == found[1], f"{name}: the same on two processes: {found}")
        stretch[name] = [float(s) for s in found[0].split(" to ")]
    box = run_scene(bar, {"Domain/Cells": f"{n}, {n}", "Boundary conditions/Displacement": "left: 0, 0"})
    wanted = float(box.model(PD)["settings"]["critical stretch"])
    print("critical stretch: lattice", wanted, "meshes", stretch)
    check(stretch["even"][0] <= wanted * (1 + 1e-5) and stretch["even"][-1] >= wanted * (1 - 1e-5), f"equal cells: {stretch['even']} around {wanted}")
    for name in stretch:
        check_close([stretch[name][0], stretch[name][-1]], [wanted, wanted], relative=0.15, what=f"{name} cells: lowest and highest stretch")


# Distances in spacings from a row of nodes, or a tip from the edge of a cell, that `table`
# compares; up to 1e-3 a crack is on the row.
PAIRS = ((0, 1e-9), (0, -1e-9), (0.999e-3, 1.001e-3), (-0.999e-3, -1.001e-3))


def heat_figure(place, along, model, nodes):
    """The difference of temperature across a crack at y = place, or with its right tip at 0.5 + place."""
    y, end = (0.0, 0.5 + place) if along else (place, 0.5)
    odd = (nodes == "vertices") == along  # the crack on a row of nodes, or the tip between rows of them
    cells = f"20, {20 + odd}" if nodes == "vertices" else f"20, {21 - odd}"
    run = plate(cells, f"-0.5,{y!r} ; {end!r},{y!r}", model, **{"Domain/Nodes": nodes})
    above, below = temperatures(run, model, POINTS[:2])
    return above - below


def opening_figure(place, along, model, nodes):
    """K_I of an edge crack, of peridynamics how far its mouth opens."""
    y, end = (0.0, 0.5 + place) if along else (place, 0.5)
    rows = 120 if (nodes == "vertices") != along else 121
    run = run_scene(PULLED_STRIP, {**HELD, "Domain/Cells": f"40, {rows}", "Domain/Nodes": nodes, "Cracks/Segments": f"0,{y!r} ; {end!r},{y!r}", "Models": model,
                           "Output/Probes": "0,0.1 ; 0,-0.1", "Peridynamics/Surface correction": "auto" if model == PD else "none"})
    if model != PD:
        return intensity(run, model)
    above, below = (run.probe(PD, (0, y), column="uy") for y in (0.1, -0.1))
    return above - below


def strength_figure(place, along, model, nodes):
    """The largest force on a plate with a crack in its middle that is pulled until it breaks."""
    y, end = (0.0, 0.2 + place) if along else (place, 0.2)
    rows = 40 if (nodes == "vertices") != along else 41
    run = run_scene("prm/fracture/centre_crack.prm", {
        "Domain/Cells": f"20, {rows}", "Domain/Nodes": nodes, "Cracks/Segments": f"-0.2,{y!r} ; {end!r},{y!r}", "Peridynamics/Horizon ratio": "3",
        "Output/Fields": "none", "Output/Write at": "", "Solver/Tolerance": "1e-10", "Time/Time step": "0.02"})
    return max(row["value"] for row in run.totals if row["quantity"] == "force on top in y")


def table():
    """Relative changes of a figure where a crack moves by next to nothing."""
    h = {heat_figure: 0.1, opening_figure: 0.025, strength_figure: 0.05}
    print("| figure | nodes | model | moved | 0 to 1e-9 | 0 to -1e-9 | 0.999e-3 to 1.001e-3 | -0.999e-3 to -1.001e-3 | 1.001e-3 from 0 |")
    print("|---|---|---|---|---|---|---|---|---|")
    for figure, name in ((heat_figure, "temperature across"), (opening_figure, "K_I, opening of the mouth"), (strength_figure, "strength")):
        for nodes in ("vertices", "cell centers"):
            for model in (FE, PD, COUPLED) if figure != strength_figure else (PD,):
                if model == COUPLED and nodes != "vertices" or model == FE and nodes != "vertices":
                    continue
                for along in (False, True):
                    values = {d: figure(d * h[figure], along, model, nodes) for d in sorted({d for pair in PAIRS for d in pair})}
                    gaps = [values[b] / values[a] - 1 for a, b in PAIRS] + [values[1.001e-3] / values[0] - 1]
                    print(f"| {name} | {nodes} | {model} | {'tip' if along else 'crack'} |" + "".join(f" {gap:.1e} |" for gap in gaps), flush=True)


if __name__ == "__main__":
    run_parts(heat, elasticity, fracture, mesh, table=table)
