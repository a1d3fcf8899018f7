# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Meshes of other programs as Gmsh files: `python3 -m perideal.meshes FILE OUT.msh`, which `Mesh file = part.inp` does by itself (doc/mesh_files.md)."""

from .convert import convert
from .mesh import Fault, Mesh

__all__ = ["Fault", "Mesh", "convert"]
