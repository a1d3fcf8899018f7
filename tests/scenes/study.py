# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""perideal study: rows give the numbers of single runs, an interrupted study goes on, failures and mistakes are told, figures are drawn.

    python3 study.py [numbers | resume | failures | mistakes | ranks | figures] ...     (all without arguments)
"""

import csv
import json
import os
import signal
import subprocess
import sys
import time

from scene_test import EXECUTABLE, SOURCE_DIR, check, check_close, check_one_message, run_parts, run_perideal, run_scene, scene_text, temporary_folder, write_file

PLATE = scene_text("""
Title = Small plate
Dimension = 2
Domain/Cells = 12, 12
Initial and source/Initial value = sin(pi*x)*sin(pi*y)
Boundary conditions/Dirichlet = left: 0; right: 0; bottom: 0; top: 0
Time/End time = 0.01
Output/Fields = none
Output/Probes = 0.5,0.5 ; 0.25,0.5
Output/Write at = 0.005, 0.01
Reference/Solution = sin(pi*x)*sin(pi*y)*exp(-2*pi^2*t)
""")

BAR = scene_text("""
Title = Bar
Dimension = 1
Domain/Cells = 40
Peridynamics/Horizon ratio = 4
Peridynamics/Kernel = constant
Boundary conditions/Dirichlet = left: 0; right: 1
Time/Steady = true
Output/Fields = none
""")

SWEEP = {"Domain/Cells": ["12, 12", "24, 24"], "Peridynamics/Horizon ratio": [2, 3]}
# Columns that differ from run to run or with the number of processes.
MEASURED = {"set-up time", "stepping time", "wall time", "peak memory", "memory", "processes"}


class Workshop:
    """A folder with two scenes, a study file, and its results."""

    def __init__(self, study):
        self.folder = temporary_folder()
        self.write("plate.prm", PLATE)
        self.write("bar.prm", BAR)
        self.output = os.path.join(self.folder, "results")
        self.file = self.write("a study.json", study if isinstance(study, str) else json.dumps(study))

    def write(self, name, text):
        return write_file(name, text, self.folder)

    def run(self, *options, ranks=1, expect=0):
        """Compute the study; returns (stdout, stderr)."""
        status, stdout, stderr = run_perideal(["study", self.file, "--output", self.output, *options], ranks, 600)
        check(status == expect, f"study {options}: exit status {status} where {expect} was expected\n{stdout[-2000:]}{stderr[-2000:]}")
        return stdout, stderr

    def lines(self):
        """study.csv."""
        with open(os.path.join(self.output, "study.csv"), newline="") as file:
            return list(csv.DictReader(file))

    def json(self):
        with open(os.path.join(self.output, "study.json")) as file:
            return json.load(file)

    def row_file(self, row, name="row.json"):
        """A file of a row, by the row's name."""
        folder = next(r["folder"] for r in self.json()["rows"] if r["name"] == row)
        return os.path.join(self.output, folder, name)


def without_measures(summary):
    """A summary without wall times and memory of the process."""
    if isinstance(summary, dict):
        return {k: without_measures(v) for k, v in summary.items() if k not in ("wall time", "peak memory")}
    return summary


