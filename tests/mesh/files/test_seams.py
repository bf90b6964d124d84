"""Nodes of files that lie on each other: welded, kept apart along cuts, or refused with both ways out."""

from __future__ import annotations

import dataclasses
import importlib.util

import numpy as np
import pytest

import magshell as ms
from magshell.cli import main
from magshell.errors import InputError, MeshError
from magshell.mesh import cut
from magshell.mesh.edges import find_edges

from .same import described

needs_gmsh = pytest.mark.skipif(importlib.util.find_spec("gmsh") is None, reason="needs the extra magshell[gmsh]")


def slit_sheet():
    """A sheet of 4 × 2 mm with a slit in the middle, opened."""
    mesh = ms.mesh.rectangle(4e-3, 2e-3, (4, 2))
    rows = find_edges(mesh.elements).real
    x, y = np.moveaxis(mesh.points[rows][..., :2], -1, 0)
    slit = rows[((abs(y - 1e-3) < 1e-9) & (x > 0.9e-3) & (x < 3.1e-3)).all(axis=1)]
    return cut(dataclasses.replace(mesh, edge_groups={**mesh.edge_groups, "slit": slit}), "slit")


def open_tube():
    """A tube whose seam is not joined."""
    sheet = ms.mesh.rectangle(2e-3 * np.pi, 1e-3, (8, 2))
    turn = 1e3 * sheet.points[:, 0]
    points = np.stack([1e-3 * np.cos(turn), 1e-3 * np.sin(turn), sheet.points[:, 1]], axis=1)
    return points, sheet


@pytest.fixture
def slit(tmp_path):
    file = tmp_path / "slit.msh"
    ms.mesh.write(slit_sheet(), file, "mm")
    return file


@pytest.fixture
def tube(tmp_path):
    """Written as a sheet, whose nodes are then put around."""
    points, sheet = open_tube()
    file = tmp_path / "tube.msh"
    ms.mesh.write(sheet, file, "mm")
    lines = file.read_text().split("\n")
    first = lines.index("$Nodes") + 3 + len(points)
    lines[first : first + len(points)] = [" ".join(map(repr, (1e3 * point).tolist())) for point in points]
    file.write_text("\n".join(lines))
    return file


def test_both_ways_out_are_offered(slit, tube):
    with pytest.raises(MeshError) as caught:
        ms.mesh.read(slit)
    message = " ".join(str(caught.value).split())
    for phrase in (
        "slit.msh: Elements",
        "both at (0.0015, 0.001, 0) m",
        "3 such places",
        'weld = "9e-06 mm"',
        "--weld",
    ):
        assert phrase in message, message
    assert 'cuts = ["slit"] keeps them apart (--cut "slit")' in message
    with pytest.raises(MeshError, match=r'cuts = \["right", "left"\] keeps them apart \(--cut "right" --cut "left"\)'):
        ms.mesh.read(tube)


def test_a_cut_that_is_named_is_kept(slit):
    mesh = ms.mesh.read(slit, cuts=["slit"])
    assert described(mesh) == described(slit_sheet())
    assert mesh.cuts == ("slit",)
    assert not mesh.origin.changes


def test_the_weld_that_the_message_offers_closes_the_slit(slit):
    mesh = ms.mesh.read(slit, weld=9e-9)
    assert len(mesh.points) == len(slit_sheet().points) - 3
    assert len(mesh.edge_groups["slit"]) == 2
    assert mesh.origin.changes == ("3 nodes welded to others, within 9e-06 mm",)
    opened = cut(mesh, "slit")
    assert described(opened)["elements"] == described(slit_sheet())["elements"]


def test_a_cut_is_not_welded(slit):
    mesh = ms.mesh.read(slit, weld=1e-6, cuts="slit")
    assert len(mesh.points) == len(slit_sheet().points)
    assert mesh.origin.changes == ("nothing welded: there are no two nodes within 0.001 mm",)


def test_a_tube_with_an_open_seam(tube):
    mesh = ms.mesh.read(tube, weld=1e-8)
    assert described(mesh)["elements"] == described(ms.mesh.cylinder(1e-3, 1e-3, (8, 2)))["elements"]
    assert len(mesh.boundary_edges) == 16
    assert len(mesh.edge_groups["left"]) == 2


def test_a_closed_line_in_a_file_is_cut_open(tmp_path):
    closed = dataclasses.replace(ms.mesh.read(_written(tmp_path), weld=9e-9), cuts=())
    ms.mesh.write(closed, tmp_path / "closed.msh", "mm")
    mesh = ms.mesh.read(tmp_path / "closed.msh", cuts=["slit"])
    assert mesh.origin.changes == ("cut open along slit: 3 nodes doubled",)
    assert described(mesh)["elements"] == described(slit_sheet())["elements"]


