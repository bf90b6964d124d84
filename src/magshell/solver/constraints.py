r"""What is held in a step whose load factor is an unknown: the distance from a state, or a displacement.

Points of the path are states with their load factors t. The distance between two of them is

    s² = Σ_I |Δu_I|² / (n L²) + ψ² Δt²,

n nodes, L the size of the body; ψ is small and matters only where the load moves nothing. A step by arc length solves
the equations together with s = radius: a sphere about the last point (Crisfield, Comput. Struct. 13, 1981). With δv the
increment at constant load and δv' that per load factor, both of one factorisation, the increment δv + δt δv' lies on
it for two values of δt. The one on the side of the trial point is taken, so the path is not run back; where the
increment misses the sphere, the value that comes closest to it.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np

from magshell.arrays import FloatArray
from magshell.linalg.vectors import dot
from magshell.shell.state import State

# ψ: the whole of a stage counts like a displacement of all nodes by a tenth of the body's size.
LOAD_WEIGHT = 0.1


class NoRoot(ArithmeticError):
    """The constraint cannot be met."""


class Metric(NamedTuple):
    """Inner product of directions (displacements, load factor); `scale` is 1/(n L²)."""

    scale: float

    def product(self, first: tuple[FloatArray, float], second: tuple[FloatArray, float]) -> float:
        """Of two directions."""
        return float(self.scale * dot(first[0], second[0]) + LOAD_WEIGHT**2 * first[1] * second[1])

    def norm(self, u: FloatArray, load: float) -> float:
        """Length of a direction."""
        return float(np.sqrt(self.product((u, load), (u, load))))


class Constraint(Protocol):
    """One equation for the load factor."""

    def d_load(self, state: State, load_factor: float, increment: FloatArray, per_load: FloatArray) -> float:
        """Increment δt that meets it with displacements moved by `increment` + δt `per_load`, both (nodes, 3).

        Raises
        ------
        NoRoot
        """


class Sphere(NamedTuple):
    """Points at a distance from the last one.

    Attributes
    ----------
    metric : Metric
    u, load_factor : ndarray, shape (nodes, 3), and float
        The last point.
    ahead, ahead_load : ndarray, shape (nodes, 3), and float
        From the last point to the trial point.
    radius : float
    """

    metric: Metric
    u: FloatArray
    load_factor: float
    ahead: FloatArray
    ahead_load: float
    radius: float

    def d_load(self, state: State, load_factor: float, increment: FloatArray, per_load: FloatArray) -> float:
        """See `Constraint`."""
        away = (state.u - self.u + increment, load_factor - self.load_factor)
        slope = (per_load, 1.0)
        a, b = self.metric.product(slope, slope), self.metric.product(away, slope)
        c = self.metric.product(away, away) - self.radius**2
        side = 1.0 if self.metric.product(slope, (self.ahead, self.ahead_load)) > 0.0 else -1.0
        return float((-b + side * np.sqrt(max(b**2 - a * c, 0.0))) / a)


class ProbeValue(NamedTuple):
    """A displacement component of a node, u[node, column] = value (m)."""

    node: int
    column: int
    value: float

    def d_load(self, state: State, load_factor: float, increment: FloatArray, per_load: FloatArray) -> float:
        """See `Constraint`."""
        slope = float(per_load[self.node, self.column])
        if slope == 0.0:
            raise NoRoot("the load does not move the probe")
        return (self.value - float(state.u[self.node, self.column] + increment[self.node, self.column])) / slope
