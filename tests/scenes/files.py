# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""The files of a run and the answers of the program: names, headers, digits, fields, totals, summary, heat balance, manual."""

import base64
import json
import math
import os
import struct
import xml.etree.ElementTree as xml
import zlib

try:
    import h5py
except ImportError:
    h5py = None

from scene_test import check, check_close, check_less, finish, print_table, run_perideal, run_scene, scene_text, temporary_folder, write_file

FEM_FIELDS = ["temperature", "heat_flux"]
PD_FIELDS = ["temperature", "heat_flux", "heat_flux_one_sided", "node_volume", "cut_fraction", "peridynamics_minus_finite_elements"]
VECTORS = ["heat_flux", "heat_flux_one_sided"]

SCENES = {
    1: scene_text("""
Dimension = 1
Domain/Cells = 20
Boundary conditions/Dirichlet = left: 1; right: 0
Time/End time = 0.3
Output/Write at = 0.1, 0.2
Output/Probes = 0.123456789012 ; 1
Output/Line = 0 ; 1 ; 5
"""),
    2: scene_text("""
Dimension = 2
Domain/Cells = 12, 10
Boundary conditions/Dirichlet = left: 1; right: 0
Boundary conditions/Flux = top: 0.5
Cracks/Segments = 0.3,0.42 ; 0.7,0.42
Time/End time = 0.3
Output/Write every = 0.1
Output/Probes = 0.123456789012,0.9 ; 1,0.5
Output/Line = 0,0.5 ; 1,0.5 ; 5
"""),
    3: scene_text("""
Dimension = 3
Domain/Cells = 6, 5, 5
Boundary conditions/Dirichlet = left: 1; right: 0
Boundary conditions/Convection = top: 2, 3
Cracks/Polygons = 0.43,0.2,0.2 ; 0.43,0.8,0.2 ; 0.43,0.8,0.8 ; 0.43,0.2,0.8
Peridynamics/Horizon ratio = 2
Time/End time = 0.3
Output/Write at = 0.1, 0.2
Output/Probes = 0.123456789012,0.9,0.5 ; 1,0.5,0.5
Output/Line = 0,0.5,0.5 ; 1,0.5,0.5 ; 5
""")}
TIMES = [0.1, 0.2, 0.3]


