"""Meshes of 8-node quadrilaterals and 6-node triangles with named groups, from a generator, a file or arrays."""

from __future__ import annotations

from magshell.mesh.cuts import cut
from magshell.mesh.drawings.polygons import polygon
from magshell.mesh.drawings.reading import from_drawing
from magshell.mesh.extrusion import profile
from magshell.mesh.files import from_cad, read, write
from magshell.mesh.generators import annulus, cylinder, rectangle, sphere_patch
from magshell.mesh.mesh import Mesh
from magshell.mesh.multiblock import blocks
from magshell.mesh.origami import miura
from magshell.mesh.shapes import in_cylinder, in_polygon, in_sphere
from magshell.mesh.solids.mid_surface import mid_surface
from magshell.mesh.triangles import split, triangle_rows

__all__ = [
    "Mesh",
    "annulus",
    "blocks",
    "cut",
    "cylinder",
    "from_cad",
    "from_drawing",
    "in_cylinder",
    "in_polygon",
    "in_sphere",
    "mid_surface",
    "miura",
    "polygon",
    "profile",
    "read",
    "rectangle",
    "sphere_patch",
    "split",
    "triangle_rows",
    "write",
]
