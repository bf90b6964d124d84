"""How cells ended, and the table of them."""

from __future__ import annotations

import json
import pathlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from magshell.files import csv_line, read_at_most, write_atomically
from magshell.output.summary import MOST_BYTES, NAME
from magshell.problem.alternatives import Setting, Value
from magshell.sweep.grid import Cell

FIGURES = {
    "load_factor": "load_factor",
    "steps": "steps",
    "solves": "iterations",
    "cpu_seconds": "cpu_seconds",
    "force_imbalance": "force_imbalance",
}
"""Columns of the table, and what `summary.json` calls them."""


@dataclass(frozen=True)
class Outcome:
    """How a cell ended.

    Attributes
    ----------
    converged : bool or None
        None: it was not solved yet.
    reason : str
        Why it is not solved; of a solved one, empty.
    summary : mapping
        What `summary.json` holds.
    """

    converged: bool | None = None
    reason: str = "not solved yet"
    summary: Mapping[str, Any] = field(default_factory=dict)


WAITING = Outcome()


def undeformed(cell: Cell) -> Outcome:
    """The outcome of a cell in which nothing acts."""
    figures: dict[str, Any] = {"load_factor": 1.0, "iterations": 0, "cpu_seconds": 0.0, "force_imbalance": 0.0}
    probes = {name: [0.0, 0.0, 0.0] for name in cell.probes}
    return Outcome(True, "nothing acts: undeformed", {"steps": 0, **figures, "probes": probes})


def outcome_in(directory: pathlib.Path) -> Outcome:
    """The outcome by the results in the folder of a cell; WAITING where there are none, or none that can be read."""
    try:
        summary = json.loads(read_at_most(directory / NAME, MOST_BYTES))
        converged, reason = summary["converged"], str(summary["reason"])
        summary["probes"].items()
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return WAITING
    return Outcome(converged is True, "" if converged is True else reason, summary)


def table(settings: Sequence[Setting], cells: Sequence[Cell], outcomes: Mapping[int, Outcome]) -> str:
    """The table as CSV: a row for each cell, numbers in SI, the unit of a column in brackets.

    Parameters
    ----------
    settings, cells : sequence of Setting, of Cell
    outcomes : mapping of int to Outcome
        By the number of the cell; those that are missing were not solved yet.
    """
    probes = list(dict.fromkeys(name for cell in cells for name in cell.probes))
    keys = [heading(setting) for setting in settings]
    moves = [f"{name}.u{i} [m]" for name in probes for i in (1, 2, 3)]
    lines = [csv_line(["cell", *keys, "converged", "reason", *FIGURES, *moves])]
    for cell in cells:
        outcome = outcomes.get(cell.number, WAITING)
        converged = "" if outcome.converged is None else str(outcome.converged)
        figures = [_number(outcome.summary.get(name)) for name in FIGURES.values()]
        values = [written_value(value) for value in cell.values]
        reached = [_number(u) for name in probes for u in displacement(outcome, name)]
        lines.append(csv_line([cell.name, *values, converged, outcome.reason, *figures, *reached]))
    return "".join(lines)


def write_table(
    file: pathlib.Path, settings: Sequence[Setting], cells: Sequence[Cell], outcomes: Mapping[int, Outcome]
) -> None:
    """Write the table in one go.

    Raises
    ------
    OSError
        The disk refuses; the message names the file.
    """
    write_atomically(file, table(settings, cells, outcomes).encode())


def heading(setting: Setting) -> str:
    """Name of the column of a setting."""
    unit = next((next(iter(value.dimension.units)) for value in setting.values if value.dimension.units), "")
    return f"{setting.key} [{unit}]" if unit else setting.key


def displacement(outcome: Outcome, probe: str) -> tuple[float | None, float | None, float | None]:
    """Of a probe at the end, m; Nones unless the end was reached."""
    reached = outcome.summary.get("probes", {}).get(probe) if outcome.converged else None
    if reached is None:
        return None, None, None
    return reached[0], reached[1], reached[2]


def written_value(value: Value) -> str:
    """A value of a setting in a table, SI where it is a quantity."""
    if value.number is None or isinstance(value.data, int):
        return value.text
    return repr(value.number)


def _number(value: Any) -> str:
    return repr(value) if isinstance(value, int | float) else ""
