# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Bonds that break: strength against Griffith, energies, motion.

    fracture.py plate | beside | interfaces | block | bend | mesh | motion | steps | symmetry | oblique | straight | scatter | criteria
    fracture.py fine_plate | fine_block | fine_motion | more_oblique      the scenes on their own lattices; the others take one of half the cells a side

Bounds that follow from no theory are at most 1.6 times the gap that was measured; the comment beside them says which.
"""

import math
import os

from crack_rows import write_mesh
from scene_test import PD, SOURCE_DIR, Comparison, check, check_close, check_less, check_message, run_parts, run_scene

QUIET = {"Output/Fields": "none", "Output/Write at": ""}
YOUNG, ENERGY = 200, 0.01
BROKEN, DISSIPATED = "broken bonds", "energy dissipated"


def history(run, *quantities, model=PD):
    """Rows (time, value of each quantity) of all load steps."""
    times = {}
    for row in run.totals:
        if row["model"] == model:
            times.setdefault(row["time"], {})[row["quantity"]] = row["value"]
    return [(t, *(times[t][q] for q in quantities)) for t in sorted(times)]


def griffith(half, width, young=YOUNG):
    """Strength of a strip with a crack in its middle, finite width by Feddersen."""
    return math.sqrt(young * ENERGY / (math.pi * half / math.cos(math.pi * half / width)))


def largest(run, quantity, model=PD):
    """Of all rows: of a time at which bonds break there may be two, the first before they do."""
    return max(row["value"] for row in run.totals if row["model"] == model and row["quantity"] == quantity)


def strength(run, area, model=PD):
    return largest(run, "force on top in y", model) / area


def energy_kept(table, what, run, bound):
    rows = history(run, "energy imbalance", "work of loads and supports")
    table.add_limit(f"{what}: energy imbalance over work", max(abs(row[1]) for row in rows) / rows[-1][2], bound)


HALF = {"Domain/Cells": "40, 80"}


def plate(lattice=HALF, delta=0.1, left_over=2e-3):
    """A plate with a crack in its middle: Griffith's strength within 10 % at m = 4, for any Poisson ratio, and the crack runs through."""
    table = Comparison(f"Plate with a crack, m = 4, delta = {delta}, half length 0.2")
    # Measured: 0.985, 0.971, 0.973 and 0.973; on the scene's own lattice 0.982 for nu = 1/3.
    for settings in ({}, {"Material/Poisson ratio": "0"}, {"Material/Poisson ratio": "0.45"},
                     {"Material/Poisson ratio": "0.3", "Elasticity/Plane": "strain"}):
        more = {"Boundary conditions/Displacement": "top: 0, 0.012*t; bottom: 0, -0.012*t", "Solver/Tolerance": "1e-8", **settings} if settings else {}
        run = run_scene("prm/fracture/centre_crack.prm", {**QUIET, **lattice, **more})
        young = YOUNG / (1 - 0.3 ** 2) if "Elasticity/Plane" in settings else YOUNG
        table.add(f"{settings or 'nu = 1/3'}: strength over Griffith's", strength(run, 1) / griffith(0.2, 1, young), 1, absolute=0.1)
        # Measured: at most 7.4e-8 and 9.9e-10; nodes beside the ends of the crack touch at first, and cease to within a step.
        energy_kept(table, f"{settings or 'nu = 1/3'}", run, 1.2e-7 if settings else 1.6e-9)
        left = run.model(PD)["boundary force"]["top"][1]
        table.add_limit(f"{settings or 'nu = 1/3'}: force left at the end over strength", abs(left) / strength(run, 1), left_over)  # measured: at most 1.3e-3 and 6.2e-4
    # A row of the equilibrium at which a step is divided, before it breaks: without it 1.488 in place of 1.607.
    coarse = run_scene("prm/fracture/centre_crack.prm", {**QUIET, **lattice, "Time/Time step": "0.1"})
    table.add("nu = 1/3, steps of 0.1: strength over Griffith's", strength(coarse, 1) / griffith(0.2, 1, YOUNG), 1, absolute=0.1)
    first = coarse.model(PD)["first broken bonds"]
    check(0.8 < first < 0.9 and any(abs(row["time"] - first) < 1e-9 for row in coarse.totals), f"steps of 0.1: the first bonds broke at t = {first}")
    table.show()


