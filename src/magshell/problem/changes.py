"""A problem file with some of its keys changed, and the rest as it is."""

from __future__ import annotations

import copy
import math
import re
from collections.abc import Mapping
from decimal import Decimal
from typing import Any

from magshell.errors import InputError
from magshell.materials import MODULI
from magshell.problem.alternatives import Value, value_of, written
from magshell.problem.reading import Source, parse
from magshell.units import FLUX_DENSITY, quoted, shortened
from magshell.units import parse as quantity

_WHOLE = ("flux_density", "vector")
_PART = re.compile(r"\.?([^.\[\]]+)|\[(\d{1,6})\]")


def changed(source: Source, changes: Mapping[str, Value]) -> Source:
    """The source with other values at some keys; its title says which.

    Parameters
    ----------
    source : Source
    changes : mapping of str to Value
        By key, as error messages write it: "shell.thickness", "remanence[0].magnitude". A single quantity for the
        vector of a field, remanence or load is its magnitude: the direction stays. Where the flux density is changed,
        stops that then lie beyond its end are left out; where two moduli are given, those of the file.

    Returns
    -------
    Source
        Of the same name and folder. Whether it is a problem is not checked.

    Raises
    ------
    InputError
        The file is not TOML, or does not have the entry of a list that a key names.
    """
    import tomlkit
    from tomlkit.exceptions import TOMLKitError

    parse(source.text, source.name)
    try:
        data = tomlkit.parse(source.text)
    except TOMLKitError as error:
        raise InputError(f"{source.name}: no key of it can be changed: {error}") from None
    for key, value in changes.items():
        try:
            put(data, key, value)
        except InputError as error:
            raise InputError(f"{source.name}: {shortened(key)}: {error}") from None
    _leave_out_moduli(data.get("material"), changes)
    if "field.stops" not in changes and any(key.startswith("field.") for key in changes):
        _leave_out_stops_beyond_the_end(data["field"])
    if changes and "title" not in changes and isinstance(data.get("title", ""), str):
        data["title"] = f"{data.get('title', '')} ({label(changes)})".strip()
    return source._replace(text=tomlkit.dumps(data))


def label(changes: Mapping[str, Value]) -> str:
    """The changes in words."""
    return ", ".join(f"{shortened(key)} = {shortened(value.text)}" for key, value in changes.items())


def put(data: dict[str, Any], key: str, value: Value) -> None:
    """Change one key of plain data in place; tables on the way that are missing are made.

    Raises
    ------
    InputError
        No such entry of a list, or a magnitude for a vector without a direction.
    """
    holder, leaf = _place(data, key)
    if isinstance(holder, dict):
        leaf = _as_given(holder, leaf, value)
    present = holder[leaf] if isinstance(holder, list) else holder.get(leaf)
    if leaf in vectors() and isinstance(present, list) and not isinstance(value.data, list | dict | bool):
        holder[leaf] = _scaled(present, value)
    else:
        holder[leaf] = copy.deepcopy(value.data)


def _as_given(table: Mapping[str, Any], key: str, value: Value) -> str:
    """The key under which a table has a magnitude: its own, or that of the whole vector."""
    if key == "magnitude" and key not in table:
        return next((whole for whole in _WHOLE if isinstance(table.get(whole), list)), key)
    if key in _WHOLE and key not in table and "magnitude" in table and not isinstance(value.data, list):
        return "magnitude"
    return key


def vectors() -> set[str]:
    """Keys of vectors: a magnitude given to one of them keeps the direction that the file says."""
    from magshell.magnetics.remanence import REMANENCES
    from magshell.model.loads import LOADS
    from magshell.model.supports import SUPPORTS

    tables = [one.keys for registry in (REMANENCES, LOADS, SUPPORTS) for one in registry.values()]
    kinds = [(key, about.kind) for keys in tables for key, about in keys.items()]
    return {"flux_density", "moment", *(key for key, kind in kinds if kind.endswith("Vector") or kind == "NodalValue")}


def _place(data: dict[str, Any], key: str) -> tuple[Any, Any]:
    """The table or list that holds a key, and its name or number there."""
    parts = _parts(key)
    holder: Any = data
    while True:
        part = parts.pop(0)
        if isinstance(part, int):
            if not isinstance(holder, list) or part >= len(holder):
                has = f"has {len(holder)} entries" if isinstance(holder, list) else "is not a list"
                raise InputError(f"there is no entry [{part}]: what it names {has} (the first is [0])")
        elif not isinstance(holder, dict):
            raise InputError(f"there is no '{shortened(part)}': what comes before it is not a table")
        else:
            part = _longest_name(holder, part, parts)
        if not parts:
            return holder, part
        if isinstance(holder, dict) and part not in holder:
            if isinstance(parts[0], int):
                raise InputError(f"the file has no list '{shortened(str(part))}'")
            holder[part] = {}
        holder = holder[part]


def _parts(key: str) -> list[str | int]:
    found = list(_PART.finditer(key))
    if "".join(match.group() for match in found) != key or not found or key.startswith((".", "[")):
        raise InputError("is not a key; write it as messages do, such as shell.thickness or remanence[0].magnitude")
    return [match.group(1) or int(match.group(2)) for match in found]


def _longest_name(table: dict[str, Any], first: str, rest: list[str | int]) -> str:
    """A name that the table has may contain dots."""
    names = [first]
    for part in rest:
        if isinstance(part, int):
            break
        names.append(part)
    for count in range(len(names), 1, -1):
        if (name := ".".join(names[:count])) in table:
            del rest[: count - 1]
            return name
    return first


def _scaled(vector: list[Any], value: Value) -> list[Any]:
    """The vector with another magnitude and its own direction."""
    if value.number is None:
        return value.data
    components = [value_of(entry).number for entry in vector]
    if None in components:
        raise InputError(f"is {quoted(vector)}, which has no direction that a magnitude could keep; give a vector")
    length = math.hypot(*(number or 0.0 for number in components))
    if not length:
        raise InputError("is the zero vector, which has no direction that a magnitude could keep; give a vector")
    if isinstance(value.data, int | float):
        return [value.data * (number or 0.0) / length for number in components]
    number, _, unit = value.data.partition(" ")
    shares = [Decimal(number) * Decimal(repr((component or 0.0) / length)) for component in components]
    return [f"{written(share)} {unit}" if share else 0 for share in shares]


def _leave_out_moduli(material: Any, changes: Mapping[str, Value]) -> None:
    """Drop the moduli of the file where two others are given."""
    given = [name for name in MODULI if f"material.{name}" in changes]
    if len(given) == 2 and isinstance(material, dict):
        for name in MODULI:
            if name not in given:
                material.pop(name, None)


def _leave_out_stops_beyond_the_end(field: Any) -> None:
    """Stops that cannot be read stay; the check reports them."""
    try:
        stops = [(stop, quantity(stop, FLUX_DENSITY)) for stop in field["stops"]]
        vector = field["flux_density"] if "flux_density" in field else [field["magnitude"]]
        end = math.hypot(*(quantity(component, FLUX_DENSITY) for component in vector))
        end *= max(abs(float(number)) for number in field.get("history", [1.0]))
    except (InputError, KeyError, TypeError, ValueError, AttributeError):
        return
    field["stops"] = [stop for stop, size in stops if size <= end * (1.0 + 1e-12)]
