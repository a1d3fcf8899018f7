# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Pictures of 2D fields: models side by side, their difference."""

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PolyCollection
from matplotlib.ticker import MaxNLocator

import fragments
import style
from raster import PixelMap, View, dual_mesh, is_constant_per_cell
from difference import compared, difference_field
from read_run import Mesh

FEM, PD = "finite elements", "peridynamics"
PIXELS = 3 * style.DOTS_PER_INCH  # along the longer side of a picture


class Maps:
    """The pixel maps of a run, one per mesh and view, made when first needed."""

    def __init__(self, run, n_pixels=None):
        self.run, self.n_pixels = run, n_pixels or PIXELS
        self.on_faces = run.cracks_on_faces()
        self._maps = {}

    def view(self, axis=None, position=None):
        """The whole body, or a slice through it."""
        lower, upper = self.run.domain
        return View(lower, upper, self.n_pixels, axis, position)

    def picture(self, index, model, values, segments, key=None, view=None):
        """A field of a model at the pixels; segments: the cracks in the view's plane."""
        mesh = self.run.mesh(index, model)
        tag = (id(mesh), key, np.concatenate([s.ravel() for s in segments]).tobytes()
               if len(segments) else b"")
        if tag not in self._maps:
            self._maps[tag] = PixelMap(mesh, view or self.view(), segments, self.on_faces)
        return self._maps[tag].evaluate(values)

    def isoline_picture(self, index, model, values, segments):
        """The picture isolines are drawn from, or None where it is the field's own picture."""
        mesh = self.run.mesh(index, model)
        if not is_constant_per_cell(mesh, values):
            return None
        tag = (id(mesh), "dual", len(segments))
        if tag not in self._maps:
            dual = dual_mesh(mesh)
            self._maps[tag] = dual and (
                PixelMap(Mesh(dual[0], dual[1]), self.view(), segments, False), dual[2])
        if not self._maps[tag]:
            return None
        pixel_map, first = self._maps[tag]
        return pixel_map.evaluate(values[first])


def segments_of(cracks):
    """The straight pieces of 2D cracks."""
    return [np.array([c[i], c[i + 1]]) for c in cracks for i in range(len(c) - 1)]


def draw_cracks(axes, segments, width=1.7):
    """Cracks as black lines with a white outline."""
    for a, b in segments:
        axes.plot([a[0], b[0]], [a[1], b[1]], color="white", linewidth=width + 1.6,
                  solid_capstyle="round", zorder=6)
        axes.plot([a[0], b[0]], [a[1], b[1]], color="black", linewidth=width,
                  solid_capstyle="round", zorder=7)


def draw_cells(axes, run, index, model, most=40_000):
    """The edges of a graded mesh, hardly visible where cells are small."""
    if not run.mesh_is_graded:
        return
    mesh = run.mesh(index, model)
    if mesh.dimension != 2 or len(mesh.cells) > most:
        return
    axes.add_collection(PolyCollection(mesh.nodes[mesh.cells], facecolors="none",
                                       edgecolors="black", linewidths=0.25, alpha=0.35, zorder=3))


def draw_isolines(axes, view, picture, scale, segments):
    """Isolines of a picture; not across cracks, where they would only bunch."""
    values = np.where(view.near_segments(segments, 1.2), np.nan, picture) if len(segments) \
        else picture
    finite = values[np.isfinite(values)]
    if not len(finite) or not len(scale.lines):
        return
    inside = (scale.lines > finite.min()) & (scale.lines < finite.max())
    if inside.any():
        colors = [c for c, keep in zip(scale.line_colors(), inside) if keep]
        x, y = view.centers()
        axes.contour(x, y, np.ma.masked_invalid(values), levels=scale.lines[inside],
                     colors=colors, linewidths=0.7, linestyles="solid", zorder=4)


def draw_picture(axes, view, picture, scale, segments=(), isolines=None):
    """One picture in its axes."""
    picture = scale.clean(picture)
    isolines = picture if isolines is None else scale.clean(isolines)
    axes.imshow(picture, origin="lower", extent=view.extent, cmap=scale.colormap, norm=scale.norm,
                interpolation="nearest", aspect="equal", zorder=2)
    draw_isolines(axes, view, isolines, scale, segments)
    draw_cracks(axes, segments)
    axes.set_xlim(view.extent[:2])
    axes.set_ylim(view.extent[2:])


def color_bar(figure, box, scale, label, vertical=False):
    """The bar of a scale in the box (fractions of the figure)."""
    axes = figure.add_axes(box)
    bar = figure.colorbar(ScalarMappable(scale.norm, scale.colormap), cax=axes,
                          orientation="vertical" if vertical else "horizontal",
                          extend=scale.extend, spacing="proportional")
    lines = scale.lines
    ticks = np.concatenate([[scale.levels[0]], lines, [scale.levels[-1]]]) if len(lines) \
        else scale.levels[::5]
    room = (box[3] * figure.get_figheight() / 0.25) if vertical \
        else (box[2] * figure.get_figwidth() / 0.5)
    stride = max(1, int(np.ceil(len(ticks) / max(room, 2))))
    step = ticks[1] - ticks[0]
    ticks = [t for t in ticks if round(t / step) % stride == 0] or ticks[::stride]
    bar.set_ticks(ticks)
    bar.ax.minorticks_off()
    bar.outline.set_linewidth(0.5)
    bar.outline.set_edgecolor("#9aa5b1")
    bar.ax.tick_params(length=2.5, labelsize=8)
    length = box[3] * figure.get_figheight() if vertical else box[2] * figure.get_figwidth()
    bar.set_label(style.wrapped(label, max(length, 1.0)), fontsize=8.5)
    return bar


