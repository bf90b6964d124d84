"""Loads in the residual: minus their multipliers times the nodal forces, at nodes with frames of their own too."""

from __future__ import annotations

import numpy as np
import pytest
from battery import PATCHES, free_body, random_state

import magshell as ms
from loads.bodies import grouped
from loads.cases import at_rest
from magshell.equations.instant import Instant
from magshell.shell.elements import ELEMENTS

SUPPORTS = (ms.SymmetryPlane("left", (1.0, 2.0, -0.5)), ms.SymmetryPlane("bottom", (0.3, -1.0, 0.8)))
LOADS = (
    ms.Force("left", (0.2, -0.1, 0.3)),
    ms.Moment("bottom", (0.1, 0.3, -0.2)),
    ms.Moment("left", (0.2, 0.0, 0.1), follower=True),
    ms.Force("bottom", (0.2, -0.1, 0.3), follower=True),
    ms.Pressure("half", 0.4),
)
FACTOR = 0.7


@pytest.fixture(scope="module")
def assemblies():
    mesh = grouped(PATCHES["curved patch"]())
    bare, loaded = (free_body(mesh, supports=SUPPORTS, loads=loads) for loads in ((), LOADS))
    state = random_state(bare, 11)
    return loaded, state, *(d.assemble(Instant(state, d.model.loading(FACTOR))) for d in (bare, loaded))


def test_residual_and_right_side(assemblies):
    d, state, bare, loaded = assemblies
    assert (d.model.constraints.frame_of >= 0).any()
    expected = -FACTOR * np.sum([one.forces(state) for one in d.model.applied], axis=0)
    size = np.abs(bare.residual).max()
    error = np.abs(d.to_global(loaded.residual - bare.residual) - expected).max() / size
    assert error < 1e-14, f"residual: {error:.1e}"
    turned = d.to_frames(d.direction(loaded.right_side - bare.right_side).nodal)
    error = np.abs(turned - np.where(d.free, d.to_frames(-expected), 0.0)).max() / np.abs(bare.right_side).max()
    assert error < 1e-14, f"right side: {error:.1e}"


def test_loads_count_among_the_forces_that_measure_the_residual():
    """An element without deformation has no forces of its own: the residual is all load, and as large as it."""
    d = free_body(PATCHES["flat patch"](), loads=(ms.Force("right", (0, 0, 1.0)),), remanent=(0, 0, 0))
    assert d.assemble(Instant(d.undeformed(), d.model.loading(FACTOR))).relative["u"] == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("element", ELEMENTS)
def test_columns_of_the_load_are_those_of_the_fields(element):
    """On a flat shell at rest: no force along the director, no couple in the surface."""
    mesh = PATCHES["flat patch"]()
    shell = ms.Shell(mesh, 0.1, ms.MicropolarNeoHookean(1.0, 1.7, 0.3, 0.2), element=element)
    model = ms.Model(shell, [ms.Clamp("left")], loads=LOADS[:4])
    carried = np.any([one.forces(at_rest(mesh)) for one in model.applied], axis=(0, 1))
    assert carried.tolist() == [True] * 5 + [False] * 4 + [True, False]
