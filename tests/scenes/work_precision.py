# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""perideal study work_precision: costs, errors, the front and what is dominated, on one process and on two; mistakes.

    python3 work_precision.py [front | exact | body | mesh | smooth | in_time | motion | measures | mistakes | ranks] ...     (all without arguments)
"""

import csv
import functools
import json
import math
import os
import re
import subprocess
import sys

from scene_test import SOURCE_DIR, check, check_close, check_less, check_one_message, run_driver, run_parts, run_perideal, scene_text, temporary_folder, write_file

PLATE = scene_text("""
Title = Small plate with a crack
Dimension = 2
Domain/Lower corner = -1, -1
Domain/Upper corner = 1, 1
Domain/Cells = 17, 17
Boundary conditions/Dirichlet = top: 1; bottom: -1
Cracks/Segments = -0.5,0 ; 0.5,0
Time/Steady = true
""")

FOLDER = temporary_folder()
write = functools.partial(write_file, folder=FOLDER)
SMALL = ["--cells", "9, 9 | 17, 17", "--budget", "8000"]


def study(scene, *options, output="results", ranks=1, expect=0):
    """Compute; returns (stdout, stderr, directory)."""
    directory = os.path.join(FOLDER, output)
    status, stdout, stderr = run_driver(["study", "work_precision", scene, "--output", directory, *options], ranks, 600, cwd=SOURCE_DIR)
    check(status == expect, f"work_precision {options}: exit status {status} where {expect} was expected\n{stdout[-2000:]}{stderr[-2000:]}")
    return stdout, stderr, directory


def results(directory):
    with open(os.path.join(directory, "work_precision.json")) as file:
        return json.load(file)


def better(a, b, cost):
    """Whether row a dominates row b."""
    return a[cost] <= b[cost] and a["error"] <= b["error"] and (a[cost] < b[cost] or a["error"] < b["error"])


def front():
    """Files, costs, errors, the front, and dominated settings."""
    plate = write("plate.prm", PLATE)
    stdout, _, directory = study(plate, *SMALL)
    data = results(directory)
    rows = {row["name"]: row for row in data["rows"]}
    with open(os.path.join(directory, "work_precision.csv"), newline="") as file:
        lines = list(csv.DictReader(file))
    check([line["name"] for line in lines] == list(rows) + [pick["name"] for pick in data["picks"]], "the rows of both files")
    for line in lines[:len(rows)]:
        row = rows[line["name"]]
        for key in ("work", "error", "wall time", "bonds", "nonzeros applied"):
            check(math.isclose(float(line[key]), row[key], rel_tol=1e-13), f"{line['name']}: {key} {line[key]} and {row[key]}")
        check(line["dominated by"] == row["dominated by"] and (line["front"] == "true") == row["front"], f"{line['name']}: front")

    # Costs.
    for row in rows.values():
        check(math.isclose(row["work"], row["nonzeros applied"] * row["iterations"], rel_tol=1e-13), f"{row['name']}: work")
        if row["model"] != "peridynamics":
            check(row["nonzeros applied"] == row["nonzeros"], f"{row['name']}: entries of a matrix")
        else:
            check(row["nonzeros applied"] >= 2 * row["bonds"] + row["unknowns"], f"{row['name']}: every bond counts twice")
        check(row["iterations"] >= 5, f"{row['name']}: {row['iterations']} iterations: a direct solution")
        check(row["peak memory"] > 0 and row["memory"] > 0, f"{row['name']}: memory")

    # The front, again, and what dominates.
    for cost, on_front, by in (("work", "front", "dominated by"), ("wall time", "front in wall time", "dominated in wall time by")):
        best = [row["name"] for row in sorted(rows.values(), key=lambda r: (r[cost], r["error"]))
                if not any(better(other, row, cost) for other in rows.values())]
        check(data[on_front] == best, f"{on_front}: {data[on_front]}, expected {best}")
        for row in rows.values():
            check(row[on_front] == (row["name"] in best) and row[on_front] == (row[by] == ""), f"{row['name']}: {on_front}")
            if row[by]:
                cheapest = next(name for name in best if better(rows[name], row, cost))
                check(row[by] == cheapest, f"{row['name']}: {by} {row[by]}, expected {cheapest}")

    # Errors: smaller on the finer lattice; those of the best known to be small.
    reference = data["reference"]
    check(reference["cells"] == ["24, 24", "48, 48", "96, 96"], f"reference: {reference}")
    check_close(reference["observed order"], 1.0, absolute=0.15, what="order of finite elements at a crack's ends")
    check(reference["order"] == 1.0, f"extrapolated with {reference['order']}")
    check_less(reference["own error"], 2e-3, "error of the reference")
    for family in data["families"]:
        errors = [rows[name]["error"] for name in family["rows"]]
        check(errors == sorted(errors, reverse=True), f"{family['name']}: errors {errors}")
        targets = {entry["error"]: entry["work"] for entry in family["at error"]}
        check(sorted(targets) == [1e-3, 1e-2], f"{family['name']}: targets {targets}")
        for error, cost in targets.items():
            if cost["kind"] == "interpolated":
                works = [rows[name]["work"] for name in family["rows"]]
                check(min(works) <= cost["cost"] <= max(works) and errors[-1] <= error, f"{family['name']}: {cost}")
    faces = rows["FEM, crack on faces, 16 x 16"]
    scaled = rows["coupled, m = 2, c = 1, scaled, 17 x 17"]
    check_less(faces["error"], 0.02, "finite elements with the crack on faces")
    check_less(scaled["error"], 0.013, "coupled, scaled")
    check_less(4 * faces["error"], rows["PD raw, m = 3, 17 x 17"]["error"], "families cut off at the surface are far more wrong")

    # The budget, and what the reader sees.
    left_out = [s for s in data["left out"] if "--budget" in s]
    check(any("PD raw, m = 6.5, 17 x 17" in s for s in left_out), f"left out: {left_out}")
    check(not any("m = 6.5, 17 x 17" in name for name in rows), "beyond the budget nothing is computed")
    for text in (*left_out, "Pareto front", "Dominated", "At an error of 1 %", "At an error of 0.1 %", "own error", f"Results: {directory}"):
        check(text in stdout, f"the output does not say {text!r}")
    again, _, _ = study(plate, *SMALL)
    check(again.count(": kept") == len(rows) + 3 + 2 * len(data["picks"]), "nothing is computed twice")
    check_picks(directory, data)

    # The charts.
    script = os.path.join(SOURCE_DIR, "applications", "report", "study.py")
    done = subprocess.run([os.environ.get("PERIDEAL_PYTHON", sys.executable), script, directory], capture_output=True, text=True)
    check(done.returncode == 0, f"study.py: {done.stderr}")
    for name in ("error_over_work.png", "error_over_wall_time.png"):
        path = os.path.join(directory, name)
        check(os.path.exists(path) and os.path.getsize(path) > 20000, name)
    page = open(os.path.join(directory, "index.html"), encoding="utf-8").read()
    check("The Pareto front" in page and "Dominated settings" in page and "What auto picks" in page, "the page has the tables")
    check(all(f"auto {tolerance}" in stdout or f"auto, {tolerance}" in stdout for tolerance in ("3e-2", "1e-2", "1e-3")), "picks in the output")
    check_interactive(page, data)
    # Without the library the page has the figures alone.
    bare = subprocess.run([os.environ.get("PERIDEAL_PYTHON", sys.executable), "-c", f"import sys; sys.path.insert(0, {os.path.dirname(script)!r})\n"
                           f"import interactive, study\ninteractive.PLACES = ()\nsys.exit(study.main([{directory!r}]))"], capture_output=True, text=True)
    page = open(os.path.join(directory, "index.html"), encoding="utf-8").read()
    check(bare.returncode == 0 and "<canvas" not in page and "data:image/svg" in page, f"a page without the library: {bare.stderr}")


def check_picks(directory, data, within=1.0):
    """Three choices, each as wrong as was asked for at most, with the whole run's wall time. Relative to the L2 norm, not to the range, so `within` times that."""
    check(data["no picks"] == "" and [pick["tolerance"] for pick in data["picks"]] == [3e-2, 1e-2, 1e-3], f"picks: {data['picks']}")
    for pick in data["picks"]:
        check(pick["met"] and pick["tries"] >= 2 and pick["estimate"] <= pick["tolerance"] and "Cells = " in pick["settings"], f"{pick}")
        check_less(pick["error"], within * pick["tolerance"], f"{pick['name']}: error")
        folder = os.path.join(directory, "rows", pick["name"].replace(", ", "_"))
        with open(os.path.join(folder, "row.json")) as file:
            check(json.load(file)["wall time"] == pick["wall time"], f"{pick['name']}: wall time")
        with open(os.path.join(folder, "summary.json")) as file:
            accuracy = json.load(file)["accuracy"]
        check(accuracy["estimate"] == pick["estimate"] and len(accuracy["steps"]) == pick["tries"], f"{pick['name']}: summary")


