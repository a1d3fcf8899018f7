#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Tests of the report of elastic bodies on output directories made up here.

    python3 tests/report_elastic_test.py
"""

import re
import unittest

import numpy as np
from PIL import Image

from report_test import ReportCase
from report_cases import FEM, PD, box_mesh

import animate
import contours
import deformed
import difference
import elastic_findings
import elastic_tables
import fragments
import loading
import materials
import sketch
import style
import supports
import surfaces
from raster import View
from read_run import Mesh, Run
from units import Units
from report_elastic_cases import COUPLED, FLIGHT, OPENING, column_values, make_broken, make_elastic


def rows_of(html):
    """The rows of all tables: lists of texts, the first the head of the row."""
    return [[re.sub("<[^>]*>", "", part) for part in re.findall("<t[hd][^>]*>(.*?)</t[hd]>", row)]
            for row in re.findall("<tr[^>]*>(.*?)</tr>", html, re.DOTALL)]


class Pages(ReportCase):
    """Whole pages of bodies of one, two and three dimensions."""

    def report(self, drawn=True, **options):
        """(page, rows of its tables, names of its figures)."""
        make_elastic(self.directory, **options)
        figures = self.directory.parent / "figures"
        page = self.page("", "--figures", figures, drawn=drawn)
        html = (self.directory / "report.html").read_text(encoding="utf-8")
        return page, rows_of(html), sorted(p.stem for p in figures.iterdir())

    def check_probes(self, rows, dimension):
        """The table of probes has the numbers of probes.csv."""
        run = Run(self.directory)
        points = elastic_tables.probe_points(run.probes)
        found = [r for r in rows if len(r) == 4 and
                 re.sub(r" \(mm\)", "", r[0]).replace("von Mises", "von_mises") in run.probe_columns]
        columns = list(run.probe_columns)
        self.assertEqual(len(found), 2 * len(columns))
        for k in range(2):
            exact = {m: column_values(m, 1.0, points[k:k + 1])[0] for m in (FEM, PD)}
            for c, row in enumerate(found[k * len(columns):(k + 1) * len(columns)]):
                self.assertEqual(row[1:], [
                    style.plain(float(exact[FEM][c]), 6), style.plain(float(exact[PD][c]), 6),
                    style.plain(float(exact[PD][c] - exact[FEM][c]), 3)])
        self.assertEqual(points.shape[1], dimension)

    def check_forces(self, rows, dimension):
        """The table of forces has the numbers of summary.json."""
        for d, axis in enumerate("xyz"[:dimension]):
            row = next(r for r in rows if r[0] == f"right, in {axis}")
            self.assertEqual(row[2:], ["1", "1.02"] if d == 0 else ["0", "0"])
            row = next(r for r in rows if r[0] == f"Sum in {axis}")
            self.assertEqual(row[2:], ["0", "0"])

    def test_plate(self):
        page, rows, figures = self.report()
        self.assertEqual(figures, ["displacement_magnitude", "displacement_x", "displacement_y",
                                   "line", "pressure", "problem", "stress_xx", "stress_xy",
                                   "von_mises"])
        self.check_probes(rows, 2)
        self.check_forces(rows, 2)
        text = "".join(page.text)
        for part in ("2D, static", "units: mm", "in plane stress at rest was computed by",
                     "displacements magnified 100 times", "contours of equal displacement",
                     "Zero everywhere, not drawn: stress yy.", "tractions t in orange",
                     "Peridynamics differs from finite elements by 2 % in the relative L2 norm",
                     "by at most 2.1×10⁻⁵ mm, reached at (",
                     "The strain energy is 0.04567 (finite elements) and 0.04658 (peridynamics)",
                     "The forces on the body are in balance: their sum is at most 2×10⁻¹² of",
                     "Zero along the line, not drawn: displacement in y, stress yy, stress zz."):
            self.assertIn(part, text)
        largest = np.hypot(1, 0.3) * 1e-3
        self.assertIn(["Largest magnitude of the displacement (mm)",
                       f"{style.plain(largest, 6)} at (−1, −1)",
                       f"{style.plain(1.02 * largest, 6)} at (−1, −1)"], rows)
        self.assertIn(["Solver iterations", "21", "21"], rows)
        self.assertIn(["At rest", "0.02", "2.1×10⁻⁵"], rows)
        self.assertIn(["Force imbalance", "2×10⁻¹²", "2×10⁻¹²"], rows)
        self.assertIn(["Von Mises stress of the mean stress", "0.2123", "0.2123"], rows)

    def test_materials(self):
        _, rows, _ = self.report(drawn=False)
        shear = 200 / 2.6
        self.assertIn(["Shear modulus", style.plain(shear, 6), style.plain(2 * shear, 6),
                       style.plain(shear, 6)], rows)
        self.assertIn(["Young modulus", "200", "400", "200"], rows)
        self.assertIn(["Density", "2.5", "2.5", "2.5"], rows)
        self.assertIn(["Where", "", "hypot(x, y) &lt; 0.2", "x &gt; 0.9"], rows)

    def test_bar(self):
        page, rows, figures = self.report(dimension=1)
        self.assertEqual(figures, ["displacement_x", "line", "problem", "stress_xx"])
        self.check_probes(rows, 1)
        self.check_forces(rows, 1)
        self.assertIn(["Largest displacement in x (mm)", "0.001 at x = 1", "0.00102 at x = 1"], rows)
        self.assertIn("The displacement of a bar", "".join(page.text))

    def test_body(self):
        page, rows, figures = self.report(dimension=3, cells=5)
        self.assertEqual(figures, ["displacement_magnitude", "displacement_x", "displacement_y",
                                   "displacement_z", "line", "pressure", "problem", "stress_xx",
                                   "stress_xy", "von_mises"])
        self.check_probes(rows, 3)
        self.check_forces(rows, 3)
        self.assertIn("displacements magnified 100 times", "".join(page.text))

    def test_cell_centers_with_a_crack(self):
        page, _, _ = self.report(centers=True, crack=True)
        self.assertIn("with a crack", "".join(page.text))

    def test_one_model(self):
        page, _, _ = self.report(models=(PD,), drawn=False)
        self.assertNotIn("Finite elements", page.cells)

    def test_later_fields(self):
        page, rows, figures = self.report(extras=("damage", "temperature"), phases=True)
        self.assertIn("damage", figures)
        self.assertIn("temperature", figures)
        self.assertIn(["Phase", "Mean", "99th percentile", "Maximum"], rows)
        self.assertEqual([r for r in rows if len(r) == 4 and r[1] in ("0.1", "10.1", "1.1", "11.1")],
                         [["Finite elements", "0.1", "0.2", "0.3"],
                          ["Peridynamics", "10.1", "10.2", "10.3"],
                          ["Finite elements", "1.1", "1.2", "1.3"],
                          ["Peridynamics", "11.1", "11.2", "11.3"]])
        self.assertIn("that are broken", "".join(page.text))

    def test_several_times(self):
        page, rows, figures = self.report(times=(0.5, 1.0, 1.5), extras=("damage",))
        self.assertEqual([f for f in figures if re.search(r"_000\d$", f)], [
            f"{name}_{i:04d}" for name in ("damage", "displacement_magnitude") for i in range(3)]
            + ["displacement_x_0002", "displacement_y_0002", "pressure_0002", "stress_xx_0002",
               "stress_xy_0002"] + [f"von_mises_{i:04d}" for i in range(3)])
        for figure in ("probes", "totals"):
            self.assertIn(figure, figures)
        text = "".join(page.text)
        for part in ("2D, slowly loaded", "units: mm, s", "up to t = 1.5 s", "t = 0.5 s",
                     "displacements magnified 50 times"):
            self.assertIn(part, text)
        self.assertIn(["Strain energy", style.plain(0.04567 * 1.5, 6),
                       style.plain(0.04567 * 1.5 * 1.02, 6)], rows)
        folder = animate.make(self.directory, PD, field="von_mises")
        self.assertEqual(sorted(p.name for p in folder.iterdir()),
                         ["contact_sheet.png", "frame_0000.png", "frame_0001.png", "frame_0002.png"])

    def test_without_fields(self):
        def change(summary):
            summary["fields"] = []
            for entry in ("sides", "values on sides", "comparison"):
                del summary[entry]
            for model in summary["models"].values():
                del model["boundary force"], model["mean stress"]

        make_elastic(self.directory)
        self.change_summary(change)
        (self.directory / "scene.prm").unlink()
        page = self.page("")
        self.assertEqual(len(page.images), 2)  # problem and line


class Shapes(ReportCase):
    """Deformed shapes are where the displacement takes them."""

    def shape(self, u, segments=(), on_faces=False, cells=10, factor=10.0):
        """A square of the size 2 with a displacement given as a function of the vertices and their cells' centres."""
        nodes, quads = box_mesh([-1, -1], [1, 1], [cells, cells])
        centers = np.repeat(nodes[quads].mean(axis=1), 4, axis=0)
        shape = deformed.Shape(Mesh(nodes, quads), u(nodes, centers), factor, segments, on_faces)
        view = View([-2, -2], [2, 2], 200)
        shape.draw_on(view)
        return nodes, shape, view

    def test_stretched_and_turned(self):
        gradient = np.array([[0.03, -0.02], [0.01, -0.01]])
        nodes, shape, view = self.shape(lambda p, c: p @ gradient.T)
        picture = shape.picture(3 * nodes[:, 0] - 2 * nodes[:, 1])
        x, y = np.meshgrid(*view.centers())
        rest = np.stack([x, y], axis=-1) @ np.linalg.inv(np.eye(2) + 10 * gradient).T
        inside = np.abs(rest).max(axis=-1) <= 1
        self.assertTrue((np.isfinite(picture) == inside).mean() > 0.999)
        both = inside & np.isfinite(picture)
        self.assertLess(np.abs(picture - (3 * rest[..., 0] - 2 * rest[..., 1]))[both].max(), 1e-9)

    def test_a_crack_opens(self):
        # Inside cells and along them, cut into the mesh or not, at vertices and at cell centres.
        for cells, on_faces, at_centers in ((11, False, False), (10, False, False),
                                            (10, True, False), (10, False, True)):
            with self.subTest(cells=cells, on_faces=on_faces, at_centers=at_centers):
                def u(nodes, centers):
                    y = centers[:, 1] if on_faces or at_centers else nodes[:, 1]
                    return np.stack([0 * y, 0.02 * (y > -1e-9)], axis=1)
                crack = [np.array([[-1.0, 0], [1.0, 0]])]
                nodes, shape, view = self.shape(u, crack, on_faces, cells)
                picture = shape.picture(np.ones(len(nodes)))
                y = view.centers()[1]
                column = np.isfinite(picture)[:, 100]
                expected = ((y > -1) & (y < 0)) | ((y > 0.2) & (y < 1.2))
                self.assertEqual(column.tolist(), expected.tolist())

    def test_faces_of_a_crack(self):
        make_elastic(self.directory, crack=True)
        run = Run(self.directory)
        maps = contours.Maps(run, 600)
        maps.on_faces = True
        shapes = deformed.Shapes(maps, [0], [FEM], 100.0)
        upper, lower = shapes.faces(0, FEM)
        pixel = maps.view().pixel.max()
        inner = slice(2, -2)
        self.assertLess(np.abs(upper[inner, 1] - 0.02).max(), pixel)
        self.assertLess(np.abs(lower[inner, 1]).max(), pixel)
        self.assertLess(np.abs(upper[inner, 0] / np.linspace(-1, 1, len(upper))[inner] - 1.1).max(),
                        0.05)

    def test_factors(self):
        for factor, rounded in ((3030, 2000), (3500, 5000), (0.7, 1), (0.2, 1), (0.1, 0.1),
                                (8.2, 10), (1.3, 1), (1e-3, 1e-3)):
            self.assertAlmostEqual(deformed.round_factor(factor), rounded, delta=1e-9 * rounded)
        make_elastic(self.directory)
        run = Run(self.directory)
        factor = deformed.magnification(run, [0])
        largest = factor * 1.02e-3 * np.hypot(1, 0.3)
        self.assertEqual(factor, 100)  # 0.05 * 2/1.065e-3 is 93.9
        self.assertAlmostEqual(largest / 2, 0.053, delta=5e-4)


