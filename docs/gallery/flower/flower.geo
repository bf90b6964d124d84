// A flower of six petals about a hexagon, held by a hexagonal post, in mm. Everything is meshed by blocks.
SetFactory("OpenCASCADE");

side = 3;                         // of the hexagon, and of a petal's foot
apothem = side * Sqrt(3) / 2;
tip = 11.0;                       // from the middle of the flower to the end of a petal
post = 1.5;                       // from the middle to the corners of the post

across = 4;                       // elements
along = 12;
ring = 2;

// The petal in the direction of side k of the hexagon is drawn along X1 and turned.
For k In {0:5}
  c = Cos(k * Pi / 3);  s = Sin(k * Pi / 3);
  p = 100 * (k + 1);
  Point(p + 0) = {apothem * c + side / 2 * s, apothem * s - side / 2 * c, 0};
  Point(p + 1) = {5.6 * c + 3.5 * s, 5.6 * s - 3.5 * c, 0};
  Point(p + 2) = {9.2 * c + 2.4 * s, 9.2 * s - 2.4 * c, 0};
  Point(p + 3) = {10.6 * c + 1.3 * s, 10.6 * s - 1.3 * c, 0};
  Point(p + 4) = {tip * c, tip * s, 0};
  Point(p + 5) = {10.6 * c - 1.3 * s, 10.6 * s + 1.3 * c, 0};
  Point(p + 6) = {9.2 * c - 2.4 * s, 9.2 * s + 2.4 * c, 0};
  Point(p + 7) = {5.6 * c - 3.5 * s, 5.6 * s + 3.5 * c, 0};
  Point(p + 8) = {post * Cos((k - 0.5) * Pi / 3), post * Sin((k - 0.5) * Pi / 3), 0};
EndFor
Point(1) = {0, 0, 0};

For k In {0:5}
  p = 100 * (k + 1);
  next = 100 * ((k + 1) % 6 + 1); // the next petal: its first point is this one's last
  Line(p + 1) = {p, next};
  BSpline(p + 2) = {p, p + 1, p + 2, p + 3};
  BSpline(p + 3) = {next, p + 7, p + 6, p + 5};
  BSpline(p + 4) = {p + 3, p + 4, p + 5};
  Line(p + 5) = {p + 8, p};
  Line(p + 6) = {p + 8, next + 8};
EndFor
For k In {0:5}
  p = 100 * (k + 1);
  next = 100 * ((k + 1) % 6 + 1);
  Curve Loop(p) = {p + 2, p + 4, -(p + 3), -(p + 1)};
  Plane Surface(p) = {p};
  Curve Loop(p + 1) = {p + 5, p + 1, -(next + 5), -(p + 6)};
  Plane Surface(p + 1) = {p + 1};
  Transfinite Curve {p + 1, p + 4, p + 6} = across + 1;
  Transfinite Curve {p + 2, p + 3} = along + 1;
  Transfinite Curve {p + 5} = ring + 1;
  Transfinite Surface {p, p + 1};
  Physical Surface(Sprintf("petal-%g", k + 1)) = {p};
EndFor
For k In {0:2}                    // the post: three rhombi about the middle
  Line(k + 1) = {1, 100 * (2 * k + 1) + 8};
EndFor
For k In {0:2}
  p = 100 * (2 * k + 1);
  Curve Loop(k + 1) = {k + 1, p + 6, p + 106, -((k + 1) % 3 + 1)};
  Plane Surface(k + 1) = {k + 1};
  Transfinite Curve {k + 1} = across + 1;
EndFor
Transfinite Surface {1, 2, 3};

Physical Surface("post") = {1, 2, 3};
Physical Surface("middle") = {101, 201, 301, 401, 501, 601};

Mesh.RecombineAll = 1;
Mesh.ElementOrder = 2;
Mesh.SecondOrderIncomplete = 1;   // of eight nodes