def check_interactive(page, data):
    """The chart in the page has all settings and choices, and the library is in it, if it is installed."""
    if not any(place and os.path.exists(place) for place in (os.environ.get("PERIDEAL_CHART_JS"), "/usr/share/javascript/chart.js/chart.min.js")):
        check("<canvas" not in page, "no library, no chart")
        return
    text = re.search(r'<script type="application/json" id="all-settings-data">(.*?)</script>', page, re.S).group(1)
    chart = json.loads(text)
    told = {point["name"]: point for line in chart["lines"] for point in line["points"]}
    for row in data["rows"]:
        check(told[row["name"]]["error"] == row["error"] and told[row["name"]]["wall time"] == row["wall time"], f"{row['name']} in the chart")
    check(len(told) == len(data["rows"]) + len(data["picks"]) and chart["lines"][-1]["stars"] == bool(data["picks"]), "points of the chart")
    check("Chart.js v" in page and not re.search(r"""(src|href)=["']?(https?:)?//""", page), "the library is in the page, and nothing is fetched")


def smooth():
    """Without cracks: elements of degree 1 and 2, bonds with their treatments, a zone by a formula; against a solution, and against elements of degree 2."""
    few = ["--cells", "8, 8 | 16, 16", "--budget", "8000"]
    _, _, directory = study("prm/heat/smooth_source.prm", *few, output="smooth")
    data = results(directory)
    check(data["reference"] == {"kind": "exact solution"}, f"reference: {data['reference']}")
    families = {family["name"]: family for family in data["families"]}
    check(set(families) >= {"FEM, degree 1", "FEM, degree 2", "PD raw, m = 2", "PD energy-corrected, m = 3", "PD exchange, m = 4", "PD mirror, m = 3"}
          and not any("coupled" in name for name in families), f"families: {list(families)}")
    check_close(families["FEM, degree 1"]["observed order"], 2.0, absolute=0.1, what="order of degree 1")
    check_close(families["FEM, degree 2"]["observed order"], 4.0, absolute=0.3, what="order of degree 2 at vertices")
    check_picks(directory, data, within=2.0)  # the range is 1, the norm 1/2
    # The same without its solution: the errors are the same.
    text = open(os.path.join(SOURCE_DIR, "prm/heat/smooth_source.prm")).read()
    unknown = write("unknown.prm", text.replace("set Solution = sin(pi*x)*sin(pi*y)", ""))
    _, _, directory = study(unknown, *few, "--no-auto", output="unknown")
    other = results(directory)
    check(other["picks"] == [] and "degree 2" in other["reference"]["kind"], f"reference: {other['reference']}")
    errors = {row["name"]: row["error"] for row in data["rows"]}
    for row in other["rows"]:
        check_close(row["error"], errors[row["name"]], absolute=3 * other["reference"]["own error"] + 1e-9, what=f"{row['name']}: error")
    zone = write("zone.prm", text + "subsection Coupling\n  set Zone = 0.3 - sqrt((x-0.5)^2+(y-0.5)^2)\nend\n")
    _, _, directory = study(zone, *few, "--no-auto", "--only", "coupled", output="zone")
    check([row["family"] for row in results(directory)["rows"]][::2] == ["coupled, m = 2, zone of the scene", "coupled, m = 3, zone of the scene"], "a zone by a formula")
    # An elastic body.
    _, _, directory = study("prm/elasticity/bar_2d.prm", *few, "--no-auto", "--only", "FEM, degree 1", "FEM, degree 2", "PD completed, m = 3", "reference", output="solid")
    check(len(results(directory)["rows"]) >= 5, "a bar")


