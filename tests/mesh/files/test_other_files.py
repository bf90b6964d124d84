"""VTK's files, with the groups of the program's own, and what arrives through meshio."""

from __future__ import annotations

import importlib.util
import sys

import numpy as np
import pytest

import magshell as ms
from magshell.errors import InputError

from .same import described

needs_meshio = pytest.mark.skipif(importlib.util.find_spec("meshio") is None, reason="needs the extra magshell[meshio]")


def vtk_grid(points, cells, kind):
    """An unstructured grid of VTK."""
    import pyvista

    rows = np.insert(cells, 0, cells.shape[1], axis=1)
    return pyvista.UnstructuredGrid(rows.ravel(), np.full(len(cells), kind, dtype=np.uint8), np.asarray(points))


def test_a_step_file_of_the_program(tmp_path):
    """Its element groups come back, and that its lengths are in m."""
    from magshell.output.registry import OUTPUTS
    from magshell.output.vtu import _add_texts, vtu

    mesh = ms.mesh.rectangle(4e-3, 2e-3, (4, 2))
    grid = vtk_grid(mesh.points, mesh.elements, 23)
    grid.cell_data[OUTPUTS["element_group"].name] = np.array([1, 1, 2, 2, 1, 0, 0, 0])
    _add_texts(grid, "element_group_names", ["Flügel", "rest"])
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


def test_solids_of_vtk_are_refused(tmp_path):
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
    vtk_grid(points, np.array([[0, 1, 2, 3]]), 10).save(tmp_path / "solid.vtu")
    with pytest.raises(InputError, match=r"solid.vtu: has 1 solid elements.*mid-surface"):
        ms.mesh.read(tmp_path / "solid.vtu", unit="m")


def test_without_meshio(tmp_path, monkeypatch):
    (tmp_path / "part.med").write_bytes(b"x")
    monkeypatch.setitem(sys.modules, "meshio", None)
    with pytest.raises(InputError, match=r"part.med: a file '.med' is read through meshio.*magshell\[meshio\]"):
        ms.mesh.read(tmp_path / "part.med", unit="m")


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
    with pytest.raises(InputError, match=r"part.xyz: files '.xyz' are not known. There is: .*\.msh"):
        ms.mesh.read(tmp_path / "part.xyz", unit="m")
    (tmp_path / "part.bdf").write_bytes(b"GRID,1,x\n")
    with pytest.raises(InputError, match=r"part.bdf: meshio cannot read it"):
        ms.mesh.read(tmp_path / "part.bdf", unit="m")
