"""Forces of a load and large rotations: of the body with the load, and of the deformed body alone."""

from __future__ import annotations

import numpy as np
import pytest
from battery import with_points
from scipy.spatial.transform import Rotation

from loads.cases import (
    CASES,
    MESHES,
    at_rest,
    crumpled,
    each_case,
    each_patch,
    on_mesh,
    turned_columns,
    turned_rigidly,
    turned_vectors,
)

TURNING = {name: case for name, case in CASES.items() if case.turns}
DEAD = {name: case for name, case in CASES.items() if not case.turns and case.load.kind != "moment"}
each_turn = pytest.mark.parametrize("seed", [1, 2])


@each_turn
@each_patch
@each_case
def test_body_and_load_turned_together(case, mesh, seed):
    """The undeformed body, its state and the load's vectors turned by Q: forces and blocks of the tangent follow."""
    Q, state = Rotation.random(rng=seed), crumpled(mesh, 10 + seed)
    R = Q.as_matrix()
    turned = with_points(mesh, mesh.points @ R.T)
    one, other = on_mesh(case, mesh), on_mesh(case._replace(load=turned_vectors(case.load, Q)), turned)
    # R̃ -> Q R̃ Qᵀ: from the turned undeformed body to the turned deformed one
    q = (Q * Rotation.from_quat(state.q, scalar_first=True) * Q.inv()).as_quat(scalar_first=True)
    state_there = state._replace(u=state.u @ R.T, w=state.w @ R.T, q=q)
    expected, found = turned_columns(one.forces(state), Q), other.forces(state_there)
    error = np.abs(found - expected).max() / np.abs(expected).max()
    assert error < 1e-13, f"forces: {error:.1e}"
    for pairs, before, found in zip(one.pairs, one.stiffness(state), other.stiffness(state_there), strict=True):
        expected = R @ before @ R.T
        error = np.abs(found - expected).max() / np.abs(expected).max()
        assert error < 1e-13, f"tangent, {pairs.row_field} over {pairs.column_field}: {error:.1e}"


@each_turn
@each_patch
@pytest.mark.parametrize("case", TURNING.values(), ids=TURNING)
def test_what_turns_with_the_deformed_body(case, mesh, seed):
    """The reference and the load as they are, the deformed body turned by Q: so are the forces."""
    Q, state, load = Rotation.random(rng=seed), crumpled(mesh, 20 + seed), on_mesh(case, mesh)
    before, after = load.forces(state), load.forces(turned_rigidly(mesh, state, Q))
    size = np.abs(before).max()
    error = np.abs(after - turned_columns(before, Q)).max() / size
    assert error < 1e-13, f"{error:.1e}"
    assert np.abs(after - before).max() > 0.1 * size


@pytest.mark.parametrize("case", DEAD.values(), ids=DEAD)
def test_what_is_dead(case):
    mesh = MESHES["curved patch"]
    load = on_mesh(case, mesh)
    assert np.array_equal(load.forces(crumpled(mesh, 30)), load.forces(at_rest(mesh)))
