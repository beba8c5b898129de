// Soil of 1 m in front of a tank of 4 m: most ranks have no solid points.
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 1, 1};
Rectangle(2) = {1, 0, 0, 4, 1};
BooleanFragments{ Surface{1}; Delete; }{ Surface{2}; Delete; }
Physical Surface("sand") = {1};
Physical Surface("tank") = {2};
e = 1e-6;
Physical Curve("inlet") = Curve In BoundingBox{-e, -e, -e, e, 1 + e, e};
Physical Curve("outlet") = Curve In BoundingBox{5 - e, -e, -e, 5 + e, 1 + e, e};
