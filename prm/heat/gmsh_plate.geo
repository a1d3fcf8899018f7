// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Quarter of a ring in unstructured quadrilaterals.
//   gmsh -2 -format msh22 gmsh_plate.geo
// Boundary ids: 1 inner arc, 2 outer arc, 3 the two straight edges.

h = 0.05;
Mesh.Algorithm = 6;                    // frontal Delaunay
Mesh.RecombinationAlgorithm = 3;       // blossom, quadrilaterals only

Point(1) = {0, 0, 0, h};
Point(2) = {1, 0, 0, h};
Point(3) = {2, 0, 0, h};
Point(4) = {0, 2, 0, h};
Point(5) = {0, 1, 0, h};
Line(1) = {2, 3};
Circle(2) = {3, 1, 4};
Line(3) = {4, 5};
Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Recombine Surface{1};

Physical Curve(1) = {4};
Physical Curve(2) = {2};
Physical Curve(3) = {1, 3};
Physical Surface(1) = {1};
