"""`summary.json`: how a run ended, in a form that scripts read."""

from __future__ import annotations

import json
import math
import os
import pathlib
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from magshell.output.files import write_atomically

if TYPE_CHECKING:
    from magshell.solver.path import Path


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
    file = pathlib.Path(directory) / "summary.json"
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
