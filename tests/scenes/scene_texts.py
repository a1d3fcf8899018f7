# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Scenes and meshes that several tests start from."""

import itertools
import math

from scene_test import scene_text, write_file

# A strip of width 1 that is pulled along y, for cracks from its sides.
PULLED_STRIP = scene_text("""
Dimension = 2
Physics = elasticity
Domain/Lower corner = 0, -1.5
Domain/Upper corner = 1, 1.5
Material/Young modulus = 200
Material/Poisson ratio = 0.3
Boundary conditions/Traction = top: 0, 1 ; bottom: 0, -1
""")


def body_of_bonds(lines, young, poisson=0.3, density=1):
    """An elastic body in peridynamics, and further lines as for scene_text()."""
    return scene_text(f"""
Physics = elasticity
Models = peridynamics
Material/Young modulus = {young}
Material/Poisson ratio = {poisson}
Material/Density = {density}
{lines.strip()}""")


def mesh_text(nodes, elements, names=()):
    """A Gmsh file of nodes, tuples of two or three numbers, and elements "kind 2 side side node ..." without their numbers; names: (dimension, number, name)."""
    numbered = lambda lines: "".join(f"{k} {line}\n" for k, line in enumerate(lines, 1))
    named = f"$PhysicalNames\n{len(names)}\n" + "".join(f'{d} {k} "{name}"\n' for d, k, name in names) + "$EndPhysicalNames\n"
    places = [" ".join(repr(float(x)) for x in (*node, 0)[:3]) for node in nodes]
    return (f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n{named if names else ''}$Nodes\n{len(nodes)}\n{numbered(places)}$EndNodes\n"
            f"$Elements\n{len(elements)}\n{numbered(elements)}$EndElements\n")


BOX = ((1, 0, 0), (2, 0, -1), (3, 1, 0), (4, 1, -1))


def grid_mesh(shape, place, sides=BOX, group=9, names=(), points=(), closed=False, turned=False):
    """A mesh file of shape = (n, m) or (n, m, l) cells with nodes at place(i, j, ...); returns its path.

    sides: (number, axis, index of nodes along it, -1 for the last, where?): those faces across the axis that belong to a cell; where: of the other
    indices. group: the number of cells, or a function of their indices, None where there is no cell. points: (number, indices of a node).
    closed: the last nodes along the first axis are the first ones. turned: cells the other way round.
    """
    dim, number, cells, elements = len(shape), {}, {}, []

    def node(index):
        return number.setdefault((index[0] % shape[0] if closed else index[0], *index[1:]), len(number) + 1)

    def add(kind, of, corners):
        elements.append(f"{kind} 2 {of} {of} " + " ".join(str(node(corner)) for corner in corners))

    square = [(0, 0), (0, 1), (1, 1), (1, 0)] if turned else [(0, 0), (1, 0), (1, 1), (0, 1)]
    for first in itertools.product(*map(range, shape)):
        cells[first] = group(*first) if callable(group) else group
        if cells[first] is not None:
            offsets = square if dim == 2 else [(*corner, k) for k in (0, 1) for corner in square]
            add(3 if dim == 2 else 5, cells[first], [tuple(map(sum, zip(first, offset))) for offset in offsets])
    for side, axis, at, *where in sides:
        at = shape[axis] if at < 0 else at
        for rest in itertools.product(*(range(n) for d, n in enumerate(shape) if d != axis)):
            beside = [cells.get((*rest[:axis], k, *rest[axis:])) for k in (at - 1, at)]
            if any(cell is not None for cell in beside) and all(holds(*rest) for holds in where):
                add(1 if dim == 2 else 3, side, [(*corner[:axis], at, *corner[axis:]) for corner in
                                                 (tuple(map(sum, zip(rest, offset))) for offset in ([(0,), (1,)] if dim == 2 else square))])
    elements += [f"15 2 {of} {of} {node(index)}" for of, index in points]
    return write_file("grid.msh", mesh_text([place(*index) for index in number], elements, names))


def shaken(spacing, moved, shape):
    """place() of nodes on a lattice, of which those inside are moved by so much of a spacing."""
    def place(i, j):
        inner = moved if 0 < i < shape[0] and 0 < j < shape[1] else 0
        return spacing * (i + inner * math.sin(7 * i + 3 * j)), spacing * (j + inner * math.cos(5 * i + 11 * j))
    return place


# A Gmsh file of the unit square: sides 3 (bottom) and 4 (top). names: its $PhysicalNames, or
# nothing; n: how many elements there are, the four of the sides included; cells: numbered from 5.
SQUARE_MESH = """$MeshFormat
2.2 0 8
$EndMeshFormat
{names}$Nodes
9
1 0 0 0
2 0.5 0 0
3 1 0 0
4 0 0.5 0
5 0.5 0.5 0
6 1 0.5 0
7 0 1 0
8 0.5 1 0
9 1 1 0
$EndNodes
$Elements
{n}
1 1 2 3 3 1 2
2 1 2 3 3 2 3
3 1 2 4 4 7 8
4 1 2 4 4 8 9
{cells}
$EndElements
"""
FOUR_CELLS = "5 3 2 7 7 1 2 5 4\n6 3 2 7 7 2 3 6 5\n7 3 2 7 7 4 5 8 7\n8 3 2 7 7 5 6 9 8"