def numbers():
    """A sweep gives what single runs give, and rows do not know of each other."""
    study = Workshop({"rows": [{"name": "first", "scene": "plate.prm"},
                               {"name": "plates", "scene": "plate.prm", "group": "plates", "vary": SWEEP, "set": {"Solver/Tolerance": 1e-9}},
                               {"name": "bar", "scene": "bar.prm", "x": 3.5},
                               {"name": "again", "scene": "plate.prm", "x": "Domain/Cells"}]})
    stdout, _ = study.run()
    check("[7/7] again: " in stdout and stdout.count("\n[") == 6, f"progress lines: {stdout}")
    lines, whole = study.lines(), study.json()
    names = list(dict.fromkeys(line["name"] for line in lines))
    wanted = ["first", "plates, Cells = 12, 12, Horizon ratio = 2", "plates, Cells = 12, 12, Horizon ratio = 3",
              "plates, Cells = 24, 24, Horizon ratio = 2", "plates, Cells = 24, 24, Horizon ratio = 3", "bar", "again"]
    check(names == wanted, f"names and order: {names}")
    for cells in SWEEP["Domain/Cells"]:
        for m in SWEEP["Peridynamics/Horizon ratio"]:
            single = run_scene(PLATE, {"Domain/Cells": cells, "Peridynamics/Horizon ratio": m, "Solver/Tolerance": 1e-9})
            name = f"plates, Cells = {cells}, Horizon ratio = {m}"
            row = next(r for r in whole["rows"] if r["name"] == name)
            for model in ("finite elements", "peridynamics"):
                alone = single.model(model)
                line = [x for x in lines if x["name"] == name and x["model"] == model][-1]
                check(line["Domain/Cells"] == cells and line["Peridynamics/Horizon ratio"] == str(m) and line["group"] == "plates",
                      f"{name}: entries are columns: {line}")
                for key in ("unknowns", "bonds", "nonzeros", "steps", "operator applications", "iterations"):
                    check(line[key] == str(alone.get(key, "")), f"{name}, {model}: {key} {line[key]!r} {alone.get(key)!r}")
                check(float(line["relative l2 error"]) == float(f"{single.error(model):.15g}"), f"{name}, {model}: error")
                check(float(line["maximum error"]) == float(f"{single.error(model, kind='maximum'):.15g}"), f"{name}, {model}: maximum")
                check(row["models"][model]["errors"] == alone["errors"], f"{name}, {model}: errors over time")
                check(row["models"][model]["boundary flux"] == alone["boundary flux"], f"{name}, {model}: boundary flux")
                check(line["time"] == "0.01", f"{name}, {model}: the last line is at the end: {line['time']}")
                check(sum(x["name"] == name and x["model"] == model for x in lines) == 2, f"{name}, {model}: a line for each time")
            found = [(p["time"], p["model"], *p["coordinates"], p["value"]) for p in row["probes"]]
            check(found == [(p["time"], p["model"], p["x"], p["y"], p["value"]) for p in single.probes], f"{name}: probes")
            check(row["totals"] == single.totals, f"{name}: totals")
    # Nothing is left over from one row to the next.
    summaries = [json.load(open(study.row_file(name, "summary.json"))) for name in ("first", "again")]
    check(without_measures(summaries[0]) == without_measures(summaries[1]), "the same scene first and last gives the same numbers")
    bar = next(line for line in lines if line["name"] == "bar" and line["model"] == "peridynamics")
    check(bar["x"] == "3.5" and bar["Peridynamics/Horizon ratio"] == "4" and bar["relative l2 error"] == "", f"bar: {bar}")
    check(lines[-1]["x"] == "12, 12", f"x may name an entry: {lines[-1]['x']}")

    # The same from the command line, several scenes, and repeats.
    output = os.path.join(study.folder, "line")
    plate, bar = os.path.join(study.folder, "plate.prm"), os.path.join(study.folder, "bar.prm")
    status, stdout, stderr = run_perideal(
        ["study", plate, "--vary", "Domain/Cells=12, 12 | 24, 24", "--vary", "Peridynamics/Horizon ratio=2|3", "-s", "Solver/Tolerance=1e-9",
         "--output", output, "--repeat", "2"])
    check(status == 0, f"study on the command line: {stderr}")
    with open(os.path.join(output, "study.csv"), newline="") as file:
        repeated = list(csv.DictReader(file))
    check([x["name"] for x in repeated[::4]] == [n.replace("plates", "plate") for n in wanted[1:5]], "the first varies slowest")
    swept = [line for line in lines if line["name"].startswith("plates")]
    for key in ("unknowns", "bonds", "relative l2 error", "maximum error", "imbalance"):
        check([x[key] for x in repeated] == [x[key] for x in swept], f"the same {key} from a file and from the command line")
    check(all(x["repeats"] == "2" for x in repeated), "repeats are a column")
    row = json.load(open(os.path.join(output, "rows", "plate_Cells_12_12_Horizon_ratio_2", "row.json")))
    for model in row["models"].values():
        times = model["times"]
        check(0 < times["total"] and times["set-up"] + times["stepping"] <= times["total"] * (1 + 1e-12), f"smallest times: {times}")
    status, _, stderr = run_perideal(["study", plate, bar, "--output", os.path.join(study.folder, "both"), "-q"])
    check(status == 0, f"two scenes: {stderr}")


