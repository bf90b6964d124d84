"""Dead loads: constant magnitude and direction."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from magshell.arrays import FloatArray
from magshell.model.loads.load import Pairs
from magshell.shell.state import State
from magshell.shell.unknowns import COLUMNS, COMPONENTS


def nodal(field: str, vectors: FloatArray) -> FloatArray:
    """Nodal columns (nodes, 11) with these vectors (nodes, 3) on one field."""
    columns = np.zeros((len(vectors), COMPONENTS))
    columns[:, COLUMNS[field]] = vectors
    return columns


@dataclass(frozen=True, eq=False)
class DeadForces:
    """Constant forces on displacements and directors; their potential is minus forces · u, and likewise for w.

    Attributes
    ----------
    on_u : ndarray, shape (nodes, 3)
        N.
    on_w : ndarray, shape (nodes, 3), optional
        N m.
    """

    on_u: FloatArray
    on_w: FloatArray | None = None

    @property
    def conservative(self) -> bool:
        return True

    @property
    def pairs(self) -> Sequence[Pairs]:
        return ()

    def forces(self, state: State) -> FloatArray:
        """The same at every state."""
        forces = nodal("u", self.on_u)
        return forces if self.on_w is None else forces + nodal("w", self.on_w)

    def stiffness(self, state: State) -> list[FloatArray]:
        """None."""
        return []
