"""What a drawing is made of: lines and smooth curves in the plane, each on a layer."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from magshell.arrays import FloatArray

STEP = np.radians(5.0)
"""Angle from one point of a circle to the next."""
FINE = 5
"""Divisions of a piece of a curve between two of its points, where areas and distances are measured."""
FOLLOWED = 1e-4
"""Of its size: how far the chords between the points of a curve may be off it."""


@dataclass(frozen=True, eq=False)
class Piece:
    """A line, an arc or another smooth curve.

    Attributes
    ----------
    points : (k, 2)
        From one end to the other: the ends of a line, or points of a curve. The first is the last where it is closed.
    layer : str
    arc : bool
        Whether the points lie on a circle.
    entity : int
        Number of what it is a part of in the file, as of a polyline; -1: it stands alone.
    """

    points: FloatArray
    layer: str
    arc: bool = False
    entity: int = -1

    @property
    def line(self) -> bool:
        """Whether it is straight."""
        return len(self.points) == 2

    @property
    def closed(self) -> bool:
        """Whether it ends where it begins."""
        return bool((self.points[0] == self.points[-1]).all())

    @property
    def length(self) -> float:
        """Sum of its chords."""
        return float(np.linalg.norm(np.diff(self.points, axis=0), axis=1).sum())

    @property
    def reversed(self) -> Piece:
        """The same, from its end to its beginning."""
        return replace(self, points=self.points[::-1])

    def between(self, begin: FloatArray, end: FloatArray) -> Piece:
        """Moved, turned and scaled so that it has other ends; ends that become one are bent together."""
        if self.closed:
            return self
        z = self.points @ (1.0, 1.0j)
        first, last = begin @ (1.0, 1.0j), end @ (1.0, 1.0j)
        share = np.linspace(0.0, 1.0, len(z))
        moved = z + (1.0 - share) * (first - z[0]) + share * (last - z[-1])
        if first != last:
            moved = first + (z - z[0]) * (last - first) / (z[-1] - z[0])
        points = np.column_stack([moved.real, moved.imag])
        points[0], points[-1] = begin, end
        return replace(self, points=points, arc=self.arc and first != last)

    def centre(self) -> FloatArray:
        """Of its circle."""
        a, b, c = (self.points[place] for place in (0, len(self.points) // 3, 2 * len(self.points) // 3))
        matrix = 2.0 * np.array([b - a, c - a])
        found: FloatArray = np.linalg.solve(matrix, [b @ b - a @ a, c @ c - a @ a])
        return found

    def fine(self) -> FloatArray:
        """Points (n, 2) so dense that straight lines between them are as good as the piece."""
        if self.line:
            return self.points
        if self.arc:
            centre = self.centre()
            away = (self.points - centre) @ (1.0, 1.0j)
            angle = np.unwrap(np.angle(away))
            radius = np.abs(away)
        else:
            from scipy.interpolate import CubicSpline

            along = np.concatenate([[0.0], np.linalg.norm(np.diff(self.points, axis=0), axis=1).cumsum()])
            curve = CubicSpline(along, self.points)
        steps = np.arange(len(self.points))
        dense = np.linspace(0.0, steps[-1], FINE * steps[-1] + 1)
        if not self.arc:
            points: FloatArray = curve(np.interp(dense, steps, along))
        else:
            turned = np.interp(dense, steps, radius) * np.exp(1j * np.interp(dense, steps, angle))
            points = centre + np.column_stack([turned.real, turned.imag])
        points[0], points[-1] = self.points[0], self.points[-1]
        return points


@dataclass(frozen=True, eq=False)
class Drawing:
    """What a file draws.

    Attributes
    ----------
    pieces : list of Piece
        In the file's unit of length.
    millimetres : float or None
        Length of that unit; None where the file does not say it.
    unit : str
        Its name.
    notes : tuple of str
        What was left out.
    """

    pieces: list[Piece]
    millimetres: float | None
    unit: str
    notes: tuple[str, ...] = ()


def circle(centre: FloatArray, radius: float, layer: str) -> Piece:
    """A whole circle."""
    angle = np.linspace(0.0, 2.0 * np.pi, round(2.0 * np.pi / STEP) + 1)
    points = centre + radius * np.column_stack([np.cos(angle), np.sin(angle)])
    points[-1] = points[0]
    return Piece(points, layer, arc=True)


def counted(numbers: dict[str, int], what: str) -> list[str]:
    """Notes of what was left out."""
    listed = ", ".join(f"{count} {name}" for name, count in sorted(numbers.items()))
    return [f"{what} left out: {listed}"] if numbers else []
