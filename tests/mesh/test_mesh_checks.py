"""What a mesh refuses, and that the message names the place."""

from __future__ import annotations

import pickle
import subprocess
import sys
import time

import numpy as np
import pytest

from magshell.errors import MeshError
from magshell.mesh import Mesh, cylinder, rectangle, sphere_patch, split


def refused(points, elements, *phrases, **groups):
    with pytest.raises(MeshError) as caught:
        Mesh(points, elements, **groups)
    for phrase in phrases:
        assert phrase in str(caught.value), str(caught.value)


@pytest.fixture
def two():
    """Points and elements of two unit squares side by side, writable."""
    mesh = rectangle(2.0, 1.0, (2, 1))
    return mesh.points.copy(), mesh.elements.copy()


def glued(*meshes):
    """Points and elements of meshes put side by side, nothing welded."""
    starts = np.cumsum([0] + [len(mesh.points) for mesh in meshes[:-1]])
    points = np.concatenate([mesh.points for mesh in meshes])
    return points, np.concatenate([mesh.elements + start for mesh, start in zip(meshes, starts, strict=True)])


def moved(mesh, x1=0.0, x2=0.0, x3=0.0):
    return Mesh(mesh.points + np.array([x1, x2, x3]), mesh.elements)


def node_at(points, *position):
    return int(np.argmin(np.linalg.norm(points - position, axis=1)))


def test_a_sound_mesh_is_copied_and_read_only(two):
    points, elements = two
    mesh = Mesh(points, elements)
    points[0] = 7
    assert (mesh.points[0] == 0).all()
    for array in (mesh.points, mesh.elements, mesh.corner_nodes, mesh.boundary_edges, *mesh.parts):
        assert not array.flags.writeable


def test_a_mesh_from_another_process_is_read_only(two):
    mesh = Mesh(*two, element_groups={"first": [0]}, node_groups={"corner": [0]})
    assert mesh.triangles.tolist() == [False, False]
    again = pickle.loads(pickle.dumps(mesh))
    groups = (again.element_groups["first"], again.node_groups["corner"])
    for array in (again.points, again.elements, again.triangles, *groups):
        assert not array.flags.writeable


@pytest.mark.parametrize(
    ("points", "elements", "phrases"),
    [
        (np.zeros((8, 2)), [range(8)], ["Points", "(n, 3)", "(8, 2)"]),
        (np.zeros(8), [range(8)], ["Points", "(n, 3)", "(8,)"]),
        ([], [range(8)], ["Points", "empty"]),
        (np.zeros((8, 3)), [range(4)], ["Elements", "(n, 8)", "(1, 4)"]),
        (np.zeros((8, 3)), [], ["Elements", "empty"]),
        (np.zeros((8, 3)), [[0.5] * 8], ["Elements", "whole numbers", "float64"]),
        (np.zeros((8, 3)), [range(8), range(4)], ["Elements", "different lengths"]),
        ([["a", "b", "c"]], [range(8)], ["Points", "numbers"]),
    ],
)
def test_wrong_shapes(points, elements, phrases):
    refused(points, elements, *phrases)


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_position_that_is_not_finite(two, value):
    points, elements = two
    points[3, 1] = value
    refused(points, elements, "Node 3", str(value), "finite")


@pytest.mark.parametrize("number", [-1, 13])
def test_a_node_out_of_range(two, number):
    points, elements = two
    elements[1, 2] = number
    refused(points, elements, f"Element 1 has node {number}", "0 to 12")


def test_a_node_twice_in_an_element(two):
    points, elements = two
    elements[1, 2] = elements[1, 1]
    refused(points, elements, f"Element 1 has node {elements[1, 1]} twice")


def test_unused_nodes(two):
    points, elements = two
    refused(np.vstack([points, [[5, 5, 5], [6, 6, 6]]]), elements, "node 13, 14", "(5, 5, 5) m")


def test_an_element_twice(two):
    points, elements = two
    turned = elements[1, [1, 2, 3, 0, 5, 6, 7, 4]]
    refused(points, np.vstack([elements, turned]), "Elements 1 and 2", "same corners")


