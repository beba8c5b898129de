// An outline that crosses itself: a corner is on the wrong side.
Point(1) = {0, 0, 0};
Point(2) = {2, 0, 0};
Point(3) = {0, 1, 0};
Point(4) = {2, 1, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Physical Surface("specimen") = {1};
