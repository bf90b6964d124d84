r"""A moment with a total over a group, on the sections of its nodes.

A section turns with its director d = D + w, so that with δω the spin of the section δd = δω × d + (δ|d|) n, n = d/|d|.
This leaves the drill n · δω open, which is the micro-rotation's. So a moment M at a node does the work

    M · δω = f · δw + c · δϑ,      f = M × d / |d|²,      c = (M · n) n,

with the spin ϑ of the micro-rotation: what is normal to the director bends and twists the section by opposite forces on
its two faces, what is along it turns the section in its plane. The torque of both is d × f + c = M, at any state.
The derivatives are, with S = (I - 2 n ⊗ n) / |d|²,

    ∂f/∂d = [M]× S,      ∂c/∂d = d ⊗ M / |d|² + (M · d) S.

M is dead (its axis and magnitude stay) or turns with the node, M = R̃ M_0, where dM = ϑ × M adds

    ∂f/∂ϑ = [d]× [M]× / |d|²,      ∂c/∂ϑ = -n ⊗ n [M]×.

Neither has a potential: over rotations about several axes, the work of a moment about an axis fixed in space or in the
body depends on their order.

A shell without micro-rotation has f alone: its directors do not feel a drill. A moment along them is refused; what
comes along them as the shell deforms is without effect.
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
from magshell.model.loads.dead import nodal
from magshell.model.loads.distribution import shares
from magshell.model.loads.load import Applied, Pairs, Size
from magshell.model.loads.total import FOLLOWER, GROUP, TotalLoad
from magshell.model.rows import Rows
from magshell.model.shell import Shell
from magshell.shell import rotation
from magshell.shell.state import State
from magshell.units import MOMENT, Dimension
from magshell.wording import place

# Sine of the angle from a plane below which a moment is in it: normals are known to the rounding of files.
IN_PLANE = 1e-4


@dataclass(frozen=True, eq=False)
class Moment(TotalLoad):
    """A moment on the sections of a group.

    What it has normal to a director works on that, what it has along it on the micro-rotation. A shell without
    micro-rotation takes moments in its surface only.

    Parameters
    ----------
    group : str
        A group of nodes, edges or elements, or a rigid body, as for `Force`; nodes without rotation get none of it.
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
            instance("follower", self.follower, (bool, np.bool_), "True or False")
            if self.follower and not shell.micro_rotation:
                raise InputError(
                    "a follower turns with the micro-rotation, which this shell does not have; leave follower out: "
                    "the moment then works on the director, about an axis fixed in space"
                )
            total, normals, body = vector("total", self.total), rows.normals[: rows.nodes], shell.body_row(self.group)
            if body is not None:
                return (_TurningCouple if self.follower else _Couple)(body, total)
            moments = shares(shell, self.group, "w")[:, None] * total
            nodes = np.flatnonzero(np.any(moments, axis=1))
            if not shell.micro_rotation:
                _check_no_drill(shell, nodes, normals[nodes], total)
                return _DirectorMoments(nodes, moments[nodes], normals)
        return (_TurningMoments if self.follower else _SectionMoments)(nodes, moments[nodes], normals)

    def size(self, forces: FloatArray) -> Size:
        """Its total."""
        return Size(moment=float(np.linalg.norm(self.value)))


def _check_no_drill(shell: Shell, nodes: IntArray, normals: FloatArray, total: FloatArray) -> None:
    """Refuse a moment that has a part along the director of one of its nodes."""
    along = np.abs(normals @ total) / np.linalg.norm(total)
    worst = int(np.argmax(along))
    if along[worst] > IN_PLANE:
        raise InputError(
            f"{along[worst]:.3g} of it is along the normal at node {nodes[worst]} at "
            f"{place(shell.mesh.points[nodes[worst]])}, and without "
            "micro-rotation nothing resists a turn about the normal; leave out micro_rotation = false, or let forces "
            "on parts of the group make up this moment"
        )


