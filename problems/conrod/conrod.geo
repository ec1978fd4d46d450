// Upper half (z >= 0) of a connecting rod: two eyes, a tapered shank with a pocket. Metres.
SetFactory("OpenCASCADE");
DefineConstant[ h = {0.006} ];
L = 0.15; R1 = 0.032; r1 = 0.024; R2 = 0.018; r2 = 0.011;  // distance of the bores; radii outside and inside
T = 0.022; F = 0.0176; w1 = 0.030; w2 = 0.022; web = 0.008; flange = 0.004;
Cylinder(1) = {0, 0, 0, 0, 0, T/2, R1};
Cylinder(2) = {L, 0, 0, 0, 0, T/2, R2};
Point(101) = {0, -w1/2, 0}; Point(102) = {L, -w2/2, 0}; Point(103) = {L, w2/2, 0}; Point(104) = {0, w1/2, 0};
Line(201) = {101, 102}; Line(202) = {102, 103}; Line(203) = {103, 104}; Line(204) = {104, 101};
Curve Loop(301) = {201, 202, 203, 204}; Plane Surface(301) = {301};
e[] = Extrude {0, 0, F/2} { Surface{301}; };
BooleanUnion(10) = { Volume{1}; Delete; }{ Volume{2}; Volume{e[1]}; Delete; };
Cylinder(11) = {0, 0, -T, 0, 0, 2*T, r1};
Cylinder(12) = {L, 0, -T, 0, 0, 2*T, r2};
Box(13) = {R1 + 0.006, -w2/2 + flange, web/2, L - R1 - R2 - 0.012, w2 - 2*flange, T};
BooleanDifference(20) = { Volume{10}; Delete; }{ Volume{11, 12, 13}; Delete; };
Physical Volume("body") = {20};
Mesh.ElementOrder = 2;
Mesh.SecondOrderLinear = 0;
Mesh.CharacteristicLengthMax = h;
Mesh.CharacteristicLengthMin = h/2;
Mesh.Algorithm3D = 1;
Mesh.RandomFactor = 1e-9;
