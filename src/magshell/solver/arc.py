r"""Arc length: the load factor as an unknown, held by the distance from the last state.

The distance between two states is that of their displacements,

    s² = Σ_I |Δu_I|² / (n L²),

n nodes, L the size of the body. A step solves the equations together with s = radius: a cylinder about the last state
in the space of displacements and load factor t (Crisfield, Comput. Struct. 13, 1981). With δv the increment at constant
load and δv' that per load factor, both of one factorisation, the increment δv + δt δv' lies on it for two values of δt.
The one that stays closer to the direction of the trial state is taken, so the path is not run back.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.shell.state import State


class NoRoot(ArithmeticError):
    """The increment misses the cylinder."""


class Cylinder(NamedTuple):
    """States at a distance from the last one.

    Attributes
    ----------
    u : ndarray, shape (nodes, 3)
        Displacement of the last state, m.
    ahead : ndarray, shape (nodes, 3)
        Displacement from the last state to the first trial state, m; its size is the distance.
    """

    u: FloatArray
    ahead: FloatArray

    def d_load(self, state: State, increment: FloatArray, per_load: FloatArray) -> float:
        """Increment δt that puts the state moved by `increment` + δt `per_load`, both (nodes, 10), on the cylinder.

        Raises
        ------
        NoRoot
        """
        away, slope = state.u - self.u + increment[:, :3], per_load[:, :3]
        a, b = np.sum(slope**2), np.sum(away * slope)
        c = np.sum(away**2) - np.sum(self.ahead**2)
        discriminant = b**2 - a * c
        if not (discriminant >= 0.0 and a > 0.0):
            raise NoRoot
        side = 1.0 if np.sum(slope * self.ahead) > 0.0 else -1.0
        return float((-b + side * np.sqrt(discriminant)) / a)


def distance(first: State, second: State, size: float) -> float:
    """Between two states of a body of this size (m)."""
    return float(np.linalg.norm(second.u - first.u) / (size * np.sqrt(len(first.u))))
