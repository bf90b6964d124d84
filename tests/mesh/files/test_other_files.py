"""VTK's files, with the groups of the program's own, and what arrives through meshio."""

from __future__ import annotations

import importlib.util
import pathlib
import sys

import numpy as np
import pytest

import magshell as ms
from magshell.errors import InputError

from .same import described

DATA = pathlib.Path(__file__).parent / "data"
needs_meshio = pytest.mark.skipif(importlib.util.find_spec("meshio") is None, reason="needs the extra magshell[meshio]")


def vtk_grid(points, cells, kind):
    """An unstructured grid of VTK."""
    import pyvista

    rows = np.insert(cells, 0, cells.shape[1], axis=1)
    return pyvista.UnstructuredGrid(rows.ravel(), np.full(len(cells), kind, dtype=np.uint8), np.asarray(points))


def as_texts(grid, name, texts):
    """Names as older versions wrote them."""
    from vtkmodules.vtkCommonCore import vtkStringArray

    array = vtkStringArray()
    array.SetName(name)
    for text in texts:
        array.InsertNextValue(text)
    grid.GetFieldData().AddArray(array)


@pytest.mark.parametrize("old", [False, True])
def test_a_step_file_of_the_program(tmp_path, old):
    """Its element groups come back, and that its lengths are in m."""
    from magshell.evaluation.outputs import OUTPUTS
    from magshell.output.vtu import _add_texts, vtu

    mesh = ms.mesh.rectangle(4e-3, 2e-3, (4, 2))
    grid = vtk_grid(mesh.points, mesh.elements, 23)
    grid.cell_data[OUTPUTS["element_group"].name] = np.array([1, 1, 2, 2, 1, 0, 0, 0])
    (as_texts if old else _add_texts)(grid, "element_group_names", ["Flügel", "rest"])
    (tmp_path / "step-0000.vtu").write_bytes(vtu(grid))
    found = ms.mesh.read(tmp_path / "step-0000.vtu")
    assert np.array_equal(found.points, mesh.points)
    assert np.array_equal(found.elements, mesh.elements)
    groups = {name: rows.tolist() for name, rows in found.element_groups.items()}
    assert groups == {"Flügel": [0, 1, 4], "rest": [2, 3]}
    assert found.origin.unit == "m"


@pytest.mark.parametrize(("suffix", "binary"), [(".vtu", True), (".vtk", False)])
def test_files_of_vtk(tmp_path, suffix, binary):
    mesh = ms.mesh.cylinder(3.0, 8.0, (6, 2))
    vtk_grid(mesh.points, mesh.elements, 23).save(tmp_path / f"tube{suffix}", binary=binary)
    found = ms.mesh.read(tmp_path / f"tube{suffix}", unit="cm")
    assert np.allclose(found.points, 0.01 * mesh.points, rtol=1e-7, atol=1e-9)
    assert np.array_equal(found.elements, mesh.elements)
    with pytest.raises(InputError, match=r"unit: is missing: tube"):
        ms.mesh.read(tmp_path / f"tube{suffix}")


def test_files_that_are_no_mesh(tmp_path):
    for name, content, message in (
        ("empty.msh", "", r"empty.msh: the file is empty"),
        ("empty.vtu", "", r"empty.vtu: "),
        ("empty.vtk", "", r"empty.vtk: "),
        ("empty.inp", "", r"empty.inp: has no \*NODE block"),
        ("cube.vtk", "# vtk DataFile Version 3.0\nx\nASCII\nDATASET STRUCTURED_POINTS\n", r"cube.vtk: "),
    ):
        (tmp_path / name).write_text(content)
        with pytest.raises(InputError, match=message):
            ms.mesh.read(tmp_path / name, unit="m")
    with pytest.raises(InputError, match=r"there is no such file. Did you mean 'empty.msh'"):
        ms.mesh.read(tmp_path / "emty.msh", unit="m")
    with pytest.raises(InputError, match=r"is a folder"):
        ms.mesh.read(tmp_path, unit="m")


def test_surfaces_that_are_not_read_are_refused(tmp_path):
    """In every format: without them the mesh would have holes."""
    points = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [2, 1, 0], [1, 1.5, 0], [0, 1, 0.0]])
    vtk_grid(points[[0, 1, 3, 4, 5]], np.array([[0, 1, 2, 3, 4]]), 7).save(tmp_path / "five.vtu")
    with pytest.raises(InputError, match=r"five.vtu: .*cannot be used: 1 of type 7 \(vtkPolygon\) with 5 nodes.*holes"):
        ms.mesh.read(tmp_path / "five.vtu", unit="m")
    vtk_grid(points, np.array([[0, 1, 2, 3, 4, 5]]), 6).save(tmp_path / "strip.vtk")
    with pytest.raises(InputError, match=r"strip.vtk: .*1 of type 6 \(vtkTriangleStrip\) with 6 nodes"):
        ms.mesh.read(tmp_path / "strip.vtk", unit="m")


