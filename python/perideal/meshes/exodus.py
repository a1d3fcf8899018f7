# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Exodus files (.e, .exo, .g): blocks are regions, side sets and node sets sides."""

import numpy as np

from .mesh import Block, Fault, HEXAHEDRON, LINE, Mesh, PYRAMID, QUADRILATERAL, TETRAHEDRON, TRIANGLE, WEDGE, text_of
from .netcdf import variables

_SHAPES = (("HEX", HEXAHEDRON), ("TET", TETRAHEDRON), ("WEDGE", WEDGE), ("PYR", PYRAMID), ("TRI", TRIANGLE), ("QUAD", QUADRILATERAL), ("SHELL", QUADRILATERAL),
           ("SHEL", QUADRILATERAL), ("BAR", LINE), ("BEAM", LINE), ("TRUSS", LINE), ("EDGE", LINE), ("LINE", LINE))
_POINTS = ("SPHERE", "CIRCLE", "NODE", "POINT")


def read(name: str) -> Mesh:
    """Raises Fault."""
    found = variables(name)
    mesh = Mesh()
    try:
        _read(found, mesh)
    except (ValueError, IndexError, KeyError, TypeError) as error:
        raise Fault(f"is damaged: {error}") from None
    return mesh


def _read(found: dict, mesh: Mesh) -> None:
    columns = [found[key] for key in ("coordx", "coordy", "coordz") if key in found]
    if not columns and "coord" in found:
        columns = list(found["coord"])
    if not columns:
        raise Fault("has no coordinates of nodes, as Exodus files have")
    mesh.points = np.zeros((len(columns[0]), 3))
    for d, column in enumerate(columns[:3]):
        mesh.points[:, d] = column
    n = len(mesh.points)
    numbers = np.asarray(found.get("node_num_map", np.arange(1, n + 1)), dtype=np.int64)
    mesh.numbers = numbers if len(np.unique(numbers)) == n else np.arange(1, n + 1)
    kept = _take_blocks(found, mesh, n, len(columns))
    for k, set_name in _numbered(found, "elem_ss", "ss_names", "ss_prop1", "sideset", mesh.ids, False):
        rows = kept[_rows(found[f"elem_ss{k}"], len(kept), set_name)]
        sides = np.asarray(found[f"side_ss{k}"])
        if len(sides) != len(rows):
            raise Fault(f"is damaged: '{set_name}' has {len(rows)} elements and {len(sides)} sides")
        mesh.add_faces(set_name, rows[rows >= 0], sides[rows >= 0], "exodus")
    for k, set_name in _numbered(found, "node_ns", "ns_names", "ns_prop1", "nodeset", mesh.ids, False):
        mesh.node_sets[set_name] = np.union1d(mesh.node_sets.get(set_name, np.zeros(0, dtype=np.int64)), _rows(found[f"node_ns{k}"], n, set_name))


def _is_shell(kind: str, n_dimensions: int) -> bool:
    """Whether sides 1 and 2 are its faces: of shells, and of triangles in space."""
    return kind.startswith(("SHEL", "TRISH")) or (kind.startswith("TRI") and n_dimensions == 3)


def _take_blocks(found: dict, mesh: Mesh, n: int, n_dimensions: int) -> np.ndarray:
    """Rows of all elements of the file, -1 of those that are left out."""
    first, kept = 0, []
    element_numbers = found.get("elem_num_map")
    for k, block_name in _numbered(found, "connect", "eb_names", "eb_prop1", "block", mesh.ids, True):
        nodes = np.asarray(found[f"connect{k}"], dtype=np.int64)
        kind = found.get(f"connect{k}:elem_type", "").strip().upper()
        shape = next((one for begin, one in _SHAPES if kind.startswith(begin)), None)
        if shape is TRIANGLE or shape is QUADRILATERAL:
            shape = TRIANGLE if nodes.ndim == 2 and nodes.shape[1] in (3, 6, 7) else QUADRILATERAL
            shape = LINE if kind.startswith("SHEL") and nodes.ndim == 2 and nodes.shape[1] == 2 else shape
        if kind.startswith(_POINTS) and nodes.ndim == 2:
            mesh.notes.append(f"{len(nodes)} elements of type {kind} in '{block_name}' are left out, which are points.")
            kept.append(np.full(len(nodes), -1))
            first += len(nodes)
            continue
        if shape is None or nodes.ndim != 2 or nodes.shape[1] < shape.corners:
            raise Fault(f"has elements of type '{kind or '?'}' in '{block_name}', which are not read")
        if nodes.size and not (1 <= nodes.min() and nodes.max() <= n):
            raise Fault(f"is damaged: '{block_name}' has nodes that are not there")
        if nodes.shape[1] > shape.corners:
            mesh.curved += len(nodes)
        rows = np.arange(mesh.n_elements, mesh.n_elements + len(nodes))
        known = element_numbers is not None and len(element_numbers) >= first + len(rows)
        numbers = np.asarray(element_numbers, dtype=np.int64)[first:first + len(rows)] if known else first + 1 + np.arange(len(rows))
        mesh.blocks.append(Block(shape, numbers, nodes[:, :shape.corners] - 1, _is_shell(kind, n_dimensions)))
        mesh.element_sets[block_name] = np.union1d(mesh.element_sets.get(block_name, np.zeros(0, dtype=np.int64)), rows)
        kept.append(rows)
        first += len(nodes)
    if not mesh.blocks and kept:
        raise Fault("has points alone (elements of type SPHERE or alike): give the mesh that these points are of")
    return np.concatenate(kept) if kept else np.zeros(0, dtype=np.int64)


def _rows(numbers, n: int, name: str) -> np.ndarray:
    rows = np.asarray(numbers, dtype=np.int64) - 1
    if rows.size and not (0 <= rows.min() and rows.max() < n):
        raise Fault(f"is damaged: '{name}' has members that are not there")
    return rows


def _numbered(found: dict, begin: str, names: str, numbers: str, otherwise: str, file_ids: dict, of_elements: bool):
    """Numbers from 1 of the variables that begin so, with the name of each; without one "block_7", with the number that the file gives, which
    goes to @p file_ids."""
    named, result, k = found.get(names), [], 1
    ids = found.get(numbers, np.zeros(0))
    while f"{begin}{k}" in found or (k <= len(ids) and len(ids) < 100_000):
        if f"{begin}{k}" in found:
            text = text_of(b"".join(named[k - 1]).split(b"\0")[0]).strip() if named is not None and k <= len(named) else ""
            number = int(ids[k - 1]) if k <= len(ids) else k
            result.append((k, text or f"{otherwise}_{number}"))
            if 0 < number < 2 ** 30:
                file_ids.setdefault((of_elements, result[-1][1]), number)
        k += 1
    return result
