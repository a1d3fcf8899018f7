SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 1, 1};
Mesh.MeshSizeMin = 0.5;
Physical Surface(1) = {1};
