"""Surfaces of magnets and coils in their places, and fields on a plane."""

from __future__ import annotations

import numpy as np
import pytest
from magnetics.fields.cases import MOTION, SHAPES, magnets, sampled

from magshell.errors import InputError
from magshell.magnetics.fields import MagnetField, Motion, Source
from magshell.output.sources import COPPER, NORTH, SOUTH, Plane, arrows, pieces, streamlines

HERE = np.array([1.0, 0, 0, 0, 0])


@pytest.mark.parametrize("name", SHAPES)
def test_pieces_have_the_size_of_the_source(name):
    shape = SHAPES[name]
    drawn = pieces(MagnetField([shape]), HERE)
    points = np.concatenate([piece.surface.points for piece in drawn])
    assert [piece.colour for piece in drawn] == ([COPPER] if shape.is_coil else [NORTH, SOUTH])
    largest = np.linalg.norm(points, axis=1).max()
    assert largest == pytest.approx(shape.size or 1e-3, rel=0.03)
    if not shape.is_coil:
        north, south = (np.asarray(piece.surface.points).mean(axis=0) for piece in drawn)
        assert (north - south) @ shape.poles > 0.0


def test_pieces_are_where_the_sources_are():
    field = magnets(MOTION)
    amounts = field.ends(2)[2]
    halves, moved = pieces(field, amounts)[:2], field.now(amounts)[0]
    points = np.concatenate([piece.surface.points for piece in halves])
    assert np.allclose(points.mean(axis=0), moved.place, atol=2e-3)
    assert np.abs(moved.shape.distance(moved.local(points.astype(float)))).max() < 1e-7
    assert len(pieces(field + magnets(), np.concatenate([amounts, HERE]))) == 6
    assert pieces(sampled(), HERE) == []


def test_lines_follow_the_field_in_the_plane():
    field = MagnetField([Source(SHAPES["cylinder"], (0.0, 0.0, 0.0), (0.0, 0.3, 0.0))])
    plane = Plane((-0.05, 0.0, -0.05), (0.1, 0.0, 0.0), (0.0, 0.0, 0.1), 60)
    lines = streamlines(field, HERE, plane)
    points = np.asarray(lines.points, dtype=float)
    assert lines.n_lines > 10
    assert np.abs(points[:, 1]).max() < 1e-9
    turns = []
    for line in lines.cell:
        start, end = line.points[:2]
        middle = 0.5 * (start + end)
        if np.linalg.norm(middle) > 0.025 and np.linalg.norm(end - start) > 1e-6:
            B = field.at(HERE, middle[None], second=False).flux_density[0]
            turns.append(B @ (end - start) / np.linalg.norm(B) / np.linalg.norm(end - start))
    assert len(turns) > 10
    assert np.min(turns) > 0.98
    assert np.all(np.asarray(lines["B"]) > 0.0)


def test_arrows_at_the_points_that_a_grid_knows():
    field = sampled()
    inside = arrows(field, HERE, Plane((-0.1, 0.0, -0.1), (0.2, 0.0, 0.0), (0.0, 0.0, 0.1), 9))
    beyond = arrows(field, HERE, Plane((-0.1, 0.0, -0.1), (0.4, 0.0, 0.0), (0.0, 0.0, 0.1), 17))
    assert inside.n_points == beyond.n_points > 0
    assert np.isfinite(inside["B"]).all()


def test_a_plane_through_a_wire():
    loop = SHAPES["loop"]
    field = MagnetField([loop], Motion())
    plane = Plane((-loop.size, 0.0, -0.01), (2.0 * loop.size, 0.0, 0.0), (0.0, 0.0, 0.02), 7)
    assert plane.counts == (7, 5)
    assert arrows(field, HERE, plane).n_points > 0


@pytest.mark.parametrize(
    ("first", "second", "message"),
    [
        ((0, 0, 0), (0, 1, 0), "must be finite and have a length"),
        ((1, 0, 0), (np.nan, 1, 0), "must be finite"),
        ((1, 0, 0), (1, 1, 0), "right angles"),
    ],
)
def test_refused_planes(first, second, message):
    with pytest.raises(InputError, match=message):
        Plane((0, 0, 0), first, second)
    with pytest.raises(InputError, match="at least 2"):
        Plane((0, 0, 0), (1, 0, 0), (0, 1, 0), 1)
