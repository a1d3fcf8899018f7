# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""What a scene of heat or moisture gets when it asks for nothing special.

    heat_defaults.py material    conductivity and storage of T: flows by Kirchhoff's transformation, transients by finite volumes in 1D
    heat_defaults.py fall_back   what keeps bonds from exchange: the note, and its advice
    heat_defaults.py moisture    two layers of other saturated concentrations: what is continuous, and `Diffusivity`
    heat_defaults.py steady      an effective conductivity is told of steady states alone
    heat_defaults.py sudden      a body at 0 that a source heats from one moment to another
"""

import math

import numpy as np

from scene_test import PD, Comparison, check, run_parts, run_scene, scene_text
from scene_texts import grid_mesh, shaken

ALL = "finite elements, peridynamics, coupled"

STEADY = "Time/Steady = true"


def wall(material, cells="20, 20", dim=2, models=PD, sides="left: 0; right: 1", more=STEADY, physics="heat"):
    """A body of unit length whose cells are squares or cubes."""
    n = [int(word) for word in cells.split(",")]
    return scene_text(f"""
Dimension = {dim}
Physics = {physics}
Models = {models}
Domain/Cells = {cells}
Domain/Upper corner = {", ".join(str(k / n[0]) for k in n)}
Boundary conditions/Dirichlet = {sides}
Coupling/Zone = 0.3 - abs(x - 0.5)
""" + "".join(f"Material/{line}\n" for line in material) + more)


def transient(stepper, end, step="", probes="0.25 ; 0.5 ; 0.75", initial="0"):
    return (f"Time/Stepper = {stepper}\nTime/End time = {end}\n" + (f"Time/Time step = {step}\n" if step else "") +
            f"Initial and source/Initial value = {initial}\nOutput/Probes = {probes}\n")


def finite_volumes(conductivity, storage, end, left=0.0, right=1.0, cells=200, saturated=None):
    """Values at 1/4, 1/2 and 3/4 of a bar from 0 on, by finite volumes and a trapezoidal rule in time (Heun's method)."""
    h = 1 / cells
    x = (np.arange(cells) + 0.5) * h

    def rate(u):
        k = conductivity(x, u)
        between = (u[1:] - u[:-1]) * 2 * k[1:] * k[:-1] / (k[1:] + k[:-1]) / h
        ends = [2 * conductivity(np.array([0.0]), np.array([left]))[0] * (u[0] - left) / h,
                2 * conductivity(np.array([1.0]), np.array([right]))[0] * (right - u[-1]) / h]
        flux = np.concatenate(([ends[0]], between, [ends[1]]))
        return (flux[1:] - flux[:-1]) / h / storage(x, u)

    u = np.zeros(cells)
    sizes = np.linspace(min(left, right, 0), max(left, right, 0), 50)
    fastest = max(float(np.max(conductivity(np.full(50, p), sizes) / storage(np.full(50, p), sizes))) for p in (0.1, 0.9))
    steps = math.ceil(end / (0.4 * h * h / fastest))
    for _ in range(steps):
        first = rate(u)
        u = u + 0.5 * end / steps * (first + rate(u + end / steps * first))
    return [float(np.interp(p, x, u)) for p in (0.25, 0.5, 0.75)]


def distorted_mesh(n=16):
    """The file of a square of quadrilaterals whose inner vertices are out of place."""
    return grid_mesh((n, n), shaken(1 / n, 0.15, (n, n)))


def flow(run, model=PD, side="right"):
    return run.model(model)["boundary flux"][side]


def material():
    table = Comparison("Material of T")
    # The first is of a user; the others have the flow of the mean conductivity, whatever the profile.
    for dim, cells in ((1, "40"), (2, "40, 40"), (3, "8, 8, 8")):
        run = run_scene(wall(["Conductivity = 1 + 1e-6*T"], cells, dim, ALL if dim > 1 else PD))
        for model in run.summary["models"]:
            table.add(f"1 + 1e-6 T, {dim}D, {model}", run.model(model)["effective conductivity"], 1 + 5e-7, relative=1e-5)
        check("Boundary treatment" not in run.stdout, f"{dim}D: nothing is said of a worse treatment")
    for b, cells, ranks in ((1, "20, 10", 1), (4, "20, 10", 2), (20, "40, 6", 1)):
        run = run_scene(wall([f"Conductivity = 1 + {b}*T"], cells, models=ALL), ranks=ranks)
        for model in run.summary["models"]:
            table.add(f"1 + {b} T, {model}", run.model(model)["effective conductivity"], 1 + b / 2, relative=2e-3)
    on_mesh = {"Domain/Cells": "1, 1", "Domain/Shape": "mesh file", "Domain/Mesh file": distorted_mesh(), "Peridynamics/Horizon": "0.19",
               "Boundary conditions/Dirichlet": "1: 0; 2: 1"}
    for ranks in (1, 2):
        run = run_scene(wall(["Conductivity = 1 + 4*T"]), on_mesh, ranks=ranks)
        table.add(f"1 + 4 T, mesh from a file, {ranks} processes", flow(run, side="2"), 3, relative=5e-3)
    # Transients.
    one = lambda x, u: np.ones_like(u)
    for title, lines, k, c in (("conductivity", ["Conductivity = 1 + 2*T"], lambda x, u: 1 + 2 * u, one),
                               ("storage", ["Heat capacity = 1 + 2*T", "Density = 1"], one, lambda x, u: 1 + 2 * u),
                               ("both", ["Conductivity = 1 + T", "Heat capacity = 1 + 2*T"], lambda x, u: 1 + u, lambda x, u: 1 + 2 * u)):
        end = 0.1
        exact = finite_volumes(k, c, end, cells=100)
        for stepper, step, dim, cells in (("auto", "", 2, "30, 8"), ("rkc2", "", 1, "30"), ("bdf2", "0.002", 1, "30"), ("sdirk2", "0.005", 2, "30, 6")):
            probes = "0.25 ; 0.5 ; 0.75" if dim == 1 else "0.25, 0 ; 0.5, 0 ; 0.75, 0"
            run = run_scene(wall(lines, cells, dim, more=transient(stepper, end, step, probes)))
            for x, value in zip((0.25, 0.5, 0.75), exact):
                table.add(f"{title}, {stepper}, {dim}D, x = {x}", run.probe(PD, (x,) if dim == 1 else (x, 0), time=end), value, absolute=4e-3)
    table.show()


def fall_back():
    centers = {"Domain/Nodes": "cell centers"}
    for dim, cells in ((1, "20"), (2, "20, 20")):
        run = run_scene(wall(["Conductivity = 2"], cells, dim), centers)
        share = run.model(PD)["effective conductivity"] / 2
        check(abs(share - 1) > 0.005, f"{dim}D, cell centers: {share:.4f} of the conductivity")
        check("'Boundary treatment = auto'" in run.stdout + run.stderr and "Nodes = vertices" in run.stdout + run.stderr,
              f"{dim}D, cell centers: a note says what it costs and what to do")
        check(abs(run_scene(wall(["Conductivity = 2"], cells, dim), {"Domain/Nodes": "vertices"}).model(PD)["effective conductivity"] - 2) < 1e-6,
              f"{dim}D: the advice is taken and right")


def moisture():
    table = Comparison("Two layers of saturated concentrations 10 and 1, D = 1 in both")
    layers = ["Phases/Regions = wet: 0.5 - x", "Phases/Saturated concentration = wet: 10"]
    for models, dim, cells in ((ALL, 2, "20, 6"), (PD, 1, "20")):
        for lines, expected in ((["Conductivity = 1"], 0.5), (["Diffusivity = 1"], 10 / 11), (["Diffusivity = 5", "Phases/Diffusivity = wet: 1"], 10 / 15)):
            run = run_scene(wall(lines + layers, cells, dim, models, "left: 1; right: 0", STEADY, "moisture"), {"Output/Probes": "0.5" if dim == 1 else "0.5, 0"})
            for model in run.summary["models"]:
                place = (0.5,) if dim == 1 else (0.5, 0)
                rows = run.rows(model, place)
                table.add(f"{lines[0]}, {model}, {dim}D: wetness between", float(rows[-1]["value"]), expected, relative=1e-6)
            check(("'Diffusivity'" in run.stdout + run.stderr) == lines[0].startswith("Conductivity"), f"{lines[0]}: the note says what is continuous")
    end = 0.1
    exact = finite_volumes(lambda x, u: np.where(x < 0.5, 10.0, 1.0), lambda x, u: np.where(x < 0.5, 10.0, 1.0), end, left=1.0, right=0.0, cells=100)
    run = run_scene(wall(["Diffusivity = 1", *layers], "40", 1, PD, "left: 1; right: 0", transient("auto", end), "moisture"))
    for x, value in zip((0.25, 0.5, 0.75), exact):
        table.add(f"transient, x = {x}", run.probe(PD, (x,), time=end), value, absolute=4e-3)
    check(run.summary["moisture counts"] == "mass", "with Diffusivity flows and amounts are masses")
    table.show()


def steady():
    for end, told in (("0.01", False), ("2", True)):
        run = run_scene(wall(["Conductivity = 1"], "20", 1, "finite elements, peridynamics", more=f"Time/End time = {end}"))
        for model in run.summary["models"]:
            found = run.model(model).get("effective conductivity")
            check((found is not None) == told, f"t = {end}, {model}: effective conductivity {found}")
            if told:
                check(abs(found - 1) < 2e-3, f"t = {end}, {model}: effective conductivity {found}")


def sudden():
    """A body at 0 that a source heats from one moment to another: whatever the step that meets the beginning, it warms by what the source gives."""
    begin, end = 0.0559, 0.0957
    table = Comparison("a source that is switched on and off")
    for stepper in ("rkc2", "bdf2", "sdirk2", "auto"):
        run = run_scene(wall([], "40", 1, "finite elements, peridynamics", sides="",
                             more=transient(stepper, 0.3, initial="0") + f"Initial and source/Source = if(t > {begin} && t < {end}, 50, 0)\nTime/Tolerance = 1e-5\n"))
        for model in run.summary["models"]:
            table.add(f"{stepper}, {model}", run.probe(model, (0.5,), time=0.3), 50 * (end - begin), relative=2e-3)
    table.show()


if __name__ == "__main__":
    run_parts(material, fall_back, moisture, steady, sudden)
