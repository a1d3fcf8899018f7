# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Benchmarks of fracture (doc/fracture_benchmarks.md) on coarse lattices, beside experiments and theory.

    fracture_benchmarks.py quench | impact | space | glass | beam | eccentric | strip | torsion

Bounds that follow from no theory are at most 1.6 times the gap that was measured; the comment beside them says which.
"""

import math

import crack_measures as measures
import numpy as np
from fracture import BROKEN, history
from scene_test import BC, COUPLED, PD, Comparison, check, run_parts, run_scene
from scenes import check_balances

FIELDS, NO_FIELDS = {"Output/Fields": "hdf5"}, {"Output/Fields": "none"}


def first_break(difference, strain):
    """When the strain of the skin of a plate of alumina, cooled by 6e4 W/(m^2 K) on one side of 5 mm, reaches a value: alpha (mean temperature - that of the surface of a half space)."""
    diffusivity, ratio, expansion, height = 31 / (3980 * 880), 6e4 / 31, 7.5e-6, 0.005
    time, lost, step = 0.0, 0.0, 1e-6
    while True:
        argument = ratio * math.sqrt(diffusivity * time)
        surface = difference * math.exp(argument ** 2) * math.erfc(argument)  # above the water's
        if expansion * (difference - lost / height - surface) > strain:
            return time
        lost += step * diffusivity * ratio * surface
        time += step


def quench():
    """A quenched plate breaks first when theory says, has more and longer cracks when it was hotter, and conserves its heat."""
    table = Comparison("Quenched alumina, half as long and on coarse cells")
    counts = {}
    for hot in (300, 600):
        plate = {"Domain/Upper corner": "0.0124, 0.005", BC + "Convection": "bottom: 6e4, 20", "Initial and source/Initial value": str(hot),
                 "Elasticity/Reference temperature": str(hot), "Output/Write at": ""}
        run = run_scene("prm/fracture/quenched_alumina.prm", {**FIELDS, **plate, "Domain/Cells": "62, 25", "Time/End time": "0.02", "Time/Time step": "5e-4"})
        x, y, damage = measures.Result(run.folder).damage()
        counts[hot] = [measures.cracks_at(x, y, damage, depth) for depth in (4e-4, 8e-4)]
        heat = run.model(COUPLED)["heat balance"]["cumulative"]
        check(heat["scale"] > 1000, f"heat leaves: {heat}")
        table.add_limit(f"{hot} C: heat imbalance since start over what has left", abs(heat["imbalance"]) / heat["scale"], 1e-11)
        strain = 5e-4 * hot / 300
        uniform = run_scene("prm/fracture/quenched_alumina.prm", {
            **NO_FIELDS, **plate, "Domain/Cells": "124, 50", "Material/Fracture energy": "", "Material/Critical stretch": str(strain),
            "Time/End time": "3.2e-3", "Time/Time step": "5e-5"})
        found = next((row[0] for row in history(uniform, BROKEN, model=COUPLED) if row[1] > 0), math.inf)
        table.add(f"{hot} C: time of the first break over that of theory", found / first_break(hot - 20, strain), 1, absolute=0.02)  # measured: -0.011, -0.012; a step is 0.02
    # Measured: 6 and 0 cracks reach 0.4 and 0.8 mm after 300 C, 9 and 3 after 600 C.
    check(counts[300][0] >= 4, f"cracks after 300 C: {counts[300]}")
    check(counts[600][0] > counts[300][0] and counts[600][1] > counts[300][1], f"more and longer cracks after 600 C: {counts}")
    table.show()


def impact():
    """Kalthoff and Winkler: when the cracks leave the notches, where to and how fast."""
    table = Comparison("Kalthoff and Winkler, 100 x 200 cells, m = 4")
    tip = (0.05, 0.025)
    for plane, angle in (("strain", 6.4), ("stress", 1.5)):
        run = measures.Result(run_scene("prm/fracture/kalthoff_winkler.prm", {**FIELDS, "Output/Write every": "5e-6", "Elasticity/Plane": plane, "Peridynamics/Horizon ratio": "4"}).folder)
        places = [(time, measures.furthest(*run.damage(entry), tip, 2e-3)) for entry, time in enumerate(run.times())]
        places = [(time, math.dist(place, tip)) for time, place in places if place is not None and place[1] < 0.095]
        speed = (places[-1][1] - places[0][1]) / (places[-1][0] - places[0][0])
        angles = [measures.direction(*run.damage(), (tip[0], side * tip[1]), side) for side in (1, -1)]
        table.add(f"plane {plane}: the cracks are mirrored, degrees apart", angles[0] - angles[1], 0, absolute=0.5)  # measured: 0.2: which of two bonds breaks first
        table.add(f"plane {plane}: angle to the notch (published: 65 to 70)", angles[0], 65, absolute=angle)  # measured: 61.4 and 64.2
        table.add(f"plane {plane}: leaves the notch at (microseconds; published: 25 to 30)", 1e6 * (places[0][0] - places[0][1] / speed), 25, absolute=1.2)  # measured: 24.6 and 24.8
        table.add(f"plane {plane}: mean speed over published 1000 m/s", speed / 1000, 1, absolute=0.6)  # measured: 1.41, 1.42
        check(speed < 2799, f"slower than Rayleigh's waves: {speed}")
    table.show()


def space():
    """In the setting of CabanaPD's regression test the furthest damaged node is near where it has it."""
    table = Comparison("Kalthoff and Winkler in space, CabanaPD's setting")
    run = run_scene("prm/fracture/kalthoff_winkler_3d.prm", FIELDS)
    check_balances(run, "kalthoff_winkler_3d")
    nodes, damage = measures.nodes_and_damage(measures.Result(run.folder))
    for side in (1, -1):
        table.add(f"furthest damage above 0.35, side {side} (mm)", 1e3 * (side * nodes[damage > measures.SHOWN, 1]).max(), 74.2, absolute=5.2)  # measured: 77.5; a spacing is 1.32
    table.show()