def test_neighbours_may_have_opposite_normals(two):
    points, elements = two
    elements[1] = elements[1, [0, 3, 2, 1, 7, 6, 5, 4]]
    assert len(Mesh(points, elements).parts) == 1


@pytest.mark.parametrize("opposite", [False, True])
def test_elements_that_lie_on_each_other(two, opposite):
    """Two squares folded about their common edge, by all but 0.05 degrees and by all but 0.2 degrees."""
    points, elements = two
    if opposite:
        elements[1] = elements[1, [0, 3, 2, 1, 7, 6, 5, 4]]
    beyond = points[:, 0] > 1
    for angle, sound in ((np.radians(0.2), True), (np.radians(0.05), False)):
        folded = points.copy()
        folded[beyond, 2] = (points[beyond, 0] - 1) * np.sin(angle)
        folded[beyond, 0] = 1 - (points[beyond, 0] - 1) * 0.9 * np.cos(angle)
        if sound:
            assert len(Mesh(folded, elements).elements) == 2
        else:
            refused(folded, elements, "Elements 0 and 1 lie on each other", "(1, 0, 0) m", "(1, 1, 0) m", "0.05")


def test_three_elements_on_an_edge(two):
    points, elements = two
    fin = rectangle(1.0, 1.0, (1, 1))
    upright = np.stack([np.ones(8), fin.points[:, 1], fin.points[:, 0]], axis=1)
    number = np.array([node_at(points, *p) if p[2] == 0 else -1 for p in upright])
    number[number < 0] = len(points) + np.arange((number < 0).sum())
    points = np.vstack([points, upright[upright[:, 2] > 0]])
    mesh = Mesh(points, np.vstack([elements, number[fin.elements]]))
    assert len(mesh.parts) == 1
    assert len(mesh.boundary_edges) == 9


def test_neighbours_with_a_middle_each(two):
    points, elements = two
    points = np.vstack([points, [1.0, 0.5, 0.0]])
    elements[1, 7] = 13
    refused(points, elements, "Elements 0 and 1 share the corners", "13", "in the middle")


def test_a_node_in_the_middle_of_two_edges():
    points, elements = glued(rectangle(1.0, 1.0, (1, 1)), moved(rectangle(1.0, 1.0, (1, 1)), x1=3.0))
    kept = np.delete(np.arange(16), elements[1, 7])
    elements[1, 7] = elements[0, 5]
    refused(points[kept], np.searchsorted(kept, elements), "Elements 0 and 1", "middle of two different edges")


def test_a_middle_that_is_a_corner_of_the_neighbour():
    """A coarse element beside two fine ones that use its middle as their common corner."""
    points, elements = glued(rectangle(1.0, 1.0, (1, 1)), moved(rectangle(1.0, 1.0, (1, 2)), x1=1.0))
    weld = np.arange(len(points))
    for height in (0.0, 0.5, 1.0):
        one, other = np.flatnonzero(np.linalg.norm(points - [1.0, height, 0], axis=1) < 1e-9)
        weld[other] = one
    kept, welded = np.unique(weld[elements], return_inverse=True)
    refused(points[kept], welded.reshape(-1, 8), "corner of element 2", "edge of element 0", "refine element 0")


def test_coincident_nodes_that_are_not_welded():
    points, elements = glued(rectangle(1.0, 1.0, (1, 1)), moved(rectangle(1.0, 1.0, (1, 1)), x1=1.0))
    refused(points, elements, "Elements 0 and 1 are not joined", "(1, 0, 0) m", "Weld", "3 such places")


def test_closed_surfaces_one_upon_the_other():
    tube = cylinder(1.0, 1.0, (6, 1))
    points, elements = glued(tube, tube)
    refused(points, elements, "Elements 0 and 6 are not joined")


@pytest.mark.parametrize("fine", [3, 4])
def test_a_node_on_a_straight_edge_of_another_element(fine):
    """Several elements against one: none of their nodes falls on its ends or its middle."""
    side = moved(rectangle(1.0, 0.8, (1, fine)), x1=1.0, x2=0.13)
    points, elements = glued(rectangle(1.0, 1.0, (1, 1)), side)
    refused(points, elements, "Elements 0 and", "do not match", "lies on the edge of the first", "Divide")


