# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Samples fields on cells at the pixels of a picture.

A picture of a mesh is a fixed set of interpolation weights: for each pixel the cell that holds its
centre and the weights of the cell's vertices. They are computed once for a mesh and a view and
serve every field and time. The number of pixels is bounded, whatever the number of cells.
"""

import numpy as np

QUAD = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
HEX = np.array([[i, j, k] for k in (0, 1) for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))])
REFERENCE = {2: QUAD, 3: HEX}

# Axes of a slice x_axis = position, to the right and up; y is up where it can be.
PAPER_AXES = {0: [2, 1], 1: [0, 2], 2: [0, 1]}


def shape_values(points, dimension):
    """Multilinear shape functions of the vertices (VTK order) at reference points (P x dim)."""
    if dimension == 2:
        s, t = points.T
        return np.stack([(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t], axis=1)
    corner = REFERENCE[dimension][None, :, :]
    factors = np.where(corner == 1, points[:, None, :], 1 - points[:, None, :])
    return factors.prod(axis=2)


def shape_gradients(points, dimension):
    """Their reference gradients, (P x vertices x dim)."""
    corner = REFERENCE[dimension][None, :, :]
    factors = np.where(corner == 1, points[:, None, :], 1 - points[:, None, :])
    signs = np.where(corner == 1, 1.0, -1.0)
    gradients = np.empty(factors.shape)
    for d in range(dimension):
        others = [e for e in range(dimension) if e != d]
        gradients[:, :, d] = signs[:, :, d] * factors[:, :, others].prod(axis=2)
    return gradients


def boxes_along_axes(corners):
    """(lower corners, extents) where all cells are such boxes, their vertices in the order of VTK, else None."""
    lower, extent = corners[:, 0], corners[:, 2 if corners.shape[2] == 2 else 6] - corners[:, 0]
    expected = lower[:, None] + REFERENCE[corners.shape[2]] * extent[:, None]
    if np.all(extent > 0) and np.abs(corners - expected).max(initial=0) <= 1e-9 * extent.max(initial=0):
        return lower, extent
    return None


def reference_points_2d(corners, points):
    """reference_points() of quadrilaterals, by x = a + b s + d t + e s t."""
    a, b, d = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 3] - corners[:, 0]
    e = corners[:, 2] - corners[:, 3] - b
    size = np.ptp(corners, axis=1).max(axis=1) + 1e-300
    at = np.full(points.shape, 0.5)
    rest = np.arange(len(points))  # those that have not arrived
    for _ in range(8):
        s, t = at[rest].T
        (bx, by), (dx, dy), (ex, ey) = b[rest].T, d[rest].T, e[rest].T
        rx, ry = (points[rest] - a[rest]).T
        rx, ry = rx - bx * s - dx * t - ex * s * t, ry - by * s - dy * t - ey * s * t
        far = np.maximum(np.abs(rx), np.abs(ry)) >= 1e-9 * size[rest]
        if not far.any():
            break
        rest, s, t, rx, ry = rest[far], s[far], t[far], rx[far], ry[far]
        sx, sy, tx, ty = bx[far] + ex[far] * t, by[far] + ey[far] * t, dx[far] + ex[far] * s, dy[far] + ey[far] * s
        determinant = sx * ty - sy * tx
        bad = np.abs(determinant) < 1e-14 * size[rest] ** 2
        determinant[bad] = 1.0
        at[rest, 0] = s + np.clip(np.where(bad, rx, (rx * ty - ry * tx) / determinant), -2, 2)
        at[rest, 1] = t + np.clip(np.where(bad, ry, (ry * sx - rx * sy) / determinant), -2, 2)
    return at


def reference_points(corners, points):
    """Newton's inverse of the multilinear map; one step suffices on parallelepipeds."""
    dimension = points.shape[1]
    if dimension == 2:
        return reference_points_2d(corners, points)
    at = np.full(points.shape, 0.5)
    size = np.ptp(corners, axis=1).max(axis=1)[:, None] + 1e-300
    for _ in range(8):
        residual = points - np.einsum("pv,pvd->pd", shape_values(at, dimension), corners)
        if np.max(np.abs(residual) / size, initial=0) < 1e-9:
            break
        jacobian = np.einsum("pve,pvd->pde", shape_gradients(at, dimension), corners)
        bad = np.abs(np.linalg.det(jacobian)) < 1e-14 * size[:, 0] ** dimension
        jacobian[bad] = np.eye(dimension)
        at += np.clip(np.linalg.solve(jacobian, residual[:, :, None])[:, :, 0], -2, 2)
    return at


