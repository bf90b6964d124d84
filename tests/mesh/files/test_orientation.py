"""Elements turned so that normals agree, and surfaces where they cannot."""

from __future__ import annotations

import numpy as np
import pytest
from bands import moebius
from hypothesis import given, settings
from hypothesis import strategies as st

import magshell as ms
from magshell.mesh import Mesh
from magshell.mesh.files.orientation import TURNED_QUAD, TURNED_TRIANGLE, agreeing
from magshell.mesh.junctions import junctions_of

from .same import described, first_order


def strip(turns, elements=12):
    """Corners of a closed strip, twisted so many half turns."""
    angle = np.repeat(2.0 * np.pi * np.arange(elements) / elements, 2)
    across = np.tile([-0.3, 0.3], elements)
    twist = 0.5 * turns * angle
    radius = 1.0 + across * np.cos(twist)
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle), across * np.sin(twist)], axis=1)
    low = 2 * np.arange(elements)
    rows = np.stack([low, low + 1, np.roll(low, -1) + 1, np.roll(low, -1)], axis=1)
    if turns % 2:
        rows[-1, 2:] = rows[-1, [3, 2]]
    return points, np.hstack([rows, np.full_like(rows, -1)])


@settings(deadline=None, max_examples=20)
@given(st.sets(st.integers(0, 11), max_size=5))
def test_any_elements_turned_come_back(turned):
    """Fewer than half of them, of a tube: the mesh is the one before."""
    mesh = ms.mesh.cylinder(1, 1, (6, 2))
    rows = mesh.elements.copy()
    chosen = np.array(sorted(turned), dtype=int)
    rows[chosen] = rows[chosen][:, TURNED_QUAD]
    back, count, _ = agreeing(rows)
    assert count == len(turned)
    assert described(Mesh(mesh.points, back))["elements"] == described(mesh)["elements"]


def test_triangles_and_separate_parts_are_turned_too():
    """Each part for itself; a turned triangle has its nodes where they belong."""
    _, rows = first_order(ms.mesh.rectangle(3, 2, (3, 2)), triangles=True)
    apart = np.where(rows >= 0, rows + rows.max() + 1, -1)
    both = np.concatenate([rows, apart[:, TURNED_TRIANGLE]])
    both[[1, 15]] = both[[1, 15]][:, TURNED_TRIANGLE]
    back, count, _ = agreeing(both)
    assert count == 2
    assert sorted(np.flatnonzero((back != both).any(axis=1))) == [1, 15]
    full = np.array([[0, 1, 2, 2, 3, 4, 2, 5]])
    assert full[:, TURNED_TRIANGLE].tolist() == [[0, 2, 1, 1, 5, 4, 1, 3]]


def test_a_moebius_band_keeps_one_line():
    """Where normals change sign: one edge of the strip, whichever elements were turned in the file."""
    for turns in (0, 2):
        assert agreeing(strip(turns)[1])[1:] == (0, 0)
    for turns in (1, 3):
        _, rows = strip(turns)
        as_written = agreeing(rows)
        assert (as_written.rows == rows).all()
        assert as_written[1:] == (0, 1)
        rows[[2, 3, 7]] = rows[[2, 3, 7]][:, TURNED_QUAD]
        turned = agreeing(rows)
        assert turned.against == 1
        assert turned.turned <= 6
        assert np.sort(turned.rows, axis=1).tolist() == np.sort(rows, axis=1).tolist()


@pytest.mark.parametrize("seed", range(3))
def test_a_wide_moebius_band_keeps_one_line_across_it(seed):
    """Any elements of 12 × 3 turned: the edges at which normals change sign are one line from rim to rim."""
    mesh = moebius(12, 3)
    rows = mesh.elements.copy()
    chosen = np.random.default_rng(seed).random(len(rows)) < 0.5
    rows[chosen] = rows[chosen][:, TURNED_QUAD]
    back, _, against = agreeing(rows)
    (line,) = junctions_of(Mesh(mesh.points, back)).flips
    assert len(line.edges) == against
    rim = np.unique(mesh.boundary_edges)
    assert np.isin([line.edges[0, 0], line.edges[-1, 1]], rim).all()
    assert not np.isin(line.edges[1:, 0], rim).any()


def test_a_moebius_band_is_read(tmp_path):
    """Half of its elements turned: told, and as good as before."""
    band = moebius(12, 2)
    rows = band.elements.copy()
    rows[::2] = rows[::2][:, TURNED_QUAD]
    ms.mesh.write(Mesh(band.points, rows), tmp_path / "band.msh", "mm")
    mesh = ms.mesh.read(tmp_path / "band.msh")
    (line,) = junctions_of(mesh).flips
    told = f"the surface has one side only: its normals change sign across {len(line.edges)} edges"
    assert mesh.origin.changes[-1] == told


def test_sheets_at_a_joint_are_turned_each_for_itself():
    """A fin on a plate: neighbours across the joint of three need not agree, those within a sheet do."""
    mesh = ms.mesh.profile(
        {"a": (0, 0), "b": (1, 0), "c": (2, 0), "d": (1, 1)},
        {"left": ("a", "b"), "right": ("b", "c"), "fin": ("b", "d")},
        1.0,
        (3, 2),
    )
    rows = mesh.elements.copy()
    rows[[0, 7]] = rows[[0, 7]][:, TURNED_QUAD]
    back, turned, against = agreeing(rows)
    assert (turned, against) == (2, 0)
    assert (back == mesh.elements).all()
