# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""perideal study work_precision: costs, errors, the front and what is dominated, on one process and on two; mistakes.

    python3 work_precision.py [front | exact | mistakes | ranks] ...     (all without arguments)
"""

import csv
import json
import math
import os
import subprocess
import sys
import tempfile

from scene_test import SOURCE_DIR, check, check_close, check_less, finish, run_perideal

PLATE = """
set Title = Small plate with a crack
set Dimension = 2
subsection Domain
  set Lower corner = -1, -1
  set Upper corner = 1, 1
  set Cells = 17, 17
end
subsection Boundary conditions
  set Dirichlet = top: 1; bottom: -1
end
subsection Cracks
  set Segments = -0.5,0 ; 0.5,0
end
subsection Time
  set Steady = true
end
"""

BAR = """
set Dimension = 1
subsection Boundary conditions
  set Dirichlet = left: 0; right: 1
end
subsection Time
  set Steady = true
end
"""

FOLDER = tempfile.mkdtemp(prefix="perideal_work_")
SMALL = ["--cells", "9, 9 | 17, 17", "--budget", "8000"]


def write(name, text):
    path = os.path.join(FOLDER, name)
    with open(path, "w") as file:
        file.write(text)
    return path


def study(scene, *options, output="results", ranks=1, expect=0):
    """Compute; returns (stdout, stderr, directory)."""
    directory = os.path.join(FOLDER, output)
    status, stdout, stderr = run_perideal(["study", "work_precision", scene, "--output", directory, *options], ranks, 600, cwd=SOURCE_DIR)
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
    check([line["name"] for line in lines] == list(rows), "the rows of both files")
    for line in lines:
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
    check(again.count(": kept") == len(rows) + 3, "nothing is computed twice")

    # The charts.
    script = os.path.join(SOURCE_DIR, "applications", "report", "study.py")
    done = subprocess.run([os.environ.get("PERIDEAL_PYTHON", sys.executable), script, directory], capture_output=True, text=True)
    check(done.returncode == 0, f"study.py: {done.stderr}")
    for name in ("error_over_work.png", "error_over_wall_time.png"):
        path = os.path.join(directory, name)
        check(os.path.exists(path) and os.path.getsize(path) > 20000, name)
    page = open(os.path.join(directory, "index.html"), encoding="utf-8").read()
    check("The Pareto front" in page and "Dominated settings" in page, "the page has the tables")


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
    """Bodies that deform: the error of the displacement at the nodes, against a solution and, without, against finite elements with the crack on faces."""
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


def mistakes():
    """One message, and nothing is computed."""
    plate = write("plate.prm", PLATE)
    oblique = PLATE.replace("-0.5,0 ; 0.5,0", "-0.5,-0.2 ; 0.5,0.3")
    for what, scene, options, words in (
            ("no crack", PLATE.replace("set Segments = -0.5,0 ; 0.5,0", ""), [], ["no crack", "'Segments'"]),
            ("one dimension", BAR, [], ["'Dimension' is 1"]),
            ("nothing to compare with", oblique, [], ["'Solution'", "along the axes"]),
            ("a crack on no lattice", PLATE.replace("-0.5,0 ; 0.5,0", "-0.5,0 ; 0.4142135623,0"), [], ["'Solution'", "ends of all cracks"]),
            ("a share of bonds", PLATE.replace("0.5,0\n", "0.5,0\n  set Transmission = 0.5\n"), [], ["'Transmission'", "'Contact conductance'"]),
            ("no condition", PLATE.replace("set Dirichlet", "set Flux"), [], ["'Dirichlet'"]),
            ("no numbers", None, ["--cells", "9, 9 | a, b"], ["--cells", "'a'", "separated by '|'"]),
            ("one lattice", None, ["--cells", "9, 9"], ["--cells", "needs 2"]),
            ("coarser lattices", None, ["--cells", "17, 17 | 9, 9"], ["--cells", "not finer"]),
            ("one number", None, ["--cells", "9 | 17"], ["--cells", "has 1 number"]),
            ("reference off the crack", None, ["--reference", "9, 9 | 18, 18 | 36, 36"], ["--reference", "three lattices"]),
            ("no budget", None, ["--budget", "0"], ["--budget"]),
            ("entry of the study", None, ["-s", "Domain/Cells=9, 9"], ["'Domain/Cells=9, 9'", "varies"]),
            ("--vary", None, ["--vary", "Domain/Cells=9, 9"], ["--vary", "--cells"]),
            ("--only without the reference", None, [*SMALL, "--only", "FEM, pairs"], ["'reference, 24 x 24'", "--only"])):
        path = plate if scene is None else write("wrong.prm", scene)
        stdout, stderr, _ = study(path, *options, output="mistakes", expect=1)
        check(stderr.count("perideal: error") == 1, f"{what}: one message, found\n{stdout}{stderr}")
        for word in words:
            check(word in stderr, f"{what}: the message does not say {word!r}:\n{stderr}")
    for arguments in (["work_precision"], ["work_precision", plate, plate], [plate, "--cells", "9, 9 | 17, 17"]):
        status, _, stderr = run_perideal(["study", *arguments])
        check(status == 1 and "work_precision" in stderr, f"study {arguments}: {stderr}")
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


def main():
    parts = {part.__name__: part for part in (front, exact, body, mistakes, ranks)}
    for name in sys.argv[1:] or parts:
        parts[name]()
    finish(FOLDER)


if __name__ == "__main__":
    main()
