# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""The sections of the report that are different for elastic bodies."""


import numpy as np

import contours
import crack_curves
import curves
import deformed
import difference
import elastic_curves
import elastic_findings
import elastic_tables
import fragments
import loading
import series
import solids
import style
from style import is_nothing

STRESSES = {1: ("stress_xx",), 2: ("stress_xx", "stress_yy", "stress_xy"),
            3: ("stress_xx", "stress_yy", "stress_zz", "stress_xy")}
ROUND_OFF = 1e-9
NO_STRESS = 1e-6  # of the largest: what the tolerance of a solver leaves in a body in pieces


class ElasticSections:
    """Takes the place of some methods of a Report."""

    def kind(self):
        """What kind of a run it is."""
        return "static" if self.steady else "slowly loaded" if loading.is_slow(self.run) \
            else "dynamic"

    def units(self):
        """Units that the page uses: a body at rest has no time."""
        return [u for u in (self.words.length, "" if self.steady else self.words.time) if u]

    def sketch_legend(self):
        """What arrows and marks at the sides mean."""
        texts = " ".join(self.run.sides().values())
        legend = []
        if "traction" in texts:
            legend.append("tractions t in orange")
        if "displacement" in texts or "velocity" in texts:
            legend.append("displacements u in red (hatched: held, circles: free to slide)")
        if "symmetry" in texts:
            legend.append("symmetry planes in violet")
        return legend

    def sentences(self):
        """What this run says."""
        index = self.shown[-1] if self.shown else None
        gap = None if index is None else difference.largest_of(
            self.run, index, difference.displacement_gap(self.run, index), self.words.solution.name)
        return elastic_findings.sentences(self.run, self.words, gap, index, self.stressed())

    def fields(self):
        """Displacement, stress, and what else was written."""
        if not self.shown:
            return
        draw = self.bar_fields if self.run.dimension == 1 else self.body_fields
        axes = "xyz"[:self.run.dimension]
        scalars = self.words.fields
        last = self.shown[-1]
        self.page.section("Displacement", "displacement")
        self.factor = deformed.magnification(self.run, self.shown) \
            if self.run.dimension > 1 else None
        draw([self.words.solution], self.shown, self.factor)
        parts = [scalars[f"displacement_{a}"] for a in axes]
        draw(self.worth_drawing(parts, [last]), [last])
        listed = parts if self.run.dimension == 1 else [self.words.solution] + parts
        self.page.add('<div class="wide">'
                      + elastic_tables.extremes_table(self.run, last, listed) + "</div>")
        self.page.section("Stress", "stress")
        draw([scalars["von_mises"]], self.under_stress())
        last = self.stressed()
        stresses = [scalars[s] for s in STRESSES[self.run.dimension]]
        if self.run.dimension > 1:
            stresses.append(scalars["pressure"])
        draw(self.worth_drawing(stresses, [last], scalars["von_mises"]), [last])
        self.page.add('<div class="wide">' + elastic_tables.extremes_table(
            self.run, last, [scalars["von_mises"]] + stresses) + "</div>")
        for name in ("plastic_strain", "damage"):
            self.lasting(name, draw)
        if any(self.run.has_field(i, "temperature") for i in self.shown):
            self.page.section(scalars["temperature"].title, "temperature")
            draw(self.worth_drawing([scalars["temperature"]], self.shown), self.shown)

    def lasting(self, name, draw):
        """What does not go back, in the deformed shape; nothing where there is none."""
        field = self.words.fields[name]
        if not any((self.values(field, i) > ROUND_OFF).any() for i in self.shown):
            return
        self.page.section(field.title, field.name)
        self.page.paragraph(field.about)
        draw([field], self.shown, self.factor)

    def under_stress(self):
        """The shown times with more stress than what a solver leaves of none; all of a motion."""
        if not loading.is_slow(self.run) or self.many:
            return self.shown
        sizes = self.largest_stresses()
        bare = [i for i in self.shown if not sizes[i] > NO_STRESS * max(sizes.values())]
        if not bare or len(bare) == len(self.shown):
            return self.shown
        listed = ", ".join(self.words.at_time(self.run.written_times()[i]) for i in bare)
        self.page.paragraph(f"No stress is left at {listed}: not drawn.")
        return [i for i in self.shown if i not in bare]

    def stressed(self):
        """The shown time that tells most of the stress, or None without fields: the last one, of a
        slowly loaded body that may have broken by then the one with much stress in all models."""
        if not self.shown or not loading.is_slow(self.run):
            return self.shown[-1] if self.shown else None
        of_models = [self.largest_stresses([m]) for m in self.run.models]
        of_models = [sizes for sizes in of_models if max(sizes.values()) > 0]
        return max(reversed(self.shown), key=lambda i: min(
            (sizes[i] / max(sizes.values()) for sizes in of_models), default=0.0))

    def largest_stresses(self, models=None):
        """{shown time: the largest von Mises stress of some models, or of all}."""
        values = {i: self.values(self.words.fields["von_mises"], i, models) for i in self.shown}
        return {i: float(v[np.isfinite(v)].max(initial=0)) for i, v in values.items()}

    def values(self, field, index, models=None):
        """The values of a field of some models, or of all, at a time, in one array."""
        found = [self.run.field(index, m, field.name, required=False)
                 for m in contours.models_with(self.run, index, field.name)
                 if models is None or m in models]
        return np.concatenate([v.ravel() for v in found]) if found else np.zeros(0)

    def worth_drawing(self, fields, indices, among=None):
        """The fields that were written and are not zero but for round-off; says which are."""
        among = among or self.words.solution
        shown, silent = [], []
        for field in fields:
            if not any(self.run.has_field(i, field.name) for i in indices):
                continue
            zero = all(is_nothing(self.values(field, i) * (1e-12 / ROUND_OFF),
                                  self.values(among, i) if field.unit == among.unit
                                  or field.name.startswith(("stress", "pressure"))
                                  else self.values(field, i)) for i in indices)
            (silent if zero else shown).append(field)
        if silent:
            self.page.paragraph("Zero everywhere, not drawn: "
                                f"{', '.join(f.text for f in silent)}.")
        return shown

    def bar_fields(self, fields, indices, factor=None):
        """Fields of a bar at its nodes; the length of its displacement is no curve of its own."""
        for field in fields:
            if field is self.words.solution or field.name == "von_mises" \
                    and self.run.has_field(indices[-1], "stress_xx"):
                continue
            table = curves.field_table(self.run, self.shown, field)
            if not table.data:
                continue
            figure = curves.line_figure(table, self.words, field, self.steady)
            largest = difference.largest(self.run, indices[-1], field.name)
            caption = f"{field.title} at the nodes" + (
                "." if len(table.models()) == 1 else ", and the difference of the models below.")
            self.page.figure(figure, field.name,
                             f"{caption} {self.picture_caption(largest, field)}", vector=True)

    def body_fields(self, fields, indices, factor=None):
        """Pictures of fields of a plate or a body; factor: of the displacements of its shape."""
        for field in fields:
            written = [i for i in indices if self.run.has_field(i, field.name)]
            if not written:
                continue
            if self.many and len(written) > 1:
                self.sheet(field, factor)
                written = [self.stressed() if field.name == "von_mises" else written[-1]]
            scale = contours.common_scale(self.run, written, field)
            if factor is not None:
                self.page.paragraph(f"The deformed shape, with {deformed.factor_text(factor)}; the body "
                                    f"at rest is dashed. {self.picture_text(scale, field)}")
            elif len(written) > 1 or field.name in ("von_mises", "damage"):
                self.page.paragraph(self.picture_text(scale, field))
            for index in written:
                self.body_field(field, index, scale, factor, len(indices) > 1)

    def body_field(self, field, index, scale, factor, of_several):
        """One picture of a field."""
        run = self.run
        largest = difference.largest(run, index, field.name)
        if run.dimension == 3:
            in_full = field.name in (self.words.solution.name, "von_mises", "damage")
            figure = solids.field_figure(self.maps, index, self.words, field, largest, scale,
                                         factor, in_full)
        elif factor is not None:
            figure = deformed.deformed_figure(self.maps, index, self.words, field, factor, largest,
                                              scale)
        else:
            figure = contours.field_figure(self.maps, index, self.words, field, largest, scale)
        if figure is None:
            return
        when = "" if self.steady else self.words.at_time(run.written_times()[index])
        heading = ", ".join(part for part in (field.title, when) if part)
        mark = f"{field.name}_{index:04d}" if of_several or not self.steady else field.name
        caption = [self.picture_caption(largest, field, index), self.beyond(field, index)]
        self.page.figure(figure, mark, " ".join(filter(None, caption)), False, heading)

    def beyond(self, field, index):
        """What lies outside the scale of a picture that leaves out fragments or extremes of a broken body."""
        run = self.run
        if field.span or not fragments.broke(run, index):
            return ""
        found = {m: fragments.find(run, index, m) for m in run.models}
        parts = [f"{f.text(self.words.solution.amount)} ({m})" for m, f in found.items()
                 if f is not None and field is self.words.solution]
        text = f"Outside the scale and, where it has gone far, the picture: {'; '.join(parts)}. " \
            if parts else ""
        values, lowest, highest = contours.body_values(run, index, field)
        low, high, extend = style.without_outliers(values, contours.outliers_of(run, [index], field))
        if extend != "neither" or parts:
            text += f"All values lie between {field.amount(lowest)} and {field.amount(highest)}"
            share = float(((values < low) | (values > high)).mean()) if len(values) else 0.0
            text += f"; {style.plain(100 * share, 2)} % of the body's are beyond the scale's ends." \
                if share > 0 else "."
        return text

    def loading(self):
        """Forces and energies of a slowly loaded body; those of a motion are among its energies."""
        if loading.is_slow(self.run) and loading.n_times(self.run) >= 3:
            self.page.section("Loading", "loading")
            self.page.add("<p>The loads change so slowly that the body is at rest at each time.</p>")
            self.loading_figures()

    def loading_figures(self):
        """Forces and broken bonds, then the energies, over time."""
        shown, opposite = loading.forces(self.run)
        figure = loading.force_figure(self.run, self.words, shown)
        if figure is not None:
            self.page.figure(figure, "forces",
                             loading.force_caption(self.run, shown, opposite), True)
        figure, drawn = loading.travel_figure(self.run, self.words, shown)
        if figure is not None:
            listed = " and of ".join(f"{f.side} in {f.axis}" for f in drawn)
            self.page.figure(figure, "force_over_displacement", "The force over the mean displacement "
                             f"of its side, of {listed}.", True)
        figure = crack_curves.figure(self.run, self.words)
        if figure is not None:
            self.page.figure(figure, "crack_growth", crack_curves.caption(self.run), True)
        figure = loading.energy_figure(self.run, self.words)
        if figure is not None:
            self.page.figure(figure, "energies", loading.energy_caption(self.run), True)

    def line(self):
        """Plots along the line, a panel for each column."""
        run = self.run
        if not run.line.data:
            return
        cracks = run.cracks(-1 if run.summary["fields"] else None)
        figure, silent = elastic_curves.line_figure(run, self.words, cracks)
        self.page.section("Along the line", "line")
        if figure is not None:
            caption = "Displacements and stresses along the line"
            if len(run.line.times()) > 1:
                caption += "; colour tells the time, the kind of line the model"
            points = next(iter(next(iter(run.line.data.values())).values()))[0]
            caption += "." if not len(curves.crossed(points, cracks)[0]) else \
                "; upright lines are cracks."
            self.page.figure(figure, "line", caption, True)
        if silent:
            self.page.paragraph("Zero along the line, not drawn: "
                                f"{', '.join(self.words.column(c).text for c in silent)}.")

    def probes(self):
        """Values at the probes, and over time where there are several."""
        html, cut = elastic_tables.probe_table(self.run, self.words)
        if not html:
            return
        self.page.section("Probes", "probes")
        figure, zero = elastic_curves.probe_figure(self.run, self.words)
        if figure is not None:
            self.page.figure(figure, "probes", self.series_text(zero), True)
        self.page.add(f'<div class="wide">{html}</div>')
        if cut:
            self.page.add('<p>Those of the last time; all are in <a href="probes.csv">probes.csv</a>'
                          ".</p>")

    def flux(self):
        """Stresses are among the fields."""

    def boundary(self):
        """Forces on the sides."""
        html = elastic_tables.force_table(self.run)
        if html:
            self.page.section("Forces on the sides", "sides")
            per = {1: "", 2: ", per unit thickness", 3: ""}[self.run.dimension]
            when = f" at {self.words.at_time(self.run.end_time)}" \
                if loading.is_slow(self.run) and self.run.end_time is not None else ""
            self.page.paragraph(f"What acts on the body from outside{when}{per}.")
            self.page.add(f'<div class="wide">{html}</div>')

    def totals(self):
        """Energies, the mean stress, statistics of the phases."""
        html = elastic_tables.energy_table(self.run)
        if html:
            self.page.section("Energy and mean stress", "totals")
            totals = self.run.totals
            if loading.is_slow(self.run) or loading.can_break(self.run):
                if not loading.is_slow(self.run):
                    self.loading_figures()
                drawn = loading.drawn_quantities(self.run) | crack_curves.drawn_quantities(self.run)
                totals = {q: v for q, v in totals.items() if q not in drawn}
            energies = {q: v for q, v in totals.items() if "energy" in q}
            others = {q: v for q, v in totals.items() if q not in energies}
            figure, zero = series.totals_figure({**energies, **others}, self.words)
            if figure is not None:
                self.page.figure(figure, "totals", self.series_text(zero), True)
            self.page.add(f'<div class="wide">{html}</div>')
        html = elastic_tables.phase_table(self.run)
        if html:
            self.page.section("Phases", "phases")
            self.page.add("<p>Statistics of the von Mises stress in each phase.</p>")
            self.page.add(f'<div class="wide">{html}</div>')
