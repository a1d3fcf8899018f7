# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Output directories of elastic runs made up for the tests of the report (report_elastic_test.py)."""

import json

import numpy as np

from report_cases import FEM, PD, box_mesh, write_fields

AXES = "xyz"
COLUMNS = {1: ["ux", "sxx", "von_mises"],
           2: ["ux", "uy", "sxx", "syy", "szz", "sxy", "von_mises"],
           3: ["ux", "uy", "uz", "sxx", "syy", "szz", "sxy", "sxz", "syz", "von_mises"]}
YOUNG, POISSON = 200.0, 0.3


def displacement(model, time, points, jump=0.0):
    """Uniform tension along x that grows with time, 2 % more with peridynamics; jump: of the half above y = 0, upwards."""
    size = (1.02 if model == PD else 1.0) * 1e-3 * time
    u = -POISSON * size * points
    u[:, 0] = size * points[:, 0]
    if points.shape[1] > 1:
        u[:, 1] += jump * time * (points[:, 1] > 0)
    return u


def stresses(model, time, points):
    """sxx is that of the tension and a bit more above; the others are zero but sxy."""
    sxx = YOUNG * (1.02 if model == PD else 1.0) * 1e-3 * time * (1 + 0.1 * points[:, -1])
    sxy = 0.1 * sxx if points.shape[1] > 1 else 0 * sxx
    return sxx, sxy, np.sqrt(sxx ** 2 + 3 * sxy ** 2)


def column_values(model, time, points):
    """The numbers of probes.csv and line.csv, a row for each point."""
    u = displacement(model, time, points)
    sxx, sxy, mises = stresses(model, time, points)
    found = {f"u{AXES[d]}": u[:, d] for d in range(points.shape[1])}
    found.update(sxx=sxx, sxy=sxy, von_mises=mises)
    return np.stack([found.get(c, 0 * sxx) for c in COLUMNS[points.shape[1]]], axis=1)


def write_table(path, times, models, points):
    """probes.csv or line.csv."""
    dimension = points.shape[1]
    lines = ["time,model," + ",".join(AXES[:dimension]) + "," + ",".join(COLUMNS[dimension])]
    for time in times:
        for model in models:
            for point, row in zip(points, column_values(model, time, points)):
                lines.append(",".join([f"{time!r}", model] + [f"{v:.15g}" for v in (*point, *row)]))
    path.write_text("\n".join(lines) + "\n")


def model_entry(model, dimension):
    """Numbers of one model."""
    pull = 1.02 if model == PD else 1.0
    force = [pull] + [0.0] * (dimension - 1)
    entry = {"unknowns": 3782, "nonzeros": 65884, "iterations": 21, "operator applications": 22,
             "operator form": "stored", "settings": {"m": "3"} if model == PD else {"elements": "Q1"},
             "wall time": {"operator": 0.11, "solving": 0.54}, "memory": 1_800_000,
             "peak memory": 192_000_000,
             "boundary force": {"left": [-f for f in force], "right": force},
             "force balance": {"throughput": pull, "imbalance": 2e-12},
             "strain energy": 0.04567 * pull,
             "mean stress": {"xx": 0.2, "von mises": 0.2123}}
    if model == PD:
        entry["bonds"] = 31676
    return entry


SCENE = """subsection Material
  set Density = 2.5
  set Bulk modulus =
  set Shear modulus =
  set Young modulus = 200
  set Poisson ratio = 0.3
  set Thermal expansion = 0
  subsection Phases
    set Regions = core: hypot(x, y) < 0.2 ; rim: x > 0.9
    set Young modulus = core: 400
    set Poisson ratio =
  end
end
subsection Elasticity
  set Plane = stress
end
"""


