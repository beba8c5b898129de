// A drain under a pond: a polygon of sixteen sides with a radius of 0.15 m, so that every mesh has the same geometry.
// h: size of the elements; g: the part of it at the drain.
h = 0.9;
g = 1;
Point(1) = {-10, -4, 0, h}; Point(2) = {10, -4, 0, h}; Point(3) = {10, 2, 0, h}; Point(4) = {-10, 2, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
For i In {0:15}
  Point(10 + i) = {0.15 * Cos(i * Pi / 8), -0.5 + 0.15 * Sin(i * Pi / 8), 0, h * g};
EndFor
For i In {0:14}
  Line(10 + i) = {10 + i, 11 + i};
EndFor
Line(25) = {25, 10};
Curve Loop(1) = {1:4}; Curve Loop(2) = {10:25};
Plane Surface(1) = {1, 2};
Physical Surface("ground") = {1};
Physical Curve("pond") = {3}; Physical Curve("drain") = {10:25};
