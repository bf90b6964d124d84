// Six petals around a disc, in mm. Every petal is a group of its own, to be magnetised along its own radius.
r = 4;        // radius of the disc
w = 24;       // half the angle that a petal takes of the disc, degrees
Point(1) = {0, 0, 0};
For k In {0:5}
  a = k * Pi / 3;
  d = w * Pi / 180;
  Point(10 * k + 11) = {r * Cos(a - d), r * Sin(a - d), 0};
  Point(10 * k + 12) = {r * Cos(a + d), r * Sin(a + d), 0};
  Point(10 * k + 13) = {9 * Cos(a) + 2.6 * Sin(a), 9 * Sin(a) - 2.6 * Cos(a), 0};
  Point(10 * k + 14) = {13 * Cos(a) + 1.2 * Sin(a), 13 * Sin(a) - 1.2 * Cos(a), 0};
  Point(10 * k + 15) = {13.6 * Cos(a), 13.6 * Sin(a), 0};
  Point(10 * k + 16) = {13 * Cos(a) - 1.2 * Sin(a), 13 * Sin(a) + 1.2 * Cos(a), 0};
  Point(10 * k + 17) = {9 * Cos(a) - 2.6 * Sin(a), 9 * Sin(a) + 2.6 * Cos(a), 0};
EndFor
For k In {0:5}
  n = 10 * ((k + 1) % 6) + 11;
  p = 10 * k + 11;
  Circle(p) = {p, 1, p + 1};          // the root of the petal
  Circle(p + 1) = {p + 1, 1, n};      // between two petals
  Spline(p + 2) = {p, p + 2, p + 3, p + 4, p + 5, p + 6, p + 1};
  Curve Loop(k + 1) = {p + 2, -p};
  Plane Surface(k + 1) = {k + 1};
  Physical Surface(Sprintf("petal-%g", k + 1)) = {k + 1};
EndFor
Curve Loop(7) = {11, 12, 21, 22, 31, 32, 41, 42, 51, 52, 61, 62};
Plane Surface(7) = {7};
Physical Surface("disc") = {7};
Physical Curve("rim") = {12, 22, 32, 42, 52, 62};
