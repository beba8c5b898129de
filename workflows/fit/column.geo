// Two layers of 0.1 m, one on top of the other. Names are those of the scene.
Point(1) = {0, 0, 0};      Point(2) = {0.025, 0, 0};   Point(3) = {0.025, 0.1, 0};
Point(4) = {0.025, 0.2, 0};  Point(5) = {0, 0.2, 0};   Point(6) = {0, 0.1, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 5};  Line(5) = {5, 6};  Line(6) = {6, 1};
Line(7) = {3, 6};
Curve Loop(1) = {3, 4, 5, -7};  Plane Surface(1) = {1};
Curve Loop(2) = {1, 2, 7, 6};   Plane Surface(2) = {2};
Physical Surface("sand") = {1};
Physical Surface("silt") = {2};
Physical Curve("top") = {4};
Physical Curve("bottom") = {1};
