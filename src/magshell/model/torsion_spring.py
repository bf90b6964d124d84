"""Torsion springs on rigid bodies: ½ k ψ² of the angle ψ by which a body has turned about an axis (`twist.py`)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import FloatArray, IntArray
from magshell.errors import InputError
from magshell.keys import Key
from magshell.model.checked import three_numbers
from magshell.model.elastic import Anchored, ElasticSupport
from magshell.model.loads.dead import nodal
from magshell.model.loads.load import Pairs
from magshell.model.places import Places
from magshell.model.shell import Shell
from magshell.model.support import REACTION
from magshell.model.twist import twist, twist_slope
from magshell.shell.state import State
from magshell.units import ANGULAR_STIFFNESS, show
from magshell.wording import vector


@dataclass(frozen=True, eq=False)
class TorsionSpring(ElasticSupport):
    """A torsion spring on a rigid body, about an axis that is fixed in space.

    It resists the angle by which the body has turned about the axis, up to two turns.

    Parameters
    ----------
    group : str
        Name of the rigid body.
    stiffness : float
        N m/rad.
    axis : array_like, shape (3,)
        Its axis.
    name, point
        As of `Spring`.
    """

    kind: ClassVar[str] = "torsion"
    keys: ClassVar[Mapping[str, Key]] = {
        "group": Key("Name", "Name of the rigid body that the spring holds."),
        "stiffness": Key("AngularStiffness", "Moment per angle of the body about the axis."),
        "axis": Key("Direction", "Of the spring, fixed in space."),
        "name": Key("Name", "Of the reaction in the results.", "the body"),
        "point": Key("Position", REACTION["point"].meaning, "the body's reference point"),
    }

    group: str
    stiffness: float
    axis: ArrayLike

    def applied(self, shell: Shell, places: Places) -> Anchored:
        """The spring on the rigid body."""
        with self.located():
            places.named(self.group)
            if not places.is_body(self.group):
                raise InputError("it is no rigid body; a torsion spring acts on the rotation of one")
            if not isinstance(self.stiffness, int | float | np.number) or not 0.0 < self.stiffness < np.inf:
                raise InputError(f"stiffness is {self.stiffness!r}; it must be positive and finite")
        weights = np.zeros(places.number)
        weights[places.named(self.group)] = 1.0
        about = None if self.point is None else three_numbers(self.label, "point", self.point)
        return _Torsion(places.named(self.group), float(self.stiffness), self.along[None], weights, about)

    @property
    def along(self) -> FloatArray:
        """The axis, of length 1."""
        axis = three_numbers(self.label, "axis", self.axis)
        if not np.any(axis):
            raise InputError(f"{self.label}: axis is {self.axis!r}; it must not be zero")
        return axis / np.linalg.norm(axis)

    def words(self, shell: Shell) -> str:
        """Stiffness and axis."""
        return f"{show(self.stiffness, ANGULAR_STIFFNESS)} about {vector(np.ravel(self.axis))}"

    @property
    def legend(self) -> str:
        """With the stiffness."""
        return f"torsion spring, {show(self.stiffness, ANGULAR_STIFFNESS)}"


@dataclass(frozen=True, eq=False)
class _Torsion:
    """Springs on the spins of rows (n,) about axes (n, 3); stiffness in N m/rad. See `twist.py`."""

    rows: IntArray
    stiffness_of: float
    axes: FloatArray
    weights: FloatArray
    about: FloatArray | None

    @property
    def conservative(self) -> bool:
        return True

    @property
    def pairs(self) -> Sequence[Pairs]:
        return (Pairs("omega", "omega", self.rows, self.rows),)

    def forces(self, state: State) -> FloatArray:
        """-k ψ g on the spins."""
        ψ, g = twist(state.q[self.rows], self.axes)
        couples = np.zeros_like(state.u)
        couples[self.rows] = -self.stiffness_of * ψ[:, None] * g
        return nodal("omega", couples)

    def stiffness(self, state: State) -> list[FloatArray]:
        """k (g ⊗ g + ψ dg/dΩ)."""
        ψ, g = twist(state.q[self.rows], self.axes)
        change = ψ[:, None, None] * twist_slope(state.q[self.rows], self.axes)
        return [self.stiffness_of * (g[:, :, None] * g[:, None, :] + change)]

    def energy(self, state: State) -> float:
        """½ Σ k ψ²."""
        return 0.5 * self.stiffness_of * float(np.sum(twist(state.q[self.rows], self.axes)[0] ** 2))
