"""The histories of all cells of a sweep in one file."""

from __future__ import annotations

import csv
from collections.abc import Mapping, Sequence

from magshell.evaluation.series import SERIES
from magshell.files import csv_line, read_at_most, write_atomically
from magshell.model.model import Model
from magshell.problem import load
from magshell.problem.alternatives import Setting
from magshell.sweep.folder import SweepFolder
from magshell.sweep.grid import Cell
from magshell.sweep.outcomes import heading, written_value

NAME = "history.csv"
MOST_BYTES = 2**30
"""Of a cell's history."""


def write_histories(folder: SweepFolder, settings: Sequence[Setting], cells: Sequence[Cell]) -> None:
    """Write `sweep-history.csv`: a row for each step of each cell, numbers in SI, the unit of a column in brackets.

    A column that a cell does not have, such as a probe of others, is empty there. Cells without results have no rows.

    Raises
    ------
    OSError
        The disk refuses; the message names the file.
    """
    found: list[tuple[Cell, list[dict[str, str]]]] = []
    units: dict[str, str] = {}
    for cell in cells:
        directory = folder.cell(cell.name)
        if not (directory / NAME).is_file():
            continue
        lines = read_at_most(directory / NAME, MOST_BYTES).decode().splitlines()
        rows = list(csv.DictReader(lines))
        if any(column not in units for column in (rows[0] if rows else ())):
            known = units_of(load(directory / "problem.toml").model)
            units |= {column: known.get(column, "") for column in rows[0]}
        found.append((cell, rows))
    text = [csv_line(["cell", *map(heading, settings), *map(_headed, units, units.values())])]
    for cell, rows in found:
        own = [cell.name, *map(written_value, cell.values)]
        text += [csv_line([*own, *(row.get(column) or "" for column in units)]) for row in rows]
    write_atomically(folder.histories, "".join(text).encode())


def units_of(model: Model) -> Mapping[str, str]:
    """SI units of the columns of a model's history that have one."""
    units = {f"B{i}": "T" for i in (1, 2, 3)}
    units |= {f"{name}.u{i}": "m" for name in model.probe_nodes for i in (1, 2, 3)}
    return units | {column: series.unit for series in SERIES.values() for column in series.columns(model)}


def _headed(column: str, unit: str) -> str:
    return f"{column} [{unit}]" if unit else column
