# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""The scenes of prm/coupling: patch tests, insulated cracks against exact and refined solutions, moving zones.

    coupling.py NAME ...      one or several of the functions below; all without a name

Bounds that follow from no theory are at most 1.5 times the error that was measured; the comment beside them says which.
"""

import math
import pathlib
import re

from scene_test import COUPLED, FE, PD, SOURCE_DIR, check, check_close, check_less, print_table, run_parts, run_scene

QUIET = {"Output/Fields": "none", "Solver/Tolerance": "1e-12"}
ZONES = {"block": "0.3 - max(abs(x - 0.5), abs(y - 0.5))", "half": "0.5 - x", "scattered": "sin(4375.85*x + 1234.5*y + 77*z)",
         "everywhere": "everywhere"}


def run_quietly(name, *more, probes=None):
    """A scene with other entries; probes: points in place of its own (too many for a command line)."""
    chosen = dict(QUIET)
    for some in more:
        chosen.update(some)
    scene = f"prm/coupling/{name}"
    if probes:
        text = pathlib.Path(SOURCE_DIR, scene).read_text(encoding="utf-8")
        scene = re.sub(r"set Probes *=.*", "set Probes = " + " ; ".join(f"{x!r},{y!r}" for x, y in probes), text)
    return run_scene(scene, chosen)


def patches():
    """Linear fields are exact with exchange for any zone; of the other schemes the certificate tells."""
    rows = []
    for name in ("patch_2d.prm", "patch_3d.prm"):
        for zone, formula in ZONES.items():
            for scheme, overlap in (("exchange", 0), ("splice", 0), ("blending", 1)):
                run = run_quietly(name, {"Coupling/Zone": formula, "Coupling/Scheme": scheme, "Coupling/Overlap": str(overlap)})
                model = run.model(COUPLED)
                found = model["certificate"]
                patch, error = found["patch error"], run.error(COUPLED)
                balance = model["heat balance"]
                loss = abs(balance["imbalance"]) / balance["throughput"]
                rows.append((name, zone, scheme, str(model["bonds"]), f"{error:.1e}", f"{patch['linear']:.1e}",
                             f"{patch['quadratic']:.1e}", f"{patch['cubic']:.1e}", f"{found['asymmetry']:.1e}", f"{loss:.1e}"))
                if scheme == "exchange":
                    what = f"{name}, {zone}"
                    check_less(error, 1e-12, f"{what}: error of a linear field")
                    check_less(patch["linear"], 1e-12, f"{what}: linear patch error")
                    check_less(found["asymmetry"], 1e-13, f"{what}: asymmetry")
                    check_less(-found["lowest eigenvalue of a cell"], 1e-13, f"{what}: lowest eigenvalue of a cell")
                    check(found["lowest eigenvalue"] > 0, f"{what}: lowest eigenvalue is positive")
                    check_less(loss, 1e-10, f"{what}: imbalance of heat")
                    check(run.summary["notes"] == [], f"{what}: no note")
                elif zone == "block" and scheme == "blending":
                    check(any("linear field" in note for note in run.summary["notes"]), f"{name}, {scheme}: the note tells of the error")
    print_table("Patch tests", ("scene", "zone", "scheme", "bonds", "error", "linear", "quadratic", "cubic", "asymmetry", "lost heat"), rows)
    layers = run_quietly("two_layers.prm")
    check_less(layers.error(COUPLED), 1e-10, "layers 1:1000")
    check(0 < layers.model(COUPLED)["bonds"] < layers.model(COUPLED)["certificate"]["full peridynamics"]["bonds"], "layers: bonds, but none across")


def smooth():
    """Second order in the spacing for any zone: -lap T = 2 pi^2 sin(pi x) sin(pi y)."""
    rows, counts = [], (20, 40, 80)
    pi = "3.14159265358979323846"
    field = f"sin({pi}*x)*sin({pi}*y)"
    for zone, formula in ZONES.items():
        errors = [run_quietly("patch_2d.prm", {"Domain/Cells": f"{n}, {n}", "Coupling/Zone": formula, "Coupling/Certificate": "false",
                                           "Boundary conditions/Dirichlet": "left: 0; right: 0; bottom: 0; top: 0",
                                           "Initial and source/Source": f"2*{pi}^2*{field}", "Reference/Solution": field}).error(COUPLED)
                  for n in counts]
        order = math.log2(errors[1] / errors[2])
        rows.append((zone, *(f"{e:.2e}" for e in errors), f"{order:.2f}"))
        check(order > 1.8, f"smooth field, zone {zone}: order {order:.2f} in the spacing")
    print_table("A smooth field: relative error", ("zone", *(f"{n} cells" for n in counts), "order"), rows)


def nodes(n):
    ticks = [-1 + 2 * i / n for i in range(n + 1)]
    return [(x, y) for y in ticks for x in ticks]


def nodal_values(run, model, time=None):
    return [row["value"] for row in run.rows(model, time=time)]


def distance(n, found, exact):
    """Relative L2 difference of nodal values, weighted with the nodes' volumes."""
    total = size = 0.0
    for k, (a, b) in enumerate(zip(found, exact)):
        weight = (0.5 if k % (n + 1) in (0, n) else 1) * (0.5 if k // (n + 1) in (0, n) else 1)
        total += weight * (a - b) ** 2
        size += weight * b ** 2
    return math.sqrt(total / size)


def crack():
    """Example 3 at 121 x 121 cells against the steady solution: finite elements with the crack on faces, extrapolated."""
    n = 121
    steady = {"Output/Line": "", "Output/Write at": "", "Time/Steady": "true", "Solver/Tolerance": "1e-10"}
    fine = {c: nodal_values(run_quietly("insulated_crack.prm", steady, {
        "Models": FE, "Domain/Cells": f"{c}, {c}", "Cracks/Mesh": "faces", "Peridynamics/Surface correction": "none"}, probes=nodes(n)), FE)
        for c in (240, 480, 960)}
    first, exact = ([2 * b - a for a, b in zip(fine[c], fine[2 * c])] for c in (240, 480))
    own = distance(n, first, exact)
    print(f"Error of the reference, at most: {own:.1e}")
    check_less(own, 1e-4, "the reference itself")
    rows, values = [], {}

    def case(what, models, limit, **more):
        run = run_quietly("insulated_crack.prm", steady, {"Models": models, **{k.replace("__", "/").replace("_", " "): v for k, v in more.items()}},
                          probes=nodes(n))
        for model in models.split(", "):
            entry = run.model(model)
            values[what] = nodal_values(run, model)
            error = distance(n, values[what], exact)
            rows.append((what, model, f"{error:.2e}", f"{entry['boundary flux']['top']:.2f}", str(entry.get("bonds", "")), str(entry["nonzeros"]),
                         str(entry["iterations"])))
            check_less(error, limit, f"{what}: relative L2 error")
        return run.model(model)

    # Measured: 2.9e-3, 1.3e-3, 1.9e-3, 8.6e-3, 7.5e-3, 7.7e-3.
    case("elements, scaled", FE, 4.3e-3)
    zone = case("c = 1, scaled", COUPLED, 1.9e-3)
    check_close(zone["bonds"], 3664, what="bonds of the zone")
    case("exchange, scaled", PD, 2.9e-3)
    none = {"Peridynamics__Surface_correction": "none"}
    case("elements", FE, 1.3e-2, **none)
    case("c = 1", COUPLED, 1.15e-2, **none)
    case("exchange", PD, 1.15e-2, **none)
    raw = case("raw, m = 6.5", PD, 8.8e-2, Peridynamics__Horizon_ratio="6.5", Peridynamics__Boundary_treatment="none", **none)
    # The error that the published settings make: 5.9 %, with a million bonds.
    check_close(distance(n, values["raw, m = 6.5"], exact), 0.059, absolute=1e-3, what="raw, m = 6.5")
    check_close(raw["bonds"], 1008540, relative=1e-4, what="bonds, raw, m = 6.5")
    for c, limit in (("0.5", 3e-3), ("2", 2e-4)):
        for what, more in (("", none), (", scaled", {})):
            case(f"c = {c}{what}", COUPLED, 1.2e-2, Coupling__Zone=f"cracks: {c}", **more)
            gap = distance(n, values[f"c = {c}{what}"], values["exchange" + what])
            rows.append((f"c = {c}{what}, from full exchange", "", f"{gap:.2e}", "", "", "", ""))
            check_less(gap, limit, f"c = {c}{what}: distance to peridynamics in the whole body")
    print_table("Insulated crack, 121 x 121 cells, steady", ("case", "model", "relative L2", "heat", "bonds", "nonzeros", "iterations"), rows)


def compared():
    """The summary compares the coupled model with both others, over the nodes."""
    n, times = 41, (0.1, 0.5)
    run = run_quietly("insulated_crack.prm", {"Domain/Cells": f"{n}, {n}", "Output/Line": "", "Coupling/Certificate": "false"}, probes=nodes(n))
    found = run.summary["comparisons"]
    check(sorted(found) == ["coupled minus finite elements", "coupled minus peridynamics"], f"comparisons: {sorted(found)}")
    for other in (FE, PD):
        entry = found[f"coupled minus {other}"]
        for k, t in enumerate(times):
            here, there = nodal_values(run, COUPLED, t), nodal_values(run, other, t)
            what = f"coupled minus {other}, t = {t}"
            check(entry["relative l2"][k][0] == t == entry["maximum"][k][0], f"{what}: time {entry['relative l2'][k][0]}")
            check_close(entry["relative l2"][k][1], distance(n, here, there), relative=1e-9, what=f"{what}: relative L2")
            check_close(entry["maximum"][k][1], max(abs(a - b) for a, b in zip(here, there)), relative=1e-9, what=f"{what}: maximum")
    pd, fem = nodal_values(run, PD, 0.5), nodal_values(run, FE, 0.5)
    check_close(run.summary["comparison"]["relative l2"][-1][1], distance(n, pd, fem), relative=1e-9, what="peridynamics minus finite elements")


def oblique_scene(angle, offset, cells):
    """An insulated crack of half length 0.5 in an infinite plate: T = Im sqrt(z^2 - 1/4)."""
    c, s = math.cos(angle), math.sin(angle)
    along = f"({c!r}*(x - {offset[0]!r}) + {s!r}*(y - {offset[1]!r}))"
    across = f"({c!r}*(y - {offset[1]!r}) - {s!r}*(x - {offset[0]!r}))"
    real = f"({along}^2 - {across}^2 - 0.25)"
    exact = f"({across} > -1e-9 ? 1 : -1)*sqrt(max(0, sqrt({real}^2 + 4*{along}^2*{across}^2) - {real})/2)"
    ends = [(offset[0] + sign * 0.5 * c, offset[1] + sign * 0.5 * s) for sign in (-1, 1)]
    return {"Domain/Cells": f"{cells}, {cells}", "Reference/Solution": exact, "Output/Line": "",
            "Boundary conditions/Dirichlet": "; ".join(f"{side}: {exact}" for side in ("left", "right", "bottom", "top")),
            "Cracks/Segments": " ; ".join(f"{x!r},{y!r}" for x, y in ends)}


def oblique():
    """Five angles, three places each."""
    cases = {"cells removed": {"Models": FE, "Cracks/Mesh": "removed"},
             "pairs": {"Models": FE, "Peridynamics/Surface correction": "none"},
             "pairs, scaled": {"Models": FE}, "coupled, scaled": {"Models": COUPLED, "Coupling/Certificate": "false"}}
    # Measured (mean, worst): 2.4e-2 and 3.1e-2, 9.9e-3 and 1.4e-2, 3.8e-3 and 6.6e-3, 3.9e-3 and
    # 6.3e-3; at 121 cells 2.3e-3 and 3.9e-3.
    limits = {"cells removed": (3.5e-2, 4.6e-2), "pairs": (1.5e-2, 2e-2), "pairs, scaled": (5.8e-3, 9.9e-3), "coupled, scaled": (5e-3, 8e-3)}
    rows = []
    for cells in (81, 121):
        for what, settings in cases.items():
            if cells == 121 and what != "coupled, scaled":
                continue
            errors = []
            for degrees in (0, 15, 30, 45, 62):
                for offset in ((0.0, 0.0), (0.006, 0.0037), (0.012, -0.009)):
                    run = run_quietly("oblique_crack.prm", oblique_scene(math.radians(degrees), offset, cells), settings)
                    errors.append(run.error(settings["Models"]))
            mean, worst = sum(errors) / len(errors), max(errors)
            rows.append((str(cells), what, f"{mean:.2e}", f"{worst:.2e}"))
            limit = limits[what] if cells == 81 else (3.4e-3, 4e-3)
            check_less(mean, limit[0], f"{what}, {cells} cells: mean error")
            check_less(worst, limit[1], f"{what}, {cells} cells: worst error")
    print_table("Oblique cracks, 5 angles and 3 places: relative L2 error at the nodes", ("cells", "case", "mean", "worst"), rows)


def growing():
    """A moving zone against peridynamics in the whole body."""
    n, times = 60, (1, 2, 3, 3.5, 4, 5, 6, 7)
    coarse = {"Domain/Cells": f"{n}, {n}", "Coupling/Certificate": "false"}
    full = run_quietly("growing_cracks.prm", coarse, {"Models": PD}, probes=nodes(n))
    rows = []
    for c, limit in (("1", 3e-3), ("2", 3e-4)):
        run = run_quietly("growing_cracks.prm", coarse, {"Coupling/Zone": f"cracks: {c}"}, probes=nodes(n))
        gaps = [distance(n, nodal_values(run, COUPLED, t), nodal_values(full, PD, t)) for t in times]
        rows.append((c, str(run.model(COUPLED)["bonds"]), *(f"{gap:.1e}" for gap in gaps)))
        check_less(max(gaps), limit, f"c = {c}: largest distance to full peridynamics")
        balance = run.model(COUPLED)["heat balance"]
        check_less(abs(balance["imbalance"]), 1e-10 * balance["throughput"], f"c = {c}: imbalance of heat")
        check(run.model(COUPLED)["bonds"] < 0.5 * full.model(PD)["bonds"], f"c = {c}: fewer bonds")
    print_table("Growing cracks: relative L2 distance from full peridynamics", ("c", "bonds", *(f"t = {t}" for t in times)), rows)
    # Scaled cells beside the cracks get stiffer as these cross, on a graded mesh most: explicit steps have to follow.
    stiff = {"Models": FE, "Domain/Cells": "64, 64", "Domain/Coarsening": "2", "Peridynamics/Surface correction": "crack scaling"}
    explicit, implicit = (run_quietly("growing_cracks.prm", stiff, {"Time/Stepper": stepper, "Time/Tolerance": "1e-4"}) for stepper in ("chebyshev", "sdirk2"))
    for mine, theirs in zip(explicit.rows(FE), implicit.rows(FE)):
        check_close(mine["value"], theirs["value"], absolute=0.02, what=f"explicit steps beside cracks that cross, t = {mine['time']}")


def others():
    """The remaining scenes: both models agree as far as they did when this was written, and no heat is lost."""
    # Measured differences of the heat: 1.03e-3, 3.2e-3, 3.4e-4, 7.3e-4, 4.5e-3; along the line
    # 1.1e-3, 3.4e-3, 1.5e-3, 2.0e-3, 0.26 (of 100).
    for name, allowed, apart in (("crack_leaving_body.prm", 1.5e-3, 1.7e-3), ("graded_material_crack.prm", 4.8e-3, 5.1e-3),
                                 ("hole_beside_crack.prm", 5.1e-4, 2.2e-3), ("square_crack_3d.prm", 1.1e-3, 3e-3), ("distorted_mesh.prm", 6.7e-3, 0.4)):
        run = run_quietly(name)
        heats = [next(iter(run.model(m)["boundary flux"].values())) for m in (FE, COUPLED)]
        check_close(heats[1], heats[0], relative=allowed, what=f"{name}: heat of the coupled model")
        lines = [run.along_line(m) for m in (FE, COUPLED)]
        gap = max(abs(a - b) for a, b in zip(*lines))
        check_less(gap, apart, f"{name}: largest difference along the line")
        print(f"{name}: heat {heats[0]:.6g} and {heats[1]:.6g}, largest difference along the line {gap:.2e}")
        balance = run.model(COUPLED)["heat balance"]
        check_less(abs(balance["imbalance"]) / balance["throughput"], 1e-9, f"{name}: imbalance of heat")
        found = run.model(COUPLED)["certificate"]
        check_less(found["patch error"]["linear"], 1e-12, f"{name}: linear patch error")
        kept = found["share of the conductance kept"]
        check(0.5 < kept < 1 if name == "distorted_mesh.prm" else kept == 1, f"{name}: share of the conductance kept {kept}")
        print(f"{name}: share of the conductance kept {kept:.3f}")


def graded():
    """Meshes that are fine only around cracks: hanging nodes, and cells that are refined and merged as cracks grow."""
    rows = []
    for levels in range(4):
        run = run_quietly("graded_mesh.prm", {"Domain/Coarsening": str(levels)})
        model = run.model(COUPLED)
        rows.append((str(levels), str(model["unknowns"]), str(model["nonzeros"]), f"{run.error(FE):.2e}", f"{run.error(COUPLED):.2e}"))
        check_less(model["certificate"]["patch error"]["linear"], 1e-12, f"merged {levels} times: linear patch error")
        check_less(model["certificate"]["asymmetry"], 1e-13, f"merged {levels} times: asymmetry")
        # Measured: 1.82e-3, 1.77e-3, 1.69e-3, 1.62e-3.
        check_less(run.error(COUPLED), 2.7e-3, f"merged {levels} times: error")
    print_table("Graded meshes: unknowns, nonzeros and errors", ("merged", "unknowns", "nonzeros", FE, COUPLED), rows)
    check(10 * int(rows[3][1]) < int(rows[0][1]), "a tenth of the unknowns")

    steady = run_quietly("graded_mesh.prm", {"Coupling/Zone": "adaptive"})
    check_less(steady.error(COUPLED), 2.7e-3, "steady, adapted: error")
    check(any("adapted" in note for note in steady.summary["notes"]), "steady: the note tells of the mesh")

    # On the same cells, although the cracks run along rows of nodes.
    small = {"Domain/Cells": "80, 80", "Domain/Coarsening": "2", "Cracks/Nodes on cracks": "left", "Time/End time": "4", "Output/Write at": "1, 2, 3"}
    adapted = run_quietly("adaptive_zone.prm", small)
    uniform = run_quietly("adaptive_zone.prm", small, {"Domain/Coarsening": "0", "Coupling/Zone": "cracks: 1"})
    gap = max(abs(a["value"] - b["value"]) for a, b in zip(adapted.probes, uniform.probes)) / 200
    print(f"growing cracks, adapted and uniform mesh: largest difference at the probes {gap:.1e} of the range")
    check_less(gap, 1.8e-4, "adapted mesh against the uniform one")  # measured: 1.2e-4
    check_less(adapted.model(COUPLED)["unknowns"], 0.5 * uniform.model(COUPLED)["unknowns"], "adapted: unknowns")
    balance = adapted.model(COUPLED)["heat balance"]
    check_less(abs(balance["imbalance"]), 1e-10 * balance["throughput"], "adapted: imbalance of heat")
    closed = run_quietly("adaptive_zone.prm", small, {"Boundary conditions/Dirichlet": "", "Initial and source/Initial value": "1 + sin(3*y + x)",
                                                  "Material/Density": "1 + x*x"})
    heats = [row["value"] for row in closed.table("totals.csv") if row["quantity"] == "heat content"]
    check(any("adapted" in note for note in closed.summary["notes"]), "insulated body: the mesh was adapted")
    check_less(max(heats) - min(heats), 1e-11 * heats[0], "insulated body: heat conserved through all changes of the mesh")


if __name__ == "__main__":
    run_parts(patches, smooth, crack, compared, oblique, growing, others, graded)
