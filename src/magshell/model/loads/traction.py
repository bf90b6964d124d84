"""A dead force per area."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import FloatArray
from magshell.keys import HISTORY, Key
from magshell.model.loads.checks import vector
from magshell.model.loads.dead import DeadForces
from magshell.model.loads.distribution import nodal_areas
from magshell.model.loads.load import Applied, Load, Size, resultant
from magshell.model.rows import Rows
from magshell.model.shell import Shell
from magshell.units import STRESS, Dimension


@dataclass(frozen=True, eq=False)
class Traction(Load):
    """A force per area of the undeformed mid-surface, which keeps its direction.

    Parameters
    ----------
    group : str or None
        A group of elements; None: the whole shell.
    traction : array_like, shape (3,)
        Pa.
    history : sequence of float, optional
        Multiplier at the end of each stage; by default 1 at the end of the first and from then on.
    """

    kind: ClassVar[str] = "traction"
    keys: ClassVar[Mapping[str, Key]] = {
        "group": Key("Name", "Group of elements that it acts on.", "the whole shell"),
        "traction": Key("StressVector", "Force per area of the undeformed mid-surface."),
        "history": HISTORY,
    }
    amount: ClassVar[tuple[str, Dimension]] = ("traction", STRESS)
    letter: ClassVar[str] = "$t$"
    on: ClassVar[Literal["nodes", "elements"]] = "elements"

    group: str | None
    traction: ArrayLike
    history: Sequence[float] | None = None

    def applied(self, shell: Shell, rows: Rows) -> Applied:
        """The load on a mesh."""
        with self.located():
            areas = nodal_areas(shell, self.members(shell))
            return DeadForces(areas[:, None] * vector("traction", self.traction))

    def size(self, forces: FloatArray) -> Size:
        """Its resultant."""
        return Size(force=float(np.linalg.norm(resultant(forces))))
