# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""What a run and a study tell of themselves beyond the numbers: places, units, notes, columns.

    report_contents.py places       where conditions on parts and on sides of meshes are, on 1, 2 and 4 processes
    report_contents.py notes        crack scaling, the interface rule, stress intensities that there are not
    report_contents.py moisture     what flows of moisture are
    report_contents.py studies      what the runs of an elastic study have found, as columns and figures
"""

import csv
import functools
import json
import math
import os
import subprocess
import sys

from scene_test import (BC, FE, PD, QUIET, SOURCE_DIR, check, check_close, check_less, run_parts, run_perideal, run_scene, scene_text,
                        temporary_folder, write_file)

FOLDER = temporary_folder()
write = functools.partial(write_file, folder=FOLDER)

BEAM = scene_text("""
Physics = elasticity
Models = finite elements
Domain/Upper corner = 4, 1
Domain/Cells = 32, 8
Material/Young modulus = 100
Material/Poisson ratio = 0.3
Boundary conditions/Parts = foot: bottom if x > 1.03 && x < 1.9 ; weight: region sqrt((x - 3)^2 + (y - 0.5)^2) < 0.3 ; back: point 4, 1
Boundary conditions/Displacement = left: 0, 0 ; foot: free, 0 ; back: free, 0
Boundary conditions/Traction = weight: 0, -1
Output/Fields = none
""")

CRACKED = scene_text("""
Dimension = 2
Domain/Upper corner = 1, 1
Domain/Cells = 32, 33
Material/Young modulus = 100
Material/Poisson ratio = 0.3
Cracks/Segments = 0.25, 0.5 ; 0.75, 0.5
Time/Steady = true
Output/Fields = none
Output/Probes = 0.5, 1 ; 1, 0.5
""")
LOADS = ("Displacement = bottom: 0, 0", "Traction = top: 0, 1")


def cracked(name, physics, models, *conditions):
    more = [f"Physics = {physics}", f"Models = {models}"] + [BC + condition for condition in conditions]
    return write(name, CRACKED + scene_text("\n".join(more)))


def places():
    scene = write("beam.prm", BEAM)
    runs = {n: run_scene(scene, {}, ranks=n).summary for n in (1, 2, 4)}
    found = runs[1]["places"]
    check(set(found) == {"foot", "weight", "back"}, f"parts with conditions: {list(found)}")
    check([found[p]["kind"] for p in ("foot", "weight", "back")] == ["part of a side", "region", "point"], "their kinds")
    check(len(found["foot"]["lines"]) == 1, f"one straight line: {found['foot']['lines']}")
    x0, y0, x1, y1 = found["foot"]["lines"][0]
    eighth = 4 / 32 / 8
    check_less(max(abs(min(x0, x1) - 1.03), abs(max(x0, x1) - 1.9), abs(y0), abs(y1)), eighth, "ends of the part, to an eighth of a cell")
    check(all(n == [0.0, -1.0] for n in found["foot"]["normals"]), "outward normals")
    check(all(math.hypot(x - 3, y - 0.5) < 0.3 for x, y in found["weight"]["at"]), "cells of the region")
    check(found["back"]["at"] == [[4.0, 1.0]], "the point")
    values = runs[1]["values on sides"]
    check(values["foot"]["displacement"]["values"][0] == [None, 0.0] and values["weight"]["traction"]["values"][0] == [0.0, -1.0],
          "what holds there")
    for n in (2, 4):
        check(runs[n]["places"] == found and runs[n]["values on sides"] == values, f"the same on {n} processes")

    ring = "prm/elasticity/thick_ring.prm"
    runs = {n: run_scene(ring, {**QUIET, "Models": FE, "Peridynamics/Surface correction": "none"}, ranks=n).summary for n in (1, 2)}
    found = runs[1]["places"]
    check(set(found) == {"1", "3", "5"} and all(p["kind"] == "side" for p in found.values()), f"sides of a mesh: {list(found)}")
    check(len(found["1"]["lines"]) == 1 and len(found["5"]["lines"]) > 5, "straight and curved sides")
    ends = [[round(v, 9) for v in line] for line in found["5"]["lines"]]
    check(all(a[2:] == b[:2] for a, b in zip(ends, ends[1:])), "a curved side is one line")
    for (x, y), normal, pull in zip(found["5"]["at"], found["5"]["normals"], runs[1]["values on sides"]["5"]["traction"]["values"]):
        r = math.hypot(x, y)
        check_less(math.hypot(normal[0] + x / r, normal[1] + y / r), 0.1, "the normal of the bore")
        check_close(pull[0], x / r, absolute=1e-12, what="the pressure there")
    check(runs[2]["places"] == found, "the same on 2 processes")

    plate = "prm/heat/gmsh_plate.prm"
    found = run_scene(plate, {**QUIET, "Models": FE}).summary
    check(set(found["places"]) == set(found["sides"]), f"heat, too: {list(found['places'])}")


def notes():
    heat = cracked("heat.prm", "heat", "peridynamics", "Dirichlet = top: 1; bottom: 0")

    def told(scene, word, more=None):
        return [n for n in run_scene(scene, more or {}).summary["notes"] if word in n]

    check(len(told(heat, "crack scaling", {"Peridynamics/Surface correction": "none"})) == 1, "a note where crack scaling is missing")
    for more in ({}, {"Peridynamics/Surface correction": "crack scaling"}, {"Cracks/Segments": ""},
                 {"Models": FE, "Cracks/Mesh": "removed"}, {"Cracks/Transmission": "0.5"}):
        check(not told(heat, "comes out some percent too large", more), f"no such note with {more}")

    phases = {"Cracks/Segments": "", "Material/Phases/Regions": "wire: circle(0.5, 0.5, 0.2)", "Domain/Nodes": "cell centers"}
    for ratio, rule, n in ((20, "arithmetic", 1), (20, "minimum", 1), (20, "harmonic", 0), (2, "arithmetic", 0)):
        more = {**phases, "Material/Phases/Conductivity": f"wire: {ratio}", "Material/Interface rule": rule}
        run = run_scene(heat, more)
        check(sum("Interface rule" in note for note in run.summary["notes"]) == n, f"{rule}, {ratio}: {run.summary['notes']}")
        check(run.model(PD)["settings"]["interface rule"] == rule, "the rule is a setting")
    for models, rule, n in ((PD, "harmonic", 1), (f"{FE}, {PD}, coupled", "minimum", 1), (PD, "arithmetic", 0), (FE, "harmonic", 0)):
        more = {"Models": models, "Material/Interface rule": rule, "Material/Phases/Regions": "wire: circle(0.5, 0.5, 0.2)", "Material/Phases/Conductivity": "wire: 20"}
        found = told(heat, "'Interface rule' in section 'Material' has no effect on ", more)
        check(len(found) == n and all(("coupled" in note) == ("coupled" in models) for note in found), f"{models}, {rule}: {found}")
    check("interface rule" not in run_scene(heat, {"Cracks/Segments": ""}).model(PD)["settings"], "of one material there is none")

    for name, models, ratio, expected in (("pd", PD, "3", ""), ("far", PD, "9", "room around"), ("both", f"{FE}, {PD}", "9", "peridynamics has none"), ("fem", FE, "3", "")):
        summary = run_scene(cracked(name + ".prm", "elasticity", models, *LOADS), {"Peridynamics/Horizon ratio": ratio}).summary
        check(expected in summary.get("no stress intensity", "") and (expected != "") == ("no stress intensity" in summary),
              f"{models}: {summary.get('no stress intensity')}")
    status, stdout, _ = run_perideal(["run", os.path.join(FOLDER, "pd.prm"), "-s", f"Output directory={FOLDER}/pd", "-s", "Peridynamics/Horizon ratio=9"])
    check(status == 0 and "no stress intensity factors: " in stdout, f"closing lines: {stdout[-800:]}")
    summary = run_scene(os.path.join(FOLDER, "pd.prm"), {"Material/Critical stretch": "0.5"}).summary
    check("no stress intensity" not in summary, "of a body that may break nobody expects them")

    # What an image conducts as a whole, of electricity.
    image = write("wire.pgm", "P2 8 8 255\n" + "\n".join(" ".join("200" if 2 <= i < 6 and 2 <= j < 6 else "0" for i in range(8)) for j in range(8)))
    scene = write("image.prm", scene_text(f"""
