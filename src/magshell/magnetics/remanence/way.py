"""Description of a way to magnetise for problem files."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from magshell.keys import Key
from magshell.magnetics.remanence.vectors import Remanence

MAGNITUDE = Key("PositiveRemanence", "Its magnitude.")
TOWARDS = Key("Direction", "Where its component along this direction would be negative, the sign is flipped.")


@dataclass(frozen=True, eq=False)
class Way:
    """An entry of `remanence` in problem files.

    Attributes
    ----------
    make : callable
        From the values of the keys, its parameters with their defaults, to the remanence.
    keys : mapping of str to Key
    words : callable
        From the values of the keys to what `magshell check` says of the direction.
    in_space : bool
        Whether the formula, of an entry for the whole part, also holds beyond a mirror plane.
    fault : callable
        From the values of the keys to a key and what is wrong with it; None: nothing.
    """

    make: Callable[..., Remanence]
    keys: Mapping[str, Key]
    words: Callable[..., str]
    in_space: bool = False
    fault: Callable[..., tuple[str, str] | None] = lambda **values: None

    def values(self, entry: Any) -> dict[str, Any]:
        """Those that an entry has for the keys."""
        return {key: getattr(entry, key) for key in self.keys}