class View:
    """A rectangle of pixels: the plane of a 2D body or a slice x_axis = position of a 3D one."""

    def __init__(self, lower, upper, n_pixels, axis=None, position=None):
        self.lower, self.upper = np.asarray(lower, float), np.asarray(upper, float)
        self.axis, self.position = axis, position
        dimension = len(self.lower)
        self.axes = [0, 1] if dimension == 2 else PAPER_AXES[axis]
        extent = (self.upper - self.lower)[self.axes]
        n = np.maximum(2, np.round(n_pixels * extent / extent.max()).astype(int))
        self.shape = (n[1], n[0])
        self.pixel = extent / n
        self.origin = self.lower[self.axes]

    @property
    def extent(self):
        """(left, right, bottom, top) for imshow."""
        lower, upper = self.lower[self.axes], self.upper[self.axes]
        return (lower[0], upper[0], lower[1], upper[1])

    def centers(self):
        """Coordinates of the pixels' centres along both directions."""
        return [self.origin[d] + self.pixel[d] * (np.arange(self.shape[1 - d]) + 0.5)
                for d in (0, 1)]

    def near_segments(self, segments, width):
        """Mask of the pixels nearer to the segments than so many pixels."""
        x, y = self.centers()
        mask = np.zeros(self.shape, bool)
        reach = width * self.pixel.max()
        for a, b in segments:
            along = b - a
            length2 = max(along @ along, 1e-300)
            t = ((x[None, :] - a[0]) * along[0] + (y[:, None] - a[1]) * along[1]) / length2
            t = np.clip(t, 0, 1)
            mask |= np.hypot(x[None, :] - a[0] - t * along[0],
                             y[:, None] - a[1] - t * along[1]) < reach
        return mask


def crosses(p, q, segment):
    """Whether the straight lines p-q (P x 2 each) cross the segment."""
    a, b = segment

    def side(u, v, w):
        return (v[..., 0] - u[..., 0]) * (w[..., 1] - u[..., 1]) - \
               (v[..., 1] - u[..., 1]) * (w[..., 0] - u[..., 0])

    return (side(a, b, p) * side(a, b, q) < 0) & (side(p, q, a) * side(p, q, b) <= 0)


def candidate_pixels(view, lower, upper):
    """(cell, column, row) of all pixels whose centres lie in the boxes of the cells."""
    low = [np.ceil((lower[:, d] - view.origin[d]) / view.pixel[d] - 0.5 - 1e-7).astype(int)
           for d in (0, 1)]
    high = [np.floor((upper[:, d] - view.origin[d]) / view.pixel[d] - 0.5 + 1e-7).astype(int)
            for d in (0, 1)]
    for d in (0, 1):
        low[d] = np.maximum(low[d], 0)
        high[d] = np.minimum(high[d], view.shape[1 - d] - 1)
    n = [np.maximum(0, high[d] - low[d] + 1) for d in (0, 1)]
    counts = n[0] * n[1]
    cell = np.repeat(np.arange(len(lower)), counts)
    offset = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
    column = low[0][cell] + offset % np.maximum(n[0], 1)[cell]
    row = low[1][cell] + offset // np.maximum(n[0], 1)[cell]
    return cell, column, row