def glass():
    """Glass that branches once, both branches alike, at less than Rayleigh's speed."""
    table = Comparison("Branching glass, 200 x 80 cells, m = 4")
    run = run_scene("prm/fracture/branching_glass.prm", {**FIELDS, "Domain/Cells": "200, 80", "Output/Write every": "2.5e-6"})
    check_balances(run, "branching_glass")
    result = measures.Result(run.folder)
    x, y, damage = result.damage()
    where = measures.branching(x, y, damage, 1.2e-3, 0.05, 0.016)
    check(where is not None, "the crack branches")
    ends = [(time, measures.front(*result.damage(entry), 0.016)) for entry, time in enumerate(result.times())]
    moving = [(time, place) for time, place in ends if 0.0505 < place < 0.098]
    speed = (moving[-1][1] - moving[0][1]) / (moving[-1][0] - moving[0][0])
    check(speed < 3156, f"slower than Rayleigh's waves: {speed}")
    table.add("branches at (mm; with a quarter of the horizon at 66.6)", 1e3 * where, 66.6, absolute=6.2)  # measured: 70.5
    for side in (1, -1):
        tip = measures.front(x, side * y[::side], damage[:, ::side] * (side * y[::side] > 2e-3), 0.016)
        check(tip > 0.09, f"branch on side {side} ends at {tip}")
    # Where bonds carry all of the stiffness, with a zone that follows as well. Measured: 69.5 (70.0 in peridynamics with this nu).
    zone = run_scene("prm/fracture/branching_glass.prm", {**FIELDS, "Domain/Cells": "200, 81", "Domain/Nodes": "vertices", "Models": COUPLED, "Coupling/Zone": "follow",
                                                          "Material/Poisson ratio": "1/3", "Output/Write every": ""})
    divides = measures.branching(*measures.Result(zone.folder).damage(), 1.2e-3, 0.05, 0.016)
    check(divides is not None, "the crack branches in a zone that follows")
    table.add("a zone that follows, nu = 1/3: branches at (mm)", 1e3 * (divides or 0), 1e3 * where, absolute=1.6)
    # Only sigma^2/(E G) counts, and powers of two change no digit.
    scaled = run_scene("prm/fracture/branching_glass.prm", {**NO_FIELDS, "Domain/Cells": "200, 80", "Output/Write every": "2.5e-6", "Material/Fracture energy": "15.2",
                                                            BC + "Traction": "top: 0, 4e6; bottom: 0, -4e6"})
    pairs = list(zip(history(run, BROKEN), history(scaled, BROKEN)))
    check(len(pairs) > 10 and all(a == b for a, b in pairs), f"twice the load on four times the energy breaks as many bonds at all times: {pairs[-1]}")
    table.show()


