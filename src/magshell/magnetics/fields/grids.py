"""Grids of B from files: tables in CSV, VTK images and rectilinear grids, arrays of NumPy.

* CSV with the columns `x1,x2,x3,b1,b2,b3` (see `magshell.tables`): one row per position, in any order.
* COMSOL's export (`.csv`, `.txt`): lines of comment that begin with %, then rows x, y, z, Bx, By, Bz.
* `.vti`, `.vtr`, `.vtk`: a point array of three components, `B` or the only one.
* `.npz` with the arrays `x1`, `x2`, `x3` and `B` (n1, n2, n3, 3); `.npy` with rows x1, x2, x3, B1, B2, B3.
"""

from __future__ import annotations

import os
import pathlib
import warnings
import zipfile
from typing import Any

import numpy as np

from magshell import units
from magshell.arrays import FloatArray
from magshell.errors import InputError, suggest
from magshell.files import first_line
from magshell.magnetics.fields.motion import Motion
from magshell.magnetics.fields.sampled import SampledField
from magshell.tables import Columns, read_table, unreadable

PLACE = ("x1", "x2", "x3")
FLUX = ("b1", "b2", "b3")
READERS = (".csv", ".txt", ".vti", ".vtr", ".vtk", ".npz", ".npy")
SAME = 1e-6
"""Coordinates nearer than this, over the extent of their axis, are one."""


def read_grid(
    file: str | os.PathLike[str],
    flux_density_unit: str = "T",
    length_unit: str = "m",
    motion: Motion | None = None,
    name: str = "sampled",
) -> SampledField:
    """A field from a file.

    Parameters
    ----------
    file : path
        `.csv` (or `.txt`), `.vti`, `.vtr`, `.vtk`, `.npz` or `.npy`.
    flux_density_unit, length_unit : str
        Of its numbers.
    motion : Motion, optional
    name : str
        Of its columns in `history.csv`.

    Raises
    ------
    InputError
        No such file, another kind of file, positions that are no grid (the first that is missing or double is named),
        numbers that are not finite, an unknown unit.
    """
    path = pathlib.Path(file)
    tesla, metre = _factor(flux_density_unit, units.FLUX_DENSITY), _factor(length_unit, units.LENGTH)
    suffix = path.suffix.lower()
    if suffix not in READERS:
        raise InputError(f"{path.name}: a grid is read from {', '.join(READERS)}; '{path.suffix}' is none of them")
    if not path.is_file():
        raise InputError(f"{path}: there is no such file")
    if suffix in (".csv", ".txt") and first_line(path).startswith("%"):
        axes, B = _arranged(path.name, *_of_comsol(path, length_unit))
    elif suffix in (".csv", ".txt"):
        table = read_table(
            path,
            Columns(FLUX, units.FLUX_DENSITY, flux_density_unit, "flux_density_unit"),
            Columns(PLACE, units.LENGTH, length_unit, "length_unit"),
        )
        if table.optional is None:
            raise InputError(f"{path.name}: has no columns {','.join(PLACE)}; a grid needs its positions")
        axes, B = _arranged(path.name, table.optional, table.wanted)
    elif suffix in (".npz", ".npy"):
        axes, B = _of_numpy(path)
    else:
        axes, B = _of_vtk(path)
    try:
        return SampledField([metre * axis for axis in axes], tesla * B, motion or Motion(), name)
    except InputError as error:
        raise InputError(f"{path.name}: {error}") from None


def _factor(unit: str, dimension: units.Dimension) -> float:
    value = dimension.value(unit)
    if value is None:
        raise InputError(f"{units.quoted(unit)} is not a unit of {dimension.name}. {suggest(unit, dimension.units)}")
    return value


def _of_comsol(path: pathlib.Path, length_unit: str) -> tuple[FloatArray, FloatArray]:
    """Positions and values of an export of COMSOL, whose comments name the unit of lengths."""
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, ValueError) as error:
        raise InputError(unreadable(path, error)) from None
    lines = text.splitlines()
    comments = [line[1:].strip() for line in lines if line.startswith("%")]
    for comment in comments:
        key, _, said = comment.replace('"', "").partition("Length unit")
        own = said.strip(" :,") if not key else ""
        if own and units.LENGTH.value(own) != units.LENGTH.value(length_unit):
            raise InputError(
                f"{path.name}: its lengths are in {units.quoted(own)}, but length_unit says '{length_unit}'"
            )
    rows = [line.replace(",", " ").split() for line in lines if line.strip() and not line.startswith("%")]
    if not rows or any(len(row) != 6 for row in rows):
        found = sorted({len(row) for row in rows})
        raise InputError(
            f"{path.name}: its rows have {' or '.join(map(str, found)) or 'no'} numbers; they must have six: x, y, z, "
            "Bx, By, Bz. Export these three expressions on a regular grid in three dimensions"
        )
    try:
        numbers = np.array(rows, dtype=float)
    except ValueError as error:
        raise InputError(f"{path.name}: {error}") from None
    if not np.isfinite(numbers[:, :3]).all():
        raise InputError(f"{path.name}: a position is not finite")
    return numbers[:, :3], numbers[:, 3:]