class Parts(ReportCase):
    """Numbers that tables and sketches are made of."""

    def test_moduli(self):
        exact = {"Bulk modulus": 1e5, "Shear modulus": 3e5 * 0.2 / 2.8, "Young modulus": 6e4,
                 "Poisson ratio": 0.4}
        names = list(exact)
        for i, a in enumerate(names):
            for b in names[i + 1:]:
                found = materials.all_moduli({a: exact[a], b: exact[b]})
                for title, value in exact.items():
                    self.assertAlmostEqual(found[title] / value, 1, delta=1e-11)
        self.assertEqual(materials.all_moduli({"Young modulus": 1.0}), {})
        self.assertEqual(materials.of_phases("a: f(1; 2) ; b: x > 0 ? 1 : 2"),
                         {"a": "f(1; 2)", "b": "x > 0 ? 1 : 2"})

    def test_difference_of_displacements(self):
        make_elastic(self.directory)
        run = Run(self.directory)
        gap = difference.displacement_gap(run, 0)
        nodes = run.mesh(0, PD).nodes
        self.assertLess(np.abs(gap - 2e-5 * np.hypot(nodes[:, 0], 0.3 * nodes[:, 1])).max(), 1e-18)

    def test_difference_at_cell_centers(self):
        make_elastic(self.directory, centers=True)
        run = Run(self.directory)
        mesh = run.mesh(0, PD)
        x = np.repeat(mesh.nodes[mesh.cells].mean(axis=1)[:, 0], 4)
        self.assertLess(np.abs(difference.difference_field(run, 0, "displacement_x")
                               - 2e-5 * x).max(), 1e-17)

    def test_supports(self):
        make_elastic(self.directory)
        run = Run(self.directory)
        self.assertEqual([supports.kind_of_support(run, s) for s in ("left", "right", "top")],
                         ["slides", "", ""])
        run.summary["values on sides"]["left"]["displacement"]["values"] = [[0.0, 0.0]]
        self.assertEqual(supports.kind_of_support(run, "left"), "held")
        run.summary["values on sides"]["left"]["displacement"]["values"] = [[0.1, 0.0]]
        self.assertEqual(supports.kind_of_support(run, "left"), "")
        self.assertEqual((supports.longest(run, "traction"), supports.longest(run, "displacement")),
                         (0.2, 0.1))
        figure = sketch.problem_sketch(contours.Maps(run), run.words)
        arrows = [p for p in figure.axes[0].patches if hasattr(p, "get_arrowstyle")]
        self.assertEqual(len(arrows), 2)

    def test_places(self):
        """Parts of sides, points and sides of meshes are in the sketch, also under the names of sides of a box."""
        make_elastic(self.directory)
        run = Run(self.directory)
        run.summary["sides"].update({"back": "displacement 0, 0", "foot": "traction 0, 5"})
        run.summary["places"] = {
            "back": {"kind": "point", "at": [[1.0, 0.0]]},
            "foot": {"kind": "part of a side", "lines": [[-0.5, -1.0, 0.5, -1.0]], "at": [[0.0, -1.0]], "normals": [[0.0, -1.0]]}}
        run.summary["values on sides"].update({
            "back": {"displacement": {"at": [[1.0, 0.0]], "values": [[0.0, 0.0]]}},
            "foot": {"traction": {"at": [[0.0, -1.0]], "values": [[0.0, 5.0]]}}})
        figure = sketch.problem_sketch(contours.Maps(run), run.words)
        axes = figure.axes[0]
        arrows = [p for p in axes.patches if hasattr(p, "get_arrowstyle")]
        self.assertEqual(len(arrows), 2)  # of the right side and of the foot
        self.assertTrue({"back", "foot"} <= {t.get_text() for t in axes.texts})
        self.assertTrue(any(np.allclose(path.vertices, [[-0.5, -1], [0.5, -1]]) for c in axes.collections for path in c.get_paths()
                            if len(path.vertices) == 2))
        held = [line for line in axes.lines if line.get_marker() == "^"]
        self.assertEqual(len(held), 1)
        run.summary["domain"]["shape"] = "mesh file"
        run.summary["places"]["left"] = {"kind": "side", "lines": [[-1.0, 1.0, -1.0, -1.0]], "at": [[-1.0, 0.0]],
                                         "normals": [[-1.0, 0.0]]}
        sketch.problem_sketch(contours.Maps(run), run.words)

    def test_one_place_is_named_once(self):
        make_elastic(self.directory)
        run = Run(self.directory)
        text = elastic_findings.largest_values(run, 0, run.words.fields["displacement_x"])
        self.assertEqual(text.count("at x") + text.count("at ("), 1)
        self.assertIn("0.001 mm (finite elements) and 0.00102 mm (peridynamics) at (1, ", text)
        run.summary["no stress intensity"] = "they are computed in two dimensions only"
        self.assertEqual(elastic_findings.intensities(run, run.words),
                         ["There are no stress intensity factors: they are computed in two dimensions only."])

    def test_units_of_materials(self):
        units = Units({"length": "mm", "time": "ms", "force": "N", "temperature": "C"}, 2, "elasticity")
        self.assertEqual([units.of_material(e) for e in ("Young modulus", "Density", "Thermal expansion", "Fracture energy", "Poisson ratio")],
                         ["MPa", "g/mm³", "1/K", "N/mm", ""])
        units = Units({"length": "m", "time": "s", "energy": "J", "field": "K", "mass": "kg"}, 3, "heat")
        self.assertEqual([units.of_material(e) for e in ("Conductivity", "Density", "Heat capacity")], ["W/(m K)", "kg/m³", "J/(kg K)"])
        units = Units({"length": "mm", "field": "V", "current": "A"}, 2, "electricity")
        self.assertEqual(units.of_material("Conductivity"), "S/mm")

    def test_outliers_do_not_rule_the_colours(self):
        values = np.concatenate([np.linspace(0, 1, 10_000), [40.0]])
        scale = style.value_scale([values], outliers=0.002)
        self.assertLess(scale.levels[-1], 1.2)
        self.assertEqual(scale.extend, "max")
        scale = style.value_scale([values])
        self.assertGreaterEqual(scale.levels[-1], 40)


