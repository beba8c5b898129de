// A levee 5 m high with slopes of 1 : 2.5 on a cover of 1.5 m over 4.5 m of sand. Metres; z = 0 is the
// ground. The waterside is on the left.
Point(1) = {-25, -6, 0};   Point(2) = {44, -6, 0};
Point(3) = {-25, -1.5, 0}; Point(4) = {44, -1.5, 0};
Point(5) = {-25, 0, 0};    Point(6) = {0, 0, 0};
Point(7) = {12.5, 5, 0};   Point(8) = {16.5, 5, 0};
Point(9) = {29, 0, 0};     Point(10) = {44, 0, 0};
Line(1) = {1, 2};  Line(2) = {2, 4};   Line(3) = {4, 3};   Line(4) = {3, 1};
Line(5) = {4, 10}; Line(6) = {10, 9};  Line(7) = {9, 6};   Line(8) = {6, 5};
Line(9) = {5, 3};  Line(10) = {9, 8};  Line(11) = {8, 7};  Line(12) = {7, 6};
Curve Loop(1) = {1, 2, 3, 4};            Plane Surface(1) = {1};
Curve Loop(2) = {-3, 5, 6, 7, 8, 9};     Plane Surface(2) = {2};
Curve Loop(3) = {-7, 10, 11, 12};        Plane Surface(3) = {3};
Physical Surface("sand") = {1};
Physical Surface("cover") = {2};
Physical Surface("levee") = {3};
Physical Curve("waterside") = {8, 12};   // foreland and slope
Physical Curve("crest") = {11};
Physical Curve("landside") = {10, 6};    // slope and hinterland
Physical Curve("inland") = {2};          // the sand goes on
