"""Rigid bodies: groups of a shell that move as one, with six unknowns at a reference point."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import FloatArray, IntArray
from magshell.errors import InputError
from magshell.mesh import Mesh
from magshell.model.checked import three_numbers


@dataclass(frozen=True, eq=False)
class RigidBody:
    """A group of a shell that moves as one rigid body: displacement, director and micro-rotation of its nodes follow.

    Supports and loads hold, move, turn and load it by its name.

    Parameters
    ----------
    group : str
        Group of nodes, edges or elements. No node may belong to two bodies.
    name : str, optional
        By default the group.
    point : array_like, shape (3,), optional
        Reference point, m: the displacement of the body is that of this point, and forces act on it. By default the
        centroid of the group's nodes.
    moment : array_like, shape (3,), optional
        Magnetic dipole moment in the undeformed configuration, A m²; it turns with the body. By default none.
    mass : float, optional
        At the reference point, kg. By default none.

    Raises
    ------
    InputError
        A value is no number, not finite, or negative.
    """

    group: str
    name: str = ""
    point: ArrayLike | None = None
    moment: ArrayLike = (0.0, 0.0, 0.0)
    mass: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "name", self.name or self.group)
        if self.point is not None:
            object.__setattr__(self, "point", three_numbers(self.label, "point", self.point))
        object.__setattr__(self, "moment", three_numbers(self.label, "moment", self.moment))
        if not isinstance(self.mass, int | float | np.number) or not 0.0 <= self.mass < np.inf:
            raise InputError(f"{self.label}: mass is {self.mass!r}; it must be a number, 0 or positive")

    @property
    def label(self) -> str:
        """Its name in messages."""
        return f"rigid body '{self.name}'"

    def reference_point(self, mesh: Mesh) -> FloatArray:
        """Its reference point (3,), m."""
        if self.point is None:
            return np.asarray(mesh.points[mesh.nodes_of(self.group)].mean(axis=0))
        return np.asarray(self.point)


def members_of(mesh: Mesh, bodies: Sequence[RigidBody]) -> IntArray:
    """Number of the body that each node of a mesh belongs to, -1 for none.

    Raises
    ------
    InputError
        Two bodies have one name, or a node in common; a group is unknown.
    """
    owner = np.full(len(mesh.points), -1)
    for number, body in enumerate(bodies):
        if any(body.name == other.name for other in bodies[:number]):
            raise InputError(f"{body.label}: there are two of this name; give them names of their own")
        try:
            nodes = mesh.nodes_of(body.group)
        except InputError as error:
            raise InputError(f"{body.label}: {error}") from None
        if body.name != body.group and body.name in mesh.groups:
            raise InputError(f"{body.label}: a group of the mesh has this name too; give the body another")
        taken = nodes[owner[nodes] >= 0]
        if taken.size:
            other = bodies[owner[taken[0]]]
            raise InputError(f"{body.label}: node {taken[0]} also belongs to {other.label}; a node moves with one body")
        owner[nodes] = number
    return owner
