"""Files of the deformed body: closed STL for printers and CAD, VTU of solid elements for ParaView and other solvers."""

from __future__ import annotations

import os
import pathlib
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from magshell.errors import InputError
from magshell.evaluation.converged import converged
from magshell.files import with_suffix, write_atomically
from magshell.output.solid.cells import solid_grid
from magshell.output.solid.slab import slab_of, volume
from magshell.output.solid.surface import Surface, closed_surface
from magshell.output.vtu import vtu

if TYPE_CHECKING:
    from magshell.solver.path import Path

STL, VTU = ".stl", ".vtu"
# STL files say no unit; programs that read them take millimetres.
MM = 1e3
# Bytes of a triangle; the head of a file has more, and less than two.
RECORD = 50


class Written(NamedTuple):
    """What was written.

    Attributes
    ----------
    file : pathlib.Path
    step : int
        Number of the step.
    volume : float
        Of the body, m³.
    cells : int
        Triangles or solid elements.
    """

    file: pathlib.Path
    step: int
    volume: float
    cells: int


def export(path: Path, file: str | os.PathLike[str], step: int = -1) -> None:
    """Write a step as a solid; see `Path.export`."""
    write_solid(path, file, step)


def write_solid(path: Path, file: str | os.PathLike[str], step: int = -1) -> Written:
    """Write the deformed body with its true thickness.

    Parameters
    ----------
    path : Path
    file : path
        `.stl`: a closed surface of flat triangles, binary, in mm. `.vtu`: solid elements of second order, in m, with
        the outputs of the mid-surface (stresses and strains of the faces are in the files of the steps).
    step : int
        Which converged step; negative counts from the last.

    Raises
    ------
    InputError
        No such step, a name that says another format.
    OSError
        The disk refuses; the message names the file.
    """
    target = with_suffix(file, STL, VTU)
    if not -len(path.steps) <= step < len(path.steps):
        raise InputError(f"There is no step {step}; the path has steps 0 to {len(path.steps) - 1}.")
    shown = path.steps[step]
    reached = converged(path.discretisation, shown)
    body = slab_of(reached)
    if target.suffix.lower() == STL:
        content = stl(closed_surface(body))
        write_atomically(target, content)
        return Written(target, shown.number, volume(body), len(content) // RECORD - 1)
    write_atomically(target, vtu(solid_grid(reached, shown)))
    return Written(target, shown.number, volume(body), len(body.elements))


def stl(surface: Surface) -> bytes:
    """A binary STL file, mm. Points that single precision makes one are one; triangles between them are left out."""
    points, number = np.unique((MM * surface.points).astype("<f4") + np.float32(0.0), axis=0, return_inverse=True)
    triangles = number.ravel()[surface.triangles]
    triangles = triangles[np.all(triangles != np.roll(triangles, 1, axis=1), axis=1)]
    corners = points[triangles]
    sides = corners[:, 1:].astype(float) - corners[:, :1]
    normals = np.cross(sides[:, 0], sides[:, 1])
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    records = np.zeros(len(corners), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    records["normal"] = normals / np.where(lengths > 0.0, lengths, 1.0)
    records["corners"] = corners
    head = b"magshell: deformed body, lengths in mm".ljust(80)
    return head + np.uint32(len(records)).astype("<u4").tobytes() + records.tobytes()
