"""Generated meshes: areas, normals, welding, groups, and what the generators refuse."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from isoparametric import area, edge_lengths, quadrature

from magshell.errors import InputError
from magshell.mesh import annulus, cylinder, rectangle, sphere_patch

lengths = st.floats(1e-3, 1e3)
counts = st.integers(1, 5)


def characteristic(mesh):
    """Euler's number: corners minus edges plus elements."""
    edges = (4 * len(mesh.elements) + len(mesh.boundary_edges)) // 2
    return len(mesh.corner_nodes) - edges + len(mesh.elements)


def assert_node_count(mesh):
    """Every edge has one middle of its own, so the nodes are the corners and the edges."""
    edges = (4 * len(mesh.elements) + len(mesh.boundary_edges)) // 2
    assert len(mesh.points) == len(mesh.corner_nodes) + edges


def assert_groups_cover_the_boundary(mesh):
    grouped = np.concatenate([mesh.edge_groups[name] for name in mesh.edge_groups])
    found = sorted(map(tuple, grouped.tolist()))
    assert found == sorted(map(tuple, mesh.boundary_edges.tolist()))


@settings(max_examples=25, deadline=None)
@given(length=lengths, ratio=st.floats(0.05, 20), n=counts, m=counts)
def test_rectangle_has_its_area_sides_and_normal(length, ratio, n, m):
    mesh = rectangle(length, length * ratio, (n, m))
    assert len(mesh.elements) == n * m
    assert area(mesh) == pytest.approx(length * length * ratio, rel=1e-12)
    normals = quadrature(mesh, 2)[1]
    assert (normals[:, :, 2] > 0).all()
    assert (normals[:, :, :2] == 0).all()
    assert_groups_cover_the_boundary(mesh)
    assert_node_count(mesh)
    for name, axis, value in [
        ("left", 0, 0),
        ("right", 0, length),
        ("bottom", 1, 0),
        ("top", 1, length * ratio),
    ]:
        at = mesh.points[mesh.nodes_of(name), axis]
        assert at == pytest.approx(np.full(len(at), value)), name
    assert edge_lengths(mesh, mesh.edge_groups["top"]).sum() == pytest.approx(length)
    assert edge_lengths(mesh, mesh.edge_groups["left"]).sum() == pytest.approx(length * ratio)


def test_rectangle_numbers_its_elements_along_x1_first():
    mesh = rectangle(3.0, 2.0, (3, 2))
    centres = mesh.points[mesh.elements[:, :4]].mean(axis=1)
    expected = [(i + 0.5, j + 0.5, 0) for j in range(2) for i in range(3)]
    assert centres == pytest.approx(np.array(expected))


def test_middles_of_a_rectangle_follow_its_corners():
    mesh = rectangle(3.0, 2.0, (3, 2))
    corners, middles = mesh.points[mesh.elements[:, :4]], mesh.points[mesh.elements[:, 4:]]
    assert middles == pytest.approx(0.5 * (corners + np.roll(corners, -1, axis=1)))


@settings(max_examples=25, deadline=None)
@given(
    inner=lengths,
    ratio=st.floats(1.1, 20),
    across=counts,
    around=st.integers(3, 9),
    start=st.floats(-180, 180),
    span=st.floats(20, 300) | st.just(360.0),
    slit=st.booleans(),
)
def test_annulus_is_flat_round_and_named(inner, ratio, across, around, start, span, slit):
    outer, slit = inner * ratio, slit and span == 360
    mesh = annulus(inner, outer, (across, around), (start, start + span), slit=slit)
    assert (mesh.points[:, 2] == 0).all()
    normals = quadrature(mesh, 2)[1]
    assert (normals[:, :, 2] > 0).all()
    radius = np.hypot(*mesh.points[:, :2].T)
    closed = span == 360 and not slit
    assert characteristic(mesh) == (0 if closed else 1)
    assert len(mesh.boundary_edges) == 2 * around + (0 if closed else 2 * across)
    assert_groups_cover_the_boundary(mesh)
    assert_node_count(mesh)
    assert radius[mesh.nodes_of("inner")] == pytest.approx(inner, rel=1e-12)
    assert radius[mesh.nodes_of("outer")] == pytest.approx(outer, rel=1e-12)
    assert ("start" in mesh.groups) != closed
    if not closed:
        gap = 0.0
        for name, turn in (("start", start), ("stop", start + span)):
            nodes = mesh.nodes_of(name)
            ray = radius[nodes, None] * [[math.cos(math.radians(turn)), math.sin(math.radians(turn))]]
            gap = np.abs(mesh.points[nodes, :2] - ray).max() / radius[nodes].max()
            if name == "start" or not slit:
                assert gap < 1e-9, (name, gap)
        assert not slit or 0 < gap < 2.1e-3 * 2 * math.pi / around + 6e-6 * ratio, gap


