# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Run scenes and check what they write.

    from scene_test import PD, check_close, run_parts, run_scene

    def plate():
        run = run_scene("prm/quick_start.prm", {"Domain/Cells": "20, 20"}, ranks=2)
        check_close(run.probe(PD, (0, 0.1), time=0.5), 12.34, relative=0.01, what="T at (0, 0.1)")

    if __name__ == "__main__":
        run_parts(plate)

A failed check is printed and counted, and the script goes on; finish() ends it with exit status 1 if any failed. A scene
that should have run and did not ends the script at once.

Where PERIDEAL_SERVE is set, as ctest does unless a test says EACH_ALONE, the scenes of a script are computed one after the other by
`perideal serve`, one for each number of processes; else each by a program of its own.
"""

import atexit
import csv
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile

SOURCE_DIR = os.environ.get(
    "PERIDEAL_SOURCE_DIR", os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))
sys.path.insert(0, os.path.join(SOURCE_DIR, "python"))
import perideal  # noqa: E402
from perideal.program import environment, on_processes  # noqa: E402

EXECUTABLE = perideal.find_program()
SERVE = os.environ.get("PERIDEAL_SERVE", "")
# Several tests run at once on few cores (tests/CMakeLists.txt).
os.environ.update(OMPI_MCA_hwloc_base_binding_policy="none", PRTE_MCA_hwloc_default_binding_policy="none", OMPI_MCA_mpi_yield_when_idle="1")

# Models, and what many scripts set.
FE, PD, COUPLED = "finite elements", "peridynamics", "coupled"
BC = "Boundary conditions/"
QUIET = {"Output/Fields": "none"}

# What a user should never see.
TRACES = ("Stacktrace", "An error occurred in line", "terminate called", "Segmentation fault", "Signal:",
          "*** Process received signal", "Additional information", "MPI_ABORT")

_checks = {"passed": 0, "failed": 0}
_folders = []


class Run:
    """What a run of perideal left behind. Tables are read when they are asked for."""

    def __init__(self, folder, returncode, stdout, stderr):
        self.folder = folder
        self.returncode = returncode
        self.stdout = stdout
        self.stderr = stderr

    @property
    def summary(self):
        with open(os.path.join(self.folder, "summary.json")) as file:
            return json.load(file)

    def model(self, name):
        """The part of the summary about one model."""
        return self.summary["models"][name]

    def table(self, name):
        """The rows of a csv file as dictionaries; what reads as a number is one."""
        with open(os.path.join(self.folder, name), newline="") as file:
            return [{key: _value(text) for key, text in row.items()} for row in csv.DictReader(file)]

    @property
    def probes(self):
        return self.table("probes.csv")

    @property
    def line(self):
        return self.table("line.csv")

    @property
    def totals(self):
        return self.table("totals.csv")

    def total(self, quantity, model, time=None):
        """One number of totals.csv; without a time the last one written."""
        rows = [row for row in self.totals if row["model"] == model and row["quantity"] == quantity
                and (time is None or math.isclose(row["time"], time, rel_tol=1e-9, abs_tol=1e-12))]
        if not rows:
            raise SystemExit(f"no row '{quantity}' of {model} at time {time} in {self.folder}/totals.csv")
        return rows[-1]["value"]

    def rows(self, model, point=None, time=None, table="probes.csv"):
        """The rows of a model, at one point and one time if given."""
        found = []
        for row in self.table(table):
            here = [row[axis] for axis in "xyz" if axis in row]
            if row["model"] != model:
                continue
            if point is not None and not all(math.isclose(a, b, rel_tol=1e-9, abs_tol=1e-12) for a, b in zip(here, point)):
                continue
            if time is not None and not math.isclose(row["time"], time, rel_tol=1e-9, abs_tol=1e-12):
                continue
            found.append(row)
        return found

    def along_line(self, model, time=None, column="value"):
        """The numbers of line.csv from its start to its end; without a time at the last one written."""
        rows = self.rows(model, time=time, table="line.csv")
        if not rows:
            raise SystemExit(f"no row for {model} at time {time} in {self.folder}/line.csv")
        last = rows[-1]["time"]
        return [row[column] for row in rows if row["time"] == last]

    def error(self, model, time=None, kind="relative l2"):
        """The error against the exact solution; without a time at the last one written."""
        for when, value in reversed(self.model(model)["errors"][kind]):
            if time is None or math.isclose(when, time, rel_tol=1e-9, abs_tol=1e-12):
                return value
        raise SystemExit(f"no error of {model} at time {time} in {self.folder}/summary.json")

    def probe(self, model, point, time=None, column="value"):
        """One number of probes.csv; without a time the last one written."""
        rows = self.rows(model, point, time)
        if not rows:
            raise SystemExit(f"no row for {model} at {point}, time {time} in {self.folder}/probes.csv")
        return rows[-1][column]


def _value(text):
    try:
        return float(text)
    except (TypeError, ValueError):
        return text


def command_and_environment(arguments, ranks=1):
    """How the program is started with any arguments, on any number of processes."""
    return on_processes([EXECUTABLE] + list(arguments), ranks), environment()


def run_perideal(arguments, ranks=1, timeout=3000, cwd=None):
    """Run the program with any arguments; returns (exit status, stdout, stderr)."""
    command, variables = command_and_environment(arguments, ranks)
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=timeout, cwd=cwd,
                          env=variables)
    return done.returncode, done.stdout, done.stderr


def run_driver(arguments, ranks=1, timeout=3000, cwd=None):
    """As run_perideal() by `python3 -m perideal`, which has studies that the program alone does not have."""
    words = [sys.executable, "-m", "perideal", *arguments] + (["-n", str(ranks)] if ranks > 1 else [])
    variables = dict(environment(), PYTHONPATH=os.path.join(SOURCE_DIR, "python"))
    done = subprocess.run(words, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=timeout, cwd=cwd, env=variables)
    return done.returncode, done.stdout, done.stderr


_servers = {}  # by number of processes


def _serve(ranks, arguments, timeout):
    """As run_perideal() by a program that executes one command after the other; one that has ended is started again."""
    if ranks not in _servers:
        _servers[ranks] = perideal.Server(ranks)
    return _servers[ranks].call(arguments, timeout, cwd=SOURCE_DIR)


@atexit.register
def _stop_servers():
    for server in _servers.values():
        server.close()


def scene_text(lines):
    """The text of a scene from lines `Section/Entry = value`, named as in overrides; lines next to each other share a section."""
    text, inside = [], []

    def enter(sections):
        common = len(os.path.commonprefix([sections, inside]))
        for depth in reversed(range(common, len(inside))):
            text.append("  " * depth + "end")
        for depth, section in enumerate(sections[common:], common):
            text.append("  " * depth + f"subsection {section}")
        inside[:] = sections

    for line in filter(str.strip, lines.splitlines()):
        name, value = line.split("=", 1)
        *sections, entry = name.strip().split("/")
        enter(sections)
        text.append("  " * len(sections) + f"set {entry} = {value.strip()}")
    enter([])
    return "\n".join(text) + "\n"


def temporary_folder():
    """A folder that finish() removes."""
    _folders.append(tempfile.mkdtemp(prefix="perideal_"))
    return _folders[-1]


def write_file(name, text, folder=None):
    """Into a temporary folder, unless one is given; returns the path."""
    path = os.path.join(folder or temporary_folder(), name)
    with open(path, "wb") as file:
        file.write(text if isinstance(text, bytes) else text.encode())
    return path


def run_scene(scene, overrides=None, ranks=1, expect_error=False, keep=False, timeout=3000, alone=False, check_status=True):
    """Run a scene in a fresh folder.

    scene: a path within the repository, an absolute path, or the text of a scene (if it has several lines).
    overrides: {"Section/Entry": value}. ranks: number of processes.
    expect_error: the run has to end with exit status 1, one message and no trace, else with 0. keep: leave the folder there.
    alone: by a program of its own, whatever PERIDEAL_SERVE says. check_status: a run that fails ends the script.
    """
    folder = tempfile.mkdtemp(prefix="perideal_")
    if keep:
        print(f"kept: {folder}")
    else:
        _folders.append(folder)
    if "\n" in scene:
        path = write_file("scene.prm", scene, folder)
    else:
        path = scene if os.path.isabs(scene) else os.path.join(SOURCE_DIR, scene)
    results = os.path.join(folder, "results")
    settings = {"Output directory": results}
    settings.update(overrides or {})
    settings_list = [f"{entry}={value}" for entry, value in settings.items()]
    arguments = ["run", path] + [word for setting in settings_list for word in ("-s", setting)]
    if SERVE and not alone:
        status, stdout, stderr = _serve(ranks, arguments, timeout)
    else:
        status, stdout, stderr = run_perideal(arguments, ranks, timeout, cwd=SOURCE_DIR)
    run = Run(settings["Output directory"], status, stdout, stderr)
    if expect_error:
        check_clean_error(run, f"{scene if len(scene) < 80 else 'scene'} {overrides or ''}")
    elif status != 0 and check_status:
        print(stdout[-4000:], stderr[-4000:], sep="\n")
        raise SystemExit(f"FAILED: {' '.join(arguments)} on {ranks} process(es) ended with exit status {status}")
    return run


def check_clean_error(run, what="the run"):
    """Exit status 1, a message, and nothing that looks like a crash: no signal, no stack, no text of deal.II's exceptions."""
    text = run.stdout + run.stderr
    check(run.returncode == 1, f"{what}: exit status {run.returncode} where 1 was expected\n{text[-2000:]}")
    check(run.stderr.strip() != "", f"{what}: no message on stderr")
    check_no_traces(text, what)


