"""Triangles in a mesh: their rows, what is refused, edges, measures, and quadrilaterals cut into them."""

from __future__ import annotations

import numpy as np
import pytest

from magshell.errors import InputError, MeshError
from magshell.mesh import Mesh, cylinder, rectangle, split, triangle_rows
from magshell.mesh.geometry import chord_lengths
from magshell.mesh.quality import measure
from magshell.mesh.triangles import PATTERNS

CORNERS = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, 0.5 * 3.0**0.5, 0.0]])
SIX = np.vstack([CORNERS, 0.5 * (CORNERS + np.roll(CORNERS, -1, axis=0))])
each_pattern = pytest.mark.parametrize("pattern", PATTERNS)


def area(mesh):
    x = mesh.points[mesh.boundary_edges[:, :2], :2]
    return 0.5 * np.sum(x[:, 0, 0] * x[:, 1, 1] - x[:, 0, 1] * x[:, 1, 0])


def test_a_triangle():
    mesh = Mesh(SIX, triangle_rows([[0, 1, 2, 3, 4, 5]]))
    assert mesh.elements.tolist() == [[0, 1, 2, 2, 3, 4, 2, 5]]
    assert mesh.triangles.tolist() == [True]
    assert mesh.boundary_edges.tolist() == [[0, 1, 3], [1, 2, 4], [2, 0, 5]]
    assert mesh.corner_nodes.tolist() == [0, 1, 2]
    assert repr(mesh) == "Mesh(1 triangles, 6 nodes, groups: none)"
    quality = measure(mesh)
    assert [quality.scaled_jacobian[0], quality.aspect_ratio[0], quality.warp[0]] == pytest.approx([1.0, 1.0, 0.0])
    assert chord_lengths(mesh.points, mesh.elements) == pytest.approx(np.ones((1, 4)))


@pytest.mark.parametrize(
    ("row", "said"),
    [
        ([0, 1, 2, 2, 3, 4, 4, 5], "node 2 twice"),
        ([0, 1, 1, 2, 3, 1, 4, 5], "which is the row a, b, c, c, ab, bc, c, ca"),
        ([0, 1, 2, 2, 3, 3, 2, 5], "Element 0 has node"),
        ([0, 2, 1, 1, 5, 4, 1, 3], None),
        ([0, 1, 2, 2, 4, 3, 2, 5], "node 4 at (0.75, 0.433013, 0) m belongs in the middle between nodes 0 and 1"),
    ],
)
def test_rows(row, said):
    """Another corner repeated, other repetitions, middles out of place are refused; either sense of turning is not."""
    if said is None:
        assert Mesh(SIX, [row]).triangles.all()
        return
    with pytest.raises(MeshError) as caught:
        Mesh(SIX, [row])
    assert said in str(caught.value), str(caught.value)


def test_triangles_that_are_flat_or_lie_on_each_other_are_refused():
    flat = SIX.copy()
    flat[2] = [1.5, 1e-9, 0.0]
    flat[[4, 5]] = 0.5 * (flat[[1, 2]] + flat[[2, 0]])
    with pytest.raises(MeshError, match="turned inside out at corner"):
        Mesh(flat, triangle_rows([[0, 1, 2, 3, 4, 5]]))
    mesh = split(rectangle(1.0, 1.0, (1, 1)), "rising")
    rows = mesh.elements.copy()
    rows[1] = rows[1][[0, 2, 1, 1, 7, 5, 1, 4]]
    assert len(Mesh(mesh.points, rows).elements) == 2, "opposite normals"
    points = mesh.points.copy()
    points[:, 1] = np.where(
        points[:, 1] > points[:, 0], points[:, 0] - 0.9 * (points[:, 1] - points[:, 0]), points[:, 1]
    )
    with pytest.raises(MeshError, match="Elements 0 and 1 lie on each other: at their common edge"):
        Mesh(points, mesh.elements)
    with pytest.raises(MeshError, match="same corners, nodes 0, 1, 2: remove"):
        Mesh(SIX, triangle_rows([[0, 1, 2, 3, 4, 5]] * 2))
    with pytest.raises(MeshError, match="is not an edge of any element"):
        Mesh(SIX, triangle_rows([[0, 1, 2, 3, 4, 5]]), edge_groups={"none": [[2, 2, 2]]})


@each_pattern
def test_split(pattern):
    """Groups, rim and area stay; cuts are straight; the number of pieces is that of the pattern."""
    coarse = rectangle(3.0, 2.0, (3, 2))
    coarse = Mesh(coarse.points, coarse.elements, {"some": [1, 4]}, coarse.edge_groups, {"one": [0]})
    mesh = split(coarse, pattern)
    each = 4 if pattern == "crossed" else 2
    assert len(mesh.elements) == 6 * each
    assert mesh.triangles.all()
    assert mesh.element_groups["some"].tolist() == [*range(each, 2 * each), *range(4 * each, 5 * each)]
    assert sorted(map(tuple, mesh.boundary_edges)) == sorted(map(tuple, coarse.boundary_edges))
    assert mesh.select_edges("also left", x1=0.0).edge_groups["also left"].tolist() == mesh.edge_groups["left"].tolist()
    assert area(mesh) == pytest.approx(6.0)
    ends = mesh.points[mesh.elements[:, [0, 1, 2]]]
    middles = mesh.points[mesh.elements[:, [4, 5, 7]]]
    assert np.abs(middles - 0.5 * (ends + np.roll(ends, -1, axis=1))).max() < 1e-15


def test_split_of_some_and_by_turns():
    mesh = split(rectangle(3.0, 1.0, (3, 1)), "crossed", [1])
    assert mesh.counts == "2 quadrilaterals, 4 triangles"
    assert split(mesh, "rising").counts == "8 triangles"
    alternating = split(rectangle(2.0, 2.0, (2, 2)), "alternating")
    middle = alternating.node_at((1.0, 1.0, 0.0))
    assert np.count_nonzero(alternating.elements[:, :3] == middle) in (4, 8)
    with pytest.raises(InputError, match=r"split: pattern is 'crosed'\. .*crossed"):
        split(mesh, "crosed")


@each_pattern
def test_split_follows_the_surface(pattern):
    """New nodes lie on a cylinder to the fourth order of the elements' angle."""
    off = []
    for count in (4, 8):
        mesh = split(cylinder(1.0, 0.5, (count, 1), angle=(0, 90)), pattern)
        off.append(np.abs(np.hypot(*mesh.points[:, :2].T) - 1.0).max())
    assert off[0] < (0.5 * np.pi / 4) ** 4 / 100.0, off
    assert off[1] < off[0] / 12.0 or off[1] < 1e-14, off