def test_annulus_numbers_across_first_and_turns_from_x1_to_x2():
    mesh = annulus(1.0, 3.0, (2, 1), angle=(0, 90))
    corners = mesh.points[mesh.elements[:, :4], :2]
    assert corners[0] == pytest.approx(np.array([[1, 0], [2, 0], [0, 2], [0, 1]]))
    assert corners[1] == pytest.approx(np.array([[2, 0], [3, 0], [0, 3], [0, 2]]))


vectors = st.tuples(*[st.floats(-1, 1)] * 3).filter(lambda v: np.linalg.norm(v) > 0.1)


@settings(max_examples=25, deadline=None)
@given(
    radius=lengths,
    ratio=st.floats(0.1, 10),
    around=st.integers(3, 9),
    along=counts,
    start=st.floats(-180, 180),
    span=st.floats(20, 300) | st.just(360.0),
    axis=vectors,
    zero=vectors,
)
def test_cylinder_lies_on_its_surface_with_the_normal_outward(radius, ratio, around, along, start, span, axis, zero):
    e3 = np.array(axis) / np.linalg.norm(axis)
    e1 = np.array(zero) - (np.array(zero) @ e3) * e3
    assume(np.linalg.norm(e1) > 1e-2)
    mesh = cylinder(radius, radius * ratio, (around, along), (start, start + span), axis, zero)
    height = mesh.points @ e3
    away = mesh.points - height[:, None] * e3
    assert np.linalg.norm(away, axis=1) == pytest.approx(np.full(len(away), radius), rel=1e-12)
    assert height.min() == pytest.approx(0, abs=1e-12 * mesh.size)
    assert height.max() == pytest.approx(radius * ratio)
    at, areas = quadrature(mesh, 3)
    outward = ((at - (at @ e3)[:, :, None] * e3) * areas).sum(axis=2)
    assert (outward > 0).all()
    whole = "angle-start" not in mesh.groups
    assert whole == (span == 360)
    assert characteristic(mesh) == (0 if whole else 1)
    assert len(mesh.boundary_edges) == 2 * around + (0 if whole else 2 * along)
    assert_groups_cover_the_boundary(mesh)
    assert_node_count(mesh)
    assert mesh.points[mesh.nodes_of("start")] @ e3 == pytest.approx(0, abs=1e-9 * mesh.size)
    assert mesh.points[mesh.nodes_of("end")] @ e3 == pytest.approx(radius * ratio)
    if not whole:
        for name, turn in (("angle-start", start), ("angle-stop", start + span)):
            towards = np.cos(np.radians(turn)) * e1 + np.sin(np.radians(turn)) * np.cross(e3, e1)
            towards *= radius / np.linalg.norm(e1)
            gap = np.abs(away[mesh.nodes_of(name)] - towards).max()
            assert gap < 1e-9 * mesh.size, (name, gap)


def test_whole_tube_closes_from_any_start_and_carries_no_seam():
    mesh = cylinder(0.01, 0.03, (8, 3), angle=(0.1, 360.1))
    assert mesh.groups == ["start", "end"]
    assert len(mesh.parts) == 1
    assert characteristic(mesh) == 0


