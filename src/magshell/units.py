"""Quantities with units, as people write them: "0.9 mm" in, SI out, and back.

This is the only place that knows a unit; everywhere else a number is in metre, pascal, tesla, newton and radian.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from decimal import Decimal, localcontext

from magshell.errors import InputError
from magshell.nearest import nearest

_PI = "3.14159265358979323846264338327950288"
_NUMBER = re.compile(r"\s*([+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]{1,6})?)(.*)", re.DOTALL)
_DECIMAL_COMMA = re.compile(r"\s*([+-]?[0-9]*),([0-9]+)(?![0-9,.])(.*)", re.DOTALL)
_FRACTION = re.compile(r"\s*[+-]?[0-9.]+\s*/\s*[0-9]")
_NOT_FINITE = re.compile(r"\s*[+-]?(nan|inf|infinity)\b", re.IGNORECASE)


@dataclass(frozen=True)
class Dimension:
    """A kind of quantity and the units it may be written in.

    Attributes
    ----------
    name : str
        For messages.
    units : dict of str to Decimal
        Value of one unit in SI; the SI unit is the first.
    display : tuple of (str, float)
        Unit and the smallest magnitude (SI) that is shown in it, in falling order.
    usual : tuple of (str, float)
        Unit that is suggested for a number without one, and the magnitude below which it is, in rising order; beyond
        the last the SI unit.
    """

    name: str
    units: dict[str, Decimal]
    display: tuple[tuple[str, float], ...]
    usual: tuple[tuple[str, float], ...] = ()

    @property
    def allowed(self) -> str:
        return ", ".join(self.units)

    def value(self, unit: str) -> float | None:
        """Value of a unit in SI; None: there is no such unit."""
        found = self.units.get(spelled(unit))
        return None if found is None else float(found)


def spelled(unit: str) -> str:
    """A unit as the tables here spell it: its micro sign (U+00B5) may be written as a Greek mu (U+03BC)."""
    return unit.replace("\u03bc", "\u00b5")


def _dimension(
    name: str, units: dict[str, str], display: dict[str, float], usual: dict[str, float] | None = None
) -> Dimension:
    values = {unit: Decimal(value) for unit, value in units.items()}
    return Dimension(name, values, tuple(display.items()), tuple((usual or {}).items()))


with localcontext() as _context:
    _context.prec = 36
    _DEGREE = str(Decimal(_PI) / 180)
    _VACUUM_PERMEABILITY = str(Decimal(_PI) * Decimal("4e-7"))
    _KILOAMPERE = str(Decimal(_PI) * Decimal("4e-4"))

LENGTH = _dimension(
    "length",
    {"m": "1", "cm": "1e-2", "mm": "1e-3", "um": "1e-6", "µm": "1e-6"},
    {"m": 1.0, "mm": 1e-4, "um": 0.0},
    usual={"m": 0.05, "mm": 1e4},
)
STRESS = _dimension(
    "stress",
    {"Pa": "1", "kPa": "1e3", "MPa": "1e6", "GPa": "1e9", "N/mm^2": "1e6"},
    {"GPa": 1e9, "MPa": 1e6, "kPa": 1e3, "Pa": 0.0},
    usual={"MPa": 1.0, "kPa": 1e4},
)
_TESLA = {"T": "1", "mT": "1e-3", "uT": "1e-6", "µT": "1e-6", "G": "1e-4", "Gauss": "1e-4"}
_SHOWN_TESLA = {"T": 1.0, "mT": 1e-4, "uT": 0.0}
FLUX_DENSITY = _dimension("magnetic flux density", _TESLA, _SHOWN_TESLA, usual={"T": 0.5, "mT": 1e4})
REMANENCE = _dimension(
    "remanence",
    {**_TESLA, "A/m": _VACUUM_PERMEABILITY, "kA/m": _KILOAMPERE, "emu/cm^3": _KILOAMPERE},
    _SHOWN_TESLA,
    usual={"T": 2.0, "mT": 1e4},
)
"""A remanent flux density, also as the magnetisation M that makes it: mu0 M."""
ANGLE = _dimension("angle", {"rad": "1", "deg": _DEGREE}, {"deg": 0.0}, usual={"rad": 3.2, "deg": math.inf})
INVERSE_LENGTH = _dimension("inverse length", {"1/m": "1", "1/mm": "1e3"}, {"1/mm": 1e3, "1/m": 0.0})
FORCE = _dimension(
    "force",
    {"N": "1", "kN": "1e3", "mN": "1e-3", "uN": "1e-6", "µN": "1e-6"},
    {"N": 1.0, "mN": 1e-4, "uN": 0.0},
)
MOMENT = _dimension(
    "moment",
    {"N m": "1", "N mm": "1e-3", "mN m": "1e-3", "mN mm": "1e-6", "uN m": "1e-6", "µN m": "1e-6"},
    {"N m": 1.0, "N mm": 1e-6, "uN m": 0.0},
    usual={"N mm": math.inf},
)
ACCELERATION = _dimension("acceleration", {"m/s^2": "1", "mm/s^2": "1e-3"}, {"m/s^2": 0.0})
STIFFNESS = _dimension(
    "stiffness",
    {"N/m": "1", "N/mm": "1e3", "mN/mm": "1", "mN/m": "1e-3"},
    {"N/mm": 1e3, "N/m": 1e-1, "mN/m": 0.0},
)
LINE_STIFFNESS = _dimension(
    "stiffness per length",
    {"N/m^2": "1", "N/mm^2": "1e6", "Pa": "1", "kPa": "1e3", "MPa": "1e6"},
    {"N/mm^2": 1e5, "N/m^2": 0.0},
)
AREA_STIFFNESS = _dimension(
    "stiffness per area",
    {"N/m^3": "1", "N/mm^3": "1e9", "Pa/m": "1", "kPa/mm": "1e6", "kPa/m": "1e3"},
    {"N/mm^3": 1e8, "kPa/mm": 1e5, "N/m^3": 0.0},
)
ANGULAR_STIFFNESS = _dimension(
    "torsional stiffness",
    {
        "N m/rad": "1",
        "N mm/rad": "1e-3",
        "mN m/rad": "1e-3",
        "mN mm/rad": "1e-6",
        "uN m/rad": "1e-6",
        "µN m/rad": "1e-6",
    },
    {"N m/rad": 1.0, "N mm/rad": 1e-6, "uN m/rad": 0.0},
)
HINGE_STIFFNESS = _dimension(
    "torsional stiffness per length",
    {
        "N/rad": "1",
        "mN/rad": "1e-3",
        "N m/rad/m": "1",
        "N mm/rad/mm": "1",
        "mN mm/rad/mm": "1e-3",
        "N mm/rad/m": "1e-3",
    },
    {"N/rad": 0.1, "mN/rad": 0.0},
)
DENSITY = _dimension("density", {"kg/m^3": "1", "g/cm^3": "1e3"}, {"kg/m^3": 0.0})
MASS = _dimension("mass", {"kg": "1", "g": "1e-3", "mg": "1e-6"}, {"kg": 1.0, "g": 1e-4, "mg": 0.0})
CURRENT = _dimension("current", {"A": "1", "mA": "1e-3", "kA": "1e3"}, {"kA": 1e3, "A": 1.0, "mA": 0.0})
MAGNETIC_MOMENT = _dimension(
    "magnetic moment", {"A m^2": "1", "mA m^2": "1e-3", "emu": "1e-3"}, {"A m^2": 0.1, "mA m^2": 0.0}
)
FLUX_GRADIENT = _dimension(
    "gradient of flux density",
    {"T/m": "1", "mT/m": "1e-3", "mT/mm": "1", "G/cm": "1e-2"},
    {"T/m": 0.1, "mT/m": 0.0},
)
NUMBER = Dimension("number without unit", {}, ())

QUANTITIES = (
    LENGTH,
    STRESS,
    FLUX_DENSITY,
    REMANENCE,
    ANGLE,
    INVERSE_LENGTH,
    FORCE,
    MOMENT,
    ACCELERATION,
    STIFFNESS,
    LINE_STIFFNESS,
    AREA_STIFFNESS,
    ANGULAR_STIFFNESS,
    HINGE_STIFFNESS,
    DENSITY,
    MASS,
    CURRENT,
    MAGNETIC_MOMENT,
    FLUX_GRADIENT,
)
"""All kinds that have a unit."""

_IN_PLACE_OF_H = {one.name: f" (units: {one.allowed})" for one in QUANTITIES} | {
    FLUX_DENSITY.name: ": in air 1 Oe belongs to a flux density of 1 G",
    REMANENCE.name: ": write the remanence in T or G, or the magnetisation in kA/m or emu/cm^3",
}


def parse(value: object, dimension: Dimension, unit: str | None = None) -> float:
    """Turn a quantity into a float.

    Parameters
    ----------
    value : str, int or float
        Number and unit, such as "0.9 mm". A bare number is accepted for ``NUMBER``, elsewhere only exactly 0.
    dimension : Dimension
        What kind of quantity is expected.
    unit : str, optional
        Unit of the result; SI without it.

    Returns
    -------
    float
        The double nearest to the decimal number written, in `unit`.

    Raises
    ------
    InputError
        Not a number, not finite, no unit where one is needed, or a unit of another kind.
    """
    number, found = _split(value, dimension)
    if not math.isfinite(float(number)):
        raise InputError(f"{quoted(value)} is not a finite number")
    if not dimension.units:
        if found:
            raise InputError(f"{quoted(value)} has the unit '{shortened(found)}' where a {dimension.name} is expected")
        return float(number)
    if not found:
        if float(number) == 0.0:
            return 0.0
        raise InputError(
            f"{quoted(value)} has no unit where a {dimension.name} is expected; write a string such as "
            f'"{_as_written(value)} {_usual_unit(abs(float(number)), dimension)}" (units: {dimension.allowed})'
        )
    if found not in dimension.units:
        raise InputError(f"{quoted(value)} {_wrong_unit(found, dimension)}")
    with localcontext() as context:
        context.prec = 36
        result = float(number * (dimension.units[found] / dimension.units[unit or next(iter(dimension.units))]))
    if not math.isfinite(result):
        raise InputError(f"{quoted(value)} is not a finite number")
    return result


def show(value: float, dimension: Dimension, digits: int = 4) -> str:
    """Write an SI value for people, in the unit that keeps the number short.

    Parameters
    ----------
    value : float
        In SI units.
    dimension : Dimension
        Kind of quantity.
    digits : int, optional
        Significant digits.
    """
    if not dimension.units:
        return f"{value:.{digits}g}"
    if value == 0.0:
        return "0"
    unit = next(name for name, smallest in dimension.display if abs(value) >= smallest)
    return f"{value / float(dimension.units[unit]):.{digits}g} {unit}"


def _split(value: object, dimension: Dimension) -> tuple[Decimal, str]:
    """Number and unit text of what was written."""
    if isinstance(value, int | float) and not isinstance(value, bool):
        try:
            return Decimal(repr(float(value))), ""
        except OverflowError:
            raise InputError(f"{quoted(value)} is not a finite number") from None
    if not isinstance(value, str):
        raise InputError(f"{quoted(value)} is not a {dimension.name}; {_example(dimension)}")
    if _NOT_FINITE.match(value):
        raise InputError(f"{quoted(value)} is not a finite number")
    if comma := _DECIMAL_COMMA.fullmatch(value):
        point = f"{comma[1] or 0}.{comma[2]}{comma[3]}"
        raise InputError(f'{quoted(value)} has a decimal comma; write a point: "{shortened(point)}"')
    match = _NUMBER.fullmatch(value)
    if match is None:
        raise InputError(f"{quoted(value)} does not begin with a number; {_example(dimension)}")
    number, unit = match.group(1), " ".join(match.group(2).split())
    if float(number) == 0.0:
        number = "0"
    unit = spelled(unit)
    return Decimal(number), "1" + unit if unit.startswith("/") else unit


def _wrong_unit(found: str, dimension: Dimension) -> str:
    if found in ("Oe", "kOe"):
        return (
            f"is in oersted, a unit of the field strength H and not of {dimension.name}{_IN_PLACE_OF_H[dimension.name]}"
        )
    if dimension is FLUX_DENSITY and found in REMANENCE.units:
        return (
            f"is a magnetisation or field strength where a {dimension.name} is expected: in air 1 kA/m belongs to "
            f"1.2566 mT (units: {dimension.allowed})"
        )
    if _FRACTION.match("1" + found):
        return "is a fraction; write a decimal number"
    for other in QUANTITIES:
        if found in other.units:
            return f"is a {other.name} where a {dimension.name} is expected (units: {dimension.allowed})"
    near = nearest(found, dimension.units)
    hint = f"; did you mean '{near}'?" if near else ""
    return f"has the unknown unit '{shortened(found)}'{hint} (units of {dimension.name}: {dimension.allowed})"


def _example(dimension: Dimension) -> str:
    if not dimension.units:
        return "write a number such as 0.5"
    unit = _usual_unit(1.0, dimension)
    return f'write a number with its unit, such as "1 {unit}" (units: {dimension.allowed})'


def _usual_unit(magnitude: float, dimension: Dimension) -> str:
    """Usual unit for numbers of this size."""
    return next((unit for unit, most in dimension.usual if magnitude < most), next(iter(dimension.units)))


def _as_written(value: object) -> str:
    """A number as one would write it: 30 for 30.0."""
    return shortened(str(value).strip().removesuffix(".0"))


def shortened(text: str) -> str:
    """Text on one line of at most 40 characters, for a message."""
    printable = "".join(c if c.isprintable() else " " for c in text)
    return printable if len(printable) <= 40 else printable[:37] + "..."


def quoted(value: object) -> str:
    """What the user wrote, on one short line, for a message."""
    try:
        return f"'{shortened(str(value))}'"
    except ValueError:  # an integer of more digits than Python prints
        return "a huge integer"
