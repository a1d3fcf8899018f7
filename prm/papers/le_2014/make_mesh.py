#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Write the upper half of Le's plate with a hole as a Gmsh file of quadrilaterals that follow the circle.

    make_mesh.py [FILE [N]]     plate_with_hole.msh; 4 N elements along the half circle, 16 unless given

Physical curves: 1 left (x = 0), 2 right (x = 100), 3 the plane of symmetry (y = 25), 4 top (y = 50), 5 the hole. Around the hole the
elements grow by a constant factor; vertices of the half circle lie between 0 and 180 degrees at equal angles, one of them at its top.
"""

import math
import sys
from pathlib import Path

LENGTH, HEIGHT, RADIUS = 100.0, 50.0, 10.0
MIDDLE, CENTER = LENGTH / 2, HEIGHT / 2


def edge_point(angle):
    """Where the ray leaves the square of half edge 25 around the hole."""
    c, s = math.cos(angle), math.sin(angle)
    reach = HEIGHT / 2 / max(abs(c), abs(s))
    return MIDDLE + reach * c, CENTER + reach * s


class Mesh:
    def __init__(self):
        self.numbers, self.points, self.quads, self.lines = {}, [], [], []

    def node(self, x, y):
        key = round(x * 1e6), round(y * 1e6)
        if key not in self.numbers:
            self.points.append((x, y))
            self.numbers[key] = len(self.points)
        return self.numbers[key]

    def block(self, point, n, m):
        """A mapped block; sides are found by their places."""
        nodes = [[self.node(*point(i, j)) for j in range(m + 1)] for i in range(n + 1)]
        for i in range(n):
            for j in range(m):
                self.quads.append((nodes[i][j], nodes[i + 1][j], nodes[i + 1][j + 1], nodes[i][j + 1]))

    def find_sides(self):
        count = {}
        for quad in self.quads:
            for a, b in zip(quad, quad[1:] + quad[:1]):
                count.setdefault(frozenset((a, b)), []).append((a, b))
        for edges in count.values():
            if len(edges) == 1:
                a, b = edges[0]
                x, y = ((self.points[a - 1][k] + self.points[b - 1][k]) / 2 for k in (0, 1))
                near = [abs(x) < 1e-6, abs(x - LENGTH) < 1e-6, abs(y - CENTER) < 1e-6, abs(y - HEIGHT) < 1e-6]
                self.lines.append((near.index(True) + 1 if any(near) else 5, a, b))


def make(n):
    """n elements along an eighth of the circle, which is half an edge of the square."""
    mesh, n_radial = Mesh(), (5 * n) // 4
    growth = (2.6 * n / 8) ** (1 / n_radial) if n > 3 else 1.0
    share = [(growth ** k - 1) / (growth ** n_radial - 1) for k in range(n_radial + 1)]

    def around(i, j):
        angle = math.pi * j / (4 * n)
        x, y = edge_point(angle)
        a, b = MIDDLE + RADIUS * math.cos(angle), CENTER + RADIUS * math.sin(angle)
        return a + share[i] * (x - a), b + share[i] * (y - b)

    mesh.block(around, n_radial, 4 * n)
    n_ends = (3 * n) // 4
    for start, inner in ((0.0, CENTER), (LENGTH, LENGTH - CENTER)):
        def end(i, j, start=start, inner=inner):
            y = edge_point(math.pi / 4 * j / n)[1]
            x = inner + (start - inner) * i / n_ends
            return x, y
        mesh.block(end if start > inner else (lambda i, j, end=end: end(i, n - j)), n_ends, n)
    mesh.find_sides()
    return mesh


def write(mesh, file):
    rows = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(mesh.points))]
    rows += [f"{k} {x:.9g} {y:.9g} 0" for k, (x, y) in enumerate(mesh.points, 1)]
    rows += ["$EndNodes", "$Elements", str(len(mesh.lines) + len(mesh.quads))]
    rows += [f"{k} 1 2 {side} {side} {a} {b}" for k, (side, a, b) in enumerate(mesh.lines, 1)]
    rows += [f"{k} 3 2 0 1 {' '.join(map(str, quad))}" for k, quad in enumerate(mesh.quads, len(mesh.lines) + 1)]
    Path(file).write_text("\n".join(rows + ["$EndElements"]) + "\n", encoding="utf-8")


if __name__ == "__main__":
    name = sys.argv[1] if len(sys.argv) > 1 else str(Path(__file__).with_name("plate_with_hole.msh"))
    write(make(int(sys.argv[2]) if len(sys.argv) > 2 else 16), name)
