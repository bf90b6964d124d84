"""Blocks: areas, welding, groups, and blocks that do not fit together."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from isoparametric import area, quadrature

from magshell.errors import InputError, MeshError
from magshell.mesh import blocks

UNIT = [(0, 0), (1, 0), (1, 1), (0, 1)]
NEXT = [(1, 0), (2, 0), (2, 1), (1, 1)]


def shoelace(corners):
    x, y = np.transpose(corners)
    return 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))


shift = st.floats(-0.2, 0.2)


@settings(max_examples=25, deadline=None)
@given(shifts=st.lists(st.tuples(shift, shift), min_size=6, max_size=6), n=st.tuples(*[st.integers(1, 4)] * 3))
def test_two_crooked_blocks_have_their_areas_and_share_a_side(shifts, n):
    grid = np.array([[i, j] for j in range(2) for i in range(3)], dtype=float) + shifts
    one, other = grid[[0, 1, 4, 3]], grid[[2, 5, 4, 1]]
    across, along, beyond = n
    mesh = blocks({"one": one, "other": other}, {"one": (across, along), "other": (along, beyond)})
    exact = {"one": shoelace(one), "other": shoelace(other)}
    areas = np.linalg.norm(quadrature(mesh)[1], axis=2).sum(axis=1)
    for name, value in exact.items():
        assert areas[mesh.elements_of(name)].sum() == pytest.approx(value, rel=1e-12), name
    assert len(mesh.elements_of("one")) == across * along
    assert len(mesh.elements_of("other")) == along * beyond
    assert len(mesh.parts) == 1
    shared = np.intersect1d(mesh.nodes_of("one"), mesh.nodes_of("other"))
    assert len(shared) == 2 * along + 1
    assert len(mesh.boundary_edges) == 2 * (across + along + beyond)
    assert (quadrature(mesh, 2)[1][:, :, 2] > 0).all()


def test_hollow_cross_quarter_is_one_part_of_the_right_area():
    corners = {
        "a": [(21, 0), (27, 0), (27, 11), (21, 5)],
        "b": [(16, 5), (21, 5), (27, 11), (16, 11)],
        "c": [(5, 5), (16, 5), (16, 11), (11, 11)],
        "d": [(5, 5), (11, 11), (11, 16), (5, 16)],
        "e": [(5, 16), (11, 16), (11, 27), (5, 21)],
        "f": [(0, 21), (5, 21), (11, 27), (0, 27)],
    }
    mesh = blocks(corners, (3, 3))
    assert len(mesh.parts) == 1
    assert area(mesh) == pytest.approx(sum(map(shoelace, corners.values())), rel=1e-12)
    assert mesh.groups == list(corners)
    shared = {
        (p, q)
        for p in corners
        for q in corners
        if p < q and len(np.intersect1d(mesh.nodes_of(p), mesh.nodes_of(q))) > 1
    }
    assert shared == {("a", "b"), ("b", "c"), ("c", "d"), ("d", "e"), ("e", "f")}


def test_blocks_around_a_corner_in_space():
    wall = [(1, 0, 0), (1, 0, 2), (1, 1, 2), (1, 1, 0)]
    mesh = blocks({"floor": UNIT, "wall": wall}, {"floor": (2, 3), "wall": (4, 3)})
    assert area(mesh) == pytest.approx(3.0, rel=1e-12)
    assert len(mesh.parts) == 1


def test_blocks_that_meet_at_a_side_whichever_way_they_face():
    """A fin on two plates, one of them upside down against the other."""
    fin = [(1, 0, 0), (1, 1, 0), (1, 1, 1), (1, 0, 1)]
    flat = [(*corner, 0) for corner in UNIT]
    over = [(*corner, 0) for corner in NEXT][::-1]
    mesh = blocks({"one": flat, "two": over, "fin": fin}, {"one": (2, 3), "two": (3, 3), "fin": (3, 1)})
    assert area(mesh) == pytest.approx(3.0, rel=1e-12)
    assert len(mesh.parts) == 1
    at = np.abs(mesh.points[:, [0, 2]] - [1, 0]).max(axis=1) < 1e-9
    for name in mesh.element_groups:
        assert np.isin(np.flatnonzero(at), mesh.nodes_of(name)).all(), name


def test_separate_blocks_are_separate_parts():
    mesh = blocks({"one": UNIT, "far": [(3, 0), (4, 0), (4, 1), (3, 1)]}, (2, 2))
    assert [part.tolist() for part in mesh.parts] == [[0, 1, 2, 3], [4, 5, 6, 7]]


@pytest.mark.parametrize(
    ("corners", "elements", "phrases"),
    [
        ({"one": UNIT, "two": NEXT}, {"one": (2, 3), "two": (2, 4)}, ["'one' and 'two'", "3 and 4", "equal"]),
        (
            {"one": UNIT, "two": [(1, 0), (2, 0), (2, 2), (1, 2)]},
            (2, 2),
            ["'one' and 'two'", "within", "Split 'two'"],
        ),
        ({"one": UNIT, "two": [(1, 0.5), (2, 0.5), (2, 2), (1, 2)]}, (2, 2), ["'one'", "'two'", "within"]),
        (
            {"one": UNIT, "two": [(0.5, 0.2), (2, 0.2), (2, 0.8), (0.5, 0.8)]},
            (2, 2),
            ["'one' and 'two' overlap"],
        ),
        ({"one": UNIT, "two": UNIT}, (2, 2), ["'one' and 'two' overlap"]),
        ({"one": UNIT, "two": NEXT[::-1]}, (2, 2), ["'two' runs clockwise", "counter-clockwise", "+X3"]),
        ({"one": [(0, 0), (1, 1), (1, 0), (0, 1)]}, (2, 2), ["'one' is not convex", "order"]),
        ({"one": [(0, 0), (1, 0), (0.2, 0.2), (0, 1)]}, (2, 2), ["'one' is not convex", "corner 3"]),
        ({"one": [(0, 0), (1, 0), (1, 0), (0, 1)]}, (2, 2), ["'one' is not convex"]),
        (
            {"one": UNIT, "two": NEXT, "fin": [(1, 0, 0), (1, 0, 1), (1, 1, 1), (1, 1, 0)]},
            {"one": (2, 2), "two": (2, 2), "fin": (2, 3)},
            ["'one' and 'fin'", "2 and 3", "equal"],
        ),
    ],
)
def test_blocks_that_do_not_fit_are_named(corners, elements, phrases):
    with pytest.raises(MeshError) as caught:
        blocks(corners, elements)
    for phrase in phrases:
        assert phrase in str(caught.value), str(caught.value)


@pytest.mark.parametrize(
    ("corners", "elements", "phrases"),
    [
        ({}, (1, 1), ["corners = {}"]),
        ({"one": UNIT[:3]}, (1, 1), ["block 'one'", "four positions"]),
        ({"one": [(0, 0), (1, 0), (1, np.nan), (0, 1)]}, (1, 1), ["block 'one'", "finite"]),
        ({"one": UNIT}, (1, 0), ["elements of block 'one' = (1, 0)", "at least 1"]),
        ({"one": UNIT}, {"ona": (1, 1)}, ["'ona'", "Did you mean 'one'"]),
        ({"one": UNIT, "two": NEXT}, {"one": (1, 1)}, ["block 'two'", "no number of elements"]),
    ],
)
def test_blocks_name_what_is_missing(corners, elements, phrases):
    with pytest.raises(InputError) as caught:
        blocks(corners, elements)
    for phrase in phrases:
        assert phrase in str(caught.value), str(caught.value)
