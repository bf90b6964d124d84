"""An instant of a solve, at which terms are evaluated, and increments from one to the next."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

import numpy as np

from magshell.arrays import FloatArray
from magshell.model.course import Loading
from magshell.shell.loops import Stresses
from magshell.shell.state import State

#: What terms predict of a state, for the mixed tangent; None: the plain tangent is made.
Prediction: TypeAlias = Stresses | None


class Weights(NamedTuple):
    """Weights of the derivatives of the residual with respect to the unknowns, their velocity and acceleration."""

    displacement: float
    velocity: float
    acceleration: float


STATIC = Weights(1.0, 0.0, 0.0)


@dataclass(frozen=True)
class Instant:
    """State and loading together.

    Attributes
    ----------
    state : State
    loading : Loading
    prediction : Prediction
        What the terms predicted of this state.
    """

    state: State
    loading: Loading
    prediction: Prediction = None


@dataclass(frozen=True, eq=False)
class Increment:
    """An increment of the unknowns, a vector: sums and multiples of increments are increments.

    Attributes
    ----------
    nodal : ndarray, shape (nodes, 11)
        Of u, w, φ and spins, global axes.
    alpha : ndarray, shape (elements, modes, 3)
        Of the elements' own parameters.
    """

    nodal: FloatArray
    alpha: FloatArray

    @property
    def u(self) -> FloatArray:
        """Displacements (nodes, 3)."""
        return self.nodal[:, :3]

    def __add__(self, other: Increment) -> Increment:
        return Increment(self.nodal + other.nodal, self.alpha + other.alpha)

    def __mul__(self, factor: float) -> Increment:
        return Increment(factor * self.nodal, factor * self.alpha)

    __rmul__ = __mul__

    def __neg__(self) -> Increment:
        return -1.0 * self


def difference(state: State, start: State) -> Increment:
    """The increment that moves `start` to a state."""
    return Increment(*state.increment_from(start))


def combined(weights: Sequence[float], predictions: Sequence[Prediction]) -> Prediction:
    """A linear combination of predictions."""
    present = [one for one in predictions if one is not None]
    if len(present) < len(predictions):
        return None
    parts = ([weight * one[part] for weight, one in zip(weights, present, strict=True)] for part in range(2))
    return Stresses(*(np.sum(part, axis=0) for part in parts))
