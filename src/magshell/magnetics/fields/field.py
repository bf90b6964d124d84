"""What a magnetic field is to the equations: B and its derivatives at points, for given amounts of what drives it.

A field depends on *amounts*: multipliers, places and angles that vary linearly within a stage of the path. A field says
what they are at the end of each stage (`ends`), its values for any of them (`at`), and the derivative of the values
along a change of them (`rate`), at fixed points.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.errors import InputError


class FieldUnknown(InputError):
    """The field is not known at a point: outside a grid, too near to a surface for an interpolation.

    Attributes
    ----------
    position : ndarray, shape (3,), or None
        The point in the frame of the field, m.
    """

    def __init__(self, message: str, position: FloatArray | None = None) -> None:
        super().__init__(message)
        self.position = position


class Values(NamedTuple):
    """A field at points.

    Attributes
    ----------
    flux_density : ndarray, shape (n, 3)
        B, T.
    gradient : ndarray, shape (n, 3, 3)
        ∂B_i/∂x_j, T/m.
    second : ndarray, shape (n, 3, 3, 3), or None
        ∂²B_i/∂x_j∂x_k, T/m²; None: not asked for.
    """

    flux_density: FloatArray
    gradient: FloatArray
    second: FloatArray | None

    def plus(self, other: Values) -> Values:
        """The sum; its second derivatives only where both have them."""
        both = self.second is not None and other.second is not None
        second = self.second + other.second if both else None  # type: ignore[operator]
        return Values(self.flux_density + other.flux_density, self.gradient + other.gradient, second)


class Field(ABC):
    """An external magnetic field.

    Attributes
    ----------
    name : str
        Of the columns of `history.csv` and in messages.
    drives : tuple of str
        Names of its amounts.
    stages : int
        Of its longest history; 1 without one.
    is_uniform : bool
        Whether B is the same everywhere, whatever the amounts.
    """

    name: str

    @property
    @abstractmethod
    def drives(self) -> tuple[str, ...]: ...
    @property
    @abstractmethod
    def stages(self) -> int: ...
    @property
    def is_uniform(self) -> bool:
        return False

    @abstractmethod
    def ends(self, stages: int) -> FloatArray:
        """Amounts (stages + 1, drives) before the first stage and at the end of each.

        Raises
        ------
        InputError
            A history that is not as long as the path has stages.
        """

    @abstractmethod
    def at(self, amounts: FloatArray, points: FloatArray, second: bool = True) -> Values:
        """Values at points (n, 3), m; NaN at points that are not finite.

        Parameters
        ----------
        amounts : ndarray, shape (drives,)
        points : ndarray, shape (n, 3)
        second : bool
            Whether second derivatives are needed.
        """

    @abstractmethod
    def rate(self, amounts: FloatArray, change: FloatArray, points: FloatArray) -> Values:
        """Derivative of B and its gradient by t at fixed points, for amounts + t change at t = 0."""

    def parts(self, amounts: FloatArray) -> Iterator[tuple[Field, FloatArray]]:
        """What it is a sum of, each with its amounts."""
        yield self, amounts

    def __add__(self, other: Field) -> FieldSum:
        return FieldSum((*_parts_of(self), *_parts_of(other)))


def _parts_of(field: Field) -> tuple[Field, ...]:
    return field.fields if isinstance(field, FieldSum) else (field,)


@dataclass(frozen=True, eq=False)
class FieldSum(Field):
    """Fields that add up; ``one + other`` makes it.

    Parameters
    ----------
    fields : tuple of Field
        At least one.
    """

    fields: tuple[Field, ...]
    name = "field"

    @cached_property
    def _names(self) -> list[str]:
        """Those of the fields; of those with the same name, each further one has a number."""
        names: list[str] = []
        for field in self.fields:
            name, number = field.name, 1
            while name in names:
                number += 1
                name = f"{field.name}-{number}"
            names.append(name)
        return names

    @property
    def drives(self) -> tuple[str, ...]:
        return tuple(
            f"{name}.{drive.rpartition('.')[2]}"
            for name, field in zip(self._names, self.fields, strict=True)
            for drive in field.drives
        )

    @property
    def stages(self) -> int:
        return max(field.stages for field in self.fields)

    @property
    def is_uniform(self) -> bool:
        return all(field.is_uniform for field in self.fields)

    def ends(self, stages: int) -> FloatArray:
        return np.concatenate([field.ends(stages) for field in self.fields], axis=1)

    def at(self, amounts: FloatArray, points: FloatArray, second: bool = True) -> Values:
        return _sum([field.at(own, points, second) for field, own in self.parts(amounts)])

    def rate(self, amounts: FloatArray, change: FloatArray, points: FloatArray) -> Values:
        pairs = zip(self.parts(amounts), self._shares(change), strict=True)
        return _sum([field.rate(own, changed, points) for (field, own), changed in pairs])

    def parts(self, amounts: FloatArray) -> Iterator[tuple[Field, FloatArray]]:
        yield from zip(self.fields, self._shares(amounts), strict=True)

    def _shares(self, amounts: FloatArray) -> list[FloatArray]:
        """The amounts of each field."""
        return np.split(amounts, np.cumsum([len(field.drives) for field in self.fields])[:-1])


def _sum(values: Sequence[Values]) -> Values:
    total = values[0]
    for one in values[1:]:
        total = total.plus(one)
    return total


def known(field: Field, amounts: FloatArray, points: FloatArray) -> FloatArray:
    """B (n, 3) at points (n, 3); NaN where the field is not known, on wires or outside grids."""
    try:
        return field.at(amounts, points, second=False).flux_density
    except FieldUnknown:
        if len(points) == 1:
            return np.full((1, 3), np.nan)
        half = len(points) // 2
        return np.concatenate([known(field, amounts, part) for part in (points[:half], points[half:])])