def in_time():
    """Transient problems: the error in time alone, by stepper."""
    _, _, directory = study("prm/heat/harmonic_2d.prm", "--cells", "8, 8 | 16, 16", "--no-auto", "--only", "FEM, degree 1", "in time", "-s", "Reference/Solution=classical harmonic(1,2)",
                            "-s", "Time/Tolerance=1e-6", output="in_time")
    data = results(directory)["in time"]
    check(data["method"] == "FEM, degree 1, 8 x 8" and data["error in space"] > 1e-3, f"{data['method']}: {data['error in space']}")
    steppers = {}
    for row in data["rows"]:
        steppers.setdefault(row["stepper"], []).append(row)
    check(list(steppers) == ["euler", "rk4", "rkc2", "chebyshev", "crank nicolson", "bdf2", "sdirk2"], f"steppers: {list(steppers)}")
    for stepper in ("rkc2", "crank nicolson", "bdf2", "sdirk2"):
        rows = steppers[stepper]
        check([row["tolerance"] for row in rows] == [1e-2, 1e-3, 1e-4, 1e-5], f"{stepper}: tolerances")
        check_less(rows[-1]["error"], 0.1 * rows[0]["error"], f"{stepper}: a tolerance a thousand times smaller")
        check_less(rows[0]["work"], rows[-1]["work"], f"{stepper}: work")
    check_less(steppers["rk4"][0]["error"], 0.1 * steppers["euler"][0]["error"], "the fourth order and the first")
    with open(os.path.join(directory, "work_precision_in_time.csv"), newline="") as file:
        lines = list(csv.DictReader(file))
    check(len(lines) == len(data["rows"]) and all(math.isclose(float(line["error"]), row["error"], rel_tol=1e-13) for line, row in zip(lines, data["rows"])),
          "the table of steppers")
    script = os.path.join(SOURCE_DIR, "applications", "report", "study.py")
    subprocess.run([os.environ.get("PERIDEAL_PYTHON", sys.executable), script, directory], check=True, stdout=subprocess.DEVNULL)
    check(os.path.getsize(os.path.join(directory, "error_in_time_over_work.png")) > 20000, "the chart of steppers")


