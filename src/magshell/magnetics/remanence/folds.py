"""Flat parts folded along lines or rolled up: isometries in closed form.

A fold is known by a point P of its line, the direction t in the plane of the flat part, from the line into the piece
that moves, and the direction n into which it moves. With s = (X - P) · t, the piece beyond the line (s > 0) turns about
the line, t towards n. A fold of radius r takes the length r θ of the part to reach its angle θ:

    angle at s:  0 before the line,  s/r on the arc,  θ beyond it,
    position:    P + r sin(angle) t + r (1 - cos(angle)) n + what lies off the line, turned.

Folds are given for the flat part, from the piece that stays outwards: a later fold is carried along by the earlier
ones, X -> x_1(x_2(… X)) and R = R_1 R_2 ….
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from magshell import wording
from magshell.arrays import AnyArray, FloatArray
from magshell.errors import InputError
from magshell.keys import Key
from magshell.magnetics.remanence.template import Placed, in_template
from magshell.magnetics.remanence.vectors import direction, first_element, vector
from magshell.units import ANGLE, LENGTH, show

if TYPE_CHECKING:
    from magshell.mesh import Mesh

FLAT = 1e-6
PARALLEL = 1e-6


@dataclass(frozen=True, eq=False)
class Fold:
    """A fold of a flat part.

    Parameters
    ----------
    through : array_like, shape (3,)
        A point of the line, m.
    along : array_like, shape (3,)
        Direction in the plane of the part, normal to the line, into the piece that moves.
    towards : array_like, shape (3,)
        Normal of the plane, into which that piece moves.
    angle : float, optional
        By which it turns, rad. Without it there is no end: the piece is rolled up.
    radius : float
        Of the arc, m; 0 for a sharp fold.

    Raises
    ------
    InputError
        A direction of no length, `towards` not normal to `along`, an angle that is not positive or beyond 180° where
        the fold is sharp, neither angle nor radius.
    """

    through: ArrayLike
    along: ArrayLike
    towards: ArrayLike
    angle: float | None = None
    radius: float = 0.0

    def __post_init__(self) -> None:
        point, t, n = (
            vector("through", self.through),
            direction("along", self.along),
            direction("towards", self.towards),
        )
        if abs(t @ n) > PARALLEL:
            raise InputError(
                "remanence: towards must be normal to along: the one is normal to the flat part, the other lies in it"
            )
        if not np.isfinite(self.radius) or self.radius < 0.0:
            raise InputError(f"remanence: radius is {self.radius!r} m; it must be positive, or 0 for a sharp fold")
        if self.angle is None and self.radius == 0.0:
            raise InputError("remanence: a fold needs an angle, or a radius to roll the part up, or both")
        if self.angle is not None:
            if not np.isfinite(self.angle) or self.angle <= 0.0:
                raise InputError(
                    f"remanence: angle is {self.angle!r} rad; it must be positive (towards says which way)"
                )
            if self.radius == 0.0 and self.angle > np.pi * (1.0 + 1e-12):
                raise InputError(
                    f"remanence: angle is {np.degrees(self.angle):g} deg; a sharp fold turns by 180 at most"
                )
        for name, value in (("through", point), ("along", t), ("towards", n)):
            object.__setattr__(self, name, value)

    @property
    def arc(self) -> float:
        """Length of the part that is bent, m."""
        return np.inf if self.angle is None else self.radius * self.angle

    def reach(self, points: FloatArray) -> FloatArray:
        """s of points (..., 3) of the flat part, m: positive beyond the line."""
        return np.asarray((points - np.asarray(self.through)) @ np.asarray(self.along))

    def place(self, flat: FloatArray, positions: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Positions (..., 3) and rotations (..., 3, 3) after this fold.

        Parameters
        ----------
        flat : FloatArray, shape (..., 3)
            The points in the flat part.
        positions : FloatArray, shape (..., 3)
            Where the later folds have brought them.
        """
        t, n = np.asarray(self.along), np.asarray(self.towards)
        s = self.reach(flat)
        if self.radius > 0.0:
            length = np.clip(s, 0.0, self.arc)
            θ = length / self.radius
        else:
            length, θ = np.zeros(s.shape), np.where(s > 0.0, self.angle or 0.0, 0.0)
        line, cos, sin = np.cross(t, n), np.cos(θ)[..., None, None], np.sin(θ)[..., None, None]
        R = np.outer(line, line) + cos * (np.outer(t, t) + np.outer(n, n)) + sin * (np.outer(n, t) - np.outer(t, n))
        before = np.asarray(self.through) + length[..., None] * t
        after = np.asarray(self.through) + self.radius * (np.sin(θ)[..., None] * t + (1.0 - np.cos(θ))[..., None] * n)
        return after + np.einsum("...ij,...j->...i", R, positions - before), R


