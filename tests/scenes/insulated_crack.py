# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""An insulated crack in a square plate, hot on top and cold below (Example 3 of Bobaru and Duangpanya 2012).

Reference: finite elements on doubled vertices, 60 to 480 cells, Richardson-extrapolated (independent program); the field has
square-root singularities at the tips, so that everything here converges with order 1. The peridynamic values at 60 to 240 cells are those
of an independent program (tests/reference) with the same rule: nodes on the crack belong to its left side, and bonds through the very tips are cut.

    insulated_crack.py finite_elements | peridynamics | pairs | conducting | fine
"""

import math

from scene_test import check, check_close, check_less, observed_orders, print_table, run_parts, run_scene

PROBES = [(0, 0.1), (0, -0.1), (0.25, 0.05), (0.6, 0), (0.5, 0.2)]
STEADY = [46.7486, -46.7486, 40.1230, 0.0, 32.3429]
HALF_SECOND = [44.0703, -44.0703, 37.8640, 0.0, 30.9434]
FLUX = 186.8789

FEM_STEADY = {60: [46.2413944101, -46.2413944101, 39.5050424648, 0, 31.8779059425],
              120: [46.4929837385, -46.4929837385, 39.8106108909, 0, 32.1070757540],
              240: [46.6202835751, -46.6202835751, 39.9659857496, 0, 32.2241827863]}
FEM_HALF = {60: [43.6613953988, -43.6613953988, 37.3415439915, 0, 30.5401139701],
            120: [43.8653479586, -43.8653479586, 37.5998339803, 0, 30.7394090019],
            240: [43.9676980041, -43.9676980041, 37.7314381434, 0, 30.8408532029]}
PD_STEADY = {60: [46.6640947208, -48.5138502319, 40.7824704637, 1.4437661929, 33.3571041745],
             120: [46.7540570894, -47.7246455922, 40.5288983383, 0.6841961506, 32.9045341209],
             240: [46.7831714268, -47.2832330344, 40.3697199473, 0.3398655490, 32.6563741528]}
PD_HALF = {60: [42.1881456352, -44.5402683218, 36.8703388315, 1.0113669291, 30.7204715532],
           120: [43.2040562835, -44.4149383347, 37.4713155390, 0.4915348012, 30.9167615399],
           240: [43.6735339622, -44.2901692524, 37.7165248736, 0.2489139399, 30.9687973601]}
PD_FLUX = {60: 170.20597691, 120: 178.15891855, 240: 182.37688179}
PD_BONDS = {60: 63036, 120: 255696, 240: 1029816}

SCENE = "prm/quick_start.prm"


def settings(cells, steady, **more):
    """Overrides of the sample scene; keywords: section and entry joined by two underscores."""
    chosen = {"Domain/Cells": f"{cells}, {cells}", "Output/Fields": "none", "Output/Line": "", "Output/Write at": "",
              "Solver/Tolerance": "1e-12", "Time/Tolerance": "1e-9", "Time/Steady": "true" if steady else "false",
              "Peridynamics/Boundary treatment": "none", "Peridynamics/Surface correction": "none", "Cracks/Nodes on cracks": "left"}
    chosen.update({key.replace("__", "/").replace("_", " "): value for key, value in more.items()})
    return chosen


def values(run, model):
    return [run.probe(model, point) for point in PROBES]


def solve(cells, steady, model, **more):
    run = run_scene(SCENE, settings(cells, steady, Models=model, **more))
    return run, values(run, model)


def errors(found, reference):
    return [value - wanted for value, wanted in zip(found, reference)]


COLUMNS = ("cells", "error at (0,0.1)", "(0,-0.1)", "(0.25,0.05)", "(0.6,0)", "(0.5,0.2)", "rms")


def rms(numbers):
    return math.sqrt(sum(x * x for x in numbers) / len(numbers))


def convergence_table(title, cells, found, reference):
    """Print the errors; returns their root mean squares at each refinement and the orders between them."""
    lists = [errors(one, reference) for one in found]
    sizes = [rms(one) for one in lists]
    orders = observed_orders([1.0 / n for n in cells], sizes)
    print_table(title, COLUMNS + ("order",), [(n, *one, size, "" if k == 0 else f"{orders[k - 1]:.2f}")
                                              for k, (n, one, size) in enumerate(zip(cells, lists, sizes))])
    for k in range(1, len(cells)):
        check(sizes[k] < sizes[k - 1], f"{title}: the error grows from {cells[k - 1]} to {cells[k]} cells")
    return sizes, orders


def finite_elements():
    """The crack cut into the mesh: the values of the reference program, and its order 1."""
    for steady, reference, exact in ((True, FEM_STEADY, STEADY), (False, FEM_HALF, HALF_SECOND)):
        name = "steady" if steady else "t = 0.5 s"
        found = []
        for cells in (60, 120, 240):
            run, value = solve(cells, steady, "finite elements", Cracks__Mesh="faces")
            found.append(value)
            check_close(value, reference[cells], relative=3e-9, what=f"finite elements, {name}, {cells} cells, against the same elements"
                                                                     f" in another program")
        sizes, orders = convergence_table(f"Finite elements, crack on faces, {name}, against the extrapolated reference",
                                          (60, 120, 240), found, exact)
        for order in orders:
            check_close(order, 1, absolute=0.1, what="observed order (1 because of the tips)")
        check_less(sizes[-1], 0.13, "error at 240 cells")
        if steady:
            check_close(run.model("finite elements")["boundary flux"]["top"], FLUX, relative=2e-3, what="heat through the top")
    # A crack from side to side: points on it and beside it belong to the right half.
    for ranks in (1, 2):
        run = run_scene(SCENE, {**settings(20, True, Cracks__Mesh="faces", Cracks__Segments="-1,0 ; 1,0"), "Output/Probes": "0.3,0 ; 0.3,-0.001 ; 1,0"},
                        ranks=ranks)
        for model in ("finite elements", "peridynamics"):
            for point, wanted in (((0.3, 0), 100), ((0.3, -0.001), -100), ((1, 0), 100)):
                check_close(run.probe(model, point), wanted, relative=1e-9, what=f"{model}, body cut in two, {ranks} process(es), T{point}")
    # Peridynamics on the same doubled nodes, each with the volume of its side.
    found = [solve(cells, True, "peridynamics", Cracks__Mesh="faces")[1] for cells in (60, 120, 240)]
    _, orders = convergence_table("Peridynamics, m = 3, on doubled nodes, steady", (60, 120, 240), found, STEADY)
    check(min(orders) > 0.5, f"delta-convergence of order {orders}")


def peridynamics(cells=(60, 120, 240)):
    """Default settings, m = 3: the values of another program, and delta-convergence to the classical solution."""
    found = []
    for n in cells:
        run, value = solve(n, True, "peridynamics")
        found.append(value)
        if n in PD_STEADY:
            check_close(value, PD_STEADY[n], relative=1e-9, what=f"peridynamics, steady, {n} cells, against another program")
            check_close(run.model("peridynamics")["boundary flux"]["top"], PD_FLUX[n], relative=1e-9, what="heat through the top")
            check_close(run.model("peridynamics")["bonds"], PD_BONDS[n], what="bonds")
    _, orders = convergence_table("Peridynamics, m = 3, crack through nodes (they belong to the upper side), steady", cells, found,
                                  STEADY)
    check(min(orders) > 0.7, f"delta-convergence of order {orders}")

    shifted = [n + 1 for n in cells]
    found = [solve(n, True, "peridynamics")[1] for n in shifted]
    _, orders = convergence_table("Peridynamics, m = 3, crack between node rows, steady", shifted, found, STEADY)
    for n, value in zip(shifted, found):
        check_close(value[0], -value[1], relative=1e-9, what=f"{n} cells: T(0, 0.1) = -T(0, -0.1)")
    check(min(orders) > 0.5, f"delta-convergence of order {orders}")

    found = []
    for n in cells[:3]:
        _, value = solve(n, False, "peridynamics")
        found.append(value)
        if n in PD_HALF:
            check_close(value, PD_HALF[n], relative=3e-9, what=f"peridynamics, t = 0.5 s, {n} cells, against another program")
    _, orders = convergence_table("Peridynamics, m = 3, crack through nodes, t = 0.5 s", cells[:3], found, HALF_SECOND)
    check(min(orders) > 0.7, f"delta-convergence of order {orders}")


def pairs():
    """Cracks that lie on no faces: pair conductances, with and without crack-side scaling, against removed cells."""
    rows = []
    for cells in (60, 61, 120, 121):
        place = "through nodes" if cells % 2 == 0 else "between rows"
        scaled, mirror = {"Peridynamics__Surface_correction": "crack scaling"}, {"Peridynamics__Boundary_treatment": "fictitious mirror"}
        treatments = {"finite elements": {"pairs": {}, "pairs, scaled": scaled, "removed": {"Cracks__Mesh": "removed"}},
                      "peridynamics": {"pairs": {}, "pairs, scaled": scaled, "mirror": mirror, "mirror, scaled": {**mirror, **scaled}}}
        for model, list_of_treatments in treatments.items():
            for title, more in list_of_treatments.items():
                run, value = solve(cells, True, model, **more)
                gaps = errors(value, STEADY)
                rows.append((cells, place, model, title, *gaps, rms(gaps)))
    print_table("Steady errors with cracks that are not cut into the mesh",
                ("cells", "crack", "model", "treatment", *COLUMNS[1:]), rows)
    size = {(row[0], row[2], row[3]): row[-1] for row in rows}
    model = "finite elements"
    for cells in (60, 61, 120, 121):
        check_less(size[cells, model, "pairs, scaled"], 0.6 * size[cells, model, "pairs"],
                   f"{model}, {cells} cells: error with crack-side scaling against 0.6 of that without")
        # With a tip on an edge of cells pairs ahead of it are cut, and cells ahead of it are not
        # removed.
        best = "pairs" if cells % 2 else "pairs, scaled"
        check_less(size[cells, model, best], size[cells, model, "removed"],
                   f"{model}, {cells} cells: error of {best} against that of removed cells")
        # In peridynamics two errors of opposite sign cancel: families cut off at the hot and the
        # cold side, and bonds missing at the crack. With mirrored layers only the second is left,
        # and scaling makes up for it.
        check_less(size[cells, "peridynamics", "mirror, scaled"], 0.6 * size[cells, "peridynamics", "mirror"],
                   f"peridynamics with mirrored layers, {cells} cells: error with crack-side scaling against 0.6 of that without")
    for treatment in ("pairs", "pairs, scaled", "removed"):
        for cells in (60, 61):
            order = observed_orders([1 / cells, 1 / (cells + 60)], [size[cells, model, treatment], size[cells + 60, model, treatment]])
            check_close(order, [1], absolute=0.2, what=f"{model}, {treatment}, {cells} to {cells + 60} cells: observed order")

    # A crack through nodes acts like one beside them.
    for model in ("finite elements", "peridynamics"):
        for correction in ("none", "crack scaling"):
            for name, on, beside, probes in (
                    ("level", "-0.5,0 ; 0.5,0", "-0.5,-1e-9 ; 0.5,-1e-9", None),
                    ("upright", "0.5,-0.4 ; 0.5,0.4", "0.500000001,-0.4 ; 0.500000001,0.4", None),
                    ("diagonal", "-0.4,-0.4 ; 0.4,0.4", "-0.399999999,-0.400000001 ; 0.400000001,0.399999999", None)):
                more = {"Peridynamics__Surface_correction": correction}
                _, first = solve(60, True, model, Cracks__Segments=on, **more)
                _, second = solve(60, True, model, Cracks__Segments=beside, **more)
                check_close(first, second, relative=1e-6,
                            what=f"{model}, correction {correction}: a {name} crack through nodes, and 1e-9 beside them")


def half_of_plate(conductance, cells):
    """Heat through the top in units of kappa x the difference from the crack to the top: a quarter of the plate by finite elements. By
    symmetry the crack is a Convection with twice its conductance, and the line ahead of it is held."""
    run = run_scene(SCENE, settings(cells, True, Models="finite elements", Domain__Lower_corner="0, 0", Cracks__Segments="", Output__Probes="",
                                    Boundary_conditions__Parts="ahead: bottom if x > 0.5000001; crack: bottom if x < 0.5",
                                    Boundary_conditions__Dirichlet="top: 1; ahead: 0",
                                    Boundary_conditions__Convection=f"crack: {2 * conductance}, 0", Material__Conductivity="1"))
    return 2 * run.model("finite elements")["boundary flux"]["top"]


def conducting():
    """Cracks with a contact conductance H: half across the plate, against finite elements on its symmetric half, and through all of it,
    against resistances in series."""
    conductances, rows, kinds = (0.0, 0.4, 4.0, 40.0, 1e9), [], ("finite elements", "coupled", "peridynamics", "peridynamics, m = 6")
    size = {}
    for conductance in conductances:
        a, b, c = (half_of_plate(conductance, n) for n in (40, 80, 160))
        limit = 2.0 if conductance > 1e6 else c + (c - b) / ((b - a) / (c - b) - 1)  # of its own order, 1 and above
        for kind, segments, exact in (("partly", "-0.5,0 ; 0.5,0", limit), ("all", "-1.5,0 ; 1.5,0", 4 / (2 + 1 / max(conductance, 1e-300)))):
            if exact < 1e-9:
                continue
            for correction in ("none", "crack scaling"):
                for cells in (20, 40, 80):
                    found = []
                    for m in (3, 6):
                        models = kinds[:3] if m == 3 else kinds[2:3]
                        run = run_scene(SCENE, settings(
                            cells, True, Models=", ".join(models), Domain__Cells=f"{cells}, {cells + 1}", Material__Conductivity="1",
                            Boundary_conditions__Dirichlet="top: 1; bottom: -1", Cracks__Segments=segments, Output__Probes="",
                            Cracks__Contact_conductance=conductance, Coupling__Zone="cracks: 1", Peridynamics__Surface_correction=correction,
                            Peridynamics__Horizon_ratio=m, Peridynamics__Boundary_treatment="exchange"))
                        found += [100 * (run.model(model)["boundary flux"]["top"] / exact - 1) for model in models]
                    rows.append((kind, conductance, correction, cells, *found))
                    for name, error in zip(kinds, found):
                        size[kind, conductance, correction, cells, name] = abs(error)
    print_table("Heat through a plate with a crack of contact conductance H (kappa 1, sides 2), error in %",
                ("crack", "H", "correction", "cells", *kinds), rows)
    # Where everything passes nothing is missing, at nodes beside an end either from which nothing crosses.
    flows = []
    for correction in ("none", "crack scaling"):
        run = run_scene(SCENE, settings(20, True, Models="coupled", Domain__Cells="20, 20", Material__Conductivity="1", Boundary_conditions__Dirichlet="top: 1; bottom: -1",
                                        Cracks__Segments="-0.5,0.03 ; 0.5,0.03", Output__Probes="", Cracks__Transmission=1, Peridynamics__Surface_correction=correction,
                                        Coupling__Zone="0.3000001 - sqrt(max(abs(x) - 0.5, 0)^2 + (y - 0.03)^2)"))
        flows.append(run.model("coupled")["boundary flux"]["top"])
    check_close(flows[0], 2.0, relative=1e-9, what="a crack that lets everything through")
    check_close(flows[1], flows[0], relative=1e-9, what="a crack that lets everything through, with crack scaling")
    for (kind, conductance, correction, cells, name), error in size.items():
        what = f"{name}, crack through {kind}, H = {conductance}, {cells} cells, {correction}: error in %"
        if correction == "none":
            continue
        plain = size[kind, conductance, "none", cells, name]
        if conductance > 1e6:  # as without a crack
            check_close(error, plain, absolute=1e-4, what=what)
        elif kind == "all":  # what is scaled is a horizon wide
            check_less(error, 14.5 * (6 if "6" in name else 3) / cells, what)
        else:
            check_less(error, plain + 0.05, what + ", against that without scaling")


if __name__ == "__main__":
    run_parts(finite_elements, peridynamics, pairs, conducting=conducting, fine=lambda: peridynamics((60, 120, 240, 480)))
