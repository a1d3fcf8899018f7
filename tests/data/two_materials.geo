// Quadrilaterals in the plate [0,2] x [0,1], irregular; material 7 below y = 1/2 and 9 above, between them a line of faces.
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 2, 0.5};
Rectangle(2) = {0, 0.5, 0, 2, 0.5};
BooleanFragments{ Surface{1}; Delete; }{ Surface{2}; Delete; }
Mesh.MeshSizeMax = 0.4;
Mesh.MeshSizeMin = 0.2666666666666667;
Mesh.RecombineAll = 1;
Mesh.SubdivisionAlgorithm = 1;
left() = Curve In BoundingBox{-0.01, -0.01, -1, 0.01, 1.01, 1};
right() = Curve In BoundingBox{1.99, -0.01, -1, 2.01, 1.01, 1};
bottom() = Curve In BoundingBox{-0.01, -0.01, -1, 2.01, 0.01, 1};
top() = Curve In BoundingBox{-0.01, 0.99, -1, 2.01, 1.01, 1};
Physical Curve(1) = {left()};
Physical Curve(2) = {right()};
Physical Curve(3) = {bottom()};
Physical Curve(4) = {top()};
Physical Surface(7) = {1};
Physical Surface(9) = {2};
