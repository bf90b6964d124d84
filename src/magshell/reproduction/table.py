"""Rows of numbers beside those of the paper, and `reproduction.csv`."""

from __future__ import annotations

import csv
import io
import pathlib
from collections.abc import Iterable
from typing import NamedTuple

from magshell.files import write_atomically

COLUMNS = ("example", "quantity", "unit", "paper", "computed", "difference_percent", "note")
WORTH_A_NOTE = 1.0
"""Per cent."""


class Row(NamedTuple):
    """A number of an example; `paper` is None where the paper has no such number, `computed` where there is no run."""

    example: str
    quantity: str
    unit: str = ""
    paper: float | None = None
    computed: float | None = None
    note: str = ""

    @property
    def difference_percent(self) -> float | None:
        """Of what was computed from the paper's number."""
        if self.paper is None or self.computed is None:
            return None
        return 100.0 * (self.computed / self.paper - 1.0)


def write_table(rows: Iterable[Row], file: pathlib.Path) -> None:
    """Write the rows as CSV in one go; numbers to five digits, differences to a hundredth of a per cent.

    Raises
    ------
    OSError
        The disk refuses; the message names the file.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    for row in rows:
        difference = row.difference_percent
        writer.writerow(
            [
                row.example,
                row.quantity,
                row.unit,
                "" if row.paper is None else f"{row.paper:g}",
                "" if row.computed is None else f"{row.computed:.5g}",
                "" if difference is None else f"{difference:+.2f}",
                row.note,
            ]
        )
    write_atomically(file, text.getvalue().encode())
