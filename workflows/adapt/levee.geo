// Ground under an impervious levee that stands on 12 <= x <= 24: a blanket of silt, sand, gravel. A ditch behind the levee
// cuts half of the blanket. h: size of the elements; g: the part of it at the feet of the levee and in the ditch.
h = 1.2;
g = 1;
Point(1) = {0, -6, 0, h}; Point(2) = {40, -6, 0, h}; Point(3) = {40, -4, 0, h}; Point(4) = {0, -4, 0, h};
Point(5) = {40, -1.2, 0, h}; Point(6) = {0, -1.2, 0, h};
Point(7) = {40, 0, 0, h}; Point(8) = {29, 0, 0, h}; Point(9) = {28.4, -0.6, 0, h * g}; Point(10) = {27.4, -0.6, 0, h * g};
Point(11) = {26.8, 0, 0, h}; Point(12) = {24, 0, 0, h * g}; Point(13) = {12, 0, 0, h * g}; Point(14) = {0, 0, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Line(5) = {3, 5}; Line(6) = {5, 6}; Line(7) = {6, 4};
Line(8) = {5, 7}; Line(9) = {7, 8}; Line(10) = {8, 9}; Line(11) = {9, 10}; Line(12) = {10, 11}; Line(13) = {11, 12};
Line(14) = {12, 13}; Line(15) = {13, 14}; Line(16) = {14, 6};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Curve Loop(2) = {-3, 5, 6, 7}; Plane Surface(2) = {2};
Curve Loop(3) = {-6, 8, 9, 10, 11, 12, 13, 14, 15, 16}; Plane Surface(3) = {3};
Physical Surface("gravel") = {1}; Physical Surface("sand") = {2}; Physical Surface("silt") = {3};
Physical Curve("waterside") = {15}; Physical Curve("landside") = {9:13};