def check_no_traces(text, what, *more):
    """Nothing that a user should never see, nor what more is given."""
    for trace in TRACES + more:
        check(trace not in text, f"{what}: '{trace}' in the output\n{text[-2000:]}")


def check_message(run, *words, what="the run"):
    """The message of a failed run, or a text, names all these words."""
    message = getattr(run, "stderr", run)
    for word in words:
        check(word in message, f"{what}: the message does not say {word!r}:\n{message[-2000:]}")


def check_one_message(stdout, stderr, words, what):
    """One message that says all words, and no trace of a crash."""
    check(stderr.count("perideal: error") == 1, f"{what}: one message, found\n{stdout[-1500:]}{stderr[-1500:]}")
    check_no_traces(stdout + stderr, what, "An error occurred", "Signal", "internal error", "json.exception")
    check_message(stderr, *words, what=what)


def check(condition, message):
    """Count a check; print the message if it failed."""
    _checks["passed" if condition else "failed"] += 1
    if not condition:
        print(f"FAILED: {message}", flush=True)
    return bool(condition)


def check_close(value, expected, relative=0.0, absolute=0.0, scale=None, what="value"):
    """|value - expected| <= max(relative * |scale|, absolute); the scale is the expected value unless given.

    Where the expected value is near zero, give the size of the field as scale. Sequences are compared number by number,
    with the largest expected one as the scale. Returns the error divided by the scale.
    """
    values = list(value) if hasattr(value, "__iter__") else [value]
    wanted = list(expected) if hasattr(expected, "__iter__") else [expected]
    if not check(len(values) == len(wanted) and len(values) > 0,
                 f"{what}: {len(values)} numbers where {len(wanted)} were expected"):
        return math.inf
    if scale is None:
        scale = max(abs(w) for w in wanted)
    worst, error = max(enumerate(abs(v - w) if math.isfinite(v) else math.inf for v, w in zip(values, wanted)),
                       key=lambda pair: pair[1])
    allowed = max(relative * abs(scale), absolute)
    share = error / abs(scale) if scale else error
    ok = check(error <= allowed, f"{what}: {values[worst]:.12g} where {wanted[worst]:.12g} was expected; error {error:.3g}"
                                 f" ({share:.3g} relative), allowed {allowed:.3g}")
    if ok:
        print(f"ok: {what}: {values[worst]:.10g}, expected {wanted[worst]:.10g}, relative error {share:.2e}", flush=True)
    return share


