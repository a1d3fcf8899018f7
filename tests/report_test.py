#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Tests of the report generator on output directories made up here.

    python3 tests/report_test.py                      runs the tests
    python3 tests/report_test.py --make CASE DIRECTORY [CELLS]   writes one made-up directory
    (CASE: bar, bar steady, crack, centers, single, long, hole, ring, cube, strip, wet cube,
    moisture, two materials, electricity)
"""

import base64
import contextlib
import functools
import io
import json
import os
import re
import struct
import sys
import tempfile
import unittest
from html.parser import HTMLParser
from pathlib import Path
from unittest import mock

import h5py
import numpy as np
from matplotlib.backends import backend_agg
from matplotlib.mathtext import MathTextParser

REPORT = Path(__file__).resolve().parent.parent / "applications" / "report"
sys.path.insert(0, str(REPORT))
os.environ.setdefault("PERIDEAL_DOTS_PER_INCH", "50")  # coarse pictures show whether they can be drawn
import contours  # noqa: E402
import curves  # noqa: E402
import difference  # noqa: E402
import film  # noqa: E402
import findings  # noqa: E402
import flux  # noqa: E402
import materials  # noqa: E402
import page as pages  # noqa: E402
import read_run  # noqa: E402
import report  # noqa: E402
import series  # noqa: E402
import sketch  # noqa: E402
import solids  # noqa: E402
import style  # noqa: E402
from crossings import crossed  # noqa: E402
from raster import PixelMap, View, boundary_lines, crosses  # noqa: E402
from read_run import Mesh, Run  # noqa: E402
from report_cases import (FEM, HEAT_NAMES, PD, box_mesh, make, make_cube,  # noqa: E402
                          make_plate, make_strip, make_wet_cube)
from units import Units  # noqa: E402
from words import Words  # noqa: E402

# The labels of all figures are parsed once.
backend_agg.MathTextParser = functools.lru_cache(maxsize=None)(MathTextParser)
EMPTY = b"\x89PNG\r\n\x1a\n" + struct.pack(">I4sII", 13, b"IHDR", 100, 100), "image/png"


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

    def change_summary(self, change):
        """Rewrites summary.json."""
        path = self.directory / "summary.json"
        summary = json.loads(path.read_text())
        change(summary)
        path.write_text(json.dumps(summary))

    def change_fields(self, change):
        """change(name of the file, file) of all files of fields."""
        for path in (self.directory / "fields").iterdir():
            with h5py.File(path, "a") as file:
                change(path.name, file)

    def page(self, case, *options, drawn=True):
        """The checked page of a case; its figures are put together, but not drawn where another test does that."""
        if not self.directory.exists():
            make(case, self.directory)
        with contextlib.nullcontext() if drawn else mock.patch.object(pages, "encode", lambda *_: EMPTY):
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

    def test_colors_of_sides(self):
        kinds = ("Dirichlet 1", "flux 2", "convection 3, 4", "contact layer 2, 0.5, 3", "sealed")
        self.assertEqual(len({sketch.side_color(text) for text in kinds}), len(kinds))
        self.assertEqual({sketch.side_color(text) for text in ("", "insulated", "sealed", "free")}, {sketch.CLOSED})

    def test_mesh_that_leaves_the_unit_square(self):
        page = self.page("ring")
        run = Run(self.directory)
        self.assertTrue(np.allclose(run.domain, [[0, 0], [2, 2]], atol=1e-12))
        maps = contours.Maps(run)
        self.assertTrue(np.allclose(maps.view().extent, [0, 2, 0, 2], atol=1e-12))
        picture = maps.picture(0, FEM, run.field(0, FEM, "temperature"), [])
        self.assertAlmostEqual(np.isfinite(picture).mean(), 3 / 4 * np.pi / 4, delta=5e-3)
        drawn = sketch.problem_sketch(maps, Words()).axes[0]
        self.assertTrue(np.allclose([drawn.get_xlim(), drawn.get_ylim()], [0, 2], atol=1e-12))
        text = "".join(page.text)
        self.assertIn("Largest difference from finite elements: −5 °C at (1.237, 1.237) (peridynamics), marked by a circle", text)
        self.assertIn("−3", "".join(page.cells))

    def test_no_picture_of_zeros(self):
        make_plate(self.directory, 8)

        def nothing(_, file):
            for name in ("heat_flux", "peridynamics_minus_finite_elements"):
                if name in file:
                    file[name][...] = 0

        self.change_fields(nothing)
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

    def test_many_times_are_small_pictures(self):
        """The first and the last of six of each model on one scale, and the last one in full."""
        make_plate(self.directory, 8, times=[0.1 * k for k in range(1, 10)])
        page = self.page("", drawn=False)
        self.assertEqual(len(page.images), 2 + 5)
        self.assertIn("6 of the 9 written times, on one colour scale", "".join(page.text))
        run = Run(self.directory)
        self.assertEqual(film.spread(range(9), 6), [0, 2, 3, 5, 6, 8])
        sheet, n = film.sheet_of(run, run.words.solution)
        self.assertEqual((len(sheet.axes), n), (2 * 6 + 1, 6))  # and the scale
        scales = {tuple(image.norm.boundaries) for axes in sheet.axes for image in axes.get_images()}
        self.assertEqual(len(scales), 1)

    def test_fields_and_tables_may_be_absent(self):
        make_plate(self.directory, 8)
        for name in ("line.csv", "probes.csv", "totals.csv", "scene.prm"):
            (self.directory / name).unlink()
        self.change_summary(lambda summary: (summary.update(fields=[]), *map(summary.pop, ("comparison", "notes", "sides"))))
        page = self.page("")
        self.assertEqual(len(page.images), 1)

    def test_constant_and_broken_values(self):
        for value in (20.0, float("nan"), float("inf")):
            def fill(_, file):
                for name in ("temperature", "heat_flux"):
                    file[name][...] = value
                file.pop("peridynamics_minus_finite_elements", None)

            make_plate(self.directory, 8)
            self.change_fields(fill)
            text = "".join(self.page("").text)
            self.assertEqual("temperatures are not finite" in text, not np.isfinite(value))

    def test_numbers_may_be_null(self):
        make_plate(self.directory, 8)
        nothing = {"stable step": {"sharp": None, "safe": None}, "heat balance": None}
        self.change_summary(lambda summary: [model.update(nothing) for model in summary["models"].values()])
        self.page("", drawn=False)


class OtherPhysics(ReportCase):
    """Runs of moisture and electricity, in their own words throughout."""

    OF_HEAT = re.compile(r"heat|temperature|isotherm|°C", re.IGNORECASE)

    def foreign_words(self):
        """Words of heat that a reader of the page would find."""
        html = (self.directory / "report.html").read_text(encoding="utf-8")
        return self.OF_HEAT.findall(re.sub(r"base64,[^\"]*|<style>.*</style>", "", html,
                                           flags=re.DOTALL))

    def test_heat_may_say_so(self):
        make_plate(self.directory, 8)
        self.page("")
        before = (self.directory / "report.html").read_text()
        self.change_summary(lambda summary: (
            summary.update(physics="heat", names=HEAT_NAMES),
            summary["units"].update(field="C")))
        self.page("")
        self.assertEqual((self.directory / "report.html").read_text(), before)
        self.assertIn("All models share one colour scale and one set of isotherms", before)

    def test_moisture(self):
        figures = self.directory.parent / "figures"
        make_plate(self.directory, 8, physics="moisture", saturated=(3.0, 3.0), title="Wet plate")
        page = self.page("", "--figures", figures)
        # problem, three times, line, probes, moisture flux, weight, other totals
        self.assertEqual(sorted(p.name for p in figures.iterdir()),
                         ["line.png", "moisture_flux.png", "probes.png", "problem.png",
                          "totals.png", "weight.png", "wetness_0000.png", "wetness_0001.png",
                          "wetness_0002.png"])
        text = "".join(page.text)
        for part in ("The wetness up to t = 0.5 h in two dimensions", "by at most 3.21, reached",
                     "one set of contours of equal wetness", "Wetness at the probes over time.",
                     "Moisture flux, t = 0.5 h.", "proportional to the moisture flux",
                     "Moisture through the sides", "Weight over time. Computed at",
                     "Zero at all times, not drawn: moisture flow from sources.",
                     "Moisture is conserved: the imbalance is at most", "units: mm, h"):
            self.assertIn(part, text)
        for cell in ("sealed", "Dirichlet −100", "Moisture throughput", "Moisture imbalance",
                     "Weight", "Moisture flow through top"):
            self.assertIn(cell, page.cells)
        self.assertNotIn("insulated", page.cells)
        self.assertNotIn("()", text)
        self.assertEqual(self.foreign_words(), [])

    def test_units_of_moisture(self):
        named = {"length": "mm", "time": "h", "mass": "g"}
        for counts, dimension, rate, amount, flux_unit in (
                ("wetness", 3, "mm³/h", "mm³", "mm/h"), ("wetness", 2, "mm²/h", "mm²", "mm/h"),
                ("wetness", 1, "mm/h", "mm", "mm/h"), ("mass", 2, "g/h/mm", "g/mm", "g/h/mm²")):
            units = Units(named, dimension, "moisture", counts)
            found = [units.of_total(q) for q in ("moisture flow through left", "throughput", "moisture entered since start",
                                                 "cumulative imbalance", "weight")]
            weight = {3: "g", 2: "g/mm", 1: "g/mm²"}[dimension]
            self.assertEqual(found, [rate, rate, amount, amount, weight])
            self.assertEqual(units.flux, flux_unit)
        self.assertEqual(Units({}, 2, "moisture", "wetness").of_total("throughput"), "")

    def test_what_moisture_counts(self):
        make_plate(self.directory, 8, physics="moisture", saturated=(3.0, 3.0))
        self.change_summary(lambda summary: (summary.update({"moisture counts": "wetness"}), summary["units"].update(mass="g")))
        (self.directory / "scene.prm").write_text("subsection Material\nset Conductivity = 0.02\nset Density = 1\n"
                                                  "set Heat capacity = 1\nset Saturated concentration = 12e-6\nend\n")
        page = self.page("", drawn=False)
        text = "".join(page.text)
        self.assertIn("wetness times the volume; times the saturated concentration, 1.2×10⁻⁵ g/mm³, they are masses", text)
        for cell in ("Diffusivity (mm²/h)", "Saturated concentration (g/mm³)", "Moisture throughput (mm²/h)", "Weight (g/mm)"):
            self.assertIn(cell, page.cells)
        self.assertNotIn("Density", page.cells)

    def test_materials_of_an_image(self):
        make_plate(self.directory, 8, physics="electricity")
        run = Run(self.directory)
        (self.directory / "scene.prm").write_text("subsection Material\nset Conductivity = 1\nsubsection Phases\n"
                                                  "set Conductivity = copper: 20\nend\nend\n")
        run.summary["image"] = {"phases": {"resin": {"color": [255, 255, 255]}, "copper": {"color": [200, 120, 40]},
                                           "void": {"color": [0, 0, 0]}}}
        html = materials.material_table(run).replace("\n", "")
        self.assertIn('<th scope="col">resin</th><th scope="col">copper</th>', html)
        self.assertIn('<th scope="row">Conductivity</th><td>1</td><td>20</td>', html)
        self.assertIn("<td>image, rgb(200, 120, 40)</td>", html)
        self.assertNotIn("void", html)

    def test_concentration_of_two_materials(self):
        figures = self.directory.parent / "figures"
        make_plate(self.directory, 8, physics="moisture", saturated=(2.0, 5.0), title="Wet plate")
        text = "".join(self.page("", "--figures", figures).text)
        self.assertEqual(len(list(figures.glob("concentration_*.png"))), 3)
        self.assertIn("one set of contours of equal concentration", text)
        self.assertIn("the concentration jumps", text)
        run = Run(self.directory)
        self.assertFalse(difference.is_multiple(run, [2], "concentration"))
        last = difference.largest(run, 2, "concentration")
        both = [run.field(2, m, "concentration") for m in (PD, FEM)]
        self.assertEqual(abs(last.value), np.abs(both[0] - both[1]).max())

    def test_concentration_in_one_and_three_dimensions(self):
        for make_body, n_pictures in ((make_strip, 1), (make_wet_cube, 2)):
            for saturated, n in (((2.0, 5.0), n_pictures), ((2.0, 2.0), 0)):
                with self.subTest(body=make_body.__name__, saturated=saturated):
                    holder = tempfile.TemporaryDirectory()
                    self.addCleanup(holder.cleanup)
                    self.directory, figures = Path(holder.name) / "o", Path(holder.name) / "f"
                    make_body(self.directory, saturated=saturated)
                    self.page("", "--figures", figures, drawn=n > 0)
                    self.assertEqual(len(list(figures.glob("concentration*.png"))), n)

    def test_multiples(self):
        make_strip(self.directory)
        run = Run(self.directory)
        self.assertTrue(difference.is_multiple(run, [0, 1], "concentration"))  # absent
        make_strip(self.directory, saturated=(0.0, 3.0))
        self.assertFalse(difference.is_multiple(Run(self.directory), [0], "concentration"))

        def concentrate(name, file):
            if name.endswith("_0000.h5"):  # a dry body has no factor
                file["wetness"][...] = 0
            file["concentration"][...] = 3 * file["wetness"][...]

        self.change_fields(concentrate)
        self.assertTrue(difference.is_multiple(Run(self.directory), [0, 1], "concentration"))
        with h5py.File(self.directory / "fields/peridynamics_0001.h5", "a") as file:
            file["concentration"][...] *= 1.1  # another factor in one model
        self.assertFalse(difference.is_multiple(Run(self.directory), [0, 1], "concentration"))

    def test_weight_needs_three_times(self):
        make_plate(self.directory, 8, physics="moisture", times=(0.1, 0.2))
        self.assertNotIn("Weight over time", "".join(self.page("", drawn=False).text))
        run = Run(self.directory)
        self.assertIsNone(series.apart_figure(run.totals, run.words, "weight"))
        make_plate(self.directory, 8, physics="moisture")
        run = Run(self.directory)
        axes = series.apart_figure(run.totals, run.words, "weight").axes[0]
        self.assertEqual((axes.get_xlabel(), axes.get_ylabel()), ("Time (h)", "Weight"))
        self.assertEqual(axes.lines[0].get_ydata().tolist(), [0.625, 2.5, 6.25])
        others = series.totals_figure(run.totals, run.words)[0]
        self.assertEqual([a.get_title(loc="left") for a in others.axes[:2]],
                         ["Moisture flow through top", "Rate of storage"])

    def test_electricity(self):
        figures = self.directory.parent / "figures"
        make_plate(self.directory, 8, physics="electricity", title="Plate and electrodes")
        page = self.page("", "--figures", figures)
        self.assertEqual(sorted(p.name for p in figures.iterdir()),
                         ["current_density.png", "line.png", "potential_0000.png",
                          "potential_0001.png", "potential_0002.png", "probes.png", "problem.png",
                          "totals.png"])
        text = "".join(page.text)
        for part in ("The potential up to t = 0.5 s in two dimensions", "by at most 3.21 V",
                     "one set of equipotentials", "Potential at the probes over time.",
                     "Current density, t = 0.5 s.", "proportional to the current density",
                     "cracks in black, electrodes in red, the line of",
                     "Current through the sides", "Charge is conserved: the imbalance is at most",
                     "Zero at all times, not drawn: current from sources.", "units: mm, s, V"):
            self.assertIn(part, text)
        for cell in ("insulated", "Charge throughput", "Charge", "Current through top"):
            self.assertIn(cell, page.cells)
        rows = re.findall(r'<th scope="row">(\w+)</th><td>(electrode[^<]*)</td><td>([^<]*)</td>',
                          (self.directory / "report.html").read_text(encoding="utf-8"))
        self.assertEqual(rows, [("top", "electrode, Dirichlet 100", "12.3456"),
                                ("bottom", "electrode, Dirichlet −100", "−12.3449")])
        self.assertEqual(self.foreign_words(), [])

    def test_words_on_axes(self):
        make_plate(self.directory, 8, physics="electricity")
        run = Run(self.directory)
        figure = contours.field_figure(contours.Maps(run), 2, run.words, run.words.solution)
        labels = {a.get_xlabel() for a in figure.axes}
        self.assertEqual(labels, {"$x$ (mm)", "Potential (V)", "Difference (V)"})
        figure, _ = flux.flux_figure(contours.Maps(run), 2, run.words)
        self.assertIn("Magnitude of the current density", {a.get_xlabel() for a in figure.axes})
        make_strip(self.directory.parent / "strip")
        run = Run(self.directory.parent / "strip")
        figure, text = flux.flux_figure(contours.Maps(run), 1, run.words)
        self.assertEqual(figure.axes[0].get_ylabel(), "Moisture flux")
        self.assertEqual(text, "Positive where moisture flows to the right.")
        solution = run.words.solution
        figure = curves.line_figure(curves.field_table(run, [1], solution), run.words, solution,
                                    False)
        self.assertEqual([a.get_ylabel() for a in figure.axes], ["Wetness", "PD − FEM"])

    def test_nothing_flows_and_values_break(self):
        def breaks(_, file):
            file["current_density"][...] = 0
            file["potential"][...] = float("nan")
            file.pop("peridynamics_minus_finite_elements", None)

        make_plate(self.directory, 8, physics="electricity")
        self.change_fields(breaks)
        text = "".join(self.page("").text)
        self.assertIn("The current density is zero everywhere.", text)
        self.assertIn("Warning: potentials are not finite for", text)

    def test_flux_of_one_side(self):
        make_plate(self.directory, 8, physics="moisture", models=[PD])
        path = self.directory / "fields/peridynamics_0002.h5"
        with h5py.File(path, "a") as file:
            file["moisture_flux_one_sided"] = file["moisture_flux"][...]
            del file["moisture_flux"]
        run = Run(self.directory)
        self.assertEqual(flux.flux_parts(run, 2, PD).shape, (len(run.mesh(2, PD).nodes), 2))

    def test_names_of_the_run_come_first(self):
        words = Words({"physics": "moisture", "names": {"content": "water"}, "units": {
            "field": "%", "temperature": "K"}})
        self.assertEqual((words.content, words.plotted_apart), ("water", ["water"]))
        self.assertEqual(words.solution.label(), "Wetness (%)")
        self.assertEqual(Words({"physics": "moisture"}).solution.label(), "Wetness")
        self.assertEqual(words.condition("insulated"), "sealed")
        words = Words({"units": {"temperature": "C", "length": "", "time": None}})
        self.assertEqual((words.solution.label(), words.axis("x"), words.time_axis()),
                         ("Temperature (°C)", "$x$", "Time"))

    def test_unknown_physics(self):
        make_plate(self.directory, 8)
        self.change_summary(lambda summary: summary.update(physics="magnetism"))
        status, errors = run_report(self.directory)
        self.assertEqual(status, 1)
        self.assertIn("physics must be one of heat, moisture, electricity, elasticity, found "
                      "\"magnetism\"", errors)


class Parts(ReportCase):
    """Numbers that pictures and sentences are made of."""

    def test_largest_difference_is_that_of_a_node(self):
        make_plate(self.directory, 10)
        run = Run(self.directory)
        found = difference.largest(run, 2, "temperature")
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
        at = difference.largest(run, 2, "temperature").at
        self.assertLess(np.abs(centers - at).max(axis=1).min(), 1e-12)

    def test_arrows_have_one_scale(self):
        make_plate(self.directory, 20, cracks=[])
        for model, size in ((FEM, 2.0), (PD, 1.0)):
            path = self.directory / f"fields/{model.replace(' ', '_')}_0002.h5"
            with h5py.File(path, "a") as file:
                file["heat_flux"][...] = [size, 0, 0]
        figure, text = flux.flux_figure(contours.Maps(Run(self.directory)), 2, Words())
        self.assertIn("the longest stands for 2.", text)
        lengths = [np.hypot(a.collections[0].U, a.collections[0].V).max()
                   for a in figure.axes[:2]]
        self.assertAlmostEqual(lengths[0], 1.0)
        self.assertAlmostEqual(lengths[1], 0.5)

    def test_probes_start_with_a_known_initial_value(self):
        make_plate(self.directory, 8)
        run = Run(self.directory)
        self.assertEqual(run.initial_value(np.array([0.5, 0.1])), 7)
        self.assertEqual(run.initial_value(np.array([1.0, 0.1])), 7)  # an insulated side
        self.assertIsNone(run.initial_value(np.array([0.5, 1.0])))  # one with a value
        figure, zero = series.probe_figure(run, Words())
        self.assertEqual(zero, [])
        start = figure.axes[0].lines[0]
        self.assertEqual([list(start.get_xdata()), list(start.get_ydata())], [[0], [7]])
        (self.directory / "scene.prm").unlink()
        figure, _ = series.probe_figure(Run(self.directory), Words())
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
        self.assertIn("finite elements cost 2 times as much", sentence(0.5, 0.25))
        self.assertIn(": both cost as much.", sentence(0.5, 0.51))

    def test_round_off_in_coordinates_is_zero(self):
        make_plate(self.directory, 8)
        path = self.directory / "line.csv"
        header, *rows = path.read_text(encoding="utf-8").splitlines()
        for i, row in enumerate(rows):
            cells = row.split(",")
            cells[2] = "-3.047e-17" if float(cells[2]) == 0 else cells[2]
            rows[i] = ",".join(cells)
        path.write_text("\n".join([header] + rows) + "\n", encoding="utf-8")
        run = Run(self.directory)
        points = next(iter(run.line.data[FEM].values()))[0]
        self.assertEqual(curves.line_coordinate(points, run.words)[1], "$y$ (cm)   at x = 0")
        small = 1e-9 * np.array([[1.0, 0.5], [1e-13, 0.25]])  # of a small body nothing else is lost
        self.assertEqual(read_run.without_round_off(small).tolist(), [[1e-9, 5e-10], [0.0, 2.5e-10]])

    def test_edge_of_a_mesh(self):
        nodes, quads = box_mesh([0, 0], [4, 4], [4, 4])
        around = np.array([q for q in quads if not np.allclose(nodes[q].mean(axis=0), [1.5, 1.5])])
        lines = boundary_lines(Mesh(nodes, around))
        self.assertEqual(sorted(len(line) for line in lines), [5, 17])
        for line in lines:
            self.assertEqual(list(line[0]), list(line[-1]))
            self.assertTrue(np.allclose(np.abs(np.diff(line, axis=0)).sum(axis=1), 1))
        apart = Mesh(nodes[around.ravel()], np.arange(around.size).reshape(-1, 4))  # vertices of their own
        self.assertEqual(sorted(len(line) for line in boundary_lines(apart)), [5, 17])

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

    def test_summaries(self):
        self.check("is not a directory")
        self.directory.mkdir()
        self.check("summary.json", "is missing")
        for text, *words in (('{"title": ', "summary.json", "not valid JSON"),
                             ('{"dimension": 2, "fields": []}', "no proper entry 'models'"),
                             ('{"dimension": 2, "models": {"peridynamics": {}}, "fields": [{"time": 1}]}', "every entry of 'fields'")):
            with self.subTest(text):
                (self.directory / "summary.json").write_text(text)
                self.check(*words)

    def test_files(self):
        def without_temperature(path):
            with h5py.File(path, "a") as file:
                del file["temperature"]

        for name, breaks, *words in (
                ("fields/peridynamics_0001.h5", Path.unlink, "fields/peridynamics_0001.h5", "is missing"),
                ("fields/finite_elements_0002.h5", lambda path: path.write_text("no"), "finite_elements_0002.h5", "not a readable HDF5 file"),
                ("fields/finite_elements_0000.h5", without_temperature, "finite_elements_0000.h5", "no dataset 'temperature'"),
                ("line.csv", lambda path: path.write_text("time,model,x,y,value\n0.1,peridynamics,0,zero,1\n"), "line.csv", "line 2", "zero"),
                ("line.csv", lambda path: path.write_text("t,x,value\n"), "line.csv", "no column 'time'", "t,x,value")):
            with self.subTest(words[0]):
                make_plate(self.directory, 8)
                breaks(self.directory / name)
                self.check(*words)


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
        for n in (11, 10):  # nodes on a crack belong to its left side
            nodes, cells = box_mesh([-1, -1], [1, 1], [n, n])
            values = np.where(nodes[:, 1] > -1e-9, 5.0, -5.0)
            crack = [np.array([[-1.0, 0], [1.0, 0]])]
            picture = PixelMap(Mesh(nodes, cells), View([-1, -1], [1, 1], 10 * n), crack).evaluate(values)
            self.assertLess(np.abs(picture[:5 * n] + 5).max(), 1e-12)
            self.assertLess(np.abs(picture[5 * n:] - 5).max(), 1e-12)

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
