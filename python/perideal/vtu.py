# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""The .vtu files that PeriDeal writes: pieces with arrays in base64, compressed by zlib."""

import base64
import zlib
from xml.etree import ElementTree

import numpy as np

TYPES = {"Float32": "<f4", "Float64": "<f8", "Int32": "<i4", "Int64": "<i8", "UInt8": "u1", "UInt32": "<u4", "UInt64": "<u8"}


def _array(element) -> np.ndarray:
    """The values of a DataArray, (N) or (N x components)."""
    kind = np.dtype(TYPES[element.get("type")])
    text = "".join((element.text or "").split())
    if element.get("format") == "ascii":
        values = np.array((element.text or "").split(), dtype=float).astype(kind)
    else:
        # blocks, their size, that of the last one, then the compressed size of each
        n_blocks = int(np.frombuffer(base64.b64decode(text[:8])[:4], "<u4")[0])
        n_letters = 4 * -(-4 * (3 + n_blocks) // 3)
        sizes = np.frombuffer(base64.b64decode(text[:n_letters]), "<u4", 3 + n_blocks)[3:]
        data, raw, begin = base64.b64decode(text[n_letters:]), b"", 0
        for size in map(int, sizes):
            raw += zlib.decompress(data[begin:begin + size])
            begin += size
        values = np.frombuffer(raw, kind)
    components = int(element.get("NumberOfComponents", 1))
    return values if components == 1 else values.reshape(-1, components)


def read_vtu(path) -> dict:
    """All arrays of a file, those of its pieces one behind the other: "nodes" (N x 3), "cells" (cells x vertices, numbered around each as VTK
    has them), and the fields by their names."""
    parts, n_points = {}, 0
    for piece in ElementTree.parse(path).getroot().iter("Piece"):
        nodes = _array(piece.find("Points/DataArray"))
        if not len(nodes):
            continue
        cells = {element.get("Name"): _array(element) for element in piece.find("Cells")}
        n_vertices = int(cells["offsets"][0])
        parts.setdefault("nodes", []).append(nodes)
        parts.setdefault("cells", []).append(cells["connectivity"].reshape(-1, n_vertices) + n_points)
        for element in piece.iterfind("PointData/DataArray"):
            parts.setdefault(element.get("Name"), []).append(_array(element))
        n_points += len(nodes)
    return {name: np.concatenate(arrays) for name, arrays in parts.items()}
