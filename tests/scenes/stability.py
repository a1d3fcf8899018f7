# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""perideal study stability: limits that are observed beside those predicted, maps confirmed by random points, mistakes, two processes.

    python3 stability.py [limits | motion | breaks | maps | settings | solids | certificate | mistakes | ranks] ...     (all without arguments)
"""

import csv
import functools
import json
import math
import os
import subprocess
import sys

from scene_test import SOURCE_DIR, check, check_close, check_one_message, run_driver, run_parts, run_scene, scene_text, temporary_folder, write_file
from scene_texts import body_of_bonds

PLATE = scene_text("""
Title = Plate with a crack
Dimension = 2
Models = finite elements, peridynamics, coupled
Domain/Lower corner = -1, -1
Domain/Upper corner = 1, 1
Domain/Cells = 49, 49
Boundary conditions/Dirichlet = top: 1; bottom: -1
Cracks/Segments = -0.5,0 ; 0.5,0
""")

BAR = scene_text("""
Title = Bar
Dimension = 1
Models = finite elements, peridynamics
Domain/Cells = 200
Boundary conditions/Dirichlet = left: 0; right: 1
""")

CUBE = scene_text("""
Title = Cube
Dimension = 3
Models = peridynamics
Domain/Cells = 16, 16, 16
Boundary conditions/Dirichlet = left: 0; right: 1
""")

SPLICE = scene_text("""
Title = Splice
Dimension = 2
Models = coupled
Domain/Cells = 16, 16
Boundary conditions/Dirichlet = left: 1; right: 0
Coupling/Scheme = splice
Coupling/Zone = 0.5 - x
Time/Steady = true
Output/Fields = none
""")

GRADED = scene_text("""
Title = Graded plate
Dimension = 2
Models = finite elements, coupled
Domain/Cells = 64, 64
Domain/Coarsening = 2
Cracks/Segments = 0.3,0.5 ; 0.7, 0.5
Boundary conditions/Dirichlet = top: 1; bottom: 0
""")

# Pulled apart: bonds break at many places at once, and parts come loose.
TORN = scene_text("""
Title = Torn bar
Physics = elasticity
Dimension = 1
Models = peridynamics
Elasticity/Solver = dynamics
Elasticity/Contact = false
Material/Young modulus = 100
Material/Density = 1
Material/Critical stretch = 0.01
Domain/Cells = 80
Boundary conditions/Velocity = left: -1; right: 1
""")

# Some of its bonds are broken, and nothing moves it but round-off.
FULL = body_of_bonds("""
Title = Plate that turns far
Elasticity/Solver = dynamics
Elasticity/Kinematics = full
Domain/Cells = 10, 10
Boundary conditions/Displacement = left: 0, 0
""", young=100)

FOLDER = temporary_folder()
write = functools.partial(write_file, folder=FOLDER)


def study(scene, *options, output="results", ranks=1, expect=0):
    """Compute; returns (stdout, stderr, stability.json, lines of stability.csv)."""
    directory = os.path.join(FOLDER, output)
    status, stdout, stderr = run_driver(["study", "stability", scene, "--output", directory, *options], ranks, 600, cwd=SOURCE_DIR)
    check(status == expect, f"stability {options}: exit status {status} where {expect} was expected\n{stdout[-2000:]}{stderr[-2000:]}")
    if status != 0:
        return stdout, stderr, None, None
    with open(os.path.join(directory, "stability.json")) as file:
        data = json.load(file)
    with open(os.path.join(directory, "stability.csv"), newline="") as file:
        lines = list(csv.DictReader(file))
    return stdout, stderr, data, lines


def map_of(data, name):
    """A map of stability.json."""
    found = [entry for entry in data["maps"] if entry["name"] == name]
    check(len(found) == 1, f"map {name}: {[entry['name'] for entry in data['maps']]}")
    return found[0]


def check_limits(data, at_least):
    """Steps are stable up to the predicted limit, and no farther than 3 % beyond it."""
    points = map_of(data, "step limit")["points"]
    ratios = [p["observed"] / p["predicted"] for p in points if p["predicted"] != "infinite"]
    check(len(ratios) >= at_least, f"{len(ratios)} limits")
    for point in points:
        check(point["verdict"] == "safe", f"limit: {point}")
        if point["predicted"] == "infinite":
            check(point["observed"] == "infinite", f"no limit: {point}")
    check(0.999 <= min(ratios) and max(ratios) <= 1.03, f"observed over predicted: {min(ratios)} to {max(ratios)}")


def check_confirmed(data, name, n, sides=("inside", "outside")):
    """All random points of a map are as its bound says."""
    entry = map_of(data, name)
    for side in sides:
        check(entry[side] == {"points": n, "confirmed": n}, f"{name}, {side}: {entry[side]}")


def limits():
    """Every explicit stepper of heat in 1, 2 and 3 dimensions."""
    for text, at_least, methods, more in ((PLATE, 60, 7, []), (BAR, 60, 7, []), (CUBE, 6, 4, ["--quick"])):
        scene = write("body.prm", text)
        _, _, data, lines = study(scene, "--maps", "step limit", "-s", "Models=peridynamics", *more)
        check_limits(data, at_least)
        found = {(line["method"], line["stages"]) for line in lines}
        check(len(found) == methods and {name for name, _ in found} == {"euler", "rk4", "rkc2", "chebyshev"}, f"methods: {found}")
    _, _, data, lines = study(write("plate.prm", PLATE), "--maps", "step limit, growth", "--quick", "--random", "20")
    check_limits(data, 15)
    check_confirmed(data, "growth", 20)
    check(list(lines[0])[:2] == ["map", "sample"] and list(lines[0])[-3:] == ["predicted", "observed", "verdict"], f"columns: {list(lines[0])}")
    check(data["cells"] == [21, 21] and data["cells of the scene"] == [49, 49], f"lattice: {data['cells']}")
    for point in map_of(data, "growth")["points"]:
        grows = point["step over limit"] > 1
        check(grows == (point["verdict"] == "fails") == (point["observed"] > 1), f"growth: {point}")
        if grows:  # of a field near the fastest one
            check_close(math.log(point["observed"]), math.log(point["predicted"]), relative=0.25, what=f"growth: {point}")


def motion():
    """Verlet, with bonds that never break, that may, and some of which have."""
    _, _, data, lines = study("prm/fracture/branching_crack.prm", "--maps", "step limit, growth", "--quick", "--random", "10")
    check_limits(data, 6)
    check_confirmed(data, "growth", 10)
    check({line["bonds"] for line in lines} == {"never break", "may break", "some broken"}, "fates of bonds")
    check({line["method"] for line in lines} == {"verlet"}, "methods of motion")


def breaks():
    """Neither bonds that break at once at many places nor round-off in bodies that are bent far are taken for steps that grow."""
    for text, n in ((TORN, 6), (FULL, 4)):
        _, _, data, lines = study(write("breaks.prm", text), "--maps", "step limit", "--quick")
        check_limits(data, n)


def settings():
    """Maps of bodies of their own with another m or a horizon; coarse lattices that can be halved; methods that a load does not allow."""
    plate = write("plate.prm", PLATE)
    for setting in ("Peridynamics/Horizon ratio=2", "Peridynamics/Horizon=0.16"):
        _, _, data, lines = study(plate, "--quick", "--maps", "lowest eigenvalue, heat lost by splice", "-s", setting)
        found = [sum(line["map"] == name for line in lines) for name in ("lowest eigenvalue", "heat lost by splice")]
        check(found == [20, 9], f"{setting}: {found} points")
    _, _, data, lines = study(write("graded.prm", GRADED), "--quick", "--maps", "step limit, growth")
    check(data["cells"] == [20, 20], f"cells that are halved twice: {data['cells']}")
    check_limits(data, 3)
    stdout, _, data, lines = study(write("bar.prm", BAR.replace("left: 0", "left: sin(t)")), "--quick", "--maps", "step limit")
    check_limits(data, 9)
    check({line["method"] for line in lines} == {"euler", "rk4", "rkc2"}, "methods for loads that change")
    left_out = map_of(data, "step limit")["left out"]
    check(len(left_out) == 2 and all("chebyshev" in text and "m = 0" not in text for text in left_out), f"left out: {left_out}")


def maps():
    """All maps of a coupled plate."""
    stdout, _, data, lines = study(write("plate.prm", PLATE), "--quick", "--random", "20")
    names = [entry["name"] for entry in data["maps"]]
    check(names == ["step limit", "growth", "error", "surface error", "lowest eigenvalue", "iterations", "heat lost by splice"], f"maps: {names}")
    check(not data["left out"] and stdout.count("20 of 20 random points") == 12, f"confirmed:\n{stdout}")
    for name in names[1:]:
        check_confirmed(data, name, 20)
    for line in lines:
        if line["map"] == "error":  # the note of a run says what the strip shows
            check_close(float(line["observed"]), float(line["predicted"]), absolute=1e-10, what=f"error: {line}")
        if line["map"] == "surface error" and line["treatment"] == "fictitious mirror":
            check_close(float(line["observed"]), float(line["predicted"]), relative=0.03, what=f"surface error: {line}")  # measured: 2.4 %
        if line["map"] == "lowest eigenvalue" and line["scheme"] == "exchange":
            safe = float(line["distortion"]) < 0.45
            check(line["verdict"] == ("safe" if safe else "refused") and safe == (float(line["observed"]) > 0), f"eigenvalue: {line}")
        if line["map"] == "heat lost by splice":
            check((line["scheme"] == "splice") == (float(line["observed"]) > 1e-4), f"heat: {line}")
    page, pictures = draw()
    for name in names:
        check(name.replace(" ", "_") + ".png" in pictures and f"<section id=\"{name.replace(' ', '_')}\"" in page, f"{name} in the page: {pictures}")
    check("20 of 20 random points inside the safe region are healthy" in page, "the page tells what random points say")


def draw(output="results"):
    """The figures of a study and its page."""
    directory = os.path.join(FOLDER, output)
    script = os.path.join(SOURCE_DIR, "applications", "report", "study.py")
    done = subprocess.run([os.environ.get("PERIDEAL_PYTHON", sys.executable), script, directory], capture_output=True, text=True, timeout=300,
                          env=dict(os.environ, PERIDEAL_DOTS_PER_INCH="60"))
    check(done.returncode == 0, f"figures: {done.stdout}{done.stderr}")
    with open(os.path.join(directory, "index.html"), encoding="utf-8") as file:
        return file.read(), {name for name in os.listdir(directory) if name.endswith(".png")}


def solids():
    """Equilibria have the map of iterations alone: slender cells and nearly incompressible bodies do not converge."""
    _, _, data, lines = study("prm/elasticity/coupled_crack.prm", "--quick", "--random", "5")
    check([entry["name"] for entry in data["maps"]] == ["iterations"] and len(data["left out"]) == 6, f"left out: {data['left out']}")
    check_confirmed(data, "iterations", 5)
    for line in lines:
        check((line["verdict"] == "safe") == math.isfinite(float(line["observed"])), f"iterations: {line}")
        if line["verdict"] != "refused":  # by the certificate of the coupling
            check(float(line["predicted"]) == 1000, f"allowed: {line}")
    page, pictures = draw()
    check("iterations.png" in pictures and "there are no steps" in page, f"figures of equilibria: {pictures}")


def certificate():
    """What the certificate of a splice says does not depend on the unit of the conductivity."""
    scene = write("splice.prm", SPLICE)
    faults = []
    for conductivity in ("1", "1e8"):
        run = run_scene(scene, {"Material/Conductivity": conductivity})
        faults.append([note for note in run.summary["notes"] if "a linear field comes out wrong" in note])
    check(len(faults[0]) == 1 and faults[0] == faults[1], f"notes: {faults}")


def mistakes():
    """One message, and nothing is computed."""
    plate = write("plate.prm", PLATE)
    for what, scene, options, words in (
            ("no such map", plate, ["--maps", "step limit, groth"], ["'groth'", "'growth'", "surface error"]),
            ("no maps", plate, ["--maps", ","], ["--maps"]),
            ("no map for the scene", "prm/elasticity/bar_1d.prm", ["--maps", "growth"], ["none of the maps", "growth: "]),
            ("a wrong scene", write("wrong.prm", PLATE.replace("Cells", "Celsl")), [], ["Celsl"]),
            ("--vary", plate, ["--vary", "Domain/Cells=9, 9"], ["--vary", "--maps"]),
            ("--only", plate, ["--only", "growth"], ["--only", "--maps"]),
            ("--budget", plate, ["--budget", "9"], ["work_precision"]),
            ("a negative number", plate, ["--random", "-3"], ["--random"])):
        stdout, stderr, _, _ = study(scene, *options, output="mistakes", expect=1)
        check_one_message(stdout, stderr, words, what)
    # A map without points is no success, but the others are there.
    short = ["-s", "Models=peridynamics", "-s", "Domain/Cells=1", "-s", "Peridynamics/Horizon ratio=1"]
    stdout, stderr, _, _ = study(write("bar.prm", BAR), "--maps", "growth, error", "--quick", *short, output="mistakes", expect=1)
    check("error: 18 points" in stdout and "No point" in stderr and "growth: " in stderr and "longer than the body" in stderr, f"no points:\n{stdout}{stderr}")
    for arguments in (["stability"], ["stability", plate, plate], [plate, "--random", "3"], ["work_precision", plate, "--maps", "growth"]):
        status, _, stderr = run_driver(["study", *arguments])
        check(status == 1 and "stability" in stderr, f"study {arguments}: {stderr}")


def ranks():
    """Two processes give the numbers of one."""
    scene = write("bar.prm", BAR)
    options = ["--maps", "step limit, growth", "--quick", "--random", "2"]
    one, two = study(scene, *options, output="one")[3], study(scene, *options, output="two", ranks=2)[3]
    check(len(one) == len(two) > 20, f"{len(one)} and {len(two)} lines")
    for a, b in zip(one, two):
        for key in a:
            if key not in ("observed", "predicted", "step"):
                check(a[key] == b[key], f"{key}: {a} and {b}")
        check_close(float(b["predicted"]), float(a["predicted"]), relative=1e-9, what=f"predicted: {a}")
        if float(a["observed"]) > 0.5:  # what is damped quickly ends in round-off
            check_close(float(b["observed"]), float(a["observed"]), relative=5e-3, what=f"observed: {a}")
    # A file that cannot be written ends both, and is no property of a coupling.
    os.makedirs(os.path.join(FOLDER, "blocked", ".stability_mesh.msh"))
    _, stderr, _, _ = study(write("graded.prm", GRADED), "--maps", "lowest eigenvalue", "--quick", output="blocked", ranks=2, expect=1)
    check(stderr.count("perideal: error") == 1 and "cannot write" in stderr, f"one message:\n{stderr}")


if __name__ == "__main__":
    run_parts(limits, motion, breaks, maps, settings, solids, certificate, mistakes, ranks)
