# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Pictures of elastic bodies in their deformed shape, with the displacement magnified."""

import math

import numpy as np

import contours
import fragments
import style
from difference import compared, difference_field
from raster import PixelMap, View, boundary_lines, crosses, is_constant_per_cell
from read_run import Mesh

SHARE = 0.05  # of the body's extent: how large the largest displacement is drawn
DAMAGED = fragments.DAMAGED  # share of broken bonds from which the body may be torn
NEAR = 0.15  # of the body's extent: how far outside it fragments are still in the picture
TORN = 0.25  # share of a cell that its vertex moves off at a tear


def magnification(run, indices):
    """One round factor for all models and times, or None without a displacement.

    The largest displacement, but for that of fragments, is drawn about as long as 5 % of the body,
    and as it is (1) where it is up to five times as large as that.
    """
    sizes = [np.linalg.norm(fragments.of_body(run, i, m, u), axis=1) for i in indices
             for m, u in ((m, run.displacement(i, m)) for m in run.models) if u is not None]
    largest = max((float(np.nanmax(s, initial=0)) for s in sizes if np.isfinite(s).any()),
                  default=0.0)
    lower, upper = run.domain
    if not largest > 0:
        return None
    return round_factor(SHARE * float((upper - lower).max()) / largest)


def round_factor(factor):
    """1, 2 or 5 times a power of ten, the nearest; 1 between 0.2 and 1."""
    if 0.2 <= factor <= 1:
        return 1.0
    exponent = math.floor(math.log10(factor))
    lead = min((1, 2, 5, 10), key=lambda d: abs(math.log(factor / 10 ** exponent / d)))
    return lead * 10.0 ** exponent


def factor_text(factor):
    """'displacements 50 times as large', or that they are true."""
    return "displacements at their true size" if factor == 1 else \
        f"displacements magnified {style.plain(factor)} times"


def left_of(segment):
    """Unit normal to the left of a segment."""
    along = segment[1] - segment[0]
    return np.array([-along[1], along[0]]) / max(np.hypot(*along), 1e-300)


