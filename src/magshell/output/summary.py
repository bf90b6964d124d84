"""`summary.json`: how far a run is, and how it ended, in a form that scripts read."""

from __future__ import annotations

import json
import math
import os
import pathlib
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from magshell.files import naming, write_atomically
from magshell.solver.events import Observer

if TYPE_CHECKING:
    from magshell.equations.discretisation import Discretisation
    from magshell.solver.path import Path
    from magshell.solver.settings import Settings

NAME = "summary.json"
MOST_BYTES = 16 * 2**20


class SummaryWriter(Observer):
    """Keep `summary.json` up to date during a run: not converged, with the reason `running`.

    Parameters
    ----------
    directory : path
        Folder of the file; one of an earlier run is removed when the solve starts.

    Raises
    ------
    OSError
        The disk refuses; the message names the file.
    """

    def __init__(self, directory: str | os.PathLike[str]) -> None:
        self.directory = pathlib.Path(directory)

    def started(self, discretisation: Discretisation, settings: Settings) -> None:
        """Forget an earlier run."""
        file = self.directory / NAME
        with naming(file):
            file.unlink(missing_ok=True)

    def resumed(self, path: Path) -> None:
        """Say that the run goes on, if it has not ended."""
        if not path.converged:
            self.kept(path)

    def kept(self, path: Path) -> None:
        """Write what there is so far."""
        write_summary(path, self.directory, reason="running")


def write_summary(path: Path, directory: str | os.PathLike[str], reason: str | None = None) -> pathlib.Path:
    """Write `summary.json` in one go.

    Parameters
    ----------
    path : Path
        A finished or broken-off load path.
    directory : path
        Folder of the file.
    reason : str, optional
        Why the run ended, where the caller knows better than the path (an interruption).

    Returns
    -------
    pathlib.Path
        The file. Strict JSON: a number that is not finite becomes null.

    Raises
    ------
    OSError
        The disk refuses; the message names the file.
    """
    file = pathlib.Path(directory) / NAME
    content = path.summary if reason is None else {**path.summary, "reason": reason}
    text = json.dumps(_plain(content), indent=2, ensure_ascii=False, allow_nan=False)
    write_atomically(file, text.encode() + b"\n")
    return file


def _plain(value: Any) -> Any:
    """The value in JSON's own types."""
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return _plain(value.tolist())
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
