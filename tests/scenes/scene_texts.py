# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Scenes and meshes that several tests start from."""

# A strip of width 1 that is pulled along y, for cracks from its sides.
PULLED_STRIP = """
set Dimension = 2
set Physics = elasticity
subsection Domain
  set Lower corner = 0, -1.5
  set Upper corner = 1, 1.5
end
subsection Material
  set Young modulus = 200
  set Poisson ratio = 0.3
end
subsection Boundary conditions
  set Traction = top: 0, 1 ; bottom: 0, -1
end
"""

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
