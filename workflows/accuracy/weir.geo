// The weir of examples/weir. Its soil has the name of all scenes of this study, whose settings study.py gives by that name.
Point(1) = {0, 0, 0};  Point(2) = {3, 0, 0};  Point(3) = {3, 1, 0};
Point(4) = {2, 1, 0};  Point(5) = {1, 1, 0};  Point(6) = {0, 1, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};
Line(4) = {4, 5};  Line(5) = {5, 6};  Line(6) = {6, 1};
Curve Loop(1) = {1, 2, 3, 4, 5, 6};
Plane Surface(1) = {1};
Physical Surface("specimen") = {1};
Physical Curve("downstream") = {3};
Physical Curve("upstream") = {5};
