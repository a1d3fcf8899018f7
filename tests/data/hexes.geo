// Hexahedra in a brick [0,1] x [0,1] x [0,0.6], extruded from irregular quadrilaterals.
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 1, 1};
Mesh.MeshSizeMax = 0.35;
Mesh.MeshSizeMin = 0.3;
Mesh.RecombineAll = 1;
Mesh.SubdivisionAlgorithm = 1;
Extrude {0, 0, 0.6} { Surface{1}; Layers{3}; Recombine; }
bottom() = Surface In BoundingBox{-0.01, -0.01, -0.01, 1.01, 1.01, 0.01};
top() = Surface In BoundingBox{-0.01, -0.01, 0.59, 1.01, 1.01, 0.61};
Physical Surface(5) = {bottom()};
Physical Surface(6) = {top()};
Physical Volume(1) = {1};
