"""VTK's files: `.vtu`, `.vtp` and `.vtk`, with the element groups of the program's own step files."""

from __future__ import annotations

import pathlib
from typing import Any

import numpy as np

from magshell.arrays import IntArray
from magshell.errors import InputError
from magshell.mesh.files.cells import VTK
from magshell.mesh.files.contents import Block, Contents

NAMES, MEMBERSHIP = "element_group_names", "element_group"
"""Field data and cell array of the program's own files: names, and the number of each element's group, from 1.

The names are the bytes of lines in UTF-8, or, in older files, an array of texts."""
_OWN_UNIT = "m"


def read_vtk(path: pathlib.Path, name: str) -> Contents:
    """Read an unstructured grid, or the polygons of a surface.

    Parameters
    ----------
    path : pathlib.Path
    name : str
        Of the file, for messages.

    Raises
    ------
    InputError
        Not a file of VTK, or one that holds neither.
    """
    grid = _grid(path, name)
    points = np.zeros((0, 3))
    if grid.GetNumberOfPoints():
        points = np.array(_array(grid.GetPoints().GetData()), dtype=np.float64)
    types = np.array([], dtype=np.int64)
    if grid.GetNumberOfCells():
        types = np.array([grid.GetCellType(cell) for cell in range(grid.GetNumberOfCells())], dtype=np.int64)
    if not len(types):
        raise InputError(f"{name}: has no cells; it is no mesh, or not a file of VTK, or it is cut short")
    bad = np.flatnonzero(~np.isfinite(points).all(axis=1))
    if bad.size:
        raise InputError(f"{name}: point {bad[0]} is not finite")
    starts = np.array(_array(grid.GetCells().GetOffsetsArray()), dtype=np.int64)
    nodes = np.array(_array(grid.GetCells().GetConnectivityArray()), dtype=np.int64)
    _sound(starts, nodes, len(types), len(points), name)
    own = grid.GetFieldData().GetAbstractArray(NAMES) is not None
    names, membership = _groups(grid, len(types))
    blocks, solids, notes, unread = [], 0, [], {}
    kinds, which, counts = np.unique(
        np.column_stack([types, np.diff(starts)]), axis=0, return_inverse=True, return_counts=True
    )
    for number, (vtk_type, width) in enumerate(kinds.tolist()):
        kind = next((kind for kind in VTK.get(vtk_type, ()) if kind.nodes == width), None)
        if kind is None:
            called, dimension = _cell_type(vtk_type)
            if dimension == 3:
                solids += int(counts[number])
            elif dimension == 2 or dimension is None:
                unread[f"{vtk_type} ({called}) with {width} nodes"] = int(counts[number])
            else:
                notes.append(f"{counts[number]} cells of VTK's type {vtk_type} ({called}) left out")
            continue
        cells = np.flatnonzero(which.ravel() == number)
        rows = nodes[starts[cells][:, None] + np.arange(kind.nodes)]
        groups = {
            group: np.flatnonzero(membership[cells] == number)
            for number, group in enumerate(names, start=1)
            if (membership[cells] == number).any()
        }
        blocks.append(Block(kind, cells, rows, groups))
    unit = _OWN_UNIT if own else None
    return Contents(points, blocks, solids=solids, unread=unread, unit=unit, notes=tuple(notes))


def _cell_type(number: int) -> tuple[str, int | None]:
    """VTK's name of a type of cells, and its dimension; None where VTK itself does not know it."""
    from vtkmodules.vtkCommonDataModel import vtkGenericCell

    cell = vtkGenericCell.InstantiateCell(number)
    return (cell.GetClassName(), int(cell.GetCellDimension())) if cell is not None else ("unknown", None)


def _grid(path: pathlib.Path, name: str) -> Any:
    """What VTK reads, with its complaints kept from the terminal."""
    from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
    from vtkmodules.vtkFiltersCore import vtkAppendFilter
    from vtkmodules.vtkIOLegacy import vtkGenericDataObjectReader
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader

    readers = {".vtu": vtkXMLUnstructuredGridReader, ".vtp": vtkXMLPolyDataReader}
    reader = readers.get(path.suffix.lower(), vtkGenericDataObjectReader)()
    usual, listening = vtkOutputWindow.GetInstance(), vtkStringOutputWindow()
    vtkOutputWindow.SetInstance(listening)
    try:
        reader.SetFileName(str(path))
        reader.Update()
    finally:
        vtkOutputWindow.SetInstance(usual)
    found = reader.GetOutput()
    known = found is not None and found.GetClassName() in ("vtkUnstructuredGrid", "vtkPolyData")
    if not known or "ERR" in listening.GetOutput().upper():
        raise InputError(
            f"{name}: cannot be read as an unstructured grid or polygons of VTK; it is damaged, or of another kind"
        )
    if found.GetClassName() == "vtkPolyData":
        joined = vtkAppendFilter()
        joined.AddInputData(found)
        joined.Update()
        found = joined.GetOutput()
    return found


def _array(data: Any) -> Any:
    from vtkmodules.util.numpy_support import vtk_to_numpy

    return vtk_to_numpy(data)


def _sound(starts: IntArray, nodes: IntArray, cells: int, points: int, name: str) -> None:
    """Refuse cells that begin or end outside the list of nodes, and nodes that do not exist."""
    if len(starts) != cells + 1 or starts[0] != 0 or (np.diff(starts) < 0).any() or starts[-1] != len(nodes):
        raise InputError(f"{name}: the offsets of its cells do not fit their {len(nodes)} nodes; it is damaged")
    bad = np.flatnonzero((nodes < 0) | (nodes >= points))
    if bad.size:
        cell = int(np.searchsorted(starts, bad[0], side="right")) - 1
        raise InputError(f"{name}: cell {cell} has point {nodes[bad[0]]}, but points are numbered 0 to {points - 1}")


def _groups(grid: Any, cells: int) -> tuple[list[str], IntArray]:
    """Names of the element groups, and the number of each cell's group; of other programs' files nothing."""
    names = grid.GetFieldData().GetAbstractArray(NAMES)
    membership = grid.GetCellData().GetArray(MEMBERSHIP)
    if names is None or membership is None:
        return [], np.zeros(cells, dtype=np.int64)
    numbers = np.array(_array(membership)).reshape(cells, -1)[:, 0]
    return _texts(names), numbers.astype(np.int64)


def _texts(array: Any) -> list[str]:
    """What `magshell.output.vtu` wrote as texts."""
    if array.GetClassName() == "vtkStringArray":
        return [str(array.GetValue(row)) for row in range(array.GetNumberOfValues())]
    text = np.array(_array(array)).astype(np.uint8).tobytes().decode("utf-8", "replace")
    return text.split("\n") if text.strip("\n") else []
