"""Functions made by functions that can be pickled: by their maker and its arguments."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, TypeVar

Maker = TypeVar("Maker", bound=Callable[..., Any])


class Made:
    """A function that another one has made of some arguments."""

    def __init__(self, maker: Callable[..., Any], made: Any, arguments: tuple[Any, ...], named: dict[str, Any]) -> None:
        self._maker, self._made, self._arguments, self._named = maker, made, arguments, named

    def __call__(self, *arguments: Any) -> Any:
        return self._made(*arguments)

    def __reduce__(self) -> tuple[Any, ...]:
        return _remade, (self._maker, self._arguments, self._named)


def remembered(maker: Maker) -> Maker:
    """Let the functions that a function of a module makes be pickled, if its arguments can be.

    They stay the same functions, except for their type.
    """

    @functools.wraps(maker)
    def remembering(*arguments: Any, **named: Any) -> Made:
        return Made(remembering, maker(*arguments, **named), arguments, named)

    return remembering  # type: ignore[return-value]


def _remade(maker: Callable[..., Any], arguments: tuple[Any, ...], named: dict[str, Any]) -> Any:
    return maker(*arguments, **named)
