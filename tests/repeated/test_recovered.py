"""Stress and strain at the sides of a part are those of the whole: averaged with the neighbours', but at borders."""

from __future__ import annotations

import numpy as np
import pytest

from magshell.evaluation.patches import patches_of
from repeated.bodies import AXIS, POINT, Sector, copied, recovered_alike, remanence
from repeated.test_cyclic import BODIES, LOADS, of_sector, of_whole
from repeated.test_periodic import HELD, bounded, cell, solved

ACCURACY = 1e-7
"""As far as two solutions of the tolerance of these tests have the same derivatives."""


def smooth(mesh):
    """Along the axis and a little outwards: of neighbours alike only where the neighbour's is turned."""
    out = mesh.points[mesh.elements].mean(axis=1) - POINT
    out -= (out @ AXIS)[:, None] * AXIS
    return AXIS + 0.2 * out / np.linalg.norm(out, axis=1, keepdims=True)


SMOOTH = {
    "flat": Sector(around=3),
    "cone": Sector(height=lambda r, a: 0.6 * r, around=3),
    "triangles": Sector(height=lambda r, a: 0.3 * r**2, around=3, split=True),
}


@pytest.mark.parametrize("body", SMOOTH.values(), ids=SMOOTH)
def test_smooth_across_the_cut(body):
    sector, (whole, _) = (of(body, LOADS["twist"], magnets=smooth) for of in (of_sector, of_whole))
    assert len(patches_of(sector.model.shell).nodes) == len(body.mesh.points), "there is no border"
    recovered_alike(sector, whole, ACCURACY)


BORDERS = {name: BODIES[name] for name in ("kink on the cut", "sections on the cut", "hinge on the cut")}


@pytest.mark.parametrize("magnets", [remanence, smooth])
@pytest.mark.parametrize("body", BORDERS.values(), ids=BORDERS)
def test_borders_on_the_cut(body, magnets):
    sector, (whole, _) = (of(body, LOADS["pressure"], magnets=magnets) for of in (of_sector, of_whole))
    recovered_alike(sector, whole, ACCURACY)


def test_node_on_the_axis():
    body = Sector(height=lambda r, a: 0.2 * r**2, inner=0.0)
    along = lambda mesh: np.broadcast_to(AXIS, (len(mesh.elements), 3))  # noqa: E731
    sector, (whole, _) = (of(body, LOADS["pressure"], magnets=along) for of in (of_sector, of_whole))
    recovered_alike(sector, whole, ACCURACY)


def test_cell_and_its_corner():
    """Of four cells the corner of one is inside."""
    mesh = cell()
    vectors = np.broadcast_to((0.3, -0.5, 0.8), (len(mesh.elements), 3))
    one = solved(mesh, vectors, *HELD["sheared"])
    many, _ = copied(mesh, [(np.eye(3), np.array([i, j, 0.0])) for i in range(2) for j in range(2)])
    four = solved(bounded(many), np.tile(vectors, (4, 1)), *HELD["sheared"], times=2)
    recovered_alike(one, four, ACCURACY)
