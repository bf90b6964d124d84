"""A dead force per area."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from numpy.typing import ArrayLike

from magshell.arrays import FloatArray
from magshell.model.loads.checks import keep_history, located, vector
from magshell.model.loads.dead import DeadForces
from magshell.model.loads.distribution import nodal_areas
from magshell.model.loads.load import Applied
from magshell.model.shell import Shell


@dataclass(frozen=True, eq=False)
class Traction:
    """A force per area of the undeformed mid-surface, which keeps its direction.

    Parameters
    ----------
    group : str
        A group of elements.
    traction : array_like, shape (3,)
        Pa.
    history : sequence of float, optional
        Multiplier at the end of each stage; by default 1 at the end of the first and from then on.
    """

    kind: ClassVar[str] = "traction"

    group: str
    traction: ArrayLike
    history: Sequence[float] | None = None

    def __post_init__(self) -> None:
        keep_history(self)

    def applied(self, shell: Shell, normals: FloatArray) -> Applied:
        """The load on a mesh."""
        with located(self):
            areas = nodal_areas(shell, shell.mesh.elements_of(self.group))
            return DeadForces(areas[:, None] * vector("traction", self.traction))
