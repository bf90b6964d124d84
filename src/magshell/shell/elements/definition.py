"""What an element type is: declared data that the kernels are generic over."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.shell.shape_functions import bilinear, gauss_legendre, quadratic_complete, serendipity


class Rule(NamedTuple):
    """Integration rule on the parent square: points (n, 2) and weights (n,)."""

    points: FloatArray
    weights: FloatArray


def gauss(count: int) -> Rule:
    """Gauss–Legendre rule of count × count points."""
    return Rule(*gauss_legendre(count))


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
    """

    name: str
    rest_nodes: int
    stretch_nodes: int
    rule: Rule
    modes: tuple[Mode, ...] = ()
    bubble: float = 0.0
    complete: bool = True

    @property
    def vectors(self) -> int:
        """Number of vectors of the element's own parameters."""
        return len(self.modes) + (self.bubble > 0.0)

    def functions(self, nodes: int, parent: FloatArray, coordinates: FloatArray) -> Functions:
        """Functions of a field on 4 or 8 nodes at parent points (p, 2) of elements (e, 8, 3)."""
        if nodes == 8 and self.complete:
            return Functions(*quadratic_complete(parent, coordinates))
        plain = serendipity(parent)[:2] if nodes == 8 else bilinear(parent)
        return Functions(*(np.broadcast_to(a, (len(coordinates), *a.shape)) for a in plain))

    def carriers(self, elements: np.ndarray, count: int) -> dict[str, np.ndarray]:
        """Which of `count` nodes carry each field: boolean arrays by the names u, w, phi and omega."""
        rest, stretch = np.zeros(count, dtype=bool), np.zeros(count, dtype=bool)
        rest[elements[:, : self.rest_nodes]] = True
        stretch[elements[:, : self.stretch_nodes]] = True
        return {"u": np.ones(count, dtype=bool), "w": rest, "phi": stretch, "omega": rest}