@dataclass(frozen=True, eq=False)
class Folded:
    """A flat part after folds, a `Shape`.

    Parameters
    ----------
    folds : sequence of Fold
        From the piece that stays outwards.
    """

    folds: Sequence[Fold]

    def __post_init__(self) -> None:
        if not self.folds:
            raise InputError("remanence: there are no folds; give at least one")

    def place(self, mesh: Mesh, points: FloatArray) -> Placed:
        """Material points in the folded shape.

        Raises
        ------
        InputError
            The part is not flat; a fold begins on the arc of an earlier one.
        """
        close = FLAT * mesh.size
        for number, fold in enumerate(self.folds):
            off = np.abs((points - np.asarray(fold.through)) @ np.asarray(fold.towards))
            if np.any(off > close):
                element = first_element(off > close)
                raise InputError(
                    f"remanence: {self._named(number)}: element {element} lies {np.nanmax(off[element]):.3g} m off the "
                    "plane through `through` normal to `towards`; only what is flat there can be folded or rolled"
                )
            on_arc = (fold.reach(points) > close) & (fold.reach(points) < fold.arc - close)
            for later in range(number + 1, len(self.folds)):
                self._check_apart(on_arc & (self.folds[later].reach(points) > close), number, later)
        positions, R = points, np.broadcast_to(np.eye(3), (*points.shape, 3))
        for fold in reversed(self.folds):
            positions, turned = fold.place(points, positions)
            R = turned @ R
        return Placed(positions, np.asarray(R))

    def _check_apart(self, both: AnyArray, number: int, later: int) -> None:
        if both.any():
            raise InputError(
                f"remanence: {self._named(later)} begins before {self._named(number)} has ended, in element "
                f"{first_element(both)}; give the folds from the piece that stays outwards and leave room for the arcs"
            )

    def _named(self, number: int) -> str:
        return "the fold" if len(self.folds) == 1 else f"folds[{number}]"


def folded(*folds: Fold) -> Folded:
    """A flat part after folds, from the piece that stays outwards."""
    return Folded(folds)


def rolled(radius: float, through: ArrayLike, along: ArrayLike, towards: ArrayLike) -> Folded:
    """A flat part wrapped about a cylinder.

    Parameters
    ----------
    radius : float
        Of the rolled mid-surface, m.
    through : array_like, shape (3,)
        A point of the line at which the cylinder touches the part, m; what lies before it stays flat.
    along : array_like, shape (3,)
        Direction in the plane of the part, normal to the axis of the cylinder, in which it is rolled.
    towards : array_like, shape (3,)
        Normal of the plane, on the side of the cylinder.

    A part longer than 2π radius passes through itself: the layers of a roll are taken to have one radius.
    """
    return Folded((Fold(through, along, towards, radius=radius),))


def _folds(folds: Sequence[Fold]) -> Folded:
    """Of entries that have the parameters of a fold."""
    made = []
    for number, one in enumerate(folds):
        try:
            made.append(Fold(one.through, one.along, one.towards, one.angle, one.radius))
        except InputError as error:
            raise InputError(f".folds[{number}]: {str(error).removeprefix('remanence: ')}") from None
    return folded(*made)


FOLDED = in_template(
    _folds,
    {"folds": Key("Folds", "From the piece that stays outwards, each as on the flat part.")},
    lambda folds: (
        f"folded along {wording.counted(len(folds), 'line')} by {', '.join(show(one.angle, ANGLE) for one in folds)}"
    ),
    in_space=True,
)
ROLLED = in_template(
    rolled,
    {
        "radius": Key("PositiveLength", "Of the rolled mid-surface."),
        "through": Key("Position", "A point of the line at which rolling begins; what lies before stays flat."),
        "along": Key("Direction", "In the flat part, normal to that line: the direction of rolling."),
        "towards": Key("Direction", "Normal of the flat part, to the side of the cylinder."),
    },
    lambda radius, through, along, towards: (
        f"rolled to the radius {show(radius, LENGTH)} towards {wording.vector(towards)}"
    ),
    in_space=True,
)
