"""Pictures of a result: load–displacement curves and the deformed shape."""

from __future__ import annotations

import os
import pathlib
from typing import TYPE_CHECKING

from magshell.output.curve import draw_curve
from magshell.output.rendering import RenderingUnavailable, attempted
from magshell.output.shape import draw_shape

if TYPE_CHECKING:
    from magshell.solver.path import Path

__all__ = ["RenderingUnavailable", "draw_curve", "draw_pictures", "draw_shape"]


def draw_pictures(path: Path, directory: str | os.PathLike[str]) -> list[pathlib.Path | str]:
    """Draw `curve.png` and `shape.png`.

    Parameters
    ----------
    path : Path
    directory : path
        Folder of the pictures.

    Returns
    -------
    list of pathlib.Path or str
        The files; in place of a picture that failed, a sentence that says why and what to do (one left by an earlier
        run is then removed).
    """
    folder = pathlib.Path(directory)
    return [
        attempted(lambda file: draw_curve(path, file), folder / "curve.png"),
        attempted(lambda file: draw_shape(path, file), folder / "shape.png"),
    ]