class Broken(ReportCase):
    """A body that has broken: a crack that has opened, a corner that has flown off."""

    def test_fragments(self):
        for centers in (False, True):
            make_broken(self.directory, centers=centers)
            run = Run(self.directory)
            self.assertIsNone(fragments.find(run, 1, FEM))
            self.assertIsNone(fragments.find(run, 0, PD))  # at the start all is whole
            for model in (PD, COUPLED):
                found = fragments.find(run, 2, model)
                self.assertEqual(found.count, 1)
                at = run.mesh(2, model).nodes[found.mask]
                self.assertGreater(at.min(), 0.6)
                self.assertAlmostEqual(found.farthest, np.sqrt(2) * FLIGHT, delta=0.01)
                self.assertAlmostEqual(found.share, 16 / 676, delta=0.01)

    def test_scale_and_view_leave_them_out(self):
        make_broken(self.directory)
        run = Run(self.directory)
        factor = deformed.magnification(run, [1, 2])
        self.assertEqual(factor, deformed.round_factor(0.1 / (0.5 * OPENING)))
        scale = contours.scale_at(run, 2, run.words.solution)
        self.assertLess(scale.levels[-1], 2 * OPENING)
        self.assertEqual(scale.extend, "max")
        shapes = deformed.Shapes(contours.Maps(run, 200), [2], [PD], factor)
        left, right, bottom, top = shapes.view.extent
        self.assertLess(max(-left, right, -bottom, top), 1.3)

    def test_a_crack_opens(self):
        """Along y = 0, in nodes at vertices and at centres, and nowhere where the body is whole."""
        for centers in (False, True):
            make_broken(self.directory, centers=centers)
            run = Run(self.directory)
            shapes = deformed.Shapes(contours.Maps(run, 300), [2], [PD], deformed.magnification(run, [2]))
            inside = np.isfinite(shapes.shapes[2, PD].picture(run.solution(2, PD)))
            x, y = shapes.view.centers()
            row = int(np.argmin(np.abs(y)))
            self.assertFalse(inside[row, (x > -0.9) & (x < -0.3)].any())
            self.assertTrue(inside[row, (x > 0.5) & (x < 0.9)].all())

    def test_page(self):
        make_broken(self.directory)
        figures = self.directory.parent / "figures"
        text = "".join(self.page("", "--figures", figures).text)
        for part in ("Left out of largest values and of the scales of pictures: a fragment (2.",
                     "The stress intensity factor K_I at crack 1 end 2 in MPa √mm is 1.25 (finite elements) "
                     "and 1.26 (peridynamics) and 1.27 (coupled).",
                     "The stress intensity factor K_II at crack 1 end 2 in MPa √mm is 0.63 (peridynamics).",
                     "The coupled model differs", "Largest von Mises stress (MPa)", "Strain energy (N mm/mm)"):
            self.assertIn(part, text.replace("At the end the coupled", "The coupled"))
        for figure in ("force_over_displacement", "crack_growth"):
            self.assertIn(figure, {p.stem for p in figures.iterdir()})
        self.assertIn("the path from the end of a crack to its tip", text)
        self.assertNotIn("damage_0000", {p.stem for p in figures.iterdir()})  # the start is for films

    def test_forces_that_cancel(self):
        """No sentence and no curve of the force on a side whose two arms are pushed apart: it is round-off."""
        make_broken(self.directory)
        run = Run(self.directory)
        self.assertTrue(loading.forces(run)[0])
        run.summary["models"][PD]["force balance"] = {"scale": 1e10 * max(abs(f.peak()[1]) for f in loading.forces(run)[0])}
        self.assertEqual(loading.forces(run), ([], []))

    def test_film(self):
        make_broken(self.directory)
        run = Run(self.directory)
        film = animate.Film(run, PD)
        self.assertEqual(film.field.name, "damage")
        self.assertEqual(film.times[film.indices[0]], 0)
        make_elastic(self.directory, times=(0.5, 1.0))
        self.assertEqual(animate.Film(Run(self.directory), PD).field.name, "displacement_magnitude")

    def test_gif(self):
        make_broken(self.directory)
        with Image.open(animate.make(self.directory, PD, gif=True) / "film.gif") as film:
            self.assertEqual((film.format, film.n_frames), ("GIF", len(animate.Film(Run(self.directory), PD).indices)))

    def test_coupled_minus_elements(self):
        make_broken(self.directory)
        run = Run(self.directory)
        pairs = difference.compared(run, 2, run.words.solution.name)
        self.assertEqual([m for m, _ in pairs], [PD, COUPLED])
        self.assertLess(max(abs(size.value) for _, size in pairs), 2 * OPENING)  # no fragment among them


