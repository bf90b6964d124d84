"""Fields of coils of a laboratory: uniform with a constant gradient, and from currents by calibration.

A gradient tensor of a static field away from its sources is symmetric (free of curl) and free of trace (of divergence);
so five numbers say it, in the order ∂B1/∂x1, ∂B1/∂x2, ∂B1/∂x3, ∂B2/∂x2, ∂B2/∂x3.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import FloatArray
from magshell.errors import InputError
from magshell.magnetics.fields.field import Field, Values
from magshell.magnetics.fields.motion import Motion, MovingField, vector

ALLOWED = 1e-6
"""Curl and divergence of a given tensor over its largest component: round-off of typed numbers."""
FIVE = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2))
ROWS = 8
"""B1, B2, B3 and the five gradients."""


@dataclass(frozen=True, eq=False)
class GradientField(MovingField):
    """B = B0 + G (x − centre), with a constant gradient G.

    Parameters
    ----------
    gradient : array_like, shape (3, 3)
        ∂B_i/∂x_j, T/m: symmetric and free of trace.
    flux_density : array_like, shape (3,)
        B0 at the centre, T.
    centre : array_like, shape (3,)
        m.
    motion : Motion, optional
    name : str
        Of its columns in `history.csv`.

    Raises
    ------
    InputError
        A tensor with curl or divergence.
    """

    gradient: ArrayLike
    flux_density: ArrayLike = (0.0, 0.0, 0.0)
    centre: ArrayLike = (0.0, 0.0, 0.0)
    motion: Motion = field(default_factory=Motion)
    name: str = "gradient"

    def __post_init__(self) -> None:
        self.check_motion()
        object.__setattr__(self, "gradient", _static(self.gradient, self.name))
        object.__setattr__(self, "flux_density", vector(self.flux_density, f"{self.name}: flux_density"))
        object.__setattr__(self, "centre", vector(self.centre, f"{self.name}: centre"))

    @property
    def middle(self) -> FloatArray:
        return np.asarray(self.centre)

    def own(self, points: FloatArray, second: bool) -> Values:
        return _linear(np.asarray(self.flux_density), np.asarray(self.gradient), points - self.middle, second)


@dataclass(frozen=True, eq=False)
class CoilSystem(Field):
    """A uniform field and a constant gradient made by coils whose currents vary along the path.

    Parameters
    ----------
    calibration : array_like, shape (8, coils)
        From currents, A, to B1, B2, B3 at the centre, T, and ∂B1/∂x1, ∂B1/∂x2, ∂B1/∂x3, ∂B2/∂x2, ∂B2/∂x3, T/m. With
        three rows the field is uniform.
    currents : array_like, shape (stages, coils)
        At the end of each stage, A; before the first they are 0, and linear in between.
    centre : array_like, shape (3,)
        m.
    name : str
        Of its columns in `history.csv`.

    Raises
    ------
    InputError
        Numbers that are not finite, or do not fit each other.
    """

    calibration: ArrayLike
    currents: ArrayLike
    centre: ArrayLike = (0.0, 0.0, 0.0)
    name: str = "coils"

    def __post_init__(self) -> None:
        calibration = _table(self.calibration, f"{self.name}: calibration")
        if len(calibration) not in (3, ROWS):
            raise InputError(
                f"{self.name}: calibration has {len(calibration)} rows; it needs {ROWS} (B1, B2, B3, ∂B1/∂x1, ∂B1/∂x2, "
                "∂B1/∂x3, ∂B2/∂x2, ∂B2/∂x3), or 3 for a field without gradient"
            )
        whole = np.zeros((ROWS, calibration.shape[1]))
        whole[: len(calibration)] = calibration
        currents = _table(self.currents, f"{self.name}: currents")
        if currents.shape[1] != whole.shape[1]:
            raise InputError(
                f"{self.name}: currents are for {currents.shape[1]} coils, the calibration for {whole.shape[1]}"
            )
        object.__setattr__(self, "calibration", whole)
        object.__setattr__(self, "currents", currents)
        object.__setattr__(self, "centre", vector(self.centre, f"{self.name}: centre"))

    @property
    def drives(self) -> tuple[str, ...]:
        return tuple(f"{self.name}.current{number + 1}" for number in range(np.shape(self.currents)[1]))

    @property
    def stages(self) -> int:
        return len(np.asarray(self.currents))

    def ends(self, stages: int) -> FloatArray:
        currents = np.asarray(self.currents)
        if len(currents) != stages:
            raise InputError(
                f"{self.name}: currents has {len(currents)} entries; it needs one for each of the {stages} stages of "
                "the path"
            )
        return np.concatenate([np.zeros_like(currents[:1]), currents])

    def at(self, amounts: FloatArray, points: FloatArray, second: bool = True) -> Values:
        made = np.asarray(self.calibration) @ amounts
        return _linear(made[:3], _tensor(made[3:]), points - np.asarray(self.centre), second)

    def rate(self, amounts: FloatArray, change: FloatArray, points: FloatArray) -> Values:
        return self.at(change, points, second=False)

    def currents_for(self, flux_density: ArrayLike, gradient: ArrayLike | None = None) -> FloatArray:
        """The least currents (coils,), A, that make a field (3,), T, and a gradient (3, 3), T/m, at the centre.

        If no gradient is given, it is not controlled.

        Raises
        ------
        InputError
            A gradient with curl or divergence; the coils cannot make this field.
        """
        wanted, rows = vector(flux_density, f"{self.name}: flux_density"), np.asarray(self.calibration)[:3]
        if gradient is not None:
            tensor = _static(gradient, self.name)
            wanted, rows = np.append(wanted, [tensor[place] for place in FIVE]), np.asarray(self.calibration)
        scale = np.linalg.norm(rows, axis=1)
        scale[scale == 0.0] = 1.0
        currents = np.linalg.lstsq(rows / scale[:, None], wanted / scale, rcond=1e-10)[0]
        missed = np.abs(rows @ currents - wanted) / scale
        if missed.max() > 1e-9 * max(float(np.abs(wanted / scale).max()), 1e-300):
            raise InputError(f"{self.name}: these {rows.shape[1]} coils cannot make this field and gradient together")
        return np.asarray(currents)


def _linear(B: FloatArray, gradient: FloatArray, away: FloatArray, second: bool) -> Values:
    count = len(away)
    zero = np.broadcast_to(0.0, (count, 3, 3, 3)) if second else None
    return Values(B + away @ gradient.T, np.broadcast_to(gradient, (count, 3, 3)), zero)


def _tensor(five: FloatArray) -> FloatArray:
    tensor = np.zeros((3, 3))
    for (i, j), value in zip(FIVE, five, strict=True):
        tensor[i, j] = tensor[j, i] = value
    tensor[2, 2] = -tensor[0, 0] - tensor[1, 1]
    return tensor


def _table(value: ArrayLike, where: str) -> FloatArray:
    try:
        table = np.array(value, dtype=float)
    except (TypeError, ValueError):
        table = np.empty(0)
    if table.ndim != 2 or not table.size or not np.isfinite(table).all():
        raise InputError(f"{where} must be rows of finite numbers, all of the same length")
    table.flags.writeable = False
    return table


def _static(value: ArrayLike, name: str) -> FloatArray:
    """A gradient tensor without curl and divergence; what typing rounded off is taken away."""
    tensor = _table(value, f"{name}: gradient")
    if tensor.shape != (3, 3):
        raise InputError(f"{name}: gradient has the shape {tensor.shape}; it needs three rows of three numbers (T/m)")
    largest = float(np.abs(tensor).max())
    trace, twist = float(np.trace(tensor)), tensor - tensor.T
    if abs(trace) > ALLOWED * largest:
        raise InputError(
            f"{name}: the diagonal of the gradient adds up to {trace:.4g} T/m; it must be 0, for a field has no "
            f"divergence. With ∂B1/∂x1 and ∂B2/∂x2 as given, ∂B3/∂x3 is {-tensor[0, 0] - tensor[1, 1]:.4g} T/m"
        )
    i, j = np.unravel_index(int(np.argmax(np.abs(twist))), (3, 3))
    if abs(twist[i, j]) > ALLOWED * largest:
        raise InputError(
            f"{name}: ∂B{i + 1}/∂x{j + 1} is {tensor[i, j]:.4g} and ∂B{j + 1}/∂x{i + 1} is {tensor[j, i]:.4g} T/m; "
            "they must be equal, for a static field has no curl away from currents"
        )
    return np.asarray(0.5 * (tensor + tensor.T) - trace / 3.0 * np.eye(3))
