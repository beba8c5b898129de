// A plan: a river on a part of the left side, the hinterland on the right, and a trench of 4 m that is pumped. h: size of
// the elements; g: the part of it at the ends of the trench and of the river.
h = 12;
g = 1;
Point(1) = {0, 0, 0, h}; Point(2) = {80, 0, 0, h}; Point(3) = {80, 60, 0, h}; Point(4) = {0, 60, 0, h};
Point(5) = {0, 45, 0, h * g}; Point(6) = {0, 15, 0, h * g};
Point(7) = {30, 28, 0, h * g}; Point(8) = {30, 30, 0, h * g}; Point(9) = {30, 32, 0, h * g};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 1};
Line(7) = {7, 8}; Line(8) = {8, 9};
Curve Loop(1) = {1:6}; Plane Surface(1) = {1};
Curve{7, 8} In Surface{1};
Physical Surface("aquifer") = {1};
Physical Curve("river") = {5}; Physical Curve("hinterland") = {2}; Physical Curve("well") = {7, 8};
