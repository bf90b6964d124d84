"""State of the shell: nodal fields and enhanced parameters."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.shell import rotation


class State(NamedTuple):
    """Immutable by convention: updates make a new one.

    Attributes
    ----------
    u : ndarray, shape (nodes, 3)
        Mid-surface displacement, m.
    w : ndarray, shape (nodes, 3)
        Director displacement d - D; zero at nodes that do not carry it.
    phi : ndarray, shape (nodes,)
        Linear thickness stretch, 1/m; zero at nodes that do not carry it.
    q : ndarray, shape (nodes, 4)
        Micro-rotation as unit quaternions, scalar first; the identity at nodes that do not carry it.
    s : ndarray, shape (nodes,)
        Stretch of the director where sections differ, (1 + s) d; zero at nodes that do not carry it.
    alpha : ndarray, shape (elements, modes, 3)
        Enhanced parameters.
    """

    u: FloatArray
    w: FloatArray
    phi: FloatArray
    q: FloatArray
    s: FloatArray
    alpha: FloatArray

    def displacement(self, nodes: int) -> FloatArray:
        """Displacement (nodes, 3) of the mesh's nodes, which come first, m."""
        return self.u[:nodes]

    @classmethod
    def undeformed(cls, nodes: int, elements: int, modes: int) -> State:
        """All zero, no rotation."""
        zeros, none = np.zeros((nodes, 3)), np.zeros(nodes)
        alpha = np.zeros((elements, modes, 3))
        return cls(zeros, zeros.copy(), none, rotation.identity(nodes), none.copy(), alpha)

    def moved(self, increment: FloatArray, d_alpha: FloatArray) -> State:
        """State after a nodal increment (nodes, 11) of u, w, φ, spin and s, and Δα."""
        return State(
            self.u + increment[:, :3],
            self.w + increment[:, 3:6],
            self.phi + increment[:, 6],
            rotation.compose(increment[:, 7:10], self.q),
            self.s + increment[:, 10],
            self.alpha + d_alpha,
        )

    def increment_from(self, other: State) -> tuple[FloatArray, FloatArray]:
        """The nodal increment (nodes, 11) and Δα that move `other` to this state."""
        spin = rotation.logarithm(rotation.product(self.q, rotation.conjugate(other.q)))
        phi, s = (self.phi - other.phi)[:, None], (self.s - other.s)[:, None]
        increment = np.concatenate([self.u - other.u, self.w - other.w, phi, spin, s], axis=1)
        return increment, self.alpha - other.alpha
