"""Finding places on a mesh, and how good its elements are."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from magshell.errors import InputError
from magshell.mesh import Mesh, blocks, cylinder, rectangle, sphere_patch
from magshell.mesh.quality import measure, worst


@pytest.fixture
def plate():
    return rectangle(2.0, 1.0, (4, 2))


def says(call, *phrases):
    with pytest.raises(InputError) as caught:
        call()
    for phrase in phrases:
        assert phrase in str(caught.value), str(caught.value)


def test_selected_edges_are_those_of_the_generator(plate):
    chosen = plate.select_edges("root", x1=0)
    assert sorted(chosen.edge_groups["root"].tolist()) == sorted(plate.edge_groups["left"].tolist())
    assert "root" not in plate.groups
    assert chosen.groups == [*plate.groups, "root"]
    assert not chosen.edge_groups["root"].flags.writeable


def test_selected_edges_are_boundary_edges_only(plate):
    says(
        lambda: plate.select_edges("mid", x1=1.0),
        "'mid'",
        "no boundary edge has X1 = 1 m",
        "nearest",
        "(2, 1, 0) m",
    )
    hollow = blocks({"one": [(0, 0), (1, 0), (1, 1), (0, 1)], "two": [(1, 0), (2, 0), (2, 1), (1, 1)]}, (1, 1))
    says(lambda: hollow.select_edges("joint", x1=1), "no boundary edge")


def test_selected_nodes_have_the_coordinates(plate):
    chosen = plate.select_nodes("line", x1=1.0).select_nodes("spot", x1=1.0, x2=0.5)
    assert chosen.points[chosen.nodes_of("line"), 0] == pytest.approx(np.ones(5))
    assert chosen.nodes_of("spot").tolist() == [plate.node_at([1.0, 0.5, 0])]


def test_selection_reaches_a_millionth_of_the_size(plate):
    assert len(plate.select_nodes("near", x1=0.9e-6 * plate.size).nodes_of("near")) == 5
    says(lambda: plate.select_nodes("near", x1=1.1e-6 * plate.size), "no node has X1 = 2.4", "(0, 0, 0) m")


def test_what_cannot_be_selected(plate):
    says(lambda: plate.select_nodes("all"), "'all'", "at least one of the coordinates x1, x2, x3")
    says(lambda: plate.select_nodes("far", x3=np.nan), "'far'", "finite")
    says(lambda: plate.select_edges("left", x1=0), "'left'", "name of its own")
    says(lambda: plate.select_nodes("", x1=0), "not empty")


@settings(max_examples=30, deadline=None)
@given(n=st.integers(1, 5), m=st.integers(1, 5), column=st.integers(0, 10))
def test_every_node_is_found_where_it_is(n, m, column):
    mesh = sphere_patch(0.02, (20, 100), (0, 70), (n, m))
    node = column % len(mesh.points)
    assert mesh.node_at(mesh.points[node]) == node


def test_a_position_between_nodes_names_the_nearest_and_its_distance(plate):
    nearest = plate.node_at((2.0, 1.0, 0.0))
    says(lambda: plate.node_at((2.0, 1.0, 0.125)), f"nearest is node {nearest}", "(2, 1, 0) m", "0.125 m away")
    says(lambda: plate.node_at((1.0, 2.0)), "three finite coordinates")
    says(lambda: plate.node_at((1.0, 2.0, np.nan)), "three finite coordinates")


def test_nodes_and_elements_of_groups():
    mesh = blocks({"arm": [(0, 0), (1, 0), (1, 1), (0, 1)], "leg": [(1, 0), (2, 0), (2, 1), (1, 1)]}, (2, 1))
    mesh = mesh.select_edges("root", x1=0).select_nodes("tip", x1=2, x2=0)
    assert mesh.groups == ["arm", "leg", "root", "tip"]
    assert mesh.elements_of("leg").tolist() == [2, 3]
    assert mesh.nodes_of("leg").tolist() == sorted(set(mesh.elements[2:].ravel().tolist()))
    assert mesh.points[mesh.nodes_of("root"), 0] == pytest.approx(np.zeros(3))
    assert mesh.nodes_of("tip").tolist() == [mesh.node_at((2, 0, 0))]
    says(lambda: mesh.nodes_of("rot"), "no group 'rot'", "Did you mean 'root'")
    says(lambda: mesh.elements_of("lag"), "no element group 'lag'", "Did you mean 'leg'")
    says(lambda: mesh.elements_of("root"), "'root' is a group of edges, not of elements", "arm, leg")


def test_corner_nodes_are_the_corners(plate):
    assert plate.corner_nodes.tolist() == sorted(set(plate.elements[:, :4].ravel().tolist()))
    assert len(plate.corner_nodes) == 15


def test_boundary_edges_walk_around_with_the_surface_on_the_left(plate):
    start, end = (plate.points[plate.boundary_edges[:, i], :2] for i in range(2))
    enclosed = 0.5 * (start[:, 0] * end[:, 1] - start[:, 1] * end[:, 0]).sum()
    assert enclosed == pytest.approx(2.0)
    assert sorted(plate.boundary_edges[:, 0]) == sorted(plate.boundary_edges[:, 1])


def test_parts_come_in_the_order_of_their_first_element():
    plate = rectangle(1.0, 1.0, (2, 1))
    count = len(plate.points)
    points = np.concatenate([plate.points, plate.points + np.array([3, 0, 0])])
    elements = np.concatenate([plate.elements + count, plate.elements])[[0, 2, 1, 3]]
    assert [part.tolist() for part in Mesh(points, elements).parts] == [[0, 2], [1, 3]]


def test_size_is_the_diagonal():
    assert rectangle(3.0, 4.0, (1, 1)).size == pytest.approx(5.0)
    assert cylinder(0.5, 1.0, (4, 1)).size == pytest.approx(np.sqrt(3))


def test_a_mesh_prints_in_one_line(plate):
    assert repr(plate) == "Mesh(8 elements, 37 nodes, groups: left, right, bottom, top)"


@pytest.mark.parametrize("duplicate", [copy.deepcopy, lambda mesh: pickle.loads(pickle.dumps(mesh))])
def test_a_mesh_can_be_copied_and_pickled(plate, duplicate):
    other = duplicate(plate)
    assert (other.points == plate.points).all()
    assert other.groups == plate.groups


def test_quality_of_a_rectangle_is_its_aspect_ratio():
    quality = measure(rectangle(6.0, 1.0, (2, 1)))
    assert quality.scaled_jacobian == pytest.approx(np.ones(2))
    assert quality.aspect_ratio == pytest.approx(np.full(2, 3.0))
    assert quality.warp == pytest.approx(np.zeros(2))


@pytest.mark.parametrize("degrees", [20, 60, 90, 150])
def test_scaled_jacobian_of_a_rhombus_is_the_sine_of_its_angle(degrees):
    side = np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees))])
    mesh = blocks({"rhombus": [(0, 0), (1, 0), (side[0] + 1, side[1]), side]}, (2, 3))
    assert measure(mesh).scaled_jacobian == pytest.approx(np.full(6, np.sin(np.radians(degrees))))


def test_warp_is_the_height_of_the_corners_above_their_plane():
    height = 0.1
    mesh = blocks({"saddle": [(0, 0, height), (1, 0, -height), (1, 1, height), (0, 1, -height)]}, (1, 1))
    assert measure(mesh).warp == pytest.approx(np.full(1, height))


def test_the_worst_elements_are_named(plate):
    points = plate.points.copy()
    corner = plate.node_at((2.0, 1.0, 0.0))
    points[corner] += [0.1, 0.0, 0.1]
    mesh = Mesh(points, plate.elements)
    found = worst(mesh)
    assert {name: item.element for name, item in found.items()} == dict.fromkeys(
        ("scaled_jacobian", "aspect_ratio", "warp"), 7
    )
    assert found["scaled_jacobian"].value < 1
    assert found["aspect_ratio"].value > 1
    assert found["warp"].value > 0
