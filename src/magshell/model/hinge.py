"""Hinges: edges along which sheets may turn against each other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from magshell.arrays import IntArray
from magshell.errors import InputError, suggest
from magshell.mesh import Mesh


@dataclass(frozen=True)
class Hinge:
    """An edge along which the elements on its sides share their displacement and nothing else.

    Parameters
    ----------
    group : str
        Group of edges, each shared by two or more elements.
    stiffness : float, optional
        Of a torsion spring along the edge, N m/rad per m: it resists a change of the angle between neighbouring sides.
        By default the hinge turns freely.

    Raises
    ------
    InputError
        The stiffness is negative or not finite.
    """

    group: str
    stiffness: float = 0.0

    def __post_init__(self) -> None:
        if not isinstance(self.stiffness, int | float | np.number) or not 0.0 <= self.stiffness < np.inf:
            raise InputError(f"{self.label}: stiffness is {self.stiffness!r}; it must be a number, 0 or positive")

    @property
    def label(self) -> str:
        """Its name in messages."""
        return f"hinge on '{self.group}'"

    def edges(self, mesh: Mesh) -> IntArray:
        """Its edges (n, 3): ends and middle.

        Raises
        ------
        InputError
            The group is unknown, or none of edges.
        """
        if self.group not in mesh.edge_groups:
            what = "it is no group of edges" if self.group in mesh.groups else "there is no such group of edges"
            raise InputError(f"{self.label}: {what}. {suggest(self.group, mesh.edge_groups)}")
        return mesh.edge_groups[self.group]