def stamps(study):
    """{row: (time of row.json, its text)} of finished rows."""
    found = {}
    rows = os.path.join(study.output, "rows")
    for folder in sorted(os.listdir(rows)):
        path = os.path.join(rows, folder, "row.json")
        if os.path.exists(path):
            with open(path) as file:
                found[folder] = (os.stat(path).st_mtime_ns, file.read())
    return found


def resume():
    """Finished rows stay, whatever ended the study; changed ones are computed again."""
    study = Workshop({"rows": [{"name": "small", "scene": "plate.prm", "quick": True},
                               {"name": "cells", "scene": "plate.prm", "set": {"Time/Stepper": "euler"},
                                "vary": {"Domain/Cells": ["120, 120", "122, 122", "124, 124", "126, 126"]}}]})
    environment = dict(os.environ, OMP_NUM_THREADS="1", OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    process = subprocess.Popen([EXECUTABLE, "study", study.file, "--output", study.output], stdout=subprocess.DEVNULL,
                               stdin=subprocess.DEVNULL, env=environment)
    end = time.time() + 120
    while time.time() < end and process.poll() is None and not os.path.exists(
            os.path.join(study.output, "rows", "cells_Cells_120_120", "row.json")):
        time.sleep(0.005)
    process.send_signal(signal.SIGKILL)
    process.wait()
    before = stamps(study)
    check(2 <= len(before) < 5, f"killed in the middle: {sorted(before)}")
    with open(os.path.join(study.output, "study.csv"), newline="") as file:
        check(len(list(csv.DictReader(file))) >= 4, "study.csv of the rows before")
    stdout, _ = study.run()
    after = stamps(study)
    check(len(after) == 5 and all(after[row] == stamp for row, stamp in before.items()), "finished rows are untouched")
    check(stdout.count(": kept") == len(before), f"kept rows are named: {stdout}")
    check(len({line["name"] for line in study.lines()}) == 5, "all rows are in the table")

    stdout, _ = study.run()
    check(stdout.count(": kept") == 5 and stamps(study) == after, "nothing to do")
    study.run("--only", "small", "--redo")
    redone = stamps(study)
    check([row for row in after if redone[row] != after[row]] == ["small"], "--redo with --only")
    check(len({line["name"] for line in study.lines()}) == 5, "--only leaves the other rows in the table")

    # --quick and --only in a fresh folder, then the rest.
    study.output += "_2"
    stdout, _ = study.run("--quick")
    check("[1/1] small: " in stdout and sorted(stamps(study)) == ["small"], f"--quick: {stdout}")
    not_computed = [r["name"] for r in study.json()["rows"] if not r["status"]]
    check(len(not_computed) == 4, f"rows that were not asked for: {not_computed}")
    study.run("--only", "cells, Cells = 120, 120")
    check(sorted(stamps(study)) == ["cells_Cells_120_120", "small"], f"--only: {sorted(stamps(study))}")

    # A changed scene, settings, a broken summary, more repeats: computed again. Another name of the
    # folder: not.
    small = Workshop({"rows": [{"name": "a", "scene": "plate.prm"}, {"name": "b", "scene": "bar.prm"}]})
    small.run()
    first = stamps(small)
    small.write("plate.prm", PLATE.replace("End time = 0.01", "End time = 0.02"))
    stdout, _ = small.run()
    check("b: kept" in stdout and "a: kept" not in stdout, f"changed scene: {stdout}")
    check(stamps(small)["b"] == first["b"] and stamps(small)["a"] != first["a"], "only the changed scene is computed again")
    check([x["time"] for x in small.lines() if x["name"] == "a"][-1] == "0.02", "with its new end time")
    stdout, _ = small.run("-s", "Solver/Tolerance=1e-8")
    check("kept" not in stdout, f"changed settings: {stdout}")
    small.run()
    with open(small.row_file("b", "summary.json"), "a") as file:
        file.write(" ")
    stdout, _ = small.run()
    check("a: kept" in stdout and "b: kept" not in stdout, f"touched summary: {stdout}")
    with open(small.row_file("b"), "w") as file:
        file.write("{ broken")
    stdout, _ = small.run()
    check("a: kept" in stdout and "b: kept" not in stdout, f"broken row.json: {stdout}")
    stdout, _ = small.run("--repeat", "2")
    check("kept" not in stdout, f"more repeats: {stdout}")
    stdout, _ = small.run()
    check(stdout.count("kept") == 2, f"fewer repeats: {stdout}")
    os.rename(small.output, small.output + "_moved")
    small.output += "_moved"
    stdout, _ = small.run()
    check(stdout.count("kept") == 2, f"moved results: {stdout}")


def failures():
    """Rows that fail, on purpose or not."""
    study = Workshop({"rows": [{"name": "early", "scene": "plate.prm", "fails": True, "set": {"Domain/Cells": "many"}},
                               {"name": "too large a step", "scene": "plate.prm", "set": {"Time/Stepper": "euler", "Time/Time step": 1}},
                               {"name": "refused", "scene": "plate.prm", "fails": True, "set": {"Time/Stepper": "rk4", "Time/Time step": 1}},
                               {"name": "good", "scene": "plate.prm"}]})
    for ranks in (1, 2):
        stdout, stderr = study.run(ranks=ranks, expect=1)
        check_one_message(stdout, stderr, ["1 of 4 rows", "too large a step: failed", "'Time step'"], f"a failed row on {ranks}")
        check("early:" not in stderr and "good:" not in stderr, f"only rows that failed are listed: {stderr}")
        status = {line["name"]: line["status"] for line in study.lines()}
        check(status == {"early": "failed as expected", "too large a step": "failed", "refused": "failed as expected", "good": "finished"},
              f"status: {status}")
        with open(study.row_file("too large a step")) as file:
            row = json.load(file)
        check(row["status"] == "failed" and "'Time step'" in row["message"], f"the message is in row.json: {row}")
        check("failed: 'Time step'" in stdout and "failed as expected: " in stdout, f"progress: {stdout}")
    stdout, stderr = study.run("--only", "good", "refused", "early")
    check("good: kept" not in stdout, "rows of another number of processes are computed again: their times are others")
    stdout, stderr = study.run("-s", "Time/Time step=1e-5", expect=1)
    check_one_message(stdout, stderr, ["refused: did not fail"], "a row that should fail and did not")
    stdout, _ = study.run("-q", "--only", "good")
    check(stdout == "", f"--quiet prints nothing: {stdout}")


ROW = '{"name": "a", "scene": "plate.prm"%s}'
ONE = '{"rows": [' + ROW + ']%s}'

MISTAKES = [  # (what, text of the study, words of the message); more in tests/unit/study_test.cc
    ("no JSON", '{\n "rows": [\n }', [":3:", "no JSON"]),
    ("no text", ' \n', ["is empty"]),
    ("a list", '[]', ["array"]),
    ("missing scene", '{"rows": [{"name": "a", "scene": "plat.prm"}]}', ["row 'a'", "'scene'", "'plat.prm'", "Did you mean 'plate.prm'?"]),
    ("unknown entry", ONE % (', "set": {"Domain/Cels": "8, 8"}', ""), ["row 'a'", "'set'", "'Domain/Cels'", "Did you mean 'Domain/Cells'?"]),
    ("value that the scene refuses", ONE % (', "set": {"Time/End time": "soon"}', ""), ["row 'a'", "'End time'", "'soon'"]),
    ("combination that the scene refuses", ONE % (', "vary": {"Peridynamics/Horizon ratio": [2, 50]}', ""),
     ["'a, Horizon ratio = 50'", "'Horizon ratio'", "longer than the body"]),
    ("too many rows", ONE % (', "vary": {' + ", ".join(
        f'"{entry}": {list(range(1, 60))}' for entry in ("Time/End time", "Material/Density", "Material/Conductivity")) + "}", ""), ["10000 rows"]),
]

OPTIONS = [  # (what, options after the study file, words of the message)
    ("unknown row", ["--only", "aa"], ["'aa'", "Did you mean 'a'?"]),
    ("no quick row", ["--quick"], ["--quick", '"quick"']),
    ("unknown option", ["--rdo"], ["--rdo", "Did you mean '--redo'?"]),
    ("no repeats", ["--repeat", "0"], ["--repeat", "1 to 1000"]),
    ("override without a value", ["-s", "Domain/Cells"], ["'Domain/Cells'", "Section/Entry=value"]),
    ("override of an unknown entry", ["-s", "Domain/Cels=8, 8"], ["Did you mean 'Domain/Cells'?"]),
    ("override of what varies", ["-s", "Domain/Cells=9, 9"], ["'Domain/Cells=9, 9'", "varies"]),
    ("--vary with a study file", ["--vary", "Domain/Cells=8, 8"], ["--vary", '"vary"']),
    ("output that is a file", None, ["cannot use", "--output"]),
    ("output with a #", ["--output", "results/a#b"], ["must not contain #"]),
]


def mistakes():
    """Mistakes are found before the first row is computed."""
    for what, text, words in MISTAKES:
        study = Workshop(text)
        stdout, stderr = study.run(expect=1)
        check_one_message(stdout, stderr, ["a study.json"] + words, what)
        check(not os.path.exists(study.output), f"{what}: nothing was computed")
    late = Workshop('{"rows": [' + ROW % "" + ', {"name": "b", "scene": "plate.prm", "set": {"Time/End time": -1}}]}')
    for ranks in (1, 2):
        stdout, stderr = late.run(ranks=ranks, expect=1)
        check_one_message(stdout, stderr, ["row 'b'", "'End time'"], "a mistake in the last row")
        check(not os.path.exists(late.output), "the first row was not computed")
    stdout, stderr = Workshop('{"rows": [{"name": "a", "scene": "plat.prm"}]}').run(ranks=2, expect=1)
    check_one_message(stdout, stderr, ["Did you mean 'plate.prm'?"], "a missing scene on two processes")

    study = Workshop(ONE % (', "vary": {"Domain/Cells": ["8, 8"]}', ""))
    for what, options, words in OPTIONS:
        if options is None:
            options = ["--output", study.write("a_file", "")]
        stdout, stderr = run_perideal(["study", study.file] + (["--output", study.output] if "--output" not in options else []) + options)[1:]
        check_one_message(stdout, stderr, words, what)
    plate = os.path.join(study.folder, "plate.prm")
    for arguments, words in (([], ["files", "required"]), (["nothing.json"], ["'nothing.json'"]), (["nothing.prm"], ["'nothing.prm'"]),
                             ([study.folder + "/"], ["no scene"]), ([study.file, plate], ["one file"]),
                             ([plate, "--vary", "Domain/Cells"], ["Section/Entry=value | value"]),
                             ([plate, "--vary", "Domain/Cells=8, 8 |"], ["empty value"]),
                             ([plate, "--vary", "Domain/Cels=8, 8"], ["Did you mean 'Domain/Cells'?"]),
                             ([plate, "--vary", "Domain/Cells=8, 8", "--vary", "Domain/Cells=9, 9"], ["twice"])):
        status, stdout, stderr = run_perideal(["study", *arguments, "--output", study.output])
        check(status == 1, f"study {arguments}: exit status {status}")
        check_one_message(stdout, stderr, words, f"study {arguments}")


def ranks():
    """Two processes give the table of one."""
    study = Workshop({"rows": [{"name": "plates", "scene": "plate.prm", "vary": SWEEP}, {"name": "bar", "scene": "bar.prm"}]})
    study.run()
    one = study.lines()
    study.output += "_2"
    stdout, _ = study.run(ranks=2)
    check(stdout.count("[1/5]") == 1, f"one process speaks: {stdout}")
    two = study.lines()
    check(len(one) == len(two), "as many lines")
    for a, b in zip(one, two):
        for column in a:
            if column in MEASURED:
                continue
            if a[column] == b[column]:
                continue
            if column == "imbalance":
                check(abs(float(a[column]) - float(b[column])) < 1e-9, f"imbalance: {a[column]} {b[column]}")
                continue
            # finite elements sum in another order; the steady bar is solved to 1e-10
            check_close(float(b[column]), float(a[column]), relative=1e-8, what=f"{a['name']}, {a['model']}: {column}")
    check(all(x["processes"] == "2" for x in two), "the number of processes is a column")


def figures():
    """applications/report/study.py."""
    os.environ["PERIDEAL_DOTS_PER_INCH"] = "200"  # the size of a file tells that something is drawn
    study = Workshop({"title": "A study <of> plates", "text": "Its text & more.", "rows": [
        {"name": "plates", "scene": "plate.prm", "vary": {"Domain/Cells": ["10, 10", "20, 20", "40, 40"], "Models": ["finite elements", "peridynamics"]}},
        {"name": "kernels", "scene": "plate.prm", "group": "kernels", "vary": {"Peridynamics/Kernel": ["constant", "conical"]}},
        {"name": "refused", "scene": "plate.prm", "fails": True, "set": {"Time/Time step": 1, "Time/Stepper": "euler"}}],
        "figures": [
            {"name": "error", "title": "Errors", "x": "Domain/Cells", "y": "relative l2 error", "log": True, "lines": ["model"]},
            {"name": "cost", "x": "wall time", "y": "maximum error", "log": True},
            {"name": "kernels", "x": "Peridynamics/Kernel", "y": "peak memory", "lines": "group"},
            {"name": "time", "x": "time", "y": "relative l2 error", "lines": ["name", "model"]},
            {"name": "balance", "x": "unknowns", "y": "imbalance", "log": True},
            {"name": "nothing", "x": "x", "y": "bonds"}]})
    study.run()
    script = os.path.join(SOURCE_DIR, "applications", "report", "study.py")
    python = os.environ.get("PERIDEAL_PYTHON", sys.executable)

    def draw(folder, expect=0):
        done = subprocess.run([python, script, folder], capture_output=True, text=True)
        check(done.returncode == expect, f"study.py: exit status {done.returncode}\n{done.stderr}")
        check("Traceback" not in done.stderr, done.stderr)
        return done

    draw(study.output)
    for name in ("error", "cost", "kernels", "time", "balance"):
        path = os.path.join(study.output, name + ".png")
        check(os.path.exists(path) and os.path.getsize(path) > 10000 and open(path, "rb").read(8) == b"\x89PNG\r\n\x1a\n", f"{name}.png")
    check(not os.path.exists(os.path.join(study.output, "nothing.png")), "no figure without numbers")
    page = open(os.path.join(study.output, "index.html"), encoding="utf-8").read()
    for text in ("A study &lt;of&gt; plates", "Its text &amp; more.", "9 of 9 rows", "failed as expected", "Cells = 40, 40", "no row has both"):
        check(text in page, f"the page does not say {text!r}")
    check(page.count("<img ") == 5 and "<script" not in page, "five figures, no script")

    # Without figures of its own: the error over what varies. Rows that are missing are named.
    bare = Workshop({"rows": [{"name": "m", "scene": "plate.prm", "vary": {"Peridynamics/Horizon ratio": [2, 3, 4]}},
                              {"name": "later", "scene": "plate.prm"}]})
    bare.run("--only", "m")
    draw(bare.output)
    check(os.path.getsize(os.path.join(bare.output, "relative_l2_error.png")) > 10000, "the default figure")
    check("Not computed: later" in open(os.path.join(bare.output, "index.html"), encoding="utf-8").read(), "missing rows are named")
    check("study.json" in draw(bare.folder, 1).stderr, "a folder without a study")

    # The example that comes along.
    output = os.path.join(bare.folder, "example")
    status, _, stderr = run_perideal(["study", "prm/studies/delta_convergence.json", "--output", output], cwd=SOURCE_DIR)
    check(status == 0, f"delta_convergence: {stderr}")
    draw(output)
    sys.path.insert(0, os.path.dirname(script))
    from study_figures import collect, slope  # needs matplotlib, as study.py does
    data = json.load(open(os.path.join(output, "study.json")))
    lines, _ = collect(data, data["figures"][0])
    for group, order in (("finite elements", 2), ("cut-off families", 1), ("mirrored nodes", 2)):
        check_close(-slope(lines[group]), order, absolute=0.05, what=f"order of {group}")


if __name__ == "__main__":
    run_parts(numbers, resume, failures, mistakes, ranks, figures)
