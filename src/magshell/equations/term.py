"""A term of the equations: what the residual is a sum of."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, Protocol

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.equations.insertion import Insertion
from magshell.equations.instant import Increment, Instant, Prediction, Weights
from magshell.model.course import Loading
from magshell.shell.unknowns import COLUMNS


class Contribution(NamedTuple):
    """What a term adds to the equations at an instant; nodal arrays in the nodes' frames.

    Attributes
    ----------
    residual : ndarray, shape (nodes, 11)
    condensed : ndarray, shape (nodes, 11)
        The same after the elimination of the unknowns that the term owns, plus the tangent's product with what is
        imposed.
    scale : ndarray, shape (5,)
        Sums of squares of the forces that the residual is made of, of u, w, φ, ω and s.
    inner : float
        Norm of the residual of the unknowns that the term owns.
    energy : ndarray, shape (elements, 2), or None
        Elastic and magnetic energy of each element, J; None: the term has no elements.
    """

    residual: FloatArray
    condensed: FloatArray
    scale: FloatArray
    inner: float
    energy: FloatArray | None = None


class Term(Protocol):
    """A part of the residual, with its tangent.

    A term is evaluated at instants; it keeps only what the next call of `recovered` needs.
    """

    def couplings(self) -> Sequence[IntArray]:
        """Nodes (n, m) that it couples with each other, row by row."""

    def evaluate(
        self, instant: Instant, weights: Weights, insertion: Insertion | None, imposed: FloatArray | None
    ) -> Contribution:
        """Residual, and with an insertion the tangent, weighted.

        Parameters
        ----------
        instant : Instant
        weights : Weights
        insertion : Insertion or None
            None: only the residual is made.
        imposed : ndarray, shape (nodes, 11), or None
            Increments of held components, in the nodes' frames.

        Raises
        ------
        InvertedElement, FieldLost
        """

    def load_rate(self, instant: Instant, rate: Loading) -> FloatArray:
        """Derivative of the residual (nodes, 11) along a rate of the loading, in the nodes' frames."""

    def predict(self, instant: Instant, increment: Increment) -> Prediction:
        """What the mixed tangent takes of a state after an increment, linear in it; None: nothing."""

    def recovered(self, nodal: FloatArray, whole: bool) -> FloatArray | None:
        """Increment of the unknowns that it owns, of the last tangent, for a nodal increment (nodes, 11), global axes.

        With `whole` it includes what their own residual asks for. None: the term owns none.
        """

    def noise(self) -> FloatArray:
        """Norms (6,) that round-off makes of the residuals of u, w, φ, ω, s and of what it owns."""


def squares_by_kind(nodal: FloatArray) -> FloatArray:
    """Sums of squares (5,) of the columns (nodes, 11) of u, w, φ, ω and s."""
    starts = [columns.start for columns in COLUMNS.values()]
    return np.add.reduceat(np.einsum("nc,nc->c", nodal, nodal), starts)


class FieldLost(ArithmeticError):
    """A trial state has an element where the field is not known."""

    def __init__(self, element: int | None, why: str) -> None:
        super().__init__(element, why)
        self.element, self.why = element, why


class InvertedElement(ArithmeticError):
    """A trial state turns an element inside out."""

    def __init__(self, element: int, determinant: float) -> None:
        super().__init__(element, determinant)
        self.element, self.determinant = element, determinant