def check_less(value, limit, what="value"):
    """value <= limit, and printed."""
    if check(value <= limit, f"{what}: {value:.6g} is more than {limit:.6g}"):
        print(f"ok: {what}: {value:.4g} <= {limit:.4g}", flush=True)


def observed_orders(sizes, errors):
    """The orders of convergence between neighbours: log(e1/e2)/log(h1/h2)."""
    return [math.log(errors[k] / errors[k + 1]) / math.log(sizes[k] / sizes[k + 1]) for k in range(len(sizes) - 1)]


def fitted_order(sizes, errors):
    """The order of convergence by least squares through all points, as papers report it."""
    x, y = [math.log(size) for size in sizes], [math.log(error) for error in errors]
    mean_x, mean_y = sum(x) / len(x), sum(y) / len(y)
    return sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y)) / sum((a - mean_x) ** 2 for a in x)


def relative_difference(found, exact):
    """|found - exact| / |exact| in the 2-norm, every number counting alike (equation 13 of Bobaru and Duangpanya 2012)."""
    return math.sqrt(sum((a - b) ** 2 for a, b in zip(found, exact))) / math.sqrt(sum(b * b for b in exact))


class Comparison:
    """A table of what was obtained and what it was compared with, printed at the end; each row is checked."""

    def __init__(self, title):
        self.title = title
        self.rows = []

    def add(self, what, obtained, reference, relative=None, absolute=None):
        """Obtained and reference differ by less than a share of the reference, or by less than a number."""
        gap = obtained - reference if relative is None else obtained / reference - 1
        bound = absolute if relative is None else relative
        if not check(abs(gap) <= bound, f"{what}: {obtained:.10g} where {reference:.10g} was expected"):
            what += "  <- FAILED"
        kind = "" if relative is None else " rel."
        self.rows.append((what, f"{obtained:.8g}", f"{reference:.8g}", f"{gap:+.1e}{kind}", f"{bound:.1e}"))

    def add_limit(self, what, obtained, limit):
        """Obtained is not negative and less than a number."""
        if not check(0 <= obtained <= limit, f"{what}: {obtained:.10g}, allowed {limit:.10g}"):
            what += "  <- FAILED"
        self.rows.append((what, f"{obtained:.3e}", "0", f"{obtained:.1e}", f"{limit:.1e}"))

    def show(self):
        print_table(self.title, ("what", "obtained", "reference", "gap", "bound"), self.rows)