def motion():
    """A wave: smaller steps do not make up for large cells."""
    _, _, directory = study("prm/elasticity/wave_in_bar.prm", "--cells", "100 | 200 | 400", output="motion")
    data = results(directory)
    check(data["no picks"] != "" or len(data["picks"]) == 3, "picks, or why there are none")
    rows = {row["name"]: row for row in data["rows"]}
    check(len(rows) + len(data["left out"]) == 36, f"rows: {list(rows)}; left out: {data['left out']}")
    for step in ("0.8", "0.4", "0.2"):
        errors = [rows[f"FEM, steps of {step} cells, {cells}"]["error"] for cells in (100, 200, 400)]
        check(errors == sorted(errors, reverse=True), f"FEM, {step}: {errors}")
    check_less(rows["FEM, steps of 0.8 cells, 400"]["error"], rows["FEM, steps of 0.2 cells, 400"]["error"], "steps near the limit take some of the dispersion back")
    _, stderr, _ = study(write("wave.prm", open(os.path.join(SOURCE_DIR, "prm/elasticity/wave_in_bar.prm")).read().replace("set Solution = 1e-6", "# set Solution = 1e-6")),
                         output="no_motion", expect=1)
    check("'Solution'" in stderr and "motion" in stderr, f"a motion without a solution: {stderr}")