def vtu_arrays(path):
    """The arrays of a VTU file by name, and the numbers of 'temperature'."""
    arrays = {array.get("Name") or "Points": array for array in xml.parse(path).getroot().iter("DataArray")}
    array = arrays["temperature"]
    text = array.text.strip()
    if array.get("format") == "ascii":
        return arrays, [float(x) for x in text.split()]
    # compressed: number of blocks, two sizes, the compressed sizes; then the blocks
    n_blocks = struct.unpack("<I", base64.b64decode(text[:8])[:4])[0]
    head = 4 * (3 + n_blocks)
    characters = -(-head // 3) * 4
    sizes = struct.unpack(f"<{3 + n_blocks}I", base64.b64decode(text[:characters])[:head])[3:]
    data, at, out = base64.b64decode(text[characters:]), 0, b""
    for size in sizes:
        out += zlib.decompress(data[at:at + size])
        at += size
    kind = "d" if array.get("type") == "Float64" else "f"
    return arrays, list(struct.unpack(f"<{len(out) // struct.calcsize(kind)}{kind}", out))


def check_tables(run, dim):
    axes = "x,y,z"[:2 * dim - 1]
    for name, n_points in (("probes.csv", 2), ("line.csv", 5)):
        with open(os.path.join(run.folder, name)) as file:
            lines = file.read().splitlines()
        check(lines[0] == f"time,model,{axes},value", f"{dim}D, {name}: the header is '{lines[0]}'")
        check(len(lines) == 1 + len(TIMES) * 2 * n_points, f"{dim}D, {name}: {len(lines)} lines")
        keys = sorted({(float(line.split(",")[0]), line.split(",")[1]) for line in lines[1:]})
        check(keys == [(t, model) for t in TIMES for model in ("finite elements", "peridynamics")], f"{dim}D, {name}: {keys}")
        if name == "probes.csv":
            check(lines[1].split(",")[2] == "0.123456789012", f"{dim}D: the coordinate is written as {lines[1].split(',')[2]}")
            digits = max(len(line.rsplit(",", 1)[1].replace("0.", "").replace(".", "").lstrip("-0")) for line in lines[1:])
            check(digits >= 12, f"{dim}D, {name}: {digits} digits")
    check_close(run.probe("finite elements", (1, 0.5, 0.5)[:dim]), 0, absolute=1e-14, what=f"{dim}D: value on a Dirichlet side")
    with open(os.path.join(run.folder, "totals.csv")) as file:
        check(file.readline().strip() == "time,model,quantity,value", f"{dim}D: header of totals.csv")
    quantities = {(row["time"], row["model"], row["quantity"]) for row in run.totals}
    sides = ["left", "right"] + {1: [], 2: ["top"], 3: ["top"]}[dim]
    for t in TIMES:
        for model in ("finite elements", "peridynamics"):
            for quantity in ["heat content"] + [f"heat flow through {side}" for side in sides]:
                check((t, model, quantity) in quantities, f"{dim}D: no '{quantity}' of {model} at {t} in totals.csv")


def check_h5(run, dim, model, number, fields):
    series = model.replace(" ", "_")
    path = os.path.join(run.folder, "fields", f"{series}_{number:04d}.h5")
    if not check(os.path.exists(path), f"{path} is missing"):
        return
    if h5py is None:
        return
    with h5py.File(path) as file:
        n_cells = run.summary["cells"]
        nodes, cells = file["nodes"][()], file["cells"][()]
        check(nodes.shape == (n_cells * 2**dim, dim), f"{path}: nodes {nodes.shape}")
        check(cells.shape == (n_cells, 2**dim), f"{path}: cells {cells.shape}")
        check(cells.max() < nodes.shape[0], f"{path}: a cell names node {cells.max()} of {nodes.shape[0]}")
        for field in fields:
            wanted = [field] if field in file or field not in VECTORS or dim > 1 else [f"{field}_x", field]
            here = next((name for name in wanted if name in file), None)
            if not check(here is not None, f"{path}: no '{field}' among {sorted(file)}"):
                continue
            values = file[here][()]
            check(values.shape[0] == nodes.shape[0] and bool((values == values).all()), f"{path}: {field} {values.shape}")
        if "node_volume" in fields:
            volume = file["node_volume"][()].ravel()
            if run.model("peridynamics")["settings"]["nodes"] == "vertices":
                whole = sum({tuple(point): v for point, v in zip(nodes.round(12), volume)}.values())
            else:
                whole = sum(volume[cell].mean() for cell in cells)
            check_close(whole, 1, relative=1e-6, what=f"{dim}D: sum of the nodal volumes (fields have single precision)")
        if dim > 1 and "cut_fraction" in fields:
            cut = file["cut_fraction"][()]
            check(cut.min() == 0 and 0 < cut.max() <= 1, f"{path}: cut fraction from {cut.min()} to {cut.max()}")


def check_fields(run, dim):
    times = [0.0] * (dim == 2) + TIMES  # that scene has 'Write every', whose films begin at the start
    for model, fields in (("finite elements", FEM_FIELDS), ("peridynamics", PD_FIELDS)):
        series = model.replace(" ", "_")
        pvd = xml.parse(os.path.join(run.folder, f"{series}.pvd")).getroot()
        sets = pvd.findall(".//DataSet")
        check([float(one.get("timestep")) for one in sets] == times, f"{dim}D: times of {series}.pvd")
        for number, one in enumerate(sets):
            path = os.path.join(run.folder, one.get("file"))
            if not check(os.path.exists(path), f"{path}, named in {series}.pvd, is missing"):
                continue
            if path.endswith(".pvtu"):
                pieces = [piece.get("Source") for piece in xml.parse(path).getroot().iter("Piece")]
                check(len(pieces) > 0, f"{path} names no pieces")
                path = os.path.join(os.path.dirname(path), pieces[0])
            arrays, temperature = vtu_arrays(path)
            for field in fields:
                check(field in arrays, f"{path}: no '{field}' among {sorted(arrays)}")
            check(len(temperature) > 0 and all(map(math.isfinite, temperature)), f"{path}: temperatures")
            check_h5(run, dim, model, number, fields)
        if dim > 1:
            xdmf = xml.parse(os.path.join(run.folder, f"{series}.xdmf")).getroot()
            check([float(g.get("Value")) for g in xdmf.iter("Time")] == times, f"{series}.xdmf: times")
            check(xdmf.get("Version") == "3.0", f"{series}.xdmf: version {xdmf.get('Version')}")
            for item in xdmf.iter("DataItem"):
                if item.get("Format") == "HDF":
                    check(os.path.exists(os.path.join(run.folder, item.text.strip().split(":")[0])), f"{series}.xdmf names {item.text}")


def check_summary(run, dim, steady=False):
    summary = run.summary
    for name in ("title", "models", "dimension"):
        check(name in summary, f"summary.json has no '{name}'")
    for name, model in summary["models"].items():
        entries = ["unknowns", "nonzeros", "steps", "operator applications", "iterations", "wall time", "peak memory", "boundary flux",
                   "heat balance"] + ([] if steady else ["stable step"]) + (["bonds"] if name == "peridynamics" else [])
        for entry in entries:
            check(entry in model, f"{dim}D, {name}: no '{entry}' in summary.json")
        if not steady:
            sharp, safe = model["stable step"]["sharp"], model["stable step"]["safe"]
            check(0 < safe <= sharp, f"{dim}D, {name}: stable step {model['stable step']}")
        check(("cumulative" in model["heat balance"]) != steady, f"{dim}D, {name}: {model['heat balance']}")
        check(model["peak memory"] > 1e6 and all(time >= 0 for time in model["wall time"].values()), f"{name}: {model}")
    with open(os.path.join(run.folder, "scene.prm")) as file:
        check("set Horizon ratio" in file.read(), "scene.prm has no defaults")


def files():
    for dim, scene in SCENES.items():
        for place in ("vertices", "cell centers"):
            more = {"Domain/Nodes": place}
            run = run_scene(scene, more)
            if place == "vertices":
                check_tables(run, dim)
            check_fields(run, dim)
            check_summary(run, dim)
            kept = sorted(os.listdir(run.folder))
            check(not [name for name in kept if name.endswith(".part") or name.startswith(".") and name != ".perideal"], f"left over: {kept}")
            again = run_scene(os.path.join(run.folder, "scene.prm"), {})
            check(again.probes == run.probes, f"{dim}D, {place}: the written scene.prm gives other values")
    # several processes and a horizon shorter than a cell's diagonal: all values of ghost vertices
    # have to be there
    for dim in (2, 3):
        short = {"Domain/Cells": ("10, 10", "5, 5, 5")[dim - 2], "Peridynamics/Horizon ratio": "1", "Peridynamics/Volume fraction": "none",
                 "Peridynamics/Kernel": "constant"}
        alone, several = run_scene(SCENES[dim], short), run_scene(SCENES[dim], short, ranks=4)
        check_fields(several, dim)
        check_same_fields(alone, several, dim)


def check_same_fields(first, second, dim):
    if h5py is None:
        return
    for model, field in (("peridynamics", "temperature"), ("peridynamics", "cut_fraction"), ("finite_elements", "temperature")):
        tables = []
        for run in (first, second):
            with h5py.File(os.path.join(run.folder, "fields", f"{model}_0002.h5")) as file:
                nodes, cells, values = file["nodes"][()].round(9), file["cells"][()], file[field][()].ravel()
                tables.append(sorted((tuple(nodes[cell].mean(axis=0).round(9)), sorted(values[cell])) for cell in cells))
        gap = max(abs(x - y) for (_, a), (_, b) in zip(*tables) for x, y in zip(a, b))
        places = [place for place, _ in tables[0]] == [place for place, _ in tables[1]]
        check(len(tables[0]) == len(tables[1]) and places and gap < 1e-11, f"{dim}D, {model}, {field}: differs by {gap} between 1 and 4 processes")


def check_since_start(run, model, heat):
    """Since the start: the summary has the last numbers of totals.csv, and what is missing is within the tolerance in time."""
    last = {row["quantity"]: row["value"] for row in run.totals if row["model"] == model}
    for key, quantity in (("entered", "heat entered since start"), ("stored", "heat stored since start"), ("imbalance", "cumulative imbalance")):
        check_close(last.get(quantity, math.nan), heat[key], relative=1e-14, scale=heat["entered"], what=f"{model}: {quantity}, in the summary")
    check(abs(heat["imbalance"]) <= 1e-4 * abs(heat["entered"]), f"{model}: since the start {heat}, to the default tolerance in time")


def balance():
    """Heat that enters and is not stored, over what passes through."""
    rows = []
    for dim, scene in SCENES.items():
        for steady in (True, False):
            for place in ("vertices", "cell centers"):
                for treatment in ("none", "fictitious mirror"):
                    more = {"Domain/Nodes": place, "Peridynamics/Boundary treatment": treatment, "Output/Fields": "none",
                            "Time/Steady": str(steady).lower(), "Solver/Tolerance": "1e-12"}
                    if steady:
                        more.update({"Output/Write at": "", "Output/Write every": ""})
                    run = run_scene(scene, more)
                    check_summary(run, dim, steady)
                    for name, model in run.summary["models"].items():
                        heat = model["heat balance"]
                        share = abs(heat["imbalance"]) / heat["throughput"]
                        rows.append((f"{dim}D", "steady" if steady else "t = 0.3", place, treatment, name, heat["throughput"], share))
                        check(share <= 1e-10, f"{rows[-1]}: imbalance")
                        if not steady:
                            check_since_start(run, name, heat["cumulative"])
    print_table("Heat balance: imbalance over throughput (at most 1e-10)",
                ("body", "time", "nodes", "boundary", "model", "throughput", "imbalance/throughput"), rows)


def answers():
    folder = temporary_folder()
    for dim, scene in SCENES.items():
        path = write_file(f"scene{dim}.prm", scene, folder)
        results = os.path.join(folder, f"results{dim}")
        status, stdout, stderr = run_perideal(["check", path, "-s", f"Output directory={results}"])
        check(status == 0 and stderr == "", f"perideal check: {status}\n{stderr}")
        for word in ("unknowns", "bonds", "B", "sharp", "safe", "stepper", "estimated", " s"):
            check(word in stdout, f"perideal check, {dim}D, does not say '{word}':\n{stdout}")
        check(not os.path.exists(results), f"perideal check has made {results}")
        check(sorted(os.listdir(folder)) == [f"scene{d}.prm" for d in range(1, dim + 1)], f"perideal check has written: {os.listdir(folder)}")

    status, text, _ = run_perideal(["parameters"])
    check(status == 0 and "subsection Peridynamics" in text, "perideal parameters")
    path = write_file("all.prm", text + "\nsubsection Boundary conditions\nend\n", folder)
    status, stdout, stderr = run_perideal(["check", path, "-s", "Boundary conditions/Dirichlet=left: 1"])
    check(status == 0, f"the printed manual is no valid scene: {stderr}")
    check(text == run_perideal(["parameters", "prm"])[1], "perideal parameters prm")
    status, text, _ = run_perideal(["parameters", "JSON"])
    check(status == 0 and len(json.loads(text)) > 0 and "Horizon" in text, "perideal parameters JSON")
    status, text, _ = run_perideal(["parameters", "XML"])
    check(status == 0 and len(list(xml.fromstring(text).iter())) > 100, "perideal parameters XML")
    status, text, _ = run_perideal(["parameters", "markdown"])
    for word in ("Horizon ratio", "Default", "Unit"):
        check(status == 0 and word.lower() in text.lower(), f"perideal parameters markdown does not say '{word}'")

    status, text, _ = run_perideal(["--version"])
    check(status == 0 and text.strip().startswith("PeriDeal "), f"--version: {text}")
    for arguments in (["--help"], ["run", "--help"], ["check", "--help"], ["parameters", "--help"]):
        status, text, stderr = run_perideal(arguments)
        check(status == 0 and "Usage" in text and stderr == "", f"{arguments}: {text}{stderr}")
    status, text, _ = run_perideal(["run", os.path.join(folder, "scene2.prm"), "-q", "-s", f"Output directory={folder}/a/b",
                                    "-s", "Domain/Cells=6, 5", "-s", "Title=Another"])
    check(status == 0 and text.strip() == "", f"a quiet run says: {text}")
    with open(os.path.join(folder, "a", "b", "summary.json")) as file:
        summary = json.load(file)
    check(summary["cells"] == 30 and summary["title"] == "Another", "overrides")
    with open(os.path.join(folder, "a", "b", "keep.txt"), "w") as file:
        file.write("mine")
    status, text, _ = run_perideal(["run", os.path.join(folder, "scene2.prm"), "-s", f"Output directory={folder}/a/b", "-s",
                                    "Output/Write every=", "-s", "Output/Fields=vtu"])
    left = sorted(os.listdir(os.path.join(folder, "a", "b")))
    check(status == 0 and "keep.txt" in left and "peridynamics.pvd" in left and "peridynamics.xdmf" not in left,
          f"after a second run into the same directory: {left}")
    status, text, _ = run_perideal(["run", os.path.join(folder, "scene2.prm"), "-s", f"Output directory={folder}/a/b", "-s",
                                    "Domain/Cells=96, 80", "-s", "Output/Fields=none", "-s", "Time/Stepper=rk4"])
    check(status == 0 and "\r" not in text and text.count("\n") < 40, f"progress in a file:\n{text}")


def unstable():
    """A step just above the sharp bound is refused with both bounds; one just below runs."""
    for stepper, reach in (("euler", 2.0), ("rk4", 2.785293563405282)):
        for model in ("finite elements", "peridynamics"):
            free = run_scene(SCENES[2], {"Models": model, "Output/Fields": "none"})
            bound = free.model(model)["stable step"]
            ratio = reach / 2 if bound["method"] == "euler" else 1.0
            sharp, safe = ratio * bound["sharp"], ratio * bound["safe"]
            run = run_scene(SCENES[2], {"Models": model, "Time/Stepper": stepper, "Time/Time step": f"{1.0001 * sharp:.12g}"}, expect_error=True)
            for number in (sharp, safe):
                check(f"{number:.4g}"[:5] in run.stderr, f"{stepper}, {model}: {number} is not in: {run.stderr}")
            check("'Time step'" in run.stderr and "'Stepper = auto'" in run.stderr, run.stderr)
            check(not os.path.exists(os.path.join(run.folder, "summary.json")), "a summary was left behind")
            run = run_scene(SCENES[2], {"Models": model, "Time/Stepper": stepper, "Output/Fields": "none",
                                        "Time/Time step": f"{0.9999 * sharp:.12g}"})
            largest = max(abs(row["value"]) for row in run.line)
            check_less(largest, 1.6, f"{stepper}, {model}: largest value with a step just below the bound")


def main():
    files()
    balance()
    answers()
    unstable()
    if h5py is None:
        print("h5py is missing: HDF5 files were not read")
    finish()


if __name__ == "__main__":
    main()
