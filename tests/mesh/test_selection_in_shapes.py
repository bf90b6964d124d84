"""Nodes, edges and elements between coordinates and in shapes, and both."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

import magshell as ms
from magshell.mesh.shapes import outside

PLATE = ms.mesh.rectangle(4.0, 2.0, (4, 2))
RING = ms.mesh.annulus(1.0, 2.0, (2, 12))
TRIANGLE = [(0.0, 0.0), (4.0, 0.0), (0.0, 2.0)]
L_SHAPE = [(0, 0), (4, 0), (4, 1), (1, 1), (1, 2), (0, 2)]


def places(mesh: ms.mesh.Mesh, name: str) -> set[tuple[float, ...]]:
    return {tuple(x) for x in mesh.points[mesh.nodes_of(name)][:, :2].round(9).tolist()}


def every(mesh: ms.mesh.Mesh) -> list[tuple[float, ...]]:
    return [tuple(x) for x in mesh.points[:, :2].round(9).tolist()]


def test_nodes_between_coordinates() -> None:
    box = PLATE.select_nodes("box", x1=(0.5, 2.0), x2=(1.0, 9.0))
    assert places(box, "box") == {x for x in every(PLATE) if 0.5 <= x[0] <= 2.0 and x[1] >= 1.0}
    line = PLATE.select_nodes("line", x1=2.0, x2=(0.0, 1.0))
    assert places(line, "line") == {(2.0, 0.0), (2.0, 0.5), (2.0, 1.0)}


def test_edges_between_coordinates_are_those_with_all_nodes_there() -> None:
    chosen = PLATE.select_edges("low", x1=(0.5, 3.5), x2=0.0)
    assert sorted(chosen.points[chosen.edge_groups["low"][:, 2], 0].tolist()) == [1.5, 2.5]


def test_nodes_in_a_sphere() -> None:
    near = PLATE.select_nodes("near", within=ms.mesh.in_sphere((1.0, 1.0, 0.0), 0.5))
    assert places(near, "near") == {(1.0, 1.0), (0.5, 1.0), (1.5, 1.0), (1.0, 0.5), (1.0, 1.5)}
    shell = PLATE.select_nodes("shell", within=ms.mesh.in_sphere((1.0, 1.0, 0.0), (0.5, 1.0)))
    assert places(shell, "shell") == {x for x in every(PLATE) if 0.499 < np.hypot(x[0] - 1, x[1] - 1) < 1.001}


def test_edges_by_their_distance_from_an_axis() -> None:
    """The hole of a ring, also if the axis is turned over and passes through another of its points."""
    for through, axis in (((0, 0, 0), (0, 0, 1)), ((0, 0, 7), (0, 0, -3))):
        hole = RING.select_edges("hole", within=ms.mesh.in_cylinder(through, axis, 1.0))
        assert sorted(hole.edge_groups["hole"].tolist()) == sorted(RING.edge_groups["inner"].tolist())
        rim = RING.select_edges("rim", within=ms.mesh.in_cylinder(through, axis, (1.5, 2.0)))
        assert sorted(rim.edge_groups["rim"].tolist()) == sorted(RING.edge_groups["outer"].tolist())


def test_elements_in_a_polygon_by_their_centres() -> None:
    chosen = PLATE.select_elements("arm", within=ms.mesh.in_polygon(L_SHAPE))
    assert chosen.element_groups["arm"].tolist() == [0, 1, 2, 3, 4]
    turned = PLATE.select_elements("arm", within=ms.mesh.in_polygon(L_SHAPE[::-1]))
    assert turned.element_groups["arm"].tolist() == [0, 1, 2, 3, 4]


def test_nodes_on_the_sides_of_a_polygon_belong_to_it() -> None:
    chosen = PLATE.select_nodes("corner", within=ms.mesh.in_polygon(TRIANGLE))
    assert places(chosen, "corner") == {x for x in every(PLATE) if x[0] + 2 * x[1] <= 4.0}


def test_everything_combined() -> None:
    mesh = PLATE.select_elements("left half", x1=(0.0, 2.0))
    shapes = [ms.mesh.in_sphere((2.0, 1.0, 0.0), 1.2), lambda x: x[:, 1] > 0.9]
    mesh = mesh.select_nodes("few", x1=(1.0, 9.0), groups=["left half"], within=shapes)
    expected = {
        x for x in every(PLATE) if 1.0 <= x[0] <= 2.0 and x[1] > 0.9 and np.hypot(x[0] - 2.0, x[1] - 1.0) <= 1.2
    }
    assert places(mesh, "few") == expected
    assert mesh.select_elements("e", groups=["left half"], within=shapes).element_groups["e"].tolist() == [5]
    sides = PLATE.select_edges("both", groups=["left", "right"])
    assert len(sides.edge_groups["both"]) == 4
    assert len(PLATE.select_edges("half", x2=(0.0, 1.0), groups=["left", "right"]).edge_groups["half"]) == 2
    assert PLATE.select_nodes("all of it", groups=["left"]).nodes_of("all of it").tolist() == (
        PLATE.nodes_of("left").tolist()
    )


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: PLATE.select_nodes("n", x1=(2.0, 1.0)), r"x1 is \[2.0, 1.0\]; it must be"),
        (lambda: PLATE.select_nodes("n", x1=(1.0, 2.0, 3.0)), r"x1 is \[1.0, 2.0, 3.0\]; it must be"),
        (lambda: PLATE.select_nodes("n", x1=(5.0, 6.0)), r"no node has X1 from 5 to 6 m. The nearest is at \(4, "),
        (lambda: PLATE.select_edges("n", groups=["lft"]), "There is no edge group 'lft'. Did you mean 'left'"),
        (
            lambda: PLATE.select_edges("n", x1=1.0, groups=["left"]),
            r"no edge of these groups has X1 = 1 m. The nearest is at \(0, ",
        ),
        (
            lambda: PLATE.select_nodes("n", within=ms.mesh.in_sphere((9.0, 0.0, 0.0), 1.0)),
            r"no node lies in the shape. The nearest is at \(4, 0, 0\) m; the mesh spans",
        ),
        (
            lambda: PLATE.select_nodes("n", x1=1.0, within=lambda x: x[:, 0] > 9.0),
            r"no node has X1 = 1 m and lies in the shape; the mesh spans",
        ),
        (lambda: PLATE.select_nodes("n", within=lambda x: x > 0), r"a shape returned bool of shape \(37, 3\)"),
        (lambda: PLATE.select_elements("n", within=ms.mesh.in_sphere((9, 0, 0), 1.0)), "no element lies there"),
        (lambda: ms.mesh.in_sphere((0, 0), 1.0), r"centre is \[0.0, 0.0\]; it must be three finite numbers"),
        (lambda: ms.mesh.in_sphere((0, 0, 0), 0.0), r"radius is 0.0; it must be positive"),
        (lambda: ms.mesh.in_sphere((0, 0, 0), (2.0, 1.0)), r"radius is \[2.0, 1.0\]"),
        (lambda: ms.mesh.in_cylinder((0, 0, 0), (0, 0, 0), 1.0), "axis is the zero vector"),
        (lambda: ms.mesh.in_polygon([(0, 0), (1, 0)]), "three or more corners"),
    ],
)  # fmt: skip
def test_bad_selections(call, words: str) -> None:
    with pytest.raises(ms.InputError, match=words):
        call()


numbers = st.floats(-3, 3)


@example(angle=0.0, x=0.0, y=-1e-27, z=0.0)
@given(angle=st.floats(0, 6.28), x=numbers, y=numbers, z=numbers)
def test_shapes_know_how_far_outside(angle: float, x: float, y: float, z: float) -> None:
    """A regular polygon of many sides about its circle; a sphere; a cylinder along any axis."""
    turns = angle + np.linspace(0.0, 2 * np.pi, 400, endpoint=False)
    polygon = ms.mesh.in_polygon(np.column_stack([np.cos(turns), np.sin(turns)]))
    point = np.array([[x, y, z]])
    assert abs(outside(point, polygon)[0] - (np.hypot(x, y) - 1.0)) < 1e-4
    assert abs(outside(point, ms.mesh.in_sphere((1, 0, 0), 2.0))[0] - (np.linalg.norm([x - 1, y, z]) - 2.0)) < 1e-12
    cylinder = ms.mesh.in_cylinder((0, 0, 5), (np.cos(angle), np.sin(angle), 0), 1.0)
    assert abs(outside(point, cylinder)[0] - (np.hypot(y * np.cos(angle) - x * np.sin(angle), z - 5) - 1.0)) < 1e-12
