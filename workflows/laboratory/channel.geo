// A plane specimen, 0.4 m by 0.24 m, with a spot at the outlet whose fines are gone. Water flows to the right.
Point(1) = {0, 0, 0};       Point(2) = {0.4, 0, 0};     Point(3) = {0.4, 0.1, 0};   Point(4) = {0.36, 0.1, 0};
Point(5) = {0.36, 0.14, 0}; Point(6) = {0.4, 0.14, 0};  Point(7) = {0.4, 0.24, 0};  Point(8) = {0, 0.24, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 5};  Line(5) = {5, 6};
Line(6) = {6, 7};  Line(7) = {7, 8};  Line(8) = {8, 1};  Line(9) = {3, 6};
Curve Loop(1) = {1, 2, 3, 4, 5, 6, 7, 8};  Plane Surface(1) = {1};
Curve Loop(2) = {9, -5, -4, -3};           Plane Surface(2) = {2};
Physical Surface("specimen") = {1};
Physical Surface("spot") = {2};
Physical Curve("inlet") = {8};
Physical Curve("outlet") = {2, 9, 6};
