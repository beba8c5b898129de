// A column of sand of 1 m by 1 m, and room to run out. The column is `squares` squares wide; each is cut along its diagonals.
squares = 16;
n = squares / 2;  // Gmsh cuts each quadrangle of this drawing in four
Point(1) = {0, 0, 0};    Point(2) = {1, 0, 0};    Point(3) = {3, 0, 0};
Point(4) = {0, 1, 0};    Point(5) = {1, 1, 0};    Point(6) = {3, 1, 0};
Point(7) = {0, 1.25, 0}; Point(8) = {1, 1.25, 0}; Point(9) = {3, 1.25, 0};
Line(1) = {1, 2}; Line(2) = {2, 3};
Line(3) = {4, 5}; Line(4) = {5, 6};
Line(5) = {7, 8}; Line(6) = {8, 9};
Line(7) = {1, 4}; Line(8) = {2, 5}; Line(9) = {3, 6};
Line(10) = {4, 7}; Line(11) = {5, 8}; Line(12) = {6, 9};
Curve Loop(1) = {1, 8, -3, -7};   Plane Surface(1) = {1};
Curve Loop(2) = {2, 9, -4, -8};   Plane Surface(2) = {2};
Curve Loop(3) = {3, 11, -5, -10}; Plane Surface(3) = {3};
Curve Loop(4) = {4, 12, -6, -11}; Plane Surface(4) = {4};
Transfinite Curve {1, 3, 5, 7, 8, 9} = n + 1;
Transfinite Curve {2, 4, 6} = 2 * n + 1;
Transfinite Curve {10, 11, 12} = n / 4 + 1;
Transfinite Surface {1, 2, 3, 4};
Recombine Surface {1, 2, 3, 4};
Physical Surface("sand") = {1};
Physical Surface("free_above") = {2, 3, 4};
Physical Curve("floor") = {1, 2};
Physical Curve("left") = {7, 10};
Physical Curve("right") = {9, 12};
Physical Curve("sky") = {5, 6};
