// A weir, 6 m long and 1 m deep in the ground. h: size of the elements; g: the part of it at its corners.
h = 1.2;
g = 1;
Point(1) = {0, -7, 0, h}; Point(2) = {26, -7, 0, h}; Point(3) = {26, 0, 0, h}; Point(4) = {16, 0, 0, h};
Point(5) = {16, -1, 0, h * g}; Point(6) = {10, -1, 0, h * g}; Point(7) = {10, 0, 0, h}; Point(8) = {0, 0, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 7}; Line(7) = {7, 8};
Line(8) = {8, 1};
Curve Loop(1) = {1:8}; Plane Surface(1) = {1};
Physical Surface("ground") = {1};
Physical Curve("upstream") = {7}; Physical Curve("downstream") = {3};
