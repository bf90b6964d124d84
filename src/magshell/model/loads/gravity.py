"""Weight.

Per unit mass the acceleration g does the work g · δx. The shell's mass is that of its undeformed volume, the change of
area across the thickness of a curved shell included (`mass.py`). Where layers or an offset put it off the mesh, it acts
at its height, and so on the director too. Left out is what curvature adds to that, which puts the centre of mass
of a plain shell off its mid-surface by h²/12 times the sum of the two curvatures.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import FloatArray, IntArray
from magshell.keys import HISTORY, Key
from magshell.mesh.geometry import centres
from magshell.model.loads.checks import vector
from magshell.model.loads.dead import DeadForces
from magshell.model.loads.load import Applied, Arrows, Load, Size, amid, resultant
from magshell.model.loads.mass import nodal_masses
from magshell.model.rows import Rows
from magshell.model.shell import Shell
from magshell.units import ACCELERATION, FORCE, Dimension
from magshell.wording import quantity


@dataclass(frozen=True, eq=False)
class Gravity(Load):
    """The weight of the shell, whose `density` it needs.

    Parameters
    ----------
    acceleration : array_like, shape (3,)
        m/s².
    group : str, optional
        A group of elements that has weight, or a rigid body with a mass; where they have one name, both. By default
        all.
    history : sequence of float, optional
        Multiplier at the end of each stage; by default 1 at the end of the first and from then on.
    """

    kind: ClassVar[str] = "gravity"
    keys: ClassVar[Mapping[str, Key]] = {
        "acceleration": Key("AccelerationVector", "Of free fall."),
        "group": Key("Name", "Group of elements that has weight, or rigid body with a mass.", "the whole shell"),
        "history": HISTORY,
    }
    amount: ClassVar[tuple[str, Dimension]] = ("acceleration", ACCELERATION)
    letter: ClassVar[str] = "$g$"
    on: ClassVar[Literal["nodes", "elements"]] = "elements"

    acceleration: ArrayLike
    group: str | None = None
    history: Sequence[float] | None = None

    def applied(self, shell: Shell, rows: Rows) -> Applied:
        """The load on a mesh."""
        with self.located():
            acceleration = vector("acceleration", self.acceleration)
            members = self.members(shell)
        masses = nodal_masses(shell, rows, members)
        for number, one in enumerate(shell.rigid):
            if self.group in (None, one.name):
                masses.on_u[rows.nodes + number] += one.mass
        return DeadForces(*(mass[:, None] * acceleration for mass in masses))

    def members(self, shell: Shell) -> IntArray:
        """The elements that have weight: of the group, none of a rigid body that is no group of this name."""
        if shell.body_row(self.group) is not None and self.group not in shell.mesh.element_groups:
            return np.empty(0, dtype=np.int64)
        return super().members(shell)

    def words(self, shell: Shell, forces: FloatArray) -> str:
        """Acceleration and weight."""
        return f"{self.given}, weight {quantity(resultant(forces), FORCE)}"

    def size(self, forces: FloatArray) -> Size:
        """The weight."""
        return Size(weight=float(np.linalg.norm(resultant(forces))))

    def arrows(self, shell: Shell, forces: FloatArray) -> Arrows:
        """One, amid the elements, or at the rigid body."""
        bodies = [one.reference_point(shell.mesh) for one in shell.rigid if one.name == self.group]
        middles = np.array(bodies) if bodies else centres(shell.mesh.points, shell.mesh.elements[self.members(shell)])
        return Arrows(amid(middles), np.array([self.value]), f"{self.kind}, {self.magnitude}")

    def beyond(self, at_nodes: bool, at_elements: bool) -> str:
        """Weight acts on both halves wherever the plane is."""
        return "the other half would weigh another way"
