# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Output directories made up for the tests of the report generator (report_test.py)."""

import json
from pathlib import Path

import h5py
import numpy as np

FEM, PD = "finite elements", "peridynamics"

# What a run of each physics says of itself; runs of heat may leave it out.
SAID = {
    "heat": {},
    "moisture": {
        "physics": "moisture",
        "names": {"field": "wetness", "flux": "moisture_flux", "content": "weight",
                  "flow": "moisture flow", "quantity": "moisture"},
        "units": {"length": "mm", "time": "h", "temperature": "K", "field": ""},
        "text": "A dry plate takes up water from above.\n\nThe crack in its middle is tight."},
    "electricity": {
        "physics": "electricity",
        "names": {"field": "potential", "flux": "current_density", "content": "charge",
                  "flow": "current", "quantity": "charge"},
        "units": {"length": "mm", "time": "s", "temperature": "K", "field": "V"},
        "text": "A plate with an electrode above and one below.\n\nIts crack lets nothing pass."}}
HEAT_NAMES = {"field": "temperature", "flux": "heat_flux", "content": "heat content",
              "flow": "heat flow", "quantity": "heat"}


def names_of(physics):
    """What the physics calls things."""
    return SAID[physics].get("names", HEAT_NAMES)


def box_mesh(lower, upper, cells):
    """Unmerged cells of a box in VTK order: (nodes, cells)."""
    dimension = len(cells)
    ticks = [np.linspace(lower[d], upper[d], cells[d] + 1) for d in range(dimension)]
    index = [i.ravel(order="F") for i in np.meshgrid(*[np.arange(n) for n in cells],
                                                     indexing="ij")]
    corner = {1: [(0,), (1,)], 2: [(0, 0), (1, 0), (1, 1), (0, 1)]}.get(dimension) or \
        [(i, j, k) for k in (0, 1) for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))]
    n_vertices = len(corner)
    nodes = np.empty((len(index[0]), n_vertices, dimension))
    for v, offsets in enumerate(corner):
        for d in range(dimension):
            nodes[:, v, d] = ticks[d][index[d] + offsets[d]]
    return nodes.reshape(-1, dimension), np.arange(len(index[0]) * n_vertices).reshape(
        -1, n_vertices)