def loads(run, model):
    """Forces on the load, in N."""
    return [-0.05 * row[1] for row in history(run, "force on load in y", model=model)]


def beam():
    """A brittle beam of concrete breaks at the load of linear fracture mechanics, which is not that of concrete, and is as stiff as finite elements."""
    table = Comparison("Concrete beam with half a notch, 20 cells high")
    elastic = {**NO_FIELDS, "Models": COUPLED, "Domain/Nodes": "vertices", "Domain/Cells": "141, 40", "Peridynamics/Horizon ratio": "3", "Material/Fracture energy": "",
               BC + "Traction": "load: 0, -200", BC + "Displacement": "left foot: 0, 0 ; right foot: free, 0", "Time/Time step": "auto", "Output/Write every": ""}
    run = run_scene("prm/fracture/half_notched_beam.prm", elastic)
    intensity = next(iter(run.model(COUPLED)["stress intensity"].values()))["I"]  # of 1 N per m of thickness
    expected = 0.05 * math.sqrt(37e9 * 143.2) / intensity
    opening = {place: run.probe(COUPLED, (place, 0), column="ux") for place in (-0.01, 0.01)}
    stiffness = 0.05 / (opening[0.01] - opening[-0.01])
    # Measured: 0.945 (0.972 where bonds break at rest) and 0.987, 1.128 and 0.994 (lattice trapping; doc/fracture.md).
    for name, bounds, settings, model in (("peridynamics, m = 5", (0.08, 0.021), {"Domain/Cells": "105, 30", "Solver/Tolerance": "1e-7"}, PD),
                                          ("zone that follows, m = 3", (0.2, 0.01), {"Domain/Cells": "71, 20", "Domain/Nodes": "vertices", "Models": COUPLED, "Coupling/Zone": "follow",
                                                                                     "Peridynamics/Horizon ratio": "3"}, COUPLED)):
        run = run_scene("prm/fracture/half_notched_beam.prm", {**NO_FIELDS, **settings, "Time/Time step": "0.04"})
        check_balances(run, f"half_notched_beam, {name}")
        found = loads(run, model)
        opened = run.probe(model, (0.01, 0), time=0.3, column="ux") - run.probe(model, (-0.01, 0), time=0.3, column="ux")
        at = next(-0.05 * row[1] for row in history(run, "force on load in y", model=model) if abs(row[0] - 0.3) < 1e-9)
        table.add(f"{name}: peak over linear fracture mechanics", max(found) / expected, 1, absolute=bounds[0])
        table.add(f"{name}: stiffness at the notch over that of elements", at / opened / stiffness, 1, absolute=bounds[1])
        check(found[-1] < 0.6 * max(found), f"{name}: the beam has broken: {found[-1]} of {max(found)}")
    table.show()


