// A plan: a river on the left, the hinterland on the right, a well, which is a line 1 m long. h: size of the elements;
// g: the part of it at the well.
h = 8;
g = 1;
Point(1) = {0, 0, 0, h}; Point(2) = {80, 0, 0, h}; Point(3) = {80, 60, 0, h}; Point(4) = {0, 60, 0, h};
Point(5) = {30, 29.5, 0, h * g}; Point(6) = {30, 30, 0, h * g}; Point(7) = {30, 30.5, 0, h * g};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Line(5) = {5, 6}; Line(6) = {6, 7};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Curve{5, 6} In Surface{1};
Physical Surface("aquifer") = {1};
Physical Curve("river") = {4}; Physical Curve("hinterland") = {2}; Physical Curve("well") = {5, 6};
