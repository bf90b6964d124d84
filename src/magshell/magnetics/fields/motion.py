"""How a field that is known in a frame of its own moves with it, and is switched, along the path.

The frame coincides with the global one before the first stage. With multiplier m, displacement d and angle α about an
axis a through the centre c, a point x is at y in the frame, and the field b(y) there is B in space:

    y = c + Rᵀ (x − c − d),    B = m R b(y),    ∇B = m R ∇b Rᵀ,    R = R(α, a).

At a fixed x, with the velocity v = d' + α' a × (x − c − d) of the frame there,

    B' = m' R b + α' a × B − ∇B v,    ∇B' = m' R ∇b Rᵀ + α' ([a] ∇B − ∇B [a]) − ∇∇B v.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from magshell.arguments import instance
from magshell.arrays import FloatArray, three_finite
from magshell.errors import InputError
from magshell.magnetics.fields.field import Field, Values
from magshell.multipliers import amplitudes, numbers

DRIVES = ("multiplier", "d1", "d2", "d3", "angle")


@dataclass(frozen=True, eq=False)
class Motion:
    """Multiplier, displacement and angle at the end of each stage; linear in between.

    Parameters
    ----------
    history : sequence of float, optional
        Multiplier of the strength or current; by default it grows from 0 to 1 in the first stage and stays.
    displacement : array_like, shape (stages, 3), optional
        From where the field is before the first stage, m; by default none.
    rotation_axis : array_like, shape (3,), optional
    rotation : sequence of float, optional
        Angle about the axis, rad.
    centre : array_like, shape (3,), optional
        A point of the axis before the first stage, m; it moves with the displacement. By default the middle of the
        sources, for other fields the origin.

    Raises
    ------
    InputError
        Numbers that are not finite, of the wrong shape, or for another number of stages; a rotation without an axis,
        or the reverse.
    """

    history: Sequence[float] | None = None
    displacement: ArrayLike | None = None
    rotation_axis: ArrayLike | None = None
    rotation: Sequence[float] | None = None
    centre: ArrayLike | None = None

    def __post_init__(self) -> None:
        if (self.rotation_axis is None) != (self.rotation is None):
            raise InputError("motion: rotation_axis and rotation go together; one of them is missing")
        if self.rotation_axis is not None:
            axis = vector(self.rotation_axis, "motion: rotation_axis")
            if not axis.any():
                raise InputError("motion: rotation_axis is the zero vector; it must have a direction")
            object.__setattr__(self, "rotation_axis", axis / np.linalg.norm(axis))
            numbers(self.rotation or (), "motion", "rotation")
        if self.centre is not None:
            object.__setattr__(self, "centre", vector(self.centre, "motion: centre"))
        if self.history is not None:
            numbers(self.history, "motion")
        if self.displacement is not None:
            object.__setattr__(self, "displacement", _places(self.displacement))

    @property
    def stages(self) -> int:
        """Of the longest history; 1 without one."""
        given = (self.history, self.displacement, self.rotation)
        return max((len(one) for one in given if one is not None), default=1)  # type: ignore[arg-type]

    def ends(self, stages: int, where: str) -> FloatArray:
        """Multiplier, displacement and angle (stages + 1, 5), before the first stage and at the end of each."""
        amounts = np.zeros((stages + 1, len(DRIVES)))
        amounts[1:, 0] = amplitudes(self.history, stages, where)
        if self.displacement is not None:
            given = np.asarray(self.displacement)
            if len(given) != stages:
                raise InputError(
                    f"{where}: displacement has {len(given)} entries; it needs one for each of the {stages} stages of "
                    "the path"
                )
            amounts[1:, 1:4] = given
        if self.rotation is not None:
            amounts[1:, 4] = amplitudes(self.rotation, stages, f"{where}: rotation")
        return amounts


def vector(value: ArrayLike, where: str) -> FloatArray:
    """Three finite numbers.

    Raises
    ------
    InputError
        They are not.
    """
    array = three_finite(value)
    if array is None:
        raise InputError(f"{where} is {value!r}; it needs three finite numbers")
    array.flags.writeable = False
    return array


def _places(value: ArrayLike) -> FloatArray:
    try:
        array = np.array(value, dtype=float)
    except (TypeError, ValueError):
        array = np.empty(0)
    if array.ndim != 2 or array.shape[1] != 3 or not len(array) or not np.isfinite(array).all():
        raise InputError(f"motion: displacement is {value!r}; it needs three finite numbers (m) for each stage")
    return array


class MovingField(Field):
    """A field that is known in a frame of its own, and moves with it.

    Attributes
    ----------
    motion : Motion
    """

    motion: Motion

    def check_motion(self) -> None:
        """Refuse a motion or a name of another class.

        Raises
        ------
        InputError
            There is one.
        """
        instance("field: name", self.name, str, "a text")
        instance(f"{self.name}: motion", self.motion, Motion, "a Motion")

    @abstractmethod
    def own(self, points: FloatArray, second: bool) -> Values:
        """Values at points (n, 3) of the frame, at multiplier 1."""

    @property
    def middle(self) -> FloatArray:
        """What it turns about unless the motion names a centre, m."""
        return np.zeros(3)

    @property
    def drives(self) -> tuple[str, ...]:
        return tuple(f"{self.name}.{drive}" for drive in DRIVES)

    @property
    def stages(self) -> int:
        return self.motion.stages

    def ends(self, stages: int) -> FloatArray:
        return self.motion.ends(stages, self.name)

    def placement(self, amounts: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Rotation R (3, 3) and shift s (3,) of the frame: x = R y + s."""
        turn = self._turn(amounts[4])
        return turn, self.pivot(amounts) - turn @ self._centre

    def pivot(self, amounts: FloatArray) -> FloatArray:
        """The point (3,) of the axis of rotation that moves with the displacement, m."""
        return np.asarray(self._centre + amounts[1:4])

    def at(self, amounts: FloatArray, points: FloatArray, second: bool = True) -> Values:
        return self._unscaled(amounts, points, second, float(amounts[0]))

    def rate(self, amounts: FloatArray, change: FloatArray, points: FloatArray) -> Values:
        moves, (m, dm) = bool(np.any(change[1:])), (float(amounts[0]), float(change[0]))
        one = self._unscaled(amounts, points, moves, 1.0)
        B, gradient = dm * one.flux_density, dm * one.gradient
        if moves:
            spin = change[4] * self._axis
            cross = _cross_matrix(spin)
            velocity = change[1:4] + np.cross(spin, points - self._centre - amounts[1:4])
            turned = np.cross(spin, one.flux_density)
            B = B + m * (turned - np.einsum("pij,pj->pi", one.gradient, velocity))
            gradient = gradient + m * (cross @ one.gradient - one.gradient @ cross)
            assert one.second is not None
            gradient = gradient - m * np.einsum("pijk,pk->pij", one.second, velocity)
        return Values(B, gradient, None)

    def _unscaled(self, amounts: FloatArray, points: FloatArray, second: bool, multiplier: float) -> Values:
        turn, shift = self.placement(amounts)
        still = amounts[4] == 0.0
        with np.errstate(invalid="ignore"):
            frame = points - shift if still else (points - shift) @ turn
        values = self.own(frame, second) if np.isfinite(frame).all() else self._where_finite(frame, second)
        return turned(values, None if still else turn, multiplier)

    def _where_finite(self, points: FloatArray, second: bool) -> Values:
        finite = np.isfinite(points).all(axis=1)
        found = self.own(points[finite], second) if finite.any() else None
        whole = [np.full((len(points),) + (3,) * order, np.nan) for order in (1, 2, 3)]
        for array, part in zip(whole, found or (), strict=False):
            if part is not None:
                array[finite] = part
        return Values(whole[0], whole[1], whole[2] if second else None)

    @property
    def _axis(self) -> FloatArray:
        return np.zeros(3) if self.motion.rotation_axis is None else np.asarray(self.motion.rotation_axis)

    @property
    def _centre(self) -> FloatArray:
        return self.middle if self.motion.centre is None else np.asarray(self.motion.centre)

    def _turn(self, angle: float) -> FloatArray:
        return rotation(self._axis, float(angle))


def rotation(axis: FloatArray, angle: float) -> FloatArray:
    """The matrix (3, 3) of a rotation by an angle (rad) about a unit vector."""
    cross = _cross_matrix(axis)
    return np.asarray(np.eye(3) + np.sin(angle) * cross + 2.0 * np.sin(0.5 * angle) ** 2 * (cross @ cross))


def turned(values: Values, turn: FloatArray | None, multiplier: float = 1.0) -> Values:
    """Values of a field that was turned (None: not) together with the points, and multiplied."""
    B, gradient, second = values
    if turn is not None:
        B = B @ turn.T
        gradient = turn @ gradient @ turn.T
        if second is not None:
            second = np.einsum("ia,pabc,jb,kc->pijk", turn, second, turn, turn, optimize=True)
    if multiplier == 1.0:
        return Values(B, gradient, second)
    return Values(multiplier * B, multiplier * gradient, None if second is None else multiplier * second)


def _cross_matrix(vector: FloatArray) -> FloatArray:
    """[v] with [v] x = v × x."""
    x, y, z = vector
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