def _written(folder):
    file = folder / "slit.msh"
    ms.mesh.write(slit_sheet(), file, "mm")
    return file


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"weld": 0.7e-3}, r"weld: 0.7 mm merges nodes of one element, at \(.*\) mm; it must be smaller"),
        ({"weld": 0.0}, r"weld: 0.0 is not allowed; it must be a positive length"),
        ({"weld": np.nan}, "weld: nan is not allowed"),
        ({"cuts": ["slot"]}, "cuts: there is no edge group 'slot'. Did you mean 'slit'"),
        ({"cuts": ["slit", "left"]}, "Cut 'left', from .*: no nodes lie on each other there, as its edges are free"),
    ],
)
def test_what_makes_no_sense(slit, given, message):
    with pytest.raises(InputError, match=message):
        ms.mesh.read(slit, **given)


PROBLEM = """
[mesh]
file = "slit.msh"
{more}

[mesh.element_groups.all]
x3 = ["-1 mm", "1 mm"]

[shell]
thickness = "0.1 mm"

[material]
law = "micropolar-neo-hookean"
shear_modulus = "100 kPa"
lame_lambda = "2 MPa"

[[supports]]
kind = "clamp"
group = "left"

[[loads]]
kind = "pressure"
group = "all"
pressure = "1 Pa"
"""


def test_from_the_command_line_and_in_a_problem(slit, monkeypatch, capsys):
    monkeypatch.chdir(slit.parent)

    def said(*command, status=0):
        assert main(command) == status
        out = capsys.readouterr()
        return " ".join((out.out + out.err).split())

    assert 'cuts = ["slit"]' in said("mesh", "slit.msh", status=2)
    assert 'file = "o.msh", cuts = ["slit"]' in said("mesh", "slit.msh", "--cut", "slit", "--out", "o.msh")
    assert "3 nodes welded" in said("mesh", "slit.msh", "--weld", "1 um")
    assert "--weld: '1 T'" in said("mesh", "slit.msh", "--weld", "1 T", status=2)
    case = slit.parent / "case.toml"
    for more, status, phrase in (
        ("", 2, "mesh.file: slit.msh: Elements"),
        ('cuts = "slit"', 0, "cuts slit (8 nodes)"),
        ('weld = "1 um"', 0, "3 nodes welded to others"),
        ('cuts = ["slot"]', 2, "mesh.cuts: there is no edge group 'slot'"),
        ('weld = "0.6 mm"', 2, "mesh.weld: 0.6 mm merges"),
        ('weld = "0 mm"', 2, "mesh.weld"),
    ):
        case.write_text(PROBLEM.format(more=more))
        assert phrase in said("check", "case.toml", status=status), more


GEO = """
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 20, 10};
Point(11) = {5, 5, 0};
Point(12) = {15, 5, 0};
Line(20) = {11, 12};
BooleanFragments{ Surface{1}; Delete; }{ Curve{20}; Delete; }
Physical Surface("sheet") = {1};
Physical Curve("slit") = {20};
"""


@needs_gmsh
def test_a_line_in_a_geometry_is_cut_open(tmp_path, monkeypatch, capsys):
    """And the copy in a results folder, which holds the mesh, has the cut."""
    from magshell.problem import load
    from magshell.problem.copies import alone

    (tmp_path / "sheet.geo").write_text(GEO)
    monkeypatch.chdir(tmp_path)
    assert main(["mesh", "sheet.geo", "--unit", "mm", "--size", "2 mm", "--cut", "slit", "--out", "slit.msh"]) == 0
    edges = len(ms.mesh.read(tmp_path / "slit.msh", cuts="slit").edge_groups["slit"]) // 2
    assert f"cut open along slit: {2 * edges - 1} nodes doubled" in " ".join(capsys.readouterr().out.split())
    more = 'unit = "mm"\nsize = "2 mm"\ncuts = ["slit"]\n[mesh.edge_groups.left]\nx1 = 0'
    (tmp_path / "case.toml").write_text(PROBLEM.format(more=more).replace("slit.msh", "sheet.geo"))
    problem = load("case.toml")
    text, copies = alone(problem)
    (tmp_path / "copy" / "inputs").mkdir(parents=True)
    (tmp_path / "copy" / "case.toml").write_text(text)
    for name, content in copies.items():
        (tmp_path / "copy" / name).write_bytes(content)
    again = load(tmp_path / "copy" / "case.toml").model.shell.mesh
    assert again.cuts == ("slit",)
    assert (again.elements == problem.model.shell.mesh.elements).all()


@needs_gmsh
def test_seams_are_for_meshes(tmp_path):
    from magshell.mesh.opening import Wishes, open_mesh

    (tmp_path / "sheet.geo").write_text(GEO)
    with pytest.raises(InputError, match="weld: is for meshes"):
        open_mesh(tmp_path / "sheet.geo", Wishes(unit="mm", weld=1e-6))
    with pytest.raises(InputError, match="cuts: there is no edge group 'slot'"):
        open_mesh(tmp_path / "sheet.geo", Wishes(unit="mm", size=5e-3, cuts=("slot",)))