class PixelMap:
    """Interpolation from the vertices of a mesh to the pixels of a view.

    In a cell that a crack divides, a pixel takes its value from the vertices on its own side of
    the crack alone (their weights scaled to the sum 1): the model has no conduction across, so a
    straight line through both sides would be a picture of the interpolant, not of the solution.
    A vertex on a crack counts to its left side, or to its cell where the mesh is cut along it.
    """

    def __init__(self, mesh, view, segments=(), on_faces=False):
        self.view = view
        lower, upper = mesh.boxes()
        chosen = np.arange(len(lower))
        if view.axis is not None:
            slack = 1e-9 * (view.upper - view.lower)[view.axis]
            chosen = np.flatnonzero((lower[:, view.axis] <= view.position + slack)
                                    & (upper[:, view.axis] >= view.position - slack))
        pixels, nodes, weights = [], [], []
        for start in range(0, len(chosen), 200_000):
            part = chosen[start:start + 200_000]
            piece = self._piece(mesh, part, lower, upper, segments, on_faces)
            for target, values in zip((pixels, nodes, weights), piece):
                target.append(values)
        n_vertices = mesh.cells.shape[1]
        self.pixels = np.concatenate(pixels) if pixels else np.empty(0, int)
        self.nodes = np.concatenate(nodes) if nodes else np.empty((0, n_vertices), int)
        self.weights = np.concatenate(weights) if weights else np.empty((0, n_vertices))

    def _piece(self, mesh, part, lower, upper, segments, on_faces):
        view = self.view
        cell, column, row = candidate_pixels(view, lower[part][:, view.axes],
                                             upper[part][:, view.axes])
        points = np.empty((len(cell), mesh.dimension))
        points[:, view.axes[0]] = view.origin[0] + (column + 0.5) * view.pixel[0]
        points[:, view.axes[1]] = view.origin[1] + (row + 0.5) * view.pixel[1]
        if view.axis is not None:
            points[:, view.axis] = view.position
        nodes = mesh.cells[part[cell]]
        corners = mesh.nodes[nodes]
        boxes = boxes_along_axes(mesh.nodes[mesh.cells[part]])
        at = reference_points(corners, points) if boxes is None else (points - boxes[0][cell]) / boxes[1][cell]
        inside = np.all((at > -1e-6) & (at < 1 + 1e-6), axis=1)
        nodes, corners, at = nodes[inside], corners[inside], at[inside]
        weights = shape_values(np.clip(at, 0, 1), mesh.dimension)
        if len(segments):
            self._split(weights, corners[:, :, view.axes], points[inside][:, view.axes],
                        segments, on_faces)
        return (row * view.shape[1] + column)[inside], nodes, weights

    @staticmethod
    def _split(weights, corners, points, segments, on_faces):
        """Removes the weights of the vertices that a crack hides from the pixel."""
        size = np.ptp(corners, axis=1).max(axis=1)
        hidden = np.zeros(weights.shape, bool)
        for segment in segments:
            low, high = segment.min(axis=0), segment.max(axis=0)
            near = np.flatnonzero(np.all((points > low - 2 * size[:, None])
                                         & (points < high + 2 * size[:, None]), axis=1))
            along = segment[1] - segment[0]
            left = np.array([-along[1], along[0]]) / max(np.hypot(*along), 1e-300)
            for vertex in range(weights.shape[1]):
                corner = corners[near, vertex]
                if on_faces:
                    corner = corner + 1e-6 * (corners[near].mean(axis=1) - corner)
                else:
                    corner = corner + 1e-6 * size[near, None] * left
                hidden[near, vertex] |= crosses(points[near], corner, segment)
        seen = np.where(hidden, 0, weights)
        total = seen.sum(axis=1)
        usable = hidden.any(axis=1) & (total > 1e-12)
        weights[usable] = seen[usable] / total[usable, None]

    def evaluate(self, values):
        """The picture of a field: rows from the bottom, NaN outside the body."""
        picture = np.full(self.view.shape[0] * self.view.shape[1], np.nan)
        picture[self.pixels] = np.einsum("pv,pv->p", self.weights, values[self.nodes])
        return picture.reshape(self.view.shape)


