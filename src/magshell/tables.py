"""Columns of CSV tables, as instruments, spreadsheets and other programs write them.

Fields are separated by commas, semicolons or tabs; the first line says by which. With the last two, numbers may have a
decimal comma. Names of columns may be in capitals and followed by a unit, as in `X1 [mm]`, `b1 (mT)` or `B2/T`.
"""

from __future__ import annotations

import csv
import itertools
import math
import pathlib
import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple, TextIO

import numpy as np

from magshell import units
from magshell.arrays import FloatArray
from magshell.errors import InputError

LONGEST = 2**20
"""Characters of a line."""
SEPARATORS = {",": "commas", ";": "semicolons", "\t": "tabs"}
LARGEST = 1e60
"""Of numbers in a table, whatever their unit: products of a few of them are still finite."""
_HEADING = re.compile(r"\s*([^\[\](){}/]+?)\s*(?:\[([^\]]*)\]|\(([^)]*)\)|/(.*))?\s*")
_DECIMAL_COMMA = re.compile(r"\s*[-+]?\d*,\d*(?:[eE][-+]?\d+)?\s*")


class Columns(NamedTuple):
    """Columns that a table may have, all of one kind.

    Attributes
    ----------
    names : tuple of str
        In small letters.
    dimension : Dimension
    unit : str or None
        As the user says it; a unit in a heading must be the same. None: not said.
    key : str
        What says it, for messages.
    """

    names: tuple[str, ...]
    dimension: units.Dimension
    unit: str | None
    key: str


class Table(NamedTuple):
    """What a file holds.

    Attributes
    ----------
    wanted : ndarray, shape (rows, k)
    optional : ndarray or None, shape (rows, k)
        None: the file does not have them.
    lines : list of int
        Of the file, one for each row.
    """

    wanted: FloatArray
    optional: FloatArray | None
    lines: list[int]


def read_table(file: pathlib.Path, wanted: Columns, optional: Columns) -> Table:
    """Columns of a CSV file: those wanted, and the optional ones if the file has them.

    Empty lines and lines that begin with # are passed over.

    Raises
    ------
    InputError
        With file and line.
    """
    try:
        with file.open(encoding="utf-8-sig", newline="") as opened:
            return _read(file, _lines(file.name, opened), wanted, optional)
    except UnicodeDecodeError as error:
        raise InputError(f"{file.name}: is not a text file in UTF-8 (byte {error.start})") from None
    except csv.Error as error:
        raise InputError(f"{file.name}: is not a CSV file: {error}") from None
    except InputError:
        raise
    except (OSError, ValueError) as error:
        raise InputError(unreadable(file, error)) from None


def _lines(name: str, opened: TextIO) -> Iterator[str]:
    """The lines of a file, each of bearable length."""
    number = 0
    while line := opened.readline(LONGEST + 1):
        number += 1
        if len(line) > LONGEST:
            raise InputError(f"{name}, line {number}: has more than {LONGEST} characters; a table has short lines")
        yield line


def unreadable(file: pathlib.Path, error: Exception) -> str:
    """Why a file cannot be read."""
    if isinstance(error, FileNotFoundError):
        return f"{file}: there is no such file"
    return f"{file}: cannot be read: {getattr(error, 'strerror', None) or error}"


def _read(file: pathlib.Path, text: Iterator[str], wanted: Columns, optional: Columns) -> Table:
    first = next(((number, line) for number, line in enumerate(text, start=1) if _says_something(line)), None)
    if first is None:
        names = ",".join((*optional.names, *wanted.names))
        raise InputError(f"{file.name}: is empty; its first line names the columns {names}")
    above, separator = first[0] - 1, _separator(first[1], (*wanted.names, *optional.names))
    reader = csv.reader(itertools.chain([first[1]], text), delimiter=separator)
    header = next(reader)
    where = f"{file.name}, line {above + reader.line_num}"
    columns = _Header(where, separator, header)
    places = columns.find(wanted)
    also = columns.find(optional) if columns.has_any(optional) else []
    numbers = _Numbers(file.name, separator, columns.names)
    rows, lines = [], []
    for fields in reader:
        if fields and _says_something("".join(fields)):
            line = above + reader.line_num
            rows.append(numbers.row(line, fields, [*places, *also]))
            lines.append(line)
    if not rows:
        raise InputError(f"{file.name}: has no rows below its first line")
    table = np.array(rows)
    return Table(table[:, : len(places)], table[:, len(places) :] if also else None, lines)


def _says_something(line: str) -> bool:
    return bool(line.strip(" \t\r\n,;")) and not line.lstrip().startswith("#")


def _separator(header: str, names: Sequence[str]) -> str:
    """By which most of the known names stand apart."""

    def known(separator: str) -> int:
        found = {_split(heading)[0] for heading in next(csv.reader([header], delimiter=separator), [])}
        return len(found & set(names))

    return max(SEPARATORS, key=known)


