Point(1)={0,0,0}; Point(2)={4,0,0}; Point(3)={4,1,0}; Point(4)={3,1,0}; Point(5)={2.25,0.25,0}; Point(6)={0,0.25,0};
Point(7)={0,1.25,0}; Point(8)={4,1.25,0};
Line(1)={1,2}; Line(2)={2,3}; Line(3)={3,4}; Line(4)={4,5}; Line(5)={5,6}; Line(6)={6,1};
Line(7)={6,7}; Line(8)={7,8}; Line(9)={8,3};
Curve Loop(1)={1,2,3,4,5,6}; Plane Surface(1)={1};
Curve Loop(2)={-5,-4,-3,-9,-8,-7}; Plane Surface(2)={2};
Physical Surface("soil")={1}; Physical Surface("free_above")={2};
Physical Curve("bottom")={1}; Physical Curve("left")={6,7}; Physical Curve("right")={2,9}; Physical Curve("top")={8};