def sparse_ticks(axes, width, height):
    """Few, round ticks for panels of so many inches."""
    for axis, length in ((axes.xaxis, width), (axes.yaxis, height)):
        axis.set_major_locator(MaxNLocator(nbins=int(np.clip(1.8 * length, 2, 9)),
                                           steps=[1, 2, 5, 10], min_n_ticks=2))
    axes.tick_params(length=2.5)


class Layout:
    """Places panels of one aspect ratio: side by side, or below each other when they are flat.

    More than three stand in two rows, the differences below the models.
    """

    WIDTH = 10.0
    SLOT = 1.6  # room for a title and a label

    def __init__(self, n_panels, extent, n_values):
        aspect = (extent[3] - extent[2]) / (extent[1] - extent[0])
        self.n, self.n_values = n_panels, n_values
        self.stacked = aspect < 0.42 and n_panels > 1
        if self.stacked or (n_panels == 1 and aspect < 0.42):
            self.stacked = True
            self.panel_width = 7.9
            self.panel_height = max(0.5, self.panel_width * aspect)
            self.width = self.WIDTH
            self.top = 0.32 + max(0.0, 0.5 * (0.9 - self.panel_height))  # the bar's label is taller
            self.height = n_panels * (self.panel_height + 0.62) + 0.1 + 2 * (self.top - 0.32)
        else:
            self.columns = n_panels if n_panels < 4 else max(n_values, n_panels - n_values)
            room = (self.WIDTH - 0.75 - 0.4 * (self.columns - 1)) / self.columns
            self.panel_width = min(room, 4.6, 5.6 / aspect)
            self.panel_height = self.panel_width * aspect
            self.gap = max(0.4, self.SLOT - self.panel_width)
            used = self.columns * (self.panel_width + self.gap)
            self.width = max(used + 0.5, 3.6)
            self.left = 0.75 + max(0.0, (self.width - 0.5 - used) / 2)
            self.row_height = self.panel_height + 1.68
            self.height = self.row_height * (1 if n_panels < 4 else 2)
        self.figure = style.figure(self.width, self.height)

    def place(self, i):
        """(column, row from below) of panel i."""
        if self.n < 4:
            return i, 0
        return (i, 1) if i < self.n_values else (i - self.n_values, 0)

    def panel(self, i):
        """Axes of panel i."""
        if self.stacked:
            bottom = self.height - self.top - self.panel_height - i * (self.panel_height + 0.62)
            box = (0.7, bottom, self.panel_width, self.panel_height)
        else:
            column, row = self.place(i)
            box = (self.left + column * (self.panel_width + self.gap), 1.3 + row * self.row_height,
                   self.panel_width, self.panel_height)
        axes = self.figure.add_axes([box[0] / self.width, box[1] / self.height,
                                     box[2] / self.width, box[3] / self.height])
        sparse_ticks(axes, self.panel_width, self.panel_height)
        return axes

    def bar(self, first, last, scale, label):
        """The colour bar of the panels first..last."""
        if self.stacked:
            top = self.height - self.top - first * (self.panel_height + 0.62)
            bottom = self.height - self.top - self.panel_height - last * (self.panel_height + 0.62)
            box = [8.8 / self.width, bottom / self.height, 0.14 / self.width,
                   (top - bottom) / self.height]
            return color_bar(self.figure, box, scale, label, vertical=True)
        (from_column, row), (to_column, _) = self.place(first), self.place(last)
        left = self.left + from_column * (self.panel_width + self.gap)
        right = self.left + to_column * (self.panel_width + self.gap) \
            + max(self.panel_width, self.SLOT - 0.3)
        length = min(right - left, 6.0)
        left += (right - left - length) / 2
        box = [left / self.width, (0.64 + row * self.row_height) / self.height,
               length / self.width, 0.13 / self.height]
        return color_bar(self.figure, box, scale, label)

    def title(self, axes, text):
        """The title of a panel."""
        style.set_title(axes, text, 9.0 if self.stacked else self.panel_width + self.gap - 0.1)


def label_axes(axes, words, view, i, layout):
    """Axis labels where there is room for them."""
    names = "xyz"
    if not layout.stacked or i == layout.n - 1:
        axes.set_xlabel(words.axis(names[view.axes[0]]), labelpad=1)
    else:
        axes.tick_params(labelbottom=False)
    if layout.stacked or layout.place(i)[0] == 0:
        axes.set_ylabel(words.axis(names[view.axes[1]]), labelpad=2)
    else:
        axes.tick_params(labelleft=False)


