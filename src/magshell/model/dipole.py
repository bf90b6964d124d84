r"""Magnetic moments of rigid bodies: a dipole m that turns with the body, R m, feels the couple R m × B.

Its energy is -R m · B.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from magshell.arrays import FloatArray
from magshell.model.loads.cross import cross_matrix
from magshell.model.loads.dead import nodal
from magshell.model.loads.load import Pairs
from magshell.model.shell import Shell
from magshell.shell import rotation
from magshell.shell.rotation import cross
from magshell.shell.state import State


@dataclass(frozen=True, eq=False)
class Dipole:
    """The couple on a moment (3,), A m², in a field of 1 T along an axis (3,)."""

    row: int
    moment: FloatArray
    axis: FloatArray

    @property
    def conservative(self) -> bool:
        return True

    @property
    def pairs(self) -> Sequence[Pairs]:
        at = np.array([self.row])
        return (Pairs("omega", "omega", at, at),)

    def turned(self, state: State) -> FloatArray:
        """R m (3,)."""
        return np.asarray(rotation.matrix(state.q[self.row]) @ self.moment)

    def forces(self, state: State) -> FloatArray:
        """R m × B on the spin of the body."""
        couples = np.zeros_like(state.u)
        couples[self.row] = cross(self.turned(state), self.axis)
        return nodal("omega", couples)

    def stiffness(self, state: State) -> list[FloatArray]:
        """-[B]× [R m]×."""
        return [-cross_matrix(self.axis[None]) @ cross_matrix(self.turned(state)[None])]


def dipoles_of(shell: Shell) -> tuple[Dipole, ...]:
    """Three for each rigid body with a moment, one for each component of the field."""
    return tuple(
        Dipole(len(shell.mesh.points) + number, np.asarray(body.moment), axis)
        for number, body in enumerate(shell.rigid)
        if np.any(body.moment)
        for axis in np.eye(3)
    )