class Shape:
    """The deformed cells of a 2D model at one time.

    A cell that a crack divides is there twice, each copy moving with the vertices on its own side
    and drawn on that side only: so a crack opens wherever it lies in the cell. Where bonds have
    broken, cells around nodes at their centres part as soon as they would be drawn out of shape, and
    cells between nodes at their vertices come apart into the quarters around these.
    """

    def __init__(self, mesh, displacement, factor, segments=(), on_faces=False, damage=None,
                 flying=None):
        self.mesh, self.factor, self.flying = mesh, factor, flying
        self.segments = segments
        self.is_torn = damage is not None and bool((damage > DAMAGED).any())
        corners = mesh.nodes[mesh.cells]
        shift = 1e-6 * np.ptp(corners, axis=1).max(axis=1)[:, None, None]
        self.centers = corners.mean(axis=1)
        if displacement.ndim == 2 and any(is_constant_per_cell(mesh, u) for u in displacement.T):
            smooth = np.stack([self.smooth(u) for u in displacement.T], axis=1)
            displacement = self.torn(displacement, smooth, damage)
            hidden, parts = np.zeros(mesh.cells.shape, bool), None  # they move as their centres do
        else:
            hidden = self.hidden_from_first(corners, shift, on_faces)
            parts = self.parts(displacement, damage, hidden)
        moves = factor * displacement[mesh.cells]
        cut = np.flatnonzero(hidden.any(axis=1))
        source, visible = [np.arange(len(mesh.cells)), cut], [~hidden, hidden[cut]]
        self.in_quarters = np.zeros(0, int)
        if parts is not None:
            source, visible = self.with_parts(parts, source, visible)
        self.source = np.concatenate(source)
        visible = np.concatenate(visible)
        visible[~visible.any(axis=1)] = True
        self.visible = visible
        self.rest = corners[self.source]
        self.anchor = self.mean_of_visible(self.rest)
        self.slack = shift[self.source, 0]
        self.divided = np.zeros(len(self.source), bool)
        self.divided[cut] = self.divided[len(mesh.cells):len(mesh.cells) + len(cut)] = True
        quarters, self.in_quarters = self.in_quarters, np.zeros(len(self.source), bool)
        self.in_quarters[quarters] = True
        moved = self.rest + self.completed(moves[self.source])
        cells = np.arange(4 * len(self.source)).reshape(-1, 4)
        self.deformed = Mesh(moved.reshape(-1, 2), cells)

    def hidden_from_first(self, corners, shift, on_faces):
        """(M x 4): the vertices that a crack separates from the first one of their cell."""
        hidden = np.zeros(corners.shape[:2], bool)
        for segment in self.segments:
            moved = corners + 1e-6 * (self.centers[:, None] - corners) if on_faces \
                else corners + shift * left_of(segment)
            for v in range(1, 4):
                hidden[:, v] |= crosses(moved[:, v], moved[:, 0], segment)
        return hidden

    def parts(self, displacement, damage, hidden):
        """(M x 4): the part of its cell that each vertex is in, 0 where the cell is whole; or None."""
        if damage is None or not (damage > DAMAGED).any() or not np.isfinite(displacement).all():
            return None
        cells = self.mesh.cells
        gap = np.stack([np.linalg.norm(displacement[cells[:, a]] - displacement[cells[:, b]], axis=1)
                        for a, b in fragments.EDGES[4]], axis=1)
        ends = np.stack([damage[cells[:, list(e)]] for e in fragments.EDGES[4]], axis=1)
        torn = fragments.torn(gap, ends[:, :, 0], ends[:, :, 1])
        torn[hidden.any(axis=1)] = False
        part = np.broadcast_to(np.arange(4), cells.shape).copy()
        for _ in range(3):
            for e, (a, b) in enumerate(fragments.EDGES[4]):
                low = np.minimum(part[:, a], part[:, b])
                for v in (a, b):
                    part[:, v] = np.where(torn[:, e], part[:, v], low)
        return part if part.any() else None

    def with_parts(self, parts, source, visible):
        """Sources and visible vertices with a copy of each cell that comes apart for all its parts."""
        apart = np.flatnonzero(parts.any(axis=1))
        visible[0][apart] = parts[apart] == 0
        at = sum(map(len, source))
        quarters = [apart]
        for part in (1, 2, 3):
            some = apart[(parts[apart] == part).any(axis=1)]
            source.append(some)
            visible.append(parts[some] == part)
            quarters.append(at + np.arange(len(some)))
            at += len(some)
        self.in_quarters = np.concatenate(quarters)
        return source, visible

    def torn(self, own, smooth, damage):
        """Displacements of the vertices: smooth, but those of a damaged cell its own at a tear."""
        if damage is None:
            return smooth
        size = np.empty(len(own))
        size[self.mesh.cells] = np.ptp(self.mesh.nodes[self.mesh.cells], axis=1).min(axis=1)[:, None]
        apart = self.factor * np.linalg.norm(smooth - own, axis=1) > TORN * size
        return np.where((apart & (damage > DAMAGED))[:, None], own, smooth)

    def mean_of_visible(self, values):
        """Mean over the visible vertices of each cell, (M x dim)."""
        weight = self.visible / self.visible.sum(axis=1, keepdims=True)
        return np.einsum("mv,mvd->md", weight, values)

    def completed(self, values):
        """Values at vertices with those of the other side replaced by the mean of the own."""
        return np.where(self.visible[:, :, None], values, self.mean_of_visible(values)[:, None])

    def smooth(self, values):
        """Values of cells as means at the vertices, of the cells on the same side of all cracks."""
        mesh = self.mesh
        corner = mesh.nodes[mesh.cells].reshape(-1, 2)
        centers = np.repeat(self.centers, 4, axis=0)
        grain = 1e-5 * np.ptp(mesh.nodes[mesh.cells], axis=1).max()
        key = np.round((corner - corner.min(axis=0)) / grain).astype(np.int64)
        hidden = np.zeros(len(corner), np.int64)
        for segment in self.segments:
            inner = corner + 1e-6 * (centers - corner)
            size = np.linalg.norm(centers - corner, axis=1)[:, None]
            hidden |= crosses(corner + 1e-6 * size * left_of(segment), inner, segment) \
                | crosses(inner, centers, segment)
        flat = (key[:, 0] * (key[:, 1].max() + 1) + key[:, 1]) * 2 + hidden
        _, group = np.unique(flat, return_inverse=True)
        of_cells = values[mesh.cells].ravel()
        means = np.bincount(group, of_cells) / np.maximum(np.bincount(group), 1)
        result = np.empty(len(mesh.nodes))
        result[mesh.cells.ravel()] = means[group]
        return result

    def is_whole(self):
        """Whether all cells are connected as they are at rest."""
        return len(self.source) == len(self.mesh.cells) and not self.is_torn

    def edge(self):
        """The edge of a body that is whole, as lines."""
        places = np.empty_like(self.mesh.nodes)
        places[self.mesh.cells] = self.deformed.nodes.reshape(-1, 4, 2)
        return boundary_lines(self.mesh, places)

    def bounds(self):
        """Lower and upper corner of the deformed shape, with what of fragments is near it."""
        nodes = self.deformed.nodes
        if self.flying is not None:
            flying = self.flying[self.mesh.cells][self.source].any(axis=1)
            of_cells = nodes.reshape(len(self.source), -1, 2)
            body = of_cells[~flying].reshape(-1, 2)
            low, high = np.nanmin(body, axis=0), np.nanmax(body, axis=0)
            reach = NEAR * (high - low).max()
            near = flying & ((of_cells > low - reach) & (of_cells < high + reach)).all(axis=(1, 2))
            nodes = np.concatenate([body, of_cells[near].reshape(-1, 2)])
        return np.nanmin(nodes, axis=0), np.nanmax(nodes, axis=0)

    def draw_on(self, view):
        """Prepares picture() for a view."""
        self.map = PixelMap(self.deformed, view)
        cell = self.map.nodes[:, 0] // 4
        checked = np.flatnonzero(self.divided[cell])
        points = np.einsum("pv,pvd->pd", self.map.weights[checked], self.rest[cell[checked]])
        wrong = np.zeros(len(checked), bool)
        for segment in self.segments:  # what lies on a crack belongs to its left side
            anchor = self.anchor + self.slack * left_of(segment)
            wrong |= crosses(points, anchor[cell[checked]], segment)
        kept = np.ones(len(cell), bool)
        kept[checked[wrong]] = False
        apart = np.flatnonzero(self.in_quarters[cell])
        nearest = self.map.weights[apart].argmax(axis=1)
        kept[apart] &= self.visible[cell[apart], nearest]
        self.map.pixels, self.map.nodes, self.map.weights = (
            part[kept] for part in (self.map.pixels, self.map.nodes, self.map.weights))

    def picture(self, values):
        """A field given at the vertices of the body's cells, on the deformed shape."""
        of_cells = values[self.mesh.cells][self.source][:, :, None]
        return self.map.evaluate(self.completed(of_cells).ravel())

    def isoline_picture(self, values):
        """The picture isolines are drawn from: smooth, where the values are those of cells."""
        return self.picture(self.smooth(values)) if is_constant_per_cell(self.mesh, values) \
            else None


