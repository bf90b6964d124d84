"""Supports: which components of which nodes are held, and at what value."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import FloatArray, IntArray
from magshell.errors import InputError, suggest
from magshell.keys import HISTORY, Key
from magshell.model.places import Places
from magshell.model.rigid_body import RigidBody
from magshell.multipliers import amplitudes
from magshell.shell.unknowns import COLUMNS, COMPONENTS
from magshell.units import ANGLE, INVERSE_LENGTH, LENGTH, NUMBER
from magshell.wording import quantity, vector

FIELDS = tuple(COLUMNS)
DIMENSION_OF_FIELD = {"u": LENGTH, "w": NUMBER, "phi": INVERSE_LENGTH, "omega": ANGLE}
GROUP = Key("Name", "Group of edges, nodes or elements whose nodes are held.")
REACTION = {
    "name": Key("Name", "Of the reaction in the results; supports of one name have one reaction.", "the group"),
    "point": Key("Position", "Point, fixed in space, that the reaction's moment is about.", "the support's centroid"),
}
"""Keys that all supports have."""
AXES = np.eye(3)


class Condition(NamedTuple):
    """direction · field = value, times the multiplier of the history, on every node of a group.

    `optional` conditions skip nodes that do not carry the field, as some mid-side nodes do not.
    """

    group: str
    field: str
    direction: FloatArray
    value: float
    optional: bool
    history: Sequence[float] | None = None


@dataclass(frozen=True, kw_only=True)
class Support(ABC):
    """Anything that gives conditions: a frozen dataclass that inherits from this class.

    Attributes
    ----------
    kind : str
        Its name in problem files.
    keys : mapping of str to Key
        Its parameters, but for those that all supports have (`REACTION`).
    mark : {"balls", "cubes"}
        How it is drawn.
    group : str
        Group of nodes, edges or elements whose nodes are held.
    name : str, optional
        Of its reaction; by default the group. Supports of one name have one reaction.
    point : array_like, shape (3,), optional
        Point, fixed in space, that the reaction's moment is about, m; by default the centroid of what the support
        holds, where it is after the deformation.
    """

    kind: ClassVar[str]
    keys: ClassVar[Mapping[str, Key]]
    mark: ClassVar[Literal["balls", "cubes"]] = "balls"

    group: str
    name: str | None = None
    point: ArrayLike | None = None

    @classmethod
    def all_keys(cls) -> dict[str, Key]:
        """Its own keys and those that all supports have."""
        return {**cls.keys, **REACTION}

    @abstractmethod
    def conditions(self) -> Iterator[Condition]:
        """The conditions."""

    @property
    def words(self) -> str:
        """The support in `magshell check`."""
        return self.kind

    @property
    def legend(self) -> str:
        """The support in pictures."""
        return self.kind


def _numbers(group: str, name: str, value: ArrayLike) -> FloatArray:
    try:
        return np.array(value, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"support on '{group}': {name} is {value!r}; it takes numbers") from None


def _fixed(group: str, field: str) -> Iterator[Condition]:
    for axis in AXES:
        yield Condition(group, field, axis, 0.0, optional=True)


@dataclass(frozen=True)
class Clamp(Support):
    """u = 0, w = 0 and no rotation; the thickness stretch φ stays free."""

    kind: ClassVar[str] = "clamp"
    keys: ClassVar[Mapping[str, Key]] = {"group": GROUP}
    mark: ClassVar[Literal["balls", "cubes"]] = "cubes"

    group: str

    def conditions(self) -> Iterator[Condition]:
        """Nine per node."""
        for field in ("u", "w", "omega"):
            yield from _fixed(self.group, field)


@dataclass(frozen=True)
class SimpleSupport(Support):
    """u = 0; the section may turn."""

    kind: ClassVar[str] = "simple"
    keys: ClassVar[Mapping[str, Key]] = {"group": GROUP}

    group: str

    @property
    def legend(self) -> str:
        """In pictures."""
        return "simple support"

    def conditions(self) -> Iterator[Condition]:
        """Three per node."""
        yield from _fixed(self.group, "u")


@dataclass(frozen=True)
class SymmetryPlane(Support):
    """Mirror plane with the given normal: u · n = 0, w · n = 0, and rotation about n only."""

    kind: ClassVar[str] = "symmetry"
    keys: ClassVar[Mapping[str, Key]] = {"group": GROUP, "normal": Key("Direction", "Of the mirror plane.")}

    group: str
    normal: ArrayLike

    @property
    def words(self) -> str:
        """With the normal."""
        return f"{self.kind}, normal {vector(np.ravel(self.normal))}"

    @property
    def unit_normal(self) -> FloatArray:
        """The normal (3,) of length 1.

        Raises
        ------
        InputError
            It is something else than three finite numbers, not all zero.
        """
        normal = _numbers(self.group, "normal", self.normal)
        if normal.shape != (3,) or not np.all(np.isfinite(normal)) or not np.any(normal):
            raise InputError(
                f"support on '{self.group}': normal is {self.normal!r}; it needs 3 components, not all zero"
            )
        return normal / np.linalg.norm(normal)

    def is_like(self, other: Support) -> bool:
        """Whether the other is a mirror plane with the same normal."""
        if not isinstance(other, SymmetryPlane):
            return False
        return float(np.abs(self.unit_normal @ other.unit_normal)) > 1.0 - 1e-9

    def conditions(self) -> Iterator[Condition]:
        """Four per node."""
        normal = self.unit_normal
        for field in ("u", "w"):
            yield Condition(self.group, field, normal, 0.0, optional=True)
        for tangent in _frame_about(normal)[1:]:
            yield Condition(self.group, "omega", tangent, 0.0, optional=True)


@dataclass(frozen=True)
class Prescribe(Support):
    """A value for a field, or one component of it.

    Parameters
    ----------
    group : str
        Group of nodes, edges or elements.
    field : {"u", "w", "phi", "omega"}
        Displacement (m), director displacement, thickness stretch (1/m), rotation (rad).
    component : {1, 2, 3}, optional
        None: all three (φ has none).
    value : float or array_like, shape (3,)
        A vector where all three components are meant; one number holds for each component named.
    history : sequence of float, optional
        Multiplier of the value at the end of each stage of the path; by default it grows to 1 in the first and stays.
    """

    kind: ClassVar[str] = "prescribe"
    keys: ClassVar[Mapping[str, Key]] = {
        "group": GROUP,
        "field": Key(
            "NodalField",
            "Displacement (length), director displacement (number), thickness stretch (1/length), rotation (angle).",
        ),
        "component": Key("Component", "Along $X_1$, $X_2$ or $X_3$; left out: all three."),
        "value": Key("NodalValue", "One value, or three where all components are meant."),
        "history": HISTORY,
    }

    group: str
    field: str
    component: int | None = None
    value: ArrayLike = 0.0
    history: Sequence[float] | None = None

    @property
    def words(self) -> str:
        """With the value."""
        given = tuple(np.atleast_1d(np.asarray(self.value, dtype=float)).tolist())
        value = quantity(given if len(given) > 1 else given[0], DIMENSION_OF_FIELD[self.field])
        return f"{self.kind} {self.field}{self.component or ''} = {value}"

    @property
    def legend(self) -> str:
        """In pictures."""
        return f"{self.field}{self.component or ''} given"

    def conditions(self) -> Iterator[Condition]:
        """One per component."""
        where = f"support on '{self.group}'"
        if self.field not in FIELDS:
            raise InputError(f"{where}: field is '{self.field}'. {suggest(self.field, FIELDS)}")
        value = _numbers(self.group, "value", self.value)
        if not np.all(np.isfinite(value)):
            raise InputError(f"{where}: value is {self.value!r}; it must be finite")
        if self.field == "phi" or self.component is not None:
            if self.field == "phi" and self.component is not None:
                raise InputError(f"{where}: phi is a scalar, it has no component {self.component}; leave it out")
            if self.component not in (None, 1, 2, 3):
                raise InputError(f"{where}: component is {self.component}; allowed are 1, 2, 3")
            if value.shape != ():
                raise InputError(f"{where}: value is {self.value!r}; one component takes one number")
            axis = AXES[(self.component or 1) - 1]
            yield Condition(self.group, self.field, axis, float(value), False, self.history)
            return
        if value.shape not in ((), (3,)):
            raise InputError(f"{where}: value has shape {value.shape}; it takes 3 numbers, or one for all components")
        for axis, component in zip(AXES, np.broadcast_to(value, 3), strict=True):
            yield Condition(self.group, self.field, axis, float(component), False, self.history)


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
        return "turned"

    def conditions(self) -> Iterator[Condition]:
        """Six on the rigid body."""
        where = f"support on '{self.group}'"
        axis, translation = (
            _numbers(self.group, "axis", self.axis),
            _numbers(self.group, "translation", self.translation),
        )
        if axis.shape != (3,) or not np.all(np.isfinite(axis)) or not np.any(axis):
            raise InputError(f"{where}: axis is {self.axis!r}; it needs 3 finite components, not all zero")
        if translation.shape != (3,) or not np.all(np.isfinite(translation)):
            raise InputError(f"{where}: translation is {self.translation!r}; it needs 3 finite components")
        angle = _numbers(self.group, "angle", self.angle)
        if angle.shape != () or not np.isfinite(angle):
            raise InputError(f"{where}: angle is {self.angle!r}; it must be one finite number")
        for direction, value in zip(AXES, translation, strict=True):
            yield Condition(self.group, "u", direction, float(value), False, self.history)
        for number, direction in enumerate(_frame_about(axis / np.linalg.norm(axis))):
            yield Condition(self.group, "omega", direction, 0.0 if number else float(angle), False, self.history)

    def body(self) -> RigidBody:
        """The rigid body that its group becomes."""
        return RigidBody(self.group, point=self.through)


def _frame_about(axis: FloatArray) -> FloatArray:
    """A unit vector (3,) and two normal to it and to each other, as rows."""
    first = np.cross(axis, AXES[np.argmin(np.abs(axis))])
    first /= np.linalg.norm(first)
    return np.array([axis, first, np.cross(axis, first)])


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


SUPPORTS: dict[str, type[Support]] = {
    support.kind: support for support in (Clamp, SimpleSupport, SymmetryPlane, Prescribe, Turn)
}
"""The supports that problem files know, by their kind."""

Supports: TypeAlias = Sequence[Support]


class Constraints(NamedTuple):
    """The resolved supports, by node and by column of the nodal arrays (see `magshell.shell.unknowns`).

    Attributes
    ----------
    fixed : ndarray of bool, shape (nodes, 11)
        In the node's frame.
    values : ndarray, shape (stages, nodes, 11)
        At the end of each stage, in the node's frame.
    frame_of : ndarray, shape (nodes, 3)
        Frame of u, w and ω, -1 for the global axes.
    frames : ndarray, shape (frames, 3, 3)
        Rows are base vectors.
    """

    fixed: AnyBool
    values: FloatArray
    frame_of: IntArray
    frames: FloatArray


AnyBool: TypeAlias = np.typing.NDArray[np.bool_]
FRAME_OF_FIELD = {"u": 0, "w": 1, "omega": 2}


def resolve(places: Places, supports: Supports, stages: int = 1) -> Constraints:
    """Conditions of all supports as fixed components, with frames of their own where directions are oblique.

    Parameters
    ----------
    places : Places
    supports : sequence of Support
    stages : int
        Of the path.

    Raises
    ------
    InputError
        Unknown group, a field that a node does not carry, supports that contradict each other, a support on a node of a
        rigid body, a history of a wrong length.
    """
    nodes, carriers, owner = places.number, places.carriers, places.owner
    fixed, values = np.zeros((nodes, COMPONENTS), dtype=bool), np.zeros((stages, nodes, COMPONENTS))
    frame_of = np.full((nodes, 3), -1)
    frames: list[FloatArray] = []
    directions: dict[tuple[int, str], list[tuple[FloatArray, FloatArray, str]]] = {}
    for support in supports:
        for condition in support.conditions():
            members = places.named(condition.group)
            if condition.field != "phi" and not places.is_body(condition.group):
                members = _off_bodies(places, owner, members, support, supports)
            if condition.field != "u":
                carries = carriers[condition.field][members]
                if not carries.any() and not condition.optional:
                    _refuse_absent(places, members, condition)
                members = members[carries]
            value = condition.value * amplitudes(condition.history, stages, f"support on '{condition.group}'")
            for node in members:
                directions.setdefault((int(node), condition.field), []).append(
                    (condition.direction, value, condition.group)
                )
    for (node, field), wanted in directions.items():
        column = COLUMNS[field].start
        base, held = _orthonormal(places.words(node), field, wanted)
        if field == "phi":
            fixed[node, column], values[:, node, column] = True, held[0]
        elif np.all(np.max(np.abs(base), axis=1) > 1.0 - 1e-12):
            for vector, one in zip(base, held, strict=True):
                axis = int(np.argmax(np.abs(vector)))
                fixed[node, column + axis], values[:, node, column + axis] = True, one * np.sign(vector[axis])
        else:
            frame_of[node, FRAME_OF_FIELD[field]] = len(frames)
            complement = np.linalg.svd(base)[2][len(base) :]
            frames.append(np.vstack([base, complement]))
            fixed[node, column : column + len(base)] = True
            values[:, node, column : column + len(base)] = held.T
    return Constraints(fixed, values, frame_of, np.array(frames).reshape(-1, 3, 3))


def _off_bodies(places: Places, owner: IntArray, members: IntArray, support: Support, supports: Supports) -> IntArray:
    """Nodes of a support, but for those on mirror planes of rigid bodies that a like support holds."""
    inside = owner[members[members < len(owner)]]
    if not np.any(inside >= 0):
        return members
    for place in np.unique(inside[inside >= 0]):
        body = places.bodies[place - len(owner)]
        if not any(
            isinstance(one, SymmetryPlane) and one.is_like(support) for one in supports if one.group == body.name
        ):
            node = members[np.argmax(inside == place)]
            raise InputError(
                f"support on '{support.group}': node {node} belongs to {body.label}, whose nodes move as one; hold "
                f'the body, by its name: group = "{body.name}"'
            )
    return members[inside < 0]


def _refuse_absent(places: Places, members: IntArray, condition: Condition) -> None:
    """Say why a field is not there."""
    field, where = condition.field, f"support on '{condition.group}'"
    if members[0] >= len(places.mesh.points):
        raise InputError(f"{where}: a rigid body has no '{field}', only u and omega")
    if not places.carriers[field].any():
        raise InputError(f"{where}: no node of this shell carries '{field}'")
    joint = field == "w" and places.carriers["omega"][members[0]]
    why = "is at a joint, where directors turn with omega," if joint else "is a mid-side node"
    raise InputError(f"{where}: node {members[0]} {why} and does not carry '{field}'")


def _orthonormal(
    where: str, field: str, wanted: list[tuple[FloatArray, FloatArray, str]]
) -> tuple[FloatArray, FloatArray]:
    """Orthonormal directions and their values, by stage, that say the same as all conditions of one node's field."""
    base: list[FloatArray] = []
    values: list[FloatArray] = []
    for direction, wanted_value, group in wanted:
        rest: FloatArray = direction.copy()
        left = wanted_value
        for known, held in zip(base, values, strict=True):
            rest = rest - (direction @ known) * known
            left = left - float(direction @ known) * held
        length = float(np.linalg.norm(rest))
        if length > 1e-9:
            base.append(rest / length)
            values.append(left / length)
        elif np.abs(left).max() > 1e-9 * max(np.abs(one).max() for one in (wanted_value, *values)):
            others = sorted({other for _, _, other in wanted} - {group})
            raise InputError(
                f"supports: they contradict each other at {where}: '{group}' wants another {field} than "
                + (f"'{others[0]}'" if others else "an earlier support on the same group")
            )
    return np.array(base), np.array(values)
