"""Tables of things that describe their keys themselves: loads, supports, material laws."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal, Optional

from pydantic import create_model

from magshell.errors import suggest
from magshell.keys import Key, defaults
from magshell.problem import fields
from magshell.problem.schema.table import Table


def table_of(cls: type, keys: Mapping[str, Key], choice: str, name: str, base: type[Table]) -> type[Table]:
    """The table of a class.

    Parameters
    ----------
    cls : type
        A dataclass or NamedTuple; its parameters are the keys, with its defaults.
    keys : mapping of str to Key
        Their descriptions.
    choice, name : str
        Key that chooses among the classes, and what it says for this one.
    base : type of Table

    Raises
    ------
    TypeError
        The class, or its description, is wrong.
    """
    known = defaults(cls)
    columns: dict[str, Any] = {choice: (Literal[name], ...)}
    for key, description in keys.items():
        kind = getattr(fields, description.kind, None)
        if kind is None:
            near = suggest(description.kind, [name for name in vars(fields) if name[0].isupper()])
            raise TypeError(f"{cls.__name__}: '{description.kind}' of {key} is no kind of value. {near}")
        default = known.get(key, None if description.otherwise else ...)
        columns[key] = (Optional[kind] if default is None else kind, default)  # noqa: UP045
    return create_model(f"{cls.__name__}Table", __base__=base, __doc__=cls.__doc__, **columns)
