"""One mesh that gmsh writes in many formats is read as one mesh; VTK's cells have the edges that VTK gives them."""

from __future__ import annotations

import importlib.util

import numpy as np
import pytest
from scipy.spatial import cKDTree

import magshell as ms
from magshell.mesh.files.session import session
from magshell.mesh.junctions import junctions_of

from .test_other_files import vtk_grid

needs_gmsh = pytest.mark.skipif(importlib.util.find_spec("gmsh") is None, reason="needs the extra magshell[gmsh]")


def draw(gmsh, kind):
    """A curved surface of two parts and a fin along the curve between them, with groups of every kind."""
    occ = gmsh.model.occ
    bottom, top = (occ.addSpline([occ.addPoint(x, y, z) for x, z in ((0, 0), (7, 2), (20, 1))]) for y in (0, 5))
    far = occ.addSpline([occ.addPoint(x, 11, z) for x, z in ((0, 1), (9, 4), (20, 0))])
    up = occ.addSpline([occ.addPoint(x, 6, z) for x, z in ((0, 6), (7, 8), (20, 7))])
    for one, other in ((bottom, top), (top, far), (top, up)):
        occ.addThruSections([occ.addWire([one]), occ.addWire([other])], makeSolid=False)
    occ.removeAllDuplicates()
    occ.synchronize()
    surfaces = [tag for _, tag in gmsh.model.getEntities(2)]
    curves = [tag for _, tag in gmsh.model.getEntities(1)]
    add, name = gmsh.model.addPhysicalGroup, gmsh.model.setPhysicalName
    for dimension, tags, called in ((2, surfaces, "all"), (1, curves[:2], "some"), (1, curves[-1:], "last")):
        name(dimension, add(dimension, tags), called)
    option = gmsh.option.setNumber
    option("General.Terminal", 0)
    option("Mesh.MeshSizeMax", 3.0)
    option("Mesh.RecombineAll", "quads" in kind)
    option("Mesh.SecondOrderIncomplete", 1)
    option("Mesh.SaveGroupsOfNodes", 0)
    gmsh.model.mesh.generate(2)
    if "second" in kind:
        gmsh.model.mesh.setOrder(2)


@needs_gmsh
@pytest.mark.parametrize("kind", ["triangles", "quads", "triangles of second order", "quads of second order"])
def test_one_mesh(kind, tmp_path):
    with session("test") as gmsh:
        draw(gmsh, kind)
        files = ["part.msh", "part.unv", "free.bdf", "small.bdf", "long.bdf", "part.vtk"]
        files += ["part.med"] if importlib.util.find_spec("h5py") else []
        for file in files:
            form = ("free", "small", "long").index(file[:-4]) if file.endswith("bdf") else 1
            gmsh.option.setNumber("Mesh.BdfFieldFormat", form)
            gmsh.write(str(tmp_path / file))
    read = {file: ms.mesh.read(tmp_path / file, unit="mm", second_order=True) for file in files}
    right = read.pop("part.msh")
    assert len(junctions_of(right).joints) == 1
    for file, mesh in read.items():
        nodes = same_nodes(mesh, right, 2e-5 if file.endswith("bdf") else 1e-9)
        assert as_sets(nodes[mesh.elements]) == as_sets(right.elements), file
        if file in ("part.unv", "part.med"):
            for found, wanted in (
                (mesh.element_groups, right.element_groups),
                (mesh.edge_groups, right.edge_groups),
            ):
                assert set(found) == set(wanted), file
            for name, rows in right.element_groups.items():
                assert as_sets(nodes[mesh.elements[mesh.element_groups[name]]]) == as_sets(right.elements[rows]), file
            for name, rows in right.edge_groups.items():
                assert as_sets(nodes[mesh.edge_groups[name]]) == as_sets(rows), file


def same_nodes(mesh, other, tolerance):
    """Number of each node in another mesh; the tolerance is that of corners, of which new middles make more."""
    distance, nodes = cKDTree(other.points).query(mesh.points)
    assert distance[mesh.elements[:, :4]].max() < tolerance * mesh.size
    assert distance.max() < 20 * tolerance * mesh.size
    assert len(np.unique(nodes)) == len(other.points)
    return nodes


def as_sets(rows):
    """Elements or edges by their nodes: corners and, apart from them, middles."""
    corners = 4 if rows.shape[1] == 8 else 2
    return sorted((sorted(row[:corners]), sorted(row[corners:])) for row in rows.tolist())


@pytest.mark.parametrize(("kind", "count"), [(69, 3), (69, 6), (70, 4), (70, 9), (22, 6), (23, 8), (28, 9), (34, 7)])
def test_cells_have_the_edges_that_vtk_gives_them(kind, count, tmp_path):
    """A cell bent at random: VTK's own edges of it, with their middles, are those of the element."""
    parametric = {
        3: [(0, 0), (1, 0), (0, 1)],
        4: [(0, 0), (1, 0), (1, 1), (0, 1)],
    }[3 if kind in (69, 22, 34) else 4]
    corners = len(parametric)
    middles = [np.add(parametric[i], parametric[(i + 1) % corners]) / 2 for i in range(corners)]
    flat = [*parametric, *middles, np.mean(parametric, axis=0)][:count]
    points = np.column_stack([flat, 0.05 * np.random.default_rng(kind).random(count)])
    grid = vtk_grid(points, np.arange(count)[None], kind)
    cell = grid.GetCell(0)
    edges = [cell.GetEdge(i) for i in range(cell.GetNumberOfEdges())]
    wanted = [[edge.GetPoints().GetPoint(i) for i in range(edge.GetNumberOfPoints())] for edge in edges]
    grid.save(tmp_path / "cell.vtu")
    mesh = ms.mesh.read(tmp_path / "cell.vtu", unit="m", second_order=True)
    found = mesh.points[mesh.boundary_edges]
    assert len(found) == len(wanted)
    for one, *rest in wanted:
        row = next(row for row in found if {tuple(row[0]), tuple(row[1])} == {one, rest[0]})
        if len(rest) > 1:
            assert np.allclose(row[2], rest[1], atol=1e-12)