class Slender(ReportCase):
    """Titles and labels of bodies of any shape lie inside their figures."""

    def test_nothing_is_clipped(self):
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        for width, height in ((20.0, 1.0), (1.0, 20.0), (1.0, 5.0), (2.0, 2.0)):
            for n in (1, 2, 3, 5):
                layout = contours.Layout(n, (0.0, width, 0.0, height), min(n, 3))
                scale = style.value_scale([np.array([0.0, 1.0])])
                for i in range(n):
                    layout.title(layout.panel(i), "Peridynamics − finite elements")
                layout.bar(0, min(n, 3) - 1, scale, "Magnitude of the displacement (mm)")
                canvas = FigureCanvasAgg(layout.figure)
                canvas.draw()  # which places the labels
                renderer = canvas.get_renderer()
                box = layout.figure.bbox
                for axes in layout.figure.axes:
                    for text in (axes.title, axes._left_title, axes.xaxis.label, axes.yaxis.label):
                        if text.get_text():
                            extent = text.get_window_extent(renderer)
                            self.assertGreaterEqual(extent.x0, box.x0 - 1, (width, height, n, text.get_text()))
                            self.assertLessEqual(extent.x1, box.x1 + 1, (width, height, n, text.get_text()))
                            self.assertGreaterEqual(extent.y0, box.y0 - 1, (width, height, n, text.get_text()))
                            self.assertLessEqual(extent.y1, box.y1 + 1, (width, height, n, text.get_text()))


