// Ground below the floors of two weirs, with a drain between them.
Point(1) = {0, 0, 0}; Point(2) = {30, 0, 0}; Point(3) = {30, 6, 0}; Point(4) = {22, 6, 0}; Point(5) = {18, 6, 0};
Point(6) = {12, 6, 0}; Point(7) = {8, 6, 0}; Point(8) = {0, 6, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 7};
Line(7) = {7, 8}; Line(8) = {8, 1};
Curve Loop(1) = {1:8}; Plane Surface(1) = {1};
Physical Surface("sand") = {1};
Physical Curve("canal") = {7}; Physical Curve("drain") = {5}; Physical Curve("river") = {3};
