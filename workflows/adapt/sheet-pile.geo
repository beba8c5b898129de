// A layer 1 m deep, 12 m long; a sheet pile of half its depth. h: size of the elements; g: the part of it at the foot of
// the pile.
h = 0.4;
g = 1;
Point(1) = {-6, -1, 0, h}; Point(2) = {6, -1, 0, h}; Point(3) = {6, 0, 0, h};
Point(4) = {0, 0, 0, h}; Point(5) = {-6, 0, 0, h}; Point(6) = {0, -0.5, 0, h * g};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 1}; Line(6) = {4, 6};
Curve Loop(1) = {1:5}; Plane Surface(1) = {1};
Curve{6} In Surface{1};
Physical Surface("ground") = {1};
Physical Curve("upstream") = {4}; Physical Curve("downstream") = {3}; Physical Curve("pile") = {6};