def write_fields(path, nodes, cells, fields):
    """One HDF5 file in the layout of deal.II."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with h5py.File(path, "w") as file:
        file["nodes"], file["cells"] = nodes, cells
        for name, values in fields.items():
            file[name] = values.reshape(len(nodes), -1)


def crack_field(x, y, half=0.5, reach=0.0):
    """Flow against an insulated crack |x| < half, y = 0 (left side: above)."""
    z = x + 1j * np.where(y >= 0, np.maximum(y, reach), np.minimum(y, -reach))
    root = np.sqrt(z - half) * np.sqrt(z + half)
    return np.where((root.imag >= 0) == (y >= 0), root.imag, -root.imag)


def write_csv(path, models, times, points, values):
    """line.csv or probes.csv."""
    lines = ["time,model," + ",".join("xyz"[:points.shape[1]]) + ",value"]
    for time in times:
        for model in models:
            for point, value in zip(points, values(model, time, points)):
                lines.append(f"{time!r},{model}," + ",".join(f"{p:.15g}" for p in point)
                             + f",{value:.15g}")
    path.write_text("\n".join(lines) + "\n")


def model_entry(model, times, exact):
    """Numbers of one model."""
    pd = model == PD
    entry = {"unknowns": 14641, "nonzeros": 127449, "steps": 84, "operator applications": 1012,
             "iterations": 0, "stepper": "chebyshev",
             "operator form": "lattice" if pd else "matrix",
             "settings": {"m": "6.5", "kernel": "conical, exponent 2",
                          "volume fraction": "linear"} if pd else
             {"degree": "1", "capacity": "lumped"},
             "wall time": {"setup": 0.21, "solve": 2.4 if pd else 0.8, "output": 0.1},
             "memory": 12_300_000 if pd else 4_500_000, "peak memory": 412_000_000,
             "stable step": {"sharp": 1.43e-4, "safe": 1.21e-4},
             "boundary flux": {"top": 12.3456, "bottom": -12.3449},
             "heat balance": {"throughput": 12.3456, "imbalance": 4e-12}}
    if pd:
        entry["bonds"] = 1234567
        del entry["nonzeros"]
    if exact:
        size = 0.0123 if pd else 0.0041
        entry["errors"] = {"relative l2": [[t, size * (1 + t)] for t in times],
                           "maximum": [[t, 10 * size] for t in times]}
    return entry


def make_summary(directory, title, dimension, lower, upper, times, models, cracks=(), exact=False,
                 steady=False, sides=None, physics="heat"):
    """summary.json and scene.prm."""
    summary = {
        "title": title, "scene file": "scenes/made_up.prm", "dimension": dimension,
        "text": "A plate is hot above & cold below. An insulated crack lies in its middle, so "
                "heat flows round its tips.\n\nThe temperature jumps across the crack <1 cm>: "
                "look at the isotherms, which meet it at right angles.",
        "program": "PeriDeal 0.1.0", "processes": 1,
        "units": {"length": "cm", "time": "s", "temperature": "C"},
        "domain": {"lower": list(lower), "upper": list(upper), "shape": "box"},
        "cracks": [np.asarray(c).tolist() for c in cracks], "steady": steady,
        "end time": times[-1], "write times": times,
        "notes": ["peridynamics: the horizon is 6.5 node spacings.",
                  "Warning: Time step taken as 1.2e-4."],
        "sides": sides or {"top": "Dirichlet 100", "bottom": "Dirichlet -100",
                           "left": "insulated", "right": "convection 25, 20"},
        "fields": [{"time": t, "files": {m: f"fields/{m.replace(' ', '_')}_{i:04d}.h5"
                                         for m in models}} for i, t in enumerate(times)],
        "models": {m: model_entry(m, times, exact) for m in models},
        "comparison": {"relative l2": [[t, 0.0087] for t in times],
                       "maximum": [[t, 3.21] for t in times]} if len(models) == 2 else {},
        "reference": "bobaru 2012 example 1" if exact else ""}
    summary.update(SAID[physics])
    directory.mkdir(parents=True, exist_ok=True)
    (directory / "summary.json").write_text(json.dumps(summary, indent=1))
    (directory / "scene.prm").write_text(
        "set Title = made up\nsubsection Initial and source\n  set Initial value = 7\nend\n")


def make_bar(directory, steady=False):
    """1D, with an exact solution."""
    times = [0.5] if steady else [0.02, 0.1, 0.3, 0.5]
    make_summary(directory, "A bar heated at one end", 1, [0.0], [10.0], times, [FEM, PD],
                 exact=True, steady=steady,
                 sides={"left": "Dirichlet 100*(1-exp(-t))", "right": "insulated"})

    def values(model, time, points):
        x = points[:, 0]
        wrong = {FEM: 0.2, PD: 0.9, "exact": 0}[model]
        return 100 * np.exp(-x / (1 + 12 * time)) + wrong * np.sin(x * 2)

    nodes, cells = box_mesh([0], [10], [50])
    for i, time in enumerate(times):
        for model in (FEM, PD):
            write_fields(directory / f"fields/{model.replace(' ', '_')}_{i:04d}.h5", nodes, cells,
                         {"temperature": values(model, time, nodes),
                          "heat_flux": np.pad(values(model, time, nodes)[:, None],
                                              ((0, 0), (0, 2)))})
    line = np.linspace(0, 10, 101)[:, None]
    write_csv(directory / "line.csv", [FEM, PD, "exact"], times, line, values)
    write_csv(directory / "probes.csv", [FEM, PD, "exact"], times, np.array([[1.0], [5.0]]), values)


def concentration(nodes, cells, values, saturated):
    """A wetness times the saturated concentration of the left or the right half of a body."""
    right = nodes[cells].mean(axis=1)[:, 0] > 0
    found = np.empty_like(values)
    found[cells] = values[cells] * np.where(right, saturated[1], saturated[0])[:, None]
    return found


def plate_values(model, time, points):
    """Temperature of the plate with a crack; PD smears the tips a little."""
    size = 100 * (1 - np.exp(-3 * time))
    field = crack_field(points[:, 0], points[:, 1], 0.5 if model != PD else 0.515)
    return size * (field + 0.12 * points[:, 0] * (1 - points[:, 0] ** 2))


def make_plate(directory, cells=60, models=(FEM, PD), centers=False, upper=(1.0, 1.0),
               hole=False, cracks=None, times=(0.05, 0.2, 0.5), exact=False, physics="heat",
               saturated=(), title="Plate with an insulated crack"):
    """2D plate with a crack; saturated: concentrations of its left and right half."""
    lower, upper = [-upper[0], -upper[1]], list(upper)
    cracks = [[[-0.5, 0], [0.5, 0]]] if cracks is None else cracks
    times = list(times)
    make_summary(directory, title, 2, lower, upper, times, list(models), cracks, exact,
                 physics=physics)
    names = names_of(physics)
    n = [int(round(cells * u / max(upper))) + 1 for u in upper]
    nodes, quads = box_mesh(lower, upper, n)
    if hole:
        quads = quads[np.hypot(*(nodes[quads].mean(axis=1) - 0.3).T) > 0.25]
    middle = np.empty_like(nodes)
    middle[quads.ravel()] = np.repeat(nodes[quads].mean(axis=1), 4, axis=0)
    rows = nodes if not centers else middle
    for i, time in enumerate(times):
        for model in models:
            values = plate_values(model, time, rows)
            h = 1e-3
            flux = np.zeros((len(rows), 3))
            for d in (0, 1):
                step = np.eye(2)[d] * h
                flux[:, d] = -(plate_values(model, time, rows + step)
                               - plate_values(model, time, rows - step)) / (2 * h)
            flux = np.clip(flux, -400, 400)
            fields = {names["field"]: values, names["flux"]: flux}
            if saturated:
                fields["concentration"] = concentration(nodes, quads, values, saturated)
            if model == PD and not centers:
                fields["peridynamics_minus_finite_elements"] = \
                    values - plate_values(FEM, time, rows)
            write_fields(directory / f"fields/{model.replace(' ', '_')}_{i:04d}.h5", nodes, quads,
                         fields)
    shown = list(models) + (["exact"] if exact else [])
    line = np.stack([np.zeros(101), np.linspace(lower[1], upper[1], 101)], axis=1)
    write_csv(directory / "line.csv", shown, times, line, plate_values)
    write_csv(directory / "probes.csv", shown, times, np.array([[0.0, 0.1], [0.5, 0.1]]),
              plate_values)
    totals = ["time,model,quantity,value"]
    for time in times:
        for model in models:
            totals += [f"{time},{model},{names['content']},{12.5 * time}",
                       f"{time},{model},{names['flow']} through top,{3.25 * time}",
                       f"{time},{model},{names['flow']} from sources,0",
                       f"{time},{model},rate of storage,{3.25 * time}"]
    (directory / "totals.csv").write_text("\n".join(totals) + "\n")


def make_ring(directory, cells=12):
    """A quarter of a ring from r = 1 to 2, named with the unit square as its domain."""
    make_summary(directory, "Quarter of a ring", 2, [0, 0], [1, 1], [0.0], [FEM, PD], steady=True,
                 sides={"1": "Dirichlet 100", "2": "Dirichlet -3"})
    polar, quads = box_mesh([1, 0], [2, np.pi / 2], [cells, 2 * cells])
    nodes = polar[:, :1] * np.stack([np.cos(polar[:, 1]), np.sin(polar[:, 1])], axis=1)
    fem = 100 * np.log(2 / polar[:, 0]) / np.log(2)
    bump = np.all(np.isclose(polar, [1.75, np.pi / 4]), axis=1)
    for model, values in ((FEM, fem), (PD, fem - 5.0 * bump)):
        write_fields(directory / f"fields/{model.replace(' ', '_')}_0000.h5", nodes, quads,
                     {"temperature": values, "heat_flux": np.pad(nodes, ((0, 0), (0, 1)))})


def cube_values(model, time, points):
    """Temperature of the cube with a square crack in its middle."""
    x, y, z = points.T
    width = np.sqrt(np.maximum(0, 0.25 - z ** 2))
    tip = 0.02 if model == PD else 0.0
    field = crack_field(x, y, 1e-9 + width * (1 + tip))
    return 50 + 100 * time * (field + 0.05 * z * x)


def make_cube(directory, cells=24, physics="heat", saturated=()):
    """3D cube with a square crack."""
    names = names_of(physics)
    crack = [[-0.5, 0, -0.5], [-0.5, 0, 0.5], [0.5, 0, 0.5], [0.5, 0, -0.5]]
    times = [0.2, 0.5]
    make_summary(directory, "Cube with a square crack", 3, [-1, -1, -1], [1, 1, 1.0], times,
                 [FEM, PD], [crack], sides={"top": "Dirichlet 100", "bottom": "Dirichlet 0",
                                            "left": "insulated", "right": "insulated",
                                            "back": "insulated", "front": "Flux 3*t*sin(pi*x)"},
                 physics=physics)
    nodes, hexes = box_mesh([-1, -1, -1], [1, 1, 1], [cells + 1] * 3)
    for i, time in enumerate(times):
        for model in (FEM, PD):
            values = cube_values(model, time, nodes)
            step = 1e-3
            flux = -np.stack([(cube_values(model, time, nodes + step * e)
                               - cube_values(model, time, nodes - step * e)) / (2 * step)
                              for e in np.eye(3)], axis=1)
            fields = {names["field"]: values, names["flux"]: np.clip(flux, -150, 150)}
            if saturated:
                fields["concentration"] = concentration(nodes, hexes, values, saturated)
            write_fields(directory / f"fields/{model.replace(' ', '_')}_{i:04d}.h5", nodes, hexes,
                         fields)
    line = np.stack([np.zeros(61), np.linspace(-1, 1, 61), np.zeros(61)], axis=1)
    write_csv(directory / "line.csv", [FEM, PD], times, line, cube_values)


def make_wet_cube(directory, saturated, cells=8):
    """The cube with moisture; saturated as of a plate."""
    make_cube(directory, cells, "moisture", saturated)


def make_strip(directory, saturated=()):
    """1D body with moisture; saturated as of a plate."""
    physics, times = "moisture", [0.5, 1.0]
    names = names_of(physics)
    make_summary(directory, "A strip", 1, [-1.0], [1.0], times, [FEM, PD], physics=physics,
                 sides={"left": "Dirichlet 1-x", "right": "insulated"})
    nodes, cells = box_mesh([-1], [1], [20])
    for i, time in enumerate(times):
        for model in (FEM, PD):
            values = time * (1 - nodes[:, 0]) * (1.01 if model == PD else 1)
            fields = {names["field"]: values, names["flux"]: np.ones((len(nodes), 3))}
            if saturated:
                fields["concentration"] = concentration(nodes, cells, values, saturated)
            write_fields(directory / f"fields/{model.replace(' ', '_')}_{i:04d}.h5", nodes, cells,
                         fields)


def make(case, directory, cells=None):
    """One made-up directory by the name of its case."""
    directory = Path(directory)
    size = {} if cells is None else {"cells": int(cells)}
    if case in ("bar", "bar steady"):
        make_bar(directory, case == "bar steady")
    elif case == "ring":
        make_ring(directory, **size)
    elif case == "cube":
        make_cube(directory, **size)
    elif case == "strip":
        make_strip(directory, (2.0, 5.0))
    elif case == "wet cube":
        make_wet_cube(directory, (2.0, 5.0), **size)
    else:
        options = {"crack": {"exact": True}, "centers": {"centers": True},
                   "single": {"models": [PD]}, "long": {"upper": (1.0, 0.2), "cracks": []},
                   "hole": {"hole": True, "cracks": [[[-0.8, -0.7], [-0.2, -0.3]]]},
                   "moisture": {"physics": "moisture", "saturated": (3.0, 3.0),
                                "title": "Wet plate"},
                   "two materials": {"physics": "moisture", "saturated": (2.0, 5.0),
                                     "title": "Wet plate of two materials"},
                   "electricity": {"physics": "electricity", "title": "Plate and electrodes"}
                   }[case]
        make_plate(directory, **size, **options)