def test_angle_zero_and_the_sense_of_turning():
    mesh = cylinder(2.0, 1.0, (1, 1), angle=(0, 90), axis=(0, 1, 0), zero=(0, 0, 1))
    first, second = mesh.points[mesh.elements[0, :2]]
    assert first == pytest.approx(np.array([0, 0, 2.0]))
    assert second == pytest.approx(np.array([2.0, 0, 0]))


@settings(max_examples=25, deadline=None)
@given(
    radius=lengths,
    polar=st.tuples(st.floats(5, 80), st.floats(100, 175)),
    start=st.floats(-180, 180),
    span=st.floats(20, 300) | st.just(360.0),
    along=st.integers(2, 5),
    around=st.integers(3, 6),
)
def test_sphere_patch_lies_on_its_surface_with_the_normal_outward(radius, polar, start, span, along, around):
    mesh = sphere_patch(radius, polar, (start, start + span), (along, around))
    distance = np.linalg.norm(mesh.points, axis=1)
    assert distance == pytest.approx(np.full(len(distance), radius), rel=1e-12)
    at, areas = quadrature(mesh, 3)
    assert ((at * areas).sum(axis=2) > 0).all()
    whole = "left" not in mesh.groups
    assert whole == (span == 360)
    assert characteristic(mesh) == (0 if whole else 1)
    assert len(mesh.boundary_edges) == 2 * around + (0 if whole else 2 * along)
    assert_groups_cover_the_boundary(mesh)
    assert_node_count(mesh)
    for name, angle in zip(("top", "bottom"), polar, strict=True):
        height = mesh.points[mesh.nodes_of(name), 2]
        assert height == pytest.approx(radius * math.cos(math.radians(angle)), rel=1e-9, abs=1e-12 * radius), name


def test_sphere_patch_puts_left_at_the_first_azimuth():
    mesh = sphere_patch(2.0, (30, 150), (-15, 15), (4, 2))
    left, right = mesh.points[mesh.nodes_of("left")], mesh.points[mesh.nodes_of("right")]
    assert np.arctan2(left[:, 1], left[:, 0]) == pytest.approx(np.full(9, -math.radians(15)))
    assert np.arctan2(right[:, 1], right[:, 0]) == pytest.approx(np.full(9, math.radians(15)))


@pytest.mark.parametrize(
    ("make", "exact"),
    [
        (lambda n: annulus(2.0, 3.0, (n, 3 * n)), 5 * math.pi),
        (lambda n: cylinder(2.0, 3.0, (3 * n, n)), 2 * math.pi * 2 * 3),
        (lambda n: cylinder(2.0, 3.0, (2 * n, n), angle=(-30, 110)), math.radians(140) * 2 * 3),
        (
            lambda n: sphere_patch(2.0, (20, 130), (-30, 60), (2 * n, 2 * n)),
            4 * math.radians(90) * (math.cos(math.radians(20)) - math.cos(math.radians(130))),
        ),
        (
            lambda n: sphere_patch(2.0, (20, 90), (0, 360), (2 * n, 6 * n)),
            4 * math.radians(360) * math.cos(math.radians(20)),
        ),
    ],
    ids=["ring", "tube", "sector", "patch", "zone"],
)
def test_area_converges_at_fourth_order(make, exact):
    errors = [abs(area(make(n)) / exact - 1) for n in (2, 4, 8, 16)]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert abs(orders[-1] - 4) < 0.1, f"errors {errors}, orders {orders}"