def _split(heading: str) -> tuple[str, str | None]:
    """Name in small letters, and the unit that follows it."""
    found = _HEADING.fullmatch(heading)
    if found is None:
        return heading.strip().casefold(), None
    unit = next((unit.strip() for unit in found.groups()[1:] if unit is not None), None)
    return found[1].casefold(), unit


class _Header:
    """The first line of a table."""

    def __init__(self, where: str, separator: str, header: Sequence[str]) -> None:
        self._where, self._separator = where, separator
        self._plain = [heading.strip() for heading in header]
        self.names, self._units = map(list, zip(*map(_split, header), strict=True))

    def has_any(self, columns: Columns) -> bool:
        return bool(set(columns.names) & set(self.names))

    def find(self, columns: Columns) -> list[int]:
        """Where the columns are."""
        return [self._one(name, columns) for name in columns.names]

    def _one(self, name: str, columns: Columns) -> int:
        found = [place for place, other in enumerate(self._plain) if other == name]
        found = found or [place for place, other in enumerate(self.names) if other == name]
        if len(found) != 1:
            fault = "more than one column is" if found else "there is no column"
            listed = units.quoted(self._separator.join(self._plain))
            raise InputError(
                f"{self._where}: {fault} {'named ' if found else ''}'{name}'; the columns are {listed}, separated by "
                f"{SEPARATORS[self._separator]} ({', '.join(SEPARATORS.values())} are read)"
            )
        unit = self._units[found[0]]
        if unit and columns.unit is not None:
            said = columns.dimension.value(columns.unit)
            own = columns.dimension.value(unit)
            if own is None:
                raise InputError(
                    f"{self._where}: {name} is in {units.quoted(unit)}, which is no unit of {columns.dimension.name} "
                    f"(units: {columns.dimension.allowed})"
                )
            if own != said:
                raise InputError(
                    f"{self._where}: {name} is in {units.quoted(unit)}, but {columns.key} says '{columns.unit}'"
                )
        return found[0]


class _Numbers:
    """Turns fields into numbers; knows whether the file has decimal commas or points."""

    def __init__(self, file: str, separator: str, names: Sequence[str]) -> None:
        self._file, self._separator, self._names = file, separator, names
        self._decimal: tuple[str, str, int] | None = None

    def row(self, line: int, fields: list[str], places: Sequence[int]) -> list[float]:
        """The numbers of a line at some places."""
        where = f"{self._file}, line {line}"
        if len(fields) != len(self._names):
            text = f"{where}: has {len(fields)} fields; the first line has {len(self._names)}"
            if self._separator == "," and len(fields) == 2 * len(self._names):
                text += "; with decimal commas the fields must be separated by semicolons or tabs"
            raise InputError(text)
        row = []
        for place in places:
            field = fields[place]
            try:
                value = float(self._with_point(where, line, self._names[place], field))
            except ValueError as error:
                if isinstance(error, InputError):
                    raise
                value = math.nan
            if not abs(value) < LARGEST:
                fault = f"more than {LARGEST:g}" if math.isfinite(value) else "not a finite number"
                raise InputError(f"{where}: {self._names[place]} is {units.quoted(field.strip())}, {fault}")
            row.append(value)
        return row

    def _with_point(self, where: str, line: int, name: str, field: str) -> str:
        """A number with a decimal point; a file has either commas or points."""
        comma = self._separator != "," and _DECIMAL_COMMA.fullmatch(field) is not None
        if comma or "." in field:
            sign = "," if comma else "."
            self._decimal = self._decimal or (sign, field.strip(), line)
            if self._decimal[0] != sign:
                raise InputError(
                    f"{where}: {name} is {units.quoted(field.strip())}, but line {self._decimal[2]} has "
                    f"{units.quoted(self._decimal[1])}; a file has decimal points or decimal commas"
                )
        return field.replace(",", ".") if comma else field


def duplicate(places: FloatArray, values: FloatArray) -> tuple[int, int] | None:
    """Two rows, the first the earlier one, that give one place (n, 3) two values (n, k); None if there are none.

    Places nearer to each other than 1e-9 of the extent are one; values that differ by 1e-9 of the largest too.
    """
    from scipy.spatial import cKDTree

    same = 1e-9 * float(np.abs(values).max(initial=0.0))
    _, first, group = np.unique(places, axis=0, return_index=True, return_inverse=True)
    other = first[group.ravel()]
    apart = np.flatnonzero(np.abs(values - values[other]).max(axis=1) > same)
    if apart.size:
        return int(other[apart[0]]), int(apart[0])
    if len(first) < 2:
        return None
    distance, nearest = map(np.asarray, cKDTree(places[first]).query(places[first], k=2))
    near = distance[:, 1] <= 1e-9 * float(np.ptp(places, axis=0).max())
    partner = first[nearest[:, 1]]
    bad = np.flatnonzero(near & (np.abs(values[first] - values[partner]).max(axis=1) > same))
    if not bad.size:
        return None
    pair = sorted((int(first[bad[0]]), int(partner[bad[0]])))
    return pair[0], pair[1]
