// A slurry wall down to 3 m in a layer of 4 m, with water on both sides. h: size of the elements; g: the part of it at
// the ends of the wall.
h = 0.8;
g = 1;
Point(1) = {0, -4, 0, h}; Point(2) = {14, -4, 0, h}; Point(3) = {14, 0, 0, h}; Point(4) = {7, 0, 0, h * g}; Point(5) = {0, 0, 0, h};
Point(6) = {7, -3, 0, h * g};
Point(7) = {6, 0, 0, h * g}; Point(8) = {8, 0, 0, h * g};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 8}; Line(4) = {8, 4}; Line(5) = {4, 7}; Line(6) = {7, 5}; Line(7) = {5, 1};
Line(8) = {4, 6};
Curve Loop(1) = {1:7}; Plane Surface(1) = {1};
Curve{8} In Surface{1};
Physical Surface("ground") = {1};
Physical Curve("upstream") = {6}; Physical Curve("downstream") = {3}; Physical Curve("slurry") = {8};