@pytest.mark.parametrize(
    ("kind", "count", "called"),
    [
        (69, 10, "vtkLagrangeTriangle"),
        (70, 16, "vtkLagrangeQuadrilateral"),
        (70, 8, "vtkLagrangeQuadrilateral"),
        (76, 6, "vtkBezierTriangle"),
        (77, 9, "vtkBezierQuadrilateral"),
    ],
)
def test_other_orders_and_bezier_cells_are_refused(tmp_path, kind, count, called):
    points = np.random.default_rng(1).random((count, 3))
    vtk_grid(points, np.arange(count)[None], kind).save(tmp_path / "cell.vtu")
    with pytest.raises(InputError, match=rf"cell.vtu: .*1 of type {kind} \({called}\) with {count} nodes"):
        ms.mesh.read(tmp_path / "cell.vtu", unit="m")


@pytest.mark.parametrize(("name", "triangles", "quads"), [("strip_69", 32, 0), ("strip_70", 0, 16)])
def test_lagrange_cells(name, triangles, quads):
    """A strip 20 × 5, its nodes on straight lines."""
    mesh = ms.mesh.read(DATA / f"{name}.vtu", unit="mm")
    assert (mesh.triangles.sum(), (~mesh.triangles).sum()) == (triangles, quads)
    assert np.allclose(np.ptp(mesh.points, axis=0), (20e-3, 5e-3, 0))
    if triangles:
        assert len(mesh.points) == 85
    area = 0.5 * np.linalg.norm(
        np.cross(*(mesh.points[mesh.elements[:, [2, 3]]] - mesh.points[mesh.elements[:, [0, 1]]]).transpose(1, 0, 2)),
        axis=1,
    )
    assert np.isclose(area.sum(), 100e-6)


@pytest.mark.parametrize("suffix", [".vtp", ".vtk"])
def test_polygons_of_vtk(tmp_path, suffix):
    """As VTK and PyVista write surfaces: triangles and quadrilaterals in one file."""
    import pyvista

    points = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [1, 1, 0.0]])
    pyvista.PolyData(points, faces=[4, 0, 1, 4, 3, 3, 1, 2, 4]).save(tmp_path / f"part{suffix}")
    mesh = ms.mesh.read(tmp_path / f"part{suffix}", unit="mm", second_order=True)
    assert mesh.triangles.tolist() == [False, True]
    assert np.allclose(mesh.points[mesh.elements[0, :4]], 1e-3 * points[[0, 1, 4, 3]])


def test_solids_of_vtk_are_refused(tmp_path):
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
    vtk_grid(points, np.array([[0, 1, 2, 3]]), 10).save(tmp_path / "solid.vtu")
    with pytest.raises(InputError, match=r"solid.vtu: has 1 solid elements.*mid-surface"):
        ms.mesh.read(tmp_path / "solid.vtu", unit="m")


def test_without_meshio(tmp_path, monkeypatch):
    (tmp_path / "part.off").write_bytes(b"x")
    monkeypatch.setitem(sys.modules, "meshio", None)
    with pytest.raises(InputError, match=r"part.off: a file '.off' is read through meshio.*magshell\[meshio\]"):
        ms.mesh.read(tmp_path / "part.off", unit="m")


@needs_meshio
@pytest.mark.parametrize("suffix", [".bdf", ".mesh"])
def test_formats_of_meshio(tmp_path, suffix):
    """First-order quadrilaterals of a plate, written by meshio itself, in two of its formats."""
    import meshio

    x, y = np.meshgrid(np.arange(4.0), np.arange(3.0))
    points = np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1)
    low = (np.arange(3)[None] + 4 * np.arange(2)[:, None]).ravel()
    quads = np.stack([low, low + 1, low + 5, low + 4], axis=1)
    meshio.Mesh(points, [("quad", quads)]).write(tmp_path / f"plate{suffix}")
    mesh = ms.mesh.read(tmp_path / f"plate{suffix}", unit="mm", second_order=True)
    assert len(mesh.elements) == 6
    assert np.allclose(mesh.points[:12], 1e-3 * points, atol=1e-12)


