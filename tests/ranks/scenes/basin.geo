// A basin of two soils with a round notch in its top.
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 2, 0.5};
Rectangle(2) = {0, 0.5, 0, 2, 0.5};
Disk(3) = {0.8, 1.0, 0, 0.3};
BooleanDifference(4) = { Surface{2}; Delete; }{ Surface{3}; Delete; };
BooleanFragments{ Surface{1}; Delete; }{ Surface{4}; Delete; }
Physical Surface("sand") = {1};
Physical Surface("gravel") = {4};
e = 1e-6;
Physical Curve("inlet") = Curve In BoundingBox{-e, -e, -e, e, 1 + e, e};
Physical Curve("outlet") = Curve In BoundingBox{2 - e, -e, -e, 2 + e, 1 + e, e};
Physical Curve("notch") = Curve In BoundingBox{0.5 - e, 0.7 - e, -e, 1.1 + e, 1 + e, e};
