"""A mesh file damaged at random is refused, with its name and mostly its line, or still a mesh; nothing else."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import magshell as ms
from faults.damage import damaged
from faults.limits import bounded, located, share
from magshell.errors import InputError
from magshell.mesh import Mesh, read
from magshell.mesh.files.scripts import put_alone

DATA = Path(__file__).parent.parent / "mesh" / "files" / "data"
PLATE = ms.mesh.rectangle(20e-3, 5e-3, (4, 1))


def inp(mesh: Mesh) -> bytes:
    """Abaqus' input file of a mesh, with sets of every kind."""
    lines = ["*Heading", "** a comment", "*Node, nset=all"]
    lines += [f"{number}, {', '.join(map(repr, point))}" for number, point in enumerate(mesh.points.tolist(), 1)]
    lines += ["*Element, type=S8R, elset=plate"]
    lines += [f"{number}, {', '.join(str(node + 1) for node in row)}" for number, row in enumerate(mesh.elements, 1)]
    lines += ["*Nset, nset=ends, generate", "1, 5, 2", "*Elset, elset=half", "1, 2", "plate", '*Nset, nset="ä b"', "1,"]
    return "\n".join([*lines, ""]).encode()


def vtk(mesh: Mesh, suffix: str, text: bool) -> bytes:
    """VTK's file of a mesh."""
    import tempfile

    import vtkmodules.all as vtk_all
    from pyvista import UnstructuredGrid

    count = len(mesh.elements)
    cells = np.column_stack([np.full(count, 8), mesh.elements]).ravel()
    grid = UnstructuredGrid(cells, np.full(count, 23, np.uint8), mesh.points)
    writer = vtk_all.vtkXMLUnstructuredGridWriter() if suffix == ".vtu" else vtk_all.vtkUnstructuredGridWriter()
    if suffix == ".vtu" and text:
        writer.SetDataModeToAscii()
    if suffix == ".vtk" and not text:
        writer.SetFileTypeToBinary()
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, f"part{suffix}")
        writer.SetFileName(str(file))
        writer.SetInputData(grid)
        writer.Write()
        return file.read_bytes()