def print_table(title, columns, rows):
    """Print a table; numbers that are not whole are printed with six digits."""
    texts = [[cell if isinstance(cell, str) else f"{cell:.6g}" for cell in row] for row in rows]
    widths = [max(len(column), *(len(row[k]) for row in texts), 1) for k, column in enumerate(columns)]
    print(f"\n{title}")
    for row in [list(columns)] + texts:
        print("  " + "  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip(), flush=True)


def run_parts(*parts, **on_demand):
    """Run the parts that the arguments of the script name, and finish.

    parts: functions, which all run where there are no arguments; on_demand: more of them, by name.
    """
    named = {**{part.__name__: part for part in parts}, **on_demand}
    for name in sys.argv[1:] or [part.__name__ for part in parts]:
        if name not in named:
            sys.exit(f"no part '{name}' among {', '.join(named)}")
        named[name]()
    finish()


def finish():
    """Remove the folders, print the number of checks and end the script."""
    for folder in _folders:
        shutil.rmtree(folder, ignore_errors=True)
    print(f"{_checks['passed']} checks passed, {_checks['failed']} failed")
    sys.exit(1 if _checks["failed"] or not _checks["passed"] else 0)


def _selftest():
    """The helpers themselves, and that the program starts and answers."""
    check_close([1.0, 2.0], [1.0, 2.0 + 1e-9], relative=1e-8, what="two numbers")
    check_close(observed_orders([1, 0.5, 0.25], [1, 0.25, 0.0625]), [2, 2], absolute=1e-12, what="orders")
    status, stdout, _ = run_perideal(["--help"])
    check(status == 0 and "run" in stdout, "perideal --help")
    status, _, stderr = run_perideal(["run", "there_is_no_such_scene.prm"])
    check(status == 1 and "there_is_no_such_scene.prm" in stderr, f"a missing scene: {stderr}")
    _selftest_of_server()
    finish()


def _selftest_of_server():
    """Scenes one after the other in one process give what programs of their own give, after a failure, too; a server that is gone comes back."""
    scene, small = "prm/quick_start.prm", {"Domain/Cells": "20, 20", "Output/Fields": "none", "Time/Stepper": "chebyshev"}
    for ranks in (1, 2):
        alone = run_scene(scene, small, ranks, alone=True)
        for name in ("first", "after a failure", "after the end of the process"):
            run = run_scene(scene, small, ranks)
            check([row["value"] for row in run.probes] == [row["value"] for row in alone.probes], f"{name}, {ranks} process(es): the same digits")
            check(run.stdout.splitlines()[0] == alone.stdout.splitlines()[0], f"{name}: {run.stdout[:300]}")
            if name == "first":
                run = run_scene(scene, {**small, "Domain/Cells": "many"}, ranks, expect_error=True)
                check_message(run, "'Cells'", "needs 2 numbers")
            elif ranks == 1 and ranks in _servers:
                _servers[ranks].process.kill()
                check(run_scene(scene, small, ranks, check_status=False).returncode != 0, "the end of a server is seen")


if __name__ == "__main__":
    _selftest()
