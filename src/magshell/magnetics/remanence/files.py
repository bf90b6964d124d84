"""Remanence and templates from files: tables in CSV, arrays in NumPy's `.npy`."""

from __future__ import annotations

import csv
import math
import os
import pathlib
import warnings
from collections.abc import Iterator, Sequence
from tokenize import TokenError
from typing import TYPE_CHECKING

import numpy as np

from magshell import units
from magshell.arrays import FloatArray
from magshell.errors import InputError, suggest
from magshell.magnetics.remanence.deformed import Deformed
from magshell.magnetics.remanence.sampled import at_places, per_element
from magshell.magnetics.remanence.template import Placed
from magshell.magnetics.remanence.vectors import Remanence

if TYPE_CHECKING:
    from magshell.mesh import Mesh

PLACE = ("x1", "x2", "x3")
FLUX = ("b1", "b2", "b3")
DISPLACEMENT = ("u1", "u2", "u3")
COINCIDENT = 1e-5
LARGEST = 1e60
"""Of numbers in a table, whatever their unit: products of a few of them are still finite."""


def from_file(
    file: str | os.PathLike[str],
    flux_density_unit: str = "T",
    length_unit: str | None = "m",
    tolerance: float | None = None,
) -> Remanence:
    """Remanence from a table.

    Parameters
    ----------
    file : path
        A CSV file whose first line names the columns `b1,b2,b3`, and `x1,x2,x3` where the rows are places (see
        `at_places`); without them it has one row per element, in the order of the mesh. Other columns are passed over.
        Or a `.npy` file: an array (elements, 3).
    flux_density_unit : str
        Of its vectors.
    length_unit : str or None
        Of its places; None: it has none.
    tolerance : float, optional
        Largest distance from the centre of an element to its place, m.

    Raises
    ------
    InputError
        No such file; no such column; a line with a number that is none, too few or too many; an unknown unit.
    """
    tesla = factor(flux_density_unit, units.FLUX_DENSITY)
    path = pathlib.Path(file)
    if path.suffix == ".npy":
        vectors, places = read_array(path), None
    else:
        vectors, places = read_columns(path, FLUX, PLACE)
    if places is None:
        return per_element(tesla * vectors)
    if length_unit is None:
        raise InputError(f"{path.name}: has the columns {','.join(PLACE)}; length_unit must say in which unit")
    return at_places(factor(length_unit, units.LENGTH) * places, tesla * vectors, tolerance)


class DisplacementsAtPlaces:
    """Displacements at the nodes, known by their undeformed places; a `Shape`."""

    def __init__(self, places: FloatArray, displacements: FloatArray, name: str) -> None:
        self._places, self._displacements, self._name = places, displacements, name

    def place(self, mesh: Mesh, points: FloatArray) -> Placed:
        """Material points in the deformed shape."""
        from scipy.spatial import cKDTree

        distance, nearest = map(np.asarray, cKDTree(self._places).query(mesh.points))
        node = int(np.argmax(distance))
        if distance[node] > COINCIDENT * mesh.size:
            at = ", ".join(f"{x:.6g}" for x in mesh.points[node])
            raise InputError(
                f"remanence: {self._name} has no row for node {node} at ({at}) m; the next is {distance[node]:.3g} m "
                "away. It needs the undeformed place of every node, mid-side nodes too; check length_unit"
            )
        return Deformed(self._displacements[nearest]).place(mesh, points)


def displaced_from_file(file: str | os.PathLike[str], length_unit: str = "m") -> Deformed | DisplacementsAtPlaces:
    """A template from a table of displacements.

    Parameters
    ----------
    file : path
        A CSV file with the columns `u1,u2,u3`, and `x1,x2,x3` for the undeformed places of the nodes; without them, and
        in a `.npy` file (nodes, 3), there is one row per node in the order of the mesh.
    length_unit : str
        Of its numbers.

    Raises
    ------
    InputError
        As `from_file`.
    """
    metre = factor(length_unit, units.LENGTH)
    path = pathlib.Path(file)
    if path.suffix == ".npy":
        return Deformed(metre * read_array(path))
    displacements, places = read_columns(path, DISPLACEMENT, PLACE)
    if places is None:
        return Deformed(metre * displacements)
    return DisplacementsAtPlaces(metre * places, metre * displacements, path.name)


