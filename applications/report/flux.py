# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Pictures of the flux: its magnitude as colour, its direction as arrows, in 1D a curve."""

import numpy as np

import contours
import curves
import solids
import style


def flux_parts(run, index, model):
    """The flux of a model at the vertices, (N x dim), or None."""
    if run.field_file(index, model) is None:
        return None
    for name in run.words.flux_datasets():
        values = run.field(index, model, name, required=False)
        if values is not None:
            values = values.reshape(len(values), -1)
            return values[:, :run.dimension]
    return None


def nothing(words):
    """The sentence in place of a picture of zeros."""
    return f"The {words.flux.text} is zero everywhere."


class Arrows:
    """Arrows on a coarse lattice of a view, of one scale for all models."""

    LONGEST = 0.92  # of the lattice's spacing

    def __init__(self, view, parts, n=16):
        rows, columns = view.shape
        stride = max(rows, columns) / n
        self.rows = np.arange(stride / 2, rows, stride).astype(int)
        self.columns = np.arange(stride / 2, columns, stride).astype(int)
        self.spacing = stride * view.pixel.max()
        self.view = view
        self.sampled = {m: [p[np.ix_(self.rows, self.columns)] for p in pair]
                        for m, pair in parts.items()}
        sizes = np.concatenate([np.hypot(*pair).ravel() for pair in self.sampled.values()])
        sizes = sizes[np.isfinite(sizes)]
        self.full = float(sizes.max(initial=0))
        usual = float(np.quantile(sizes, 0.95)) if len(sizes) else 0.0
        self.capped = 0 < 1.5 * usual < self.full
        if self.capped:
            self.full = usual

    def text(self, flux):
        """What an arrow's length says of the flux of that name."""
        if not self.full > 0:
            return ""
        more = " and more" if self.capped else ""
        return (f"The length of an arrow is proportional to the {flux}, on one scale for "
                f"all pictures: the longest stands for {style.plain(self.full, 3)}{more}.")

    def draw(self, axes, model):
        """The arrows of one model."""
        u, v = self.sampled[model]
        size = np.hypot(u, v)
        shown = np.isfinite(size) & (size > 0.02 * self.full)
        if not shown.any():
            return
        x, y = self.view.centers()
        x, y = np.meshgrid(x[self.columns], y[self.rows])
        factor = np.minimum(1, self.full / size[shown]) / self.full
        axes.quiver(x[shown], y[shown], u[shown] * factor, v[shown] * factor, pivot="mid",
                    angles="xy", scale_units="xy", scale=1 / (self.LONGEST * self.spacing),
                    width=0.0036, headwidth=4.2, headlength=4.8, headaxislength=4.3,
                    minlength=0.1, color="#1f2933", edgecolor="white", linewidth=0.3, zorder=5)


def plane_figure(maps, index, words, view=None, segments=None, key=None):
    """Magnitude and direction of all models in a plane: (figure or None, text)."""
    run = maps.run
    view = view or maps.view()
    segments = contours.segments_of(run.cracks(index)) if segments is None else segments
    parts = {}
    for model in run.models:
        values = flux_parts(run, index, model)
        if values is not None:
            parts[model] = [maps.picture(index, model, values[:, d], segments, key, view)
                            for d in range(run.dimension)]
    if not parts:
        return None, ""
    magnitude = {m: np.sqrt(sum(p ** 2 for p in part)) for m, part in parts.items()}
    if not any(np.nanmax(p, initial=0) > 0 for p in magnitude.values()):
        return None, nothing(words)
    scale = style.value_scale(list(magnitude.values()), style.FLUX, n=10, parts=6, clip=0.995)
    without_lines = style.Scale(scale.levels, style.FLUX, [], scale.extend)
    arrows = Arrows(view, {m: [part[view.axes[0]], part[view.axes[1]]]
                           for m, part in parts.items()})
    layout = contours.Layout(len(parts), view.extent, len(parts))
    for i, model in enumerate(parts):
        axes = layout.panel(i)
        contours.draw_picture(axes, view, magnitude[model], without_lines, segments)
        arrows.draw(axes, model)
        axes.set_title(style.name(model), loc="left", pad=5)
        contours.label_axes(axes, words, view, i, layout)
    layout.bar(0, len(parts) - 1, scale, f"Magnitude of the {words.flux.text}")
    return layout.figure, arrows.text(words.flux.text)


def slice_figure(maps, index, words):
    """The first slice of a 3D body: (figure or None, text)."""
    slices = solids.Slices(maps, index)
    view, segments = slices.slices[0]
    figure, text = plane_figure(maps, index, words, view, segments,
                                (view.axis, float(view.position), view.shape))
    if figure is None:
        return figure, text
    return figure, (f"Slice {slices.title(view, words)}; arrows show the part in its plane, "
                    f"colour the whole. {text}")


def curve_figure(run, index, words):
    """The flux over a 1D body: (figure or None, text)."""
    found = {}
    for model in run.models:
        values = flux_parts(run, index, model)
        if values is not None:
            mesh = run.mesh(index, model)
            order = mesh.cells[np.argsort(mesh.nodes[mesh.cells].mean(axis=1)[:, 0])].ravel()
            found[model] = (mesh.nodes[order, 0], values[order, 0])
    if not found:
        return None, ""
    if not any(np.nanmax(np.abs(v), initial=0) > 0 for _, v in found.values()):
        return None, nothing(words)
    figure = style.figure(10, 3.2)
    axes = figure.add_axes([0.085, 0.19, 0.735, 0.74])
    for model, (x, values) in found.items():
        curves.draw_curve(axes, x, values, model)
    axes.set_xlabel(words.axis("x"))
    axes.set_ylabel(words.flux.label())
    style.tidy(axes)
    curves.model_legend(axes, list(found), True, loc="upper left", bbox_to_anchor=(1.01, 1.0))
    return figure, f"Positive where {words.quantity} flows to the right."


def flux_figure(maps, index, words):
    """The picture of a run of any dimension: (figure or None, text)."""
    if maps.run.dimension == 1:
        return curve_figure(maps.run, index, words)
    return (plane_figure if maps.run.dimension == 2 else slice_figure)(maps, index, words)
