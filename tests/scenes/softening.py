# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Bonds that soften: half-notched beams against an independent cohesive model, stopped and resumed, on several processes, in motion, and what is refused.

    softening.py beams      largest forces, energies, another step
    softening.py glue       what an interface takes up that opens, by its own bonds and beside it, and in steps of another length
    softening.py eccentric  a beam that cracks beside its middle, against a measured force
    softening.py zone       the same beams as finite elements with a zone that follows
    softening.py controlled loads that go back: a bar with snap-back against its closed form, brittle bonds, on several processes (resumed: resume.py)
    softening.py zones      more beams with a zone
    softening.py resume     a run that stops and goes on; 2 processes; full kinematics
    softening.py refusals   entries that do not go together
"""

from scene_test import COUPLED, PD, Comparison, check, check_less, check_message, run_parts, run_scene, scene_text

BEAM = "prm/fracture/softening_beam.prm"
THICKNESS = 0.05

# Largest forces in kN (thickness 50 mm) of half a beam of bilinear elements whose middle plane opens by the same curve, of this depth in m: E = 37 GPa, f_t = 3.9 MPa,
# G = 143.2 J/m^2, span 2.5 depths.
COHESIVE = {(0.05, "exponential"): 1.237, (0.1, "exponential"): 2.189, (0.05, "linear"): 1.351}


def beam(depth, high, odd=0, **more):
    """Overrides for a beam of this depth, so many cells high: nodes are where its feet are if 1.25 high - 0.5 is a whole number (odd = 1: those at vertices)."""
    h = depth / high
    n = 2 * round(1.8 * high) + odd
    foot, load = 0.55 * h, max(0.04 * depth, 1.1 * h)
    overrides = {
        "Domain/Lower corner": f"{-0.5 * n * h}, 0", "Domain/Upper corner": f"{0.5 * n * h}, {depth}", "Domain/Cells": f"{n}, {high}",
        "Boundary conditions/Parts": f"load: top if abs(x) < {load} ; left foot: bottom if abs(x + {1.25 * depth}) < {foot} ; right foot: bottom if abs(x - {1.25 * depth}) < {foot}",
        "Cracks/Segments": f"0,0 ; 0,{0.5 * depth}", "Output/Probes": ""}
    overrides.update({entry.replace("_", "/", 1).replace("_", " "): value for entry, value in more.items()})
    return overrides


def largest_force(run, model=PD):
    """In kN."""
    return 1e-3 * THICKNESS * abs(run.model(model)["largest force"]["value"])


def finer_beams():
    table = Comparison("half-notched beams, largest force in kN")
    for depth, more, bound in ((0.05, {}, 0.02), (0.1, {"Boundary conditions_Displacement": "load: free, -8e-5*t ; left foot: 0, 0 ; right foot: free, 0"}, 0.05)):
        table.add(f"depth {depth}, 30 cells", largest_force(run_scene(BEAM, beam(depth, 30, **more))), COHESIVE[depth, "exponential"], relative=bound)
    table.show()


def beams():
    table = Comparison("half-notched beams, largest force in kN")
    first = None
    for depth, high, curve, more, bound in (
            (0.05, 18, "exponential", {}, 0.05), (0.05, 18, "exponential", {"Peridynamics_Horizon_ratio": "4"}, 0.05), (0.05, 18, "linear", {}, 0.05),
            (0.05, 18, "exponential", {"Elasticity_Model": "state-based", "Material_Poisson_ratio": "0.2"}, 0.05)):
        run = run_scene(BEAM, beam(depth, high, Material_Softening=curve, **more))
        force = largest_force(run)
        table.add(f"depth {depth}, {high} cells, {curve} {more}", force, COHESIVE[depth, curve], relative=bound)
        if high == 18 and curve == "exponential" and not more:
            first = force
        energy = run.model(PD)["energy balance"]
        check_less(abs(energy["imbalance"]), 1e-3 * energy["work"], "balance of energy")
        check(energy["dissipated"] > 0.2 * energy["work"], f"energy dissipated: {energy['dissipated']} of {energy['work']}")
    halved = run_scene(BEAM, beam(0.05, 18, Time_Time_step="0.0125"))
    table.add("the same, steps half as long", largest_force(halved), first, relative=0.01)
    table.show()


def glue():
    """A bar between two planes of symmetry whose interface has two thirds of its strength. Where the bar is far stronger only bonds across it soften."""
    table = Comparison("glued bar pulled apart, energy dissipated over that of the glue")
    energy, strength, height = 0.1432, 2.6, 10
    bar = {"Domain/Upper corner": f"30, {height}", "Domain/Cells": "30, 10", "Material/Softening": "exponential", "Material/Fracture energy": "0.1432", "Material/Phases/Regions": "left: 15.000001 - x",
           "Material/Interfaces": f"left/elsewhere: fracture energy {energy}, tensile strength {strength}", "Boundary conditions/Displacement": f"left: 0, free ; right: {12 * energy / strength}*t^2, free",
           "Elasticity/Breaking": "auto", "Time/End time": "1", "Time/Time step": "0.01", "Output/Fields": "none", "Output/Probes": "", "Output/Write at": ""}
    stronger = {"Material/Tensile strength": "78", "Material/Fracture energy": "60"}
    state_based = {"Elasticity/Model": "state-based", "Material/Poisson ratio": "0.2"}
    for what, more, bound in (("crossing bonds alone", stronger, 0.005), ("all", {}, 0.01), ("crossing bonds alone, state-based", {**stronger, **state_based}, 0.01), ("all, state-based", state_based, 0.02),
                              ("crossing bonds alone, m = 4", {**stronger, "Peridynamics/Horizon ratio": "4"}, 0.005), ("steps half as long", {**stronger, "Time/Time step": "0.005"}, 0.005)):
        run = run_scene("prm/fracture/snap_back.prm", {**bar, **more})
        table.add(what, run.total("energy dissipated", PD) / height / energy, 1, absolute=bound)
        check_less(abs(run.total("force on right in x", PD)), 1e-2 * strength * height, f"{what}: the force at the end")
    table.show()


def eccentric():
    """Measured: 5.4 kN (Garcia-Alvarez et al. 2012)."""
    table = Comparison("beam with an eccentric notch, largest force in kN")
    run = run_scene("prm/fracture/softening_eccentric.prm", {"Time/End time": "0.85", "Output/Fields": "none"})
    table.add("measured", largest_force(run), 5.4, relative=0.03)
    table.show()
    energy = run.model(PD)["energy balance"]
    check_less(abs(energy["imbalance"]), 1e-3 * energy["work"], "balance of energy")


ZONE = "prm/fracture/softening_zone.prm"


def beams_with_zones(cases):
    table = Comparison("beams with a zone whose bonds soften, largest force in kN")
    for depth, curve, more in cases:
        run = run_scene(ZONE, beam(depth, 30, odd=1, Material_Softening=curve, **more))
        table.add(f"depth {depth}, {curve} {more}", largest_force(run, COUPLED), COHESIVE[depth, curve], relative=0.02)
        energy = run.model(COUPLED)["energy balance"]
        check_less(abs(energy["imbalance"]), 1e-4 * energy["work"], "balance of energy")
        check_less(abs(energy["released by joining"]), 1e-2 * energy["work"], "released by joining")
    return table


def zones():
    """Finer beams, and the others of the cohesive model."""
    finer_beams()
    cubes = "load: free, -8e-5*t ; left foot: 0, 0 ; right foot: free, 0"
    beams_with_zones(((0.05, "exponential", {}), (0.05, "exponential", {"Peridynamics_Horizon_ratio": "4"}), (0.1, "exponential", {"Boundary conditions_Displacement": cubes}))).show()


def zone():
    scene = ZONE
    table = beams_with_zones(((0.05, "linear", {}),))
    # Where sides are left as they are, both models have the same bonds around the notch.
    coarse = beam(0.05, 18, odd=1)
    first = run_scene(scene, coarse)
    alone = run_scene(scene, {**coarse, "Models": PD, "Peridynamics/Surface correction": "none"})
    table.add("coarser, of peridynamics alone", largest_force(first, COUPLED), largest_force(alone), relative=2e-3)
    everywhere = run_scene(scene, {**coarse, "Coupling/Zone": "everywhere"})
    table.add("a zone everywhere", largest_force(everywhere, COUPLED), largest_force(first, COUPLED), relative=2e-3)
    halved = run_scene(scene, {**coarse, "Time/Time step": "0.0125"})
    table.add("steps half as long", largest_force(halved, COUPLED), largest_force(first, COUPLED), relative=0.005)
    two = run_scene(scene, coarse, ranks=2)
    table.add("on 2 processes", largest_force(two, COUPLED), largest_force(first, COUPLED), relative=1e-5)
    table.show()


def controlled():
    table = Comparison("loads that go back where bonds soften")
    scene, length, height, strength, opening = "prm/fracture/snap_back.prm", 2000, 100, 2, 0.05
    run = run_scene(scene, {"Output/Fields": "none"})
    of = {name: {row["time"]: row["value"] for row in run.totals if row["quantity"] == name} for name in ("force on right in x", "load factor", "energy dissipated", "strain energy")}
    stiffness = 37000 / (1 - 1 / 9) * height / length # neither end nor side lets it become narrower
    way = [(0.2 * t * factor, of["force on right in x"][t]) for t, factor in sorted(of["load factor"].items())]
    peak = max(force for _, force in way)
    table.add("largest force over that of the glue", peak / height / strength, 1, absolute=0.08) # measured: 0.93, as sides that go on hold the glue, too
    after = way[[force for _, force in way].index(peak):]
    low = [(u, force) for u, force in after if 0.15 * peak < force < 0.6 * peak] # farther on oblique bonds, whose ends the opening stretches less, are left
    check(len(low) > 5 and min(u for u, _ in low) < 0.65 * after[0][0], f"the end of the bar comes back: {way}")
    for u, force in low:
        table.add(f"displacement at {force:.3g} N", u, force / stiffness + opening * (1 - force / (height * strength)), relative=0.04)
    table.add("energy dissipated over that of the glue", run.total("energy dissipated", PD) / height / 0.05, 1, absolute=0.015)
    check_less(abs(run.total("energy imbalance", PD)), 1e-8 * run.total("energy dissipated", PD), "balance of energy")
    table.add("work of loads, over that", run.total("work of loads and supports", PD) / run.total("energy dissipated", PD), 1, absolute=1e-6)
    table.add("load factor at the end, when all is open", of["load factor"][max(of["load factor"])], 1, absolute=0)
    # At once it gives off what the bar has stored, too.
    table.add("energy dissipated at once", run_scene(scene, {"Output/Fields": "none", "Elasticity/Breaking": "auto"}).total("energy dissipated", PD), 0.5 * peak**2 / stiffness, relative=0.1)
    two = run_scene(scene, {"Output/Fields": "none"}, ranks=2)
    table.add("energy dissipated, 2 processes", two.total("energy dissipated", PD), run.total("energy dissipated", PD), relative=1e-6)
    # Beams hardly snap back; loads that do not go back are those of their steps (half as long: 0.3 % less).
    free, led = (run_scene(ZONE, beam(0.05, 18, odd=1, Elasticity_Breaking=how)) for how in ("auto", "controlled"))
    table.add("beam with a zone that follows", largest_force(led, COUPLED), largest_force(free, COUPLED), relative=0.012)
    # Brittle bonds break one after the other, in a symmetric plate two by two, on any number of processes.
    plate = {"Domain/Cells": "16, 32", "Time/Time step": "0.05", "Solver/Tolerance": "1e-13", "Output/Fields": "none", "Output/Write at": ""}
    led, on_two = (run_scene("prm/fracture/centre_crack.prm", {**plate, "Elasticity/Breaking": "controlled"}, ranks=n) for n in (1, 2))
    rest = run_scene("prm/fracture/centre_crack.prm", {**plate, "Elasticity/Breaking": "at rest"})
    table.add("brittle plate with a crack, largest force", abs(led.model(PD)["largest force"]["value"]), abs(rest.model(PD)["largest force"]["value"]), relative=0.01)
    for quantity in ("broken bonds", "energy dissipated"):
        for t in (0.9, 1):
            table.add(f"{quantity}, t = {t}, 2 processes", on_two.total(quantity, PD, t), led.total(quantity, PD, t), relative=1e-7)
    check(led.total("broken bonds", PD, 0.9) > 0 and all(row["value"] % 2 == 0 for row in led.totals if row["quantity"] == "broken bonds"), "bonds break two by two")
    refused = run_scene(BEAM, {"Elasticity/Breaking": "controlled", "Elasticity/Model": "state-based", "Elasticity/Plane": "strain", "Material/Law": "viscoelastic", "Material/Tensile strength": "", "Material/Relaxation": "0.5, 1"}, expect_error=True)
    check_message(refused, "'Breaking' in section 'Elasticity'", "'controlled'", "'Law = linear'")
    table.show()


def resume():
    coarse = beam(0.05, 18)
    whole, two = (run_scene(BEAM, {**coarse, "Time/End time": "0.6"}, ranks=n) for n in (1, 2))
    check(abs(largest_force(two) / largest_force(whole) - 1) < 2e-3, f"2 processes: {largest_force(two)}, 1: {largest_force(whole)}")
    full = run_scene(BEAM, {**coarse, "Elasticity/Kinematics": "full", "Elasticity/Solver": "conjugate gradients", "Time/End time": "0.5", "Time/Time step": "0.05"})
    linear = run_scene(BEAM, {**coarse, "Time/End time": "0.5", "Time/Time step": "0.05"})
    check(abs(largest_force(full) / largest_force(linear) - 1) < 0.02, f"full kinematics: {largest_force(full)}, linear: {largest_force(linear)}")


def refusals():
    for overrides, words in (
            ({"Material/Tensile strength": ""}, ("Tensile strength", "is empty, which 'Law = softening' needs")),
            ({"Material/Fracture energy": ""}, ("Fracture energy", "is empty, which 'Law = softening' needs")),
            ({"Material/Law": "linear"}, ("Tensile strength", "is for 'Law = softening'")),
            ({"Material/Tensile strength": "-1"}, ("Tensile strength",)),
            ({"Material/Critical stretch": "1e-4", "Material/Fracture energy": ""}, ("Critical stretch", "brittle")),
            ({"Elasticity/Breaking": "at rest"}, ("Breaking", "softening")),
            ({"Models": "finite elements"}, ("Law", "for 'Models = peridynamics' and 'coupled'")),
            ({"Models": "coupled", "Elasticity/Model": "state-based"}, ("Scheme", "Use 'blending'")),
            ({"Material/Softening": "cubic"}, ("Softening", "linear, bilinear, exponential"))):
        check_message(run_scene(BEAM, overrides, expect_error=True), *words)


if __name__ == "__main__":
    run_parts(beams, glue, eccentric, zone, controlled, resume, refusals, zones=zones)
