"""Places that supports hold: nodes of the mesh and, after them, rigid bodies, by the names of groups and bodies."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.errors import InputError, suggest
from magshell.mesh import Mesh
from magshell.model.rigid_body import RigidBody, members_of


class Places(NamedTuple):
    """Nodes and bodies.

    Attributes
    ----------
    mesh : Mesh
    carriers : mapping of str to (places,) ndarray of bool
        Which of them carry the fields u, w, phi and omega.
    bodies : tuple of RigidBody
    """

    mesh: Mesh
    carriers: Mapping[str, AnyArray]
    bodies: tuple[RigidBody, ...] = ()

    @property
    def number(self) -> int:
        """Number of places."""
        return len(self.mesh.points) + len(self.bodies)

    @property
    def points(self) -> FloatArray:
        """Positions (places, 3) of nodes and reference points, m."""
        return np.concatenate([self.mesh.points, *(body.reference_point(self.mesh)[None] for body in self.bodies)])

    @property
    def owner(self) -> IntArray:
        """Place (nodes,) of the body that each node belongs to; -1 for none."""
        owner = members_of(self.mesh, self.bodies)
        return np.where(owner >= 0, owner + len(self.mesh.points), -1)

    def is_body(self, name: str) -> bool:
        """Whether a rigid body has this name."""
        return any(body.name == name for body in self.bodies)

    def named(self, name: str) -> IntArray:
        """Place of the body of this name, or the nodes of the group.

        Raises
        ------
        InputError
            There is neither.
        """
        for number, body in enumerate(self.bodies):
            if body.name == name:
                return np.array([len(self.mesh.points) + number])
        if self.bodies and name not in self.mesh.groups:
            names = [*self.mesh.groups, *(body.name for body in self.bodies)]
            raise InputError(f"There is no group or rigid body '{name}'. {suggest(name, names)}")
        return self.mesh.nodes_of(name)

    def words(self, place: int) -> str:
        """A place in messages."""
        nodes = len(self.mesh.points)
        return f"node {place}" if place < nodes else self.bodies[place - nodes].label
