"""What a user writes: the keys of a load, a support or a material law, described once, beside its class.

Of these descriptions are made the tables of problem files, the words of their errors and the reference page. The
parameters of the class are the keys, with its defaults.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Collection, Mapping
from typing import Any, NamedTuple


class Key(NamedTuple):
    """A key of a table.

    Attributes
    ----------
    kind : str
        What may stand to the right of the equals sign: a type of `magshell.problem.fields`.
    meaning : str
        A sentence of the reference page.
    otherwise : str
        In words, what holds where the key is left out; empty: the default as it stands, or the key is required.
    """

    kind: str
    meaning: str
    otherwise: str = ""


HISTORY = Key(
    "History",
    "Multiplier at the end of each stage; left out: 1 at the end of the first and from then on.",
    "`[1, 1, …]`",
)


def defaults(make: Callable[..., Any]) -> Mapping[str, Any]:
    """The parameters of a class or function that have a default, with it."""
    parameters = inspect.signature(make).parameters.values()
    return {one.name: one.default for one in parameters if one.default is not one.empty}


def fits(make: Callable[..., Any], keys: Collection[str]) -> bool:
    """Whether a class or function can be called with values for these keys and nothing else."""
    try:
        inspect.signature(make).bind(**dict.fromkeys(keys))
    except TypeError:
        return False
    return True