def exact():
    """With an exact solution the error is that of the run, and no reference is computed."""
    _, _, directory = study("prm/coupling/oblique_crack.prm", "--cells", "15, 15 | 21, 21", "--only", "FEM, pairs", "FEM, pairs, scaled",
                            output="exact")
    data = results(directory)
    check(data["reference"] == {"kind": "exact solution"}, f"reference: {data['reference']}")
    check([s for s in data["left out"] if s.startswith("FEM, crack on faces")] != [], "an oblique crack lies on no faces")
    check(len(data["rows"]) == 4, f"rows: {[row['name'] for row in data['rows']]}")
    with open(os.path.join(directory, "study.csv"), newline="") as file:
        errors = {line["name"]: float(line["relative l2 error"]) for line in csv.DictReader(file)}
    for row in data["rows"]:
        check_close(row["error"], errors[row["name"]], relative=1e-10, what=f"{row['name']}: error")


def body():
    """Elastic bodies: the error of the displacement at the nodes, against a solution and, without, against finite elements with the crack on faces."""
    _, _, directory = study("prm/elasticity/coupled_crack.prm", "--cells", "11, 11 | 21, 21", "--budget", "20000", output="body")
    data = results(directory)
    check(data["reference"] == {"kind": "exact solution"}, f"reference: {data['reference']}")
    with open(os.path.join(directory, "study.csv"), newline="") as file:
        errors = {line["name"]: float(line["relative l2 error"]) for line in csv.DictReader(file)}
    rows = {row["name"]: row for row in data["rows"]}
    check(len(rows) > 30 and any(name.startswith("PD completed, m = 3") for name in rows), f"rows: {list(rows)}")
    for name, row in rows.items():
        # Nodes on a crack on faces do not count, and those of the whole lattice do on a graded mesh.
        if not name.startswith("FEM, crack on faces") and "graded" not in name:
            check_close(row["error"], errors[name], relative=1e-9, what=f"{name}: error")
    # Measured: 0.0089 and 0.0367.
    scaled, removed = rows["coupled, m = 2, c = 1, scaled, 21 x 21"]["error"], rows["FEM, cells removed, 21 x 21"]["error"]
    check(scaled < 0.0135 and removed > 2.5 * scaled, f"coupled {scaled}, finite elements {removed}")
    check(sum("graded" in name for name in rows) >= 8, "graded meshes are among the rows")
    plain = write("coupled_crack.prm", open(os.path.join(SOURCE_DIR, "prm/elasticity/coupled_crack.prm")).read().replace("westergaard(1, 0)", ""))
    _, _, directory = study(plain, "--cells", "11, 11 | 21, 21", "--only", "reference", "FEM, crack on faces", "FEM, cells removed", output="body_reference")
    data = results(directory)
    check(abs(data["reference"]["order"] - 1.0) < 0.3, f"reference: {data['reference']}")
    for row in data["rows"]:
        check(1e-3 < row["error"] < 0.1, f"{row['name']}: {row['error']}")


