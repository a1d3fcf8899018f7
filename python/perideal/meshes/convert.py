# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Reads a mesh of any format and writes it as a Gmsh file of version 2.2."""

from pathlib import Path

import numpy as np

from . import abaqus, exodus, unv, with_meshio
from .groups import Groups
from .mesh import Fault, Mesh, POINT, SIDES

READERS = {".inp": abaqus.read, ".e": exodus.read, ".exo": exodus.read, ".ex2": exodus.read, ".g": exodus.read, ".gen": exodus.read, ".unv": unv.read}
MOST_BYTES = 1_000_000_000


def read(name: str) -> Mesh:
    """Raises Fault."""
    path = Path(name)
    try:
        if not path.is_file():
            raise Fault("cannot be read: it is no file")
        if path.stat().st_size > MOST_BYTES:
            raise Fault("cannot be read: it has more than 1 GB")
        reader = READERS.get(path.suffix.lower(), with_meshio.read)
        mesh = reader(name)
    except OSError as error:
        raise Fault(f"cannot be read: {error.strerror or error}") from None
    except MemoryError:
        raise Fault("cannot be read: memory ran out") from None
    if not mesh.n_elements or not len(mesh.points):
        raise Fault("has no elements that a mesh can have")
    if not np.isfinite(mesh.points).all():
        raise Fault("has nodes whose coordinates are no finite numbers")
    return mesh


def write(mesh: Mesh, dimension: int, out: str) -> None:
    """The elements of this dimension, and of one less as far as sets name them."""
    groups = Groups(mesh, dimension)
    numbers = mesh.numbers
    if not len(numbers) or numbers.min() <= 0 or numbers.max() >= 2 ** 31 - 1 or len(np.unique(numbers)) < len(numbers):
        numbers = np.arange(1, len(mesh.points) + 1)
    with open(out, "w", encoding="utf-8", errors="replace") as file:
        file.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n")
        if groups.names:
            file.write(f"$PhysicalNames\n{len(groups.names)}\n")
            for (of, name), number in groups.names.items():
                shown = " ".join(name.replace('"', "'").split())  # names with double quotes could not be written in scenes
                file.write(f'{of} {number} "{shown}"\n')
            file.write("$EndPhysicalNames\n")
        file.write(f"$Nodes\n{len(numbers)}\n")
        for start in range(0, len(numbers), 100_000):
            rows = zip(numbers[start:start + 100_000].tolist(), mesh.points[start:start + 100_000].tolist())
            file.write("".join(f"{number} {x!r} {y!r} {z!r}\n" for number, (x, y, z) in rows))
        lists = _elements(mesh, groups, dimension, numbers)
        file.write(f"$EndNodes\n$Elements\n{sum(len(one) for one in lists)}\n")
        for one in lists:
            for start in range(0, len(one), 100_000):
                file.write("".join(" ".join(map(str, row)) + "\n" for row in one[start:start + 100_000].tolist()))
        file.write("$EndElements\n")


def _elements(mesh: Mesh, groups: Groups, dimension: int, node_numbers) -> list:
    """Lines of elements: number, kind, 2, group, group, nodes. Cells keep their numbers, if they can."""
    kept = [block for block in mesh.blocks if block.shape.dimension == dimension]
    all_numbers = np.concatenate([block.numbers for block in kept]) if kept else np.zeros(0, dtype=np.int64)
    unique = len(np.unique(all_numbers)) == len(all_numbers) and (not len(all_numbers) or 0 < all_numbers.min() <= all_numbers.max() < 2 ** 30)
    last, lists = int(all_numbers.max()) if unique and len(all_numbers) else 0, []
    for block in kept:
        group = groups.cells[id(block)]
        own = block.numbers if unique else np.arange(last + 1, last + 1 + len(group))
        last = last if unique else last + len(group)
        rows = np.empty((len(group), 5 + block.shape.corners), dtype=np.int64)
        rows[:, 0], rows[:, 1], rows[:, 2], rows[:, 3], rows[:, 4] = own, block.shape.gmsh, 2, group, group
        rows[:, 5:] = node_numbers[block.nodes]
        lists.append(rows)
    for shape in SIDES.values():
        sides = [(corners, group) for corners, group in groups.sides if len(corners) == shape.corners]
        if sides and shape.dimension == dimension - 1:
            corners, group = np.array([one[0] for one in sides]), np.array([one[1] for one in sides])
            own = np.arange(last + 1, last + 1 + len(group))
            last += len(group)
            lists.append(np.column_stack([own, np.full(len(own), shape.gmsh), np.full(len(own), 2), group, group, node_numbers[corners]]))
    if groups.points:
        rows, group = (np.array(column) for column in zip(*groups.points))
        own = np.arange(last + 1, last + 1 + len(group))
        lists.append(np.column_stack([own, np.full(len(own), POINT.gmsh), np.full(len(own), 2), group, group, node_numbers[rows]]))
    return lists


def convert(name: str, out: str, dimension: int = 0) -> list:
    """Write the mesh of a file as a Gmsh file of this dimension (0: the highest of its elements). Returns notes on what was made of it. Raises
    Fault."""
    mesh = read(name)
    if dimension and not any(block.shape.dimension == dimension for block in mesh.blocks):
        kinds = sorted({block.shape.name for block in mesh.blocks})
        raise Fault(f"has no elements of dimension {dimension}: it has {', '.join(kinds)}")
    try:
        write(mesh, dimension or mesh.dimension(), out)
    except OSError as error:
        raise Fault(f"cannot be converted: {out} cannot be written: {error.strerror or error}") from None
    if mesh.curved:
        mesh.notes.insert(0, f"of {mesh.curved} elements of higher order the corners are taken, with straight edges between them.")
    return mesh.notes
