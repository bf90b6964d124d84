"""What may stand to the right of an equals sign in a problem file: quantities, counts, names, lists of them.

Every type here turns a value as TOML gives it into SI and raises `InputError` with what is wrong and what
would be right; where it is wrong is added by `magshell.problem.reading`.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection
from fractions import Fraction
from functools import partial
from typing import Annotated, Any, Literal, get_args

from pydantic import AfterValidator, BeforeValidator, Discriminator, StrictBool, Tag, ValidationInfo

from magshell import units
from magshell.errors import InputError, suggest
from magshell.magnetics import COUPLINGS
from magshell.materials import Multiple
from magshell.mesh.files.names import named
from magshell.model.parts import MOST_LEVELS
from magshell.model.region import OFFSETS
from magshell.model.supports import DIMENSION_OF_FIELD
from magshell.nearest import nearest
from magshell.shell.elements import ELEMENTS

# Beyond these no shell exists; within them no product of two magnitudes overflows or vanishes.
SMALLEST, LARGEST = 1e-12, 1e12
MOST_DIVISIONS = 10_000
_NAME = re.compile(r"\w[\w '*+.-]*")
_PROBE_NAME = re.compile(r"\w[\w'-]*")


def _read(value: object, dimension: units.Dimension, unit: str | None = None) -> float:
    number = units.parse(value, dimension, unit)
    if abs(number) > LARGEST or 0.0 < abs(number) < SMALLEST:
        raise InputError(f"{units.quoted(value)} is beyond any {dimension.name} that makes sense")
    return number


def _quantity(dimension: units.Dimension, unit: str | None = None) -> BeforeValidator:
    return BeforeValidator(partial(_read, dimension=dimension, unit=unit))


def _read_positive(value: object, dimension: units.Dimension) -> float:
    number = _read(value, dimension)
    if number <= 0.0:
        raise InputError(f"{units.quoted(value)} is not positive")
    return number


def _positive_quantity(dimension: units.Dimension) -> BeforeValidator:
    return BeforeValidator(partial(_read_positive, dimension=dimension))


def dimension_of(kind: Any) -> units.Dimension:
    """Dimension of a single quantity, which is one of the types below."""
    found: units.Dimension = get_args(kind)[1].func.keywords["dimension"]
    return found


_MULTIPLE = re.compile(r"\s*\+?([0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE]([+-]?[0-9]{1,2}))?\s*(\w+)\s*")


def _or_multiple(dimension: units.Dimension, symbol: str, *, what: str) -> BeforeValidator:
    def read(value: object) -> float:
        if isinstance(value, Multiple):
            return value
        found = _MULTIPLE.fullmatch(value) if isinstance(value, str) and len(value) <= 40 else None
        if found is not None and units.spelled(found[3]).replace("\u00b5", "mu") == symbol:
            return Multiple(Fraction(found[1]) * Fraction(10) ** int(found[2] or 0))
        try:
            return _not_negative(_read(value, dimension))
        except InputError as error:
            raise InputError(f'{error}; or write a multiple of the {what}, such as "1 {symbol}"') from None

    return BeforeValidator(read)


def _list_of(count: int | tuple[int, ...], what: str) -> BeforeValidator:
    counts = (count,) if isinstance(count, int) else count

    def read(value: object) -> object:
        if not isinstance(value, list | tuple) or len(value) not in counts:
            has = f"has {len(value)} entries" if isinstance(value, list | tuple) else "is not a list"
            raise InputError(f"{has}; expected {' or '.join(map(str, counts))}: {what}")
        return value

    return BeforeValidator(read)


def _count(value: object) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or not 1 <= value <= MOST_DIVISIONS:
        raise InputError(f"{units.quoted(value)} is not a whole number from 1 to {MOST_DIVISIONS}")
    return value


def _text_like(pattern: re.Pattern[str], rule: str) -> Callable[[object], str]:
    def read(value: object) -> str:
        if not isinstance(value, str):
            raise InputError(f"{units.quoted(value)} is not a name; write it in quotes")
        if not pattern.fullmatch(value):
            here = named(({value: ()}, {}, {}))[0][0, value] if pattern is _NAME else ""
            renamed = (
                f"; a group that a mesh file calls so is {units.quoted(here)} here" if value.strip() and here else ""
            )
            raise InputError(f"{units.quoted(value)} is not a name: {rule}{renamed}")
        return value

    return read


def _file_name(value: object) -> str:
    if not isinstance(value, str):
        raise InputError(f"{units.quoted(value)} is not a file name; write it in quotes")
    if not value.strip() or not value.isprintable():
        raise InputError(f"{units.quoted(value)} is not a file name")
    return value


def _unit_of(dimension: units.Dimension) -> BeforeValidator:
    def read(value: object) -> str:
        if not isinstance(value, str) or dimension.value(value) is None:
            raise InputError(
                f"{units.quoted(value)} is not a unit of {dimension.name}. {suggest(str(value)[:40], dimension.units)}"
            )
        return units.spelled(value)

    return BeforeValidator(read)


def _as_list(value: object) -> object:
    return value if isinstance(value, list | tuple) else [value]


def _one_or_more(value: object) -> object:
    if value == []:
        raise InputError("is an empty list; name at least one or leave the key out")
    return [value] if isinstance(value, str) else value


def _one_each(what: str) -> Callable[[object], object]:
    def read(value: object) -> object:
        if not isinstance(value, list | tuple) or not value:
            fault = "is empty" if value in ([], ()) else "is not a list"
            raise InputError(f"{fault}; expected one {what} for each stage")
        return value

    return read


def _offset(value: object) -> object:
    if value in OFFSETS:
        return value
    if isinstance(value, str) and value[:1].isalpha():
        raise InputError(f"{units.quoted(value)} is neither a face nor a length. {suggest(value, OFFSETS)}")
    return _read(value, units.LENGTH)


def _levels(value: object) -> object:
    if isinstance(value, bool) or not isinstance(value, int) or not 1 <= value <= MOST_LEVELS:
        raise InputError(f"{units.quoted(value)} is not a whole number from 1 to {MOST_LEVELS}")
    return value


def _coordinate(value: object) -> float | tuple[float, float]:
    if not isinstance(value, list | tuple):
        return _read(value, units.LENGTH)
    if len(value) != 2:
        raise InputError(f"has {len(value)} entries; expected one coordinate, or the least and the greatest")
    return _read(value[0], units.LENGTH), _read(value[1], units.LENGTH)


def _radius(value: object) -> float | tuple[float, float]:
    if not isinstance(value, list | tuple):
        return _read_positive(value, units.LENGTH)
    if len(value) != 2:
        raise InputError(f"has {len(value)} entries; expected the largest distance, or the least and the largest")
    return _not_negative(_read(value[0], units.LENGTH)), _read_positive(value[1], units.LENGTH)


def _outline(value: object) -> object:
    if not isinstance(value, list | tuple) or len(value) < 3:
        has = f"has {len(value)} corners" if isinstance(value, list | tuple) else "is not a list"
        raise InputError(f"{has}; expected three or more, each a pair of coordinates X1, X2")
    return value


def _several_places(value: object) -> object:
    if not isinstance(value, list | tuple) or len(value) < 3:
        has = f"has {len(value)} entries" if isinstance(value, list | tuple) else "is not a list"
        raise InputError(f"{has}; expected three or more, each with coordinates X1, X2, X3")
    return value


def not_empty(value: object) -> object:
    """A list or table that must hold something."""
    if value in ([], {}, ()):
        raise InputError("is empty; it needs at least one entry")
    return value


def _not_zero(value: float) -> float:
    if not value:
        raise InputError("is zero; leave the table out")
    return value


def _not_negative(value: float) -> float:
    if value < 0.0:
        raise InputError("is negative; it must be zero or positive")
    return value


def _nonzero(value: tuple[float, float, float]) -> tuple[float, float, float]:
    if not any(value):
        raise InputError("is the zero vector; it must have a direction")
    return value


Length = Annotated[float, _quantity(units.LENGTH)]
PositiveLength = Annotated[float, _positive_quantity(units.LENGTH)]
NonNegativeLength = Annotated[float, _quantity(units.LENGTH), AfterValidator(_not_negative)]
NonNegativeStress = Annotated[float, _quantity(units.STRESS), AfterValidator(_not_negative)]
PositiveStress = Annotated[float, _positive_quantity(units.STRESS)]
CouplingModulus = Annotated[Any, _or_multiple(units.STRESS, "mu", what="shear modulus")]
LengthScale = Annotated[Any, _or_multiple(units.LENGTH, "h", what="thickness")]
FluxDensity = Annotated[float, _quantity(units.FLUX_DENSITY)]
PositiveFluxDensity = Annotated[float, _positive_quantity(units.FLUX_DENSITY)]
Remanence = Annotated[float, _quantity(units.REMANENCE)]
PositiveRemanence = Annotated[float, _positive_quantity(units.REMANENCE)]
Force = Annotated[float, _quantity(units.FORCE)]
Moment = Annotated[float, _quantity(units.MOMENT)]
Pressure = Annotated[float, _quantity(units.STRESS), AfterValidator(_not_zero)]
Stress = Annotated[float, _quantity(units.STRESS)]
Stiffness = Annotated[float, _positive_quantity(units.STIFFNESS)]
LineStiffness = Annotated[float, _positive_quantity(units.LINE_STIFFNESS)]
AreaStiffness = Annotated[float, _positive_quantity(units.AREA_STIFFNESS)]
FluxGradient = Annotated[float, _quantity(units.FLUX_GRADIENT)]
AnyCurrent = Annotated[float, _quantity(units.CURRENT)]
Current = Annotated[float, _quantity(units.CURRENT), AfterValidator(_not_zero)]
DipoleMoment = Annotated[float, _quantity(units.MAGNETIC_MOMENT)]
AngularStiffness = Annotated[float, _positive_quantity(units.ANGULAR_STIFFNESS)]
HingeStiffness = Annotated[float, _positive_quantity(units.HINGE_STIFFNESS)]
PositiveMass = Annotated[float, _positive_quantity(units.MASS)]
Acceleration = Annotated[float, _quantity(units.ACCELERATION)]
PositiveDensity = Annotated[float, _positive_quantity(units.DENSITY)]
Angle = Annotated[float, _quantity(units.ANGLE)]
Degrees = Annotated[float, _quantity(units.ANGLE, unit="deg")]
Number = Annotated[float, _quantity(units.NUMBER)]
PositiveNumber = Annotated[float, _positive_quantity(units.NUMBER)]
Count = Annotated[int, BeforeValidator(_count)]

Name = Annotated[str, BeforeValidator(_text_like(_NAME, "letters, digits, spaces and _ - + . * ' only"))]
ProbeName = Annotated[str, BeforeValidator(_text_like(_PROBE_NAME, "letters, digits and _ - ' only"))]
FileName = Annotated[str, BeforeValidator(_file_name)]
LengthUnit = Annotated[str, _unit_of(units.LENGTH)]
FluxDensityUnit = Annotated[str, _unit_of(units.FLUX_DENSITY)]
RemanenceUnit = Annotated[str, _unit_of(units.REMANENCE)]
Names = Annotated[tuple[Name, ...], BeforeValidator(_one_or_more)]

Divisions = Annotated[tuple[Count, Count], _list_of(2, "numbers of elements in the two directions")]
AngleRange = Annotated[tuple[Degrees, Degrees], _list_of(2, "first and last angle")]
LengthRange = Annotated[tuple[Length, Length], _list_of(2, "least and greatest coordinate")]
LengthPair = Annotated[tuple[PositiveLength, PositiveLength], _list_of(2, "lengths")]
NamePair = Annotated[tuple[Name, Name], _list_of(2, "names of points")]
Coordinate = Annotated[float | tuple[float, float], BeforeValidator(_coordinate)]
Radius = Annotated[float | tuple[float, float], BeforeValidator(_radius)]
Position = Annotated[tuple[Length, Length, Length], _list_of(3, "coordinates X1, X2, X3")]
FluxVector = Annotated[
    tuple[FluxDensity, FluxDensity, FluxDensity],
    _list_of(3, "components of the flux density along X1, X2, X3"),
]
RemanenceVector = Annotated[
    tuple[Remanence, Remanence, Remanence],
    _list_of(3, "components of the remanence along X1, X2, X3"),
]
Direction = Annotated[
    tuple[Number, Number, Number], _list_of(3, "components along X1, X2, X3"), AfterValidator(_nonzero)
]
ForceVector = Annotated[
    tuple[Force, Force, Force], _list_of(3, "components of the force along X1, X2, X3"), AfterValidator(_nonzero)
]
MomentVector = Annotated[
    tuple[Moment, Moment, Moment], _list_of(3, "components of the moment about X1, X2, X3"), AfterValidator(_nonzero)
]
StressVector = Annotated[
    tuple[Stress, Stress, Stress], _list_of(3, "components of the traction along X1, X2, X3"), AfterValidator(_nonzero)
]
AccelerationVector = Annotated[
    tuple[Acceleration, Acceleration, Acceleration],
    _list_of(3, "components of the acceleration along X1, X2, X3"),
    AfterValidator(_nonzero),
]
GradientRow = Annotated[tuple[FluxGradient, FluxGradient, FluxGradient], _list_of(3, "derivatives along X1, X2, X3")]
GradientTensor = Annotated[
    tuple[GradientRow, GradientRow, GradientRow], _list_of(3, "rows, the gradients of B1, B2, B3")
]
Polarisation = Annotated[
    tuple[Remanence, Remanence, Remanence],
    _list_of(3, "components of the polarisation along the magnet's own axes"),
    AfterValidator(_nonzero),
]
MagneticMoment = Annotated[
    tuple[DipoleMoment, DipoleMoment, DipoleMoment],
    _list_of(3, "components of the magnetic moment"),
    AfterValidator(_nonzero),
]
Sides = Annotated[tuple[PositiveLength, PositiveLength, PositiveLength], _list_of(3, "lengths along its own axes")]
PlaneSides = Annotated[tuple[PositiveLength, PositiveLength], _list_of(2, "lengths along its first two axes")]
Sector = Annotated[tuple[Angle, Angle], _list_of(2, "first and last angle")]
Places = Annotated[tuple[Position, ...], BeforeValidator(_several_places)]
Displacements = Annotated[tuple[Position, ...], BeforeValidator(_one_each("displacement"))]
Currents = Annotated[
    tuple[tuple[AnyCurrent, ...], ...], BeforeValidator(_one_each("list of currents, one of each coil,"))
]
History = Annotated[tuple[Number, ...], BeforeValidator(_one_each("multiplier"))]
Rotation = Annotated[tuple[Angle, ...], BeforeValidator(_one_each("angle"))]
Remanences = Annotated[tuple[Remanence, ...], BeforeValidator(_as_list), AfterValidator(not_empty)]
Angles = Annotated[tuple[Angle, ...], BeforeValidator(_as_list), AfterValidator(not_empty)]
Positions = Annotated[tuple[Length, ...], BeforeValidator(not_empty)]
Corner = Annotated[tuple[Length, ...], _list_of((2, 3), "coordinates X1, X2 and, out of the plane, X3")]
Corners = Annotated[tuple[Corner, Corner, Corner, Corner], _list_of(4, "corners, one after the other")]

PlaneCorner = Annotated[tuple[Length, Length], _list_of(2, "coordinates X1 and X2")]
Outline = Annotated[tuple[PlaneCorner, ...], BeforeValidator(_outline)]


def _count_or_list(value: object) -> str:
    return "list" if isinstance(value, list | tuple) else "count"


FieldStops = Annotated[
    Annotated[Count, Tag("count")] | Annotated[tuple[PositiveFluxDensity, ...], Tag("list")],
    Discriminator(_count_or_list),
]
StageStops = Annotated[
    Annotated[Count, Tag("count")] | Annotated[tuple[PositiveNumber, ...], Tag("list")], Discriminator(_count_or_list)
]


def one_of(names: Collection[str]) -> BeforeValidator:
    """A name of a registry, which may grow."""

    def read(value: object) -> object:
        if value not in names:
            *others, last = (f"'{name}'" for name in names)
            near = nearest(value, names) if isinstance(value, str) else None
            hint = f"; did you mean '{near}'?" if near else ""
            raise InputError(f"{units.quoted(value)} is not one of {', '.join(others)} or {last}{hint}")
        return value

    return BeforeValidator(read)


def _component(value: object, info: ValidationInfo) -> object:
    if info.data.get("field") == "phi" and value is not None:
        raise InputError("makes no sense with the field phi, which has only one; leave it out")
    return value


def _nodal_value(value: object, info: ValidationInfo) -> float | tuple[float, ...]:
    """Value of a nodal field, or of its three components: u in m, w a number, phi in 1/m, omega in rad."""
    if "field" not in info.data:
        return 0.0
    dimension = DIMENSION_OF_FIELD[info.data["field"]]
    if not isinstance(value, list | tuple):
        return _read(value, dimension)
    one = info.data["field"] == "phi" or info.data.get("component") is not None
    if one or len(value) != 3:
        expected = "one value" if one else "one value, or three along X1, X2, X3"
        raise InputError(f"has {len(value)} entries; expected {expected}")
    return tuple(_read(each, dimension) for each in value)


Switch = StrictBool
Offset = Annotated[str | float, BeforeValidator(_offset)]
Levels = Annotated[int, BeforeValidator(_levels)]
NodalField = Literal["u", "w", "phi", "omega"]
Component = Annotated[Literal[1, 2, 3] | None, AfterValidator(_component)]
NodalValue = Annotated[float | tuple[float, float, float], BeforeValidator(_nodal_value)]
Element = Annotated[str, one_of(ELEMENTS)]
Coupling = Annotated[str, one_of(COUPLINGS)]
