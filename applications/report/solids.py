# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Pictures of 3D fields: slices through the body and its three visible outer faces."""

import numpy as np

import contours
import fragments
import style
from crossings import crack_normal
from difference import compared, difference_field
from raster import PAPER_AXES, View

# Directions of x, y, z on paper, y upwards: the sides right, top and front are seen.
ISOMETRIC = np.array([[0.866, -0.5], [0.0, 1.0], [-0.866, -0.5]])
FACES = (0, 1, 2)


def project(points):
    """Points of space on paper."""
    return np.asarray(points, float) @ ISOMETRIC


def body_corners(lower, upper):
    """The eight corners of a box on paper."""
    ends = (lower, upper)
    return project([[ends[i][0], ends[j][1], ends[k][2]]
                    for i in (0, 1) for j in (0, 1) for k in (0, 1)])


def nodes_off(mesh, axis, position, direction):
    """Coordinate of the nearest nodes beyond a position, at least a quarter of a cell from it."""
    lower, upper = mesh.boxes()
    cell = float(np.median((upper - lower)[:, axis]))
    distance = np.sign(direction) * (mesh.nodes[:, axis] - position)
    beyond = distance[distance > 0.25 * cell]
    return position + np.sign(direction) * (beyond.min() if len(beyond) else 0.5 * cell)


def slice_positions(run, index):
    """Where the three slices lie: through the first crack's centre, else the body's centre.

    A slice in the crack's own plane is moved to the first nodes off the crack, on its left
    side: on the crack the solution has two values.
    """
    lower, upper = run.domain
    position = 0.5 * (lower + upper)
    polygons = [c for c in run.cracks(index) if len(c) >= 3]
    remark = {}
    if polygons:
        normal = crack_normal(polygons[0])
        position = polygons[0].mean(axis=0)
        parallel = int(np.argmax(np.abs(normal)))
        spread = np.ptp(polygons[0][:, parallel])
        if spread < 1e-9 * (upper - lower).max():
            model = next(m for m in run.models if run.field_file(index, m) is not None)
            mesh = run.mesh(index, model)
            position[parallel] = nodes_off(mesh, parallel, position[parallel], normal[parallel])
            remark[parallel] = "the first nodes off the crack"
    margin = 1e-6 * (upper - lower)
    return np.clip(position, lower + margin, upper - margin), remark


def slice_segments(cracks, axis, position):
    """Lines in which crack polygons cut the plane x_axis = position, in its two coordinates.

    A polygon that only touches the plane with an edge does not cut it: there is no jump there.
    """
    segments = []
    for polygon in cracks:
        offset = polygon[:, axis] - position
        slack = 1e-9 * np.ptp(polygon, axis=0).max()
        if len(polygon) < 3 or offset.min() > -slack or offset.max() < slack:
            continue
        hits = []
        for a, b in zip(polygon, np.roll(polygon, -1, axis=0)):
            u, v = a[axis] - position, b[axis] - position
            if u * v < 0 or (u == 0) != (v == 0):
                hits.append(a + (b - a) * (u / (u - v)))
        if len(hits) >= 2:
            distances = [np.linalg.norm(h - hits[0]) for h in hits]
            segment = np.array([hits[0], hits[int(np.argmax(distances))]])[:, PAPER_AXES[axis]]
            if np.ptp(segment, axis=0).max() > 0:
                segments.append(segment)
    return segments


def slice_outlines(cracks, axis, position, reach):
    """Edges of crack polygons that lie within reach of the plane, in its two coordinates."""
    edges = []
    for polygon in cracks:
        for a, b in zip(polygon, np.roll(polygon, -1, axis=0)):
            if max(abs(a[axis] - position), abs(b[axis] - position)) <= reach:
                edges.append(np.array([a, b])[:, PAPER_AXES[axis]])
    return edges


