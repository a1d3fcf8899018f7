// Quadrilaterals in the plate [0,2] x [0,1], irregular, with a line of faces along y = 1/2 from x = 1/2 to 1.5.
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 2, 0.5};
Rectangle(2) = {0, 0.5, 0, 2, 0.5};
BooleanFragments{ Surface{1}; Delete; }{ Surface{2}; Delete; }
Mesh.MeshSizeMax = 0.12;
Mesh.MeshSizeMin = 0.08;
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
Physical Surface(1) = {1, 2};
