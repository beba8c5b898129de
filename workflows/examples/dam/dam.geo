// A zoned dam 20 m high on impervious rock: shells, a core, a toe drain. Metres; z = 0 is the rock.
Point(1) = {0, 0, 0};      Point(2) = {42, 0, 0};     Point(3) = {54, 0, 0};    Point(4) = {88, 0, 0};
Point(5) = {96, 0, 0};     Point(6) = {92, 2, 0};     Point(8) = {44, 20, 0};
Point(9) = {46.5, 20, 0};  Point(10) = {49.5, 20, 0}; Point(11) = {82, 2, 0};   Point(12) = {56, 20, 0};
Line(1) = {1, 2};   Line(2) = {2, 9};    Line(3) = {9, 8};   Line(4) = {8, 1};
Line(5) = {2, 3};   Line(6) = {3, 10};   Line(7) = {10, 9};
Line(8) = {3, 4};   Line(9) = {4, 11};   Line(10) = {11, 6}; Line(11) = {6, 12};  Line(12) = {12, 10};
Line(13) = {4, 5};  Line(14) = {5, 6};
Curve Loop(1) = {1, 2, 3, 4};              Plane Surface(1) = {1};
Curve Loop(2) = {5, 6, 7, -2};             Plane Surface(2) = {2};
Curve Loop(3) = {8, 9, 10, 11, 12, -6};    Plane Surface(3) = {3};
Curve Loop(4) = {13, 14, -10, -9};         Plane Surface(4) = {4};
Physical Surface("upstream_shell") = {1};
Physical Surface("core") = {2};
Physical Surface("downstream_shell") = {3};
Physical Surface("drain") = {4};
Physical Curve("reservoir") = {4};
Physical Curve("crest") = {3, 7, 12};
Physical Curve("downstream") = {11, 14};