def factor(unit: str, dimension: units.Dimension) -> float:
    """SI value of a unit."""
    if unit not in dimension.units:
        raise InputError(
            f"'{units.shortened(unit)}' is not a unit of {dimension.name}. {suggest(unit, dimension.units)}"
        )
    return float(dimension.units[unit])


def read_columns(
    file: pathlib.Path, wanted: Sequence[str], optional: Sequence[str]
) -> tuple[FloatArray, FloatArray | None]:
    """Columns of a CSV file: those wanted (rows, k), and the optional ones (rows, k) if the file has them.

    Empty lines and lines that begin with # are passed over.

    Raises
    ------
    InputError
        With file and line.
    """
    lines = _lines(file)
    number, header = next(lines, (0, []))
    if not number:
        raise InputError(f"{file.name}: is empty; its first line names the columns {','.join((*optional, *wanted))}")
    names = [name.strip() for name in header]
    for name in (*wanted, *(optional if set(optional) & set(names) else ())):
        if names.count(name) != 1:
            fault = "there is no column" if name not in names else "more than one column is named"
            raise InputError(
                f"{file.name}, line {number}: {fault} '{name}'; the columns are {units.quoted(','.join(names))}"
            )
    columns = [*wanted, *(optional if optional[0] in names else ())]
    places = [names.index(name) for name in columns]
    rows = [_row(file, number, fields, names, places) for number, fields in lines]
    if not rows:
        raise InputError(f"{file.name}: has no rows below its first line")
    table = np.array(rows)
    return table[:, : len(wanted)], table[:, len(wanted) :] if len(columns) > len(wanted) else None


def _row(file: pathlib.Path, number: int, fields: list[str], names: list[str], places: list[int]) -> list[float]:
    if len(fields) != len(names):
        raise InputError(f"{file.name}, line {number}: has {len(fields)} fields; the first line has {len(names)}")
    row = []
    for place in places:
        try:
            value = float(fields[place])
        except ValueError:
            value = math.nan
        if not abs(value) < LARGEST:
            found = units.quoted(fields[place].strip())
            fault = f"more than {LARGEST:g}" if math.isfinite(value) else "not a finite number"
            raise InputError(f"{file.name}, line {number}: {names[place]} is {found}, {fault}")
        row.append(value)
    return row


def _lines(file: pathlib.Path) -> Iterator[tuple[int, list[str]]]:
    """Line number and fields of every line that says something."""
    try:
        with file.open(encoding="utf-8-sig", newline="") as opened:
            reader = csv.reader(opened)
            for fields in reader:
                if fields and any(field.strip() for field in fields) and not fields[0].lstrip().startswith("#"):
                    yield reader.line_num, fields
    except UnicodeDecodeError as error:
        raise InputError(f"{file.name}: is not a text file in UTF-8 (byte {error.start})") from None
    except csv.Error as error:
        raise InputError(f"{file.name}: is not a CSV file: {error}") from None
    except (OSError, ValueError) as error:
        raise InputError(_unreadable(file, error)) from None


def read_array(file: pathlib.Path) -> FloatArray:
    """An array (n, 3) of finite numbers from a `.npy` file."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of a header that is damaged or of another age
            array = np.load(file, allow_pickle=False)
    except OSError as error:
        raise InputError(_unreadable(file, error)) from None
    except (ValueError, EOFError, SyntaxError, TokenError, MemoryError) as error:
        raise InputError(f"{file.name}: is not an array of numbers in NumPy's format: {error}") from None
    if not isinstance(array, np.ndarray) or array.dtype.kind not in "fiu" or array.ndim != 2 or array.shape[1] != 3:
        found = f"{array.dtype} of shape {array.shape}" if isinstance(array, np.ndarray) else "an archive"
        raise InputError(f"{file.name}: holds {found}; it must be numbers of shape (n, 3)")
    numbers = array.astype(float)
    for allowed, fault in (
        (np.isfinite(numbers), "is not finite"),
        (np.abs(numbers) < LARGEST, f"is over {LARGEST:g}"),
    ):
        if not allowed.all():
            raise InputError(f"{file.name}: row {np.flatnonzero(~allowed.all(axis=1))[0]} {fault}")
    return numbers


def _unreadable(file: pathlib.Path, error: Exception) -> str:
    if isinstance(error, FileNotFoundError):
        return f"{file}: there is no such file"
    return f"{file}: cannot be read: {getattr(error, 'strerror', None) or error}"
