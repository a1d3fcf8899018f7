# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""The Python package: fronts and lattices of its studies, runs, results, servers, mistakes, interrupts.

    python3 python_package.py [fronts | lattices | maps | results | runs | serve | errors | stopped | example] ...     (all without arguments)
"""

import json
import math
import os
import re
import signal
import subprocess
import sys
import time

import numpy as np

from scene_test import FE, PD, SOURCE_DIR, check, check_close, environment, run_driver, run_parts, scene_text, temporary_folder, write_file
import perideal
from perideal.program import call, command, settings
from perideal.stability.scene import Point as MapPoint, Random, coarse_cells
from perideal.stability.tables import Result, RandomPoint, describe, stability_csv
from perideal.work_precision import lattice
from perideal.work_precision.driver import Relay
from perideal.work_precision.pareto import Point, cost_at_error, dominates, dominating, front, observed_order, order_of_differences, richardson
from perideal.words import did_you_mean, full_precision, number_text, readable_count

PLATE = scene_text("""
Title = Small plate
Dimension = 2
Models = finite elements, peridynamics
Domain/Lower corner = -1, -1
Domain/Upper corner = 1, 1
Domain/Cells = 13, 13
Boundary conditions/Dirichlet = top: 1; bottom: -1
Cracks/Segments = -0.5,0 ; 0.5,0
Time/Steady = true
Output/Probes = 0, 0.5 ; 0, -0.5
""")
BODY = scene_text("""
Physics = elasticity
Dimension = 2
Models = finite elements
Domain/Cells = 4, 3
Material/Young modulus = 1
Material/Poisson ratio = 0.25
Boundary conditions/Displacement = left: 0, 0; right: 0.1, 0
Output/Fields = hdf5, vtu
""")
# Takes minutes if nobody stops it.
LONG = {"Domain/Cells": "40, 40", "Time/Steady": "false", "Time/End time": "1e4", "Time/Stepper": "euler", "Output/Fields": "none"}


def fronts():
    """Costs and errors: the front, what dominates, orders, the cost of an error."""
    points = [Point(*pair) for pair in ((10, 0.1), (5, 0.2), (20, 0.1), (7, 0.3), (40, 0.01), (5, 0.2), (50, 0.05), (5, 0.25))]
    check(dominates(points[0], points[2]) and dominates(points[1], points[7]), "as wrong and dearer; as dear and more wrong")
    check(not dominates(points[1], points[5]) and not dominates(points[0], points[1]), "the same, and others")
    check(front(points) == [1, 5, 0, 4] and front([]) == [], f"front: {front(points)}")
    check(dominating(points) == [None, None, 0, 1, None, None, 4, 1], f"dominating: {dominating(points)}")
    check(dominating([Point(1, 0.5), Point(2, 0.1), Point(3, 0.6)]) == [None, None, 0], "the cheapest of those that dominate is named")

    check_close(observed_order([0.4, 0.2, 0.1], [0.32, 0.08, 0.02]), 2, absolute=1e-12, what="order of three")
    check_close(observed_order([0.2, 0.1], [0.3, 0.15]), 1, absolute=1e-12, what="order of two")
    for spacings, errors in (([0.1], [0.1]), ([0.1, 0.1], [0.1, 0.2]), ([0.2, 0.1], [0.1, 0]), ([], [])):
        check(math.isnan(observed_order(spacings, errors)), f"no order in {spacings}, {errors}")
    check_close(order_of_differences(0.4, 0.1), 2, absolute=1e-12, what="order of differences")
    check(math.isnan(order_of_differences(0, 0)) and order_of_differences(1, 0) == math.inf, "differences that are zero")
    limit = richardson(np.array([3 + 5 * 2 ** 1.5]), np.array([8.0]), 1.5)  # 3 + 5 h^1.5 on h = 2, 1
    check_close(limit, [3], absolute=1e-12, what="the limit")

    family = [Point(100, 1), Point(1000, 0.1), Point(10000, 0.01)]  # error = 100/cost
    for error, kind, cost, beyond in ((0.05, "interpolated", 2000, 1), (0.1, "interpolated", 1000, 1), (0.001, "extrapolated", 1e5, 10), (2, "at most", 100, 1)):
        found = cost_at_error(family, error)
        check(found.kind == kind, f"error {error}: {found}")
        check_close([found.cost, found.beyond], [cost, beyond], relative=1e-12, what=f"cost of {error}")
    check(cost_at_error(family, 0.0009).kind == "none", "too far")
    found = cost_at_error([Point(1, 0.01), Point(10, 0.2), Point(100, 0.02)], 0.05)
    check(found.kind == "interpolated" and found.cost > 10, f"a lucky coarse point does not count: {found}")
    for first in (10, 12):  # two that cost the same, as wall times may; one that costs less
        check(cost_at_error([Point(first, 0.2), Point(10, 0.05), Point(40, 0.02)], 0.1) == ("at most", 10, 1), f"hardly dearer than {first}")
    for flat in ([Point(1, 0.2), Point(10, 0.2)], [Point(1, 0.2)], []):
        check(cost_at_error(flat, 0.1).kind == "none", f"no gain at the end, one point, none: {flat}")
    check((number_text(0.1), number_text(2e6), number_text(1 / 3), readable_count(1234567), full_precision(-math.nan)) ==
          ("0.1", "2e+06", "0.333333333333", "1,234,567", "nan"), "numbers as the program writes them")
    check(did_you_mean("openings", ("field", "opening")) == " Did you mean 'opening'?" and did_you_mean("xyz", ("field",)) == "", "names")


def lattices():
    """Ladders, lattices with cracks on cell faces, bonds, errors at nodes."""
    check(lattice.parse_ladder(" 21, 21|41,41 | 81, 81 ", "--cells", 2, 2) == [(21, 21), (41, 41), (81, 81)], "a ladder")
    check(lattice.parse_ladder("4,5,6", "--cells", 3, 1) == [(4, 5, 6)], "a lattice")
    for wrong in ("", "21, 21", "21 | 41", "21, x | 41, 41", "21, 21 | 21, 41", "0, 2 | 3, 3", "21, 21 | 41, 41, 41", "-2, 4 | 8, 8"):
        try:
            lattice.parse_ladder(wrong, "--cells", 2, 2)
            check(False, f"'{wrong}' is taken for a ladder")
        except perideal.Error as error:
            check("--cells" in str(error) and "separated by '|'" in str(error), f"{wrong}: {error}")
    for cells, ladder in (((161, 161), [(21, 21), (41, 41), (81, 81), (161, 161)]), ((160, 81), [(20, 11), (40, 21), (80, 41), (160, 81)]),
                          ((20, 20), [(10, 10), (20, 20)]), ((6, 6), [(6, 6)])):
        check(lattice.default_ladder(cells, 4) == ladder, f"halving {cells} keeps odd and even: {lattice.default_ladder(cells, 4)}")

    def facts(crack, dim=2):
        box = {"Domain/Lower corner": [-1] * dim, "Domain/Upper corner": [1] * dim, "Domain/Cells": [9] * dim, "Dimension": dim, "Models": FE}
        return perideal.describe(write_file("plate.prm", PLATE), {**box, "Output/Probes": "", f"Cracks/{'Segments' if dim == 2 else 'Rectangles'}": crack,
                                                                  **({"Cracks/Segments": ""} if dim == 3 else {})})

    plate = facts("-0.5,0 ; 0.5,0")
    check(plate["cracks along axes"] and plate["cracks"] == [[[-0.5, 0], [0.5, 0]]], f"facts: {plate}")
    for cells, on_faces, multiple, fitting in (((41, 41), True, 1, (40, 40)), ((22, 22), True, 1, (20, 22)), ((41, 41), False, 1, (41, 41)),
                                               ((41, 41), False, 8, (40, 40)), ((37, 37), True, 2, (40, 36))):
        found = lattice.nearest_fitting(plate, cells, on_faces, multiple)
        check(found == fitting, f"nearest to {cells}: {found}, expected {fitting}")
    check(lattice.nearest_fitting(facts("-0.5,0 ; 3,0"), (41, 41), True, 1) == (40, 40), "a crack that leaves the box")
    for crack, along in (("-0.5,0 ; 0.5,0.1", False), (f"{-math.sqrt(0.2)},0 ; 0.5,0", True)):
        found = facts(crack)
        check(found["cracks along axes"] == along and lattice.nearest_fitting(found, (41, 41), True, 1) is None, f"{crack}: on no lattice")
    check(lattice.estimated_bonds(plate, (41, 41), 3) == 0.5 * 42 * 42 * 36, "36 neighbours nearer than 3.5 spacings")

    # A 2 x 2 lattice: the middle counts four times as much as a corner, twice as much as a side.
    one = np.ones(9)
    for place, error in ((4, math.sqrt(1 / 4)), (0, math.sqrt(1 / 16)), (1, math.sqrt(1 / 8))):
        check_close(lattice.nodal_error(one + (np.arange(9) == place), one, (2, 2)), error, absolute=1e-14, what=f"error at node {place}")
    check_close(lattice.nodal_error(one, 0 * one, (2, 2)), 1, absolute=1e-14, what="without a reference")
    gap = np.where(np.arange(9) == 4, math.nan, 1)
    check_close(lattice.nodal_error(2 * one, gap, (2, 2), with_gaps=True), 1, absolute=1e-14, what="a gap does not count")


def maps():
    """Coarse lattices, random numbers, tables of maps; questions about a model."""
    for cells, n_halvings, coarse in (((49, 49), 0, [21, 21]), ((64, 64), 2, [20, 20]), ((200,), 0, [60]), ((16, 16, 16), 0, [8, 8, 8]), ((10, 7), 0, [10, 7]),
                                      ((1,), 0, [1])):
        check(coarse_cells(cells, n_halvings) == coarse, f"{cells}: {coarse_cells(cells, n_halvings)}, expected {coarse}")
    random = Random(1)
    check([random.next(), random.next()] == [1791095845, 4282876139], "the numbers of std::mt19937")
    check(Random(1).uniform(2, 4) == 2 + 2 * 1791095845 / 2 ** 32 and Random(1).any_of("abc") == "abc"[1791095845 % 3], "of a range, of a list")

    class Steps:
        name = "step limit"

    points = [MapPoint({"method": "euler", "stages": None, "m": 2.0}, 1.0, 1.02, "safe"), MapPoint({"method": "a, b", "stages": 3}, math.inf, math.nan, "fails")]
    result = Result(Steps(), "", points, [RandomPoint(True, points[0]), RandomPoint(False, points[0])], ["this"])
    check(stability_csv([result]) == 'map,sample,method,stages,m,predicted,observed,verdict\nstep limit,grid,euler,,2,1,1.02,safe\n'
          'step limit,grid,"a, b",3,,inf,nan,fails\nstep limit,inside,euler,,2,1,1.02,safe\nstep limit,outside,euler,,2,1,1.02,safe\n', stability_csv([result]))
    check(describe(result) == ["  step limit: 2 points, 1 fails, 1 safe (0 s)", "    observed over predicted: 1.02 to 1.02", "    1 of 1 random points inside are healthy",
                               "    0 of 1 random points outside are not healthy", "    left out: this"], f"{describe(result)}")

    plate = write_file("plate.prm", PLATE)
    for question, words in (('{"ask": "weather"}', "no question 'weather'"), ("steps", "no question"), ('{"ask": "heat"}', "no question"),
                            ('{"ask": "flow", "side": "top"}', "not for this model")):
        scene = plate if "flow" not in question else write_file("body.prm", BODY)
        answer = call(["check", scene, "-s", "Models=finite elements", "--ask", question])
        check(answer.status == 1 and words in answer.errors, f"{question}: {answer}")
    answer = call(["check", plate, "-s", "Models=finite elements", "--ask", '{"ask": "flow", "side": "top"}'])
    flux = perideal.run(plate, {"Models": FE, "Output/Fields": "none"}).summary["models"][FE]["boundary flux"]["top"]
    check_close(json.loads(answer.output)["flow"], flux, relative=1e-9, what="a flow")


def results():
    """Tables and fields as arrays, HDF5 and vtu alike."""
    plate = perideal.run(PLATE, {"Output/Fields": "hdf5"})
    check(plate.models == [FE, PD] and plate.summary["status"] == "complete" and "Results" in plate.output, f"{plate.models}")
    with open(plate.folder / "probes.csv") as file:
        lines = [line.split(",") for line in file.read().splitlines()]
    check(list(plate.probes) == lines[0] and [f"{value:.15g}" for value in plate.probes["value"]] == [line[-1] for line in lines[1:]], "probes")
    above = perideal.select(plate.probes, model=FE, y=0.5)
    check(len(above["value"]) == 1 and 0 < above["value"][0] < 1, f"above the crack: {above}")
    flows = perideal.select(plate.totals, model=PD, quantity="heat flow through top")
    check_close(flows["value"][-1], plate.summary["models"][PD]["boundary flux"]["top"], relative=1e-12, what="a total")
    check(plate.line == {} and perideal.select({}, model=FE) == {}, "a table that was not written")
    nodes, cells, field = (plate.field(name, PD) for name in ("nodes", "cells", "temperature"))
    check(nodes.shape == (4 * 169, 2) and cells.shape == (169, 4) and field.shape == (4 * 169,), f"{nodes.shape}, {cells.shape}, {field.shape}")
    check_close(field[nodes[:, 1] == 1], np.ones(26), absolute=1e-12, what="temperature on top")
    check(list(plate.times) == [entry["time"] for entry in plate.summary["fields"]], "times")
    try:
        plate.field("pressure")
        check(False, "a field that is not there")
    except KeyError as error:
        check("temperature" in str(error), f"{error}")

    both = perideal.run(BODY)
    vtu = perideal.run(BODY, {"Output/Fields": "vtu"})
    check(set(both.fields()) >= {"nodes", "cells", "displacement"} and both.field("displacement").shape == (48, 3), f"{list(both.fields())}")
    check(vtu.field("displacement").shape == (48, 3) and vtu.field("cells").shape == (12, 4), f"vtu: {vtu.fields().keys()}")
    for name in ("nodes", "displacement"):
        width = both.field(name).shape[1]
        check_close(vtu.field(name)[:, :width].ravel(), both.field(name).ravel(), absolute=1e-6, what=f"vtu: {name}")  # Float32
    two = perideal.run(BODY, {"Output/Fields": "vtu"}, processes=2)
    check_close(np.sort(two.field("displacement").ravel()), np.sort(both.field("displacement").ravel()), absolute=1e-6, what="vtu of two processes")
    try:
        perideal.read(temporary_folder())
        check(False, "a folder without results")
    except FileNotFoundError as error:
        check("summary.json" in str(error), f"{error}")


def runs():
    """Scenes as files and texts, overrides in both forms, folders, processes."""
    folder = temporary_folder()
    kept = perideal.run(write_file("plate.prm", PLATE), ["Domain/Cells=11, 11", "Models=peridynamics"], folder=os.path.join(folder, "kept"))
    check(str(kept.folder) == os.path.join(folder, "kept") and kept.models == [PD] and kept.summary["models"][PD]["unknowns"] == 144, f"{kept}")
    again = perideal.run(PLATE, {"Domain/Cells": (11, 11), "Models": PD, "Output/Fields": "none"}, processes=2)
    check_close(again.probes["value"], kept.probes["value"], relative=1e-9, what="two processes")
    check(again.fields() == {} and perideal.read(kept.folder).summary == kept.summary, "read again")
    place = again.folder
    del again
    check(not place.exists() and kept.folder.exists(), "a temporary folder goes with its results")
    check(settings({"A/B": True, "C": [1, 2.5]}) == ["A/B=true", "C=1, 2.5"], "values as scenes have them")
    facts = perideal.describe(os.path.join(SOURCE_DIR, "prm/elasticity/wave_in_bar.prm"))
    check(facts["moves"] and facts["wave speed"] > 0 and facts["exact solution"] and not facts["steady"], f"facts: {facts}")
    answer = run_driver(["--version"])
    check(answer[0] == 0 and answer[1].startswith("PeriDeal "), f"python3 -m perideal: {answer}")


def serve():
    """One start for many commands: the same results, whatever happened before; lines that are no requests."""
    plate = write_file("plate.prm", PLATE)
    alone = perideal.run(plate)
    for processes in (1, 2):
        with perideal.Server(processes) as server:
            first = server.run(plate)
            running = server.process.pid
            for overrides, words in (({"Domain/Cells": "many"}, "'Cells'"), ({"Modles": PD}, "Modles")):
                try:
                    server.run(plate, overrides)
                    check(False, f"{overrides} are computed")
                except perideal.Error as error:
                    check(words in str(error) and error.status == 1, f"{overrides}: {error}")
            second = server.run(PLATE, {"Models": PD})
            check(server.process.pid == running, "mistakes do not end a server")
            check_close(second.probes["value"], perideal.select(alone.probes, model=PD)["value"], relative=1e-9, what="after mistakes")
            check(processes > 1 or list(first.probes["value"]) == list(alone.probes["value"]), "the same digits")
            check(server.describe(plate)["cells"] == [13, 13] and server.call(["--version"]).output.startswith("PeriDeal"), "other commands")
            answer = server.call(["serve"])
            check(answer.status == 1 and "cannot be a server" in answer.errors, f"a server in a server: {answer}")
            folder = temporary_folder()
            answer = server.call(["run", plate, "-s", "Output directory=here", "-q"], cwd=folder)
            check(answer == (0, "", "") and os.path.exists(os.path.join(folder, "here", "summary.json")), f"the working directory: {answer}")
            if processes == 1:
                server.process.kill()
                server.process.wait()
                check(server.call(["--version"]).status == 0, "one that is gone is started again")
        check(server.process is None, "closed")
    # The protocol itself.
    lines = ["no JSON", "{}", '{"arguments": ["--version"]}', '{"arguments": "run"}', '{"arguments": ["run", "no.prm"]}',
             '{"arguments": ["--version"], "output": "/no/such/folder/file"}', '{"arguments": ["--version"], "directory": "/no/such/folder"}']
    done = subprocess.run(command(["serve"]), input="\n".join(lines), capture_output=True, text=True, env=environment())
    answers = [json.loads(line) for line in done.stdout.splitlines()]
    check(done.returncode == 0 and [answer["status"] for answer in answers] == [1, 1, 0, 1, 1, 1, 1], f"{answers}")
    check("no request" in answers[0]["message"] and "no.prm" in answers[4]["message"] and answers[2]["message"] == "", f"{answers}")
    check("PeriDeal" in done.stderr and "no.prm" in done.stderr, f"without files all is said on standard error: {done.stderr}")


def errors():
    """The program's own words."""
    plate = write_file("plate.prm", PLATE)
    overrides = {"Peridynamics/Kernel": "conicla"}
    said = call(["run", plate, "-s", "Peridynamics/Kernel=conicla"]).errors
    for what, action in (("run", lambda: perideal.run(plate, overrides)), ("a text", lambda: perideal.run(PLATE, overrides)),
                         ("describe", lambda: perideal.describe(plate, overrides)), ("two processes", lambda: perideal.run(plate, overrides, processes=2))):
        try:
            action()
            check(False, f"{what}: computed")
        except perideal.Error as error:
            check(error.status == 1 and "conicla" in str(error) and f"perideal: error: {error}" in said.replace(plate, "scene.prm") + said,
                  f"{what}: {error}\n{said}")
    variables = dict(os.environ, PERIDEAL_EXECUTABLE="/no/such/program", PYTHONPATH=os.path.join(SOURCE_DIR, "python"))
    done = subprocess.run([sys.executable, "-c", "import perideal; perideal.run('x.prm')"], capture_output=True, text=True, env=variables)
    check(done.returncode == 1 and "/no/such/program" in done.stderr, f"no program: {done.stderr}")
    # What is wrong with rows may come in pieces, and is kept for the end.
    for words in (["\\nperideal: ", "error: no\\n"], ["row 1\\n", "\\nperideal: error: ", "no\\n"], ["\\nper", "ideal: error: no", "\\n"]):
        said = subprocess.Popen(["sh", "-c", "; ".join(f"printf '{word}' >&2; sleep 0.1" for word in words)], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        relay = Relay(said, quiet=True)
        said.wait()
        relay.wait()
        check(relay.mistake == "\nperideal: error: no\n", f"{words}: {relay.mistake!r}")


def stopped():
    """Ctrl-C ends a server in a run and at rest, and a study in order."""
    plate = write_file("plate.prm", PLATE)
    for request in ({"arguments": ["run", plate, "-s", f"Output directory={temporary_folder()}/results", *(
            word for setting in settings(LONG) for word in ("-s", setting))]}, None):
        process = subprocess.Popen(command(["serve"]), stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment())
        process.stdin.write(json.dumps(request or {"arguments": ["--version"]}) + "\n")
        process.stdin.flush()
        while request and "peridynamics: stepper" not in process.stderr.readline():
            pass
        time.sleep(1 if request else 0)
        line = "" if request else process.stdout.readline()
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=60)
        check(process.returncode == 3 and "interrupt" in err, f"a server after an interrupt: {process.returncode}, {line}{out}{err}")
        check(not request or json.loads(out)["status"] == 3, f"the answer to a run that was stopped: {out}")
    variables = dict(environment(), PYTHONPATH=os.path.join(SOURCE_DIR, "python"))
    for number, reason in ((signal.SIGINT, "an interrupt (SIGINT)"), (signal.SIGUSR1, "a request to stop (SIGUSR1)")):
        words = [sys.executable, "-m", "perideal", "study", "stability", plate, "-s", "Time/Steady=false", "--output", temporary_folder()]
        process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=variables)
        process.stdout.readline()
        process.send_signal(number)
        _, err = process.communicate(timeout=60)
        check(process.returncode == 3 and err == f"\nperideal: stopped by {reason}.\n", f"maps after a signal: {process.returncode}, {err}")
    words = [sys.executable, "-m", "perideal", "study", "work_precision", plate, "--no-auto", "--cells", "9, 9 | 17, 17", "--output", temporary_folder()]
    process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=variables)
    while "[3/" not in process.stdout.readline():
        pass
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=60)
    check(process.returncode == 3 and "Traceback" not in err and "interrupt" in err, f"a study after an interrupt: {process.returncode}, {err}")
    done = subprocess.run(words, capture_output=True, text=True, env=variables)
    check(done.returncode == 0 and ": kept" in done.stdout and "Pareto front" in done.stdout, f"and goes on: {done.stdout[-500:]}{done.stderr}")


def example():
    """The example of doc/python.md."""
    with open(os.path.join(SOURCE_DIR, "doc/python.md"), encoding="utf-8") as file:
        code = re.search(r"```python\n(.*?)```", file.read(), re.S).group(1)
    figure = os.path.join(temporary_folder(), "two_horizons.png")
    code = code.replace("two_horizons.png", figure)
    variables = dict(environment(), PYTHONPATH=os.path.join(SOURCE_DIR, "python"))
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=SOURCE_DIR, env=variables)
    jumps = [float(number) for number in re.findall(r"jumps by ([0-9.]+) across", done.stdout)]
    check(done.returncode == 0 and os.path.getsize(figure) > 10000, f"example: {done.stdout}{done.stderr}")
    check(len(jumps) == 2 and 70 < jumps[0] < 110 and 70 < jumps[1] < 110 and jumps[0] != jumps[1], f"jumps across the crack: {jumps}")


if __name__ == "__main__":
    run_parts(fronts, lattices, maps, results, runs, serve, errors, stopped, example)