class Shapes:
    """The deformed shapes of some models at some times in one view."""

    def __init__(self, maps, indices, models, factor, margin=0.02):
        self.maps, self.run, self.factor = maps, maps.run, factor
        self.shapes = {}
        for index in indices:
            segments = contours.segments_of(self.run.cracks(index))
            for model in models:
                u = self.run.displacement(index, model)
                if u is not None and np.isfinite(u).all():
                    damage = self.run.field(index, model, "damage", required=False)
                    flying = fragments.find(self.run, index, model)
                    self.shapes[index, model] = Shape(self.run.mesh(index, model), u, factor,
                                                      segments, maps.on_faces, damage,
                                                      None if flying is None else flying.mask)
        ends = [self.run.domain] + [s.bounds() for s in self.shapes.values()]
        lower = np.min([e[0] for e in ends], axis=0)
        upper = np.max([e[1] for e in ends], axis=0)
        edge = margin * (upper - lower).max()
        self.view = View(lower - edge, upper + edge, maps.n_pixels)
        for shape in self.shapes.values():
            shape.draw_on(self.view)

    def faces(self, index, model):
        """Both faces of each crack in the deformed shape, as lines of points."""
        maps, run = self.maps, self.run
        cracks = contours.segments_of(run.cracks(index))
        if not cracks:
            return []
        view = maps.view()
        parts = [maps.picture(index, model, u, cracks)
                 for u in run.displacement(index, model).T]
        lines = []
        for a, b in cracks:
            along = b - a
            length = np.hypot(*along)
            normal = np.array([-along[1], along[0]]) / max(length, 1e-300)
            n = max(2, int(length / view.pixel.max() / 2))
            points = a + np.linspace(0, 1, n)[:, None] * along
            for side in (1.0, -1.0):
                at = points + 1.3 * side * view.pixel.max() * normal
                column, row = (np.floor((at[:, d] - view.origin[d]) / view.pixel[d]).astype(int)
                               for d in (0, 1))
                inside = (column >= 0) & (row >= 0) & (column < view.shape[1]) \
                    & (row < view.shape[0])
                u = np.full((n, 2), np.nan)
                for d in (0, 1):
                    u[inside, d] = parts[d][row[inside], column[inside]]
                lines.append(points + self.factor * u)
        return lines

    def draw(self, axes, index, model, values, scale):
        """One field on the deformed shape, in its axes."""
        shape, view = self.shapes[index, model], self.view
        picture = scale.clean(shape.picture(values))
        axes.imshow(picture, origin="lower", extent=view.extent, cmap=scale.colormap,
                    norm=scale.norm, interpolation="nearest", aspect="equal", zorder=2)
        smooth = shape.isoline_picture(values)
        contours.draw_isolines(axes, view, picture if smooth is None else scale.clean(smooth),
                               scale, ())
        if shape.is_whole():  # the edge itself, else that of the pixels
            for line in shape.edge():
                axes.plot(*line.T, color=style.INK, linewidth=0.7, zorder=5)
        else:
            outline(axes, view, np.isfinite(picture), color=style.INK, linewidth=0.7, zorder=5)
        for line in self.faces(index, model):
            axes.plot(*line.T, color="black", linewidth=0.9, zorder=6)
        for line in boundary_lines(shape.mesh):
            axes.plot(*line.T, color="#52606d", linewidth=0.7, linestyle=(0, (4, 3)), zorder=5)
        axes.set_xlim(view.extent[:2])
        axes.set_ylim(view.extent[2:])


