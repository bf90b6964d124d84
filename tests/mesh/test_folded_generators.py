"""Profiles and Miura-ori: areas, groups, joints, creases, and what they refuse."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from isoparametric import area, edge_lengths, quadrature

from magshell.errors import InputError, MeshError
from magshell.mesh import miura, profile
from magshell.mesh.edges import find_edges
from magshell.mesh.geometry import centres, diagonal_normals, unit
from magshell.mesh.junctions import junctions_of

SQUARE = {"a": (0, 0), "b": (2, 0), "c": (2, 1), "d": (0, 1)}
ROUND = {"south": ("a", "b"), "east": ("b", "c"), "north": ("c", "d"), "west": ("d", "a")}
SECTIONS = {
    "L": ({"foot": (0, 0), "knee": (2, 0), "tip": (2, 1)}, {"post": ("foot", "knee"), "arm": ("tip", "knee")}),
    "Z": (
        {"a": (0, 0), "b": (1, 0), "c": (1, 2), "d": (2, 2)},
        {"low": ("a", "b"), "web": ("b", "c"), "high": ("c", "d")},
    ),
    "T": (
        {"a": (0, 0), "b": (1, 0), "c": (2, 0), "d": (1, -1)},
        {"left": ("a", "b"), "right": ("c", "b"), "web": ("b", "d")},
    ),
    "box": (SQUARE, ROUND),
    "two cells": (
        SQUARE | {"e": (3, 0), "f": (3, 1)},
        ROUND | {"bottom": ("b", "e"), "side": ("e", "f"), "top": ("f", "c")},
    ),
}


@pytest.mark.parametrize("name", SECTIONS)
def test_profiles_have_their_areas_groups_and_joints(name):
    points, walls = SECTIONS[name]
    mesh = profile(points, walls, 3.0, (2, 4), {next(iter(walls)): 3})
    wide = {wall: np.linalg.norm(np.subtract(points[one], points[other])) for wall, (one, other) in walls.items()}
    areas = np.linalg.norm(quadrature(mesh)[1], axis=2).sum(axis=1)
    for wall, width in wide.items():
        assert areas[mesh.elements_of(wall)].sum() == pytest.approx(3 * width, rel=1e-12), wall
    assert len(mesh.elements) == 4 * (2 * len(walls) + 1)
    assert list(mesh.element_groups) == list(walls)
    assert list(mesh.edge_groups) == [*points, "start", "end"]
    assert len(mesh.parts) == 1
    sharing = {point: sum(point in pair for pair in walls.values()) for point in points}
    for point, place in points.items():
        nodes = mesh.nodes_of(point)
        assert mesh.points[nodes, :2] == pytest.approx(np.tile(np.array(place, dtype=float), (9, 1))), point
        assert edge_lengths(mesh, mesh.edge_groups[point]).sum() == pytest.approx(3.0)
        for wall, pair in walls.items():
            assert np.isin(nodes, mesh.nodes_of(wall)).all() == (point in pair), "watertight"
    for end, height in (("start", 0.0), ("end", 3.0)):
        assert edge_lengths(mesh, mesh.edge_groups[end]).sum() == pytest.approx(sum(wide.values()))
        assert (mesh.points[mesh.nodes_of(end), 2] == height).all()
    free = sum(8 // 2 for point in points if sharing[point] == 1)
    assert len(mesh.boundary_edges) == free + 2 * (2 * len(walls) + 1)
    found = junctions_of(mesh)
    assert sorted(line.groups for line in found.joints) == sorted((point,) for point in points if sharing[point] > 2)
    assert all(line.groups[0] in points for line in found.kinks)


def test_a_section_walked_like_a_circle_faces_outward():
    at, areas = quadrature(profile(SQUARE, ROUND, 1.0, (2, 2)), 2)
    assert (((at - [1.0, 0.5, 0.5]) * areas).sum(axis=2) > 0).all()


def test_axis_and_first_direction_place_the_section():
    mesh = profile({"a": (0, 0), "b": (2, 1)}, {"wall": ("a", "b")}, 3.0, (1, 1), axis=(0, 2, 0), first=(5, 1, 0))
    assert mesh.points[mesh.nodes_of("b")] == pytest.approx(np.array([[2, 0, -1], [2, 1.5, -1], [2, 3, -1]]))


@pytest.mark.parametrize(
    ("change", "phrases"),
    [
        ({"points": {"a": (0, 0)}}, ["points", "two names or more"]),
        ({"points": SQUARE | {"a": (0, 0, 0)}}, ["point 'a'", "two finite coordinates"]),
        ({"points": SQUARE | {"a": (0, np.nan)}}, ["point 'a'", "two finite coordinates"]),
        ({"points": SQUARE | {"z": (5, 5)}}, ["no wall joins point 'z'"]),
        ({"points": SQUARE | {"a": (2, 0)}}, ["'a' and 'b' lie on each other"]),
        ({"walls": {}}, ["walls = {}"]),
        ({"walls": ROUND | {"east": ("b", "b")}}, ["wall 'east' must join two points"]),
        ({"walls": ROUND | {"east": "bc"}}, ["wall 'east' must join two points"]),
        ({"walls": ROUND | {"east": ("b", "cc")}}, ["wall 'east' joins 'cc'", "There is: a, b, c, d"]),
        ({"walls": ROUND | {"again": ("b", "a")}}, ["'south' and 'again' join the same two points"]),
        ({"walls": ROUND | {"one": ("a", "c"), "other": ("b", "d")}}, ["'one' and 'other' cross"]),
        ({"walls": ROUND | {"a": ("a", "c")}}, ["'a' is the name of a point and of a wall"]),
        ({"walls": ROUND | {"end": ("a", "c")}}, ["'end' is the name of an end"]),
        (
            {"points": SQUARE | {"m": (1, 0), "n": (1, 2)}, "walls": ROUND | {"rib": ("m", "n")}},
            ["'m' lies within wall 'south'", "split"],
        ),
        ({"length": 0}, ["length = 0", "positive"]),
        ({"elements": (0, 1)}, ["elements = (0, 1)"]),
        ({"divided": {"nort": 2}}, ["'nort' is divided, but is no wall", "'north'"]),
        ({"divided": {"north": 0}}, ["elements of wall 'north' = 0", "at least 1"]),
        ({"first": (0, 0, 1)}, ["first = (0, 0, 1)", "along axis"]),
    ],
)
def test_profiles_name_what_is_wrong(change, phrases):
    with pytest.raises(InputError) as caught:
        profile(**({"points": SQUARE, "walls": ROUND, "length": 1.0, "elements": (1, 1)} | change))
    assert str(caught.value).startswith("profile: ")
    for phrase in phrases:
        assert phrase in str(caught.value), str(caught.value)


def test_walls_that_fold_back_are_refused():
    points = {"a": (0, 0), "b": (1, 0), "c": (0.5, 1e-5)}
    with pytest.raises(MeshError, match="lie on each other: at their common edge"):
        profile(points, {"there": ("a", "b"), "back": ("b", "c")}, 1.0, (3, 1))


folds = st.floats(1.0, 85.0) | st.just(0.0)


@settings(max_examples=20, deadline=None)
@given(b=st.floats(0.5, 2), a=st.floats(0.5, 2), sector=st.floats(20, 85), fold=folds, n=st.integers(1, 3))
def test_miura_panels_are_rigid(b, a, sector, fold, n):
    """Every panel is the same flat parallelogram in every folded state; creases and rims have their lengths."""
    mesh = miura((b, a), sector, fold, (2, 1), (n, 2))
    angle = np.radians(sector)
    areas = np.linalg.norm(quadrature(mesh, 2)[1], axis=2).sum(axis=1)
    assert list(mesh.element_groups) == [f"panel-{i}-{j}" for j in (1, 2) for i in (1, 2, 3, 4)]
    for name, members in mesh.element_groups.items():
        assert areas[members].sum() == pytest.approx(a * b * np.sin(angle), rel=1e-9), name
        assert len(members) == 2 * n
        normals = unit(diagonal_normals(mesh.points[mesh.elements[members]]))
        assert normals == pytest.approx(np.tile(normals[0], (2 * n, 1))), name
        assert normals[0, 2] == pytest.approx(np.cos(np.radians(fold))), name
    creases = sum(edge_lengths(mesh, mesh.edge_groups[name]).sum() for name in ("mountain", "valley"))
    assert creases == pytest.approx(6 * a + 4 * b)
    for name, length in (("left", 2 * a), ("right", 2 * a), ("bottom", 4 * b), ("top", 4 * b)):
        assert edge_lengths(mesh, mesh.edge_groups[name]).sum() == pytest.approx(length), name
    grouped = np.concatenate([mesh.edge_groups[name] for name in ("left", "right", "bottom", "top")])
    assert sorted(map(tuple, grouped.tolist())) == sorted(map(tuple, mesh.boundary_edges.tolist()))
    corner = mesh.points[[mesh.node_at(p) for p in (mesh.points[0], mesh.points[mesh.elements[n - 1, 1]])]]
    assert np.linalg.norm(corner[1] - corner[0]) == pytest.approx(b)


def test_mountains_are_ridges_and_valleys_grooves():
    """The two elements at a crease lie below it, seen from the side of the normals, or above."""
    mesh = miura((1.0, 1.3), 55, 35, (2, 2), (2, 1))
    edges = find_edges(mesh.elements)
    one, other = edges.pairs
    normals, middle = diagonal_normals(mesh.points[mesh.elements]), mesh.points[edges.sides[one, 2]]
    centre = centres(mesh.points, mesh.elements)
    rise = (
        (0.5 * (centre[one // 4] + centre[other // 4]) - middle) * unit(normals[one // 4] + normals[other // 4])
    ).sum(axis=1)
    for name, sign in (("mountain", -1), ("valley", 1)):
        at = np.isin(edges.sides[one, 2], mesh.edge_groups[name][:, 2])
        assert (sign * rise[at] > 0.05).all(), name
    creased = np.abs(rise) > 1e-9
    assert creased.sum() == len(mesh.edge_groups["mountain"]) + len(mesh.edge_groups["valley"])
    flat = miura((1.0, 1.3), 55, 0, (2, 2), (2, 1))
    for name in ("mountain", "valley"):
        assert flat.edge_groups[name].tolist() == mesh.edge_groups[name].tolist(), "the same when flat"


def test_a_vertex_has_three_creases_of_one_kind():
    mesh = miura((1, 1), 60, 40, (1, 1), (1, 1))
    assert sorted(len(mesh.edge_groups[name]) for name in ("mountain", "valley")) == [1, 3]


@pytest.mark.parametrize(
    ("change", "phrases"),
    [
        ({"sides": (1, 0)}, ["sides = 0", "positive"]),
        ({"sides": 1.0}, ["sides = 1.0", "two lengths"]),
        ({"sector": 90}, ["sector = 90", "between 0 and 90"]),
        ({"fold": 90}, ["fold = 90", "between 0 and 90"]),
        ({"fold": -1}, ["fold = -1", "between 0 and 90"]),
        ({"cells": (0, 1)}, ["cells = (0, 1)", "at least 1"]),
        ({"elements": (1,)}, ["elements = (1,)", "two whole numbers"]),
    ],
)
def test_miura_names_what_is_wrong(change, phrases):
    with pytest.raises(InputError) as caught:
        miura(**({"sides": (1, 1), "sector": 60, "fold": 30, "cells": (1, 1), "elements": (1, 1)} | change))
    assert str(caught.value).startswith("miura: ")
    for phrase in phrases:
        assert phrase in str(caught.value), str(caught.value)


def test_panels_folded_together_are_refused():
    with pytest.raises(MeshError, match="lie on each other"):
        miura((1, 1), 60, 89.99, (1, 1), (1, 1))


def test_areas_add_up():
    assert area(profile(*SECTIONS["two cells"], 2.0, (1, 1))) == pytest.approx(2 * 9)