def nastran(mesh: Mesh) -> bytes:
    """Nastran's bulk data in free and small fields, in a system of coordinates of its own."""
    lines = ["BEGIN BULK", "CORD2C,3,,0.,0.,0.,0.,0.,1.", ",1.,0.,0."]
    lines += [f"GRID,{number},3,{x!r},{1e3 * y!r},{z!r}" for number, (x, y, z) in enumerate(mesh.points.tolist(), 1)]
    for number, row in enumerate((mesh.elements + 1).tolist(), 1):
        lines += ["".join(f"{text:<8}" for text in ("CQUAD8", number, 1 + number // 2, *row[:6], "+"))]
        lines += ["".join(f"{text:<8}" for text in ("+", *row[6:]))]
    return "\n".join([*lines, "ENDDATA", ""]).encode()


def written(mesh: Mesh, file: Path) -> bytes:
    ms.mesh.write(mesh, file, "mm")
    return file.read_bytes()


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("meshes")


def refused_or_a_mesh(content: bytes, file: Path) -> None:
    file.write_bytes(content)
    with bounded(), warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            mesh = read(file, None if b"lengths in" in content else "mm", second_order=True)
        except InputError as error:
            if not str(error).startswith("unit: "):
                located(error, file.name)
            return
    assert np.isfinite(mesh.points).all()
    assert mesh.elements.max() < len(mesh.points)
    for groups in (mesh.element_groups, mesh.edge_groups, mesh.node_groups):
        assert all(name.isprintable() and len(members) for name, members in groups.items()), list(groups)


@pytest.fixture(autouse=True)
def own_readers_and_little_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """Text that becomes another version is a fault here, not a file for gmsh; other programs are soon ended."""
    monkeypatch.setattr("magshell.mesh.files.session.installed", lambda: False)
    monkeypatch.setattr("magshell.mesh.files.reading.SECONDS", 15)


@share(0.07)
@given(content=damaged((DATA / "two-plates-41.msh").read_bytes()))
def test_msh_4(content: bytes, folder: Path) -> None:
    refused_or_a_mesh(content, folder / "part.msh")


@share(0.07)
@given(content=damaged((DATA / "two-plates-22.msh").read_bytes()))
def test_msh_2(content: bytes, folder: Path) -> None:
    refused_or_a_mesh(content, folder / "part.msh")


@share(0.07)
@given(content=damaged(inp(PLATE)))
def test_inp(content: bytes, folder: Path) -> None:
    refused_or_a_mesh(content, folder / "part.inp")


@share(0.07)
@given(content=damaged(nastran(ms.mesh.rectangle(20.0, 5.0, (4, 1)))))
def test_nastran(content: bytes, folder: Path) -> None:
    refused_or_a_mesh(content, folder / "part.bdf")


@share(0.07)
@given(content=damaged((DATA / "gmsh_q8.unv").read_bytes()))
def test_unv(content: bytes, folder: Path) -> None:
    refused_or_a_mesh(content, folder / "part.unv")


@share(0.005)
@given(content=damaged((DATA / "two-plates.med").read_bytes()))
def test_med(content: bytes, folder: Path) -> None:
    """Read in another process, which HDF5 may crash."""
    pytest.importorskip("h5py")
    refused_or_a_mesh(content, folder / "part.med")


@share(0.005)
@given(content=damaged((DATA / "strip_70.vtu").read_bytes()))
def test_lagrange_cells(content: bytes, folder: Path) -> None:
    refused_or_a_mesh(content, folder / "strip.vtu")


@pytest.mark.parametrize("suffix", [".stl", ".ply", ".obj"])
def test_skins(suffix: str, folder: Path) -> None:
    """Through meshio, in another process: a closed box stays refused, or is damaged so that it is another surface."""
    meshio = pytest.importorskip("meshio")
    points = np.array([[x, y, z] for x in (0.0, 4.0) for y in (0.0, 2.0) for z in (0.0, 1.0)])
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = np.array([each for a, b, c, d in sides for each in ((a, b, c), (a, c, d))])
    meshio.Mesh(points, [("triangle", triangles)]).write(folder / f"box{suffix}")
    whole = (folder / f"box{suffix}").read_bytes()
    with pytest.raises(InputError, match="is the skin of a solid"):
        read(folder / f"box{suffix}", "mm", second_order=True)

    @share(0.005)
    @given(content=damaged(whole))
    def check(content: bytes) -> None:
        refused_or_a_mesh(content, folder / f"part{suffix}")

    check()


@pytest.mark.parametrize("text", [True, False], ids=["text", "binary"])
@pytest.mark.parametrize("suffix", [".vtu", ".vtk"])
def test_vtk(suffix: str, text: bool, folder: Path) -> None:
    """Read in another process, which VTK may crash."""
    whole = vtk(PLATE, suffix, text)
    (folder / f"part{suffix}").write_bytes(whole)
    assert len(read(folder / f"part{suffix}", "mm").elements) == 4

    @share(0.002)
    @given(content=damaged(whole))
    def check(content: bytes) -> None:
        refused_or_a_mesh(content, folder / f"part{suffix}")

    check()


def test_vtk_without_end(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """VTK counts the components of a point, up to any number that the file says."""
    monkeypatch.setattr("magshell.mesh.files.reading.SECONDS", 1)
    whole, count = vtk(PLATE, ".vtu", True), b'NumberOfComponents="3"'
    assert count in whole
    (folder / "endless.vtu").write_bytes(whole.replace(count, b'NumberOfComponents="9223372036854775807"'))
    with pytest.raises(InputError, match=r"^endless.vtu: VTK does not finish reading it"):
        read(folder / "endless.vtu", "mm")


@share(0.005)
@given(content=damaged((DATA / "two-plates-binary.msh").read_bytes()))
def test_msh_through_gmsh(content: bytes, folder: Path) -> None:
    """Read in another process, which gmsh may crash."""
    pytest.importorskip("gmsh")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("magshell.mesh.files.session.installed", lambda: True)
        refused_or_a_mesh(content, folder / "binary.msh")


@share(0.02)
@given(content=st.binary(max_size=400), suffix=st.sampled_from([".msh", ".inp", ".unv", ".bdf"]))
def test_anything(content: bytes, suffix: str, folder: Path) -> None:
    refused_or_a_mesh(content, folder / f"any{suffix}")


@pytest.mark.parametrize(
    ("name", "old", "new", "words"),
    [
        ("part.msh", b"\n", b"\r\n", ""),
        ("part.msh", b'"both"', '"Blütenblatt №3 „links“"'.encode(), ""),
        ("part.msh", b'"both"', b'"with \\"quotes\\" in it"', ""),
        ("part.msh", b'"both"', b'"caf\xe9"', ""),
        ("part.msh", b'"both"', b'"' + 5000 * b"n" + b'"', ""),
        ("part.msh", b"\n27 ", b"\n99999999999999 ", ""),
        ("part.inp", b"*Element", b"*ELEMENT", ""),
        ("part.inp", b"\n", b"\r\n", ""),
        ("part.inp", b"1, 5, 2", b"1, 999999999999, 1", "first, last and increment"),
        ("part.inp", b"1, 5, 2", b"1, 999999, 1", ""),
        ("part.inp", b"1, 5, 2", b"1, 99999999, 1", "first, last and increment"),
        ("part.inp", b"1, 2\nplate", b"half, no", "no set 'no' above"),
        ("part.inp", b"0.02,", b"nan,", "part.inp, line "),
        ("part.inp", b"0.02,", b"1e200,", "coordinates must be finite"),
    ],
)
def test_what_may_stand_in_a_file(name: str, old: bytes, new: bytes, words: str, folder: Path) -> None:
    content = inp(PLATE) if name.endswith("inp") else (DATA / "two-plates-22.msh").read_bytes()
    assert old in content
    refused_or_a_mesh(content.replace(old, new), folder / name)
    if words:
        with pytest.raises(InputError, match=words):
            read(folder / name, "mm", second_order=True)


@pytest.mark.parametrize("suffix", [".msh", ".inp", ".unv", ".bdf", ".vtu", ".vtp", ".vtk", ".txt", ""])
def test_empty(suffix: str, folder: Path) -> None:
    (folder / f"empty{suffix}").touch()
    with pytest.raises(InputError) as error:
        read(folder / f"empty{suffix}", "mm")
    located(error.value, f"empty{suffix}")


@share(0.1)
@given(content=damaged((DATA / "two-plates.geo").read_bytes()) | st.binary(max_size=300))
def test_scripts(content: bytes, tmp_path_factory: pytest.TempPathFactory) -> None:
    """Before gmsh sees one it is understood, or refused."""
    folder = tmp_path_factory.mktemp("script")
    (folder / "part.geo").write_bytes(content)
    (folder / "alone").mkdir()
    try:
        copy = put_alone(folder / "part.geo", folder / "alone")
    except InputError as error:
        located(error, "part.geo")
    else:
        assert copy.parent.parent == folder / "alone"
