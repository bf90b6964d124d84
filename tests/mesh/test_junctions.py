"""Lines at which sheets meet, and what `magshell check` says of them."""

from __future__ import annotations

import numpy as np
import pytest
from bands import moebius

from magshell.mesh import Mesh, annulus, blocks, cylinder, miura, profile, rectangle, sphere_patch
from magshell.mesh.junctions import junctions_of
from magshell.mesh.welding import weld
from magshell.problem.junction_report import lines

TURNED = [0, 3, 2, 1, 7, 6, 5, 4]


def bent(angle, elements=(2, 3)):
    """An L of two unit squares whose surface turns by so many degrees at the line X1 = 1."""
    along = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    return profile(
        {"foot": (0, 0), "knee": (1, 0), "tip": (1 + along[0], along[1])},
        {"post": ("foot", "knee"), "arm": ("knee", "tip")},
        1.0,
        elements,
    )


@pytest.mark.parametrize("angle", [-150.0, -31.0, 31.0, 90.0, 179.0])
@pytest.mark.parametrize("upside_down", [False, True])
def test_a_kink_by_its_angle_whichever_side_is_up(angle, upside_down):
    mesh = bent(angle)
    rows = mesh.elements.copy()
    arm = mesh.elements_of("arm")
    if upside_down:
        rows[arm] = rows[arm][:, TURNED]
    found = junctions_of(Mesh(mesh.points, rows, mesh.element_groups, mesh.edge_groups))
    (kink,) = found.kinks
    assert np.degrees(kink.angle) == pytest.approx(abs(angle), abs=1e-9)
    assert kink.groups == ("knee",)
    assert not kink.closed
    assert kink.nodes.tolist() == mesh.nodes_of("knee").tolist()
    assert (kink.edges[1:, 0] == kink.edges[:-1, 1]).all(), "in a row"
    assert len(found.flips) == upside_down
    assert not found.joints


@pytest.mark.parametrize("angle", [0.0, 29.0, -29.0])
def test_a_small_angle_is_no_kink(angle):
    found = junctions_of(bent(angle))
    assert found == ([], [], [])


@pytest.mark.parametrize(
    "mesh",
    [rectangle(1, 1, (2, 2)), cylinder(1, 1, (4, 2)), sphere_patch(1, (30, 150), (0, 360), (3, 4))],
    ids=["flat", "coarse tube", "coarse zone"],
)
def test_smooth_surfaces_have_none(mesh):
    """Elements of 90 degrees too: their normals at the edges are those of the quadratic surface."""
    assert junctions_of(mesh) == ([], [], [])


def test_a_kink_around_a_tube_is_a_loop():
    """A tube and the flat ring that continues it inward."""
    tube, ring = cylinder(1, 1, (8, 2)), annulus(0.5, 1, (2, 8))
    points = np.concatenate([tube.points, ring.points])
    points, rows = weld(points, np.concatenate([tube.elements, ring.elements + len(tube.points)]), 1e-9)
    (loop,) = junctions_of(Mesh(points, rows)).kinks
    assert loop.closed
    assert len(loop.edges) == 8
    assert np.degrees(loop.angle) == pytest.approx(90, abs=1e-9)


def test_joints_end_where_they_branch():
    """A cross of four walls on a floor: one joint of four, and the floor's joints of three that meet in the middle."""
    floor = {
        f"floor{i}{j}": [(i, j, 0), (i + 1, j, 0), (i + 1, j + 1, 0), (i, j + 1, 0)] for i in (-1, 0) for j in (-1, 0)
    }
    ways = {"east": (1, 0), "north": (0, 1), "west": (-1, 0), "south": (0, -1)}
    walls = {name: [(0, 0, 0), (x, y, 0), (x, y, 1), (0, 0, 1)] for name, (x, y) in ways.items()}
    found = junctions_of(blocks(floor | walls, (2, 2)))
    assert not found.kinks
    ends = sorted(tuple(line.edges[[0, -1], [0, 1]].tolist()) for line in found.joints)
    assert len(ends) == 5
    assert len({node for pair in ends for node in pair}) == 6
    assert all(len(line.edges) == 2 for line in found.joints)


def test_a_moebius_band_flips_once():
    found = junctions_of(moebius(16, 2))
    assert not found.kinks
    (line,) = found.flips
    assert len(line.edges) == 2


def test_lines_end_where_names_change():
    creases = junctions_of(miura((1, 1), 60, 40, (2, 1), (2, 2))).kinks
    assert {line.groups for line in creases} == {("mountain",), ("valley",)}
    assert all(len(line.edges) == 2 for line in creases)
    # Three parallel zigzags of one cell pair: 4 panels wide, 2 deep, so 3 · 2 straight creases and one zigzag of 4.
    assert len(creases) == 10


def test_what_check_says():
    mesh = profile(
        {"a": (0, 0), "b": (1, 0), "c": (2, 0), "d": (1, 1), "e": (2, 1)},
        {"left": ("a", "b"), "right": ("b", "c"), "rib": ("b", "d"), "cap": ("d", "e")},
        2.0,
        (2, 3),
    )
    assert dict(lines(mesh)) == {
        "kinks": "1 line, 7 nodes, 90°: d, from (1 m, 1 m, 0) to (1 m, 1 m, 2 m)",
        "joints of three or more": "1 line, 7 nodes: b, from (1 m, 0, 0) to (1 m, 0, 2 m)",
    }
    unnamed = Mesh(mesh.points, mesh.elements)
    assert "no group, from (1 m, 0, 0) to (1 m, 0, 2 m)" in dict(lines(unnamed))["joints of three or more"]
    assert not list(lines(rectangle(1, 1, (2, 2))))
