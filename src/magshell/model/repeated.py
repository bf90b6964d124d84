"""A part that stands for a structure of many alike: a sector of a rosette, a cell of a sheet that repeats."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from magshell.arrays import FloatArray, IntArray
from magshell.errors import InputError
from magshell.keys import Key
from magshell.mesh import Mesh
from magshell.mesh.geometry import COINCIDENT
from magshell.model.checked import three_numbers
from magshell.wording import place

EDGE = Key("Name", "Group of edges or nodes where the part meets one of its copies.")
IMAGE = Key("Name", "Group where it meets the other: the copy of the first group, node by node.")


@dataclass(frozen=True, eq=False)
class Repeated(ABC):
    """A rigid motion that takes the modelled part to its neighbour, and with it the deformation: a frozen dataclass.

    Attributes
    ----------
    kind : str
        Its name in problem files.
    keys : mapping of str to Key
        Its parameters.
    group, image : str
        Where the part meets its neighbours; the motion takes the first to the second.
    """

    kind: ClassVar[str]
    keys: ClassVar[Mapping[str, Key]]

    group: str
    image: str

    @property
    def label(self) -> str:
        """Its name in messages."""
        return f"repeated from '{self.group}' to '{self.image}'"

    @abstractmethod
    def rotation(self, mesh: Mesh) -> FloatArray:
        """Of the motion, (3, 3)."""

    @abstractmethod
    def moved(self, mesh: Mesh, points: FloatArray) -> FloatArray:
        """Images of points (n, 3), m."""

    def of_the_whole(self, force: FloatArray, moment: FloatArray) -> tuple[FloatArray, FloatArray]:
        """What is left of a force and a moment about the origin, (3,), in the mean over all copies."""
        return force, moment

    @property
    @abstractmethod
    def words(self) -> str:
        """The motion in `magshell check`."""

    def nodes(self, mesh: Mesh) -> tuple[IntArray, IntArray]:
        """Nodes (n,) of the group and of the image, pair by pair.

        Raises
        ------
        InputError
            A group is unknown, or the image of a node is no node of the other group.
        """
        one, other = self._members(mesh, self.group), self._members(mesh, self.image)
        if len(one) != len(other):
            raise InputError(
                f"{self.label}: '{self.group}' has {len(one)} nodes and '{self.image}' {len(other)}; mesh both alike"
            )
        places = self.moved(mesh, mesh.points[one])
        found = cKDTree(mesh.points[other]).query(places)
        distance, nearest = np.asarray(found[0]), np.asarray(found[1])
        worst = int(np.argmax(distance))
        if distance[worst] > COINCIDENT * mesh.size:
            raise InputError(
                f"{self.label}: node {one[worst]} of '{self.group}', {self.words}, comes to {place(places[worst])}, "
                f"and the nearest node of '{self.image}', {other[nearest[worst]]}, is "
                f"{1e3 * distance[worst]:.3g} mm away; mesh both alike, and check the motion"
            )
        if len(np.unique(nearest)) < len(nearest):
            twice = int(other[np.argmax(np.bincount(nearest))])
            raise InputError(f"{self.label}: node {twice} of '{self.image}' is the image of several nodes")
        return one, other[nearest]

    def _members(self, mesh: Mesh, name: str) -> IntArray:
        try:
            return np.unique(mesh.nodes_of(name))
        except InputError as error:
            raise InputError(f"{self.label}: {error}") from None


@dataclass(frozen=True, eq=False)
class Cyclic(Repeated):
    """A sector that stands for a structure of several around an axis.

    Parameters
    ----------
    group, image : str
        Groups of edges or nodes: the two sides of the sector. Nodes on the axis belong to both.
    sectors : int
        Number of sectors that make the whole.
    axis : array_like, shape (3,), optional
        Direction of the axis; by default X3.
    point : array_like, shape (3,), optional
        Point on the axis, m; by default the origin.

    Raises
    ------
    InputError
        A value is out of its range.
    """

    kind: ClassVar[str] = "cyclic"
    keys: ClassVar[Mapping[str, Key]] = {
        "group": EDGE,
        "image": IMAGE,
        "sectors": Key("Count", "Number of sectors that make the whole."),
        "axis": Key("Direction", "Of the axis.", "$X_3$"),
        "point": Key("Position", "On the axis.", "the origin"),
    }

    sectors: int = field(kw_only=True)
    axis: ArrayLike = (0.0, 0.0, 1.0)
    point: ArrayLike = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        if not isinstance(self.sectors, int | np.integer) or isinstance(self.sectors, bool) or self.sectors < 2:
            raise InputError(f"{self.label}: sectors is {self.sectors!r}; it must be a whole number, 2 or more")
        axis = three_numbers(self.label, "axis", self.axis)
        if not np.any(axis):
            raise InputError(f"{self.label}: axis is {self.axis!r}; its length must not be zero")
        object.__setattr__(self, "axis", axis / np.linalg.norm(axis))
        object.__setattr__(self, "point", three_numbers(self.label, "point", self.point))

    @property
    def words(self) -> str:
        """The angle between neighbours."""
        return f"turned by {360.0 / self.sectors:.4g}°"

    def rotation(self, mesh: Mesh) -> FloatArray:
        """By the angle of a sector, in the sense in which the group comes nearer to the image."""
        from_axis = [
            mesh.points[self._members(mesh, name)].mean(axis=0) - np.asarray(self.point)
            for name in (self.group, self.image)
        ]
        axis, angle = np.asarray(self.axis), 2.0 * np.pi / self.sectors
        turns = [Rotation.from_rotvec(sign * angle * axis).as_matrix() for sign in (1.0, -1.0)]
        return min(turns, key=lambda turn: float(np.linalg.norm(turn @ from_axis[0] - from_axis[1])))

    def of_the_whole(self, force: FloatArray, moment: FloatArray) -> tuple[FloatArray, FloatArray]:
        """See `Repeated`: the parts along the axis, of the moment about a point on it."""
        axis, point = np.asarray(self.axis), np.asarray(self.point)
        along = (force @ axis) * axis
        return along, ((moment - np.cross(point, force)) @ axis) * axis + np.cross(point, along)

    def moved(self, mesh: Mesh, points: FloatArray) -> FloatArray:
        """See `Repeated`."""
        point = np.asarray(self.point)
        return point + (points - point) @ self.rotation(mesh).T


@dataclass(frozen=True, eq=False)
class Periodic(Repeated):
    """A cell that stands for a sheet or a strip of many in a row, all deformed alike.

    The displacement of the image is that of the group and a *jump* that all its nodes share. It has the name of the
    repetition: supports hold or prescribe its components, loads act on it. By default it is free: the sheet stretches
    as it likes.

    Parameters
    ----------
    group, image : str
        Groups of edges or nodes: two opposite sides of the cell.
    name : str, optional
        Of the jump; by default those of the groups, "group-image".

    Raises
    ------
    InputError
        A value is out of its range.
    """

    kind: ClassVar[str] = "periodic"
    keys: ClassVar[Mapping[str, Key]] = {
        "group": EDGE,
        "image": IMAGE,
        "name": Key("Name", "Of the jump of the displacement.", "`group-image`"),
    }

    name: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "name", self.name or f"{self.group}-{self.image}")

    @property
    def words(self) -> str:
        """What it is."""
        return "moved to the next cell"

    def rotation(self, mesh: Mesh) -> FloatArray:
        """None."""
        return np.eye(3)

    def moved(self, mesh: Mesh, points: FloatArray) -> FloatArray:
        """See `Repeated`."""
        return points + self.period(mesh)

    def period(self, mesh: Mesh) -> FloatArray:
        """Translation (3,) from the group to the image, m."""
        one, other = (mesh.points[self._members(mesh, name)] for name in (self.group, self.image))
        return np.asarray(other.mean(axis=0) - one.mean(axis=0))


REPEATED: dict[str, type[Repeated]] = {one.kind: one for one in (Cyclic, Periodic)}
"""The repetitions that problem files know, by their kind."""
