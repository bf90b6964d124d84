"""A field that a Python function gives."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from magshell.arguments import real
from magshell.arrays import FloatArray
from magshell.errors import InputError
from magshell.magnetics.fields.differences import STEP, general
from magshell.magnetics.fields.field import Values
from magshell.magnetics.fields.motion import Motion, MovingField

Function = Callable[[FloatArray], FloatArray]


@dataclass(frozen=True, eq=False)
class FunctionField(MovingField):
    """The field of a function of positions.

    Its derivatives are central differences of sixth order, unless the gradient is given (then second derivatives are
    differences of the gradient). Nothing is projected: of a function with curl or divergence the gradient has them.

    Parameters
    ----------
    function : callable
        From positions (n, 3), m, to B (n, 3), T.
    length : float
        Over which B varies considerably, m; steps of differences are 0.008 of it.
    gradient : callable, optional
        From positions (n, 3) to ∂B_i/∂x_j (n, 3, 3), T/m.
    motion : Motion, optional
    name : str
        Of its columns in `history.csv`.

    Raises
    ------
    InputError
        A length that is not positive; later, values that are not finite or of another shape.
    """

    function: Function
    length: float
    gradient: Function | None = None
    motion: Motion = field(default_factory=Motion)
    name: str = "function"

    def __post_init__(self) -> None:
        if not callable(self.function) or not (self.gradient is None or callable(self.gradient)):
            raise InputError(f"{self.name}: function and gradient must be functions of positions (n, 3)")
        self.check_motion()
        if not 0.0 < real(f"{self.name}: length", self.length, "a length (m)") < np.inf:
            raise InputError(f"{self.name}: length is {self.length!r} m; it must be positive")

    def own(self, points: FloatArray, second: bool) -> Values:
        step = np.full(len(points), STEP * self.length)
        if self.gradient is None:
            return general(self._flux_density, points, step, second)
        B, gradient = self._flux_density(points), self._called(self.gradient, points, (3, 3))
        if not second:
            return Values(B, gradient, None)
        rows = [general(partial(self._row, i), points, step, False).gradient for i in range(3)]
        whole = np.stack(rows, axis=1)
        return Values(B, gradient, 0.5 * (whole + whole.swapaxes(2, 3)))

    def _flux_density(self, points: FloatArray) -> FloatArray:
        return self._called(self.function, points, (3,))

    def _row(self, i: int, points: FloatArray) -> FloatArray:
        """∂B_i/∂x (n, 3)."""
        assert self.gradient is not None
        return self._called(self.gradient, points, (3, 3))[:, i]

    def _called(self, function: Function, points: FloatArray, shape: tuple[int, ...]) -> FloatArray:
        values = np.asarray(function(points.copy()), dtype=float)
        if values.shape != (len(points), *shape):
            raise InputError(
                f"{self.name}: for {len(points)} positions the function gives an array of shape {values.shape}; it "
                f"must be {(len(points), *shape)}"
            )
        bad = ~np.isfinite(values).all(axis=tuple(range(1, values.ndim)))
        if bad.any():
            place = ", ".join(f"{x:.6g}" for x in points[bad][0])
            raise InputError(f"{self.name}: the function is not finite at ({place}) m")
        return values
