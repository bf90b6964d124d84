"""`critical.csv` and `critical/`: the limit points and bifurcations of a path, with their modes for ParaView."""

from __future__ import annotations

import os
import pathlib
from typing import TYPE_CHECKING

import numpy as np

from magshell.evaluation.patches import patches_of
from magshell.files import append_line, csv_line, naming, write_atomically
from magshell.output.vtu import grid, vtu
from magshell.shell.unknowns import COLUMNS
from magshell.solver.events import Observer

if TYPE_CHECKING:
    from magshell.equations.discretisation import Discretisation
    from magshell.model.model import Model
    from magshell.solver.buckling import BucklingMode
    from magshell.solver.critical import CriticalPoint
    from magshell.solver.settings import Settings

HEADING = (
    "number", "kind", "stage", "load_factor", "B1", "B2", "B3", "arc_length", "negative_pivots_before",
    "negative_pivots_after", "mode",
)  # fmt: skip


class CriticalWriter(Observer):
    """Write every critical point as a row of `critical.csv`, and its state and mode as a VTU file.

    Point arrays of the file are those of a step, and `mode` (displacements, the largest 1 m), `mode_director` and
    `mode_rotation` (rad per metre of that). A path without critical points has neither file.

    Parameters
    ----------
    directory : path
        Files of an earlier run in this folder are removed when the solve starts.

    Raises
    ------
    OSError
        The disk refuses; the message names the file.
    """

    def __init__(self, directory: str | os.PathLike[str]) -> None:
        self.file = pathlib.Path(directory) / "critical.csv"

    def started(self, discretisation: Discretisation, settings: Settings) -> None:
        """Forget an earlier run."""
        self._discretisation = discretisation
        folder = self.file.parent / "critical"
        with naming(folder):
            self.file.unlink(missing_ok=True)
            for old in folder.glob("point-[0-9][0-9]*.vtu"):
                old.unlink(missing_ok=True)

    def critical(self, point: CriticalPoint) -> None:
        """Write the mode, then the row."""
        name = f"critical/point-{point.number:02d}.vtu"
        write_mode(self.file.parent / name, self._discretisation, point)
        if not self.file.exists():
            write_atomically(self.file, csv_line(HEADING).encode())
        field = field_cells(self._discretisation.model, point)
        numbers = [repr(float(point.load_factor)), *field, repr(float(point.arc_length))]
        pivots = ["" if count is None else str(count) for count in point.negative_pivots]
        append_line(self.file, csv_line([str(point.number), point.kind, str(point.stage + 1), *numbers, *pivots, name]))


def write_mode(file: pathlib.Path, discretisation: Discretisation, point: CriticalPoint | BucklingMode) -> None:
    """A state with its mode as a VTU file."""
    content, patches = grid(discretisation, point), patches_of(discretisation.model.shell)
    first = np.unique(patches.elements, return_index=True)[1]
    mode = point.mode[discretisation.rows.elements.ravel()[first]]
    for array, field in (("mode", "u"), ("mode_director", "w"), ("mode_rotation", "omega")):
        content.point_data.set_array(np.ascontiguousarray(mode[:, COLUMNS[field]]), array)
    write_atomically(file, vtu(content))


def field_cells(model: Model, point: CriticalPoint | BucklingMode) -> list[str]:
    """B1, B2, B3 as cells of a table, T; empty where the field is not known at the shell's centre."""
    field = model.course(point.stage).reported(point.load_factor, point.flux_density)
    return ["" if np.isnan(B) else repr(B) for B in field.tolist()]
