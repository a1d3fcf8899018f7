# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""All that meshio reads: VTK, VTU, XDMF, MED and others. Whole numbers of cells, and sets, are regions and sides."""

import contextlib
import io
import re
from pathlib import Path

import numpy as np

from .mesh import Block, Fault, HEXAHEDRON, LINE, Mesh, POINT, PYRAMID, QUADRILATERAL, TETRAHEDRON, TRIANGLE, WEDGE

_KIND = re.compile(r"([a-z]+)\d*")
_SHAPES = dict((("vertex", POINT), ("line", LINE), ("triangle", TRIANGLE), ("quad", QUADRILATERAL), ("tetra", TETRAHEDRON), ("pyramid", PYRAMID), ("wedge", WEDGE),
                ("hexahedron", HEXAHEDRON)))
_WORDS = ("physical", "region", "material", "group", "block", "phase", "tag", "label", "marker", "ref", "domain", "zone", "part", "entityid", "id")
_NO_REGIONS = ("partition", "rank", "proc", "original", "global")  # numbers of processes, and of cells
_FEW_CELLS = 20  # of which each may be a region of its own
_MOST_GROUPS = 1000
FORMATS = "Gmsh (.msh), Abaqus and CalculiX (.inp), Exodus (.e, .exo, .g), UNV (.unv) and, with meshio, VTK (.vtk, .vtu), XDMF (.xdmf) and others"


def read(name: str) -> Mesh:
    """Raises Fault."""
    if not Path(name).suffix:
        raise Fault(f"has no ending that tells its format; known are {FORMATS}")
    try:
        import meshio
    except ImportError:
        raise Fault(f"(format {Path(name).suffix}) needs the Python package meshio, which was not found (Debian: python3-meshio): install it, or save the mesh as .msh, "
                    ".inp, .e or .unv, which are read without it") from None
    if Path(name).suffix.lower() not in meshio.extension_to_filetypes:
        raise Fault(f"has an ending of no format that is known; known are {FORMATS}")
    said = io.StringIO()
    try:
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            given = meshio.read(name)
    except (SystemExit, Exception) as error:
        why = " ".join((str(error) if not isinstance(error, SystemExit) and str(error) else said.getvalue()).split())[:200]
        raise Fault(f"cannot be read by meshio: {why.rstrip('.') or type(error).__name__}") from None
    return _taken(given)


def _taken(given) -> Mesh:
    points = np.asarray(given.points, dtype=float)
    mesh = Mesh(points=np.zeros((len(points), 3)), numbers=np.arange(1, len(points) + 1))
    mesh.points[:, :points.shape[1]] = points[:, :3]
    ids, tags, kept, first = None, getattr(given, "cell_tags", None) or {}, {}, 0
    if not tags:
        what, ids = _group_numbers(given)
        if ids is not None:
            mesh.notes.append(f"regions and sides are those of the numbers '{what}'; 0 is none.")
    for k, block in enumerate(given.cells):
        match = _KIND.fullmatch(block.type)
        shape = _SHAPES.get(match[1]) if match else None
        nodes = np.asarray(block.data)
        if shape is None or not len(nodes) or nodes.ndim != 2:
            if shape is None:
                mesh.notes.append(f"{len(nodes)} elements of type {block.type} are left out.")
            continue
        if nodes.min() < 0 or nodes.max() >= len(points):
            raise Fault("is damaged: an element has a node that is not there")
        rows = np.arange(first, first + len(nodes))
        kept[k] = rows
        mesh.blocks.append(Block(shape, rows + 1, nodes[:, :shape.corners].astype(np.int64)))
        mesh.curved += len(nodes) if nodes.shape[1] > shape.corners else 0
        if ids is not None:
            for number in np.unique(ids[k]):
                if number != 0:
                    label = str(int(number))
                    known = mesh.element_sets.get(label, np.zeros(0, dtype=np.int64))
                    mesh.element_sets[label] = np.concatenate([known, rows[np.asarray(ids[k]) == number]])
        for number, names in tags.items():  # of MED: families, each in several groups
            family = rows[np.asarray(given.cell_data["cell_tags"][k]).ravel() == number]
            for name in names if len(family) else ():
                mesh.element_sets[str(name)] = np.union1d(mesh.element_sets.get(str(name), np.zeros(0, dtype=np.int64)), family)
        first += len(nodes)
    for number, names in (getattr(given, "point_tags", None) or {}).items():
        family = np.flatnonzero(np.asarray(given.point_data["point_tags"]).ravel() == number)
        for name in names if len(family) else ():
            mesh.node_sets[str(name)] = np.union1d(mesh.node_sets.get(str(name), np.zeros(0, dtype=np.int64)), family)
    for name, nodes in (getattr(given, "point_sets", None) or {}).items():
        mesh.node_sets[str(name)] = np.asarray(nodes, dtype=np.int64)
    for name, pieces in (getattr(given, "cell_sets", None) or {}).items():
        rows = [kept[k][np.asarray(piece, dtype=np.int64)] for k, piece in enumerate(pieces) if k in kept and piece is not None and len(piece)]
        if rows and not str(name).startswith("gmsh:"):
            mesh.element_sets[str(name)] = np.concatenate(rows)
    return mesh


def _group_numbers(given):
    """The array of whole numbers whose name says most that it is one of regions, and its name."""
    best = None
    for name, arrays in (given.cell_data or {}).items():
        flat = [np.asarray(array) for array in arrays]
        flat = [array[:, 0] if array.ndim == 2 and array.shape[1] == 1 else array for array in flat]
        whole = all(array.ndim == 1 and np.all(np.isfinite(array)) and np.all(array == np.round(array)) for array in flat)
        rank = next((k for k, word in enumerate(_WORDS) if word in name.lower()), None)
        if not whole or rank is None or any(word in name.lower() for word in _NO_REGIONS):
            continue
        numbers = np.concatenate(flat)
        n = len(np.unique(numbers))
        if n <= _MOST_GROUPS and (n < len(numbers) or n <= _FEW_CELLS) and (best is None or rank < best[0]):
            best = (rank, name, flat)
    return (best[1], best[2]) if best else (None, None)
