r"""A moment with a total over a group, on the micro-rotations or, without them, on the directors.

On the micro-rotation it is a couple c_I on the spin of node I, dead (its axis and magnitude stay) or turning with the
node, c_I = R̃_I C_I, so that dc_I = ϑ × c_I: the tangent gets [c_I]×. Neither has a potential: over rotations about
several axes, the work of a couple about an axis fixed in space or in the body depends on their order.

A shell without micro-rotation turns with its director d = D + w: δd = δω × d leaves for the rotation, but for the drill
about d itself, δω = d × δd / |d|², and the work of a moment M about an axis fixed in space is

    M · δω = f · δw,   f = M × d / |d|²,   df/dd = [M]× (I - 2 n ⊗ n) / |d|²,   n = d/|d|.

In bending (M normal to d) these are opposite forces on the two faces that turn with the section, through any number of
turns. What M has along d does no work: a director does not feel its own drill. Shares of the nodes are taken without
regard to that.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import FloatArray, IntArray
from magshell.errors import InputError
from magshell.keys import HISTORY, Key
from magshell.model.loads.checks import vector
from magshell.model.loads.cross import cross_matrix
from magshell.model.loads.dead import nodal
from magshell.model.loads.distribution import shares
from magshell.model.loads.load import Applied, Pairs, Size
from magshell.model.loads.total import FOLLOWER, GROUP, TotalLoad
from magshell.model.rows import Rows
from magshell.model.shell import Shell
from magshell.shell import rotation
from magshell.shell.state import State
from magshell.units import MOMENT, Dimension


@dataclass(frozen=True, eq=False)
class Moment(TotalLoad):
    """A moment on the micro-rotations of a group; on the directors where the shell has no micro-rotation.

    Parameters
    ----------
    group : str
        A group of nodes, edges or elements, as for `Force`; nodes without rotation get none of it.
    total : array_like, shape (3,)
        N m.
    follower : bool, optional
        Whether it turns with the micro-rotations of its nodes. By default its axis is fixed in space.
    history : sequence of float, optional
        Multiplier at the end of each stage; by default 1 at the end of the first and from then on.
    """

    kind: ClassVar[str] = "moment"
    keys: ClassVar[Mapping[str, Key]] = {
        "group": GROUP,
        "total": Key("MomentVector", "Its sum over the group."),
        "follower": FOLLOWER,
        "history": HISTORY,
    }
    amount: ClassVar[tuple[str, Dimension]] = ("total", MOMENT)
    letter: ClassVar[str] = "$M$"
    axial: ClassVar[bool] = True

    group: str
    total: ArrayLike
    follower: bool = False
    history: Sequence[float] | None = None

    def applied(self, shell: Shell, rows: Rows) -> Applied:
        """The load on a mesh."""
        with self.located():
            if self.follower and not shell.micro_rotation:
                raise InputError(
                    "a follower turns with the micro-rotation, which this shell does not have; leave follower out: "
                    "the moment then works on the director, about an axis fixed in space"
                )
            parts = shares(shell, self.group, "omega" if shell.micro_rotation else "w")
            moments = parts[:, None] * vector("total", self.total)
        if not shell.micro_rotation:
            return _DirectorMoments(moments, rows.normals[: len(moments)])
        return _TurningCouples(moments) if self.follower else _DeadCouples(moments)

    def size(self, forces: FloatArray) -> Size:
        """Its total."""
        return Size(moment=float(np.linalg.norm(self.value)))


@dataclass(frozen=True, eq=False)
class _Moments:
    """Moments (nodes, 3), N m; those that turn, of the unrotated nodes."""

    moments: FloatArray

    @property
    def conservative(self) -> bool:
        return False

    @property
    def _nodes(self) -> IntArray:
        return np.flatnonzero(np.any(self.moments, axis=1))


class _DeadCouples(_Moments):
    @property
    def pairs(self) -> Pairs | None:
        return None

    def forces(self, state: State) -> FloatArray:
        """The same at every state."""
        return nodal("omega", self.moments)

    def stiffness(self, state: State) -> FloatArray:
        """None."""
        return np.zeros((0, 3, 3))


class _TurningCouples(_Moments):
    @property
    def pairs(self) -> Pairs:
        return Pairs("omega", "omega", self._nodes, self._nodes)

    def _turned(self, state: State) -> FloatArray:
        return np.einsum("nij,nj->ni", rotation.matrix(state.q[: len(self.moments)]), self.moments)

    def forces(self, state: State) -> FloatArray:
        """c = R̃ C on the spin."""
        return nodal("omega", self._turned(state))

    def stiffness(self, state: State) -> FloatArray:
        """[c]×."""
        return cross_matrix(self._turned(state)[self._nodes])


@dataclass(frozen=True, eq=False)
class _DirectorMoments(_Moments):
    normals: FloatArray

    @property
    def pairs(self) -> Pairs:
        return Pairs("w", "w", self._nodes, self._nodes)

    def forces(self, state: State) -> FloatArray:
        """M × d / |d|² on w."""
        d = self.normals + state.w[: len(self.normals)]
        return nodal("w", rotation.cross(self.moments, d) / np.sum(d * d, axis=1, keepdims=True))

    def stiffness(self, state: State) -> FloatArray:
        """-[M]× (I - 2 n ⊗ n) / |d|²."""
        d = self.normals[self._nodes] + state.w[self._nodes]
        square = np.sum(d * d, axis=1)[:, None, None]
        reflection = np.eye(3) - 2.0 * d[:, :, None] * d[:, None, :] / square
        return -cross_matrix(self.moments[self._nodes]) @ reflection / square