def _arranged(name: str, places: FloatArray, values: FloatArray) -> tuple[list[FloatArray], FloatArray]:
    """Axes and values (n1, n2, n3, 3) of rows in any order."""
    axes, numbers = [], []
    for column in places.T:
        axis, number = _levels(column)
        axes.append(axis)
        numbers.append(number)
    shape = tuple(map(len, axes))
    flat = np.ravel_multi_index(tuple(numbers), shape)
    count = np.bincount(flat, minlength=int(np.prod(shape)))
    for wrong, what in ((count > 1, "is there more than once"), (count == 0, "is missing")):
        if wrong.any():
            at = np.unravel_index(int(np.argmax(wrong)), shape)
            place = ", ".join(f"{axis[k]:.6g}" for axis, k in zip(axes, at, strict=True))
            raise InputError(
                f"{name}: its {len(places)} positions have {' × '.join(map(str, shape))} different coordinates, and "
                f"the position ({place}) {what}; a regular grid has each once. Export on a grid without holes"
            )
    B = np.empty((int(np.prod(shape)), 3))
    B[flat] = values
    return axes, B.reshape(*shape, 3)


def _levels(column: FloatArray) -> tuple[FloatArray, Any]:
    """Different coordinates, and the number of that of each row."""
    different, inverse = np.unique(column, return_inverse=True)
    starts = np.append(True, np.diff(different) > SAME * max(float(np.ptp(column)), 1e-300))
    group = np.cumsum(starts) - 1
    return different[starts], group[inverse.ravel()]


def _of_numpy(path: pathlib.Path) -> tuple[list[FloatArray], FloatArray]:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            loaded = np.load(path, allow_pickle=False)
            if path.suffix.lower() == ".npy":
                return _arranged(path.name, *_rows(path, loaded))
            with loaded:
                missing = [key for key in (*PLACE, "B") if key not in loaded]
                if missing:
                    raise InputError(f"{path.name}: has no array '{missing[0]}'. {suggest(missing[0], loaded.files)}")
                arrays = [_numbers(path, loaded[key]) for key in (*PLACE, "B")]
    except InputError:
        raise
    except (OSError, ValueError, EOFError, SyntaxError, KeyError, MemoryError, zipfile.BadZipFile) as error:
        raise InputError(f"{path.name}: is not a file of NumPy's arrays: {error}") from None
    return arrays[:3], arrays[3]


def _rows(path: pathlib.Path, loaded: Any) -> tuple[FloatArray, FloatArray]:
    rows = _numbers(path, loaded)
    if rows.ndim != 2 or rows.shape[1] != 6:
        raise InputError(f"{path.name}: holds an array of shape {rows.shape}; it must be rows x1, x2, x3, B1, B2, B3")
    return rows[:, :3], rows[:, 3:]


def _numbers(path: pathlib.Path, array: Any) -> FloatArray:
    if array.dtype.kind not in "fiu":
        raise InputError(f"{path.name}: holds {array.dtype} where numbers are expected")
    return np.asarray(array, dtype=float)


def _of_vtk(path: pathlib.Path) -> tuple[list[FloatArray], FloatArray]:
    import pyvista

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # what VTK's readers only warn of
            grid = pyvista.read(path)
    except Exception as error:  # of VTK's readers, whatever they raise
        raise InputError(unreadable(path, error)) from None
    if isinstance(grid, pyvista.ImageData):
        axes = [
            grid.origin[k] + grid.spacing[k] * (grid.extent[2 * k] + np.arange(grid.dimensions[k])) for k in range(3)
        ]
    elif isinstance(grid, pyvista.RectilinearGrid):
        axes = [np.asarray(axis, dtype=float) for axis in (grid.x, grid.y, grid.z)]
    else:
        raise InputError(
            f"{path.name}: holds a {type(grid).__name__}; a grid is an image (.vti) or a rectilinear grid (.vtr)"
        )
    vectors = [key for key in grid.point_data if np.shape(grid.point_data[key])[1:] == (3,)]
    chosen = "B" if "B" in vectors else vectors[0] if len(vectors) == 1 else None
    if chosen is None:
        listed = ", ".join(vectors) or "none"
        raise InputError(f"{path.name}: needs a point array 'B' of three components; those of three are: {listed}")
    B = np.asarray(grid.point_data[chosen], dtype=float)
    return axes, B.reshape(*map(len, reversed(axes)), 3).transpose(2, 1, 0, 3)
