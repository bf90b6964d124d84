"""What a magnet or a coil is: its field in its own axes, where it is singular, and how it looks.

A shape is a frozen dataclass that inherits from `Shape`. Its file has everything about it: the keys of its table
in problem files, what `magshell check` prints, its surface for pictures. The field comes from magpylib
(https://magpylib.readthedocs.io), which is imported when the first value is asked for.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import AnyArray, FloatArray
from magshell.errors import InputError
from magshell.keys import Key
from magshell.magnetics.fields.differences import STEP, harmonic
from magshell.magnetics.fields.field import Values

AT_ONCE = 2000
"""Points whose differences are taken in one call of magpylib: all that it keeps stays in the processor's cache."""
LEAST = 1e-6
"""Least distance from a surface, over the size of the source, that gives a step of differences."""


class Shape(ABC):
    """A magnet or coil in its own axes, with its middle at the origin.

    Attributes
    ----------
    kind : str
        Its name in problem files and messages.
    keys : mapping of str to Key
        Its parameters.
    is_coil : bool
    size : float
        Radius of a ball about the origin that holds it, m; of a dipole 0.
    """

    kind: ClassVar[str]
    keys: ClassVar[Mapping[str, Key]]
    is_coil: ClassVar[bool] = False

    @property
    @abstractmethod
    def size(self) -> float: ...

    @abstractmethod
    def bodies(self) -> Sequence[tuple[float, Any]]:
        """Objects of magpylib in these axes and their factors; the field is the sum."""

    @abstractmethod
    def distance(self, points: FloatArray) -> FloatArray:
        """Distance (n,), m, of points (n, 3) from the nearest surface or wire."""

    def inside(self, points: FloatArray) -> AnyArray:
        """Which of some points (n, 3) lie in its material."""
        return np.zeros(len(points), dtype=bool)

    @property
    def poles(self) -> FloatArray | None:
        """Direction (3,) from its south to its north pole, of any length; None: it is a coil."""
        return None

    @abstractmethod
    def surface(self) -> Any:
        """Its surface, a `pyvista.PolyData`."""

    @abstractmethod
    def words(self) -> str:
        """The shape in `magshell check`."""

    def flux_density(self, points: FloatArray) -> FloatArray:
        """B (n, 3), T, at points (n, 3)."""
        total = np.zeros(points.shape)
        with np.errstate(all="ignore"):  # at edges and wires, where B is not finite
            for factor, body in self._bodies:
                total += factor * body.getB(points).reshape(points.shape)
        return total

    def values(self, points: FloatArray, second: bool) -> Values:
        """B and its derivatives at points (n, 3)."""
        step = STEP * np.maximum(self.distance(points), LEAST * self.size)
        starts = range(0, len(points), AT_ONCE)
        pieces = [harmonic(self.flux_density, points[k : k + AT_ONCE], step[k : k + AT_ONCE], second) for k in starts]
        if len(pieces) == 1:
            return pieces[0]
        B, gradient = (np.concatenate([piece[part] for piece in pieces] or [np.empty(shape)]) for part, shape in PARTS)
        seconds = [piece.second for piece in pieces if piece.second is not None]
        return Values(B, gradient, np.concatenate(seconds or [np.empty((0, 3, 3, 3))]) if second else None)

    @cached_property
    def _bodies(self) -> tuple[tuple[float, Any], ...]:
        return tuple(self.bodies())

    def _positive(self, *names: str) -> None:
        """Refuse parameters that are not positive and finite."""
        for name in names:
            value = getattr(self, name)
            if isinstance(value, bool) or not isinstance(value, int | float | np.number) or not 0.0 < value < np.inf:
                raise InputError(f"{self.kind}: {name} is {value!r}; it must be positive")

    def _vector(self, name: str, what: str) -> None:
        """Make a parameter an array (3,), and refuse one that is not finite or zero."""
        vector = self._numbers(name, (3,))
        if not vector.any():
            raise InputError(f"{self.kind}: {name} is zero: the {what} has no field; give it, or leave the {what} out")

    def _numbers(self, name: str, shape: tuple[int | None, ...]) -> FloatArray:
        """Make a parameter an array of finite numbers of a shape, None for any length."""
        value: ArrayLike = getattr(self, name)
        try:
            array = np.array(value, dtype=float)
        except (TypeError, ValueError):
            array = np.empty(0)
        fits = array.ndim == len(shape) and all(
            want in (None, have) for want, have in zip(shape, array.shape, strict=False)
        )
        if not fits or not np.isfinite(array).all():
            expected = " × ".join("n" if count is None else str(count) for count in shape)
            raise InputError(f"{self.kind}: {name} is {value!r}; it needs {expected} finite numbers")
        array.flags.writeable = False
        object.__setattr__(self, name, array)
        return array


PARTS: tuple[tuple[int, tuple[int, ...]], ...] = ((0, (0, 3)), (1, (0, 3, 3)))


def distance_from_box(points: FloatArray, half: FloatArray) -> FloatArray:
    """Signed distance (n,) of points (n, d) from the surface of a box of half lengths (d,), negative inside."""
    beyond = np.abs(points) - half
    return np.asarray(np.linalg.norm(np.maximum(beyond, 0.0), axis=1) + np.minimum(beyond.max(axis=1), 0.0))


def meridian(points: FloatArray) -> FloatArray:
    """Distance from the third axis and height (n, 2)."""
    return np.stack([np.hypot(points[:, 0], points[:, 1]), points[:, 2]], axis=1)


def distance_from_segments(points: FloatArray, ends: FloatArray) -> FloatArray:
    """Distance (n,) of points (n, d) from the nearest of some segments (m, 2, d)."""
    least = np.full(len(points), np.inf)
    for start, end in ends:
        along = end - start
        share = np.clip((points - start) @ along / max(float(along @ along), 1e-300), 0.0, 1.0)
        least = np.minimum(least, np.linalg.norm(points - start - share[:, None] * along, axis=1))
    return least
