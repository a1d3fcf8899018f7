# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""What elastic runs say of themselves, and the report that is made of it.

    elastic_report.py bar | plate | body | fracture      a run, its summary, and the numbers in the tables of its report
"""

import math
import os
import re
import subprocess
import sys

import h5py
import numpy as np

from scene_test import FE, PD, SOURCE_DIR, check, check_close, run_parts, run_scene, scene_text


BAR = scene_text("""
Title = Bar
Dimension = 1
Physics = elasticity
Models = finite elements, peridynamics
Domain/Upper corner = 10
Domain/Cells = 40
Material/Young modulus = 200
Material/Poisson ratio = 0.3
Boundary conditions/Displacement = left: 0
Boundary conditions/Traction = right: 1
Output/Probes = 5 ; 10
Output/Line = 0 ; 10 ; 21
""")

PLATE = "# A cracked plate of two materials.\n" + scene_text("""
Title = Plate
Dimension = 2
Physics = elasticity
Models = finite elements, peridynamics
Domain/Lower corner = -1, -1
Domain/Upper corner = 1, 1
Domain/Cells = 24, 24
Material/Bulk modulus = 1e5
Material/Poisson ratio = 0.4
Material/Phases/Regions = stiff: y > 0.5
Material/Phases/Bulk modulus = stiff: 2e5
Cracks/Segments = -0.5, 0 ; 0.5, 0
Cracks/Mesh = faces
Boundary conditions/Displacement = bottom: 0, 0
Boundary conditions/Traction = top: 0.5*x, 1
Output/Probes = 0, 1 ; 0.52, 0.3
Output/Line = 0.1, -1 ; 0.1, 1 ; 41
""")

BODY = scene_text("""
Title = Body
Dimension = 3
Physics = elasticity
Models = finite elements, peridynamics
Domain/Upper corner = 2, 1, 1
Domain/Cells = 12, 6, 6
Material/Young modulus = 1000
Material/Poisson ratio = 0.3
Boundary conditions/Displacement = left: 0, 0, 0
Boundary conditions/Traction = right: 0, -1, 0
Peridynamics/Horizon ratio = 2
Output/Probes = 2, 0.5, 0.5 ; 1, 1, 0.5
Output/Line = 0, 1, 0.5 ; 2, 1, 0.5 ; 21
""")


def written(value, digits=6):
    """A number as the report writes it."""
    sys.path.insert(0, os.path.join(SOURCE_DIR, "applications", "report"))
    import style
    return style.plain(value, digits)


def report_of(run):
    """(rows of all tables, text) of the report."""
    script = os.path.join(SOURCE_DIR, "applications", "report", "report.py")
    done = subprocess.run([sys.executable, script, run.folder], capture_output=True, text=True, check=False)
    check(done.returncode == 0, f"the report is drawn {done.stderr}")
    with open(os.path.join(run.folder, "report.html"), encoding="utf-8") as file:
        html = file.read()
    rows = [[re.sub("<[^>]*>", "", part) for part in re.findall("<t[hd][^>]*>(.*?)</t[hd]>", row)]
            for row in re.findall("<tr[^>]*>(.*?)</tr>", html, re.DOTALL)]
    return rows, re.sub("<[^>]*>", "", re.sub(r"base64,[^\"]*", "", html)), html.count("<img ")


def check_tables(run, rows):
    """Numbers of tables are those of probes.csv, totals.csv and summary.json."""
    columns = [c for c in run.probes[0] if c not in ("time", "model", "x", "y", "z")]
    of_model = {m: run.rows(m) for m in (FE, PD)}
    expected = [[written(of_model[m][k][c]) for m in (FE, PD)] for k in range(len(of_model[FE])) for c in columns]
    names = [c.replace("von_mises", "von Mises") for c in columns]
    found = [row[1:3] for row in rows if len(row) == 4 and row[0].split(" (")[0] in names]
    check(found == expected, "the table of probes has the numbers of probes.csv")
    totals = {(r["model"], r["quantity"]): r["value"] for r in run.totals}
    for quantity in ("strain energy", "mean stress xx"):
        row = next((r for r in rows if r[0].split(" (")[0] == quantity.capitalize()), None)
        unit = {"strain energy": {1: "J/m²", 2: "J/m", 3: "J"}[run.summary["dimension"]]}.get(quantity, "Pa")
        check(row is not None and row[0].endswith(f" ({unit})"), f"the unit of {quantity} is {unit}")
        check(row is not None and row[1:] == [written(totals[m, quantity]) for m in (FE, PD)], f"{quantity} is that of totals.csv")
    for side, force in run.model(PD)["boundary force"].items():
        for d, value in enumerate(force):
            row = next(r for r in rows if r[0] == f"{side}, in {'xyz'[d]}")
            check(row[2:] == [written(run.model(FE)["boundary force"][side][d]), written(value)], f"force on {side} in {'xyz'[d]}")


def check_comparison(run, dimension):
    """The comparison in the summary against that of the fields, whose nodes share the cells around them."""
    u = {}
    for model in (FE, PD):
        with h5py.File(os.path.join(run.folder, run.summary["fields"][-1]["files"][model])) as file:
            u[model] = file["displacement"][:, :dimension]
    # Field files have single precision, 6e-8 of the displacement. On a lattice each vertex of a
    # cell has an equal share of its volume.
    gap = np.linalg.norm(u[PD] - u[FE], axis=1)
    relative = math.sqrt((gap ** 2).sum() / (u[FE] ** 2).sum())
    found = run.summary["comparison"]
    check_close(found["relative l2"][-1][1], relative, relative=1e-6, what="relative L2 difference of the displacements")
    check_close(found["maximum"][-1][1], gap.max(), absolute=1.2e-7 * np.abs(u[PD]).max(), what="largest difference of the displacements")


def bar():
    run = run_scene(BAR)
    rows, text, n_images = report_of(run)
    check(n_images == 4, f"sketch, displacement, stress and line are drawn: {n_images}")
    check_tables(run, rows)
    check_comparison(run, 1)
    check(run.summary["sides"] == {"left": "displacement 0", "right": "traction 1"}, f"sides are {run.summary['sides']}")
    check(run.summary["values on sides"]["right"] == {"traction": {"at": [[10.0]], "values": [[1.0]]}}, "the traction at the end")
    check("The largest magnitude" in text and "1D, static" in text, "a bar at rest")
    check_close(run.probe(FE, (10,), column="ux"), 10 / 200, relative=1e-12, what="elongation")


def plate():
    runs = [run_scene(PLATE, ranks=ranks) for ranks in (1, 2)]
    for kind in ("relative l2", "maximum"):
        one, two = (run.summary["comparison"][kind][-1][1] for run in runs)
        check_close(two, one, relative=1e-11, what=f"{kind} on two processes")
    run = runs[1]
    rows, text, n_images = report_of(run)
    check(n_images == 11, f"sketch, 3 displacements, 5 stresses, the damage and the line are drawn: {n_images}")
    check_tables(run, rows)
    check_comparison(run, 2)
    sides = run.summary["sides"]
    check(sides == {"left": "free", "right": "free", "bottom": "displacement 0, 0", "top": "traction 0.5*x, 1"}, f"sides are {sides}")
    load = run.summary["values on sides"]["top"]["traction"]
    check(np.allclose(load["values"], [[0.5 * x, 1] for x, _ in load["at"]], atol=1e-15) and len(load["at"]) == 7
          and all(y == 1 for _, y in load["at"]), f"tractions along the top: {load}")
    with h5py.File(os.path.join(run.folder, run.summary["fields"][-1]["files"][PD])) as file:
        largest = np.linalg.norm(file["displacement"][:], axis=1).max()
        stress = file["von_mises"][:].max()
    row = next(r for r in rows if r[0].startswith("Largest magnitude of the displacement"))
    check(row[2].startswith(written(float(largest)) + " at "), f"the largest displacement is {largest}: {row}")
    row = next(r for r in rows if r[0] == "Largest von Mises stress (Pa)")
    check(row[2].startswith(written(float(stress)) + " at "), f"the largest von Mises stress is {stress}: {row}")
    factor = float(re.search("displacements magnified (.*?) times", text)[1].replace("\u202f", ""))
    check(0.03 < factor * largest / 2 < 0.08, f"displacements are drawn {factor} times as large, as {factor * largest / 2} of the body")
    check(["Young modulus (Pa)", written(6e4), written(1.2e5)] in rows, "the Young moduli that follow from bulk modulus and Poisson ratio")


def body():
    run = run_scene(BODY)
    rows, text, n_images = report_of(run)
    check(n_images == 12, f"sketch, 4 displacements, 6 stresses and the line are drawn: {n_images}")
    check_tables(run, rows)
    check_comparison(run, 3)
    check("3D, static" in text and "traction 0, −1, 0" in text, "a body at rest")
    check(len(run.summary["values on sides"]["left"]["displacement"]["at"]) == 9, "nine points of a side")


COARSE = {"Domain/Cells": "20, 40", "Peridynamics/Horizon ratio": "3", "Output/Fields": "hdf5"}


def over_time(run, model, quantity):
    """[(time, value)] of a quantity of totals.csv."""
    return [(r["time"], r["value"]) for r in run.totals if r["model"] == model and r["quantity"] == quantity]


def bonds_sentence(run, when):
    """What the report has to say of the bonds of a run in which some broke."""
    broken, lost = over_time(run, PD, "broken bonds"), over_time(run, PD, "energy dissipated")
    first, last = run.model(PD)["first broken bonds"], int(broken[-1][1])
    total = last + run.model(PD)["bonds"]
    return f"The first bonds broke {when} t = {written(first, 4)} s; in the end {written(last)} bonds of {written(total)} " \
        f"({written(100 * last / total, 3)} %) were broken, and an energy of {written(lost[-1][1], 4)} J/m was dissipated."


def loaded_until_it_breaks():
    """A plate slowly pulled apart: what breaks, when, at which force."""
    run = run_scene("prm/fracture/centre_crack.prm",
                    {**COARSE, "Models": "finite elements, peridynamics", "Time/Time step": "0.1", "Output/Write at": "0.6",
                     "Boundary conditions/Displacement": "top: 0, 0.012*t; bottom: 0, -0.012*t"})
    rows, text, n_images = report_of(run)
    check(n_images == 18, f"sketch, 4 displacements, 6 stresses, 2 damages, forces twice, energies, the growth of the crack and totals are drawn: {n_images}")
    check("2D, slowly loaded" in text and "slowly loaded up to t = 1 s, was computed" in text, "a slowly loaded body")
    check(bonds_sentence(run, "at") in text, f"the report says: {bonds_sentence(run, 'at')}")
    peaks = {m: max(over_time(run, m, "force on top in y"), key=lambda pair: abs(pair[1])) for m in (FE, PD)}
    listed = " and ".join(f"{written(v, 4)} N/m at t = {written(t, 4)} s ({m})" for m, (t, v) in peaks.items())
    check(f"The largest force on top, in y, was {listed}." in text, f"the largest force on top is {listed}")
    check(0.5 < peaks[PD][0] < 1 and peaks[FE][0] == 1, "peridynamics breaks before the end, finite elements never")
    check("Above, the force on top in y; that on bottom is equal and opposite; below, the bonds that have broken." in text,
          "forces and broken bonds over time")
    balance = run.model(PD)["energy balance"]
    for quantity, key in (("Energy released by broken bonds", "released"), ("Energy dissipated", "dissipated"),
                          ("Broken bonds", "broken bonds")):
        value = over_time(run, PD, quantity[0].lower() + quantity[1:])[-1][1]
        unit = "" if quantity == "Broken bonds" else " (J/m)"
        check([quantity + unit, "–", written(value)] in rows, f"{quantity} is that of totals.csv, {value}")
        check_close(balance[key], value, relative=1e-14, what=f"{key} of the summary")
    with h5py.File(os.path.join(run.folder, run.summary["fields"][-1]["files"][PD])) as file:
        damage = file["damage"][:].max()
    check(0.3 < damage <= 1 and "0 where all are whole, 1 where none is left" in text, f"the damage is drawn, up to {damage}")


def loaded_and_whole():
    """The plate without a crack, under a small load: no damage to draw."""
    run = run_scene("prm/fracture/centre_crack.prm",
                    {**COARSE, "Time/Time step": "0.1", "Time/End time": "0.3", "Output/Write at": "", "Cracks/Segments": ""})
    _, text, _ = report_of(run)
    check("No bond broke." in text and "none is left" not in text, "no bond broke, and no damage is drawn")
    force = over_time(run, PD, "force on top in y")[-1][1]
    check(f"The largest force on top, in y, was {written(force, 4)} N/m at t = 0.3 s." in text, f"the largest force is {force}")


def branching():
    """A motion: broken bonds are drawn beside its energies, a load that is always the same is not."""
    run = run_scene("prm/fracture/branching_crack.prm", {**COARSE, "Domain/Cells": "50, 20", "Output/Write every": "1e-5"})
    rows, text, _ = report_of(run)
    check("2D, dynamic" in text and "The loads change so slowly" not in text, "a motion")
    check(bonds_sentence(run, "by") in text, f"the report says: {bonds_sentence(run, 'by')}")
    check("The bonds that have broken; the forces on the sides do not change." in text, "broken bonds over time")
    for quantity in ("Kinetic energy", "Energy dissipated", "Broken bonds"):
        value = over_time(run, PD, quantity[0].lower() + quantity[1:])[-1][1]
        unit = "" if quantity == "Broken bonds" else " (J/m)"
        check([quantity + unit, written(value)] in rows, f"{quantity} is that of totals.csv, {value}")


def fracture():
    loaded_until_it_breaks()
    loaded_and_whole()
    branching()


if __name__ == "__main__":
    run_parts(bar, plate, body, fracture)
