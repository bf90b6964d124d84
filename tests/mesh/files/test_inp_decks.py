"""Input files of other programs: what must be read of each."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import magshell as ms
from magshell.errors import InputError

DECKS = Path(__file__).parent / "data" / "inp"
TIP = [-1.347e-3, 0.0, 6.541e-3]
"""Of the strip 20 × 5 × 1 mm at 2 mT."""


def read(name):
    return ms.mesh.read(DECKS / name, "mm")


def sizes(groups):
    return {name: len(members) for name, members in groups.items()}


def tip_of(folder, deck, group):
    """Displacement of the tip of the strip that is clamped at a group."""
    text = (DECKS / "strip.toml").read_text(encoding="utf-8")
    assert 'file = "job.inp"' in text
    assert 'group = "Set-1-nodes"' in text
    text = text.replace("job.inp", deck.name).replace("Set-1-nodes", group)
    (folder / "strip.toml").write_text(text, encoding="utf-8")
    (folder / deck.name).write_bytes(deck.read_bytes())
    problem = ms.problem.load(folder / "strip.toml")
    return ms.solve(problem.model, problem.settings).probe("tip").u[-1]


def test_a_set_of_the_assembly_is_not_one_of_the_part(tmp_path):
    mesh = read("job.inp")
    assert sizes(mesh.element_groups) == {"Part-1-1.Set-1": 16, "Set-1": 2}
    assert sizes(mesh.node_groups) == {"Part-1-1.Set-1-nodes": 69, "Set-1-nodes": 5, "Set-2": 5}
    assert (mesh.points[mesh.node_groups["Set-1-nodes"], 0] == 0.0).all()
    assert tip_of(tmp_path, DECKS / "job.inp", "Set-1-nodes") == pytest.approx(TIP, abs=5e-7)


def test_a_reference_point_has_a_number_of_its_own():
    mesh = read("job_rp.inp")
    assert (len(mesh.elements), len(mesh.points), mesh.triangles.any()) == (16, 69, False)
    assert len(mesh.node_groups["Fixed"]) == 5
    assert (mesh.points[mesh.node_groups["Fixed"], 0] == 0.0).all()
    assert sorted(mesh.points[mesh.edge_groups["TipEdge"], 0].ravel()) == pytest.approx(6 * [20e-3])
    assert "constraints are not read: *COUPLING (line 125)" in mesh.origin.changes


@pytest.mark.parametrize(
    ("name", "size", "spans"),
    [
        ("node_cylindrical.inp", [10, 10, 5], [(0, 10), (0, 10), (0, 5)]),
        ("system_offset.inp", [5, 20, 0], [(95, 100), (0, 20), (0, 0)]),
    ],
)
def test_coordinate_systems(name, size, spans):
    mesh = read(name)
    assert 1e3 * np.ptp(mesh.points, axis=0) == pytest.approx(size, abs=1e-9)
    for axis, (least, greatest) in enumerate(spans):
        column = 1e3 * mesh.points[:, axis]
        assert (column.min(), column.max()) == pytest.approx((least, greatest), abs=1e-9)
    if "cylindrical" in name:
        assert 1e3 * np.hypot(*mesh.points[:, :2].T) == pytest.approx(np.full(69, 10.0))


@pytest.mark.parametrize("name", ["strip_s6.inp", "freecad_like.inp"])
def test_six_node_shells(name, tmp_path):
    mesh = read(name)
    assert (mesh.triangles.sum(), len(mesh.elements), len(mesh.points)) == (32, 32, 85)
    if name.startswith("free"):
        assert sizes(mesh.element_groups) == {"Efaces": 32, "Eall": 32, "MaterialSheet": 32}
    assert 1e3 * tip_of(tmp_path, DECKS / name, "root")[2] == pytest.approx(6.541, abs=1e-3)


@pytest.mark.parametrize("type_name", ["S6", "STRI65"])
def test_no_holes_among_quadrilaterals(type_name, tmp_path):
    text = (DECKS / "quad_dominant.inp").read_text(encoding="utf-8")
    (tmp_path / "mixed.inp").write_text(text.replace("TYPE=S6", f"TYPE={type_name}"), encoding="utf-8")
    mesh = ms.mesh.read(tmp_path / "mixed.inp", "mm")
    assert (len(mesh.elements), mesh.triangles.sum(), len(mesh.points)) == (18, 4, 71)
    assert len(mesh.element_groups["sheet"]) == 18
    assert tip_of(tmp_path, tmp_path / "mixed.inp", "root") == pytest.approx(TIP, abs=1e-6)


@pytest.mark.parametrize("type_name", ["S12", "US3", "SAX2", "CAX6", "CPEG6", "U1", "DC2D6", "S_6"])
def test_types_that_are_not_read_are_listed(type_name, tmp_path):
    """Shells of other programs, axisymmetric and user elements: left out, they would leave holes."""
    text = (DECKS / "quad_dominant.inp").read_text(encoding="utf-8")
    text = (
        text.replace("TYPE=S6", f"type={type_name.lower()}") + "*ELEMENT, TYPE=QU8\n300, 1, 3, 29, 27, 2, 19, 28, 18\n"
    )
    (tmp_path / "holes.inp").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=rf"holes.inp: .*4 of type {type_name}, 1 of type QU8"):
        ms.mesh.read(tmp_path / "holes.inp", "mm")


@pytest.mark.parametrize(("name", "count"), [("gmsh_q8.inp", 104), ("gmsh_t6.inp", 212)])
def test_lines_from_gmsh(name, count):
    """T3D3: end, middle, end."""
    mesh = read(name)
    assert len(mesh.elements) == count
    assert not [change for change in mesh.origin.changes if "left out" in change]
    edges = sizes(mesh.edge_groups)
    assert [edges[group] for group in ("clamped_edge", "Außenrand", "hinge_line")] == [4, 44, 4]
    for group in ("clamped_edge", "Außenrand", "hinge_line"):
        on_edges = np.unique(mesh.edge_groups[group])
        assert on_edges.tolist() == sorted(mesh.node_groups[f"{group}-nodes"].tolist())
        ends = mesh.points[mesh.edge_groups[group]]
        assert ends[:, 2] == pytest.approx((ends[:, 0] + ends[:, 1]) / 2)


def test_labels():
    """Capitals do not count, blanks and quotation marks may stand in a label, a set of elements has nodes."""
    mesh = read("caps.inp")
    assert sizes(mesh.element_groups) == {"Sheet": 16}
    assert sizes(mesh.node_groups) == {"NALL": 69, "Root": 5, "tip edge": 5, "copy of root": 5, "ELS": 69}
    assert mesh.node_groups["copy of root"].tolist() == mesh.node_groups["Root"].tolist()


def test_sets_of_springs_and_masses():
    mesh = read("strip_spring.inp")
    assert sizes(mesh.element_groups) == {"sheet": 16, "everything": 16}
    assert set(mesh.origin.changes) == {
        "1 elements of type SPRING1 left out",
        "1 elements of type MASS left out",
        "group 'ground' left out, as it holds only elements that are left out",
        "group 'tipmass' left out, as it holds only elements that are left out",
    }


def test_masses_with_a_comma_behind_each(tmp_path):
    text = (DECKS / "strip_spring.inp").read_text(encoding="utf-8")
    text += "*ELEMENT, TYPE=MASS, ELSET=masses\n903, 17,\n904, 26,\n*NSET, NSET=heavy, ELSET=masses\n"
    (tmp_path / "masses.inp").write_text(text, encoding="utf-8")
    mesh = ms.mesh.read(tmp_path / "masses.inp", "mm")
    assert mesh.node_groups["heavy"].tolist() == [16, 25]
    assert "3 elements of type MASS left out" in mesh.origin.changes


def test_solids_are_counted_by_element(tmp_path):
    text = "*NODE\n1, 0\n*ELEMENT, TYPE=C3D10, ELSET=a\n1, 1, 1, 1, 1, 1, 1, 1,\n1, 1, 1\n2, 1,1,1,1,1,1,1,1,1,1\n"
    (tmp_path / "solid.inp").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=r"solid.inp: has 2 solid elements"):
        ms.mesh.read(tmp_path / "solid.inp", "mm")


def test_the_command_lists_the_groups(capsys):
    from magshell.cli import main

    assert main(["mesh", str(DECKS / "job.inp"), "--unit", "mm"]) == 0
    said = capsys.readouterr().out
    assert re.search(r"Set-1-nodes \(5 nodes\)", said), said
    assert re.search(r"Part-1-1\.Set-1 \(16 elements\)", said), said
