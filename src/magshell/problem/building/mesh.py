"""The mesh of a problem."""

from __future__ import annotations

import pathlib
import re

import numpy as np

from magshell.errors import InputError
from magshell.mesh import Mesh, annulus, blocks, cylinder, miura, polygon, profile, rectangle, sphere_patch
from magshell.mesh.opening import Wishes, meshes, open_mesh
from magshell.problem import schema
from magshell.problem.building.located import at
from magshell.problem.schema.mesh import Generated

MOST_ELEMENTS = 1_000_000
_SELECTIONS = {
    "element_groups": Mesh.select_elements,
    "edge_groups": Mesh.select_edges,
    "node_groups": Mesh.select_nodes,
}


def build_mesh(table: schema.Mesh, folder: pathlib.Path) -> Mesh:
    """The mesh that a table describes, with its selections as groups."""
    if isinstance(table, schema.MeshFile):
        mesh = _read(table, folder)
    else:
        with at("mesh"):
            mesh = _generated(table)
    for kind, select in _SELECTIONS.items():
        for name, chosen in getattr(table, kind).items():
            with at(f"mesh.{kind}.{name}"):
                mesh = select(mesh, name, chosen.x1, chosen.x2, chosen.x3, chosen.groups, chosen.shapes)
    return mesh


def _read(table: schema.MeshFile, folder: pathlib.Path) -> Mesh:
    try:
        mesh = open_mesh(folder / table.file, wishes_of(table))
    except InputError as error:
        of_key = re.match(r"(unit|size|mid_surface|second_order|closed|holes|gap|weld|cuts): ", str(error))
        raise InputError(f"mesh.{error}" if of_key else f"mesh.file: {error}") from None
    if len(mesh.elements) > MOST_ELEMENTS:
        raise InputError(f"mesh.file: {table.file} has {len(mesh.elements)} elements; at most {MOST_ELEMENTS}")
    return mesh


def wishes_of(table: schema.MeshFile) -> Wishes:
    """What a table asks for."""
    return Wishes(
        unit=table.unit,
        size=table.size,
        second_order=table.second_order,
        closed=table.closed,
        mid_surface=table.mid_surface,
        holes=table.holes,
        gap=table.gap,
        weld=table.weld,
        cuts=table.cuts,
    )


def made_by_gmsh(table: schema.Mesh) -> bool:
    """Whether gmsh makes the mesh of a table whenever it is built."""
    if isinstance(table, schema.MeshFile):
        return meshes(table.file, wishes_of(table))
    return isinstance(table, schema.Polygon)


def _generated(table: Generated) -> Mesh:
    match table:
        case schema.Rectangle():
            _bounded(table.elements)
            return rectangle(table.length, table.width, table.elements)
        case schema.Annulus():
            _bounded(table.elements)
            return annulus(table.inner_radius, table.outer_radius, table.elements, table.angle, table.slit)
        case schema.Cylinder():
            _bounded(table.elements)
            return cylinder(table.radius, table.length, table.elements, table.angle, table.axis, table.zero)
        case schema.SpherePatch():
            _bounded(table.elements)
            return sphere_patch(table.radius, table.polar, table.azimuth, table.elements)
        case schema.Profile():
            across = {**dict.fromkeys(table.walls, table.elements[0]), **table.divided}
            _bounded(*((number, table.elements[1]) for number in across.values()))
            walls = {name: wall.between for name, wall in table.walls.items()}
            return profile(table.points, walls, table.length, table.elements, table.divided, table.axis, table.first)
        case schema.Miura():
            _bounded((2 * table.cells[0] * table.elements[0], 2 * table.cells[1] * table.elements[1]))
            return miura(table.sides, table.sector, table.fold, table.cells, table.elements)
        case schema.Polygon():
            return polygon(table.corners, table.size, table.holes)
        case schema.Blocks():
            divisions = {name: table.divisions(name) for name in table.blocks}
            _bounded(*divisions.values())
            spatial = any(len(corner) == 3 for block in table.blocks.values() for corner in block.corners)
            corners = {
                name: np.array([[*corner, 0.0][: 3 if spatial else 2] for corner in block.corners])
                for name, block in table.blocks.items()
            }
            return blocks(corners, divisions)


def _bounded(*divisions: tuple[int, int]) -> None:
    elements = sum(n * m for n, m in divisions)
    if elements > MOST_ELEMENTS:
        raise InputError(f"elements: asks for {elements} elements; at most {MOST_ELEMENTS} can be solved")
