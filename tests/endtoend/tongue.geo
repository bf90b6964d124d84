// A tongue with a round tip, drawn in mm.
SetFactory("OpenCASCADE");
Rectangle(1) = {0, -2, 0, 12, 4};
Disk(2) = {12, 0, 0, 2};
BooleanUnion(3) = { Surface{1}; Delete; }{ Surface{2}; Delete; };
Physical Surface("tongue") = {3};
root() = Curve In BoundingBox {-0.01, -2.01, -0.01, 0.01, 2.01, 0.01};
Physical Curve("root") = {root()};