def outline(axes, view, inside, **look):
    """The edge of a mask, where it meets the edge of the view too."""
    x, y = view.centers()
    x, y = (np.concatenate([[v[0] - 0.5 * step], v, [v[-1] + 0.5 * step]])
            for v, step in zip((x, y), view.pixel))
    lines = axes.contour(x, y, np.pad(inside.astype(float), 1), levels=[0.5], linewidths=0)
    for line in lines.allsegs[0]:
        axes.plot(*np.asarray(line).T, **look)


def shapes_at(maps, index, models, factor):
    """Shapes of one time; those of the last call, which other fields of that time ask for again."""
    key = (index, tuple(models), factor)
    if getattr(maps, "last_shapes", (None,))[0] != key:
        maps.last_shapes = key, Shapes(maps, [index], models, factor)
    return maps.last_shapes[1]


def deformed_figure(maps, index, words, field, factor, largest=None, scale=None):
    """A field of all models on their deformed shapes, and the difference on the shape at rest."""
    run = maps.run
    models = contours.models_with(run, index, field.name)
    shapes = shapes_at(maps, index, models, factor)
    models = [m for m in models if (index, m) in shapes.shapes]
    if not models:
        return None
    values = {m: run.field(index, m, field.name) for m in models}
    gaps = [(m, size, difference_field(run, index, field.name, m))
            for m, size in compared(run, index, field.name, largest)]
    gaps = [entry for entry in gaps if entry[2] is not None]
    layout = contours.Layout(len(models) + len(gaps), shapes.view.extent, len(models))
    scale = scale or (contours.scale_at(run, index, field) if fragments.broke(run, index) else
                      style.value_scale(list(values.values()), outliers=field.outliers))
    for i, model in enumerate(models):
        axes = layout.panel(i)
        shapes.draw(axes, index, model, values[model], scale)
        layout.title(axes, style.name(model))
        contours.label_axes(axes, words, shapes.view, i, layout)
    layout.bar(0, len(models) - 1, scale, field.label())
    segments = contours.segments_of(run.cracks(index))
    for i, (model, size, gap) in enumerate(gaps, len(models)):
        picture = maps.picture(index, model, gap, segments, ("wide", index), shapes.view)
        contours.draw_difference(layout, i, shapes.view, picture, segments, words, field, size, model)
    return layout.figure