def difference_picture(maps, index, field, segments, pictures, model=PD):
    """A model minus FEM of a field: at the nodes, else (two meshes) the difference of the pictures."""
    if FEM not in pictures or model not in pictures:
        return None
    values = difference_field(maps.run, index, field.name, model)
    if values is None:
        return pictures[model] - pictures[FEM]
    return maps.picture(index, model, values, segments)


BROKEN_OFF = 0.002  # share of the nodes of a broken body that colours may leave out at either end


def outliers_of(run, indices, field):
    """The share of the values that colours may leave out: of a broken body always some."""
    some = run.words.elastic and not field.span and any(fragments.broke(run, i) for i in indices)
    return max(field.outliers, BROKEN_OFF if some else 0.0)


def body_values(run, index, field):
    """(finite values of all models at one written time without fragments, lowest and highest of all)."""
    found, ends = [], []
    for model in run.models:
        values = run.field(index, model, field.name, not run.words.elastic)
        if values is None or not np.isfinite(values).any():
            continue
        ends += [np.nanmin(values), np.nanmax(values)]
        if run.words.elastic:
            values = fragments.of_body(run, index, model, values)
        found.append(values[np.isfinite(values)])
    return (np.concatenate(found), min(ends), max(ends)) if found else (np.zeros(0), 0.0, 0.0)


def scale_at(run, index, field):
    """The scale of an elastic body's field at one written time: by its values without fragments."""
    if field.span:
        return style.fixed_scale(*field.span)
    values, *reach = body_values(run, index, field)
    return style.value_scale([values], outliers=outliers_of(run, [index], field), reach=reach)


def value_range(run, index, field):
    """(lowest, highest value that the scale shows, lowest, highest of all) of all models at one
    written time, or None."""
    values, *reach = body_values(run, index, field)
    if not len(values):
        return None
    share = outliers_of(run, [index], field) if run.words.elastic and fragments.broke(run, index) else 0.0
    low, high, _ = style.without_outliers(values, share)
    return low, high, *reach


def common_scale(run, indices, field, least=0.3):
    """One scale for all times, or None where at some time the values would fill little of it."""
    if field.span:
        return style.fixed_scale(*field.span)
    ranges = [r for r in (value_range(run, i, field) for i in indices) if r is not None]
    if len(ranges) < 2:
        return None
    low, high = min(r[0] for r in ranges), max(r[1] for r in ranges)
    if min(r[1] - r[0] for r in ranges) < least * (high - low) or not high > low:
        return None
    return style.value_scale([np.array([low, high])],
                             reach=(min(r[2] for r in ranges), max(r[3] for r in ranges)))


def models_with(run, index, name):
    """The models that wrote a field at that time."""
    written = [m for m in run.models if run.field_file(index, m) is not None]
    if not run.words.elastic:  # there it is a fault of the files if one has not
        return written
    return [m for m in written if run.field(index, m, name, required=False) is not None]


def field_figure(maps, index, words, field, largest=None, scale=None):
    """A field of all models at one written time and, if there is one, the difference."""
    run = maps.run
    segments = segments_of(run.cracks(index))
    view = maps.view()
    models = models_with(run, index, field.name)
    pictures, smooth = {}, {}
    for model in models:
        values = run.field(index, model, field.name)
        pictures[model] = maps.picture(index, model, values, segments)
        smooth[model] = maps.isoline_picture(index, model, values, segments)
    gaps = [(m, size, difference_picture(maps, index, field, segments, pictures, m))
            for m, size in compared(run, index, field.name, largest)]
    gaps = [entry for entry in gaps if entry[2] is not None]
    layout = Layout(len(models) + len(gaps), view.extent, len(models))
    scale = scale or (scale_at(run, index, field) if run.words.elastic and fragments.broke(run, index) else
                      style.value_scale(list(pictures.values()), outliers=field.outliers))
    for i, model in enumerate(models):
        axes = layout.panel(i)
        draw_picture(axes, view, pictures[model], scale, segments, smooth[model])
        draw_cells(axes, run, index, model)
        layout.title(axes, style.name(model))
        label_axes(axes, words, view, i, layout)
    layout.bar(0, len(models) - 1, scale, field.label())
    for i, (model, size, gap) in enumerate(gaps, len(models)):
        draw_difference(layout, i, view, gap, segments, words, field, size, model)
    return layout.figure


def draw_difference(layout, i, view, difference, segments, words, field, largest, model):
    """The panel of a model minus FEM with a circle at its largest value."""
    axes = layout.panel(i)
    scale = style.difference_scale([difference])
    draw_picture(axes, view, difference, scale, segments)
    layout.title(axes, f"{style.name(model)} − finite elements")
    label_axes(axes, words, view, i, layout)
    layout.bar(i, i, scale, field.label("Difference"))
    if largest is not None:
        axes.plot(*largest.at, marker="o", markersize=7, markerfacecolor="none",
                  markeredgecolor=style.INK, markeredgewidth=1.0, zorder=8, clip_on=False)
