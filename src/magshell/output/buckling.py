"""`buckling.csv` and `buckling/`: critical multipliers with their modes, for ParaView and as pictures."""

from __future__ import annotations

import dataclasses
import os
import pathlib
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from magshell.equations.instant import Increment
from magshell.files import csv_line, first_line, refuse_somebodys, write_atomically
from magshell.output.critical import field_cells, write_mode
from magshell.output.rendering import attempted
from magshell.output.shape import draw_shape
from magshell.solver.step import Step

if TYPE_CHECKING:
    from magshell.solver.buckling import Buckling, BucklingMode

TABLE = "buckling.csv"
HEADING = ("number", "load_factor", "B1", "B2", "B3", "mode", "strain", "rotation")
# Largest displacement of a mode in its picture, in sizes of the body.
SHOWN = 0.15


def require_free(directory: str | os.PathLike[str]) -> None:
    """Refuse a folder in which files that no run has made would be replaced or removed.

    Raises
    ------
    InputError
        Names them.
    """
    folder = pathlib.Path(directory)
    made = first_line(folder / TABLE) == csv_line(HEADING)
    refuse_somebodys(folder, made, (TABLE, "buckling/mode-[0-9][0-9]*.*"))


def write_buckling(buckling: Buckling, directory: str | os.PathLike[str]) -> list[pathlib.Path | str]:
    """Write the multipliers, and each mode as a VTU file and a picture.

    Parameters
    ----------
    buckling : Buckling
    directory : path
        Those of an earlier run are replaced.

    Returns
    -------
    list of pathlib.Path or str
        The pictures; a sentence that says why in place of one that failed.

    Raises
    ------
    InputError
        The folder holds somebody's own files with the names of these.
    OSError
        The disk refuses; the message names the file.
    """
    require_free(directory)
    folder = pathlib.Path(directory)
    for old in (folder / "buckling").glob("mode-[0-9][0-9]*.*"):
        old.unlink(missing_ok=True)
    rows = [csv_line(HEADING)]
    for mode in buckling.modes:
        name = f"buckling/mode-{mode.number:02d}.vtu"
        write_mode(folder / name, buckling.path.discretisation, mode)
        numbers = [repr(float(mode.load_factor)), *field_cells(buckling.path.model, mode)]
        rows.append(csv_line([str(mode.number), *numbers, name, repr(float(mode.strain)), repr(float(mode.rotation))]))
    write_atomically(folder / TABLE, "".join(rows).encode())
    return [
        attempted(partial(_draw, buckling, mode), folder / f"buckling/mode-{mode.number:02d}.png")
        for mode in buckling.modes
    ]


def _draw(buckling: Buckling, mode: BucklingMode, file: pathlib.Path) -> None:
    size = SHOWN * buckling.path.model.shell.mesh.size
    increment = Increment(size * mode.mode, np.zeros_like(mode.state.alpha))
    shape = buckling.path.discretisation.moved(mode.state, increment)
    drives = buckling.path.model.course(mode.stage).at(mode.load_factor).drives
    step = Step(
        mode.number,
        mode.load_factor,
        shape,
        0,
        0.0,
        None,
        0.0,
        mode.stage,
        mode.flux_density,
        np.zeros(0),
        None,
        drives,
    )
    draw_shape(dataclasses.replace(buckling.path, steps=[step]), file, color="u")
