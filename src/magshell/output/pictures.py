"""Pictures of a result: load–displacement curves and the deformed shape."""

from __future__ import annotations

import os
import pathlib
from typing import TYPE_CHECKING

from magshell.output.curve import draw_curve
from magshell.output.rendering import RenderingUnavailable
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
        The files; for a picture that this machine cannot draw, a sentence that says why and what to install
        (one left by an earlier run is then removed).

    Raises
    ------
    OSError
        The disk refuses; the message names the file.
    """
    results: list[pathlib.Path | str] = []
    for draw, name in ((draw_curve, "curve.png"), (draw_shape, "shape.png")):
        file = pathlib.Path(directory) / name
        try:
            draw(path, file)
            results.append(file)
        except RenderingUnavailable as unavailable:
            file.unlink(missing_ok=True)
            results.append(str(unavailable))
    return results