class Slices:
    """The views of one run at one time: three slices and three outer faces."""

    def __init__(self, maps, index):
        self.maps, self.index, run = maps, index, maps.run
        self.lower, self.upper = run.domain
        self.position, self.remark = slice_positions(run, index)
        self.cracks = run.cracks(index)
        self.slices = []
        for axis in (2, 1, 0):
            view = View(self.lower, self.upper, 2 * maps.n_pixels // 3, axis, self.position[axis])
            self.slices.append((view, slice_segments(self.cracks, axis, self.position[axis])))
        slack = 1e-9 * (self.upper - self.lower).max()
        self.outlines = {axis: slice_outlines(self.cracks, axis, self.position[axis],
                                              self.off_crack(axis) + slack) for axis in FACES}
        inset = 1e-11 * (self.upper - self.lower)
        self.faces = []
        for axis in FACES:
            at = self.upper[axis] - inset[axis]
            view = View(self.lower, self.upper, 4 * maps.n_pixels // 15, axis, at)
            self.faces.append((view, slice_segments(self.cracks, axis, at)))

    def off_crack(self, axis):
        """Distance of a slice from the first crack where it was moved off it, else 0."""
        if axis not in self.remark:
            return 0.0
        return abs(self.position[axis] - self.cracks_with_area()[0][:, axis].mean())

    def cracks_with_area(self):
        """The polygons among the cracks."""
        return [c for c in self.cracks if len(c) >= 3]

    def pictures(self, model, values):
        """Pictures of the slices and of the faces."""
        return [[self.maps.picture(self.index, model, values, segments,
                                   (view.axis, float(view.position), view.shape), view)
                 for view, segments in group] for group in (self.slices, self.faces)]

    def title(self, view, words):
        """Name of a slice."""
        text = f"{'xyz'[view.axis]} = {style.plain(view.position)} {words.length}".strip()
        if view.axis in self.remark:
            return f"{text}: {self.remark[view.axis]}"
        return text + (": along an edge of a crack" if self.outlines[view.axis] else "")


def face_points(view, fraction_x, fraction_y):
    """Points on paper at fractions of a face."""
    points = np.empty(np.broadcast(fraction_x, fraction_y).shape + (3,))
    extent = view.upper - view.lower
    points[..., view.axes[0]] = view.lower[view.axes[0]] + fraction_x * extent[view.axes[0]]
    points[..., view.axes[1]] = view.lower[view.axes[1]] + fraction_y * extent[view.axes[1]]
    points[..., view.axis] = view.position
    return project(points)


def between(moves):
    """What pixels move by at their corners: means of those around, the edge's own at the edge."""
    padded = np.pad(moves, ((1, 1), (1, 1), (0, 0)), mode="edge")
    parts = np.stack([padded[i:i + moves.shape[0] + 1, j:j + moves.shape[1] + 1]
                      for i in (0, 1) for j in (0, 1)])
    found = np.isfinite(parts)
    return np.where(found, parts, 0).sum(axis=0) / np.maximum(found.sum(axis=0), 1)


def draw_body(axes, slices, pictures, scale, moves=None):
    """The three visible outer faces in isometric projection; moves: by what their pixels do."""
    for i, ((view, _), picture) in enumerate(zip(slices.faces, pictures)):
        picture = scale.clean(picture)
        rows, columns = view.shape
        edges = face_points(view, np.linspace(0, 1, columns + 1)[None, :],
                            np.linspace(0, 1, rows + 1)[:, None])
        shift = 0.0
        if moves is not None:
            edges = edges + project(between(moves[i]))
            shift = project(np.nan_to_num(moves[i]))
        axes.pcolormesh(edges[..., 0], edges[..., 1], np.ma.masked_invalid(picture),
                        cmap=scale.colormap, norm=scale.norm, rasterized=True,
                        edgecolors="face", linewidth=0.2, zorder=2)
        middle = face_points(view, (np.arange(columns)[None, :] + 0.5) / columns,
                             (np.arange(rows)[:, None] + 0.5) / rows) + shift
        finite = picture[np.isfinite(picture)]
        if len(finite) and len(scale.lines):
            inside = (scale.lines > finite.min()) & (scale.lines < finite.max())
            colors = [c for c, keep in zip(scale.line_colors(), inside) if keep]
            if inside.any():
                axes.contour(middle[..., 0], middle[..., 1], np.ma.masked_invalid(picture),
                             levels=scale.lines[inside], colors=colors, linewidths=0.6,
                             linestyles="solid", zorder=3)
        outline = np.concatenate([edges[0], edges[1:, -1], edges[-1, -2::-1], edges[-2::-1, 0]])
        axes.plot(outline[:, 0], outline[:, 1], color=style.INK, linewidth=0.9, zorder=4,
                  solid_joinstyle="round")
        if moves is not None:
            rest = face_points(view, np.array([0, 1, 1, 0, 0]), np.array([0, 0, 1, 1, 0]))
            axes.plot(rest[:, 0], rest[:, 1], color="#52606d", linewidth=0.7,
                      linestyle=(0, (4, 3)), zorder=4)


def draw_hidden_cracks(axes, cracks):
    """Cracks inside the body as dashed outlines."""
    for polygon in cracks:
        closed = project(np.vstack([polygon, polygon[:1]]))
        axes.plot(closed[:, 0], closed[:, 1], color="white", linewidth=2.6, zorder=5)
        axes.plot(closed[:, 0], closed[:, 1], color="black", linewidth=1.2,
                  linestyle=(0, (3.5, 2)), zorder=6)


def label_body(axes, lower, upper, words, size=8):
    """Coordinate names and end values along three edges."""
    extent = upper - lower
    offset = 0.075 * np.ptp(body_corners(lower, upper), axis=0).max()
    edges = ((0, np.array([0, 0, 1]), (-0.6, -1.0)), (1, np.array([0, 0, 1]), (-1.0, 0.0)),
             (2, np.array([1, 0, 0]), (0.6, -1.0)))
    for axis, start, shift in edges:
        a = lower + start * extent
        b = a.copy()
        b[axis] = upper[axis]
        for fraction, text in ((0.0, style.plain(lower[axis])), (0.5, f"${'xyz'[axis]}$"),
                               (1.0, style.plain(upper[axis]))):
            point = project(a + (b - a) * (0.1 + 0.8 * fraction)) + offset * np.array(shift)
            axes.text(point[0], point[1], text, ha="center", va="center", fontsize=size,
                      color=style.INK if fraction == 0.5 else "#52606d")


def frame_body(axes, lower, upper, moves=None):
    """Limits that hold the body, deformed or not, and its labels; equal scales, no axes."""
    corners = body_corners(lower, upper)
    if moves is not None:
        corners = np.concatenate([corners, corners + project(np.stack([
            [np.nanmin(m[..., d]) for d in range(3)] for m in moves]).min(axis=0)),
            corners + project(np.stack([
                [np.nanmax(m[..., d]) for d in range(3)] for m in moves]).max(axis=0))])
    low, high = corners.min(axis=0), corners.max(axis=0)
    pad = 0.13 * (high - low).max()
    low, high = low - [pad, 0.7 * pad], high + [pad, 0.1 * pad]
    # Wider or higher to fill the axes (Matplotlib 3.10 does not do so with limits that are set without a warning).
    box = axes.bbox
    size = high - low
    more = np.maximum(size, size[::-1] * [box.width / box.height, box.height / box.width]) - size
    axes.set_xlim(low[0] - more[0] / 2, high[0] + more[0] / 2)
    axes.set_ylim(low[1] - more[1] / 2, high[1] + more[1] / 2)
    axes.set_aspect("equal")
    axes.axis("off")


def body_height(slices):
    """Height of the picture of the body over its width, at most 1."""
    width, height = np.ptp(body_corners(slices.lower, slices.upper), axis=0)
    return float(np.clip((height + 0.11 * max(width, height)) / (1.26 * width), 0.4, 1.0))


class Grid:
    """Columns of models, rows of views with their own heights, colour bars below."""

    def __init__(self, n_columns, extents):
        self.column = min(2.85, (10 - 0.75 - 0.4 * (n_columns - 1)) / n_columns)
        self.width = max(0.9 + n_columns * self.column + 0.4 * (n_columns - 1), 4.6)
        self.left = 0.75
        if n_columns == 1:
            self.column = 3.7
        self.heights = []
        for width, height in extents:
            self.heights.append(min(self.column * height / width, 3.4))
        self.height = sum(self.heights) + 0.62 * len(extents) + 0.8
        self.figure = style.figure(self.width, self.height)

    def panel(self, row, column):
        """Axes of a panel."""
        bottom = self.height - 0.3 - sum(self.heights[:row + 1]) - 0.62 * row
        bottom += 0.25 if row else 0.0
        left = self.left + column * (self.column + 0.4)
        return self.figure.add_axes([left / self.width, bottom / self.height,
                                     self.column / self.width,
                                     self.heights[row] / self.height])

    def bar(self, first, last, scale, label):
        """The colour bar below some columns."""
        left = self.left + first * (self.column + 0.4)
        length = (last - first) * (self.column + 0.4) + self.column
        box = [left / self.width, 0.52 / self.height, length / self.width, 0.13 / self.height]
        contours.color_bar(self.figure, box, scale, label)


def draw_column(grid, column, slices, pictures, scale, words, title, moves=None):
    """The body and its slices for one model; moves: of the faces, else they are at rest."""
    sections, faces = pictures
    axes = grid.panel(0, column)
    draw_body(axes, slices, faces, scale, moves)
    draw_hidden_cracks(axes, slices.cracks)
    label_body(axes, slices.lower, slices.upper, words, 7.5)
    frame_body(axes, slices.lower, slices.upper, moves)
    style.set_title(axes, title, grid.column + 0.3, 9.5, 4)
    for row, ((view, segments), picture) in enumerate(zip(slices.slices, sections), 1):
        axes = grid.panel(row, column)
        contours.draw_picture(axes, view, picture, scale, segments)
        for edge in slices.outlines[view.axis]:
            axes.plot(*edge.T, color="black", linewidth=1.2, linestyle=(0, (3.5, 2)), zorder=6)
        axes.set_anchor("W")
        axes.set_title(slices.title(view, words), loc="left", pad=3, fontsize=8,
                       fontweight="normal")
        axes.set_xlabel(words.axis("xyz"[view.axes[0]]), labelpad=0)
        contours.sparse_ticks(axes, grid.column, grid.heights[row])
        if column == 0:
            axes.set_ylabel(words.axis("xyz"[view.axes[1]]), labelpad=2)
        else:
            axes.tick_params(labelleft=False)


def difference_pictures(maps, index, field, slices, pictures, model):
    """A model minus FEM of a field in all views: of the nodes, else (two meshes) of the pictures."""
    values = difference_field(maps.run, index, field.name, model)
    if values is not None:
        return slices.pictures(model, values)
    return [[p - f for p, f in zip(*groups)]
            for groups in zip(pictures[model], pictures[contours.FEM])]


def face_moves(maps, index, model, slices, factor):
    """By what the pixels of the outer faces move, magnified; None for a body drawn at rest."""
    displacement = None if factor is None else maps.run.displacement(index, model)
    if displacement is None:
        return None
    flying = fragments.find(maps.run, index, model)
    if flying is not None:
        displacement = np.where(flying.mask[:, None], np.nan, displacement)
    parts = [slices.pictures(model, u)[1] for u in displacement.T]
    return [factor * np.stack(of_face, axis=-1) for of_face in zip(*parts)]


def field_figure(maps, index, words, field, largest=None, scale=None, factor=None, sections=True):
    """A field on the body and its slices, of all models and the difference, if there is one.

    factor: of the displacements of the outer faces, None for the body at rest; sections: whether
    the slices are drawn, too.
    """
    run = maps.run
    slices = Slices(maps, index)
    if not sections:
        slices.slices = []
    models = contours.models_with(run, index, field.name)
    pictures = {m: slices.pictures(m, run.field(index, m, field.name)) for m in models}
    gaps = [m for m, _ in compared(run, index, field.name, largest)
            if m in pictures and contours.FEM in pictures]
    extents = [(1.0, body_height(slices))] + [(v.extent[1] - v.extent[0], v.extent[3] - v.extent[2])
                              for v, _ in slices.slices]
    grid = Grid(len(models) + len(gaps), extents)
    scale = scale or (
        contours.scale_at(run, index, field) if run.words.elastic and fragments.broke(run, index) else
        style.value_scale([p for group in pictures.values() for part in group for p in part],
                          outliers=field.outliers))
    for column, model in enumerate(models):
        draw_column(grid, column, slices, pictures[model], scale, words, style.name(model),
                    face_moves(maps, index, model, slices, factor))
    grid.bar(0, len(models) - 1, scale, field.label())
    for column, model in enumerate(gaps, len(models)):
        difference = difference_pictures(maps, index, field, slices, pictures, model)
        shown = style.difference_scale([p for part in difference for p in part])
        draw_column(grid, column, slices, difference, shown, words,
                    f"{style.name(model)} − finite elements")
        grid.bar(column, column, shown, field.label("Difference"))
    return grid.figure