@needs_meshio
def test_sets_of_meshio_become_groups():
    import meshio

    from magshell.mesh.files.assembling import assemble
    from magshell.mesh.files.other import contents_of_meshio

    plate = ms.mesh.rectangle(3.0, 1.0, (3, 1))
    lines = plate.edge_groups["left"]
    cells = [("line3", lines), ("quad8", plate.elements[:2]), ("quad8", plate.elements[2:])]
    sets = {"arm": [None, np.array([1]), np.array([0])], "rim": [np.array([0]), None, None]}
    mesh = meshio.Mesh(plate.points, cells, point_sets={"tip": np.array([3])}, cell_sets=sets)
    found = assemble(contents_of_meshio(mesh, "plate"), "plate", "m", second_order=False)
    assert {name: rows.tolist() for name, rows in found.element_groups.items()} == {"arm": [1, 2]}
    assert described(found)["edge groups"] == {"rim": described(plate)["edge groups"]["left"]}
    assert found.node_groups["tip"].tolist() == [3]


@needs_meshio
def test_what_meshio_does_not_read(tmp_path):
    (tmp_path / "part.xyz").write_bytes(b"x")
    with pytest.raises(InputError, match=r"part.xyz: files '.xyz' are not known. Known are: .*\.msh"):
        ms.mesh.read(tmp_path / "part.xyz", unit="m")
    (tmp_path / "part.off").write_bytes(b"OFF\nx\n")
    with pytest.raises(InputError, match=r"part.off: meshio cannot read it"):
        ms.mesh.read(tmp_path / "part.off", unit="m")


@needs_meshio
def test_the_list_of_formats_is_what_can_be_read(tmp_path):
    """Not what meshio only writes, such as .svg, nor what it reads by a package that is not there."""
    import meshio

    from magshell.mesh.files.reading import _READERS

    (tmp_path / "part.svg").write_text("<svg/>")
    with pytest.raises(InputError, match=r"files '.svg' are not known") as error:
        ms.mesh.read(tmp_path / "part.svg", unit="m")
    listed = str(error.value).rpartition("Known are: ")[2].split(", ")
    assert set(_READERS) - {".med"} <= set(listed)
    assert (".med" in listed) == (importlib.util.find_spec("h5py") is not None)
    assert {".stl", ".obj", ".ply", ".off", ".mesh"} <= set(listed)
    for ending in set(listed) - set(_READERS):
        assert set(meshio.extension_to_filetypes[ending]) <= set(meshio._helpers.reader_map), ending
    if importlib.util.find_spec("netCDF4") is None:
        assert ".exo" not in listed
        (tmp_path / "part.exo").write_bytes(b"")
        with pytest.raises(InputError, match=r"part.exo: meshio needs netCDF4 to read it.*pip install netCDF4"):
            ms.mesh.read(tmp_path / "part.exo", unit="m")


@needs_meshio
def test_a_file_in_which_meshio_finds_no_end(tmp_path, monkeypatch):
    monkeypatch.setattr("magshell.mesh.files.reading.SECONDS", 2)
    (tmp_path / "part.node").write_bytes(b"")
    with pytest.raises(InputError, match=r"^part.node: meshio does not finish reading it"):
        ms.mesh.read(tmp_path / "part.node", unit="m")


@needs_meshio
def test_several_zones_are_refused(tmp_path):
    """meshio drops all but one."""
    zone = "ZONE N=3, E=1, DATAPACKING=POINT, ZONETYPE=FETRIANGLE\n0 0 0\n1 0 0\n0 1 0\n1 2 3\n"
    head = 'VARIABLES = "X" "Y" "Z"\n'
    (tmp_path / "one.tec").write_text(head + zone)
    assert len(ms.mesh.read(tmp_path / "one.tec", unit="m", second_order=True).elements) == 1
    (tmp_path / "two.tec").write_text(head + zone + zone)
    with pytest.raises(InputError, match=r"two.tec: has 2 zones, of which meshio reads one"):
        ms.mesh.read(tmp_path / "two.tec", unit="m", second_order=True)


@needs_meshio
@pytest.mark.parametrize(("suffix", "read"), [(".obj", "f 1 2 3 4 5"), (".ply", "5 0 1 2 3 4")])
def test_polygons_of_five_corners_are_refused(tmp_path, suffix, read):
    points = ["0 0 0", "1 0 0", "2 1 0", "1 2 0", "0 1 0"]
    ply = "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
    ply += "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    lines = [f"v {point}" for point in points] if suffix == ".obj" else [ply + points[0], *points[1:]]
    (tmp_path / f"five{suffix}").write_text("\n".join([*lines, read, ""]))
    with pytest.raises(InputError, match=r"cannot be used: 1 of type polygon"):
        ms.mesh.read(tmp_path / f"five{suffix}", unit="m", second_order=True)