Physics = electricity
Models = {FE}
Domain/Shape = image
Domain/Image = {image}
Domain/Image colors = resin: 0 ; wire: 200
Domain/Upper corner = 2, 1
Material/Conductivity = 3
Boundary conditions/Dirichlet = left: 1; right: 0
Time/Steady = true
Output/Fields = none
"""))
    check_close(run_scene(scene, {}).model(FE)["effective conductivity"], 3, relative=1e-9, what="of one conductivity: that")


def moisture():
    scene = write("wet.prm", scene_text("""
Physics = moisture
Models = finite elements
Domain/Upper corner = 2, 1
Domain/Cells = 10, 4
Material/Conductivity = 0.02
Material/Saturated concentration = 12e-6
Boundary conditions/Convection = right: 0.03, 1
Time/End time = 5
Output/Fields = none
"""))
    wet = run_scene(scene, {})
    mass = run_scene(scene, {"Material/Density": "12e-6", "Material/Conductivity": "0.02*12e-6",
                            "Boundary conditions/Convection": "right: 0.03*12e-6, 1"})
    check((wet.summary["moisture counts"], mass.summary["moisture counts"]) == ("wetness", "mass"), "what flows are")
    entered = [run.model(FE)["heat balance"]["cumulative"]["entered"] for run in (wet, mass)]
    weights = [next(float(r["value"]) for r in run.totals if r["quantity"] == "weight") for run in (wet, mass)]
    check_close(entered[0] * 12e-6, weights[0], relative=1e-6, what="wetness times volume times the saturated concentration is the weight")
    check_close(entered[1], weights[1], relative=1e-6, what="with Density = C_sat what enters is the weight")
    check_close(weights[0], weights[1], relative=1e-6, what="both ways")


def studies():
    scene = cracked("study.prm", "elasticity", f"{FE}, {PD}", *LOADS)
    output = os.path.join(FOLDER, "study")
    status, _, stderr = run_perideal(["study", scene, "--vary", "Domain/Cells=32, 33 | 40, 41", "--vary", "Peridynamics/Horizon ratio=2 | 3",
                                      "--output", output, "-q"])
    check(status == 0, f"the study: {stderr}")
    with open(os.path.join(output, "study.csv"), newline="") as file:
        lines = list(csv.DictReader(file))
    with open(os.path.join(output, "study.json")) as file:
        whole = json.load(file)
    wanted = ["ux at (0.5, 1)", "uy at (0.5, 1)", "von_mises at (0.5, 1)", "ux at (1, 0.5)", "uy at (1, 0.5)", "von_mises at (1, 0.5)",
              "K_I at crack 1 end 1", "K_II at crack 1 end 1", "K_I at crack 1 end 2", "K_II at crack 1 end 2", "strain energy", "largest force"]
    check(whole["quantities"] == wanted and whole["columns"][-len(wanted):] == wanted, f"columns: {whole['quantities']}")
    for line in lines:
        row = next(r for r in whole["rows"] if r["name"] == line["name"])
        model = row["models"][line["model"]]
        probe = next(p for p in row["probes"] if p["model"] == line["model"] and p["coordinates"] == [0.5, 1])
        check_close(float(line["uy at (0.5, 1)"]), probe["uy"], relative=1e-12, what="the probe")
        check_close(float(line["largest force"]), 1, relative=0.01, what="the largest force")
        check_close(float(line["strain energy"]), model["strain energy"], relative=1e-12, what="the energy")
        check_close(float(line["K_I at crack 1 end 2"]), model["stress intensity"]["crack 1 end 2"]["I"], relative=1e-12, what=f"{line['model']}: K_I")
    script = os.path.join(SOURCE_DIR, "applications", "report", "study.py")
    done = subprocess.run([sys.executable, script, output], capture_output=True, text=True, check=False)
    check(done.returncode == 0, f"the figures: {done.stderr}")
    figures = {name for name in os.listdir(output) if name.endswith(".png")}
    check({"uy_at_0.5_1.png", "K_I_at_crack_1_end_2.png", "strain_energy.png", "wall_time.png"} <= figures, f"figures: {sorted(figures)}")

    # Elements do not know the horizon: one line for both. Peridynamics has one for each.
    sys.path.insert(0, os.path.dirname(script))
    import study_figures
    found, _ = study_figures.collect(whole, {"x": "Domain/Cells", "y": "uy at (0.5, 1)", "lines": []})
    check(sorted(found) == [FE, PD + ", Horizon ratio = 2", PD + ", Horizon ratio = 3"], f"lines: {sorted(found)}")
    check(all(len(points) == 2 for points in found.values()), "a point for each lattice")
    # One line for each model: all that peridynamics has found, whichever is smaller.
    found, _ = study_figures.collect(whole, {"x": "Domain/Cells", "y": "uy at (0.5, 1)", "lines": ["model"]})
    values = {model: sorted(float(line["uy at (0.5, 1)"]) for line in lines if line["model"] == model) for model in (FE, PD)}
    check(sorted(y for _, y in found[PD]) == values[PD] and len(found[PD]) == 4, f"points of peridynamics: {found[PD]}")
    check(sorted(y for _, y in found[FE]) == sorted(set(values[FE])) and len(found[FE]) == 2, f"points of elements: {found[FE]}")
    # Of what was computed again the shorter time.
    found, _ = study_figures.collect(whole, {"x": "Domain/Cells", "y": "wall time", "lines": ["model"]})
    times = {}
    for line in lines:
        if line["model"] == FE:
            times.setdefault(line["Domain/Cells"], []).append(float(line["wall time"]))
    shortest = zip(sorted(y for _, y in found[FE]), sorted(min(t) for t in times.values()))
    check(all(math.isclose(a, b, rel_tol=1e-9) for a, b in shortest) and len(found[FE]) == len(times) and len(found[PD]) == 4,
          f"wall times: {found}")
    check(study_figures.label_of(whole, "uy at (0.5, 1)") == "Displacement in y at (0.5, 1) (m)", "the label with its unit")

    # Such a column may be asked for.
    file = write("study.json", json.dumps({"rows": [{"name": "a", "scene": scene, "set": {"Models": FE}}],
                                           "figures": [{"name": "f", "x": "unknowns", "y": "uy at (0.5, 1)"}]}))
    status, _, stderr = run_perideal(["study", file, "--output", os.path.join(FOLDER, "asked"), "-q"])
    check(status == 0, f"a figure of what runs find: {stderr}")


if __name__ == "__main__":
    run_parts(places, notes, moisture, studies)
