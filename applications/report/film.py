# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""A field of one 2D model at many times, on one scale: frames, and sheets of small pictures."""

import numpy as np

import contours
import deformed
import fragments
import style
from contours import Maps, color_bar, draw_cells, draw_picture, segments_of

AT_MOST = 12  # pictures of a sheet


class Film:
    """The pictures of one model of a run at all written times, or some, and their common scale.

    factor: of the displacements of deformed shapes; scale: else what the values need.
    """

    def __init__(self, run, model, field=None, n_pixels=480, indices=None, factor=None, scale=None):
        self.run, self.model, self.factor = run, model, factor
        self.times = run.written_times()
        self.indices = [i for i in (range(len(self.times)) if indices is None else indices)
                        if run.field_file(i, model) is not None]
        self.field = field or self.usual_field()
        self.indices = [i for i in self.indices if run.field(i, model, self.field.name, required=False) is not None]
        self.segments = {i: segments_of(run.cracks(i)) for i in self.indices}
        self.shapes = self.deformed_shapes(n_pixels)
        if self.shapes is not None:
            self.view = self.shapes.view
            share = contours.outliers_of(run, self.indices, self.field)
            self.scale = scale or self.scale_of([fragments.of_body(run, i, model, self.values(i))
                                                 for i in self.indices], share)
            return
        self.view = Maps(run, n_pixels).view()
        self.pictures, self.isolines = {}, {}
        maps, cracks = None, None
        for i in self.indices:
            if maps is None or run.mesh_changes or cracks != run.cracks_text(i):
                maps = Maps(run, n_pixels)  # its weights depend on the cracks of this time
            cracks = run.cracks_text(i)
            values = self.values(i)
            self.pictures[i] = maps.picture(i, model, values, self.segments[i])
            self.isolines[i] = maps.isoline_picture(i, model, values, self.segments[i])
        self.scale = scale or self.scale_of(list(self.pictures.values()), 0.0)

    def usual_field(self):
        """The damage where bonds break, else the solution."""
        words = self.run.words
        if words.elastic and fragments.broke(self.run, self.indices[-1]) \
                and self.run.field(self.indices[-1], self.model, "damage", required=False) is not None:
            return words.fields["damage"]
        return words.solution

    def scale_of(self, values, outliers=None):
        """The scale of all frames: that of the field, where it has one, else what the values need."""
        field = self.field
        return style.fixed_scale(*field.span) if field.span else style.value_scale(
            values, outliers=field.outliers if outliers is None else outliers)

    def values(self, index):
        """The field of a frame at the vertices."""
        return self.run.field(index, self.model, self.field.name)

    def deformed_shapes(self, n_pixels):
        """Of an elastic body that moves, else None."""
        run = self.run
        factor = self.factor or (deformed.magnification(run, self.indices) if run.words.elastic else None)
        if factor is None:
            return None
        shapes = deformed.Shapes(Maps(run, n_pixels), self.indices, [self.model], factor)
        return shapes if all((i, self.model) in shapes.shapes for i in self.indices) else None

    def time_text(self, index):
        """The time of a frame with its unit."""
        unit = self.run.get("units", "time", default="")
        return f"t = {style.plain(self.times[index])} {unit}".rstrip()

    def draw(self, axes, index, scale=None, above=None):
        """One frame in its axes, with its time in the corner, or above where it would cover much."""
        if self.shapes is not None:
            self.shapes.draw(axes, index, self.model, self.values(index), scale or self.scale)
        else:
            draw_picture(axes, self.view, self.pictures[index], scale or self.scale,
                         self.segments[index], self.isolines[index])
            draw_cells(axes, self.run, index, self.model)
        if self.run.get("steady", default=False) and len(self.indices) < 2:
            return
        if is_narrow(self) if above is None else above:
            axes.set_title(self.time_text(index), loc="left", fontsize=8.5, fontweight="normal", pad=3)
            return
        axes.text(0.02, 0.98, self.time_text(index), transform=axes.transAxes, va="top", ha="left",
                  fontsize=8.5, zorder=9, color=style.INK,
                  bbox={"facecolor": "white", "alpha": 0.85, "edgecolor": "none", "pad": 2})


def is_narrow(film):
    """Whether the body is so flat or slender that a text would cover much of it."""
    return min(shape_of(film)) < 2.0


def shape_of(film):
    """Width and height of one panel in inches, 3.6 at most."""
    left, right, bottom, top = film.view.extent
    aspect = (top - bottom) / (right - left)
    return (3.6, 3.6 * aspect) if aspect <= 1 else (3.6 / aspect, 3.6)


def spread(indices, at_most=AT_MOST):
    """Up to so many of some indices, spread evenly, the first and the last included."""
    n = len(indices)
    return [indices[k] for k in sorted({int(round(x)) for x in np.linspace(0, n - 1, min(n, at_most))})]


def sheet_of(run, field, factor=None, n_pixels=None):
    """Small pictures of a field of all models that have it, on one scale; factor: of displacements."""
    last = len(run.summary["fields"]) - 1
    models = contours.models_with(run, last, field.name)
    indices = spread(range(last + 1), AT_MOST // max(1, len(models)))
    scale = contours.common_scale(run, indices, field, least=0.0)
    films = [Film(run, m, field, n_pixels or int(1.2 * style.DOTS_PER_INCH), indices, factor, scale) for m in models]
    return contact_sheet(films, 10.0), len(indices)


def contact_sheet(films, widest=11.0):
    """Small pictures of the times of some films, one below the other, on the scale of the first."""
    first, n, titled = films[0], max(len(f.indices) for f in films), len(films) > 1
    columns = n if titled else min(n, 4)
    rows = -(-n // columns)
    most = (widest - 0.3) / columns - 0.12
    width, height = (min(0.72, most / shape_of(first)[0]) * size for size in shape_of(first))
    above = is_narrow(first) or min(width, height) < 1.7
    across, up = max(0.12, min(1.0, most) - width), 0.32 if above else 0.12
    block = rows * (height + up) + (0.3 if titled else 0.0)
    total = (max(columns * (width + across) + 0.3, 3.0), len(films) * block + 0.85)
    figure = style.figure(*total)
    for b, film in enumerate(films):
        top = total[1] - 0.1 - b * block
        if titled:
            figure.text(0.15 / total[0], (top - 0.06) / total[1], style.name(film.model), fontsize=10,
                        fontweight="bold", va="top")
            top -= 0.3
        for k, index in enumerate(film.indices):
            left = 0.15 + (k % columns) * (width + across)
            bottom = top - (k // columns + 1) * (height + up) + 0.12
            axes = figure.add_axes([left / total[0], bottom / total[1], width / total[0], height / total[1]])
            film.draw(axes, index, first.scale, above)
            axes.set_xticks([])
            axes.set_yticks([])
    length = min(total[0] - 0.6, 5.0)
    color_bar(figure, [(total[0] - length) / 2 / total[0], 0.55 / total[1], length / total[0], 0.12 / total[1]],
              first.scale, first.field.label())
    return figure