class SurfaceTest(unittest.TestCase):
    """What lies within a distance of the surface of a body."""

    @staticmethod
    def mesh(shape, n=24):
        """Cells with copies of their vertices: a quarter of a ring from 1 to 2, or a square with a hole."""
        s = np.linspace(0, 1, n + 1)
        quads = [np.array([(s[i], s[j]), (s[i + 1], s[j]), (s[i + 1], s[j + 1]), (s[i], s[j + 1])])
                 for i in range(n) for j in range(n)]
        if shape == "ring":
            quads = [np.column_stack(((1 + q[:, 0]) * np.cos(0.5 * np.pi * q[:, 1]),
                                      (1 + q[:, 0]) * np.sin(0.5 * np.pi * q[:, 1]))) for q in quads]
        else:
            quads = [q for q in quads if np.abs(q.mean(axis=0) - 0.5).max() > 0.125]
        return Mesh(np.concatenate(quads), np.arange(4 * len(quads)).reshape(-1, 4))

    def test_ring(self):
        mesh = self.mesh("ring")
        radius = np.hypot(*mesh.nodes.T)
        depth = np.minimum(np.minimum(radius - 1, 2 - radius), mesh.nodes.min(axis=1))
        near = surfaces.near_surface(mesh, 0.1)
        self.assertTrue(near[depth < 0.095].all())
        self.assertFalse(near[depth > 0.105].any())
        inner = np.hypot(*(mesh.nodes - 1.05 / np.sqrt(2)).T).argmin()  # far from the box around the ring
        self.assertTrue(near[inner])

    def test_hole(self):
        mesh = self.mesh("hole")
        x = np.abs(mesh.nodes - 0.5).max(axis=1)
        near = surfaces.near_surface(mesh, 0.06)
        self.assertTrue(near[(x < 0.125 + 0.05) | (x > 0.45)].all())
        self.assertFalse(near[(x > 0.125 + 0.07) & (x < 0.43)].any())

    def test_completed_sides(self):
        """Planes that families go on beyond are no surface; a hole is."""
        mesh = self.mesh("hole")
        planes = [(axis, at) for axis in (0, 1) for at in (0.0, 1.0)]
        x = np.abs(mesh.nodes - 0.5).max(axis=1)
        near = surfaces.near_surface(mesh, 0.06, planes)
        self.assertTrue(near[x < 0.125 + 0.05].all())
        self.assertFalse(near[x > 0.125 + 0.07].any())
        near = surfaces.near_surface(mesh, 0.06, planes[:1])
        self.assertFalse(near[np.abs(mesh.nodes[:, 1] - 0.5) + 0.4 * mesh.nodes[:, 0] < 0.1].any())
        self.assertTrue(near[mesh.nodes[:, 0] > 0.95].all())
        nodes, cells = box_mesh((0, 0), (1, 1), (8, 8))
        self.assertFalse(surfaces.near_surface(Mesh(nodes, cells), 0.2, planes).any())

    def test_block(self):
        nodes, cells = box_mesh((0, 0, 0), (2, 1, 1), (16, 8, 8))
        depth = np.minimum(nodes, (2, 1, 1) - nodes).min(axis=1)
        near = surfaces.near_surface(Mesh(nodes, cells), 0.2)
        np.testing.assert_array_equal(near, depth < 0.2)


if __name__ == "__main__":
    unittest.main()
