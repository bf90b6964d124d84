"""`history.csv`: the load–displacement curves, one row per converged step, written as the solve goes."""

from __future__ import annotations

import os
import pathlib
from typing import TYPE_CHECKING

from magshell.files import append_line, csv_line, write_atomically
from magshell.solver.events import Observer

if TYPE_CHECKING:
    from magshell.equations.discretisation import Discretisation
    from magshell.solver.path import Path
    from magshell.solver.settings import Settings
    from magshell.solver.step import Step

ABOUT = ("stage", "arc_length", "negative_pivots")


class HistoryWriter(Observer):
    """Write the field and the displacement of every probe at every converged step.

    Columns: `load_factor`, `B1,B2,B3` (T), then `NAME.u1,NAME.u2,NAME.u3` (m) per probe, in the order of
    the model's probes, then `stage` (from 1), `arc_length` and `negative_pivots` (0: stable; empty where the linear
    solver cannot tell). Numbers are written so that reading them gives the same double back.

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
        write_atomically(self.file, self._heading().encode())

    def resumed(self, path: Path) -> None:
        """The rows of the steps so far, whatever the file was."""
        self._model = path.model
        write_atomically(self.file, "".join([self._heading(), *map(self._row, path.steps)]).encode())

    def converged(self, step: Step) -> None:
        """Append one row."""
        append_line(self.file, self._row(step))

    def _heading(self) -> str:
        probes = [f"{name}.u{i}" for name in self._model.probe_nodes for i in (1, 2, 3)]
        return csv_line(["load_factor", "B1", "B2", "B3", *probes, *ABOUT])

    def _row(self, step: Step) -> str:
        row = [step.load_factor, *step.flux_density]
        for node in self._model.probe_nodes.values():
            row += step.state.u[node].tolist()
        pivots = "" if step.negative_pivots is None else str(step.negative_pivots)
        numbers = (repr(float(value)) for value in row)
        return csv_line([*numbers, str(step.stage + 1), repr(float(step.arc_length)), pivots])
