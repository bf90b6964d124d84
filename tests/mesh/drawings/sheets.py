"""Drawings that tests make, and what they measure of flat meshes."""

from __future__ import annotations

import importlib.util

import numpy as np
import pytest

NEEDED = ("gmsh", "ezdxf", "svgelements", "shapely")
needs_drawings = pytest.mark.skipif(
    any(importlib.util.find_spec(package) is None for package in NEEDED), reason="needs the extra magshell[drawings]"
)
SQUARE = [(0, 0), (10, 0), (10, 10), (0, 10)]


def dxf(file, draw, units=4):
    """A DXF file with what `draw` puts into its model space."""
    import ezdxf

    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = units
    draw(document.modelspace(), document)
    document.saveas(file)
    return file


def lines(space, corners, layer="cut", closed=True):
    """Single lines between corners."""
    following = [*corners[1:], corners[0]] if closed else corners[1:]
    for begin, end in zip(corners, following, strict=False):
        space.add_line(begin, end, dxfattribs={"layer": layer})


def area(mesh, elements=slice(None)):
    """Of flat elements with parabolic sides, m²."""
    x = mesh.points[mesh.elements[elements], :2]

    def shoelace(ring):
        following = np.roll(ring, -1, axis=1)
        return 0.5 * (ring[..., 0] * following[..., 1] - ring[..., 1] * following[..., 0]).sum(axis=1)

    corners = shoelace(x[:, :4])
    return float((corners + 4.0 / 3.0 * (shoelace(x[:, [0, 4, 1, 5, 2, 6, 3, 7]]) - corners)).sum())


def normals(mesh):
    """Third components of the normals of flat elements."""
    x = mesh.points[mesh.elements[:, :4], :2]
    one, other = x[:, 2] - x[:, 0], x[:, 3] - x[:, 1]
    return one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]
