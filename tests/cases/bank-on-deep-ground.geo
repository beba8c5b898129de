Point(1)={-3,-1,0};Point(2)={12,-1,0};Point(3)={12,0,0};Point(4)={3,0,0};Point(5)={0,2,0};Point(6)={-3,2,0};Point(7)={12,2.5,0};Point(8)={-3,2.5,0};Point(9)={-3,0,0};
Point(10)={-40,-1,0};Point(11)={-40,-40,0};Point(12)={50,-40,0};Point(13)={50,-1,0};
Line(1)={1,2};Line(2)={2,3};Line(3)={3,4};Line(4)={4,5};Line(5)={5,6};Line(6)={6,9};Line(7)={9,1};Line(8)={3,7};Line(9)={7,8};Line(10)={8,6};Line(11)={9,4};
Line(12)={1,10};Line(13)={10,11};Line(14)={11,12};Line(15)={12,13};Line(16)={13,2};
Curve Loop(1)={1,2,3,-11,7};Plane Surface(1)={1};Curve Loop(2)={11,4,5,6};Plane Surface(2)={2};Curve Loop(3)={8,9,10,-5,-4,-3};Plane Surface(3)={3};
Curve Loop(4)={12,13,14,15,16,-1};Plane Surface(4)={4};
MeshSize{10,11,12,13}=8; MeshSize{1,2,3,4,5,6,7,8,9}=1.0;
Physical Surface("found")={1};Physical Surface("bank")={2};Physical Surface("free_above")={3};Physical Surface("deep")={4};
Physical Curve("base")={14};Physical Curve("sides")={2,6,7,8,10,13,15};Physical Curve("sky")={9};
