"""`history.csv`: the load–displacement curves, one row per converged step, written as the solve goes; as a table."""

from __future__ import annotations

import math
import os
import pathlib
from typing import TYPE_CHECKING, Any

from magshell.errors import InputError
from magshell.files import append_line, csv_line, write_atomically
from magshell.solver.events import Observer
from magshell.solver.history import History

if TYPE_CHECKING:
    from magshell.equations.discretisation import Discretisation
    from magshell.evaluation.series import Number
    from magshell.solver.path import Path
    from magshell.solver.settings import Settings
    from magshell.solver.step import Step


class HistoryWriter(Observer):
    """Write the field, the displacement of every probe and the numbers of all series at every converged step.

    Columns: `load_factor`, `B1,B2,B3` (T, empty where not known), then `NAME.u1,NAME.u2,NAME.u3` (m) per probe, in the
    order of the model's probes, then `stage` (from 1), `arc_length` and `negative_pivots` (0: stable; empty where the
    linear solver cannot tell), then the columns of `magshell.evaluation.series`: reactions, energies, work and torque.
    Numbers are written so that reading them gives the same double back.

    Parameters
    ----------
    directory : path
        The file is `history.csv` in this folder. One of an earlier run is replaced when the solve starts.

    Raises
    ------
    OSError
        The disk refuses; the message names the file.
    """

    def __init__(self, directory: str | os.PathLike[str]) -> None:
        self.file = pathlib.Path(directory) / "history.csv"

    def started(self, discretisation: Discretisation, settings: Settings) -> None:
        """Begin a new file with its heading."""
        self._history = History(discretisation)
        write_atomically(self.file, csv_line(self._history.columns).encode())

    def resumed(self, path: Path) -> None:
        """The rows of the steps so far, whatever the file was."""
        self._history = path.history
        write_atomically(self.file, history_text(path).encode())

    def kept(self, path: Path) -> None:
        """The path has the numbers of its steps."""
        self._history = path.history

    def converged(self, step: Step) -> None:
        """Append one row."""
        append_line(self.file, _line(self._history.row(step)))


def history_text(path: Path) -> str:
    """The whole file of a path."""
    return "".join([csv_line(path.history.columns), *map(_line, path.history.rows(path.steps))])


def _line(row: list[Number]) -> str:
    return csv_line(["" if number is None else repr(number) for number in row])


def table(path: Path) -> Any:
    """The history of a path as a pandas frame; see `Path.table`."""
    try:
        import pandas
    except ImportError:
        raise InputError('path.table() needs pandas, which is not installed: pip install "magshell[pandas]"') from None
    rows = [[math.nan if one is None else one for one in row] for row in path.history.rows(path.steps)]
    return pandas.DataFrame(rows, columns=path.history.columns)
