r"""A force with a total over a group, dead or turning with the micro-rotation.

One that follows is R̃_I F_I at node I, with the node's share F_I of the total. A spin ϑ changes it by ϑ × R̃_I F_I, so
that the tangent gets [R̃_I F_I]× at (u, ω). This has no potential, since there is no transposed block at (ω, u).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from magshell.arguments import instance
from magshell.arrays import FloatArray, IntArray
from magshell.errors import InputError
from magshell.keys import HISTORY, Key
from magshell.model.loads.checks import vector
from magshell.model.loads.cross import cross_matrix
from magshell.model.loads.dead import DeadForces, nodal
from magshell.model.loads.distribution import shares
from magshell.model.loads.load import Applied, Pairs, Size
from magshell.model.loads.total import FOLLOWER, GROUP, TotalLoad
from magshell.model.rows import Rows
from magshell.model.shell import Shell
from magshell.shell import rotation
from magshell.shell.state import State
from magshell.units import FORCE, Dimension


@dataclass(frozen=True, eq=False)
class Force(TotalLoad):
    """A force on the displacements of a group.

    Parameters
    ----------
    group : str
        A group of nodes, which share it equally, of edges, along whose undeformed length it is uniform, or of elements,
        over whose undeformed area it is uniform; or the name of a rigid body, at whose reference point it acts.
    total : array_like, shape (3,)
        N.
    follower : bool, optional
        Whether it turns with the micro-rotations of its nodes; those without share none of it. By default it is dead:
        it keeps its direction.
    history : sequence of float, optional
        Multiplier at the end of each stage; by default 1 at the end of the first and from then on.
    """

    kind: ClassVar[str] = "force"
    keys: ClassVar[Mapping[str, Key]] = {
        "group": GROUP,
        "total": Key("ForceVector", "Its sum over the group."),
        "follower": FOLLOWER,
        "history": HISTORY,
    }
    amount: ClassVar[tuple[str, Dimension]] = ("total", FORCE)
    letter: ClassVar[str] = "$F$"

    group: str
    total: ArrayLike
    follower: bool = False
    history: Sequence[float] | None = None

    def applied(self, shell: Shell, rows: Rows) -> Applied:
        """The load on a mesh."""
        with self.located():
            instance("follower", self.follower, (bool, np.bool_), "True or False")
            if self.follower and not shell.micro_rotation:
                raise InputError(
                    "a follower turns with the micro-rotation, which this shell does not have; leave follower out"
                )
            body, jump = shell.body_row(self.group), shell.jump_row(self.group)
            if self.follower and jump is not None:
                raise InputError("a jump does not turn, so nothing can follow it; leave follower out")
            body = jump if body is None else body
            parts = np.zeros(len(rows.of))
            if body is None:
                parts[: rows.nodes] = shares(shell, self.group, "omega" if self.follower else "u")
            else:
                parts[body] = 1.0
            on_u = parts[:, None] * vector("total", self.total)
        return _TurningForces(on_u) if self.follower else DeadForces(on_u)

    def size(self, forces: FloatArray) -> Size:
        """Its total."""
        return Size(force=float(np.linalg.norm(self.value)))


@dataclass(frozen=True, eq=False)
class _TurningForces:
    """Forces (nodes, 3) of the unrotated nodes, N."""

    unrotated: FloatArray

    @property
    def conservative(self) -> bool:
        return False

    @property
    def _nodes(self) -> IntArray:
        return np.flatnonzero(np.any(self.unrotated, axis=1))

    @property
    def pairs(self) -> Sequence[Pairs]:
        return (Pairs("u", "omega", self._nodes, self._nodes),)

    def _turned(self, state: State) -> FloatArray:
        return np.einsum("nij,nj->ni", rotation.matrix(state.q[: len(self.unrotated)]), self.unrotated)

    def forces(self, state: State) -> FloatArray:
        """R̃ F on u."""
        return nodal("u", self._turned(state))

    def stiffness(self, state: State) -> list[FloatArray]:
        """[R̃ F]×."""
        return [cross_matrix(self._turned(state)[self._nodes])]
