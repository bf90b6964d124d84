"""The element for general use: quadratic u, w and micro-rotation, bilinear thickness stretch, 2 × 2 points.

Two choices make it stable and free of locking. The thickness stretch enters the section by its value only, as a partner
of the derivatives of w. On all eight nodes it has more values than the four points of an element can see: these are all
the spurious modes of the fully quadratic element with reduced integration (four for one element, and they spread). On
the corners it has as many as there are points, and is of the order of the derivatives of w.

Eight nodes give u too little freedom: the four points impose 20 conditions of no stretch and no shear in thin bending
on the 15 unknowns of u and w that an element brings to a large mesh, and it locks (a clamped plate of L/h = 1000 under
a point load, four elements across a quarter, reaches two thirds of its deflection). A bubble in u, eliminated in the
element, gives three more, and what the points do not see of it is held by itself (`magshell.shell.bubble`).
"""

from __future__ import annotations

from dataclasses import replace

from magshell.shell.elements.definition import ElementType, gauss, three_points

_QUADRILATERALS = ElementType(name="quadratic", rest_nodes=8, stretch_nodes=4, rule=gauss(2), bubble=1.0)
QUADRATIC = replace(_QUADRILATERALS, mixed=replace(_QUADRILATERALS, triangle_rule=three_points()))
