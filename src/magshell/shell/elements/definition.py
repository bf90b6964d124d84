"""Element types: declared data over which the kernels are generic."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.shell import triangle
from magshell.shell.shape_functions import bilinear, bubble, gauss_legendre, quadratic_complete, serendipity


class Rule(NamedTuple):
    """Integration rule on the parent square: points (n, 2) and weights (n,)."""

    points: FloatArray
    weights: FloatArray


def gauss(count: int) -> Rule:
    """Gauss–Legendre rule of count × count points."""
    return Rule(*gauss_legendre(count))


def three_points() -> Rule:
    """Rule of degree 2 on the triangle: the points where one barycentric coordinate is 2/3 and the others 1/6."""
    return Rule(*triangle.on_square(0.5 * np.eye(3) + 1.0 / 6.0, np.full(3, 1.0 / 3.0)))


class Points(NamedTuple):
    """Parent points, as many of quadrilaterals as of triangles: both (p, 2)."""

    quadrilaterals: FloatArray
    triangles: FloatArray


class Mode(NamedTuple):
    """An enhanced mode: F gains α ⊗ A^column ξ^xi η^eta, less what makes its integral vanish; column is 1, 2 or 3.

    A^1 and A^2 are those of the element's centre, A^3 is D.
    """

    column: int
    xi: int
    eta: int


class Functions(NamedTuple):
    """Functions of one field at points and their parent derivatives: (elements, p, nodes), (elements, p, 2, nodes)."""

    values: FloatArray
    derivatives: FloatArray


@dataclass(frozen=True, eq=False)
class ElementType:
    """Which fields live on which nodes, by which functions, and where they are integrated.

    Nodes of a field are the first ones of the element: 4 are the corners, 8 all.

    Attributes
    ----------
    name : str
    rest_nodes : int
        Nodes of the director displacement w and of the micro-rotation: 4 or 8.
    stretch_nodes : int
        Nodes of the thickness stretch φ: 4 or 8.
    rule : Rule
    modes : tuple of Mode
        Enhanced modes, each with a vector of three parameters.
    bubble : float
        If positive, u has a ninth function, the bubble (1 - ξ²)(1 - η²), with parameters of the element, and this is
        the factor c of what holds it (`magshell.shell.bubble`); 0: none.
    complete : bool
        Whether the 8-node functions hold all quadratic polynomials on straight-sided quadrilaterals
        (`quadratic_complete`) or are the plain serendipity ones.
    triangle_rule : Rule, optional
        Rule of triangles (`magshell.shell.triangle`), on the parent square too; None: the type has no triangles. With
        it, triangles have one more enhanced vector, that of the `turning_field` of `magshell.shell.geometry`;
        quadrilaterals beside them have nothing of it.
    mixed : ElementType, optional
        The type that stands for this one on meshes with triangles; None: there is none.
    """

    name: str
    rest_nodes: int
    stretch_nodes: int
    rule: Rule
    modes: tuple[Mode, ...] = ()
    bubble: float = 0.0
    complete: bool = True
    triangle_rule: Rule | None = None
    mixed: ElementType | None = None

    @property
    def vectors(self) -> int:
        """Number of vectors of the element's own parameters."""
        return len(self.modes) + (self.triangle_rule is not None) + (self.bubble > 0.0)

    @property
    def with_triangles(self) -> ElementType | None:
        """What stands for this type on meshes with triangles; None: it has none."""
        return self.mixed if self.triangle_rule is None else self

    def integration(self, coordinates: FloatArray) -> tuple[Points, FloatArray]:
        """Integration points of elements (e, 8, 3) and weights (e, p) of each.

        Where there are both shapes the shorter of the two rules has its last point again, with weight zero.
        """
        triangles = triangle.collapsed(coordinates)
        rules = [self.rule, self.triangle_rule or self.rule]
        if triangles.all() or not triangles.any():
            rules = 2 * [rules[int(triangles.any())]]
        most = max(len(rule.weights) for rule in rules)
        places = [np.minimum(np.arange(most), len(rule.weights) - 1) for rule in rules]
        weights = np.stack([np.pad(rule.weights, (0, most - len(rule.weights))) for rule in rules])
        points = Points(*(rule.points[place] for rule, place in zip(rules, places, strict=True)))
        return points, weights[triangles.astype(int)]

    def functions(self, nodes: int, parent: FloatArray | Points, coordinates: FloatArray) -> Functions:
        """Functions of a field on 4 or 8 nodes of elements (e, 8, 3) at parent points (p, 2), all alike or by shape."""
        points = parent if isinstance(parent, Points) else Points(parent, parent)
        square, count = points.quadrilaterals, len(coordinates)
        if nodes == 8 and self.complete:
            of_quadrilaterals = Functions(*quadratic_complete(square, coordinates))
        else:
            values, derivatives = serendipity(square)[:2] if nodes == 8 else bilinear(square)
            of_quadrilaterals = Functions(_repeated(values, count), _repeated(derivatives, count))
        of_triangles = (triangle.quadratic if nodes == 8 else triangle.linear)(points.triangles)
        return _by_shape(coordinates, of_quadrilaterals, Functions(*of_triangles))

    def bubbles(self, parent: FloatArray | Points, coordinates: FloatArray) -> Functions:
        """Bubble of elements (e, 8, 3) at parent points likewise: (e, p), and its parent derivatives (e, p, 2)."""
        points = parent if isinstance(parent, Points) else Points(parent, parent)
        values, derivatives = bubble(points.quadrilaterals)
        of_quadrilaterals = Functions(_repeated(values, len(coordinates)), _repeated(derivatives, len(coordinates)))
        return _by_shape(coordinates, of_quadrilaterals, Functions(*triangle.bubble(points.triangles)))

    def carriers(self, elements: np.ndarray, count: int) -> dict[str, np.ndarray]:
        """Which of `count` nodes carry each field: boolean arrays by the names u, w, phi and omega."""
        rest, stretch = np.zeros(count, dtype=bool), np.zeros(count, dtype=bool)
        rest[elements[:, : self.rest_nodes]] = True
        stretch[elements[:, : self.stretch_nodes]] = True
        return {"u": np.ones(count, dtype=bool), "w": rest, "phi": stretch, "omega": rest}


def _repeated(array: FloatArray, count: int) -> FloatArray:
    return np.broadcast_to(array, (count, *array.shape))


def _by_shape(coordinates: FloatArray, of_quadrilaterals: Functions, of_triangles: Functions) -> Functions:
    """Functions of each element, with those that all triangles share in the rows of triangles."""
    triangles = triangle.collapsed(coordinates)
    if not triangles.any():
        return of_quadrilaterals
    mixed = Functions(*(np.array(a) for a in of_quadrilaterals))
    mixed.values[triangles], mixed.derivatives[triangles] = of_triangles
    return mixed
