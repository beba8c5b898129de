// A quarter of a flooded disc with a radius of 1 m on a box: a polygon of 24 sides, six of which are here, so that every
// mesh has the same geometry. h: size of the elements; g: the part of it at the edge of the disc.
h = 0.8;
g = 1;
SetFactory("OpenCASCADE");
Box(1) = {0, 0, -3, 3, 3, 3};
Point(100) = {0, 0, 0, h};
For i In {0:6}
  Point(101 + i) = {Cos(i * Pi / 12), Sin(i * Pi / 12), 0, h};
EndFor
For i In {0:6}
  Line(100 + i) = {100 + i, 101 + i};
EndFor
Line(107) = {107, 100};
Curve Loop(100) = {100:107}; Plane Surface(100) = {100};
BooleanFragments{ Volume{1}; Delete; }{ Surface{100}; Delete; }
MeshSize{ PointsOf{ Volume{:}; } } = h;
rim() = {};
For i In {0:6}
  rim() += Point In BoundingBox{Cos(i * Pi / 12) - 1e-3, Sin(i * Pi / 12) - 1e-3, -1e-3, Cos(i * Pi / 12) + 1e-3, Sin(i * Pi / 12) + 1e-3, 1e-3};
EndFor
MeshSize{ rim() } = h * g;
Physical Volume("ground") = {1};
Physical Surface("disc") = Surface In BoundingBox{-1e-3, -1e-3, -1e-3, 1.001, 1.001, 1e-3};
Physical Surface("bottom") = Surface In BoundingBox{-1e-3, -1e-3, -3.001, 3.001, 3.001, -2.999};
Physical Surface("right") = Surface In BoundingBox{2.999, -1e-3, -3.001, 3.001, 3.001, 1e-3};
Physical Surface("back") = Surface In BoundingBox{-1e-3, 2.999, -3.001, 3.001, 3.001, 1e-3};