@dataclass(frozen=True, eq=False)
class _DirectorMoments:
    """Moments (n, 3) of some nodes, N m, those that turn of the unrotated nodes; unit normals (nodes, 3) of all."""

    nodes: IntArray
    moments: FloatArray
    normals: FloatArray

    @property
    def conservative(self) -> bool:
        return False

    @property
    def pairs(self) -> Sequence[Pairs]:
        return (Pairs("w", "w", self.nodes, self.nodes),)

    def acting(self, state: State) -> tuple[FloatArray, FloatArray]:
        """Moments and directors (n, 3)."""
        return self.moments, self.normals[self.nodes] + state.w[self.nodes]

    def forces(self, state: State) -> FloatArray:
        """Forces f on w."""
        M, d = self.acting(state)
        return self._nodal("w", rotation.cross(M, d) / _square(d))

    def stiffness(self, state: State) -> list[FloatArray]:
        """That of f over w."""
        M, d = self.acting(state)
        return [-cross_matrix(M) @ _mirror(d)]

    def _nodal(self, field: str, vectors: FloatArray) -> FloatArray:
        whole = np.zeros_like(self.normals)
        whole[self.nodes] = vectors
        return nodal(field, whole)


class _SectionMoments(_DirectorMoments):
    @property
    def pairs(self) -> Sequence[Pairs]:
        return (*super().pairs, Pairs("omega", "w", self.nodes, self.nodes))

    def forces(self, state: State) -> FloatArray:
        """Forces f on w, couples c on the spin."""
        M, d = self.acting(state)
        drill = np.sum(M * d, axis=1, keepdims=True) / _square(d) * d
        return super().forces(state) + self._nodal("omega", drill)

    def stiffness(self, state: State) -> list[FloatArray]:
        """Also that of c over w."""
        M, d = self.acting(state)
        along = np.sum(M * d, axis=1)[:, None, None]
        return [*super().stiffness(state), -_dyad(d, M) / _square(d)[..., None] - along * _mirror(d)]


class _TurningMoments(_SectionMoments):
    @property
    def pairs(self) -> Sequence[Pairs]:
        spins = (Pairs(field, "omega", self.nodes, self.nodes) for field in ("w", "omega"))
        return (*super().pairs, *spins)

    def acting(self, state: State) -> tuple[FloatArray, FloatArray]:
        """With M = R̃ M_0."""
        M, d = super().acting(state)
        return np.einsum("nij,nj->ni", rotation.matrix(state.q[self.nodes]), M), d

    def stiffness(self, state: State) -> list[FloatArray]:
        """Also those of f and c over spins."""
        M, d = self.acting(state)
        turning = cross_matrix(M) / _square(d)[..., None]
        return [*super().stiffness(state), -cross_matrix(d) @ turning, _dyad(d, d) @ turning]


@dataclass(frozen=True, eq=False)
class _Couple:
    """A moment (3,) on the spin of a rigid body, N m; one that turns, of the unrotated body."""

    row: int
    moment: FloatArray

    @property
    def conservative(self) -> bool:
        return False

    @property
    def pairs(self) -> Sequence[Pairs]:
        return ()

    def acting(self, state: State) -> FloatArray:
        """The moment (3,)."""
        return self.moment

    def forces(self, state: State) -> FloatArray:
        """On the spin of the body."""
        couples = np.zeros_like(state.u)
        couples[self.row] = self.acting(state)
        return nodal("omega", couples)

    def stiffness(self, state: State) -> list[FloatArray]:
        """None: the moment keeps its axis."""
        return []


class _TurningCouple(_Couple):
    @property
    def pairs(self) -> Sequence[Pairs]:
        at = np.array([self.row])
        return (Pairs("omega", "omega", at, at),)

    def acting(self, state: State) -> FloatArray:
        """R M."""
        return np.asarray(rotation.matrix(state.q[self.row]) @ self.moment)

    def stiffness(self, state: State) -> list[FloatArray]:
        """[c]×."""
        return [cross_matrix(self.acting(state)[None])]


def _square(d: FloatArray) -> FloatArray:
    """|d|² (n, 1)."""
    return np.sum(d * d, axis=1, keepdims=True)


def _dyad(a: FloatArray, b: FloatArray) -> FloatArray:
    return a[:, :, None] * b[:, None, :]


def _mirror(d: FloatArray) -> FloatArray:
    """S = (I - 2 n ⊗ n) / |d|² (n, 3, 3)."""
    square = _square(d)[..., None]
    return (np.eye(3) - 2.0 * _dyad(d, d) / square) / square
