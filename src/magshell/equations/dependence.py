r"""Values that depend on others: directors at joints, displacements and directors of rigid bodies.

With the micro-rotation R of a row, and a rigid body's reference point r (`shell/ties.py`, which does the same inside
the elements):

    d = R D,    u = u_r + (R - I) ρ_0,        δd = δω × d,    δu = δu_r + δω × ρ,        ρ = R ρ_0.

Nodal forces f on d and g on u are then forces g on u_r and couples d × f + ρ × g on ω. Loads differentiate them by the
pairs of `Pairs`; blocks B between u or d of two rows become blocks between their spins by the same levers,
and where the forces f stay, the couples change by ½ (f ⊗ d + d ⊗ f) - (f · d) I in the chart exp(ϑ) R.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import AnyArray, FloatArray
from magshell.model.loads.cross import cross_matrix
from magshell.model.rows import OMEGA, Rows, U, W
from magshell.shell import rotation
from magshell.shell.rotation import cross
from magshell.shell.state import State
from magshell.shell.ties import RIGID, TURNED


class Levers(NamedTuple):
    """What spins multiply: d of the rows whose director turns, and ρ of those on rigid bodies, (n, 3)."""

    directors: FloatArray
    arms: FloatArray


class Dependence:
    """The dependent values of some rows.

    Attributes
    ----------
    turned, rigid : ndarray of int
        Rows whose director turns with the micro-rotation, and those of rigid bodies among them.
    depends : ndarray of bool, shape (rows,)
        The former, as a mask.
    """

    def __init__(self, rows: Rows) -> None:
        self._rows = rows
        self.turned, self.rigid = np.flatnonzero(rows.kind >= TURNED), np.flatnonzero(rows.kind == RIGID)
        self._bodies = rows.body[self.rigid]
        self._arms = rows.points[self.rigid] - rows.points[self._bodies]
        self.depends = rows.kind >= TURNED

    def depends_of(self, field: str) -> AnyArray:
        """Which rows (rows,) have a dependent value of a field."""
        if field == "omega":
            return np.zeros_like(self.depends)
        return self._rows.kind == RIGID if field == "u" else self.depends

    def settled(self, state: State) -> State:
        """A state with its dependent values put to those of its others."""
        if not self.turned.size:
            return state
        u, w, q = state.u.copy(), state.w.copy(), state.q.copy()
        q[self.rigid] = q[self._bodies]
        D = self._rows.normals[self.turned]
        w[self.turned] = _rotated(q[self.turned], D) - D
        u[self.rigid] = u[self._bodies] + _rotated(q[self.rigid], self._arms) - self._arms
        return state._replace(u=u, w=w, q=q)

    def levers(self, state: State) -> Levers:
        """At a state."""
        rows = self._rows
        arms = self._arms + state.u[self.rigid] - state.u[self._bodies]
        return Levers(rows.normals[self.turned] + state.w[self.turned], arms)

    def spread(self, nodal: FloatArray, levers: Levers) -> FloatArray:
        """Increments (rows, 11), global axes, with those of the dependent values."""
        if not self.turned.size:
            return nodal
        spread = nodal.copy()
        spread[self.turned, W] = cross(nodal[self.turned, OMEGA], levers.directors)
        spread[self.rigid, U] += cross(nodal[self.rigid, OMEGA], levers.arms)
        return spread

    def gathered(self, forces: FloatArray, levers: Levers) -> FloatArray:
        """Forces (rows, 11), global axes, with those on dependent values put on what these depend on."""
        if not self.turned.size:
            return forces
        gathered = forces.copy()
        gathered[self.turned, W] = 0.0
        gathered[self.turned, OMEGA] += cross(levers.directors, forces[self.turned, W])
        gathered[self.rigid, OMEGA] += cross(levers.arms, forces[self.rigid, U])
        return gathered

    def curvature(self, forces: FloatArray, levers: Levers) -> FloatArray:
        """Second derivatives (rows, 3, 3) of the work of dead forces (rows, 11) by the spins of each row."""
        blocks = np.zeros((len(forces), 3, 3))
        blocks[self.turned] += _second(forces[self.turned, W], levers.directors)
        blocks[self.rigid] += _second(forces[self.rigid, U], levers.arms)
        return blocks

    def lever_matrices(self, field: str, levers: Levers) -> FloatArray:
        """Matrices L (rows, 3, 3) with δu = … + L δω, or δd = L δω; zero for rows that do not depend."""
        matrices = np.zeros((len(self._rows.of), 3, 3))
        if field == "u":
            matrices[self.rigid] = -cross_matrix(levers.arms)
        elif field == "w":
            matrices[self.turned] = -cross_matrix(levers.directors)
        return matrices


def _rotated(q: FloatArray, vectors: FloatArray) -> FloatArray:
    return np.asarray(np.einsum("nij,nj->ni", rotation.matrix(q), vectors))


def _second(f: FloatArray, d: FloatArray) -> FloatArray:
    outer = 0.5 * (f[:, :, None] * d[:, None, :] + d[:, :, None] * f[:, None, :])
    return np.asarray(outer - np.sum(f * d, axis=1)[:, None, None] * np.eye(3))