@pytest.mark.parametrize(
    ("call", "phrases"),
    [
        (lambda: rectangle(-1, 1, (1, 1)), ["rectangle: length = -1", "positive"]),
        (lambda: rectangle(1, math.nan, (1, 1)), ["rectangle: width = nan", "positive"]),
        (lambda: rectangle(1, "2 mm", (1, 1)), ["rectangle: width = '2 mm'", "positive"]),
        (lambda: rectangle(1, 1, (0, 1)), ["rectangle: elements = (0, 1)", "at least 1"]),
        (lambda: rectangle(1, 1, (1.5, 1)), ["rectangle: elements = (1.5, 1)", "whole"]),
        (lambda: rectangle(1, 1, 4), ["rectangle: elements = 4", "two whole numbers"]),
        (lambda: annulus(0, 1, (1, 4)), ["annulus: inner_radius = 0", "positive"]),
        (lambda: annulus(1, 0.5, (1, 4)), ["annulus: outer_radius = 0.5", "exceed inner_radius = 1"]),
        (lambda: annulus(1, 2, (0, 4)), ["annulus: elements = (0, 4)", "at least 1"]),
        (lambda: annulus(1, 2, (1, 2)), ["annulus: elements = 2", "angle", "at least 3 elements"]),
        (lambda: annulus(1, 2, (1, 4), angle=(0, 400)), ["annulus: angle = (0, 400)", "at most 360"]),
        (lambda: annulus(1, 2, (1, 4), angle=(0, 90), slit=True), ["slit is for a whole ring", "(0, 90)"]),
        (lambda: cylinder(0, 1, (4, 1)), ["cylinder: radius = 0", "positive"]),
        (lambda: cylinder(1, math.inf, (4, 1)), ["cylinder: length = inf", "positive"]),
        (lambda: cylinder(1, 1, (4, 1), angle=(0, 361)), ["cylinder: angle = (0, 361)", "at most 360"]),
        (lambda: cylinder(1, 1, (4, 1), angle=(90, 90)), ["cylinder: angle = (90, 90)", "below the stop"]),
        (lambda: cylinder(1, 1, (4, 1), angle=(0,)), ["cylinder: angle = (0,)", "two numbers, in degrees"]),
        (lambda: cylinder(1, 1, (4, 1), angle=(0, math.nan)), ["cylinder: angle = (0, nan)", "in degrees"]),
        (lambda: cylinder(1, 1, (2, 1)), ["cylinder: elements = 2", "angle", "at least 3 elements"]),
        (lambda: cylinder(1, 1, (4, 1), axis=(0, 0, 0)), ["cylinder: axis = (0, 0, 0)", "not all zero"]),
        (lambda: cylinder(1, 1, (4, 1), zero=(1, 0)), ["cylinder: zero = (1, 0)", "three numbers"]),
        (
            lambda: cylinder(1, 1, (4, 1), axis=(1, 0, 0)),
            ["cylinder: zero = (1.0, 0.0, 0.0)", "axis = (1, 0, 0)"],
        ),
        (lambda: sphere_patch(-1, (10, 20), (0, 9), (1, 1)), ["sphere_patch: radius = -1", "positive"]),
        (
            lambda: sphere_patch(1, (-5, 20), (0, 9), (1, 1)),
            ["sphere_patch: polar = (-5, 20)", "from 0", "180"],
        ),
        (lambda: sphere_patch(1, (10, 200), (0, 9), (2, 1)), ["sphere_patch: polar = (10, 200)", "to 180"]),
        (
            lambda: sphere_patch(1, (20, 10), (0, 9), (1, 1)),
            ["sphere_patch: polar = (20, 10)", "below the stop"],
        ),
        (lambda: sphere_patch(1, (0, 90), (0, 9), (1, 1)), ["polar = (0, 90)", "pole", "(1, 90)"]),
        (lambda: sphere_patch(1, (90, 180), (0, 9), (1, 1)), ["polar = (90, 180)", "pole", "(90, 179)"]),
        (lambda: sphere_patch(1, (10, 20), (0, 400), (1, 4)), ["azimuth = (0, 400)", "at most 360"]),
        (lambda: sphere_patch(1, (10, 20), (9, 0), (1, 4)), ["azimuth = (9, 0)", "below the stop"]),
        (lambda: sphere_patch(1, (10, 20), (0, 180), (1, 1)), ["azimuth = (0, 180)", "at least 2 elements"]),
    ],
)
def test_generators_name_the_argument_its_value_and_what_is_allowed(call, phrases):
    with pytest.raises(InputError) as caught:
        call()
    for phrase in phrases:
        assert re.search(re.escape(phrase), str(caught.value)), str(caught.value)
