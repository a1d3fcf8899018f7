#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Tests of the report generator on output directories made up here.

    python3 tests/report_test.py                      runs the tests
    python3 tests/report_test.py --make CASE DIRECTORY [CELLS]   writes one made-up directory
    (CASE: bar, bar steady, crack, centers, single, long, hole, ring, cube)
"""

import base64
import contextlib
import io
import json
import re
import struct
import sys
import tempfile
import unittest
from html.parser import HTMLParser
from pathlib import Path

import h5py
import numpy as np

REPORT = Path(__file__).resolve().parent.parent / "applications" / "report"
sys.path.insert(0, str(REPORT))
import contours  # noqa: E402
import difference  # noqa: E402
import findings  # noqa: E402
import flux  # noqa: E402
import report  # noqa: E402
import series  # noqa: E402
import sketch  # noqa: E402
import solids  # noqa: E402
import style  # noqa: E402
from crossings import crossed  # noqa: E402
from raster import PixelMap, View, crosses  # noqa: E402
from read_run import Mesh, Run  # noqa: E402

FEM, PD = "finite elements", "peridynamics"


# ---- made-up output directories -------------------------------------------------------------

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
             "settings": {"m": "6.5", "kernel": "conical, exponent 2", "volume fraction": "linear"} if pd else
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
                 steady=False, sides=None):
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


def plate_values(model, time, points):
    """Temperature of the plate with a crack; PD smears the tips a little."""
    size = 100 * (1 - np.exp(-3 * time))
    field = crack_field(points[:, 0], points[:, 1], 0.5 if model != PD else 0.515)
    return size * (field + 0.12 * points[:, 0] * (1 - points[:, 0] ** 2))


def make_plate(directory, cells=60, models=(FEM, PD), centers=False, upper=(1.0, 1.0),
               hole=False, cracks=None, times=(0.05, 0.2, 0.5), exact=False):
    """2D plate with an insulated crack."""
    lower, upper = [-upper[0], -upper[1]], list(upper)
    cracks = [[[-0.5, 0], [0.5, 0]]] if cracks is None else cracks
    times = list(times)
    make_summary(directory, "Plate with an insulated crack", 2, lower, upper, times, list(models),
                 cracks, exact)
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
            fields = {"temperature": values, "heat_flux": flux}
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
            totals += [f"{time},{model},total heat,{12.5 * time}",
                       f"{time},{model},heat through top,{3.25 * time}"]
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


def make_cube(directory, cells=24):
    """3D cube with a square crack."""
    crack = [[-0.5, 0, -0.5], [-0.5, 0, 0.5], [0.5, 0, 0.5], [0.5, 0, -0.5]]
    times = [0.2, 0.5]
    make_summary(directory, "Cube with a square crack", 3, [-1, -1, -1], [1, 1, 1.0], times,
                 [FEM, PD], [crack], sides={"top": "Dirichlet 100", "bottom": "Dirichlet 0",
                                            "left": "insulated", "right": "insulated",
                                            "back": "insulated", "front": "Flux 3*t*sin(pi*x)"})
    nodes, hexes = box_mesh([-1, -1, -1], [1, 1, 1], [cells + 1] * 3)
    for i, time in enumerate(times):
        for model in (FEM, PD):
            values = cube_values(model, time, nodes)
            step = 1e-3
            flux = -np.stack([(cube_values(model, time, nodes + step * e)
                               - cube_values(model, time, nodes - step * e)) / (2 * step)
                              for e in np.eye(3)], axis=1)
            write_fields(directory / f"fields/{model.replace(' ', '_')}_{i:04d}.h5", nodes, hexes,
                         {"temperature": values, "heat_flux": np.clip(flux, -150, 150)})
    line = np.stack([np.zeros(61), np.linspace(-1, 1, 61), np.zeros(61)], axis=1)
    write_csv(directory / "line.csv", [FEM, PD], times, line, cube_values)


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
    else:
        options = {"crack": {"exact": True}, "centers": {"centers": True},
                   "single": {"models": [PD]}, "long": {"upper": (1.0, 0.2), "cracks": []},
                   "hole": {"hole": True, "cracks": [[[-0.8, -0.7], [-0.2, -0.3]]]}}[case]
        make_plate(directory, **size, **options)


# ---- checks ---------------------------------------------------------------------------------

class Checker(HTMLParser):
    """Checks that tags are balanced; collects texts, tables and images."""

    VOID = {"meta", "img", "br", "link"}

    def __init__(self):
        super().__init__()
        self.open, self.images, self.cells, self.text, self.outside = [], [], [], [], []

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        if tag == "img":
            self.images.append(attributes["src"])
        for key in ("src", "href"):
            if re.match(r"(https?:)?//", attributes.get(key) or ""):
                self.outside.append(attributes[key])
        assert tag != "script"
        if tag not in self.VOID:
            self.open.append(tag)
        if tag in ("td", "th"):
            self.cells.append("")

    def handle_startendtag(self, tag, attributes):
        self.handle_starttag(tag, attributes)

    def handle_endtag(self, tag):
        assert self.open and self.open[-1] == tag, f"</{tag}> closes {self.open[-3:]}"
        self.open.pop()

    def handle_data(self, data):
        self.text.append(data)
        if {"td", "th"} & set(self.open):
            self.cells[-1] += data


def run_report(*arguments):
    """(exit status, stderr) of the program."""
    errors = io.StringIO()
    with contextlib.redirect_stderr(errors), contextlib.redirect_stdout(io.StringIO()):
        status = report.main([str(a) for a in arguments])
    return status, errors.getvalue()


class ReportCase(unittest.TestCase):
    """A directory that is thrown away."""

    def setUp(self):
        self.holder = tempfile.TemporaryDirectory()
        self.addCleanup(self.holder.cleanup)
        self.directory = Path(self.holder.name) / "output"

    def page(self, case, *options):
        """The checked page of a case."""
        if not self.directory.exists():
            make(case, self.directory)
        status, errors = run_report(self.directory, *options)
        self.assertEqual((status, errors), (0, ""))
        checker = Checker()
        checker.feed((self.directory / "report.html").read_text(encoding="utf-8"))
        checker.close()
        self.assertEqual(checker.open, [])
        self.assertEqual(checker.outside, [])
        for image in checker.images:
            self.check_image(image)
        return checker

    def check_image(self, image):
        """An image is embedded and decodes."""
        kind, data = re.fullmatch(r"data:image/(png|svg\+xml);base64,(.*)", image).groups()
        data = base64.b64decode(data)
        if kind == "png":
            self.assertEqual(data[:8], b"\x89PNG\r\n\x1a\n")
            width, height = struct.unpack(">II", data[16:24])
            self.assertGreater(min(width, height), 50)
        else:
            self.assertIn(b"</svg>", data)


class Pages(ReportCase):
    """Whole pages."""

    def test_plate_with_crack_and_exact_solution(self):
        figures = self.directory.parent / "figures"
        page = self.page("crack", "--figures", figures)
        # problem, three times, line, probes, heat flux, totals
        self.assertEqual(len(page.images), 8)
        self.assertEqual(sorted(p.name for p in figures.iterdir()),
                         ["heat_flux.png", "line.png", "probes.png", "problem.png",
                          "temperature_0000.png", "temperature_0001.png", "temperature_0002.png",
                          "totals.png"])
        space = "\u202f"
        for number in (f"14{space}641", f"1{space}234{space}567", f"127{space}449", "84",
                       "0.000143", "0.000121", "12.3 MB", "4.5 MB", "12.3456", "4×10⁻¹²",
                       "0.01845", "0.00615", "0.0087", "3.21", "2.71 s", "1.11 s"):
            self.assertIn(number, page.cells)
        text = "".join(page.text)
        self.assertIn("look at the isotherms", text)
        self.assertIn("<1 cm>", text)
        self.assertIn("hot above & cold below", text)
        self.assertIn("peridynamics cost 2.4 times as much", text)
        self.assertIn("0.87 % in the relative L2 norm", text)
        self.assertRegex(text, r"0\.615 % \(finite elements\) and 1\.8[45] % \(peridynamics\)")
        self.assertIn("bobaru 2012 example 1", text)
        self.assertEqual(text.count("412 MB"), 1)
        self.assertIn("conical kernel, n = 2", text)
        self.assertIn("Dirichlet −100", page.cells)

    def test_bar(self):
        page = self.page("bar")
        # problem, temperature over the body, probes, heat flux
        self.assertEqual(len(page.images), 4)
        self.assertIn("Dirichlet 100*(1−exp(−t))", page.cells)

    def test_steady_bar(self):
        page = self.page("bar steady")
        self.assertIn("The steady temperature in one dimension", "".join(page.text))

    def test_cell_centers(self):
        self.page("centers")

    def test_single_model(self):
        page = self.page("single")
        self.assertNotIn("Finite elements", page.cells)

    def test_flat_body(self):
        self.page("long")

    def test_hole(self):
        self.page("hole")

    def test_cube(self):
        make_cube(self.directory, 8)
        page = self.page("cube")
        self.assertIn("Flux 3*t*sin(pi*x)", page.cells)

    def test_mesh_that_leaves_the_unit_square(self):
        page = self.page("ring")
        run = Run(self.directory)
        self.assertTrue(np.allclose(run.domain, [[0, 0], [2, 2]], atol=1e-12))
        maps = contours.Maps(run)
        self.assertTrue(np.allclose(maps.view().extent, [0, 2, 0, 2], atol=1e-12))
        picture = maps.picture(0, FEM, run.field(0, FEM, "temperature"), [])
        self.assertAlmostEqual(np.isfinite(picture).mean(), 3 / 4 * np.pi / 4, delta=5e-3)
        drawn = sketch.problem_sketch(maps, style.Units({})).axes[0]
        self.assertTrue(np.allclose([drawn.get_xlim(), drawn.get_ylim()], [0, 2], atol=1e-12))
        text = "".join(page.text)
        self.assertIn("Largest difference: −5 °C at (1.237, 1.237), marked by a circle", text)
        self.assertIn("−3", "".join(page.cells))

    def test_no_picture_of_zeros(self):
        make_plate(self.directory, 8)
        for path in (self.directory / "fields").iterdir():
            with h5py.File(path, "a") as file:
                file["heat_flux"][...] = 0
                if "peridynamics_minus_finite_elements" in file:
                    file["peridynamics_minus_finite_elements"][...] = 0
        (self.directory / "totals.csv").write_text(
            "time,model,quantity,value\n" + "".join(
                f"{t},{m},{q},{v}\n" for t in (0.1, 0.2, 0.3) for m in (FEM, PD)
                for q, v in (("heat content", 5), ("heat flow from sources", 0))))
        page = self.page("")
        self.assertEqual(len(page.images), 7)
        text = "".join(page.text)
        for sentence in ("The heat flux is zero everywhere.", "agree to round-off",
                         "Zero at all times, not drawn: heat flow from sources."):
            self.assertIn(sentence, text)

    def test_many_times_show_six(self):
        make_plate(self.directory, 8, times=[0.1 * k for k in range(1, 10)])
        page = self.page("")
        self.assertEqual(len(page.images), 6 + 5)
        self.assertTrue("Also written, not shown: t = 0.2, 0.5, 0.8 s" in "".join(page.text))

    def test_fields_and_tables_may_be_absent(self):
        make_plate(self.directory, 8)
        for name in ("line.csv", "probes.csv", "totals.csv", "scene.prm"):
            (self.directory / name).unlink()
        summary = json.loads((self.directory / "summary.json").read_text())
        summary["fields"] = []
        del summary["comparison"], summary["notes"], summary["sides"]
        (self.directory / "summary.json").write_text(json.dumps(summary))
        page = self.page("")
        self.assertEqual(len(page.images), 1)

    def test_constant_and_broken_values(self):
        for value in (20.0, float("nan"), float("inf")):
            make_plate(self.directory, 8)
            for path in (self.directory / "fields").iterdir():
                with h5py.File(path, "a") as file:
                    for name in ("temperature", "heat_flux"):
                        file[name][...] = value
                    if "peridynamics_minus_finite_elements" in file:
                        del file["peridynamics_minus_finite_elements"]
            text = "".join(self.page("").text)
            self.assertEqual("temperatures are not finite" in text, not np.isfinite(value))

    def test_numbers_may_be_null(self):
        make_plate(self.directory, 8)
        summary = json.loads((self.directory / "summary.json").read_text())
        for model in summary["models"].values():
            model["stable step"] = {"sharp": None, "safe": None}
            model["heat balance"] = None
        (self.directory / "summary.json").write_text(json.dumps(summary))
        self.page("")


class Parts(ReportCase):
    """Numbers that pictures and sentences are made of."""

    def test_largest_difference_is_that_of_a_node(self):
        make_plate(self.directory, 10)
        run = Run(self.directory)
        found = difference.largest(run, 2)
        nodes = run.mesh(2, PD).nodes
        values = run.field(2, PD, "peridynamics_minus_finite_elements")
        self.assertEqual(abs(found.value), np.abs(values).max())
        self.assertLess(np.abs(nodes - found.at).max(axis=1).min(), 1e-15)
        self.assertFalse(found.alone)  # there is a mirror image

    def test_largest_difference_of_cell_centers_is_at_a_center(self):
        make_plate(self.directory, 10, centers=True)
        run = Run(self.directory)
        mesh = run.mesh(2, PD)
        centers = mesh.nodes[mesh.cells].mean(axis=1)
        at = difference.largest(run, 2).at
        self.assertLess(np.abs(centers - at).max(axis=1).min(), 1e-12)

    def test_arrows_have_one_scale(self):
        make_plate(self.directory, 20, cracks=[])
        for model, size in ((FEM, 2.0), (PD, 1.0)):
            path = self.directory / f"fields/{model.replace(' ', '_')}_0002.h5"
            with h5py.File(path, "a") as file:
                file["heat_flux"][...] = [size, 0, 0]
        figure, text = flux.flux_figure(contours.Maps(Run(self.directory)), 2, style.Units({}))
        self.assertIn("the longest stands for 2.", text)
        lengths = [np.hypot(a.collections[0].U, a.collections[0].V).max()
                   for a in figure.axes[:2]]
        self.assertAlmostEqual(lengths[0], 1.0)
        self.assertAlmostEqual(lengths[1], 0.5)

    def test_probes_start_with_a_known_initial_value(self):
        make_plate(self.directory, 8)
        run = Run(self.directory)
        self.assertEqual(run.initial_value(np.array([0.5, 0.1])), 7)
        self.assertIsNone(run.initial_value(np.array([1.0, 0.1])))
        figure, zero = series.probe_figure(run, style.Units({}))
        self.assertEqual(zero, [])
        start = figure.axes[0].lines[0]
        self.assertEqual([list(start.get_xdata()), list(start.get_ydata())], [[0], [7]])
        (self.directory / "scene.prm").unlink()
        figure, _ = series.probe_figure(Run(self.directory), style.Units({}))
        self.assertEqual(min(min(line.get_xdata()) for line in figure.axes[0].lines), 0.05)

    def test_short_times_are_not_compared(self):
        make_plate(self.directory, 8)
        run = Run(self.directory)

        def sentence(fem, pd):
            for model, time in ((FEM, fem), (PD, pd)):
                run.summary["models"][model]["wall time"] = {"solve": time}
            return findings.what_it_cost(run)

        self.assertEqual(sentence(0.02, 0.001),
                         "Both models took less than 0.1 s of wall time on 1 process.")
        self.assertEqual(sentence(0.5, 0.01), "The wall time was 0.5 s (finite elements) and less "
                                              "than 0.1 s (peridynamics) on 1 process.")
        self.assertIn("peridynamics cost 4 times as much", sentence(0.5, 2.0))

    def test_slices_of_a_crack(self):
        make_cube(self.directory, 8)  # nodes every 2/9, the crack between two rows
        run = Run(self.directory)
        position, remark = solids.slice_positions(run, 0)
        self.assertEqual(list(remark), [1])
        self.assertTrue(np.allclose(position, [0, 1 / 9, 0]))
        crack = run.cracks(0)
        self.assertEqual(len(solids.slice_segments(crack, 0, 0.49)), 1)
        self.assertEqual(solids.slice_segments(crack, 0, 0.5), [])  # touched, not cut
        self.assertEqual(len(solids.slice_outlines(crack, 0, 0.5, 1e-9)), 1)
        self.assertEqual(len(solids.slice_outlines(crack, 1, 0.0, 1e-9)), 4)


    def test_lines_are_broken_at_cracks(self):
        y = np.linspace(-1, 1, 5)
        line = np.stack([np.full(5, 0.2), y], axis=1)
        crack = np.array([[-0.5, 0.0], [0.5, 0.0]])
        self.assertEqual(crossed(line, [crack])[0].tolist(), [1])  # y = 0 is above
        self.assertEqual(crossed(line, [crack[::-1]])[0].tolist(), [2])
        self.assertEqual(crossed(line, [crack])[1].tolist(), [1.0])  # at y = 0
        self.assertEqual(crossed(line, [crack[::-1]])[1].tolist(), [0.0])
        self.assertEqual(crossed(line + [0.4, 0], [crack])[0].tolist(), [])
        square = np.array([[-1, 0, -1], [-1, 0, 1], [1, 0, 1], [1, 0, -1.0]])  # normal: y
        line = np.stack([np.full(5, 0.2), y, np.full(5, -0.3)], axis=1)
        self.assertEqual(crossed(line, [square])[0].tolist(), [1])
        self.assertEqual(crossed(line, [0.25 * square])[0].tolist(), [])


class Faults(ReportCase):
    """Faults are told in one line, exit status 1, and leave no page."""

    def check(self, *expected):
        status, errors = run_report(self.directory)
        self.assertEqual(status, 1)
        self.assertEqual(errors.count("\n"), 1)
        self.assertTrue(errors.startswith("report: "))
        for text in expected:
            self.assertIn(text, errors)
        self.assertFalse((self.directory / "report.html").exists())

    def test_no_directory(self):
        self.check("is not a directory")

    def test_no_summary(self):
        self.directory.mkdir()
        self.check("summary.json", "is missing")

    def test_broken_summary(self):
        self.directory.mkdir()
        (self.directory / "summary.json").write_text('{"title": ')
        self.check("summary.json", "not valid JSON")

    def test_summary_without_models(self):
        self.directory.mkdir()
        (self.directory / "summary.json").write_text('{"dimension": 2, "fields": []}')
        self.check("no proper entry 'models'")

    def test_summary_with_a_bad_fields_entry(self):
        self.directory.mkdir()
        (self.directory / "summary.json").write_text(
            '{"dimension": 2, "models": {"peridynamics": {}}, "fields": [{"time": 1}]}')
        self.check("every entry of 'fields'")

    def test_missing_field_file(self):
        make_plate(self.directory, 8)
        (self.directory / "fields/peridynamics_0001.h5").unlink()
        self.check("fields/peridynamics_0001.h5", "is missing")

    def test_field_file_that_is_not_hdf5(self):
        make_plate(self.directory, 8)
        (self.directory / "fields/finite_elements_0002.h5").write_text("no")
        self.check("finite_elements_0002.h5", "not a readable HDF5 file")

    def test_missing_dataset(self):
        make_plate(self.directory, 8)
        with h5py.File(self.directory / "fields/finite_elements_0000.h5", "a") as file:
            del file["temperature"]
        self.check("finite_elements_0000.h5", "no dataset 'temperature'")

    def test_broken_line_file(self):
        make_plate(self.directory, 8)
        (self.directory / "line.csv").write_text(
            "time,model,x,y,value\n0.1,peridynamics,0,zero,1\n")
        self.check("line.csv", "line 2", "zero")

    def test_line_file_with_wrong_header(self):
        make_plate(self.directory, 8)
        (self.directory / "line.csv").write_text("t,x,value\n")
        self.check("line.csv", "no column 'time'", "t,x,value")


class Sampling(unittest.TestCase):
    """Pixels have the right values."""

    def test_bilinear_field_on_quads_is_exact(self):
        nodes, cells = box_mesh([-1, 0], [2, 1], [7, 5])
        skewed = nodes + 0.04 * np.sin(3 * nodes[:, ::-1])
        for points in (nodes, skewed):
            mesh = Mesh(points, cells)
            view = View(points.min(axis=0), points.max(axis=0), 90)
            picture = PixelMap(mesh, view).evaluate(3 * points[:, 0] - 2 * points[:, 1] + 1)
            x, y = np.meshgrid(*view.centers())
            inside = np.isfinite(picture)
            self.assertGreater(inside.mean(), 0.9)
            self.assertLess(np.abs(picture - (3 * x - 2 * y + 1))[inside].max(), 1e-5)

    def test_slice_of_hexes_is_exact(self):
        nodes, cells = box_mesh([0, 0, 0], [1, 2, 3], [3, 4, 5])
        view = View([0, 0, 0], [1, 2, 3], 60, axis=1, position=0.77)
        picture = PixelMap(Mesh(nodes, cells), view).evaluate(nodes @ [1.0, 10.0, 100.0])
        x, z = np.meshgrid(*view.centers())
        self.assertLess(np.abs(picture - (x + 7.7 + 100 * z)).max(), 1e-9)

    def test_hole_has_no_value(self):
        nodes, cells = box_mesh([0, 0], [1, 1], [10, 10])
        cells = np.delete(cells, 44, axis=0)
        picture = PixelMap(Mesh(nodes, cells), View([0, 0], [1, 1], 100)).evaluate(nodes[:, 0])
        self.assertEqual(np.count_nonzero(np.isnan(picture)), 100)

    def test_jump_at_a_crack_inside_cells_is_kept(self):
        nodes, cells = box_mesh([-1, -1], [1, 1], [11, 11])
        values = np.where((np.abs(nodes[:, 0]) < 2) & (nodes[:, 1] > 0), 5.0, -5.0)
        crack = [np.array([[-1.0, 0], [1.0, 0]])]
        picture = PixelMap(Mesh(nodes, cells), View([-1, -1], [1, 1], 110), crack).evaluate(values)
        self.assertLess(np.abs(picture[:55] + 5).max(), 1e-12)
        self.assertLess(np.abs(picture[55:] - 5).max(), 1e-12)

    def test_nodes_on_a_crack_belong_to_its_left_side(self):
        nodes, cells = box_mesh([-1, -1], [1, 1], [10, 10])
        values = np.where(nodes[:, 1] > -1e-9, 5.0, -5.0)
        crack = [np.array([[-1.0, 0], [1.0, 0]])]
        picture = PixelMap(Mesh(nodes, cells), View([-1, -1], [1, 1], 100), crack).evaluate(values)
        self.assertLess(np.abs(picture[:50] + 5).max(), 1e-12)
        self.assertLess(np.abs(picture[50:] - 5).max(), 1e-12)

    def test_jump_between_cells_cut_apart_is_kept(self):
        nodes, cells = box_mesh([-1, -1], [1, 1], [10, 10])
        upper = np.repeat(nodes[cells].mean(axis=1)[:, 1] > 0, 4)
        values = np.where(upper, 5.0, -5.0) + nodes[:, 1]
        crack = [np.array([[-1.0, 0], [1.0, 0]])]
        view = View([-1, -1], [1, 1], 100)
        picture = PixelMap(Mesh(nodes, cells), view, crack, on_faces=True).evaluate(values)
        y = view.centers()[1]
        expected = np.where(y > 0, 5, -5) + y
        self.assertLess(np.abs(picture - expected[:, None]).max(), 1e-12)

    def test_many_cells_cost_no_more_pixels(self):
        nodes, cells = box_mesh([0, 0], [1, 1], [700, 700])
        pixel_map = PixelMap(Mesh(nodes, cells), View([0, 0], [1, 1], 600))
        self.assertLessEqual(len(pixel_map.pixels), 361_000)
        self.assertFalse(np.isnan(pixel_map.evaluate(nodes[:, 0])).any())

    def test_crossing(self):
        p, q = np.array([[0.0, -1], [2, -1]]), np.array([[0.0, 1], [2, 1]])
        self.assertEqual(crosses(p, q, np.array([[-1.0, 0], [1, 0]])).tolist(), [True, False])


class Formats(unittest.TestCase):
    """Numbers and scales."""

    def test_numbers(self):
        self.assertEqual(style.plain(1234567), "1\u202f234\u202f567")
        self.assertEqual(style.plain(1.2345678e-7, 3), "1.23×10⁻⁷")
        self.assertEqual(style.plain(-0.5), "−0.5")
        self.assertEqual(style.plain(None), "–")
        self.assertEqual(style.plain(268.3, 2), "270")
        self.assertEqual(style.minus("exp(-t)-1e-9"), "exp(−t)−1e−9")
        self.assertEqual(style.prose("well-known, 2e-4 or -3: 1 - exp(-2 x), option -s, a-3"),
                         "well-known, 2e−4 or −3: 1 − exp(−2 x), option -s, a-3")

    def test_levels_cover_the_values(self):
        for low, high in ((0, 100), (-97.3, 12.1), (293.15, 293.16), (5, 5)):
            levels = style.nice_levels(low, high, 12)
            slack = 1e-12 * abs(high)
            self.assertLessEqual(levels[0], low + slack)
            self.assertGreaterEqual(levels[-1], high - slack)
            self.assertLessEqual(len(levels), 16)

    def test_difference_scale_is_symmetric(self):
        scale = style.difference_scale([np.array([[-0.3, 0.1]])])
        self.assertAlmostEqual(scale.levels[0], -scale.levels[-1])
        self.assertGreaterEqual(scale.levels[-1], 0.3)


if __name__ == "__main__":
    if sys.argv[1:2] == ["--make"]:
        make(*sys.argv[2:])
    else:
        unittest.main()
