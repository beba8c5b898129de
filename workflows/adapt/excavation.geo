// A quarter of an excavation of 6 m by 8 m, 3 m deep, within walls that reach 2 m below its floor. h: size of the
// elements; g: the part of it at the feet of the walls.
h = 2.5;
g = 1;
SetFactory("OpenCASCADE");
Box(1) = {0, 0, -9, 12, 12, 9};
Box(2) = {0, 0, -3, 3, 4, 3};
BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Point(101) = {3, 0, -3}; Point(102) = {3, 4, -3}; Point(103) = {0, 4, -3};
Point(104) = {3, 0, -5}; Point(105) = {3, 4, -5}; Point(106) = {0, 4, -5};
Line(101) = {101, 102}; Line(102) = {102, 105}; Line(103) = {105, 104}; Line(104) = {104, 101};
Line(105) = {102, 103}; Line(106) = {103, 106}; Line(107) = {106, 105};
Curve Loop(101) = {101:104}; Plane Surface(101) = {101};
Curve Loop(102) = {105, 106, 107, -102}; Plane Surface(102) = {102};
BooleanFragments{ Volume{3}; Delete; }{ Surface{101, 102}; Delete; }
MeshSize{ PointsOf{ Volume{:}; } } = h;
foot() = Point In BoundingBox{-1e-3, -1e-3, -5.001, 3.001, 4.001, -4.999};
MeshSize{ foot() } = h * g;
Physical Volume("ground") = Volume{:};
Physical Surface("surface") = Surface In BoundingBox{-1e-3, -1e-3, -1e-3, 12.001, 12.001, 1e-3};
Physical Surface("floor") = Surface In BoundingBox{-1e-3, -1e-3, -3.001, 3.001, 4.001, -2.999};
walls() = Surface In BoundingBox{2.999, -1e-3, -5.001, 3.001, 4.001, -2.999};
walls() += Surface In BoundingBox{-1e-3, 3.999, -5.001, 3.001, 4.001, -2.999};
Physical Surface("walls") = walls();
