#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Compute and measure what doc/fracture_benchmarks.md tells, and draw its figures.

    python3 doc/make_fracture_benchmarks.py [--program PERIDEAL] [--output FOLDER] [quench] [impact] [glass] [beam] [eccentric] [strip] [torsion]

Runs that are complete in FOLDER (output/fracture_benchmarks) are not computed again. All of them take about an hour on one core.
"""

import argparse
import json
import math
import os
import subprocess
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests" / "scenes"))
import crack_measures as measures  # noqa: E402

BROKEN = "broken bonds"
SCENES = ROOT / "prm" / "fracture"


def hot(value, **more):
    return {"Initial and source/Initial value": value, "Elasticity/Reference temperature": value, "Output/Write at": "0.003, 0.01, 0.03", **more}


def half(value, **more):
    """Half as long, without the cooled short side, and half the time."""
    return hot(value, **{"Domain/Upper corner": "0.0125, 0.005", "Domain/Cells": "125, 50", "Boundary conditions/Convection": "bottom: 6e4, 20", "Time/End time": 0.05,
                         "Time/Time step": 0.001, **more})


def drawn(shift):
    """Other fracture energies from node to node."""
    digits = f"43758.5*sin(129898*x + 782330*y + {shift})"
    return {"Material/Fracture energy": f"24.3*if(x < 3e-4 || y > 4.7e-3, 10, 1 + 0.2*({digits} - rint({digits})))"}


def lattice(cells, m, **more):
    return {"Domain/Cells": cells, "Peridynamics/Horizon ratio": m, **more}


def zone(cells, m):
    return lattice(cells, m, **{"Models": "coupled", "Coupling/Zone": "follow", "Domain/Nodes": "vertices"})


def pulled(energy, stress, cells, **more):
    return {"Material/Fracture energy": energy, "Boundary conditions/Traction": f"top: 0, {stress}; bottom: 0, -{stress}", "Domain/Cells": cells,
            "Output/Write every": 2.5e-6, **more}


def pushed(difference):
    return {"Initial and source/Initial value": f"-{difference}*if(x < 0.008, 1, exp(-638*(x - 0.008)))",
            "Initial and source/Source": f"-{difference}*6.77e5*exp(-4e6*(x - 0.008 - 3e-4*t)^2)", "Output/Write at": ""}


OFTEN = {"Output/Write every": 5e-6}
AT_REST = {"Elasticity/Breaking": "at rest"}
RUNS = {
    "quench": ("quenched_alumina", {
        "300 C, as the scene": hot(300),
        **{f"{t} C": half(t) for t in (300, 350, 400, 500, 600)},
        "300 C, broken bonds conduct": half(300, **{"Elasticity/Broken bonds conduct": 1}),
        "300 C, one energy everywhere": half(300, **{"Material/Fracture energy": "24.3*if(x < 3e-4 || y > 4.7e-3, 10, 1)"}),
        "300 C, m = 4": half(300, **{"Peridynamics/Horizon ratio": 4}),
        "300 C, peridynamics": half(300, **{"Models": "peridynamics", "Domain/Nodes": "cell centers", **AT_REST}),
        **{f"{t} C, other digits {k}": half(t, **drawn(k)) for t in (300, 600) for k in (1, 2)}}),
    "impact": ("kalthoff_winkler", {
        "m = 3, delta = 3 mm": OFTEN,
        "m = 3, delta = 3 mm, plane stress": {**OFTEN, "Elasticity/Plane": "stress"},
        "m = 4, delta = 2.9 mm": lattice("140, 280", 4, **OFTEN),
        "m = 5, delta = 3.1 mm": lattice("160, 320", 5, **OFTEN),
        "m = 3, delta = 1.5 mm": lattice("200, 400", 3, **OFTEN),
        "m = 3, delta = 1.5 mm, plane stress": lattice("200, 400", 3, **OFTEN, **{"Elasticity/Plane": "stress"}),
        "m = 5, delta = 1.6 mm": lattice("320, 640", 5, **{"Output/Write every": 1e-5}),
        "m = 3, delta = 3 mm, zone that follows": {**OFTEN, **zone("101, 200", 3)}}),
    "glass": ("branching_glass", {
        **{f"G = {g}, {load / 1e6:g} MPa, {name}": pulled(g, load, cells, **{"Peridynamics/Horizon ratio": m})
           for g, load in ((3.8, 2e6), (3.8, 4e6))
           for name, cells, m in (("delta = 2 mm", "200, 80", 4), ("delta = 1 mm", "400, 160", 4), ("delta = 0.5 mm", "800, 320", 4))},
        "G = 135, 12 MPa, delta = 2 mm": pulled(135, 12e6, "200, 80"),
        "G = 3.8, 2 MPa, delta = 1 mm, m = 3": pulled(3.8, 2e6, "300, 120", **{"Peridynamics/Horizon ratio": 3}),
        "G = 3.8, 2 MPa, delta = 1 mm, m = 6": pulled(3.8, 2e6, "600, 240", **{"Peridynamics/Horizon ratio": 6}),
        "G = 3.8, 2 MPa, delta = 2 mm, zone that follows": pulled(3.8, 2e6, "200, 81", **zone("200, 81", 4)),
        "G = 3.8, 2 MPa, delta = 1 mm, zone that follows": pulled(3.8, 2e6, "400, 161", **zone("400, 161", 4)),
        "zone that follows, nu = 1/3": pulled(3.8, 2e6, "200, 81", **{**zone("200, 81", 4), "Material/Poisson ratio": "1/3"}),
        "coupled everywhere": pulled(3.8, 2e6, "200, 81", **{**zone("200, 81", 4), "Coupling/Zone": "everywhere"}),
        "coupled everywhere, nu = 1/3": pulled(3.8, 2e6, "200, 81", **{**zone("200, 81", 4), "Coupling/Zone": "everywhere", "Material/Poisson ratio": "1/3"}),
        "delta = 2 mm, nu = 1/3": pulled(3.8, 2e6, "200, 80", **{"Material/Poisson ratio": "1/3"})}),
    "beam": ("half_notched_beam", {
        **{f"m = {m}, {40 if k == 1 else 60} cells high": lattice(f"{140 if k == 1 else 210}, {40 if k == 1 else 60}", m, **AT_REST) for k, m in ((1, 4), (1, 5), (1, 6), (2, 4))},
        "zone that follows, m = 3, 40 cells high": zone("141, 40", 3),
        "zone that follows, m = 4, 40 cells high": zone("141, 40", 4)}),
    "eccentric": ("eccentric_notch", {
        "zone that follows, m = 3, 64 cells high": {},
        "zone that follows, m = 4, 64 cells high": {"Peridynamics/Horizon ratio": 4}}),
    "strip": ("quenched_strip", {
        **{f"{t} K": pushed(t) for t in (60, 140, 250)},
        "250 K, m = 4": {**pushed(250), "Peridynamics/Horizon ratio": 4, "Time/End time": 80},
        "400 K, m = 4": {**pushed(400), "Peridynamics/Horizon ratio": 4, "Time/End time": 40}}),
    "torsion": ("notched_torsion", {
        "11 cells high": {},
        "5 cells high": {"Domain/Cells": "20, 5, 5"}}),
}


def computed(program, folder, scene, settings):
    """The result of a scene with settings; computed unless it is there."""
    summary = folder / "summary.json"
    if not summary.exists() or json.loads(summary.read_text(encoding="utf-8")).get("status") != "complete":
        overrides = {"Output directory": folder, "Output/Fields": "hdf5", "Elasticity/Contact": "false", **settings}
        subprocess.run([program, "run", str(SCENES / f"{scene}.prm"), "--overwrite"] + [word for entry, value in overrides.items() for word in ("-s", f"{entry}={value}")],
                       check=True, stdout=subprocess.DEVNULL)
    return measures.Result(str(folder))


def draw(name, results, columns, limits=None):
    """The damage of several runs side by side."""
    x, y, _ = results[0][1].damage()
    rows = -(-len(results) // columns)
    width = 14 / columns
    figure, axes = plt.subplots(rows, columns, figsize=(14, rows * (width * (y[-1] - y[0]) / (x[-1] - x[0]) + 0.3)), squeeze=False, layout="constrained")
    for place in axes.ravel():
        place.set_axis_off()
    for place, (title, result) in zip(axes.ravel(), results):
        x, y, table = result.damage()
        place.imshow(table.T, origin="lower", extent=(x[0], x[-1], y[0], y[-1]), cmap="viridis", vmin=0, vmax=limits or 0.6, interpolation="nearest")
        place.set_title(title, fontsize=10)
    figure.savefig(ROOT / "doc" / "figures" / f"{name}.png", dpi=72)
    plt.close(figure)


def quench(results):
    """Cracks from the long side that reach some depths, their spacing, and the length of the longest."""
    for name, result in results:
        for entry, time in enumerate(result.times()):
            x, y, table = result.damage(entry)
            inner = x < 0.9 * x[-1]  # without the cracks of the corner
            counts = [measures.cracks_at(x[inner], y, table[inner], depth) for depth in (2.5e-4, 5e-4, 1e-3, 1.5e-3, 2e-3)]
            below = [y[last] for row in table[inner] for first, last in measures.stretches(row > 0.25)[:1] if first == 0]
            heat = result.model["heat balance"]["cumulative"]
            print(f"  {name:32} t = {time:g} s: {counts} cracks reach 0.25, 0.5, 1, 1.5, 2 mm; longest {1e3 * max(below, default=0):.2f} mm; heat lost {abs(heat['imbalance']) / heat['scale']:.0e}")
        print(f"  {name:32} first break {1e3 * result.model['first broken bonds']:.2f} ms")
    draw("fracture_quench", results[1:10], 3)


def impact(results):
    """Angle, start and speed of the upper crack."""
    tip = (0.05, 0.025)
    for name, result in results:
        places = []
        for entry, time in enumerate(result.times()):
            x, y, table = result.damage(entry)
            place = measures.furthest(x, y, table, tip, 2e-3)
            if place is not None and place[1] < 0.095:
                places.append((time, math.dist(place, tip), place))
        x, y, table = result.damage()
        angles = [measures.direction(x, y, table, (tip[0], side * tip[1]), side) for side in (1, -1)]
        (t0, l0, _), (t1, l1, end) = places[0], places[-1]
        speed = (l1 - l0) / (t1 - t0)
        print(f"  {name:40} angles {angles[0]:.1f}, {angles[1]:.1f} to its end, {math.degrees(math.atan2(end[1] - tip[1], end[0] - tip[0])):.1f}; first break {1e6 * result.model['first broken bonds']:.1f} us,"
              f" leaves the notch {1e6 * (t0 - l0 / speed):.1f} us; {speed:.0f} m/s in the mean; {len(places)} places")
    draw("fracture_impact", results, 4)


def glass(results):
    """Where and when the crack divides, and how fast it runs before and after."""
    for name, result in results:
        x, y, table = result.damage()
        where = measures.branching(x, y, table, 1.2e-3, 0.05, 0.016)
        ends = [(time, measures.front(*result.damage(entry), 0.016)) for entry, time in enumerate(result.times())]
        moving = [(t, place) for t, place in ends if 0.0505 < place < 0.098]
        when = next((a[0] + (where - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) for a, b in zip(ends, ends[1:]) if a[1] < where <= b[1]), math.nan) if where else math.nan
        speeds = [(b[1] - a[1]) / (b[0] - a[0]) for a, b in zip(moving, moving[2:])]
        mean = (moving[-1][1] - moving[0][1]) / (moving[-1][0] - moving[0][0])
        print(f"  {name:50} first break {1e6 * result.model['first broken bonds']:.1f} us; branches at {1e3 * where if where else math.nan:.1f} mm, {1e6 * when:.1f} us; {mean:.0f} m/s in the mean, at most {max(speeds):.0f}"
              f" over 5 us; imbalance {result.model['energy balance']['imbalance']:.2g} of {result.model['energy balance']['released']:.3g}")
    draw("fracture_glass", results[:-4], 3)


def openings(result):
    """Force (N) against the opening between the two probes (m)."""
    probes = {}
    with open(os.path.join(result.folder, "probes.csv"), encoding="utf-8") as file:
        names = file.readline().strip().split(",")
        for line in file:
            row = dict(zip(names, line.strip().split(",")))
            probes.setdefault(float(row["time"]), []).append((float(row["x"]), float(row["ux"])))
    forces = dict(result.history("force on load in y"))
    return [(sorted(pair)[1][1] - sorted(pair)[0][1], -0.05 * forces[t]) for t, pair in sorted(probes.items()) if t in forces]


def beam(results):
    for name, result in results:
        loads = [-0.05 * row[1] for row in result.history("force on load in y")]
        stiff = [force / opening for opening, force in openings(result) if opening > 0]
        print(f"  {name:42} peak {max(loads):.0f} N; stiffness at the notch {stiff[0] / 1e6 if stiff else math.nan:.1f} kN/mm; {len(stiff)} openings")


eccentric = beam


def strip(results):
    """Where the crack is at the end, and what it has dissipated per length between a third and the end of the time."""
    for name, result in results:
        rows = result.history("energy dissipated", BROKEN)
        x, y, table = result.damage()
        near = min(rows, key=lambda row: abs(row[0] - rows[-1][0] / 3))
        rate = (rows[-1][1] - near[1]) / (3e-4 * (rows[-1][0] - near[0]))
        print(f"  {name:8} {rows[-1][2]:.0f} bonds; the crack ends at {1e3 * measures.front(x, y, table, 0.005):.2f} mm, the front is at {8 + 0.3 * rows[-1][0]:.2f} mm; {rate:.2f} J/m^2 of the way")
    draw("fracture_strip", results, 3)


def torsion(results):
    """Torque against twist, and where the crack comes out of the sides of the beam."""
    for name, result in results:
        nodes, damage = measures.nodes_and_damage(result)
        torques = [(t, 2 * energy / (6e-3 * t), bonds) for t, energy, bonds in result.history("strain energy", BROKEN) if t > 0]
        peak = max(torques, key=lambda row: row[1])
        first = next((row for row in torques if row[2] > 0), (math.nan,) * 3)
        angles = [round(measures.angle_in_layer(nodes, damage, y), 1) for y in (-0.0045, -0.0227, -0.0318, -0.0409)]
        print(f"  {name:22} peak {peak[1]:.0f} N m at a twist of {6e-3 * peak[0]:.2e}; first break at {first[1]:.0f} N m; {torques[-1][1]:.0f} N m at the end; angles to the axis in layers, from the notch down: {angles}")
    unrolled([(name, *measures.sides_of_beam(*measures.nodes_and_damage(result))) for name, result in results])


def unrolled(pictures):
    """The damage on the sides of a beam, front, bottom and back side one below the other."""
    figure, axes = plt.subplots(1, len(pictures), figsize=(14, 5.2), squeeze=False, layout="constrained")
    for place, (title, (x, _, _), sides) in zip(axes.ravel(), pictures):
        place.imshow(np.vstack(sides), extent=(1e3 * x[0], 1e3 * x[-1], 300, 0), cmap="viridis", vmin=0, vmax=0.6, interpolation="nearest")
        place.set_title(title, fontsize=10)
        place.set_yticks((50, 150, 250), ("front", "bottom", "back"))
    figure.savefig(ROOT / "doc" / "figures" / "fracture_torsion.png", dpi=72)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=str(ROOT / "build" / "release" / "applications" / "perideal"))
    parser.add_argument("--output", type=Path, default=ROOT / "output" / "fracture_benchmarks")
    parser.add_argument("parts", nargs="*", help=", ".join(RUNS))
    arguments = parser.parse_args()
    for part in arguments.parts or RUNS:
        scene, variants = RUNS[part]
        print(f"{part}: {scene}.prm", flush=True)
        results = [(name, computed(arguments.program, arguments.output / part / "".join(c if c.isalnum() else "_" for c in name), scene, settings))
                   for name, settings in variants.items()]
        globals()[part](results)


if __name__ == "__main__":
    main()
