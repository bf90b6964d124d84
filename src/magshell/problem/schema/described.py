"""Tables of things that describe their keys themselves: loads, supports, remanences, material laws."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Literal, Optional, get_origin

from pydantic import create_model

from magshell.errors import suggest
from magshell.keys import Key, defaults, fits
from magshell.problem import fields
from magshell.problem.schema.remanence import Folds
from magshell.problem.schema.table import Table

KINDS = {name: kind for name, kind in vars(fields).items() if get_origin(kind) is not None} | {"Folds": Folds}


def table_of(
    choice: str, names: tuple[str, ...], make: Callable[..., Any], keys: Mapping[str, Key], base: type[Table]
) -> type[Table]:
    """The table of something that describes its keys.

    Parameters
    ----------
    choice : str
        Key that chooses among the tables.
    names : tuple of str
        What it may say for this one.
    make : callable
        A class or function whose parameters are the keys, with their defaults.
    keys : mapping of str to Key
        Their descriptions.
    base : type of Table

    Raises
    ------
    TypeError
        A description names no kind of value; keys and parameters differ.
    """
    name, known = names[0], defaults(make)
    if not fits(make, keys):
        raise TypeError(f"{name}: its keys ({', '.join(keys)}) are not the parameters of {make}")
    columns: dict[str, Any] = {choice: (Literal[names], ...)}
    for key, description in keys.items():
        if description.kind not in KINDS:
            near = suggest(description.kind, KINDS)
            raise TypeError(f"{name}: '{description.kind}' of {key} is no kind of value. {near}")
        kind = KINDS[description.kind]
        default = known.get(key, None if description.otherwise else ...)
        columns[key] = (Optional[kind] if default is None else kind, default)  # noqa: UP045
    return create_model(f"{base.__name__} {name}", __base__=base, **columns)
