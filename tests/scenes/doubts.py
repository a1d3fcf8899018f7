# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""What is computed, but told: points outside the body, parts that nothing uses, entries that are rarely meant so, rows that tractions tear off.

    doubts.py gaps | entries | symmetry | torn | loose | ends
"""

import math
import re

from scene_test import BC, FE, PD, check, check_close, run_parts, run_perideal, run_scene, scene_text, write_file
from scene_texts import PULLED_STRIP, body_of_bonds, grid_mesh


PLATE = scene_text("""
Title = Plate with holes
Dimension = 2
Domain/Cells = 20, 20
Domain/Holes = circle: 0.5, 0.5, 0.2 ; rectangle: 0.1, 0.1, 0.2, 0.2
Boundary conditions/Dirichlet = top: 1 ; bottom: 0
Time/Steady = true
Output/Fields = none
Output/Line = 0,0.5 ; 1,0.5 ; 21
""")
ELASTIC = {"Physics": "elasticity", "Material/Young modulus": "200", "Material/Poisson ratio": "0.3", BC + "Dirichlet": "",
           BC + "Displacement": "bottom: 0, 0", BC + "Traction": "top: 0, 1", "Time/Steady": "false"}


def quarter_ring(n=6):
    """A quarter of the ring 1 < r < 2, the planes x = 0 and y = 0 and its skin named."""
    def place(i, j):
        r, angle = 1 + i / n, 0.5 * math.pi * j / (2 * n)
        return r * math.cos(angle), r * math.sin(angle)
    return grid_mesh((n, 2 * n), place, ((2, 1, 0), (1, 1, -1), (3, 0, 0), (3, 0, -1)), names=((1, 1, "plane x"), (1, 2, "plane y"), (1, 3, "skin")))


def said(run, *words):
    """The run has one note with all these words."""
    found = [n for n in run.summary["notes"] if all(w in n for w in words)]
    check(len(found) == 1, f"{len(found)} notes say {words}: {run.summary['notes']}")
    return found[0] if found else ""


def not_said(run, word):
    check(not any(word in n for n in run.summary["notes"]), f"a note says '{word}': {run.summary['notes']}")


def check_command(text, overrides):
    """What `perideal check` says of a scene."""
    status, stdout, stderr = run_perideal(["check", write_file("checked.prm", text)] + [w for e, v in overrides.items() for w in ("-s", f"{e}={v}")])
    return status, stdout + stderr


def gaps():
    """A line through a hole has gaps, exactly where there is no body, whatever the model, the nodes and the number of processes."""
    for physics, more in (("heat", {}), ("elasticity", ELASTIC)):
        column = "value" if physics == "heat" else "uy"
        for nodes in ("vertices", "cell centers"):
            settings = {**more, "Domain/Nodes": nodes}
            runs = [run_scene(PLATE, settings, ranks) for ranks in (1, 2)]
            said(runs[0], "'Line'", "of its 21 points lie outside the body", "line.csv")
            for model in (FE, PD):
                values = [[row[column] for row in run.rows(model, table="line.csv")] for run in runs]
                xs = [row["x"] for row in runs[0].rows(model, table="line.csv")]
                missing = [x for x, v in zip(xs, values[0]) if math.isnan(v)]
                check(len(values[0]) == 21 and missing and 0.25 < min(missing) and max(missing) < 0.75,
                      f"{physics}, {nodes}, {model}: gaps at {missing}")
                check(all(not math.isnan(v) for x, v in zip(xs, values[0]) if abs(x - 0.5) > 0.21), f"{physics}, {nodes}, {model}: {values[0]}")
                check(all(math.isnan(a) == math.isnan(b) and (math.isnan(a) or abs(a - b) < 1e-10) for a, b in zip(*values)),
                      f"{physics}, {nodes}, {model}: other values on 2 processes")
            # The points that are in the body have the values of a line that is in it.
            inside = run_scene(PLATE, {**settings, "Output/Line": "0,0.5 ; 0.25,0.5 ; 6"})
            not_said(inside, "'Line'")
            for a, b in zip(inside.rows(PD, table="line.csv"), runs[0].rows(PD, table="line.csv")):
                check_close(a[column], b[column], absolute=1e-10, what=f"{physics}, {nodes}: value at {a['x']}")
    status, text = check_command(PLATE, {})
    check(status == 0 and "outside the body" in text, f"perideal check does not tell of gaps: {text}")
    for more in ({}, ELASTIC):
        status, text = check_command(PLATE, {**more, "Output/Line": "", "Output/Probes": "0.3,0.3 ; 0.52,0.48"})
        check(status == 1 and "'Probes'" in text and "(0.52, 0.48)" in text and "in a hole" in text, f"a probe in a hole: {text}")
    # Meshes from files: found before anything is computed, by `check`, too.
    mesh = quarter_ring()
    ring = {**ELASTIC, "Domain/Holes": "", "Domain/Shape": "mesh file", "Domain/Mesh file": mesh, "Peridynamics/Horizon": "0.5",
            BC + "Displacement": "plane x: 0, free ; plane y: free, 0", BC + "Traction": "skin: x, y", "Output/Line": "0,0 ; 1.5,1.5 ; 16"}
    run = run_scene(PLATE, ring)
    said(run, "'Line'", "9 of its 16 points lie outside", "(0, 0)", "(1.5, 1.5)")
    status, text = check_command(PLATE, {**ring, "Output/Probes": "0.1,0.1"})
    check(status == 1 and "'Probes'" in text and "(0.1, 0.1)" in text, f"a probe outside a mesh: {text}")
    status, text = check_command(PLATE, {**ring, "Output/Line": "0,0 ; 0.1,0.1 ; 3"})
    check(status == 1 and "'Line'" in text and "none of its points" in text, f"a line outside a mesh: {text}")


def entries():
    """Notes on what is allowed, but rarely meant."""
    parts = {BC + "Parts": "pin: point 1.02, 0.5 ; spare: left if y > 0.5", BC + "Dirichlet": "top: 1 ; bottom: 0 ; pin: 2"}
    for ranks in (1, 2):
        run = run_scene(PLATE, parts, ranks)
        said(run, "'Parts'", "'pin'", "(1.02, 0.5) lies outside the body, 0.02 from", "(1, 0.5)")
        said(run, "'Parts'", "no condition is on 'spare'", "has no effect")
    inside = run_scene(PLATE, {**parts, BC + "Parts": "pin: point 0.99, 0.5"})
    not_said(inside, "Parts")
    motion = {**ELASTIC, "Elasticity/Solver": "dynamics", "Time/End time": "0.01", "Output/Line": ""}
    run = run_scene(PLATE, motion)
    said(run, "'Density'", "is 1, its default", "waves run at about 14.1 m/s")
    not_said(run_scene(PLATE, {**motion, "Material/Density": "1.0"}), "'Density'")
    not_said(run_scene(PLATE, {**ELASTIC, "Output/Line": ""}), "'Density'")
    fast = {**motion, "Material/Density": "2", BC + "Traction": "", BC + "Velocity": "top: free, if(t < 1, 40, 0)"}
    said(run_scene(PLATE, fast), "a velocity of 40 m/s", "waves run at about 10 m/s", "'Velocity'")
    not_said(run_scene(PLATE, {**fast, BC + "Velocity": "top: free, 4"}), "a velocity")
    wet = {"Physics": "moisture", "Time/Steady": "false", "Time/End time": "0.01", "Output/Line": "", BC + "Dirichlet": "top: 1"}
    said(run_scene(PLATE, {**wet, "Initial and source/Initial value": "7"}), "'Initial value'", "wetness of 7", "from 0 to 1")
    not_said(run_scene(PLATE, {**wet, "Initial and source/Initial value": "0.5"}), "wetness")


def symmetry():
    """On a mesh from a file a plane of symmetry is insulated for a computed temperature: as where the same planes are held by displacements."""
    mesh = quarter_ring()
    ring = {**ELASTIC, "Domain/Holes": "", "Domain/Shape": "mesh file", "Domain/Mesh file": mesh, "Peridynamics/Horizon": "0.5",
            "Material/Thermal expansion": "1e-3", "Elasticity/Temperature change": "computed", BC + "Traction": "skin: x, y",
            BC + "Dirichlet": "skin: if(x^2 + y^2 < 2, 1, 0)", "Time/Steady": "true", "Output/Line": "", "Output/Probes": "1.06,1.06 ; 1.5,0"}
    held = run_scene(PLATE, {**ring, BC + "Displacement": "plane x: 0, free ; plane y: free, 0"})
    for ranks in (1, 2):
        mirrored = run_scene(PLATE, {**ring, BC + "Displacement": "", BC + "Symmetry": "plane x, plane y"}, ranks)
        for column in ("ux", "uy", "temperature"):
            check_close(mirrored.probe(FE, (1.06, 1.06), column=column), held.probe(FE, (1.06, 1.06), column=column), relative=1e-9, what=column)
        check_close(mirrored.probe(PD, (1.5, 0), column="temperature"), held.probe(PD, (1.5, 0), column="temperature"), relative=1e-9,
                    what="temperature of peridynamics")
    heat = {"Domain/Holes": "", "Domain/Shape": "mesh file", "Domain/Mesh file": mesh, "Peridynamics/Horizon": "0.5", BC + "Dirichlet": "skin: x",
            BC + "Symmetry": "plane x", "Output/Line": ""}
    status, text = check_command(PLATE, heat)
    check(status == 1 and "'Symmetry'" in text and "Leave the entry out" in text, f"symmetry of heat on a mesh: {text}")
    run_scene(PLATE, {**heat, "Models": FE})


TORN = body_of_bonds("""
Title = A breakable plate, suddenly pulled
Domain/Cells = 16, 17
Material/Critical stretch = 0.01
Boundary conditions/Traction = top: 0, 20 ; bottom: 0, -20
Peridynamics/Surface correction = none
Elasticity/Solver = dynamics
Time/End time = 0.02
Output/Fields = none
""", young=200, density=2)


def torn():
    """Rows that tractions tear off: where the first bond broke, and how many did beside which side, the same on any number of processes."""
    found = []
    for nodes in ("vertices", "cell centers"):
        for ranks in (1, 2, 4):
            run = run_scene(TORN, {"Domain/Nodes": nodes}, ranks)
            of_model = run.model(PD)
            beside, n = of_model["broken beside loads"], run.model(PD)["energy balance"]["broken bonds"]
            note = said(run, "bonds broke beside the loaded sides 'bottom'", "'top'", "before any did elsewhere", "'Traction layer'")
            found.append((of_model["first broken bond"], beside, note))
            check(found[-1] == found[3 * (len(found) // 4) if nodes == "vertices" else 3], f"{nodes}: not the same on {ranks} processes: {found}")
            check(beside["top"] == beside["bottom"] and sum(beside.values()) <= n, f"{nodes}: {beside} of {n}")
            check(abs(found[-1][0][1] - 0.5) > 0.35, f"{nodes}: the first at {found[-1][0]}")
            check("first bond broke at (" in run.stdout and "beside the loaded side" in run.stdout, f"no line tells of it: {run.stdout}")
    # A part of a side, a thin bridge that breaks elsewhere first, and bodies whose loads they bear.
    part = run_scene(TORN, {BC + "Parts": "middle: top if abs(x - 0.5) < 0.2", BC + "Traction": "middle: 0, 40"})
    said(part, "broke beside the loaded side 'middle'")
    tip = run_scene(TORN, {BC + "Parts": "tip: point 0.5, 1", BC + "Traction": "tip: 0, 20"})
    check("Traction layer" not in said(tip, "broke beside the loaded side 'tip'", "larger region"), "a layer is proposed for a point")
    waist = run_scene(TORN, {"Domain/Holes": "rectangle: -1, 0.4, 0.4, 0.6 ; rectangle: 0.6, 0.4, 2, 0.6", BC + "Traction layer": "0.1",
                             BC + "Traction": "top: 0, 0.7*min(t, 1) ; bottom: 0, -0.7*min(t, 1)", "Time/End time": "3", "Time/Time step": "1e-3"})
    check(abs(waist.model(PD)["first broken bond"][1] - 0.5) < 0.2, f"a waist breaks at {waist.model(PD)['first broken bond']}")
    not_said(waist, "beside the loaded")
    whole = run_scene(TORN, {BC + "Traction": "top: 0, 0.2 ; bottom: 0, -0.2"})
    check("first broken bond" not in whole.model(PD), "a body that holds tells of a first break")
    not_said(whole, "beside the loaded")


def loose():
    """Parts that cracks cut off and loads pull: `perideal check` finds them, on lattices that it estimates by coarse ones, too, and nothing where they are held."""
    cut = {**ELASTIC, "Domain/Holes": "", "Output/Line": "", "Time/Steady": "true", BC + "Traction": "right: if(y > 0.6, 1, 0), 0",
           "Cracks/Segments": "-1, 0.52 ; 2, 0.52", "Peridynamics/Horizon": "0.02"}
    for model in (FE, PD):
        for cells in (100, 180):  # 20,000 unknowns, and 65,000, an estimate of whose coarse lattices precedes
            settings = {**cut, "Models": model, "Domain/Cells": f"{cells}, {cells}"}
            status, text = check_command(PLATE, settings)
            check(status == 1 and "Nothing holds a part" in text and "'Displacement'" in text, f"{model}, {cells} cells: {text}")
            status, text = check_command(PLATE, {**settings, BC + "Displacement": "bottom: 0, 0 ; top: 0, 0"})
            check(status == 0 and "time: about" in text, f"held on both sides, {model}, {cells} cells: {text}")


def ends():
    """An edge crack of half the width that ends within a cell: K_I is as much too large as is told, within a factor of two (handbook; 0.5 % good)."""
    a = 0.5
    handbook = math.sqrt(math.pi * a) * (1.12 - 0.231 * a + 10.55 * a**2 - 21.72 * a**3 + 30.39 * a**4)
    for n in (41, 61):
        run = run_scene(PULLED_STRIP, {"Domain/Cells": f"{n}, {3 * n}", "Cracks/Segments": f"0, 0 ; {a}, 0", "Output/Fields": "none",
                                       BC + "Parts": "back: point 1, 0 ; middle: point 0.8, 0", BC + "Displacement": "back: 0, 0 ; middle: free, 0"})
        told = float(re.search(r"stress intensities ([0-9.]+) % or more too large", said(run, "0.5 of a cell", "stress intensities")).group(1))
        check_close(run.model(FE)["stress intensity"]["crack 1 end 2"]["I"] / handbook - 1, 0.015 * told, relative=1 / 3, what=f"K_I less 1, on {n} cells, beside {told} % told")


if __name__ == "__main__":
    run_parts(gaps, entries, symmetry, torn, loose, ends)
