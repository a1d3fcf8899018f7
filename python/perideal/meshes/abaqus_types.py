# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Element types of Abaqus and CalculiX: which shape each has."""

import re

from .mesh import HEXAHEDRON, LINE, PYRAMID, QUADRILATERAL, TETRAHEDRON, TRIANGLE, WEDGE

_SOLID = re.compile(r"(C3D|DC3D|DCC3D|AC3D|Q3D|COH3D|EC3D|EMC3D|SC|CSS|F3D)(\d+)")
_PLANE = re.compile(r"(CPS|CPE|CPEG|CAX|CGAX|DC2D|DCC2D|DCAX|AC2D|ACAX|Q2D|EMC2D|STRI|S|DS|M3D|R3D|SFM3D|COH2D|WARP2D)(\d+)")
_LINE = re.compile(r"(B2|B3|T2D|T3D|PIPE2|PIPE3|DC1D|R2D|AC1D|F2D)(\d)")
_SOLIDS = {4: TETRAHEDRON, 10: TETRAHEDRON, 5: PYRAMID, 13: PYRAMID, 6: WEDGE, 15: WEDGE, 8: HEXAHEDRON, 20: HEXAHEDRON, 27: HEXAHEDRON}
_PLANES = {3: TRIANGLE, 6: TRIANGLE, 4: QUADRILATERAL, 8: QUADRILATERAL, 9: QUADRILATERAL}
_SHELLS = re.compile(r"(STRI|S|DS|M3D|R3D|SFM3D)\d")
_AXISYMMETRIC = re.compile(r"(CAX|CGAX|DCAX|ACAX)\d")


def shape_of(kind: str):
    """The shape of an element type and its number of nodes, or nothing for what has no shape (springs, masses)."""
    kind = kind.upper()
    if kind.startswith(("F3D3", "F3D4")):  # a face of Abaqus, a tetrahedron of CalculiX
        return None
    if match := _SOLID.match(kind):
        n = int(match[2])
        return (_SOLIDS[n], n) if n in _SOLIDS else None
    if kind.startswith("STRI65"):
        return TRIANGLE, 6
    if match := _PLANE.match(kind):
        n = int(match[2][0])
        return (_PLANES[n], n) if n in _PLANES else None
    if match := _LINE.match(kind):
        n = int(match[2])
        if kind.startswith(("B", "PIPE")):  # B21 has 2 nodes, B22 3, B23 and B33 are cubic on 2
            n = {1: 2, 2: 3, 3: 2}.get(n, 0)
        return (LINE, n) if n in (2, 3) else None
    return None


def is_shell(kind: str) -> bool:
    """Whether sides 1 and 2 are its faces, and those from 3 on its edges."""
    return _SHELLS.match(kind.upper()) is not None


def is_axisymmetric(kind: str) -> bool:
    return _AXISYMMETRIC.match(kind.upper()) is not None