def fine_plate():
    plate({}, 0.05, 1e-3)


def beside():
    """The plate with bonds beside finite elements: the load at which the crack gets through the next column of nodes."""
    columns = 35
    table = Comparison(f"Plate with a crack, coupled, m = 4, {columns} cells across")
    # Measured: 0.939 and 1.016.
    for nu in ("0", "0.45"):
        run = run_scene("prm/fracture/centre_crack.prm", {
            **QUIET, "Models": "coupled", "Coupling/Zone": "follow", "Domain/Nodes": "vertices", "Domain/Cells": f"{columns}, {2 * columns + 1}",
            "Material/Poisson ratio": nu, "Time/Time step": "0.02", "Time/End time": "0.96"})
        left = history(run, "force on top in y", model="coupled")[-1][1]
        # Energy is released by whole columns: Griffith's load is that of the crack in the middle of its step.
        table.add(f"nu = {nu}: strength over Griffith's", strength(run, 1, "coupled") / griffith(0.2 + 0.5 / columns, 1), 1, absolute=0.1)
        table.add_limit(f"nu = {nu}: force left at the end over strength", abs(left) / strength(run, 1, "coupled"), 0.05)
    # Two cells at the sides come loose: with a multigrid of what is left, made without any hold for them, no equilibrium was found at t = 1.05.
    # Steps are divided where a bond is stretched 2 % too far, so that they hardly matter. Measured: 1.098 with both.
    loose = {**QUIET, "Models": "coupled", "Domain/Nodes": "vertices", "Domain/Cells": "45, 91", "Peridynamics/Horizon ratio": "3", "Time/End time": "1.5"}
    fine, coarse = (strength(run_scene("prm/fracture/centre_crack.prm", {**loose, "Time/Time step": step}), 1, "coupled") for step in ("0.01", "0.1"))
    table.add("m = 3, 45 cells: strength over Griffith's", fine / griffith(0.2, 1), 1, absolute=0.156)
    table.add("with steps of 0.1, over that with steps of 0.01", coarse / fine, 1, absolute=0.02)
    table.show()


def check_cantilever(table, run):
    """The crack of prm/fracture/double_cantilever.prm grows bit by bit, at an energy near the fracture energy (crack_tips.py runs it)."""
    growth = []
    for t, strain, lost, broken in history(run, "strain energy", DISSIPATED, BROKEN):
        if broken == 0:
            continue
        opening = 0.16 * t
        force = 2 * strain / opening
        length = (YOUNG * 0.2 ** 3 * opening / (8 * force)) ** (1 / 3)
        growth.append((t, length, 3 * YOUNG * 0.2 ** 3 * opening ** 2 / (16 * length ** 4), lost))
    late = [row for row in growth if row[0] > 0.599]
    check(late[-1][1] - late[0][1] > 0.15, f"the crack grows from {late[0][1]} to {late[-1][1]}")
    check(max(b[1] - a[1] for a, b in zip(late, late[1:])) < 0.03, "the crack grows bit by bit")
    # Measured: 1.105 and, in the mean, 1.091 of the fracture energy, whose roots are 1.05 and 1.04
    # of Griffith's load.
    rate = (late[-1][3] - late[0][3]) / (late[-1][1] - late[0][1])
    table.add("energy dissipated per length over the fracture energy", rate / ENERGY, 1, absolute=0.32)
    table.add("load in the mean over Griffith's", sum(math.sqrt(row[2] / ENERGY) for row in late) / len(late), 1, absolute=0.1)
    # Beams do not see how the crack jumps from row to row.
    table.add("energy dissipated per length, against that of beams", rate, sum(row[2] for row in late) / len(late), relative=0.04)
    energy_kept(table, "growth", run, 1e-9)


