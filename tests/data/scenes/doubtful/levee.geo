// A levee 4 m high with slopes of 1:2.
Point(1) = {0, 0, 0};
Point(2) = {18, 0, 0};
Point(3) = {10, 4, 0};
Point(4) = {8, 4, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Physical Surface("fill") = {1};
Physical Curve("landside") = {2};
Physical Curve("waterside") = {4};
