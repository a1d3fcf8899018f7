#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Makes OUTPUT_DIRECTORY/report.html from the files of a run.

    python3 report.py OUTPUT_DIRECTORY [--figures DIRECTORY]

The page holds its figures itself and needs neither a network nor JavaScript. A fault of the files
is told in one line, with exit status 1; no page is written then.
"""

import argparse
import sys
from html import escape
from pathlib import Path

try:
    import numpy as np

    import contours
    import curves
    import difference
    import film
    import findings
    import flux
    import materials
    import series
    import sketch
    import solids
    import tables
    from elastic import ElasticSections
    from page import Page, paragraphs, write_page
    from read_run import EXACT, ReportError, Run
    from style import is_formula, minus, name, plain, prose
except ImportError as fault:
    sys.exit(f"report: a Python package is missing ({fault}); "
             "the report needs numpy, matplotlib and h5py")

SHOWN_TIMES = {1: 6, 2: 6, 3: 4}


class Report:
    """Assembles the page of one run."""

    def __init__(self, run, figure_directory=None):
        self.run = run
        self.words = run.words
        self.steady = bool(run.get("steady", default=False))
        self.maps = contours.Maps(run)
        self.page = Page(figure_directory)
        self.shown = run.shown_indices(SHOWN_TIMES[run.dimension])
        # A page of large pictures is read by nobody: then small ones, and one time in full.
        self.many = run.dimension == 2 and len(run.shown_indices(sys.maxsize)) > len(self.shown)
        self.largest = difference.largest(run, self.shown[-1], self.words.solution.name) \
            if self.shown else None

    def html(self):
        """The document."""
        title = self.run.get("title", default="PeriDeal run")
        if not self.run.models:
            return self.without_results(title)
        self.problem()
        place = len(self.page.parts)
        self.fields()
        self.page.parts.insert(place, self.findings())
        self.loading()
        self.line()
        self.probes()
        self.flux()
        self.cost()
        self.boundary()
        self.totals()
        self.settings()
        self.files()
        return self.page.html(title, self.header(title))

    def without_results(self, title):
        """The page of a run that has written nothing yet."""
        self.page.section("The problem", "problem")
        self.page.add(paragraphs(prose(self.run.get("text", default=""))))
        self.files()
        return self.page.html(title, self.header(title))

    def header(self, title):
        """Title and the facts of the run in one line."""
        facts = [self.run.get("scene file"), self.run.get("program"),
                 f"{self.run.dimension}D, " + self.kind()]
        processes = self.run.get("processes")
        if processes:
            facts.append(f"{plain(processes)} process" + ("es" if processes != 1 else ""))
        if self.units():
            facts.append("units: " + ", ".join(self.units()))
        spans = "".join(f"<span>{escape(str(f))}</span>" for f in facts if f)
        warning = f'<p class="unfinished">{escape(self.run.unfinished)}</p>' if self.run.unfinished else ""
        return f"<h1>{escape(title)}</h1><p>{spans}</p>{warning}"

    def kind(self):
        """What kind of a run it is."""
        return "steady" if self.steady else "transient"

    def units(self):
        """The units that the page uses."""
        return [u for u in (self.words.length, self.words.time, self.words.solution.unit) if u]

    def rest_of_problem(self):
        """What else belongs to the problem, as HTML: the material."""
        html = materials.material_table(self.run)
        return f'<div class="wide">{html}</div>' if html else ""

    def sketch_legend(self):
        """What colours of the sides mean."""
        return [] if self.run.sides() == self.run.sides(brief=True) \
            else [f"{self.words.held}s in red"]

    def sentences(self):
        """What this run says."""
        return findings.sentences(self.run, self.words, self.largest)

    def problem(self):
        """Text and sketch."""
        self.page.section("The problem", "problem")
        self.page.add('<div class="problem"><div>')
        self.page.add(paragraphs(prose(self.run.get("text", default=""))))
        reference = self.run.get("reference", default="")
        if reference:
            text = minus(reference) if is_formula(str(reference)) else str(reference)
            self.page.add(f"<p><strong>Reference:</strong> {escape(text)}</p>")
        self.page.add(tables.sides_table(self.run))
        self.page.add(self.rest_of_problem())
        self.page.add("</div>")
        legend = []
        if self.run.cracks() and self.run.dimension > 1:
            legend.append("cracks in black")
        legend += self.sketch_legend()
        if self.run.dimension == 2 and self.run.line.data:
            legend.append("the line of the plots dashed")
        if self.run.dimension == 2 and self.run.probes.data:
            legend.append("probes as dots")
        caption = "The body and its sides" + (": " + ", ".join(legend) if legend else "") + "."
        self.page.figure(sketch.problem_sketch(self.maps, self.words), "problem", caption,
                         vector=self.run.dimension != 2)
        self.page.add("</div>")

    def findings(self):
        """The sentences, as a box that follows the problem."""
        items = "".join(f"<li>{escape(s)}</li>" for s in self.sentences())
        notes = len(self.run.get("notes", default=[]))
        if notes:
            items += (f'<li>The program left {plain(notes)} note{"s" if notes != 1 else ""}, '
                      f'see <a href="#settings">Settings and notes</a>.</li>')
        return f'<div class="findings"><h2>What this run says</h2><ul>{items}</ul></div>'

    def fields(self):
        """The solution, and fields that tell more than a multiple of it."""
        for field in (self.words.solution,) + self.words.also:
            solution = field is self.words.solution
            if not self.shown or not solution and \
                    difference.is_multiple(self.run, self.shown, field.name):
                continue
            self.page.section(field.title, field.name)
            if field.about:
                self.page.paragraph(field.about)
            if self.run.dimension > 1:
                self.pictures(field)
            elif solution and self.line_is_body():
                self.draw_line(f"{field.title} over the body")
            else:
                self.profile(field)

    def profile(self, field):
        """A field of a 1D body at its nodes."""
        figure = curves.line_figure(curves.field_table(self.run, self.shown, field), self.words,
                                    field, self.steady)
        self.page.figure(figure, field.name, "Nodal values over the body" + (
            "." if len(self.run.models) == 1 else ", and their difference below."), vector=True)
        largest = difference.largest(self.run, self.shown[-1], field.name)
        self.page.paragraph(self.picture_caption(largest, field))

    def pictures(self, field):
        """The pictures of a field at all shown times."""
        run = self.run
        module = contours if run.dimension == 2 else solids
        scale = contours.common_scale(run, self.shown, field)
        self.page.paragraph(self.picture_text(scale, field))
        times = run.written_times()
        if self.many:
            self.sheet(field)
        for index in self.shown[-1:] if self.many else self.shown:
            largest = difference.largest(run, index, field.name)
            figure = module.field_figure(self.maps, index, self.words, field, largest, scale)
            heading = self.words.at_time(times[index], self.steady)
            self.page.figure(figure, f"{field.name}_{index:04d}",
                             self.picture_caption(largest, field, index), False,
                             name(heading) if self.steady else heading)
        hidden = [plain(t) for i, t in enumerate(times) if i not in self.shown]
        if hidden and not self.many:
            self.page.paragraph(f"Also written, not shown: t = {', '.join(hidden)} "
                                f"{self.words.time}.")

    def sheet(self, field, factor=None):
        """Small pictures of a field at many times."""
        figure, n = film.sheet_of(self.run, field, factor)
        self.page.figure(figure, f"{field.name}_sheet", f"{plain(n)} of the {plain(len(self.run.summary['fields']))} "
                         "written times, on one colour scale; animate.py draws all of them.", False)

    def scale_text(self, scale, field):
        """What the colours have in common."""
        several = len(self.shown) > 1 and not self.many
        if len(self.run.models) < 2 or not field.isolines:
            lines = f"Lines are {field.isolines}. " if field.isolines else ""
            return lines + (
                "" if not several else "All times share one colour scale. " if scale else
                "Each time has its own colour scale. ")
        when = "" if not several else " at all times" if scale else " at each time"
        return f"All models share one colour scale and one set of {field.isolines}{when}. " \
            + ("The difference has its own scale at each time. " if several else "")

    def picture_text(self, scale, field):
        """How to read the pictures."""
        text = self.scale_text(scale, field)
        if self.run.dimension == 3:
            text += "Above, the outer faces that are seen from the upper front right; below, " \
                "slices through the body."
            if self.run.cracks():
                text += " Dashed outlines are cracks behind the faces or beside a slice, " \
                    "thick lines where a slice cuts them."
        elif self.run.cracks():
            text += "Cracks are thick black lines; values are shown up to the crack from each " \
                "side, never across it."
        return text

    def picture_caption(self, largest, field, index=None):
        """Where the largest difference lies, of each model that is compared with finite elements."""
        found = [] if largest is None else [("peridynamics", largest)]
        if index is not None:
            found = [(m, size) for m, size in
                     difference.compared(self.run, index, field.name, largest, with_equal=True) if size is not None]
        text = [f"{name(m)} and finite elements agree to round-off." for m, size in found if size.zero]
        listed = " and ".join(f"{field.amount(size.value)} {size.place()} ({m})" for m, size in found if not size.zero)
        if listed:
            circle = "" if self.run.dimension != 2 else ", marked by circles" if listed.count(" and ") else ", marked by a circle"
            text.append(f"Largest difference from finite elements: {listed}{circle}.")
        return " ".join(text)

    def loading(self):
        """Only elastic bodies are loaded."""

    def line(self):
        """Plots along the line."""
        if not self.run.line.data or (self.shown and self.line_is_body()):
            return
        self.page.section("Along the line", "line")
        self.draw_line(f"{self.words.solution.title} along the line")

    def line_is_body(self):
        """Whether a 1D body is shown by its line already."""
        if self.run.dimension > 1 or not self.run.line.data:
            return False
        points = self.run.line.at(self.run.line.models()[0], self.run.line.times()[-1])[0]
        lower, upper = self.run.domain
        return np.ptp(points) > 0.95 * (upper - lower)[0]

    def draw_line(self, text):
        """The plot along the line."""
        cracks = self.run.cracks(-1 if self.run.summary["fields"] else None)
        figure = curves.line_figure(self.run.line, self.words, self.words.solution, self.steady,
                                    cracks)
        exact = EXACT in self.run.line.models()
        compared = bool(curves.difference_pairs(self.run.line))
        lower = "" if not compared else "each model minus the exact solution" if exact else \
            "peridynamics minus finite elements"
        caption = f"{text}: colour tells the time, the kind of line the model" \
            if len(self.run.line.times()) > 1 else text
        caption += f"; below: {lower}." if lower else "."
        points = next(iter(next(iter(self.run.line.data.values())).values()))[0]
        if len(curves.crossed(points, cracks)[0]):
            caption += " Upright lines are cracks."
            if not self.run.cracks_on_faces():
                caption += " In a cell that a crack cuts, values are interpolated from the " \
                    "nodes on both sides of it."
        if exact and self.run.at_cell_centers():
            caption += " Nodes lie at cell centres and a point of the line has the value of the " \
                "nearest one, hence the fine steps."
        self.page.figure(figure, "line", caption, True)

    def probes(self):
        """Probes over time and their values."""
        html, left_out = tables.probe_table(self.run, self.words)
        if not html:
            return
        self.page.section("Probes", "probes")
        figure, zero = series.probe_figure(self.run, self.words)
        if figure is not None:
            self.page.figure(figure, "probes", f"{self.words.solution.title} at the probes over "
                             f"time. {self.series_text(zero)}", True)
        self.page.add(f'<div class="wide">{html}</div>')
        if left_out:
            self.page.add(f"<p>{plain(left_out)} more rows are in "
                          f'<a href="probes.csv">probes.csv</a>.</p>')

    @staticmethod
    def series_text(zero):
        """How to read plots over time; zero: names of what is not drawn."""
        text = "Computed at the marked times; lines only join the marks."
        return text + (f" Zero at all times, not drawn: {', '.join(zero)}." if zero
                       else "")

    def flux(self):
        """The flux at the last time."""
        index = len(self.run.summary["fields"]) - 1
        if index < 0:
            return
        figure, text = flux.flux_figure(self.maps, index, self.words)
        if figure is None and not text:
            return
        self.page.section(self.words.flux.title, "flux")
        if figure is None:
            self.page.paragraph(text)
            return
        when = self.words.at_time(self.run.written_times()[index], self.steady)
        self.page.figure(figure, self.words.flux.name,
                         f"{self.words.flux.title}, {when}. {text}",
                         vector=self.run.dimension == 1)

    def cost(self):
        """Cost and error."""
        self.page.section("Cost and error", "cost")
        self.page.add(f'<div class="wide">{tables.cost_table(self.run, self.words)}</div>')
        shared = tables.shared_cost(self.run)
        if shared:
            self.page.paragraph(shared)
        html = tables.error_table(self.run, self.words)
        if html:
            self.page.add(f'<h3>Over time</h3><div class="wide">{html}</div>' if not self.steady
                          else f'<div class="wide">{html}</div>')

    def boundary(self):
        """Boundary flux."""
        html = tables.boundary_table(self.run)
        if html:
            self.page.section(f"{name(self.words.passing)} through the sides", "sides")
            self.page.add("<p>What enters the body is positive"
                          + (", per unit thickness" if self.run.dimension == 2 else "") + ".</p>")
            self.moisture()
            self.page.add(f'<div class="wide">{html}</div>')

    def moisture(self):
        """What flows of moisture are."""
        text = tables.what_moisture_counts(self.run)
        if text:
            self.page.paragraph(text)

    def totals(self):
        """Quantities over time."""
        html = tables.totals_table(self.run)
        if not html:
            return
        self.page.section("Totals", "totals")
        self.moisture()
        for quantity in self.words.plotted_apart:
            figure = series.apart_figure(self.run.totals, self.words, quantity)
            if figure is not None:
                self.page.figure(figure, quantity.replace(" ", "_"), f"{name(quantity)} "
                                 f"over time. {self.series_text([])}", True)
        figure, zero = series.totals_figure(self.run.totals, self.words)
        if figure is not None:
            self.page.figure(figure, "totals", self.series_text(zero), True)
        self.page.add(f'<div class="wide">{html}</div>')

    def settings(self):
        """Settings and notes."""
        html, notes = tables.settings_table(self.run), self.run.get("notes", default=[])
        if not html and not notes:
            return
        self.page.section("Settings and notes", "settings")
        if notes:
            kinds = {True: '<li class="warning">', False: "<li>"}
            items = "".join(f'{kinds["warning" in n.lower()]}{escape(n)}</li>'
                            for n in map(prose, notes))
            self.page.add(f'<ul class="notes">{items}</ul>')
        if html:
            self.page.add(f'<div class="wide">{html}</div>')

    def files(self):
        """Links to the files beside the page."""
        directory = self.run.directory
        found = [p for p in ("scene.prm", "summary.json", "line.csv", "probes.csv", "totals.csv")
                 if (directory / p).is_file()]
        found += sorted(str(p.relative_to(directory)) for p in (directory / "fields").glob("*")
                        if p.is_file())
        found += sorted(p.name for p in directory.glob("*") if p.suffix in (".pvd", ".xdmf"))
        self.page.section("Files", "files")
        shown = found[:60]
        items = "".join(f'<li><a href="{escape(p, quote=True)}">{escape(p)}</a></li>'
                        for p in shown)
        self.page.add(f'<ul class="files">{items}</ul>')
        if len(found) > len(shown):
            self.page.add(f"<p>And {len(found) - len(shown)} more in fields/.</p>")
        program = self.run.get("program", default="PeriDeal")
        self.page.add(f"<footer>Written by {escape(program)}.</footer>")


class ElasticReport(ElasticSections, Report):
    """The page of a run of an elastic body."""


def main(arguments=None):
    """Command line."""
    parser = argparse.ArgumentParser(description="Makes report.html from the files of a run.")
    parser.add_argument("directory", metavar="OUTPUT_DIRECTORY")
    parser.add_argument("--figures", metavar="DIRECTORY",
                        help="also write the figures there, as PNG")
    options = parser.parse_args(arguments)
    try:
        run = Run(options.directory)
        html = (ElasticReport if run.words.elastic else Report)(run, options.figures).html()
        target = Path(options.directory) / "report.html"
        write_page(target, html)
    except (ReportError, OSError) as fault:
        print(f"report: {fault}".replace("\n", " "), file=sys.stderr)
        return 1
    print(target)
    return 0


if __name__ == "__main__":
    sys.exit(main())