def is_constant_per_cell(mesh, values, n_sample=20_000):
    """Whether a field has one value a cell (cell-centre nodes); judged on a sample of cells."""
    step = max(1, len(mesh.cells) // n_sample)
    of_cells = values[mesh.cells[::step]]
    spread = np.ptp(of_cells, axis=1).max(initial=0)
    return bool(spread <= 1e-12 * (np.abs(of_cells).max(initial=0) + 1e-300)
                and np.ptp(of_cells) > 0)


def dual_mesh(mesh):
    """Lattice of the cells' centres as (nodes, cells, first vertex of each cell), 2D, or None.

    Isolines of cell-centre nodes are drawn on it: on the cells themselves they are stairs.
    """
    if mesh.dimension != 2 or len(mesh.cells) > 600_000:
        return None
    lower, upper = mesh.boxes()
    centers = 0.5 * (lower + upper)
    spacing = (upper - lower).min(axis=0)
    position = np.round((centers - centers.min(axis=0)) / spacing).astype(int)
    if np.abs((centers - centers.min(axis=0)) / spacing - position).max() > 1e-3:
        return None
    n = position.max(axis=0) + 1
    if n[0] * n[1] > 8 * len(mesh.cells):
        return None
    index = np.full((n[0] + 1, n[1] + 1), -1)
    index[position[:, 0], position[:, 1]] = np.arange(len(centers))
    i, j = position.T
    quads = np.stack([index[i, j], index[i + 1, j], index[i + 1, j + 1], index[i, j + 1]], axis=1)
    return centers, quads[(quads >= 0).all(axis=1)], mesh.cells[:, 0]


def is_inside(ends, middles, corners):
    """Which edges of one cell lie on others: where a mesh is graded, a long one and the two halves of it."""
    number = {tuple(corner): k for k, corner in enumerate(corners.tolist())}
    row = {frozenset(pair): k for k, pair in enumerate(ends.tolist())}
    inside = np.zeros(len(ends), bool)
    for k, ((a, b), middle) in enumerate(zip(ends.tolist(), middles.tolist())):
        # rounding may put the middle into the next place
        for near in ((i, j) for i in (0, -1, 1) for j in (0, -1, 1)):
            m = number.get((middle[0] + near[0], middle[1] + near[1]))
            halves = [row.get(frozenset((a, m))), row.get(frozenset((m, b)))] if m is not None else [None]
            if None not in halves:
                inside[[k, *halves]] = True
                break
    return inside


def boundary_lines(mesh, where=None):
    """The edge of a mesh of quadrilaterals as lines of points: (K x 2) each, closed ones end where they begin.

    Cells with vertices of their own at one place are neighbours. where: (N x 2) places to draw the vertices at."""
    nodes = mesh.nodes if where is None else where
    lower, extent = mesh.nodes.min(axis=0), max(np.ptp(mesh.nodes, axis=0).max(), 1e-300)
    grid = lambda points: np.round((points - lower) / (1e-7 * extent)).astype(np.int64)
    corners, place = np.unique(grid(mesh.nodes), axis=0, return_inverse=True)
    place = place.ravel()
    vertices = np.concatenate([mesh.cells[:, [i, j]] for i, j in ((0, 1), (1, 2), (2, 3), (3, 0))])
    ends = np.sort(place[vertices], axis=1)
    first, count = np.unique(ends, axis=0, return_index=True, return_counts=True)[1:]
    edges = vertices[first[count == 1]]
    edges = edges[~is_inside(place[edges], grid(mesh.nodes[edges].mean(axis=1)), corners)]
    leaving = {}
    for k, a in enumerate(place[edges[:, 0]]):
        leaving.setdefault(int(a), []).append(k)
    lines, taken = [], np.zeros(len(edges), bool)
    for k in range(len(edges)):
        line = []
        while not taken[k]:
            taken[k] = True
            line += [edges[k, 0]] if not line else []
            line.append(edges[k, 1])
            k = next((n for n in leaving.get(int(place[edges[k, 1]]), []) if not taken[n]), k)
        if line:
            lines.append(nodes[line])
    return lines
