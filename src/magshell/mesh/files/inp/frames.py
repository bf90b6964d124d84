"""Coordinate systems, rotations and curves of an input file."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from magshell.arrays import FloatArray


@dataclass(frozen=True)
class Frame:
    """A rectangular coordinate system: position = origin + axes · coordinates."""

    origin: FloatArray
    axes: FloatArray
    """(3, 3): the columns are its directions."""

    def positions(self, coordinates: FloatArray) -> FloatArray:
        """Global positions (n, 3) of local coordinates (n, 3)."""
        return self.origin + coordinates @ self.axes.T


def frame(first: list[float], second: list[float]) -> Frame | None:
    """The frame of `*SYSTEM`: its origin and a point on the first axis, and one beside that axis.

    None if the points define none.
    """
    first = first + [0.0] * (3 - len(first))
    origin = np.array(first[:3])
    if len(first) == 3:
        return Frame(origin, np.eye(3))
    along = np.array((first + [0.0] * (6 - len(first)))[3:6]) - origin
    if second:
        beside = np.array((second + [0.0] * (3 - len(second)))[:3]) - origin
        normal = np.cross(along, beside)
    else:
        along[2], normal = 0.0, np.array([0.0, 0.0, 1.0])
    lengths = np.linalg.norm(along), np.linalg.norm(normal)
    if not min(lengths) > 0.0 or not np.isfinite(lengths).all():
        return None
    e1, e3 = along / lengths[0], normal / lengths[1]
    return Frame(origin, np.column_stack([e1, np.cross(e3, e1), e3]))


def from_cylindrical(coordinates: FloatArray) -> FloatArray:
    """Rectangular coordinates (n, 3) of radius, angle in degrees and height (n, 3)."""
    angle = np.deg2rad(coordinates[:, 1])
    radius = coordinates[:, 0]
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle), coordinates[:, 2]])


def rotated(points: FloatArray, start: FloatArray, end: FloatArray, degrees: float) -> FloatArray:
    """Points (n, 3) turned about the axis from `start` to `end`."""
    from scipy.spatial.transform import Rotation

    axis = (end - start) / np.linalg.norm(end - start)
    turned: FloatArray = Rotation.from_rotvec(axis * np.deg2rad(degrees)).apply(points - start)
    return start + turned


@dataclass(frozen=True)
class Move:
    """A translation, then a rotation about an axis."""

    translation: FloatArray
    start: FloatArray | None = None
    end: FloatArray | None = None
    degrees: float = 0.0

    def __call__(self, points: FloatArray) -> FloatArray:
        """Moved points (n, 3)."""
        moved = points + self.translation
        return moved if self.start is None or self.end is None else rotated(moved, self.start, self.end, self.degrees)


def move(first: list[float], second: list[float]) -> Move | None:
    """The move of two data lines: a translation; two points of an axis and an angle in degrees.

    None if the axis has no direction.
    """
    translation = np.array([*first, 0.0, 0.0, 0.0][:3])
    if not second:
        return Move(translation)
    numbers = np.array([*second, *7 * [0.0]][:7])
    if not np.any(numbers[3:6] != numbers[:3]):
        return None
    return Move(translation, numbers[:3], numbers[3:6], float(numbers[6]))


def straight(start: FloatArray, end: FloatArray, shares: FloatArray) -> FloatArray:
    """Points (n, 3) at shares (n,) of the way."""
    return start + np.outer(shares, end - start)


def parabola(start: FloatArray, end: FloatArray, middle: FloatArray, shares: FloatArray) -> FloatArray:
    """Points (n, 3) of the parabola that is in its middle half way."""
    bulge = middle - 0.5 * (start + end)
    return straight(start, end, shares) + np.outer(4.0 * shares * (1.0 - shares), bulge)


def arc(start: FloatArray, end: FloatArray, centre: FloatArray, shares: FloatArray) -> FloatArray | None:
    """Points (n, 3) at equal angles on the shorter arc; None if there is no such arc."""
    a, b = start - centre, end - centre
    normal = np.cross(a, b)
    radius = np.linalg.norm(a)
    if not abs(np.linalg.norm(b) - radius) < 1e-3 * radius or not np.linalg.norm(normal) > 1e-6 * radius**2:
        return None
    angle = np.arctan2(np.linalg.norm(normal), a @ b)
    across = np.cross(normal / np.linalg.norm(normal), a)
    grown = 1.0 + shares * (np.linalg.norm(b) / radius - 1.0)
    return centre + grown[:, None] * (np.outer(np.cos(shares * angle), a) + np.outer(np.sin(shares * angle), across))
