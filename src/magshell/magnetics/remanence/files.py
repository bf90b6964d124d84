"""Remanence and templates from files: tables in CSV, arrays in NumPy's `.npy`."""

from __future__ import annotations

import os
import pathlib
import warnings
from tokenize import TokenError
from typing import TYPE_CHECKING

import numpy as np

from magshell import units
from magshell.arrays import FloatArray
from magshell.errors import InputError, suggest
from magshell.keys import Key
from magshell.magnetics.remanence.deformed import Deformed
from magshell.magnetics.remanence.sampled import at_places, per_element
from magshell.magnetics.remanence.template import Placed, in_template
from magshell.magnetics.remanence.vectors import Remanence
from magshell.magnetics.remanence.way import Way
from magshell.tables import LARGEST, Columns, Table, duplicate, read_table, unreadable

if TYPE_CHECKING:
    from magshell.mesh import Mesh

PLACE = ("x1", "x2", "x3")
FLUX = ("b1", "b2", "b3")
DISPLACEMENT = ("u1", "u2", "u3")
COINCIDENT = 1e-5


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
        Semicolons, tabs, decimal commas and units in headings are read (`magshell.tables`).
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
        No such file; no such column; a line with something that is not a number, or too few or too many of them; an
        unknown unit, or another one in a heading; a place with two values.
    """
    tesla = factor(flux_density_unit, units.REMANENCE)
    path = pathlib.Path(file)
    if path.suffix == ".npy":
        return per_element(tesla * read_array(path))
    flux = Columns(FLUX, units.REMANENCE, flux_density_unit, "flux_density_unit")
    table = read_table(path, flux, Columns(PLACE, units.LENGTH, length_unit, "length_unit"))
    if table.optional is None:
        return per_element(tesla * table.wanted)
    if length_unit is None:
        raise InputError(f"{path.name}: has the columns {','.join(PLACE)}; length_unit must say in which unit")
    check_one_value_each(path, table, "Keep one of the lines")
    return at_places(factor(length_unit, units.LENGTH) * table.optional, tesla * table.wanted, tolerance)


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
    columns = (Columns(names, units.LENGTH, length_unit, "length_unit") for names in (DISPLACEMENT, PLACE))
    table = read_table(path, *columns)
    if table.optional is None:
        return Deformed(metre * table.wanted)
    advice = "At a slit, leave the places out and give a line for each node, in the order of the mesh"
    check_one_value_each(path, table, advice)
    return DisplacementsAtPlaces(metre * table.optional, metre * table.wanted, path.name)


def check_one_value_each(file: pathlib.Path, table: Table, advice: str) -> None:
    """Refuse a place that stands in a table twice, with different values."""
    assert table.optional is not None
    found = duplicate(table.optional, table.wanted)
    if found is not None:
        earlier, later = (table.lines[row] for row in found)
        place, one, other = (
            ", ".join(f"{number:.6g}" for number in numbers)
            for numbers in (table.optional[found[1]], table.wanted[found[0]], table.wanted[found[1]])
        )
        raise InputError(
            f"{file.name}, line {later}: the place ({place}) has ({other}), but in line {earlier} it has ({one}). "
            + advice
        )


def factor(unit: str, dimension: units.Dimension) -> float:
    """SI value of a unit."""
    value = dimension.value(unit)
    if value is None:
        raise InputError(
            f"'{units.shortened(unit)}' is not a unit of {dimension.name}. {suggest(unit, dimension.units)}"
        )
    return value


def read_array(file: pathlib.Path) -> FloatArray:
    """An array (n, 3) of finite numbers from a `.npy` file."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of a header that is damaged or of another age
            array = np.load(file, allow_pickle=False)
    except OSError as error:
        raise InputError(unreadable(file, error)) from None
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


FROM_FILE = Way(
    lambda file, flux_density_unit, length_unit=None, tolerance=None: from_file(
        file, flux_density_unit, length_unit, tolerance
    ),
    {
        "file": Key(
            "FileName",
            "CSV with the columns `b1,b2,b3` and, if its rows are places, `x1,x2,x3`; without them one row per "
            "element. Or a `.npy` array (elements, 3).",
        ),
        "flux_density_unit": Key("RemanenceUnit", 'Unit of the vectors, such as `"mT"`.'),
        "length_unit": Key("LengthUnit", "Unit of the places."),
        "tolerance": Key("PositiveLength", "Largest distance from the centre of an element to its place."),
    },
    lambda file, **others: f"from {file}",
)
DEFORMED = in_template(
    displaced_from_file,
    {
        "displacements": Key(
            "FileName",
            "CSV with the columns `u1,u2,u3` and, for the undeformed places of the nodes, `x1,x2,x3`; without them one "
            "row per node. Or a `.npy` array (nodes, 3).",
        ),
        "length_unit": Key("LengthUnit", "Unit of its numbers."),
    },
    lambda displacements, length_unit: f"deformed as {displacements} says",
)