def make_elastic(directory, dimension=2, cells=12, times=(0.0,), models=(FEM, PD), centers=False,
                 crack=False, extras=(), phases=False):
    """A body of the size 2 in every direction under tension, at rest where there is one time.

    extras: further scalar fields, zero at the left and 1 at the right; crack: y = 0 in all of the
    body, which has opened; centers: peridynamics has its nodes at the cell centres.
    """
    lower, upper = [-1.0] * dimension, [1.0] * dimension
    steady = len(times) == 1
    sides = dict.fromkeys(("left", "right", "bottom", "top", "back", "front")[:2 * dimension], "free")
    others = ", free" * (dimension - 1)
    sides.update(left="displacement 0" + others, right="traction 0.2" + ", 0" * (dimension - 1))
    middle = [0.0] * (dimension - 1)
    summary = {
        "title": "A body in tension", "text": "A body is pulled.", "scene file": "made_up.prm",
        "program": "PeriDeal 0.1.0", "dimension": dimension, "processes": 1,
        "physics": "elasticity",
        "names": {"field": "displacement", "flux": "stress", "content": "strain energy",
                  "flow": "force", "quantity": "force"},
        "units": {"length": "mm", "time": "s", "temperature": "K", "field": "mm"},
        "domain": {"lower": lower, "upper": upper, "shape": "box"},
        "cracks": [[[-1.0, 0.0], [1.0, 0.0]]] if crack else [], "steady": steady,
        "end time": times[-1], "notes": [], "sides": sides,
        "values on sides": {
            "left": {"displacement": {"at": [[-1.0] + middle],
                                      "values": [[0.0] + [None] * (dimension - 1)]}},
            "right": {"traction": {"at": [[1.0] + middle],
                                   "values": [[0.2] + [0.0] * (dimension - 1)]}}},
        "fields": [{"time": t, "files": {m: f"fields/{m.replace(' ', '_')}_{i:04d}.h5"
                                         for m in models}} for i, t in enumerate(times)],
        "models": {m: model_entry(m, dimension) for m in models}}
    if len(models) == 2:
        summary["comparison"] = {"relative l2": [[t, 0.02] for t in times],
                                 "maximum": [[t, 2.1e-5] for t in times]}
    if phases:
        for i, entry in enumerate(summary["models"].values()):
            entry["phases"] = {p: {"mean": 0.1 + k + 10 * i, "99th percentile": 0.2 + k + 10 * i,
                                   "maximum": 0.3 + k + 10 * i}
                               for k, p in enumerate(("core", "rim"))}
    directory.mkdir(parents=True, exist_ok=True)
    (directory / "summary.json").write_text(json.dumps(summary))
    (directory / "scene.prm").write_text(SCENE)
    when = [t or 1.0 for t in times]  # a body at rest has its displacements at the time 0
    nodes, quads = box_mesh(lower, upper, [cells] * dimension)
    for i, time in enumerate(when):
        for model in models:
            points = nodes
            if centers and model == PD:
                points = np.repeat(nodes[quads].mean(axis=1), quads.shape[1], axis=0)
            inside = np.repeat(nodes[quads].mean(axis=1), quads.shape[1], axis=0)
            u = displacement(model, time, points)
            if crack:
                u[:, 1] += 2e-4 * time * (inside[:, 1] > 0)
            sxx, sxy, mises = stresses(model, time, points)
            fields = {"displacement": u if dimension == 1 else
                      np.pad(u, ((0, 0), (0, 3 - dimension))),
                      "stress_xx": sxx, "von_mises": mises, "pressure": -sxx / 3}
            if dimension > 1:
                fields.update({"stress_yy": 0 * sxx, "stress_zz": 0 * sxx, "stress_xy": sxy})
            fields.update({name: 0.5 * (1 + points[:, 0]) for name in extras})
            write_fields(directory / f"fields/{model.replace(' ', '_')}_{i:04d}.h5", nodes, quads,
                         fields)
    line = np.zeros((21, dimension))
    line[:, 0] = np.linspace(-1, 1, 21)
    probes = np.zeros((2, dimension))
    probes[:, 0] = 0.25, 1.0
    for name, points in (("line.csv", line), ("probes.csv", probes)):
        write_table(directory / name, when if not steady else [1.0], models, points)
    totals = ["time,model,quantity,value"]
    for time in times:
        for model in models:
            entry = summary["models"][model]
            totals += [f"{time},{model},strain energy,{entry['strain energy'] * (time or 1)}",
                       f"{time},{model},force on left in x,{entry['boundary force']['left'][0]}",
                       f"{time},{model},mean stress xx,0.2"]
    (directory / "totals.csv").write_text("\n".join(totals) + "\n")


