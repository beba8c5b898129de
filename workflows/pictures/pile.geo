// Soil 24 m wide and 6 m deep under a river bed, with a sheet pile of half its depth. Small elements
// at the foot of the pile.
h = 0.4;
Point(1) = {-12, -6, 0, h};
Point(2) = {12, -6, 0, h};
Point(3) = {12, 0, 0, h};
Point(4) = {0, 0, 0, h / 2};
Point(5) = {-12, 0, 0, h};
Point(6) = {0, -3, 0, h / 8};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 1};
Line(6) = {4, 6};
Curve Loop(1) = {1, 2, 3, 4, 5};
Plane Surface(1) = {1};
Curve{6} In Surface{1};
Physical Surface("sand") = {1};
Physical Curve("downstream") = {3};
Physical Curve("upstream") = {4};
Physical Curve("pile") = {6};
