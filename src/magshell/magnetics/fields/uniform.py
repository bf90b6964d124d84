"""A field that is the same everywhere.

Its amounts are the multiplier h and the angle α about the axis a: B = h R(α) B0, and along the path
B' = h' R(α) B0 + α' a × B.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import FloatArray, three_finite
from magshell.errors import InputError
from magshell.magnetics.fields.field import Field, Values
from magshell.multipliers import amplitudes, numbers, spaced


@dataclass(frozen=True, eq=False)
class UniformField(Field):
    """External flux density, the same everywhere.

    Parameters
    ----------
    flux_density : array_like, shape (3,)
        At multiplier 1, T.
    stops : sequence of float or int
        Magnitudes of flux density, T, that the load path must hit wherever the multiplier passes them. A whole number:
        so many, evenly spaced up to the largest.
    history : sequence of float, optional
        Multiplier at the end of each stage of the path; by default it grows to 1 in the first and stays.
    rotation_axis : array_like, shape (3,), optional
        Axis about which the field turns.
    rotation : sequence of float, optional
        Angle, rad, about the axis at the end of each stage.

    Raises
    ------
    InputError
        Components that are not three finite numbers; stops outside the path or out of order; a rotation without an
        axis, or the reverse.
    """

    flux_density: ArrayLike
    stops: ArrayLike = ()
    history: Sequence[float] | None = None
    rotation_axis: ArrayLike | None = None
    rotation: Sequence[float] | None = None
    vector: FloatArray = field(init=False, repr=False)
    axis: FloatArray = field(init=False, repr=False)
    name = "field"
    drives = ("field.multiplier", "field.angle")
    is_uniform = True

    def __post_init__(self) -> None:
        try:
            vector = np.array(self.flux_density, dtype=float)
        except (TypeError, ValueError) as error:
            raise InputError(f"field: flux_density and stops are numbers (T): {error}") from None
        if vector.shape != (3,) or not np.all(np.isfinite(vector)):
            raise InputError(f"field: flux_density is {self.flux_density!r}; it needs 3 finite components (T)")
        largest = 1.0 if self.history is None else float(np.abs(numbers(self.history, "field")).max())
        magnitude = largest * float(np.linalg.norm(vector))
        try:
            stops = np.array(spaced(self.stops, magnitude, "field"), dtype=float).reshape(-1)
        except (TypeError, ValueError) as error:
            raise InputError(f"field: stops are numbers (T): {error}") from None
        if not np.all(np.isfinite(stops)) or np.any(np.diff(stops) <= 0.0) or np.any(stops <= 0.0):
            raise InputError(f"field: stops are {stops.tolist()} T; they must be positive and increasing")
        if stops.size and stops[-1] > magnitude * (1.0 + 1e-12):
            raise InputError(f"field: the stop {stops[-1]:g} T is beyond the field's largest magnitude {magnitude:g} T")
        vector.flags.writeable = False
        object.__setattr__(self, "vector", vector)
        object.__setattr__(self, "stops", tuple(float(stop) for stop in stops))
        object.__setattr__(self, "axis", self._unit_axis())

    def _unit_axis(self) -> FloatArray:
        if (self.rotation_axis is None) != (self.rotation is None):
            raise InputError("field: rotation_axis and rotation go together; one of them is missing")
        if self.rotation is None:
            return np.zeros(3)
        numbers(self.rotation, "field", "rotation")
        axis = three_finite(self.rotation_axis)
        if axis is None or not np.any(axis):
            raise InputError(
                f"field: rotation_axis is {self.rotation_axis!r}; it needs 3 finite components, not all zero"
            )
        return axis / np.linalg.norm(axis)

    @property
    def magnitude(self) -> float:
        """Length of the vector at multiplier 1, T."""
        return float(np.linalg.norm(self.vector))

    def turned(self, angle: float) -> FloatArray:
        """Flux density (3,) at multiplier 1, turned by an angle (rad) about the axis."""
        along, across, normal = self._parts
        return np.asarray(along + np.cos(angle) * across + np.sin(angle) * normal)

    @cached_property
    def _parts(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Of the vector: along the axis, across it, and their normal."""
        along = (self.vector @ self.axis) * self.axis
        return along, self.vector - along, np.cross(self.axis, self.vector)

    @property
    def stages(self) -> int:
        return max((len(one) for one in (self.history, self.rotation) if one is not None), default=1)

    def ends(self, stages: int) -> FloatArray:
        amounts = np.zeros((stages + 1, 2))
        amounts[1:, 0] = amplitudes(self.history, stages, "field")
        if self.rotation is not None:
            amounts[1:, 1] = amplitudes(self.rotation, stages, "field: rotation")
        return amounts

    def at(self, amounts: FloatArray, points: FloatArray, second: bool = True) -> Values:
        return _everywhere(amounts[0] * self.turned(amounts[1]), len(points), second)

    def rate(self, amounts: FloatArray, change: FloatArray, points: FloatArray) -> Values:
        direction = self.turned(amounts[1])
        turning = amounts[0] * change[1] * np.cross(self.axis, direction)
        return _everywhere(change[0] * direction + turning, len(points), False)


def _everywhere(flux_density: FloatArray, count: int, second: bool) -> Values:
    """The same at all points, without memory for each."""

    def zero(*shape: int) -> FloatArray:
        return np.broadcast_to(0.0, (count, *shape))

    return Values(np.broadcast_to(flux_density, (count, 3)), zero(3, 3), zero(3, 3, 3) if second else None)
