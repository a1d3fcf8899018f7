# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Scenes and meshes that several tests start from."""

from scene_test import scene_text

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
    """A Gmsh file of nodes "x y" and elements "kind 2 side side node ..." without their numbers; names: of sides 1, 2, ..."""
    numbered = lambda lines, end="": "".join(f"{k + 1} {line}{end}\n" for k, line in enumerate(lines))
    named = f"$PhysicalNames\n{len(names)}\n" + "".join(f'1 {k + 1} "{name}"\n' for k, name in enumerate(names)) + "$EndPhysicalNames\n"
    return (f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n{named if names else ''}$Nodes\n{len(nodes)}\n{numbered(nodes, ' 0')}$EndNodes\n"
            f"$Elements\n{len(elements)}\n{numbered(elements)}$EndElements\n")


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
