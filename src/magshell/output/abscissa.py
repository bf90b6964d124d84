"""What curves are drawn against: the field, the angle of what turns, the place of what moves, or the load factor."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np

from magshell.arrays import FloatArray
from magshell.errors import InputError, suggest
from magshell.magnetics.fields import UniformField

if TYPE_CHECKING:
    from magshell.solver.critical import CriticalPoint
    from magshell.solver.path import Path
    from magshell.solver.step import Step

FIELD, LOAD_FACTOR = "field", "load_factor"
FLUX = r"$|B^\mathrm{ext}|$ (mT)"
_SUBSCRIPTS = str.maketrans("123", "₁₂₃")

Points: TypeAlias = "Sequence[Step | CriticalPoint]"


class Abscissa(NamedTuple):
    """A quantity that every point of a path has.

    Attributes
    ----------
    name : str
        For the command line: `field`, `load_factor`, or an amount of the field such as `field.angle` or `magnet.d3`.
    label, text : str
        Of the axis, with its unit: with mathematics for matplotlib, and as text.
    of : callable
        Its values (points,) at steps or critical points of the path, in that unit.
    """

    name: str
    label: str
    text: str
    of: Callable[[Points], FloatArray]


def abscissae(path: Path) -> list[Abscissa]:
    """What the curves of a path can be drawn against; the first is the usual one.

    That is the flux density of a uniform field, negative where it is reversed; where the field or a magnet turns, its
    angle; otherwise the load factor, plus the number of the stages before. Amounts of a field that varies in space are
    offered if they vary along the path.
    """
    amounts = _amounts(path, path.steps)
    varying = {name: i for i, name in enumerate(path.model.field.drives) if np.ptp(amounts[:, i]) > 0.0}
    angles = [_amount(path, name, i) for name, i in varying.items() if name.endswith(".angle")]
    field = path.model.field
    uniform = isinstance(field, UniformField)
    flux = [_flux(field, turning=bool(angles))] if isinstance(field, UniformField) and field.magnitude else []
    factor = Abscissa(LOAD_FACTOR, "load factor", "load factor", _load_factors)
    others = [_amount(path, name, i) for name, i in varying.items() if not (uniform or name.endswith(".angle"))]
    return [*angles, *flux, factor, *others]


def abscissa(path: Path, name: str | None = None) -> Abscissa:
    """The one of that name; without a name, the usual one.

    Raises
    ------
    InputError
        No such one for this path.
    """
    found = {one.name: one for one in abscissae(path)}
    if name is None:
        return next(iter(found.values()))
    if name not in found:
        raise InputError(f"There is no '{name}' to draw curves over. {suggest(name, found)}")
    return found[name]


def _flux(field: UniformField, turning: bool) -> Abscissa:
    """|B| in mT; of a field that does not turn, negative where it is reversed."""

    def values(points: Points) -> FloatArray:
        flux = _rows((point.flux_density for point in points), 3)
        return 1e3 * (np.linalg.norm(flux, axis=1) if turning else flux @ (field.vector / field.magnitude))

    return Abscissa(FIELD, FLUX, "|B| (mT)", values)


def _amount(path: Path, name: str, column: int) -> Abscissa:
    owner, _, what = name.rpartition(".")
    kind, number = what.rstrip("0123456789"), what.lstrip("abcdefghijklmnopqrstuvwxyz")
    whose = "the field" if owner == FIELD else owner
    text, factor = {
        "angle": (f"angle of {whose} (°)", float(np.degrees(1.0))),
        "d": (f"displacement of {whose} along X{number.translate(_SUBSCRIPTS)} (mm)", 1e3),
        "current": (f"current {number} of {whose} (A)", 1.0),
    }.get(kind, (f"{what} of {whose}", 1.0))
    return Abscissa(name, text.replace("$", r"\$"), text, lambda points: factor * _amounts(path, points)[:, column])


def _amounts(path: Path, points: Points) -> FloatArray:
    """Amounts of the field (points, drives): linear in the load factor within each stage."""
    found = (path.courses[point.stage].amounts(point.load_factor).drives for point in points)
    return _rows(found, len(path.model.field.drives))


def _rows(rows: Iterable[FloatArray], columns: int) -> FloatArray:
    return np.array(list(rows), dtype=float).reshape(-1, columns)


def _load_factors(points: Points) -> FloatArray:
    return np.array([float(point.stage + point.load_factor) for point in points])
