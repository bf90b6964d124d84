"""A text file by lines: numbers in rows, and errors that name file and line."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any, NoReturn

import numpy as np

from magshell.arrays import AnyArray
from magshell.errors import InputError
from magshell.units import shortened

_WORDS: dict[type, str] = {int: "whole number", float: "number"}


class Lines:
    """The lines of a file, counted from 0 here and from 1 in messages.

    Parameters
    ----------
    name : str
        Of the file, for messages.
    content : bytes
    """

    def __init__(self, name: str, content: bytes) -> None:
        self.name = name
        self.every = content.splitlines()

    def fail(self, line: int, message: str) -> NoReturn:
        """Raise an InputError that names file and line."""
        raise InputError(f"{self.name}, line {line + 1}: {message}")

    def text(self, line: int) -> str:
        """A line without its blanks at both ends, in UTF-8 or, if it is not, in Latin 1."""
        try:
            return self.every[line].decode().strip()
        except UnicodeDecodeError:
            return self.every[line].decode("latin-1").strip()

    def numbers(self, line: int, what: str, kind: type = int) -> list[Any]:
        """All numbers of a line."""
        parts = self.every[line].split()
        try:
            return [kind(part) for part in parts]
        except ValueError:
            self.fail(line, f"expected {what}, found '{shortened(self.text(line))}'")

    def rows(self, where: Sequence[int], width: int, kind: type, what: str, separator: str | None = None) -> AnyArray:
        """Numbers (lines, width) of some lines.

        Parameters
        ----------
        where : sequence of int
            The lines.
        width : int
            Numbers on each.
        kind : type
            int or float.
        what : str
            What a line holds, for the message.
        separator : str, optional
            Between the numbers; blanks without it.

        Raises
        ------
        InputError
            A line that does not hold these numbers, or one that is not finite.
        """
        chunk = [self.every[line] for line in where]
        dtype = np.int64 if kind is int else np.float64
        if not chunk:
            return np.zeros((0, width), dtype)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                found = np.loadtxt(chunk, dtype=dtype, comments=None, delimiter=separator, ndmin=2)
        except (ValueError, OverflowError, Warning):
            found = np.zeros((0, 0))
        if found.shape == (len(chunk), width) and np.isfinite(found).all():
            return found
        return np.array([self._row(line, width, kind, what, separator) for line in where], dtype)

    def _row(self, line: int, width: int, kind: type, what: str, separator: str | None) -> list[Any]:
        """The numbers of one line, the slow way, which knows what is wrong."""
        parts = self.text(line).split(separator)
        found = f"found '{shortened(self.text(line))}'" if self.text(line) else "the line is empty"
        if len(parts) != width:
            plural = "s" if width > 1 else ""
            self.fail(line, f"expected {width} {_WORDS[kind]}{plural} ({what}), {found}")
        try:
            values = [kind(part) for part in parts]
        except ValueError:
            self.fail(line, f"expected {what}, {found}")
        if any(abs(value) > 9e18 if kind is int else not np.isfinite(value) for value in values):
            self.fail(line, f"expected {what}, {found}: not a finite number")
        return values
