// A sheet pile above a lens of clay. h: size of the elements; g: the part of it at the foot of the pile; its square
// root is the part at the corners of the lens.
h = 0.8;
g = 1;
Point(1) = {0, 0, 0, h}; Point(2) = {12, 0, 0, h}; Point(3) = {12, 4, 0, h}; Point(4) = {6, 4, 0, h};
Point(5) = {0, 4, 0, h}; Point(6) = {6, 2.5, 0, h * g};
Point(7) = {4, 1.5, 0, h * Sqrt(g)}; Point(8) = {7.5, 1.5, 0, h * Sqrt(g)};
Point(9) = {7.5, 2.3, 0, h * Sqrt(g)}; Point(10) = {4, 2.3, 0, h * Sqrt(g)};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 1}; Line(6) = {4, 6};
Line(7) = {7, 8}; Line(8) = {8, 9}; Line(9) = {9, 10}; Line(10) = {10, 7};
Curve Loop(1) = {1:5}; Curve Loop(2) = {7:10};
Plane Surface(1) = {1, 2}; Plane Surface(2) = {2};
Curve{6} In Surface{1};
Physical Surface("sand") = {1}; Physical Surface("clay") = {2};
Physical Curve("upstream") = {4}; Physical Curve("downstream") = {3}; Physical Curve("pile") = {6};