GLUED = """
set Title     = Glued bar that softens
set Dimension = 2
set Physics   = elasticity
set Models    = peridynamics
subsection Domain
  set Upper corner = 100, 20
  set Cells        = 20, 4
end
subsection Material
  set Young modulus    = 37000
  set Poisson ratio    = 1/3
  set Law              = softening
  set Tensile strength = 3.9
  set Fracture energy  = 0.1432
  set Interfaces       = left/elsewhere: fracture energy 0.05, tensile strength 2
  subsection Phases
    set Regions       = left: 50.1 - x
    set Young modulus = left: 37000
  end
end
subsection Boundary conditions
  set Displacement = left: 0, free ; right: 0.4*t^2, free
  set Symmetry     = bottom, top
end
subsection Elasticity
  set Solver = newton
end
subsection Time
  set Time step = 0.005
end
"""


def interfaces():
    """A crack runs along the interface of two plies of one material at the energy of the interface, and no bond within them breaks."""
    table = Comparison("Delamination, m = 4")
    scene = "prm/fracture/delamination.prm"
    quiet = {**QUIET, "Domain/Cells": "100, 20"}
    run = run_scene(scene, quiet)
    growth = []
    for t, strain, lost, broken in history(run, "strain energy", DISSIPATED, BROKEN):
        if broken > 0:
            opening = 0.16 * t
            length = (YOUNG * 0.2 ** 3 * opening / (16 * strain / opening)) ** (1 / 3)
            growth.append((length, 3 * YOUNG * 0.2 ** 3 * opening ** 2 / (16 * length ** 4), lost))
    late = growth[len(growth) // 3:]
    check(late[-1][0] - late[0][0] > 0.1, f"the crack grows from {late[0][0]} to {late[-1][0]}")
    loads = sum(math.sqrt(rate / ENERGY) for _, rate, _ in late) / len(late)
    print(f"  energy per length: {(late[-1][2] - late[0][2]) / (late[-1][0] - late[0][0]) / ENERGY:.4f}")
    table.add("load in the mean over that by beams", loads, 1, absolute=0.12)
    # Plies that are a thousand times as tough: nothing else than the interface breaks.
    tough = run_scene(scene, {**quiet, "Material/Fracture energy": "40"})
    for quantity in (BROKEN, DISSIPATED, "force on left in y"):
        table.add(f"{quantity}, with plies that cannot break", tough.total(quantity, PD, time=1), run.total(quantity, PD, time=1), relative=1e-12)
    # A uniform body whose interface is as tough as itself breaks as without it, on two processes, too.
    same, none = (run_scene(scene, {**quiet, "Material/Interfaces": text, "Material/Fracture energy": "0.01", "Time/End time": "0.6"}, ranks=n)
                  for text, n in (("elsewhere/upper: fracture energy 0.01", 2), ("", 1)))
    table.add("an interface like the body, on two processes", same.total(DISSIPATED, PD, time=0.6), none.total(DISSIPATED, PD, time=0.6), relative=1e-9)
    # Bonds that soften: the bar bears what its glue does, and gives off the energy of that, whatever the steps; measured: 0.968, 1.0005.
    glued = run_scene(GLUED, QUIET)
    table.add("glue that softens: strength of a bar", largest(glued, "force on right in x") / 20 / 2, 1, absolute=0.05)
    table.add("its energy", glued.total(DISSIPATED, PD, time=1) / 20 / 0.05, 1, absolute=0.005)
    table.show()
    for text, words in (("upper/lower: fracture energy 1", ("'Interfaces' in section 'Material'", "'lower'", "upper, elsewhere")),
                        ("upper/upper: fracture energy 1", ("two different phases",)), ("upper: fracture energy 1", ("'name/name'",)),
                        ("upper/elsewhere: tensile strength 1", ("'fracture energy'",)), ("upper/elsewhere: fracture energy -1", ("greater than 0",)),
                        ("upper/elsewhere: energy 1", ("fracture energy NUMBER",)), ("upper/elsewhere: fracture energy 1, tensile strength 2", ("'Law = softening'",)),
                        ("upper/elsewhere: fracture energy 1 ; elsewhere/upper: fracture energy 2", ("twice",))):
        check_message(run_scene(scene, {"Material/Interfaces": text}, expect_error=True), *words)


def block(lattice={"Domain/Cells": "16, 32, 2"}, delta=0.19, apart=0.35):
    """Three dimensions."""
    table = Comparison(f"Block with a crack, m = 3, delta = {delta}")
    run = run_scene("prm/fracture/cracked_block.prm", {**QUIET, **lattice})
    # Measured: 1.300; 1.144 at delta = 0.125, 1.116 on the scene's own lattice.
    table.add("strength over Griffith's", strength(run, 0.125) / griffith(0.2, 1), 1, absolute=apart)
    energy_kept(table, "block", run, 1e-8)
    table.show()


def fine_block():
    block({}, 0.094, 0.15)


def bend():
    """A notched beam on two feet is pressed until it breaks: under a given load K rises with the crack, so the peak is where linear fracture mechanics has it start."""
    table = Comparison("Three-point bend, m = 6, 30 cells across the height")
    run = run_scene("prm/fracture/three_point_bend.prm", {
        **QUIET, "Models": PD, "Domain/Cells": "132, 30", "Domain/Nodes": "cell centers", "Material/Fracture energy": str(ENERGY),
        "Peridynamics/Horizon ratio": "6", "Solver/Tolerance": "1e-8", "Time/Time step": "0.02", "Boundary conditions/Traction": "",
        "Boundary conditions/Parts": "load: top if abs(x) < 0.06 ; left foot: bottom if abs(x + 2) < 0.06 ; right foot: bottom if abs(x - 2) < 0.06",
        "Boundary conditions/Displacement": "load: free, -0.045*t ; left foot: 0, 0 ; right foot: free, 0"})
    loads = [-row[1] for row in history(run, "force on load in y")]
    # K = 10.65 P (ASTM E399); the load, spread over 0.12, has the moment of 2 - 0.03 in place of 2.
    expected = math.sqrt(YOUNG * ENERGY) / (10.65 * (1 - 0.06 / 4))
    table.add("peak over that of linear fracture mechanics", max(loads) / expected, 1, absolute=0.0222)  # measured: 1.014; m = 5: 1.069, m = 4: 1.143
    table.add_limit("force at the end over the peak", loads[-1] / max(loads), 0.9)  # measured: 0.82
    table.show()


def mesh():
    """The plate on a Gmsh file of the box's cells breaks as that on the box: families on meshes are those of the lattice but for partial volumes."""
    table = Comparison("Plate with a crack, m = 3, on a mesh over that on a lattice")
    scene = open(os.path.join(SOURCE_DIR, "prm/fracture/centre_crack.prm"), encoding="utf-8").read()
    for line in ("  set Horizon ratio   = 4\n", "  set Lower corner = -0.5, -1\n", "  set Upper corner = 0.5, 1\n", "  set Cells        = 80, 160\n"):
        check(line in scene, f"the scene has {line.strip()}")
        scene = scene.replace(line, "")
    path = write_mesh([-0.5 + i / 24 for i in range(25)], [-1 + 2 * i / 49 for i in range(50)])
    # Free sides of lattices and meshes are completed by different moments: here both end.
    shared = {**QUIET, "Domain/Nodes": "vertices", "Peridynamics/Horizon": "0.125", "Peridynamics/Surface correction": "none", "Solver/Tolerance": "1e-11", "Time/Time step": "0.02"}
    box = run_scene(scene, {**shared, "Domain/Lower corner": "-0.5, -1", "Domain/Upper corner": "0.5, 1", "Domain/Cells": "24, 49",
                           "Boundary conditions/Displacement": "top: 0, 0.015*t; bottom: 0, -0.015*t"})
    runs = [run_scene(scene, {**shared, "Domain/Shape": "mesh file", "Domain/Mesh file": path,
                              "Boundary conditions/Displacement": "4: 0, 0.015*t; 3: 0, -0.015*t"}, ranks=ranks) for ranks in (1, 2)]
    found = []
    for run, side in ((box, "top"), (runs[0], "4"), (runs[1], "4")):
        rows = history(run, f"force on {side} in y", BROKEN)
        first = next(k for k, row in enumerate(rows) if row[2] > 0)
        found.append((rows[first][0], max(row[1] for row in rows), rows[first - 1][1], rows[-1][2]))
    for name, on_box, on_mesh, bound in zip(("time of the first break", "strength", "force before"), found[0], found[1], (1e-12, 2.1e-3, 2.2e-3)):
        table.add(name, on_mesh / on_box, 1, absolute=bound)  # measured: 0, 1.3e-3, 1.4e-3
    check_close(found[2], found[1], relative=1e-9, what="two processes")
    check(found[0][3] > 500, f"the plate breaks: {found[0][3]} bonds")
    table.show()


def branching(lattice, steps):
    """A crack that branches: energy of second order in the time step."""
    table = Comparison("Branching crack")
    lost = []
    for step, bound in zip(steps, (0.05, 0.016)):
        run = run_scene("prm/fracture/branching_crack.prm", {**lattice, "Time/Time step": step, "Output/Write every": "2e-6", "Output/Fields": "none"})
        lost.append(max(abs(row[1]) for row in history(run, "energy imbalance")))
        last = run.model(PD)["energy balance"]
        table.add_limit(f"step {step}: energy imbalance over energy released", lost[-1] / last["released"], bound)
    # Cracks branch a little differently with another step: no exact power.
    table.add("ratio of the imbalances", lost[0] / lost[1], 4, absolute=1.6)
    table.show()


def motion():
    branching({"Domain/Cells": "100, 40"}, ("1.2e-7", "0.6e-7"))
    table = Comparison("Branching crack, newmark")
    # Faces that begin to touch conserve energy to order dt^2 alone.
    newmark = run_scene("prm/fracture/branching_crack.prm", {"Domain/Cells": "50, 20", "Time/Stepper": "newmark", "Time/Time step": "4e-7",
                                                             "Output/Write every": "", "Output/Fields": "none", "Peridynamics/Horizon ratio": "3",
                                                             "Material/Fracture energy": "60", "Elasticity/Contact": "false"})
    check(newmark.model(PD)["energy balance"]["broken bonds"] > 100, "bonds break with newmark")
    energy_kept(table, "newmark", newmark, 1e-7)
    table.show()


def fine_motion():
    branching({}, ("0.6e-7", "0.3e-7"))


COARSE = {**QUIET, "Domain/Cells": "24, 48", "Peridynamics/Horizon ratio": "3", "Solver/Tolerance": "1e-12", "Time/Time step": "0.05",
          "Material/Poisson ratio": "0.2", "Material/Fracture energy": "0.005"}


def steps():
    """A crack, not a heap of rubble, whatever the step of the load; grips that move a body whose bonds break; what is kept of a run that finds no equilibrium."""
    broken = []
    for step in ("1", "0.1", "0.02"):
        run = run_scene("prm/fracture/centre_crack.prm", {**COARSE, "Time/Time step": step})
        broken.append(run.model(PD)["energy balance"][BROKEN])
        check(run.model(PD)["steps"] == round(1 / float(step)), f"steps of {step}: {run.model(PD)['steps']}")
    check(max(broken) - min(broken) <= 0.05 * max(broken), f"bonds broken with load steps of 1, 0.1 and 0.02: {broken}")
    # Faces that begin to touch conserve energy to order dt^2 alone.
    moving = {**COARSE, "Elasticity/Contact": "false", "Elasticity/Solver": "dynamics", "Time/Stepper": "newmark", "Time/Time step": "0.004", "Material/Density": "0.1"}
    run = run_scene("prm/fracture/centre_crack.prm", moving)
    energy = run.model(PD)["energy balance"]
    check(energy[BROKEN] > 50 and energy["released"] > 0, f"bonds break in motion: {energy}")
    check_less(abs(energy["imbalance"]) / energy["released"], 1e-8, "newmark, moving grips: energy imbalance over energy released")
    # All bonds of a bar in even tension are as stretched: none is left, and nothing moves.
    bar = {**QUIET, "Models": PD, "Domain/Cells": "30", "Material/Fracture energy": "0.01", "Boundary conditions/Displacement": "left: 0; right: 0.05*t", "Boundary conditions/Traction": "",
           "Time/Time step": "0.1", "Time/End time": "1"}
    run = run_scene("prm/elasticity/bar_1d.prm", bar)
    check(run.model(PD)["energy balance"][BROKEN] == 30 + 29 + 28, f"a bar in even tension: {run.model(PD)['energy balance'][BROKEN]} of 87 bonds broken")
    pulled = {**COARSE, "Boundary conditions/Displacement": "bottom: 0, 0", "Boundary conditions/Traction": "top: 0, 4*t"}
    run = run_scene("prm/fracture/centre_crack.prm", pulled, expect_error=True)
    check_message(run, "No equilibrium was found at t =", "bonds had broken", "'Displacement'", "'Solver = dynamics'")
    check(run.summary["status"] == "diverged" and run.summary["message"] in run.stderr, f"the run's end: {run.summary['status']}")
    check(history(run, "force on top in y")[-1][1] > 0.5, "the load that the plate bore")


def symmetry():
    """A quarter of the plate bears what the whole does, with the crack in a plane of symmetry between the nodes; where nodes lie in that plane it is refused."""
    whole = run_scene("prm/fracture/centre_crack.prm", COARSE)
    quarter = {"Domain/Lower corner": "0, 0", "Domain/Cells": "12, 24", "Boundary conditions/Symmetry": "left, bottom", "Boundary conditions/Displacement": "top: 0, 0.01*t"}
    run = run_scene("prm/fracture/centre_crack.prm", {**COARSE, **quarter})
    forces = [{round(row[0], 6): row[1] for row in history(r, "force on top in y") if row[0] < 0.51} for r in (whole, run)]
    check(len(forces[0]) > 9, f"load steps: {forces[0]}")
    check_close([2 * forces[1][t] for t in forces[0]], list(forces[0].values()), relative=1e-8, what="twice the force on a quarter")
    check_close([2 * largest(run, "force on top in y")], [largest(whole, "force on top in y")], relative=1e-8, what="twice the strength of a quarter")
    for models, energy in (("finite elements", ""), ("coupled", "0.01"), ("peridynamics", "0.01")):
        asked = {"Domain/Nodes": "vertices", "Models": models, "Material/Fracture energy": energy}
        run = run_scene("prm/fracture/centre_crack.prm", {**COARSE, **quarter, **asked}, expect_error=True)
        check_message(run, "'Segments' in section 'Cracks'", "'Symmetry = bottom'", "ligament: free, 0", "'Nodes = cell centers'")


# Angle of the crack to the rows and the bound of what it turns by, degrees.
OBLIQUE = ((10, 1.8), (22.5, 4.7))  # measured: 1.1 and 3.0; at 33 degrees 7.4; with `Breaking = at rest` 3.5 and 13.4


def tilted(angle, half=0.3):
    """The settings of a plate with a crack at an angle (degrees) to the rows of the lattice, pulled straight across it."""
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    pulled = f"0.016*t*({s * s}*x - {s * c}*y), 0.016*t*({c * c}*y - {s * c}*x)"
    return {"Cracks/Segments": f"{-half * c},{-half * s} ; {half * c},{half * s}",
            "Boundary conditions/Displacement": "; ".join(f"{side}: {pulled}" for side in ("left", "right", "bottom", "top"))}


def turned(run, angle, half=0.3, shown=0.35, model=PD):
    """By how many degrees each half of the crack has left its direction: total least squares of the damaged nodes beyond the tip, within 0.45 of it."""
    import numpy as np

    nodes, damage = nodes_and_damage(run, model)
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    turns = []
    for side in (1, -1):
        there = side * nodes @ np.array([[c, -s], [s, c]])
        there = there[(damage > shown) & (there[:, 0] > half + 0.03) & (there[:, 0] < half + 0.45)]
        check(len(there) > 20 and there[:, 0].max() > half + 0.3, f"the crack at {angle} degrees grows: {len(there)} nodes")
        along = np.linalg.svd(there - there.mean(0))[2][0]
        turns.append(math.degrees(math.atan(along[1] / along[0])))
    return turns


def oblique(cases=OBLIQUE[1:]):
    """A slow crack goes straight on, whatever its angle to the rows; that of `Breaking = at rest` turns to them."""
    table = Comparison("Slow crack at an angle to the rows, m = 4")
    shared = {"Output/Fields": "hdf5", "Output/Write at": "0.7", "Time/End time": "0.7"}
    for angle, bound in cases:
        run = run_scene("prm/fracture/oblique_crack_growth.prm", {**shared, **tilted(angle)})
        check(not any("rows of nodes" in note for note in run.summary["notes"]), f"in motion no note tells of rows: {run.summary['notes']}")
        for turn in turned(run, angle):
            table.add(f"at {angle} degrees: angle to its direction", turn, 0, absolute=bound)
    table.show()


def more_oblique():
    oblique(OBLIQUE[:1])


# Model, angle and the bound, degrees; measured: 2.2 and 1.1 (without `Crack direction` 10.0 and 7 to 17).
STRAIGHT = ((PD, 33, 3.5), ("coupled", 22.5, 1.8))


def straight():
    """Slow cracks across the mean tension about their tips go straight on, beside elements too, and part no more than they have to."""
    table = Comparison("Slow crack at an angle to the rows, mean tension, m = 4")
    shared = {"Elasticity/Crack direction": "mean tension", "Output/Fields": "hdf5", "Output/Write at": "0.7", "Time/End time": "0.7", "Domain/Cells": "60, 60"}
    edge = 59 / 60
    beside = {"Models": "coupled", "Domain/Nodes": "vertices", "Domain/Cells": "59, 59", "Domain/Lower corner": f"{-edge}, {-edge}", "Domain/Upper corner": f"{edge}, {edge}",
              "Coupling/Zone": "follow"}
    for model, angle, bound in STRAIGHT:
        run = run_scene("prm/fracture/oblique_crack_growth.prm", {**shared, **tilted(angle), **(beside if model != PD else {})})
        for turn in turned(run, angle, model=model):
            table.add(f"{model} at {angle} degrees: angle to its direction", turn, 0, absolute=bound)
    table.show()


def scatter():
    """Weibull strength: a bar in tension is the weaker the more its strength scatters, the same on any number of processes and for the same seed alone."""
    shared = {**COARSE, "Cracks/Segments": "", "Boundary conditions/Displacement": "top: 0, 0.03*t; bottom: 0, -0.03*t", "Material/Strength seed": "1"}
    shared = {**shared, "Material/Fracture energy": "", "Material/Critical stretch": "0.02"}
    found = {}
    for modulus in ("40", "10"):
        for seed, ranks in (("1", 1), ("1", 2), ("2", 1)):
            run = run_scene("prm/fracture/centre_crack.prm", {**shared, "Material/Weibull modulus": modulus, "Material/Strength seed": seed}, ranks=ranks)
            found[modulus, seed, ranks] = strength(run, 1), history(run, DISSIPATED)[-1][1]
    for modulus in ("40", "10"):
        check_close(found[modulus, "1", 2], found[modulus, "1", 1], relative=1e-7, what=f"modulus {modulus}: strength and energy dissipated on two processes")
        check(abs(found[modulus, "2", 1][1] / found[modulus, "1", 1][1] - 1) > 1e-6, f"modulus {modulus}: another seed, another crack: {found}")
    check_less(found["10", "1", 1][0], 0.9 * found["40", "1", 1][0], "strength at modulus 10 against 40")
    print(f"strength with scatter: {found}")


STRENGTH = "prm/fracture/critical_stress.prm"
# Uniform: no hole, no contraction.
UNIFORM = {**QUIET, "Domain/Shape": "box", "Domain/Nodes": "vertices", "Domain/Cells": "10, 20", "Material/Poisson ratio": "0", "Elasticity/Model": "correspondence", "Solver/Tolerance": "1e-12",
           "Boundary conditions/Displacement": "top: 0, 0.004*t; bottom: 0, -0.004*t"}
STRETCHED = {**UNIFORM, "Material/Criterion": "stretch", "Material/Critical stress": ""}


def first_break(overrides):
    return run_scene(STRENGTH, overrides).model(PD)["first broken bonds"]


def nodes_and_damage(run, model=PD):
    import h5py

    with h5py.File(os.path.join(run.folder, run.summary["fields"][-1]["files"][model])) as file:
        return file["nodes"][:, :2], file["damage"][:].ravel()


def criteria():
    """A strength that is given, limits of time and temperature at rest and in motion, ends that never break."""
    table = Comparison("Bonds that break by other criteria")
    # A strain of 0.004 t.
    for criterion in ("principal stress", "von mises"):
        run = run_scene(STRENGTH, {**UNIFORM, "Material/Criterion": criterion, "Material/Critical stress": "0.4"})
        table.add(f"{criterion}: stress of the plate over its strength", strength(run, 1) / 0.4, 1, absolute=0.01)
        energy_kept(table, criterion, run, 1e-9)
    table.add("strength that falls in time: time of the first break", first_break({**UNIFORM, "Material/Critical stress": "0.8 - 0.5*t"}), 0.8 / 1.3, absolute=0.006)
    falls, warm = "0.002 - 0.001*t", {"Elasticity/Temperature change": "80"}
    for what, more in (("of time", {"Material/Critical stretch": falls}),
                       ("of time, in motion", {"Material/Critical stretch": falls, "Elasticity/Solver": "dynamics", "Elasticity/Breaking": "auto", "Material/Density": "1.0", "Time/Time step": "0.002",
                                               "Initial and source/Initial velocity": "0, 0.004*y", "Time/End time": "0.5"}),
                       ("of temperature", {**warm, "Material/Critical stretch": "0.0032*(1 - T/160)"})):
        table.add(f"critical stretch {what}: time of the first break", first_break({**STRETCHED, **more}), 0.4, absolute=0.004)
    # A strain of 0.004 t, whose rate makes 1.2 of the critical stretch of 0.0016.
    pulled = {"Elasticity/Solver": "dynamics", "Elasticity/Breaking": "auto", "Material/Density": "1.0", "Time/Time step": "0.002", "Initial and source/Initial velocity": "0, 0.004*y", "Time/End time": "0.6",
              "Material/Critical stretch": "0.0016", "Material/Rate factor": "1 + 50*rate"}
    for ranks in (1, 2):
        table.add(f"critical stretch that grows with the rate, {ranks} processes: time of the first break", run_scene(STRENGTH, {**STRETCHED, **pulled}, ranks=ranks).model(PD)["first broken bonds"], 0.48, absolute=0.004)
    # Its surfaces are softer, and its ends break last.
    full = {"Elasticity/Model": "state-based", "Elasticity/Kinematics": "full", "Peridynamics/Surface correction": "none"}
    check(first_break({**STRETCHED, **pulled, **full}) > 0.48, "full kinematics: limits grow with the rate")
    # Loads that stay, limits that fall; what is no limit any more.
    table.add("a strength that falls under loads that stay: time of the first break", first_break({**UNIFORM, "Boundary conditions/Displacement": "top: 0, 0.002; bottom: 0, -0.002", "Material/Critical stress": "0.8 - 0.5*t", "Time/Time step": "0.01"}), 0.8, absolute=0.011)
    check_message(run_scene(STRENGTH, {**STRETCHED, "Material/Critical stretch": "", "Material/Fracture energy": "2*(1 - 3*t)"}, expect_error=True), "'Fracture energy' in section 'Material'", "not positive")
    # The hole breaks, the grips do not, whatever the criterion.
    coarse = {**QUIET, "Domain/Cells": "20, 40", "Solver/Tolerance": "1e-12", "Boundary conditions/Displacement": "top: 0, 0.008*t; bottom: 0, -0.008*t"}
    for criterion, limit in (("principal stress", {}), ("energy", {"Material/Critical stress": "", "Material/Fracture energy": "2e-4", "Peridynamics/Kernel": "constant"})):
        run = run_scene(STRENGTH, {**coarse, "Material/Criterion": criterion, **limit, "Output/Fields": "hdf5", "Output/Write at": "1"})
        places, damage = nodes_and_damage(run)
        in_grips = abs(places[:, 1]) > 0.8 + 3 * 0.05
        check(in_grips.any() and not damage[in_grips].any() and damage.max() > 0.4, f"{criterion}: damage in the grips {damage[in_grips].max()}, elsewhere {damage.max()}")
        if criterion == "energy": # by stresses what has lost bonds has less stress, and the rest of its bonds stay
            check_less(abs(run.model(PD)["boundary force"]["top"][1]), 1e-2 * largest(run, "force on top in y"), f"{criterion}: force left")
        energy_kept(table, f"plate with a hole, {criterion}", run, 1e-7)
    table.show()


if __name__ == "__main__":
    run_parts(plate, beside, interfaces, block, bend, mesh, motion, steps, symmetry, oblique, straight, scatter, criteria,
              fine_plate=fine_plate, fine_block=fine_block, fine_motion=fine_motion, more_oblique=more_oblique)
