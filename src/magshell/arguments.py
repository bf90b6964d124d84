"""Arguments of the wrong class: what was given, what it must be, and how that is written."""

from __future__ import annotations

import contextlib
import inspect
import reprlib
from collections.abc import Iterable
from typing import Any

from magshell.arrays import three_finite
from magshell.errors import InputError

Kinds = type | tuple[type, ...]


def shown(value: Any) -> str:
    """A value in messages, shortened where it is long."""
    return reprlib.repr(value)


def instance(where: str, value: Any, kinds: Kinds, wanted: str) -> None:
    """Refuse what is of none of some classes.

    Raises
    ------
    InputError
        It is not; the message says what is wanted.
    """
    if not isinstance(value, kinds):
        raise InputError(f"{where} is {shown(value)}; it must be {wanted}")


def several(where: str, values: Any, kinds: Kinds, wanted: str) -> tuple[Any, ...]:
    """The members of a sequence, all of one of some classes.

    Raises
    ------
    InputError
        It is no sequence, or a member is of another class.
    """
    if isinstance(values, kinds) and not isinstance(values, str):
        raise InputError(f"{where} is one {type(values).__name__}; put it into a list")
    if isinstance(values, str) or not isinstance(values, Iterable):
        raise InputError(f"{where} is {shown(values)}; it must be a list, each entry {wanted}")
    members = tuple(values)
    for number, member in enumerate(members):
        instance(f"{where}[{number}]", member, kinds, wanted)
    return members


def on_groups(where: str, values: Any, kinds: Kinds, wanted: str) -> tuple[Any, ...]:
    """The same of what has its place by names of groups, in which there can be slips too.

    Raises
    ------
    InputError
        As by `several`, or a name that is no text.
    """
    members = several(where, values, kinds, wanted)
    for number, member in enumerate(members):
        for attribute in ("group", "image", "name"):
            name = getattr(member, attribute, None)
            if not (name is None or isinstance(name, str)):
                raise InputError(f"{where}[{number}]: {attribute} is {shown(name)}; it must be one name, as text")
    return members


def real(where: str, value: Any, wanted: str = "a number") -> float:
    """A number, finite or not.

    Raises
    ------
    InputError
        It is none.
    """
    with contextlib.suppress(TypeError, ValueError):
        if not isinstance(value, bool | str | bytes):
            return float(value)
    raise InputError(f"{where} is {shown(value)}; it must be {wanted}")


def sampling(where: str, value: Any, module: str, what: str) -> None:
    """Refuse what is no function of a mesh and points, as remanence and a thickness that varies are.

    Parameters
    ----------
    where : str
    value : object
    module : str
        That has ways to make them, as users write it.
    what : str
        What they give.

    Raises
    ------
    InputError
        It cannot be called, or with other arguments.
    """
    if not callable(value):
        given = f"[{', '.join(f'{one:g}' for one in vector)}]" if (vector := three_finite(value)) is not None else ""
        instead = f"{module}.constant({given})" if given else f"made by {module}, for instance {module}.constant([…])"
        raise InputError(f"{where} is {shown(value)}; it must be {what}: {instead}")
    try:
        inspect.signature(value).bind(None, None)
    except TypeError:
        raise InputError(
            f"{where} is a function of other arguments than mesh and points; for a function of the position write "
            f"{module}.function(…)"
        ) from None
    except ValueError:  # some callables of C have no signature
        return
