// A quarter of the soil around a well: radii 0.2 m and 1 m, 0.3 m high.
Point(1) = {0, 0, 0};
Point(2) = {0.2, 0, 0};
Point(3) = {1, 0, 0};
Point(4) = {0, 1, 0};
Point(5) = {0, 0.2, 0};
Line(1) = {2, 3};
Circle(2) = {3, 1, 4};
Line(3) = {4, 5};
Circle(4) = {5, 1, 2};
Curve Loop(1) = {1:4};
Plane Surface(1) = {1};
made[] = Extrude {0, 0, 0.3} { Surface{1}; };
Physical Volume("specimen") = {made[1]};
Physical Surface("outside") = {made[3]};
Physical Surface("inside") = {made[5]};
