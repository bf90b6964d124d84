r"""Arc length: the load factor as an unknown, held by the distance from the last state.

The distance between two states on the path is that of their displacements and load factors,

    s² = Σ_I |Δu_I|² / (n L²) + Δt²,

n nodes, L the size of the body, t the load factor. A step solves the equations together with s = radius: a sphere
about the last state (Crisfield, Comput. Struct. 13, 1981; spherical, in u and t). With δv the increment at constant
load and δv' that per load factor, both of one factorisation, the increment δv + δt δv' lies on the sphere for two
values of δt. The one that stays closer to the direction of the trial state is taken, so the path is not run back.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.shell.state import State


class NoRoot(ArithmeticError):
    """The increment misses the sphere."""


class Sphere(NamedTuple):
    """States at a distance from the last one.

    Attributes
    ----------
    u : ndarray, shape (nodes, 3)
        Displacement of the last state, m.
    load_factor : float
        Of the last state.
    ahead : ndarray, shape (nodes, 3)
        Displacement from the last state to the first trial state, m.
    load_ahead : float
        The same for the load factor.
    size : float
        Length that makes displacements numbers: √n L, m.
    """

    u: FloatArray
    load_factor: float
    ahead: FloatArray
    load_ahead: float
    size: float

    @property
    def radius(self) -> float:
        """Distance of the trial state from the last one."""
        return float(np.hypot(np.linalg.norm(self.ahead) / self.size, self.load_ahead))

    def d_load(self, state: State, load_factor: float, increment: FloatArray, per_load: FloatArray) -> float:
        """Increment δt that puts the state moved by `increment` + δt `per_load`, both (nodes, 10), on the sphere.

        Raises
        ------
        NoRoot
        """
        away = (state.u - self.u + increment[:, :3]) / self.size
        slope, dt = per_load[:, :3] / self.size, load_factor - self.load_factor
        a = np.sum(slope**2) + 1.0
        b = np.sum(away * slope) + dt
        c = np.sum(away**2) + dt**2 - self.radius**2
        discriminant = b**2 - a * c
        if discriminant < 0.0:
            raise NoRoot
        ahead = np.sum(slope * self.ahead) / self.size + self.load_ahead
        side = 1.0 if ahead > 0.0 else -1.0
        return float((-b + side * np.sqrt(discriminant)) / a)


def distance(first: State, second: State, d_load: float, size: float) -> float:
    """Between two states whose load factors differ by `d_load`."""
    return float(np.hypot(np.linalg.norm(second.u - first.u) / size, d_load))
