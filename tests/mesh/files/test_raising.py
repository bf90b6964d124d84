"""First order raised to second: how near the middles come to the surface that the elements stand for."""

from __future__ import annotations

import numpy as np
import pytest
from bands import moebius

import magshell as ms
from magshell.mesh import Mesh
from magshell.mesh.edges import SIDES, edge_keys
from magshell.mesh.files.orientation import TURNED_QUAD, agreeing
from magshell.mesh.files.raising import raise_order
from magshell.mesh.junctions import junctions_of
from magshell.mesh.welding import weld

from .same import first_order

KINDS = {"quadrilaterals": False, "triangles": True}


def off_cylinder(points):
    return np.abs(np.hypot(points[:, 0], points[:, 1]) - 1.0)


def off_sphere(points):
    return np.abs(np.linalg.norm(points, axis=1) - 1.0)


def twisted(points):
    """Points of a unit tube, moved along it and around so that the elements are askew and of unequal size."""
    turn = np.arctan2(points[:, 1], points[:, 0]) + 0.3 * points[:, 2] + 0.1 * points[:, 2] * np.sin(5 * points[:, 2])
    return np.stack([np.cos(turn), np.sin(turn), points[:, 2] + 0.2 * np.sin(2 * turn)], axis=1)


SURFACES = {
    "tube": (lambda n: ms.mesh.cylinder(1, 1, (3 * n, n)), off_cylinder),
    "sector": (lambda n: ms.mesh.cylinder(1, 1, (n, n), angle=(20, 120)), off_cylinder),
    "skew sector": (lambda n: ms.mesh.cylinder(1, 1, (n, n), angle=(0, 120)), off_cylinder),
    "sphere": (lambda n: ms.mesh.sphere_patch(1, (30, 120), (0, 100), (n, n)), off_sphere),
}


def worst(surface, n, triangles):
    """Largest distance of a new middle, and of the middle of a chord, from the surface of radius 1."""
    make, off = SURFACES[surface]
    points, rows = first_order(make(n), triangles)
    points = twisted(points) if surface.startswith("skew") else points
    raised = raise_order(points, rows)
    sides = raised.rows[:, SIDES].reshape(-1, 3)
    sides = sides[sides[:, 0] != sides[:, 1]]
    assert raised.creases == 0
    return off(raised.points[sides[:, 2]]).max(), off(raised.points[sides[:, :2]].mean(axis=1)).max()


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("surface", SURFACES)
def test_fourth_order_on_cylinder_and_sphere(surface, kind):
    """The distance falls 16-fold when elements are halved, at free edges too (or is none); a chord's falls 4-fold."""
    coarse, fine = (worst(surface, n, KINDS[kind]) for n in (8, 16))
    order = np.log2(coarse[0] / fine[0])
    chords = np.log2(coarse[1] / fine[1])
    print(f"{surface}, {kind}: {fine[0]:.2e} (chord {fine[1]:.2e}), orders {order:.2f} and {chords:.2f}")
    assert order > 3.7 or coarse[0] < 1e-14
    assert 1.8 < chords < 2.2
    assert fine[0] < 0.02 * fine[1]


@pytest.mark.parametrize("kind", KINDS)
def test_flat_pieces_stay_straight(kind):
    """A plate, and a plate folded sharply or by 20 degrees: every middle is half-way, round-off apart."""
    for angle in (0, 20, 90):
        mesh = ms.mesh.rectangle(2.0, 1.0, (8, 4))
        points, rows = first_order(mesh, KINDS[kind])
        beyond = points[:, 0] > 1.0
        along = points[beyond, 0] - 1.0
        points[beyond, 0], points[beyond, 2] = (
            1.0 + along * np.cos(np.radians(angle)),
            along * np.sin(np.radians(angle)),
        )
        raised = raise_order(points, rows)
        assert raised.curved == 0, angle
        assert raised.creases == (4 if angle else 0)
        sides = raised.rows[:, SIDES].reshape(-1, 3)
        half = 0.5 * (raised.points[sides[:, 0]] + raised.points[sides[:, 1]])
        assert np.array_equal(raised.points[sides[:, 2]], half)


def test_the_rim_of_a_tube_stays_in_its_plane():
    """So that it can be selected by its coordinate."""
    raised = raise_order(*first_order(ms.mesh.cylinder(1, 2, (12, 5))))
    mesh = Mesh(raised.points, raised.rows)
    assert len(mesh.select_edges("rim", x3=0.0).edge_groups["rim"]) == 12


