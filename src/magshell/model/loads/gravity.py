"""Weight.

Per unit mass the acceleration g does the work g · δx. The shell's mass is that of its undeformed volume, the change of
area across the thickness of a curved shell included. It acts on the mid-surface: left out is its first moment about
that, which puts the centre of mass off it by h²/12 times the sum of the two curvatures.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import FloatArray
from magshell.errors import InputError
from magshell.model.loads.checks import keep_history, located, vector
from magshell.model.loads.dead import DeadForces
from magshell.model.loads.distribution import nodal_volumes
from magshell.model.loads.load import Applied
from magshell.model.shell import Shell


@dataclass(frozen=True, eq=False)
class Gravity:
    """The weight of the shell, whose `density` it needs.

    Parameters
    ----------
    acceleration : array_like, shape (3,)
        m/s².
    group : str, optional
        A group of elements that has weight; by default all.
    history : sequence of float, optional
        Multiplier at the end of each stage; by default 1 at the end of the first and from then on.
    """

    kind: ClassVar[str] = "gravity"

    acceleration: ArrayLike
    group: str | None = None
    history: Sequence[float] | None = None

    def __post_init__(self) -> None:
        keep_history(self)

    def applied(self, shell: Shell, normals: FloatArray) -> Applied:
        """The load on a mesh."""
        if shell.density is None:
            raise InputError("shell: density is missing; gravity needs it")
        with located(self):
            acceleration = vector("acceleration", self.acceleration)
            members = np.arange(len(shell.mesh.elements))
            if self.group is not None:
                members = shell.mesh.elements_of(self.group)
        masses = shell.density * nodal_volumes(shell, normals, members)
        return DeadForces(masses[:, None] * acceleration)
