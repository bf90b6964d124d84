"""The text of an input file: keywords with their parameters and data lines, labels, numbers."""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from magshell.arrays import AnyArray, IntArray
from magshell.errors import suggest
from magshell.mesh.files.lines import Lines
from magshell.units import shortened

LARGEST_NUMBER = 10**11
"""Of nodes and elements; Abaqus allows 10⁹."""
_WHOLE = re.compile(r"[+-]?[0-9]+")
_REAL = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eEdD][+-]?[0-9]+)?")

T = TypeVar("T")


@dataclass(frozen=True)
class Keyword:
    """A keyword line and the data lines under it."""

    name: str
    """In capitals and without blanks."""
    parameters: list[tuple[str, str]]
    """Name in capitals and without blanks, and the value as it is written."""
    line: int
    rows: list[int]
    """The data lines, without comments and empty lines."""


def keywords(lines: Lines) -> Iterator[Keyword]:
    """The keywords of a file, in order."""
    every = lines.every
    starts = [line for line, text in enumerate(every) if text[:1] == b"*" and text[:2] != b"**"]
    for start, end in zip(starts, [*starts, len(every)][1:], strict=True):
        rows = [line for line in range(start + 1, end) if every[line] and every[line][:2] != b"**"]
        words = split(lines.text(start)[1:])
        while len(words) > 1 and not words[-1] and rows and (more := split(lines.text(rows[0]))):
            if _REAL.fullmatch(more[0]):  # a comma too many, and no keyword line that goes on
                break
            words = words[:-1] + more
            del rows[0]
        parameters = [(folded(key), value.strip()) for key, _, value in (word.partition("=") for word in words[1:])]
        yield Keyword(folded(words[0]), [each for each in parameters if any(each)], start, rows)


def parameters(lines: Lines, keyword: Keyword, allowed: Sequence[str]) -> dict[str, str]:
    """Parameters by their full names; Abaqus lets them be shortened.

    Raises
    ------
    InputError
        A parameter that is not `allowed`, one that may be several of them, one that is there twice.
    """
    found: dict[str, str] = {}
    for name, value in keyword.parameters:
        matching = [name] if name in allowed else [full for full in allowed if name and full.startswith(name)]
        if len(matching) != 1:
            lines.fail(
                keyword.line,
                f"*{keyword.name} with '{shortened(name)}' is not read. {suggest(name, allowed)} (A label with a comma "
                "in it stands in quotation marks.)",
            )
        if matching[0] in found:
            lines.fail(keyword.line, f"{matching[0]} is given twice")
        found[matching[0]] = value
    return found


def split(text: str) -> list[str]:
    """Fields between commas, stripped; commas in quotation marks part nothing."""
    pieces = text.split('"')
    if len(pieces) == 1 or len(pieces) % 2 == 0:
        return [field.strip() for field in text.split(",")]
    fields = [""]
    for number, piece in enumerate(pieces):
        if number % 2:
            fields[-1] += f'"{piece}"'
        else:
            first, *rest = piece.split(",")
            fields[-1] += first
            fields += rest
    return [field.strip() for field in fields]


def folded(text: str) -> str:
    """Without blanks and in capitals (of ASCII, as in Abaqus)."""
    return "".join(text.split()).encode("utf-8", "replace").upper().decode()


def key(label: str) -> str:
    """What a label is known by: capitals and blanks do not count, unless it stands in quotation marks."""
    return shown(label) if label[:1] == '"' else folded(label)


def shown(label: str) -> str:
    """A label as people read it."""
    return label[1:-1] if len(label) > 1 and label[0] == label[-1] == '"' else label


def lookup(named: Mapping[str, T], label: str) -> T | None:
    """What has this label; if nothing has, what has it but for capitals, blanks and quotation marks."""
    if key(label) in named:
        return named[key(label)]
    close = [each for name, each in named.items() if folded(name) == folded(shown(label))]
    return close[0] if len(close) == 1 else None


def is_whole(text: str) -> bool:
    """Whether a field is a whole number, and no label."""
    return _WHOLE.fullmatch(text) is not None


def whole(lines: Lines, line: int, text: str, what: str) -> int:
    """A whole number of no more than 11 digits."""
    value = int(text) if is_whole(text) and len(text) < 20 else 2**62
    if abs(value) > LARGEST_NUMBER:
        lines.fail(line, f"expected {what}, found '{shortened(text)}'")
    return value


def real(lines: Lines, line: int, text: str, what: str) -> float:
    """A finite number, its exponent with E or D; an empty field is 0."""
    value = float(re.sub("[dD]", "e", text)) if _REAL.fullmatch(text) else 0.0 if not text else np.inf
    if not np.isfinite(value):
        lines.fail(line, f"expected {what}, found '{shortened(lines.text(line))}'")
    return value


def reals(lines: Lines, keyword: Keyword, row: int, most: int, what: str) -> list[float]:
    """The numbers of a data line, at most `most`; none if the line is not there."""
    if row >= len(keyword.rows):
        return []
    line = keyword.rows[row]
    fields = split(lines.text(line))
    while fields and not fields[-1]:
        fields.pop()
    if len(fields) > most:
        lines.fail(line, f"expected {what}, found '{shortened(lines.text(line))}'")
    return [real(lines, line, field, what) for field in fields]


def table(lines: Lines, rows: Sequence[int], kind: type) -> AnyArray | None:
    """Numbers (rows, fields) of data lines that all have as many, or None if that is not so; it is fast."""
    chunk = [lines.every[line].rstrip(b", \t") for line in rows]
    if not chunk or chunk[0].count(b'"'):
        return None
    if kind is float and b"D" in chunk[0].upper():
        chunk = [line.upper().replace(b"D", b"E") for line in chunk]
    dtype = np.int64 if kind is int else np.float64
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            found: AnyArray = np.loadtxt(chunk, dtype=dtype, comments=None, delimiter=",", ndmin=2)
    except (ValueError, OverflowError, Warning):
        return None
    bounded = (found >= -LARGEST_NUMBER) & (found <= LARGEST_NUMBER)
    return found if len(found) == len(rows) and bounded.all() else None


def whole_rows(lines: Lines, rows: Sequence[int], what: str) -> tuple[IntArray, IntArray]:
    """All whole numbers of data lines, one after the other, and how many each line has."""
    fast = table(lines, rows, int)
    if fast is not None:
        return fast.ravel(), np.full(len(rows), fast.shape[1], dtype=np.int64)
    flat: list[int] = []
    counts: list[int] = []
    for line in rows:
        fields = lines.text(line).rstrip(", \t").split(",")
        flat += [whole(lines, line, field.strip(), what) for field in fields]
        counts.append(len(fields))
    return np.array(flat, dtype=np.int64), np.array(counts, dtype=np.int64)
