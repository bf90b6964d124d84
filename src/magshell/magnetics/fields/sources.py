"""The field of magnets and coils that move as one."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from magshell.arguments import real
from magshell.arrays import FloatArray, IntArray
from magshell.errors import InputError
from magshell.keys import Key
from magshell.magnetics.fields.field import FieldUnknown, Values
from magshell.magnetics.fields.lattice import NEAREST, Lattice
from magshell.magnetics.fields.magpy import is_of_magpylib, shapes_of
from magshell.magnetics.fields.motion import Motion, MovingField, rotation, turned, vector
from magshell.magnetics.fields.shapes import LEAST, Shape

POINT = 1e-9
"""Distance, m, within which a point is at a dipole: far above the round-off of places."""
OUTSIDE = -1


@dataclass(frozen=True, eq=False)
class Source:
    """A magnet or coil in its place before the first stage.

    Parameters
    ----------
    shape : Shape
    position : array_like, shape (3,)
        Of its middle, m.
    rotation_vector : array_like, shape (3,)
        From the global axes to its own: the direction is the axis, the length the angle, rad.

    Attributes
    ----------
    turn : ndarray, shape (3, 3)
        Its axes in its columns.
    """

    shape: Shape
    position: ArrayLike = (0.0, 0.0, 0.0)
    rotation_vector: ArrayLike = (0.0, 0.0, 0.0)
    turn: FloatArray = field(init=False, repr=False)

    def __post_init__(self) -> None:
        where = self.shape.kind
        object.__setattr__(self, "position", vector(self.position, f"{where}: position"))
        turn = vector(self.rotation_vector, f"{where}: rotation_vector")
        object.__setattr__(self, "rotation_vector", turn)
        angle = float(np.linalg.norm(turn))
        object.__setattr__(self, "turn", rotation(turn / angle, angle) if angle else np.eye(3))

    @property
    def place(self) -> FloatArray:
        """Its position as an array (3,)."""
        return np.asarray(self.position)

    def local(self, points: FloatArray) -> FloatArray:
        """Points (n, 3) in its own axes."""
        return (points - self.place) @ self.turn

    def values(self, points: FloatArray, second: bool) -> Values:
        """Its field at points (n, 3)."""
        still = not np.any(np.asarray(self.rotation_vector))
        return turned(self.shape.values(self.local(points), second), None if still else self.turn)

    def moved(self, turn: FloatArray, shift: FloatArray) -> Source:
        """Turned by a matrix (3, 3) about the origin and then shifted."""
        from scipy.spatial.transform import Rotation

        return Source(self.shape, turn @ self.place + shift, Rotation.from_matrix(turn @ self.turn).as_rotvec())


@dataclass(frozen=True, eq=False)
class Kind:
    """A magnet or a coil, or a set of them, that problem files know.

    Attributes
    ----------
    make : callable
        From the values of the keys to a shape, or to sources that are placed about the origin.
    keys : mapping of str to Key
        Its parameters.
    """

    make: Callable[..., Shape | Sequence[Source]]
    keys: Mapping[str, Key]

    def sources(self, **values: Any) -> tuple[Source, ...]:
        """The sources about the origin.

        Raises
        ------
        InputError
            Values that do not make one.
        """
        made = self.make(**values)
        return (Source(made),) if isinstance(made, Shape) else tuple(made)


@dataclass(frozen=True, eq=False)
class MagnetField(MovingField):
    """The field of magnets and coils that move as one, and whose strengths and currents vary as one.

    Fields of others that move otherwise are added with ``+``, and so is a uniform field.

    Parameters
    ----------
    sources : sequence
        Objects of magpylib (magnets, circles, closed polylines, dipoles, collections of these), as they are now: later
        changes of them change nothing here. Or `Source`, or shapes of `magshell.magnetics.fields`.
    motion : Motion, optional
        By default the strength grows from 0 to that of the sources in the first stage.
    spacing : float, optional
        With it the field of all sources is interpolated by splines on a lattice of this spacing, m, in the frame of the
        sources; see `interpolation_error`. Points must be 8 spacings from surfaces and wires; at 12, the error of B is
        some 1e-5 of it.
    name : str
        Of its columns in `history.csv`.

    Raises
    ------
    InputError
        No sources; something that is no source, has no polarisation or current, or no size.
    """

    sources: Sequence[Any]
    motion: Motion = field(default_factory=Motion)
    spacing: float | None = None
    name: str = "magnets"
    _lattice: Lattice | None = field(init=False, repr=False)

    def __post_init__(self) -> None:
        sources = tuple(_sources_of(self.sources))
        if not sources:
            raise InputError(f"{self.name}: there is no magnet and no coil")
        object.__setattr__(self, "sources", sources)
        self.check_motion()
        if self.spacing is not None and not 0.0 < real(f"{self.name}: spacing", self.spacing, "a length (m)") < np.inf:
            raise InputError(f"{self.name}: spacing is {self.spacing!r} m; it must be positive")
        lattice = None if self.spacing is None else Lattice(self._flux_density, self.spacing)
        object.__setattr__(self, "_lattice", lattice)

    @property
    def middle(self) -> FloatArray:
        return np.asarray(np.mean([source.place for source in self.sources], axis=0))

    def own(self, points: FloatArray, second: bool) -> Values:
        self._check_known(points)
        return self.direct(points, second) if self._lattice is None else self._lattice.values(points, second)

    def direct(self, points: FloatArray, second: bool = True) -> Values:
        """Values at points (n, 3) of the frame without interpolation."""
        total = self.sources[0].values(points, second)
        for source in self.sources[1:]:
            total = total.plus(source.values(points, second))
        return total

    def interpolation_error(self, amounts: FloatArray, points: FloatArray) -> tuple[float, float, float]:
        """Largest errors of B, T, ∇B, T/m, and ∇∇B, T/m², by interpolation at points (n, 3)."""
        turn, shift = self.placement(amounts)
        frame = (points - shift) @ turn
        pairs = zip(self.own(frame, True), self.direct(frame), strict=True)
        errors = [float(np.abs(one - other).max(initial=0.0)) for one, other in pairs]  # type: ignore[operator]
        return errors[0], errors[1], errors[2]

    def now(self, amounts: FloatArray) -> tuple[Source, ...]:
        """The sources in their places for given amounts."""
        turn, shift = self.placement(amounts)
        return tuple(source.moved(turn, shift) for source in self.sources)

    def containing(self, amounts: FloatArray, points: FloatArray) -> IntArray:
        """Number (n,) of the source in whose material each of some points (n, 3) lies; `OUTSIDE` where in none."""
        turn, shift = self.placement(amounts)
        frame, found = (points - shift) @ turn, np.full(len(points), OUTSIDE)
        for number, source in enumerate(self.sources):
            found[source.shape.inside(source.local(frame))] = number
        return found

    def _check_known(self, points: FloatArray) -> None:
        """Refuse points on surfaces and wires, where magpylib gives 0, and those too near for the splines."""
        for source in self.sources:
            least = _touching(source.shape) if self.spacing is None else NEAREST * self.spacing
            away = np.linalg.norm(points - source.place, axis=1)
            near = np.flatnonzero(away <= source.shape.size + least)
            distance = source.shape.distance(source.local(points[near]))
            if not np.any(distance <= least):
                continue
            nearest = int(np.argmin(distance))
            raise FieldUnknown(
                self._fault(source, points[near[nearest]], float(distance[nearest])), points[near[nearest]]
            )

    def _fault(self, source: Source, point: FloatArray, distance: float) -> str:
        kind, place = source.shape.kind, ", ".join(f"{x:.6g}" for x in point)
        frame = (
            "" if self.motion.displacement is None and self.motion.rotation is None else " in the frame of the sources"
        )
        where = f"{self.name}: the point ({place}) m{frame} is"
        if distance <= _touching(source.shape):
            return (
                f"{where} on the surface or wire of a {kind}, where its field jumps or has no limit; move one of them"
            )
        return (
            f"{where} {distance:.3g} m from the surface of a {kind}; splines of spacing {self.spacing:g} m are for "
            f"{NEAREST * float(self.spacing or 0.0):.3g} m and more. Choose a spacing of {distance / NEAREST:.2g} m or "
            "less, or none"
        )

    def _flux_density(self, points: FloatArray) -> FloatArray:
        """B (n, 3) at points of the frame."""
        total = np.zeros(points.shape)
        for source in self.sources:
            total += source.shape.flux_density(source.local(points)) @ source.turn.T
        return total


def _touching(shape: Shape) -> float:
    """Distance from the surface, the wire or the dipole within which a point is on it, m."""
    return max(LEAST * shape.size, POINT)


def _sources_of(given: Any) -> Iterable[Source]:
    if isinstance(given, Source | Shape) or is_of_magpylib(given):
        given = (given,)
    try:
        entries = list(given)
    except TypeError:
        raise InputError(f"magnets: {given!r} is no source and no list of sources") from None
    for number, one in enumerate(entries):
        if isinstance(one, Source):
            yield one
        elif isinstance(one, Shape):
            yield Source(one)
        elif is_of_magpylib(one):
            for shape, position, rotation_vector in shapes_of(one):
                yield Source(shape, position, rotation_vector)
        else:
            raise InputError(
                f"magnets[{number}]: {type(one).__name__} is no source; it takes objects of magpylib, or Source"
            )
