"""The unit of length of a file."""

from __future__ import annotations

from magshell.errors import InputError, suggest
from magshell.units import LENGTH, quoted, spelled


def length_unit(unit: str) -> float:
    """Value of a unit of length in metres.

    Raises
    ------
    InputError
        No unit of length.
    """
    value = LENGTH.value(str(unit))
    if value is None:
        raise InputError(f"unit: {quoted(unit)} is not a unit of length. {suggest(str(unit), LENGTH.units)}")
    return value


def agreed(given: str | None, said: str | None, name: str) -> str:
    """The unit of a file, from what the user says and what the file says.

    Raises
    ------
    InputError
        Neither says it, they differ, or it is no unit of length.
    """
    for unit in (given, said):
        if unit is not None:
            length_unit(unit)
    if given is None and said is None:
        raise InputError(
            f'unit: is missing: {name} does not say in which unit its lengths are. Write it, as in unit = "mm" '
            f"(magshell mesh: --unit mm); it may be one of {LENGTH.allowed}"
        )
    if given is not None and said is not None and length_unit(given) != length_unit(said):
        raise InputError(f"unit: is '{given}', but {name} says that its lengths are in {said}; leave the unit out")
    return spelled(str(given or said))