def test_a_node_on_a_curved_edge_of_another_element():
    """Of two rings one is turned by 5 of the 30 degrees of an element: nodes lie on the true circle only."""
    points, elements = glued(cylinder(1.0, 0.5, (12, 2)), moved(cylinder(1.0, 0.5, (12, 2), angle=(5, 365)), x3=0.5))
    refused(points, elements, "do not match", "lies on the edge of the first")


@pytest.mark.parametrize("shift", [0.3, 0.42])
@pytest.mark.parametrize("triangles", [False, True])
def test_a_rib_that_stands_on_a_plate_without_nodes_there(shift, triangles):
    """Its foot runs through the elements."""
    plate = rectangle(2.0, 1.0, (4, 4))
    plate = split(plate, "rising") if triangles else plate
    rib = rectangle(1.0, 1.0, (2, 1)).points[:, [1, 0, 2]] * [0, 0.93, 0] + [0, 0.03, 0]
    rib += np.stack([0 * rib[:, 0] + shift, 0 * rib[:, 0], rectangle(1.0, 1.0, (2, 1)).points[:, 1]], axis=1)
    points = np.concatenate([plate.points, rib])
    rows = np.concatenate([plate.elements, rectangle(1.0, 1.0, (2, 1)).elements + len(plate.points)])
    refused(points, rows, "are not joined: node", "free edge of the second lies on the first", "T-joint", "leave a gap")
    points[len(plate.points) :, 2] += 5e-3
    assert len(Mesh(points, rows).parts) == 2


def test_a_rib_on_a_curved_surface_is_found():
    tube = cylinder(1.0, 1.0, (12, 2))
    fin = rectangle(0.5, 0.9, (1, 2)).points
    turn = np.radians(11.0)
    outward = np.array([np.cos(turn), np.sin(turn), 0.0])
    for gap, sound in ((0.0, False), (0.02, True)):
        points = np.concatenate(
            [tube.points, (1.0 + gap + fin[:, :1]) * outward + fin[:, 1:2] * [0, 0, 1] + [0, 0, 0.07]]
        )
        rows = np.concatenate([tube.elements, rectangle(0.5, 0.9, (1, 2)).elements + len(tube.points)])
        if sound:
            assert len(Mesh(points, rows).parts) == 2
        else:
            refused(points, rows, "are not joined", "free edge of the second")


def test_a_narrow_gap_is_allowed():
    points, elements = glued(rectangle(1.0, 1.0, (2, 2)), moved(rectangle(1.0, 1.0, (3, 3)), x1=1.01))
    assert [len(part) for part in Mesh(points, elements).parts] == [4, 9]


def test_slender_elements_are_allowed():
    mesh = rectangle(1.0, 1e-4, (1, 4))
    assert len(mesh.elements) == 4


def test_an_edge_of_no_length(two):
    points, elements = two
    points[elements[1, 2]] = points[elements[1, 1]]
    refused(points, elements, "Element 1 has an edge of no length", str(elements[1, 1]), str(elements[1, 2]))


def straight(corners):
    """Points of one element with straight edges."""
    corners = np.array(corners, dtype=float)
    return np.vstack([corners, 0.5 * (corners + np.roll(corners, -1, axis=0))])


@pytest.mark.parametrize(
    "corners",
    [
        [(0, 0, 0), (1, 1, 0), (1, 0, 0), (0, 1, 0)],
        [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)],
        [(0, 0, 0), (0, 3, 2), (0, 3, 0), (0, 0, 1)],
    ],
)
def test_a_bow_tie(corners):
    refused(straight(corners), [range(8)], "Element 0 is a bow-tie", "order of a walk")


@pytest.mark.parametrize("corner", range(4))
@pytest.mark.parametrize("depth", [0.5, 0.8])
def test_a_corner_of_180_degrees_or_more_is_named(corner, depth):
    """The corner is pulled to the line between its neighbours, and beyond it."""
    corners = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], dtype=float)
    corners[corner] += depth * (corners[(corner + 2) % 4] - corners[corner])
    refused(straight(corners), [range(8)], f"Element 0 is turned inside out at corner {corner + 1}", "180 degrees")