def mesh():
    """A body from a mesh file: at a corner cells that are fine there alone are worth more than halving all."""
    _, _, directory = study("prm/heat/angle.prm", "--cells", "1 | 2 | 4 | 8", output="mesh")
    data = results(directory)
    rows = {row["name"]: row for row in data["rows"]}
    check(data["reference"] == {"kind": "exact solution"} and len(rows) == 26, f"{data['reference']}, {len(rows)} rows")
    order = {family["name"]: family["observed order"] for family in data["families"]}
    check_close(order["FEM, degree 2"], 4 / 3, absolute=0.2, what="order in the body with a corner")
    check_close(order["FEM, degree 1, fine at corners"], 2.0, absolute=0.3, what="order with cells that are fine at the corner")
    check(order["FEM, degree 2, fine at corners"] > 2.6, f"order of degree 2, fine at the corner: {order}")
    check_less(10 * rows["FEM, degree 2, fine at corners, edges in 8"]["error"], rows["FEM, degree 2, edges in 8"]["error"], "fine at the corner")
    check(rows["PD exchange, edges in 4"]["error"] < rows["PD raw, edges in 4"]["error"], "families cut off at the sides are more wrong")
    for pick in data["picks"]:
        check(pick["met"] and pick["error"] < pick["tolerance"], f"{pick}")
    for wrong, options, words in (("thirds", ["--cells", "1 | 3"], ["--cells", "powers of two"]), ("a measure", ["--measure", "opening"], ["--measure", "'field'"]),
                                  ("no solution", ["-s", "Reference/Solution="], ["'Solution'", "mesh file"])):
        stdout, stderr, _ = study("prm/heat/angle.prm", *options, output="mistakes", expect=1)
        check_one_message(stdout, stderr, words, wrong)


def measures():
    """Openings and stress intensities of a crack in an elastic body."""
    few = ["--cells", "21, 21 | 41, 41", "--budget", "8000", "--only", "reference", "FEM, crack on faces", "FEM, cells removed", "coupled, m = 3, c = 1, scaled"]
    crack = "prm/elasticity/coupled_crack.prm"
    _, _, directory = study(crack, "--measure", "stress intensity", *few, "auto", output="intensity")
    data = results(directory)
    rows = {row["name"]: row for row in data["rows"]}
    check(data["measure"] == "stress intensity" and "cells" in data["reference"], f"{data['measure']}, {data['reference']}")
    check_less(data["reference"]["own error"], 1e-3, "the reference's stress intensities")
    # Measured: 0.0016, 0.0003, 0.0172; K_I is sqrt(pi/2), K_II is 0.
    check_less(rows["coupled, m = 3, c = 1, scaled, 41 x 41"]["error"], 0.004, "coupled")
    check_less(rows["FEM, crack on faces, 40 x 40"]["error"], 0.001, "the crack on faces")  # measured: 0.0003
    with open(os.path.join(directory, "rows", "FEM_cells_removed_41_x_41", "summary.json")) as file:
        ends = json.load(file)["models"]["finite elements"]["stress intensity"]
    exact, found = math.sqrt(math.pi / 2), [end[mode] for end in ends.values() for mode in ("I", "II")]
    error = math.dist(found, [exact, 0.0] * len(ends)) / (exact * math.sqrt(len(ends)))
    check_close(rows["FEM, cells removed, 41 x 41"]["error"], error, absolute=2e-3, what="cells removed: error")
    check(data["picks"][2]["error"] < 1e-3 and data["picks"][2]["met"], f"{data['picks']}")
    check(any("no stress intensities" in sentence for sentence in data["left out"]), f"{data['left out']}")
    _, _, directory = study(crack, "--measure", "opening", "--no-auto", *few[:-4], *few[-3:], output="opening")
    rows = {row["name"]: row["error"] for row in results(directory)["rows"]}
    # Measured: 0.0034, 0.0346.
    check(rows["coupled, m = 3, c = 1, scaled, 41 x 41"] < 0.005 and 0.025 < rows["FEM, cells removed, 41 x 41"] < 0.045, f"{rows}")


