"""Errors that say where in the file."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from magshell.errors import InputError


@contextmanager
def at(where: str) -> Iterator[None]:
    """Prefix every input error of the block with its place."""
    try:
        yield
    except InputError as error:
        raise type(error)(f"{where}: {error}") from None
