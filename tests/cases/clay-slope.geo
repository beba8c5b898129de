Point(1) = {0, 0, 0}; Point(2) = {16, 8, 0}; Point(3) = {20, 8, 0}; Point(4) = {36, 0, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1 ... 4}; Plane Surface(1) = {1};
Physical Surface("fill") = {1};
Physical Curve("water") = {1}; Physical Curve("crest") = {2}; Physical Curve("land") = {3}; Physical Curve("base") = {4};
