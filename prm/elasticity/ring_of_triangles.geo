// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// A quarter of a thick ring in triangles: gmsh -2 -format msh22 ring_of_triangles.geo
h = 0.1;
Point(1) = {0, 0, 0, h};
Point(2) = {0.5, 0, 0, h};
Point(3) = {1, 0, 0, h};
Point(4) = {0, 1, 0, h};
Point(5) = {0, 0.5, 0, h};
Line(1) = {2, 3};
Circle(2) = {3, 1, 4};
Line(3) = {4, 5};
Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Physical Curve("plane y = 0") = {1};
Physical Curve("rim") = {2};
Physical Curve("plane x = 0") = {3};
Physical Curve("bore") = {4};
Physical Surface("steel") = {1};