def test_a_corner_is_turned_inside_out_by_curved_edges(two):
    """Both edges at node (0, 0) bend into the element until their tangents cross."""
    points, elements = two
    points[node_at(points, 0.5, 0, 0)] += [0, 0.3, 0]
    points[node_at(points, 0, 0.5, 0)] += [0.3, 0, 0]
    refused(points, elements, "Element 0 is turned inside out at corner 1", "node 0")


@pytest.mark.parametrize(("shift", "sound"), [(0.24, True), (0.25, False), (-0.25, False), (0.4, False)])
def test_a_middle_must_lie_in_the_middle_half(two, shift, sound):
    points, elements = two
    middle = node_at(points, 1.5, 0, 0)
    points[middle, 0] += shift
    if sound:
        assert len(Mesh(points, elements).elements) == 2
    else:
        refused(points, elements, f"Element 1: node {middle}", f"{0.5 + shift:.3g} of the way", "0.25 and 0.75")


def test_a_middle_must_not_stand_far_aside(two):
    points, elements = two
    middle = node_at(points, 1.5, 0, 0)
    points[middle, 2] += 0.6
    refused(points, elements, f"Element 1: node {middle}", "0.6 of the edge's length aside")


@pytest.mark.parametrize(
    ("groups", "phrases"),
    [
        ({"element_groups": {"arm": [0, 2]}}, ["Element group 'arm' has element 2", "0 to 1"]),
        ({"node_groups": {"tip": [-1]}}, ["Node group 'tip' has node -1", "0 to 12"]),
        ({"edge_groups": {"root": [[0, 99, 1]]}}, ["Edge group 'root' has node 99", "0 to 12"]),
        ({"edge_groups": {"root": [[0, 1, 2]]}}, ["Edge group 'root': row 0", "not an edge of any element"]),
        ({"edge_groups": {"root": [[0, 1]]}}, ["Edge group 'root'", "(n, 3)", "(1, 2)"]),
        ({"element_groups": {"arm": []}}, ["Element group 'arm'", "empty"]),
        ({"edge_groups": {"root": np.zeros((0, 3), int)}}, ["Edge group 'root'", "empty"]),
        ({"node_groups": {"tip": []}}, ["Node group 'tip'", "empty"]),
        ({"node_groups": {"tip": [1.5]}}, ["Node group 'tip'", "whole numbers"]),
        ({"node_groups": {"tip": [1], "": [1]}}, ["''", "not empty"]),
        ({"element_groups": {"arm": [0]}, "node_groups": {"arm": [0]}}, ["'arm'", "elements", "nodes"]),
    ],
)
def test_groups_that_make_no_sense(two, groups, phrases):
    refused(*two, *phrases, **groups)


def test_an_edge_group_may_walk_either_way_and_lie_inside(two):
    points, elements = two
    start, end, middle = (node_at(points, 1, y, 0) for y in (0, 1, 0.5))
    mesh = Mesh(points, elements, edge_groups={"joint": [[start, end, middle], [end, start, middle]]})
    assert mesh.edge_groups["joint"].tolist() == [[start, end, middle]]


@pytest.mark.parametrize(
    "make",
    [
        lambda n: rectangle(1.0, 1.0, (25 * n, 20 * n)),
        lambda n: rectangle(1.0, 1e-3, (500 * n**2, 1)),
        lambda n: sphere_patch(1.0, (10, 170), (0, 360), (20 * n, 25 * n)),
    ],
    ids=["square", "strip", "zone"],
)
def test_time_grows_as_the_number_of_elements(make):
    """Sixteen times as many take far less than 16² times as long."""
    rectangle(1.0, 1.0, (1, 1))  # imports scipy

    def seconds(n):
        start = time.process_time()
        mesh = make(n)
        assert len(mesh.elements) == 500 * n**2
        return time.process_time() - start

    few, many = min(seconds(2) for _ in range(3)), seconds(8)
    assert many < 3 * 16 * few, f"{few:.3f} s, {many:.3f} s"


def test_importing_the_mesh_does_not_import_scipy():
    code = "import sys, magshell.mesh; print([name for name in sys.modules if name.startswith('scipy')])"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert found.strip() == "[]", found
