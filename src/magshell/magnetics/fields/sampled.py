"""A field that is known on a regular grid, interpolated by cubic splines, which are C²."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from magshell.arguments import instance, shown
from magshell.arrays import FloatArray
from magshell.errors import InputError
from magshell.magnetics.fields.field import FieldUnknown, Values
from magshell.magnetics.fields.motion import Motion, MovingField

DEGREE = 3
EDGE = 1e-9
"""A point this far outside the grid, over its length, is on its boundary."""


@dataclass(frozen=True, eq=False)
class SampledField(MovingField):
    """B on a grid of positions whose lines are parallel to the axes.

    Between the positions each component is a tensor product of cubic splines (not-a-knot), and the gradient is the
    derivative of these. `magshell.magnetics.fields.grids` reads files.

    Parameters
    ----------
    axes : sequence of three array_like
        Coordinates along each axis, increasing, at least four, m. Steps need not be equal.
    flux_density : array_like, shape (n1, n2, n3, 3)
        B at the positions, T.
    motion : Motion, optional
    name : str
        Of its columns in `history.csv`.

    Raises
    ------
    InputError
        Coordinates that do not increase or are too few, values that are not finite, another shape. Later,
        `FieldUnknown` at a point outside the grid.
    """

    axes: Sequence[ArrayLike]
    flux_density: ArrayLike
    motion: Motion = field(default_factory=Motion)
    name: str = "sampled"

    def __post_init__(self) -> None:
        self.check_motion()
        instance(f"{self.name}: axes", self.axes, (Sequence, np.ndarray), "three sequences of coordinates")
        axes = tuple(self._coordinates(number, values) for number, values in enumerate(self.axes))
        if len(axes) != 3:
            raise InputError(f"{self.name}: there are {len(axes)} axes; a grid has three")
        B, shape = self._numbers(), (*map(len, axes), 3)
        if B.shape != shape:
            raise InputError(f"{self.name}: flux_density has the shape {B.shape}; the axes make it {shape}")
        bad = np.argwhere(~np.isfinite(B).all(axis=-1))
        if len(bad):
            place = ", ".join(f"{axis[k]:.6g}" for axis, k in zip(axes, bad[0], strict=True))
            raise InputError(
                f"{self.name}: the flux density is not finite at {len(bad)} of {B[..., 0].size} positions, first at "
                f"({place}) m; cut the grid so that it leaves out the inside of magnets and coils, or fill it"
            )
        B.flags.writeable = False
        object.__setattr__(self, "axes", axes)
        object.__setattr__(self, "flux_density", B)

    def _numbers(self) -> FloatArray:
        try:
            return np.array(self.flux_density, dtype=float)
        except (TypeError, ValueError):
            raise InputError(
                f"{self.name}: flux_density is {shown(self.flux_density)}; it must be numbers (T)"
            ) from None

    def _coordinates(self, number: int, values: ArrayLike) -> FloatArray:
        try:
            axis = np.array(values, dtype=float).reshape(-1)
        except (TypeError, ValueError):
            raise InputError(
                f"{self.name}: the coordinates along X{number + 1} are {shown(values)}; they must be numbers (m)"
            ) from None
        if not np.isfinite(axis).all() or np.any(np.diff(axis) <= 0.0):
            raise InputError(f"{self.name}: the coordinates along X{number + 1} must be finite and increase")
        if len(axis) <= DEGREE:
            raise InputError(
                f"{self.name}: there are {len(axis)} coordinates along X{number + 1}; cubic splines need at least "
                f"{DEGREE + 1}"
            )
        axis.flags.writeable = False
        return axis

    @cached_property
    def _spline(self) -> Any:
        from scipy.interpolate import NdBSpline, make_interp_spline

        coefficients, knots = np.asarray(self.flux_density), []
        for number, axis in enumerate(self.axes):
            along = make_interp_spline(np.asarray(axis), coefficients, k=DEGREE, axis=number)
            coefficients = np.moveaxis(along.c, 0, number)
            knots.append(along.t)
        return NdBSpline(tuple(knots), np.ascontiguousarray(coefficients), DEGREE)

    @property
    def middle(self) -> FloatArray:
        return np.array([0.5 * (np.asarray(axis)[0] + np.asarray(axis)[-1]) for axis in self.axes])

    def own(self, points: FloatArray, second: bool) -> Values:
        places = self._inside(points)
        spline, eye = self._spline, np.eye(3, dtype=int)
        gradient = np.stack([spline(places, nu=tuple(eye[j])) for j in range(3)], axis=2)
        if not second:
            return Values(spline(places), gradient, None)
        whole = np.empty((len(points), 3, 3, 3))
        for j in range(3):
            for k in range(j, 3):
                whole[:, :, j, k] = whole[:, :, k, j] = spline(places, nu=tuple(eye[j] + eye[k]))
        return Values(spline(places), gradient, whole)

    def _inside(self, points: FloatArray) -> FloatArray:
        """The points, those on the boundary within round-off put onto it."""
        low, high = (np.array([np.asarray(axis)[end] for axis in self.axes]) for end in (0, -1))
        beyond = np.maximum(low - points, points - high)
        outside = np.argwhere(beyond > EDGE * (high - low))
        if len(outside):
            number, axis = outside[0]
            place = ", ".join(f"{x:.6g}" for x in points[number])
            where = "" if not self._has_moved else " in the frame of the grid"
            raise FieldUnknown(
                f"{self.name}: the point ({place}) m{where} is outside the grid, which has X{axis + 1} from "
                f"{low[axis]:.6g} to {high[axis]:.6g} m; give a larger one",
                points[number],
            )
        return np.clip(points, low, high)

    @property
    def _has_moved(self) -> bool:
        return self.motion.displacement is not None or self.motion.rotation is not None
