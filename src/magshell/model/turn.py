"""Groups that are turned about an axis and moved: they become rigid bodies, and their motion is given."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike

from magshell.errors import InputError
from magshell.keys import HISTORY, Key
from magshell.model.rigid_body import RigidBody
from magshell.model.support import AXES, Condition, Support, frame_about, numbers
from magshell.units import ANGLE, LENGTH
from magshell.wording import quantity, vector


@dataclass(frozen=True)
class Turn(Support):
    """A rigid motion: a group, or a rigid body, turned about an axis by any angle, and moved.

    A group becomes a rigid body of its own: displacement, director and micro-rotation of its nodes follow.

    Parameters
    ----------
    group : str
        Group of nodes, edges or elements, or the name of a rigid body.
    axis : array_like, shape (3,)
        Direction of the axis.
    angle : float, optional
        rad, of any size.
    through : array_like, shape (3,), optional
        Point on the axis, m; by default the centroid of the group's nodes. Of a rigid body it is its reference point.
    translation : array_like, shape (3,), optional
        Displacement of that point, m.
    history : sequence of float, optional
        Multiplier of angle and translation at the end of each stage; by default it grows to 1 in the first and stays.
    """

    kind: ClassVar[str] = "turn"
    keys: ClassVar[Mapping[str, Key]] = {
        "group": Key("Name", "Group of edges, nodes or elements, or the name of a rigid body."),
        "axis": Key("Direction", "Of the axis."),
        "angle": Key("Angle", "By which it is turned; any size.", "0"),
        "through": Key("Position", "Point on the axis.", "the centroid of the group's nodes"),
        "translation": Key("Position", "Displacement of that point.", "none"),
        "history": HISTORY,
    }
    mark: ClassVar[Literal["balls", "cubes"]] = "cubes"

    group: str
    axis: ArrayLike
    angle: float = 0.0
    through: ArrayLike | None = None
    translation: ArrayLike = (0.0, 0.0, 0.0)
    history: Sequence[float] | None = None

    @property
    def words(self) -> str:
        """With the angle."""
        moved = np.any(np.asarray(self.translation, dtype=float))
        also = f", moved by {quantity(tuple(np.ravel(self.translation).tolist()), LENGTH)}" if moved else ""
        return f"turned by {quantity(float(self.angle), ANGLE)} about {vector(np.ravel(self.axis))}{also}"

    @property
    def legend(self) -> str:
        """In pictures."""
        return f"turned by {quantity(float(self.angle), ANGLE)}"

    def conditions(self) -> Iterator[Condition]:
        """Six on the rigid body."""
        where = f"support on '{self.group}'"
        axis, translation = (
            numbers(self.group, "axis", self.axis),
            numbers(self.group, "translation", self.translation),
        )
        if axis.shape != (3,) or not np.all(np.isfinite(axis)) or not np.any(axis):
            raise InputError(f"{where}: axis is {self.axis!r}; it needs 3 finite components, not all zero")
        if translation.shape != (3,) or not np.all(np.isfinite(translation)):
            raise InputError(f"{where}: translation is {self.translation!r}; it needs 3 finite components")
        angle = numbers(self.group, "angle", self.angle)
        if angle.shape != () or not np.isfinite(angle):
            raise InputError(f"{where}: angle is {self.angle!r}; it must be one finite number")
        for direction, value in zip(AXES, translation, strict=True):
            yield Condition(self.group, "u", direction, float(value), False, self.history)
        for number, direction in enumerate(frame_about(axis / np.linalg.norm(axis))):
            yield Condition(self.group, "omega", direction, 0.0 if number else float(angle), False, self.history)

    def body(self) -> RigidBody:
        """The rigid body that its group becomes."""
        through = None if self.through is None else numbers(self.group, "through", self.through)
        if through is not None and (through.shape != (3,) or not np.all(np.isfinite(through))):
            raise InputError(f"support on '{self.group}': through is {self.through!r}; it needs 3 finite coordinates")
        return RigidBody(self.group, point=through)


def turned_bodies(bodies: Sequence[RigidBody], supports: Sequence[Support]) -> tuple[RigidBody, ...]:
    """Rigid bodies, and those that the groups of `Turn` become.

    Raises
    ------
    InputError
        A rigid body is turned about an axis that does not go through its reference point.
    """
    known = {body.name for body in bodies}
    more: dict[str, RigidBody] = {}
    for support in supports:
        if not isinstance(support, Turn):
            continue
        if support.group not in known:
            more.setdefault(support.group, support.body())
        elif support.through is not None:
            raise InputError(
                f"support on '{support.group}': through is given, and a rigid body turns about its reference point; "
                "leave through out and give the body this point"
            )
    return (*bodies, *more.values())