COUPLED = "coupled"
OPENING, FLIGHT = 0.02, 5.0


def broken_fields(points, time, kind):
    """(displacement, damage) of a body that has opened along y = 0 up to x = 0.3 and has lost a corner.

    kind: 1.0 of finite elements, which do not break; slightly other numbers of each other model.
    """
    u = np.zeros((len(points), 3))
    u[:, 0] = 1e-3 * time * kind * points[:, 0]
    damage = np.zeros(len(points))
    if kind == 1.0:
        return u, damage
    x, y = points.T
    lips = (x < 0.3) & (np.abs(y) < 0.2)
    damage[lips] = 0.4
    u[:, 1] += 0.5 * OPENING * time * np.sign(y + 1e-9) * np.clip(0.3 - x, 0, 1)
    corner = (x > 0.7) & (y > 0.7)
    damage[corner | ((x > 0.5) & (y > 0.5))] = 0.5
    u[corner] += FLIGHT * time
    return u, damage


def make_broken(directory, centers=False, models=(FEM, PD, COUPLED), cells=25):
    """An elastic run with a crack that has opened through a row of cells, and a fragment.

    centers: nodes at cell centres, else at vertices; 25 cells: none of them on y = 0.
    """
    times = (0.0, 0.5, 1.0)
    make_elastic(directory, times=times, models=models, cells=cells)
    summary = json.loads((directory / "summary.json").read_text())
    summary["units"]["force"] = "N"
    summary["comparisons"] = {"coupled minus finite elements": {"relative l2": [[1.0, 0.1]],
                                                                "maximum": [[1.0, 0.01]]}}
    for model, k in zip(models, (1.25, 1.26, 1.27)):
        summary["models"][model]["stress intensity"] = {
            "crack 1 end 2": {"J-integral": 0.01, "I": k, "II": 0.5 * k if model == PD else 0.0}}
    (directory / "summary.json").write_text(json.dumps(summary))
    for name in ("line.csv", "probes.csv"):  # those of a body in tension
        (directory / name).unlink()
    nodes, quads = box_mesh([-1.0, -1.0], [1.0, 1.0], [cells, cells])
    inside = np.repeat(nodes[quads].mean(axis=1), 4, axis=0)
    totals = ["time,model,quantity,value"]
    for i, time in enumerate(times):
        for k, model in enumerate(models):
            at_centers = centers and model == PD
            u, damage = broken_fields(inside if at_centers else nodes, time, 1.0 + 0.1 * k)
            fields = {"displacement": u, "von_mises": 200 * time + 0 * damage}
            if model != FEM:
                fields["damage"] = damage
            write_fields(directory / f"fields/{model.replace(' ', '_')}_{i:04d}.h5", nodes, quads, fields)
            totals += [f"{time},{model},strain energy,{0.5 * time ** 2}",
                       f"{time},{model},force on right in x,{2 * time - time ** 2}",
                       f"{time},{model},displacement of right in x,{0.01 * time}"]
            if model != FEM:
                totals += [f"{time},{model},broken bonds,{100 * time}", f"{time},{model},crack length,{0.4 * time}",
                           f"{time},{model},damaged volume,{0.04 * time}"]
            if model != FEM and time > 0:
                totals += [f"{time},{model},{quantity} at crack 1 end 2,{value * time}"
                           for quantity, value in (("tip x", 0.3), ("crack length", 0.38), ("tip speed", 0.41))]
    (directory / "totals.csv").write_text("\n".join(totals) + "\n")
