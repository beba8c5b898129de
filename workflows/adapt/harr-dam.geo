// A layer 1 m deep, 13 m long; a dam with a flat impervious base of 1 m on it. h: size of the elements; g: the part of it
// at the corners of the base, where the flux has no bound.
h = 0.4;
g = 1;
Point(1) = {-6.5, -1, 0, h}; Point(2) = {6.5, -1, 0, h}; Point(3) = {6.5, 0, 0, h};
Point(4) = {0.5, 0, 0, h * g}; Point(5) = {-0.5, 0, 0, h * g}; Point(6) = {-6.5, 0, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 1};
Curve Loop(1) = {1:6}; Plane Surface(1) = {1};
Physical Surface("ground") = {1};
Physical Curve("upstream") = {5}; Physical Curve("downstream") = {3};