def mistakes():
    """One message, and nothing is computed."""
    plate = write("plate.prm", PLATE)
    oblique = PLATE.replace("-0.5,0 ; 0.5,0", "-0.5,-0.2 ; 0.5,0.3")
    for what, scene, options, words in (
            ("no box", PLATE.replace("subsection Domain", "subsection Domain\n  set Shape = plate with hole"), [], ["'Shape'", "box"]),
            ("a hole", PLATE.replace("subsection Domain", "subsection Domain\n  set Holes = circle: 0, 0.6, 0.2"), [], ["'Holes'", "has to be empty"]),
            ("nothing to compare with", oblique, [], ["'Solution'", "along the axes"]),
            ("a crack on no lattice", PLATE.replace("-0.5,0 ; 0.5,0", "-0.5,0 ; 0.4142135623,0"), [], ["'Solution'", "ends of all cracks"]),
            ("a share of bonds", PLATE.replace("0.5,0\n", "0.5,0\n  set Transmission = 0.5\n"), [], ["'Transmission'", "'Contact conductance'"]),
            ("no condition", PLATE.replace("set Dirichlet", "set Flux"), [], ["'Dirichlet'"]),
            ("no numbers", None, ["--cells", "9, 9 | a, b"], ["--cells", "'a'", "separated by '|'"]),
            ("one lattice", None, ["--cells", "9, 9"], ["--cells", "needs 2"]),
            ("coarser lattices", None, ["--cells", "17, 17 | 9, 9"], ["--cells", "not finer"]),
            ("one number", None, ["--cells", "9 | 17"], ["--cells", "has 1 number"]),
            ("reference off the crack", None, ["--reference", "9, 9 | 18, 18 | 36, 36"], ["--reference", "three lattices"]),
            ("an unknown measure", None, ["--measure", "openings"], ["--measure", "'openings'", "Did you mean 'opening'?"]),
            ("no opening in diffusion", None, ["--measure", "opening"], ["--measure", "elastic bodies"]),
            ("no budget", None, ["--budget", "0"], ["--budget"]),
            ("entry of the study", None, ["-s", "Domain/Cells=9, 9"], ["'Domain/Cells=9, 9'", "varies"]),
            ("--vary", None, ["--vary", "Domain/Cells=9, 9"], ["--vary", "--cells"]),
            ("--only without the reference", None, [*SMALL, "--only", "FEM, pairs"], ["'reference, 24 x 24'", "--only"])):
        path = plate if scene is None else write("wrong.prm", scene)
        stdout, stderr, _ = study(path, *options, output="mistakes", expect=1)
        check_one_message(stdout, stderr, words, what)
    for arguments in (["work_precision"], ["work_precision", plate, plate], [plate, "--cells", "9, 9 | 17, 17"]):
        status, _, stderr = run_driver(["study", *arguments])
        check(status == 1 and "work_precision" in stderr, f"study {arguments}: {stderr}")
    status, _, stderr = run_perideal(["study", "work_precision", plate])
    check(status == 1 and "python3 -m perideal study work_precision" in stderr, f"the program says where it is: {stderr}")
    _, stderr, _ = study(plate, "--cells", "9, 9 | x", output="mistakes", ranks=2, expect=1)
    check(stderr.count("perideal: error") == 1, f"one message on two processes: {stderr}")


def ranks():
    """Two processes give the numbers of one; the number of iterations depends on how multigrid is shared out."""
    plate = write("plate.prm", PLATE)
    groups = ["--only", "reference", "FEM, pairs, scaled", "PD raw, m = 3", "PD exchange, scaled, m = 2", "coupled, m = 3, c = 1, scaled"]
    one = results(study(plate, *SMALL, *groups, output="one")[2])
    two = results(study(plate, *SMALL, *groups, output="two", ranks=2)[2])
    check_close(two["reference"]["own error"], one["reference"]["own error"], relative=1e-6, what="own error")
    check(len(one["rows"]) == len(two["rows"]) == 8, f"{len(one['rows'])} and {len(two['rows'])} rows")
    for a, b in zip(one["rows"], two["rows"]):
        check(a["name"] == b["name"], f"{a['name']} and {b['name']}")
        for key in ("unknowns", "bonds", "nonzeros", "nonzeros applied"):
            check(a[key] == b[key], f"{a['name']}: {key} {a[key]} {b[key]}")
        check_close(b["error"], a["error"], relative=1e-6, what=f"{a['name']}: error")
        check(abs(a["iterations"] - b["iterations"]) <= 3, f"{a['name']}: {a['iterations']} and {b['iterations']} iterations")


if __name__ == "__main__":
    run_parts(front, exact, body, mesh, smooth, in_time, motion, measures, mistakes, ranks)
