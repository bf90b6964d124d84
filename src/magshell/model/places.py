"""Places that supports hold: nodes of the mesh, rigid bodies, jumps between cells, by the names of all these."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.errors import InputError, suggest
from magshell.mesh import Mesh
from magshell.model.images import Images
from magshell.model.repeated import Periodic
from magshell.model.rigid_body import RigidBody, members_of
from magshell.model.support import Condition


def check_name(name: str, mesh: Mesh, bodies: Sequence[RigidBody], jumps: Sequence[Periodic]) -> None:
    """Refuse what is the name of no group, where rigid bodies and jumps have names too."""
    names = [*mesh.groups, *(body.name for body in bodies), *(jump.name for jump in jumps)]
    if (bodies or jumps) and name not in names:
        what = " or ".join(["group", *["rigid body"] * bool(bodies), *["jump"] * bool(jumps)])
        raise InputError(f"There is no {what} '{name}'. {suggest(name, names)}")


class Places(NamedTuple):
    """Nodes, bodies and jumps.

    Attributes
    ----------
    mesh : Mesh
    carriers : mapping of str to (places,) ndarray of bool
        Which of them carry the fields u, w, phi and omega.
    bodies : tuple of RigidBody
    jumps : tuple of Periodic
    images : Images, optional
        None: no node is the image of another.
    """

    mesh: Mesh
    carriers: Mapping[str, AnyArray]
    bodies: tuple[RigidBody, ...] = ()
    jumps: tuple[Periodic, ...] = ()
    images: Images | None = None

    @property
    def number(self) -> int:
        """Number of places."""
        return len(self.mesh.points) + len(self.bodies) + len(self.jumps)

    @property
    def points(self) -> FloatArray:
        """Positions (places, 3) of nodes and reference points, m; periods of jumps."""
        bodies = [body.reference_point(self.mesh)[None] for body in self.bodies]
        return np.concatenate([self.mesh.points, *bodies, *(jump.period(self.mesh)[None] for jump in self.jumps)])

    @property
    def owner(self) -> IntArray:
        """Place (nodes,) of the body that each node belongs to; -1 for none."""
        owner = members_of(self.mesh, self.bodies)
        return np.where(owner >= 0, owner + len(self.mesh.points), -1)

    @property
    def _beyond(self) -> list[RigidBody | Periodic]:
        """What has the places after the nodes."""
        return [*self.bodies, *self.jumps]

    def is_body(self, name: str) -> bool:
        """Whether a rigid body or a jump has this name."""
        return any(one.name == name for one in self._beyond)

    def named(self, name: str) -> IntArray:
        """Place of the body or jump of this name, or the nodes of the group.

        Raises
        ------
        InputError
            There is neither.
        """
        for number, one in enumerate(self._beyond):
            if one.name == name:
                return np.array([len(self.mesh.points) + number])
        check_name(name, self.mesh, self.bodies, self.jumps)
        return self.mesh.nodes_of(name)

    def words(self, place: int) -> str:
        """A place in messages."""
        nodes = len(self.mesh.points)
        return f"node {place}" if place < nodes else self._beyond[place - nodes].label

    def rooted(self, condition: Condition, members: IntArray) -> Iterator[tuple[int, FloatArray]]:
        """Places and directions that a condition on some places holds: of images of others at their roots.

        u of a node beyond a jump is left to `level_jumps`.
        """
        nodes = len(self.mesh.points)
        for place in members.tolist():
            if self.images is None or place >= nodes or self.images.root[place] == place:
                yield place, condition.direction
            elif condition.field != "u" or not self.images.steps[place].any():
                yield int(self.images.root[place]), condition.direction @ self.images.rotation[place]

    def level_jumps(self, condition: Condition, members: IntArray) -> IntArray:
        """Places of the jumps that have no component along a condition on u, which holds both sides alike.

        Raises
        ------
        InputError
            It holds a node beyond a jump, and not the one on the other side.
        """
        level: set[int] = set()
        if condition.field != "u" or self.images is None or not self.jumps:
            return np.empty(0, dtype=np.int64)
        members = members[members < len(self.mesh.points)]
        for node in members[self.images.steps[members].any(axis=1)].tolist():
            root, stepped = int(self.images.root[node]), np.flatnonzero(self.images.steps[node])
            if root not in members or (len(stepped) > 1 and not level.issuperset(stepped.tolist())):
                names = " and ".join(repr(self.jumps[number].name) for number in stepped)
                raise InputError(
                    f"support on '{condition.group}': node {node} follows node {root} on the other side of the cell "
                    f"with a jump; hold both, or that node and the jump by its name, {names}"
                )
            level.add(int(stepped[0]))
        return self.number - len(self.jumps) + np.array(sorted(level), dtype=np.int64)
