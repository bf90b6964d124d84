"""`history.csv`: the load–displacement curves, one row per converged step, written as the solve goes."""

from __future__ import annotations

import csv
import io
import os
import pathlib
from collections.abc import Iterable
from typing import TYPE_CHECKING

from magshell.output.files import append_line, write_atomically
from magshell.solver.events import Observer

if TYPE_CHECKING:
    from magshell.assembly import Discretisation
    from magshell.solver.path import Step
    from magshell.solver.settings import Settings


class HistoryWriter(Observer):
    """Write the field and the displacement of every probe at every converged step.

    Columns: `load_factor`, `B1,B2,B3` (T), then `NAME.u1,NAME.u2,NAME.u3` (m) per probe, in the order of
    the model's probes. Numbers are written so that reading them gives the same double back.

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
        self._model = discretisation.model
        probes = [f"{name}.u{i}" for name in self._model.probe_nodes for i in (1, 2, 3)]
        write_atomically(self.file, _line(["load_factor", "B1", "B2", "B3", *probes]).encode())

    def converged(self, step: Step) -> None:
        """Append one row."""
        row = [step.load_factor]
        row += [step.load_factor * b for b in self._model.field.vector]
        for node in self._model.probe_nodes.values():
            row += step.state.u[node].tolist()
        append_line(self.file, _line(repr(float(value)) for value in row))


def _line(values: Iterable[str]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerow(values)
    return text.getvalue()
