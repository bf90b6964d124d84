"""Groups that a problem file names by where they lie: the same as those of the mesh itself."""

from __future__ import annotations

import pytest
from problem_files import STRIP, changed

import magshell as ms
from magshell.mesh import Mesh, in_cylinder, in_polygon, in_sphere
from magshell.problem.building import build
from magshell.problem.reading import check, parse

FAR = 'far = { x1 = "20 mm" }'
PLATE = ms.mesh.rectangle(20e-3, 5e-3, (4, 1))
CORNERS = [(0.0, 0.0), (11e-3, 0.0), (11e-3, 5e-3), (0.0, 5e-3)]


def mesh_of(table: str, kind: str) -> Mesh:
    """That of the strip with a group `far` of another kind."""
    text = changed(STRIP, ("[mesh.edge_groups]", f"[mesh.{kind}]"), (FAR, f"far = {table}"))
    return build(check(parse(text, "strip.toml"), "strip.toml"), "strip.toml").model.shell.mesh


@pytest.mark.parametrize("kind", ["node_groups", "edge_groups"])
@pytest.mark.parametrize(
    ("table", "given"),
    [
        ('{ x1 = ["10 mm", "20 mm"] }', {"x1": (10e-3, 20e-3)}),
        ('{ x1 = ["10 mm", "20 mm"], x2 = 0, x3 = 0 }', {"x1": (10e-3, 20e-3), "x2": 0.0, "x3": 0.0}),
        ('{ sphere = { radius = "5 mm" } }', {"within": in_sphere((0, 0, 0), 5e-3)}),
        (
            '{ cylinder = { through = ["20 mm", 0, 0], axis = [0, 0, 2], radius = ["0 mm", "6 mm"] } }',
            {"within": in_cylinder((20e-3, 0, 0), (0, 0, 1), (0.0, 6e-3))},
        ),
        (
            '{ polygon = [[0, 0], ["11 mm", 0], ["11 mm", "5 mm"], [0, "5 mm"]], x2 = 0 }',
            {"within": in_polygon(CORNERS), "x2": 0.0},
        ),
        ('{ groups = ["left", "right"] }', {"groups": ["left", "right"]}),
    ],
)
def test_nodes_and_edges(table: str, given: dict, kind: str) -> None:
    select = PLATE.select_nodes if kind == "node_groups" else PLATE.select_edges
    expected = select("far", **given).nodes_of("far")
    assert mesh_of(table, kind).nodes_of("far").tolist() == expected.tolist()
    assert 0 < len(expected) < len(PLATE.points)


def test_elements() -> None:
    polygon = "[[0, 0], ['11 mm', 0], ['11 mm', '5 mm'], [0, '5 mm']]"
    assert mesh_of(f"{{ polygon = {polygon} }}", "element_groups").elements_of("far").tolist() == [0, 1]
    both = f"{{ polygon = {polygon}, x1 = ['5 mm', '20 mm'] }}"
    assert mesh_of(both, "element_groups").elements_of("far").tolist() == [1]
    assert mesh_of("{ sphere = { radius = '8 mm' } }", "element_groups").elements_of("far").tolist() == [0, 1]


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ("{}", "far: selects nothing; give at least one of cylinder, groups, polygon, sphere, x1, x2, x3"),
        ("{ box = 1 }", "far.box: is an unknown key: a box is ranges of x1, x2 and x3"),
        ("{ x = 0 }", "far.x: is an unknown key. Did you mean 'x1'"),
        ('{ x1 = ["1 mm"] }', "far.x1: has 1 entries; expected one coordinate, or the least and the greatest"),
        ('{ x1 = ["2 mm", "1 mm"] }', "far: Group 'far': x1 is .* it must be"),
        ("{ sphere = { radius = 0 } }", "far.sphere.radius: '0' is not positive"),
        ('{ sphere = { radius = ["1 mm", "2 mm", 0] } }', "far.sphere.radius: has 3 entries"),
        ('{ sphere = { radius = ["3 mm", "2 mm"] } }', r"far: radius is .* a least and a largest one"),
        ('{ sphere = { centre = ["1 m", 0, 0], radius = "2 mm" } }', "far: Group 'far': no boundary edge lies in the"),
        ('{ polygon = [[0, 0], ["1 mm", 0]] }', "far.polygon: has 2 corners"),
        ('{ groups = "lft" }', "far: There is no edge group 'lft'. Did you mean 'left'"),
    ],
)
def test_bad_selections(table: str, words: str) -> None:
    with pytest.raises(ms.InputError, match=rf"^strip\.toml: mesh\.edge_groups\.{words}"):
        mesh_of(table, "edge_groups")
