"""What a support is: conditions on components of what a group holds."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import FloatArray
from magshell.errors import InputError
from magshell.keys import Key

GROUP = Key("Name", "Group of edges, nodes or elements whose nodes are held, or the name of a rigid body.")
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


def numbers(group: str, name: str, value: ArrayLike) -> FloatArray:
    try:
        return np.array(value, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"support on '{group}': {name} is {value!r}; it takes numbers") from None


def frame_about(axis: FloatArray) -> FloatArray:
    """A unit vector (3,) and two normal to it and to each other, as rows."""
    first = np.cross(axis, AXES[np.argmin(np.abs(axis))])
    first /= np.linalg.norm(first)
    return np.array([axis, first, np.cross(axis, first)])
