"""The element for general use: quadratic u, w and micro-rotation, bilinear thickness stretch, 2 × 2 points.

The thickness stretch enters the section by its value only, as a partner of the derivatives of w. On all eight nodes it
has more values than the four points of an element can see: these are all the spurious modes of the fully quadratic
element with reduced integration (four for one element, and they spread). On the corners it has as many as there are
points, and is of the order of the derivatives of w. The remaining modes are the six rigid ones, exactly.
"""

from __future__ import annotations

from magshell.shell.elements.definition import ElementType, gauss

QUADRATIC = ElementType(name="quadratic", rest_nodes=8, stretch_nodes=4, rule=gauss(2))
