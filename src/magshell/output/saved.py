"""Folders of paths that Python has made: the files of a run, and the path as a pickle, from which it goes on.

A model that was built in Python has no problem file. So what the folder is read back from is `path.pickle`: a line that
says what it is, then the pickled path.
"""

from __future__ import annotations

import logging
import os
import pathlib
import pickle
from typing import TYPE_CHECKING

from magshell.errors import InputError
from magshell.files import first_line, naming, refuse_somebodys, write_atomically
from magshell.output.critical import CriticalWriter
from magshell.output.history import HistoryWriter
from magshell.output.pictures import draw_pictures
from magshell.output.summary import SummaryWriter, write_summary
from magshell.output.vtu import VtuWriter, save_series
from magshell.units import shortened
from magshell.version import __version__

if TYPE_CHECKING:
    from magshell.solver.path import Path

NAME, FORMAT = "path.pickle", "magshell path"
WRITTEN = (
    NAME, "history.csv", "summary.json", "shell.pvd", "critical.csv", "curve.png", "shape.png", "steps/step-*.vtu",
    "critical/point-*.vtu", "problem.toml",
)  # fmt: skip

logger = logging.getLogger(__name__)


def save_path(path: Path, file: str | os.PathLike[str]) -> None:
    """Write a path into a folder, where the name ends with a slash or is that of a folder, or else for ParaView."""
    if str(file).endswith(("/", os.sep)) or os.path.isdir(file):
        save_folder(path, file)
    else:
        save_series(path, file)


def is_saved(directory: pathlib.Path) -> bool:
    """Whether a folder holds a saved path."""
    return (directory / NAME).is_file() and first_line(directory / NAME).startswith(FORMAT)


def save_folder(path: Path, directory: str | os.PathLike[str]) -> None:
    """Write a path with its curves, shapes, critical points, summary and pictures into a folder.

    Raises
    ------
    InputError
        The folder holds files of the same names that are of something else, or a part of the model cannot be pickled.
    OSError
        The disk refuses; the message names the file.
    """
    folder = pathlib.Path(directory)
    refuse_somebodys(folder, is_saved(folder), WRITTEN)
    content = _pickled(path)
    with naming(folder):
        folder.mkdir(parents=True, exist_ok=True)
        (folder / NAME).unlink(missing_ok=True)
    history, shapes, critical = HistoryWriter(folder), VtuWriter(folder), CriticalWriter(folder)
    for writer in (SummaryWriter(folder), shapes, critical):
        writer.started(path.discretisation, path.settings)
    history.resumed(path)
    for step in path.steps:
        shapes.converged(step)
    for point in path.critical_points:
        critical.critical(point)
    write_summary(path, folder)
    for picture in draw_pictures(path, folder):
        if isinstance(picture, str):
            logger.warning("%s", picture)
    write_atomically(folder / NAME, content, durably=True)


def _pickled(path: Path) -> bytes:
    try:
        return f"{FORMAT}, magshell {__version__}\n".encode() + pickle.dumps(path)
    except (pickle.PicklingError, AttributeError, TypeError) as error:
        raise InputError(
            f"the model cannot be saved: {shortened(str(error))}. A remanence, thickness or field that is a function "
            "must be a function of a module, no lambda and none inside another function"
        ) from None


def read_saved(directory: pathlib.Path) -> tuple[Path, list[str]]:
    """The path of a folder, and notes on why going on would not give the same bits.

    Raises
    ------
    InputError
        The file is damaged, or of a version whose paths are no longer known.
    """
    file = directory / NAME
    try:
        head, _, content = file.read_bytes().partition(b"\n")
    except OSError as error:
        raise InputError(f"{file}: cannot be read: {error.strerror or error}") from None
    version = head.decode(errors="replace").rpartition(" ")[2]
    try:
        path: Path = pickle.loads(content)
        path.discretisation.dofs  # noqa: B018
    except Exception as error:  # whatever unpickling a damaged file may raise
        raise InputError(
            f"{file}: is damaged, or this magshell {__version__} does not know what version {version} has saved "
            f"({type(error).__name__}: {shortened(str(error))})"
        ) from None
    notes = [] if version == __version__ else [f"the path was saved by magshell {version}, this is {__version__}"]
    return path, notes