def test_a_tube_with_a_wall_inside_and_a_fin_stays_round():
    """Joints of three along the axis: their middles lie half-way on straight lines, those of the tube on the circle."""
    tube = ms.mesh.cylinder(1, 1, (24, 4))
    points = {"a": (-1, 0), "m": (0, 0), "b": (1, 0), "c": (2, 0)}
    wall = ms.mesh.profile(points, {"west": ("a", "m"), "east": ("m", "b"), "fin": ("b", "c")}, 1.0, (3, 4))
    both = np.concatenate([tube.points, wall.points])
    rows = np.concatenate([tube.elements, wall.elements + len(tube.points)])
    mesh = Mesh(*weld(both, rows, 1e-9))
    assert len(junctions_of(mesh).joints) == 2
    raised = raise_order(*first_order(mesh))
    at = raised.rows[:96]
    new = raised.points[np.unique(at[:, 4:])]
    print(f"{off_cylinder(new).max():.2e}, chords {1 - np.cos(np.pi / 24):.2e}")
    assert off_cylinder(new).max() < 0.03 * (1 - np.cos(np.pi / 24))
    assert np.abs(raised.points[raised.rows[96:], 1]).max() < 1e-12


def test_a_moebius_band_is_raised_across_its_line():
    """Wherever its normals change sign: middles there are one-sided, with an error of second order."""
    apart = []
    for around in (32, 64):
        points, rows = first_order(moebius(around, 4))
        other = rows.copy()
        quarter = np.arange(len(rows)).reshape(4, around)[:, : around // 4].ravel()
        other[quarter] = other[quarter][:, TURNED_QUAD]
        made, again = raise_order(points, rows), raise_order(points, other)
        assert made.creases == again.creases == 0
        middles = []
        for each in (made, again):
            sides = each.rows[:, SIDES].reshape(-1, 3)
            _, first = np.unique(edge_keys(sides, len(points)), return_index=True)
            middles.append(each.points[sides[first, 2]])
            chords = np.linalg.norm(middles[-1] - points[sides[first, :2]].mean(axis=1), axis=1).max()
        apart.append(np.linalg.norm(middles[0] - middles[1], axis=1).max())
        print(f"{around}: {apart[-1]:.2e} apart, chords {chords:.2e}")
    assert np.log2(apart[0] / apart[1]) > 2.5


def test_a_tube_and_its_lid_share_their_circle():
    """At the crease between them: the middles of the edge are on the cylinder and in the plane of the lid."""
    tube, lid = first_order(ms.mesh.cylinder(1, 1, (24, 4))), first_order(ms.mesh.annulus(0.3, 1, (3, 24)))
    points = np.concatenate([tube[0], lid[0]])
    welded, place = np.unique(np.round(points, 9), axis=0, return_inverse=True)
    rows = np.concatenate([tube[1], np.where(lid[1] >= 0, lid[1] + len(tube[0]), -1)])
    rows, turned, _ = agreeing(np.where(rows >= 0, place.ravel()[rows], -1))
    assert turned == 3 * 24
    raised = raise_order(welded, rows)
    assert raised.creases == 24
    new = raised.points[len(welded) :]
    circle = new[(np.abs(new[:, 2]) < 0.05) & (np.hypot(new[:, 0], new[:, 1]) > 0.95)]
    off = off_cylinder(circle).max(), np.abs(circle[:, 2]).max()
    print(f"off the cylinder {off[0]:.1e}, off the plane {off[1]:.1e}, chord {1 - np.cos(np.pi / 24):.1e}")
    assert len(circle) == 24
    assert max(off) < 1e-6


def test_middles_that_are_there_stay():
    """Beside a neighbour of second order only what is missing is made."""
    points, rows = first_order(ms.mesh.rectangle(2.0, 1.0, (2, 1)))
    middle = np.array([[0.5, -0.1, 0.0]])
    side = int(np.argmin(np.abs(points[rows[0][SIDES[:, :2]]].mean(axis=1) - [0.5, 0.0, 0.0]).sum(axis=1)))
    rows[0, 4 + side] = len(points)
    raised = raise_order(np.concatenate([points, middle]), rows)
    assert raised.middles == 6
    assert np.array_equal(raised.points[raised.rows[0, 4 + side]], middle[0])
