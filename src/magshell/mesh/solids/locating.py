"""VTK's search among triangles."""

from __future__ import annotations

from typing import Any

import numpy as np

from magshell.arrays import FloatArray, IntArray


def locator_of(points: FloatArray, triangles: IntArray) -> Any:
    """A `vtkStaticCellLocator` of triangles (m, 3)."""
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData, vtkStaticCellLocator

    surface, corners, cells = vtkPolyData(), vtkPoints(), vtkCellArray()
    corners.SetDataTypeToDouble()
    corners.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=1))
    listed = np.column_stack([np.full(len(triangles), 3), triangles]).astype(np.int64)
    cells.ImportLegacyFormat(numpy_to_vtkIdTypeArray(listed.ravel(), deep=1))
    surface.SetPoints(corners)
    surface.SetPolys(cells)
    locator = vtkStaticCellLocator()
    locator.SetDataSet(surface)
    locator.BuildLocator()
    return locator
