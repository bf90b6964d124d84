"""Values that `--set` gives to a key of a problem file, one after the other.

`KEY=VALUES`, where VALUES is a list of quantities, numbers, names, true and false ("0.4,0.8 mm": a number without a
unit takes that of the next one that has one), a range "first:last:count" ("0 mT:50 mT:11"), or lists and tables as
TOML writes them ('[0, 0, "5 mT"], [0, "5 mT", 0]').
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Context, Decimal
from typing import Any

from magshell.errors import InputError
from magshell.units import NUMBER, QUANTITIES, Dimension, parse, quoted, shortened, spelled

MOST_VALUES = 10_000
_QUANTITY = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,3})?)\s*(\D.*)?", re.ASCII)
_WHOLE = re.compile(r"[+-]?\d{1,15}")
_FINE = Context(prec=15)


@dataclass(frozen=True)
class Value:
    """One value of a key.

    Attributes
    ----------
    data : object
        As TOML would give it.
    text : str
        As a person would write it.
    number : float or None
        In SI; None for names, lists and tables.
    dimension : Dimension
        What kind of number it is.
    """

    data: Any
    text: str
    number: float | None = None
    dimension: Dimension = NUMBER


@dataclass(frozen=True)
class Setting:
    """A key of a problem file, as error messages write it, and the values that it takes."""

    key: str
    values: tuple[Value, ...]


def read_settings(texts: Sequence[str]) -> list[Setting]:
    """The settings that were asked for, each `KEY=VALUES`.

    Raises
    ------
    InputError
        What cannot be read, one line for each text.
    """
    settings: list[Setting] = []
    faults = []
    for text in texts:
        try:
            setting = read_setting(text)
            if any(setting.key == other.key for other in settings):
                raise InputError(f"--set {setting.key}: is given twice; write all its values in one")
            settings.append(setting)
        except InputError as error:
            faults.append(str(error))
    if faults:
        raise InputError("\n".join(faults))
    return settings


def read_setting(text: str) -> Setting:
    """One `KEY=VALUES`.

    Raises
    ------
    InputError
        It cannot be read.
    """
    key, equals, values = (part.strip() for part in text.partition("="))
    if not equals or not key or not values:
        raise InputError(f"--set {shortened(text)}: write KEY=VALUES, such as shell.thickness=0.4,0.8 mm")
    try:
        return Setting(key, tuple(_distinct(_values(values))))
    except InputError as error:
        raise InputError(f"--set {shortened(key)}: {error}") from None


def read_changes(texts: Sequence[str]) -> dict[str, Any]:
    """Key and value, as TOML gives it, of settings that have one value each.

    Raises
    ------
    InputError
        What cannot be read, or has several values.
    """
    changes = {}
    for setting in read_settings(texts):
        if len(setting.values) > 1:
            listed = ", ".join(value.text for value in setting.values[:3])
            raise InputError(f"--set {setting.key}: has {len(setting.values)} values ({listed}, …); a run takes one")
        changes[setting.key] = setting.values[0].data
    return changes


def value_of(data: Any) -> Value:
    """A value from what TOML gives."""
    if isinstance(data, bool | list | dict):
        return Value(data, _toml(data))
    if isinstance(data, int | float):
        return Value(data, str(data), float(data))
    match = _QUANTITY.fullmatch(str(data))
    dimension = _dimension(_unit(match.group(2))) if match else None
    number = parse(data, dimension) if dimension else None
    return Value(data, str(data), number, dimension or NUMBER)


def _distinct(values: Sequence[Value]) -> Sequence[Value]:
    for place, value in enumerate(values):
        if any(value.data == other.data and type(value.data) is type(other.data) for other in values[:place]):
            raise InputError(f"{quoted(value.text)} is listed twice")
    return values


def _values(text: str) -> list[Value]:
    if text[0] in "[{\"'":
        try:
            return [value_of(data) for data in tomllib.loads(f"values = [{text}]")["values"]]
        except (tomllib.TOMLDecodeError, RecursionError):
            raise InputError(f"{quoted(text)} is not a list of values as TOML writes them") from None
    items = [item.strip() for item in text.split(",")]
    if not all(items):
        raise InputError(f"{quoted(text)} has an empty value between its commas")
    units = [_written_unit(item) for item in items]
    values: list[Value] = []
    for place, item in enumerate(items):
        carried = next((unit for unit in [*units[place:], *units[place::-1]] if unit), "")
        values += _range(item, carried) if ":" in item else [_one(item, carried)]
    return values


def _written_unit(item: str) -> str:
    """The unit that stands in a value, or in the end of a range."""
    for part in reversed(item.split(":")):
        if (match := _QUANTITY.fullmatch(part.strip())) and match.group(2):
            return match.group(2)
    return ""


def _one(item: str, unit: str) -> Value:
    match = _QUANTITY.fullmatch(item)
    if match is None:
        return value_of({"true": True, "false": False}.get(item, item))
    if match.group(2) or unit:
        return value_of(f"{match.group(1)} {(match.group(2) or unit).strip()}")
    return value_of(int(item) if _WHOLE.fullmatch(item) else float(item))


def _range(item: str, carried: str) -> list[Value]:
    """The values of "first:last:count"."""
    parts = [part.strip() for part in item.split(":")]
    ends = [_QUANTITY.fullmatch(part) for part in parts[:2]]
    if len(parts) != 3 or None in ends:
        raise InputError(f"{quoted(item)} is not a range; write first:last:count, such as 0 mT:50 mT:11")
    if not _WHOLE.fullmatch(parts[2]) or not 2 <= int(parts[2]) <= MOST_VALUES:
        raise InputError(f"{quoted(item)} asks for {quoted(parts[2])} values; a range has 2 to {MOST_VALUES}")
    count = int(parts[2])
    numbers = [Decimal(end.group(1)) for end in ends if end]
    units = [end.group(2) or "" for end in ends if end]
    unit = units[0] or units[1] or carried
    last = _converted(numbers[1], units[1] or unit, unit, item)
    steps = [
        _FINE.divide(numbers[0] * (count - 1 - place) + last * place, Decimal(count - 1)) for place in range(count)
    ]
    if unit:
        return [value_of(f"{written(step)} {unit.strip()}") for step in steps]
    whole = all(step == step.to_integral_value() and abs(step) < 10**15 for step in steps)
    return [value_of(int(step) if whole else float(step)) for step in steps]


def _converted(number: Decimal, unit: str, to: str, item: str) -> Decimal:
    """The same quantity in another unit."""
    if unit == to:
        return number
    dimension = _dimension(_unit(unit))
    if dimension is None or _unit(to) not in dimension.units:
        raise InputError(f"{quoted(item)} goes from '{shortened(to)}' to '{shortened(unit)}', which do not go together")
    return _FINE.divide(number * dimension.units[_unit(unit)], dimension.units[_unit(to)])


def _unit(text: str | None) -> str:
    """A unit in the spelling of `magshell.units`."""
    unit = spelled(" ".join((text or "").split()))
    return "1" + unit if unit.startswith("/") else unit


def _dimension(unit: str) -> Dimension | None:
    return next((dimension for dimension in QUANTITIES if unit in dimension.units), None)


def written(number: Decimal) -> str:
    """A number without needless zeros, with an exponent only where it is very large or small."""
    number = number.normalize()
    return f"{number:f}" if -7 < number.adjusted() < 15 else str(number)


def _toml(data: Any) -> str:
    """On one line, as TOML writes it."""
    match data:
        case bool():
            return str(data).lower()
        case str():
            return f'"{data}"'
        case list():
            return f"[{', '.join(map(_toml, data))}]"
        case dict():
            return "{" + ", ".join(f"{key} = {_toml(value)}" for key, value in data.items()) + "}"
        case _:
            return str(data)
