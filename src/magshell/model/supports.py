"""Supports: which components of which nodes are held, and at what value."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import FloatArray
from magshell.errors import InputError, suggest
from magshell.keys import HISTORY, Key
from magshell.model.rigid_body import RigidBody
from magshell.model.support import AXES, GROUP, Condition, Support, frame_about, numbers
from magshell.model.turn import Turn
from magshell.shell.unknowns import COLUMNS
from magshell.units import ANGLE, INVERSE_LENGTH, LENGTH, NUMBER
from magshell.wording import quantity, vector

FIELDS = tuple(COLUMNS)
DIMENSION_OF_FIELD = {"u": LENGTH, "w": NUMBER, "phi": INVERSE_LENGTH, "omega": ANGLE}


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
        normal = numbers(self.group, "normal", self.normal)
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
        for tangent in frame_about(normal)[1:]:
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
        value = numbers(self.group, "value", self.value)
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


def mirror_planes(supports: Sequence[Support], bodies: Sequence[RigidBody]) -> list[SymmetryPlane]:
    """The mirror planes that groups of the mesh lie in: not those that hold a rigid body by its name."""
    names = {body.name for body in bodies}
    return [one for one in supports if isinstance(one, SymmetryPlane) and one.group not in names]


SUPPORTS: dict[str, type[Support]] = {
    support.kind: support for support in (Clamp, SimpleSupport, SymmetryPlane, Prescribe, Turn)
}
"""The supports that problem files know, by their kind."""