def eccentric():
    """A beam with an eccentric notch is as stiff as the measured one, and its crack runs towards the load."""
    table = Comparison("Concrete beam with an eccentric notch, 32 cells high")
    run = run_scene("prm/fracture/eccentric_notch.prm", {**FIELDS, "Domain/Cells": "101, 32", "Time/Time step": "0.04", "Output/Write at": "0.2, 1", "Output/Write every": ""})
    check_balances(run, "eccentric_notch")
    opened = run.probe(COUPLED, (0.085, 0), time=0.2, column="ux") - run.probe(COUPLED, (0.065, 0), time=0.2, column="ux")
    at = next(-0.05 * row[1] for row in history(run, "force on load in y", model=COUPLED) if abs(row[0] - 0.2) < 1e-9)
    found = loads(run, COUPLED)
    table.add("stiffness at the notch over the measured one, 498 to 510 kN/mm", at / opened / 504e6, 1, absolute=0.027)  # measured: 0.983
    check(found[-1] < 0.2 * max(found), f"the beam has broken: {found[-1]} of {max(found)}")
    x, y, damage = measures.Result(run.folder).damage()
    places = np.argwhere((damage > measures.SHOWN) & (y[None, :] > 0.024) & (y[None, :] < 0.07))
    slope = np.polyfit(y[places[:, 1]], x[places[:, 0]], 1)[0]
    check(y[places[:, 1]].max() > 0.06, f"the crack has grown to {y[places[:, 1]].max()}")
    check(0.25 < slope < 0.83, f"the crack leans towards the load, which is at a slope of 0.83: {slope}")  # measured: 0.41
    table.show()


def strip():
    """A strip of glass, quenched at a moving front: no crack where it is little colder, else one that follows the front."""
    table = Comparison("Strip of glass, 100 x 21 cells")
    for difference in (60, 140):
        run = run_scene("prm/fracture/quenched_strip.prm", {
            **FIELDS, "Domain/Cells": "100, 21", "Time/Time step": "2", "Output/Write at": "40, 80",
            "Initial and source/Initial value": f"-{difference}*if(x < 0.008, 1, exp(-638*(x - 0.008)))",
            "Initial and source/Source": f"-{difference}*6.77e5*exp(-4e6*(x - 0.008 - 3e-4*t)^2)"})
        check_balances(run, f"quenched_strip, {difference} K")
        run = measures.Result(run.folder)
        if difference == 60:
            check(run.history(BROKEN)[-1][1] == 0, f"60 K: no bond breaks: {run.history(BROKEN)[-1]}")
            continue
        for entry, time in enumerate(run.times()):
            table.add(f"140 K: end of the crack before the front at {time:g} s, mm", 1e3 * (measures.front(*run.damage(entry), 0.005) - 0.008 - 3e-4 * time), 0, absolute=1.2)  # measured: 1, two cells (without contact one)
    table.show()


def torsion():
    """A beam with a deep notch, twisted: it breaks near the torque of linear fracture mechanics, and the two halves that a half turn about the notch's middle exchanges alike."""
    table = Comparison("Twisted beam, 5 cells high")
    run = run_scene("prm/fracture/notched_torsion.prm", {**FIELDS, "Domain/Cells": "20, 5, 5", "Time/Time step": "0.05"})
    check_balances(run, "notched_torsion")
    rows = [row for row in history(run, "strain energy", "energy imbalance", "energy dissipated", model=COUPLED) if row[0] > 0]
    torques = [2 * row[1] / (6e-3 * row[0]) for row in rows]
    table.add("largest torque over that of linear fracture mechanics, 730 N m", max(torques) / 730, 1, absolute=0.19)  # measured: 1.13; on the scene's lattice 1.18
    check(torques[-1] < 0.05 * max(torques), f"the beam has broken: {torques[-1]} of {max(torques)}")
    table.add("area of the crack over what the notch had left", run.total("crack area", COUPLED) / (0.05 * 0.1 * math.sqrt(2)), 1, absolute=0.3)  # measured: 1.19; on the scene's lattice 0.93
    table.add_limit("energy imbalance over dissipated", max(abs(row[2]) for row in rows) / rows[-1][3], 1e-6)
    nodes, damage = measures.nodes_and_damage(measures.Result(run.folder))
    turned = {tuple(np.round(p * np.array([-1, 1, -1]), 6) + 0.0): value for p, value in zip(nodes, damage)}
    table.add_limit("damage that a half turn changes", max(abs(value - turned[tuple(np.round(p, 6) + 0.0)]) for p, value in zip(nodes, damage)), 1e-9)
    table.show()


if __name__ == "__main__":
    run_parts(quench, impact, space, glass, beam, eccentric, strip, torsion)
