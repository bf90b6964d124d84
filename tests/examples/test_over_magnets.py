"""The built-in problems with magnets, against values from independent calculations."""

from __future__ import annotations

import numpy as np
import pytest

import magshell as ms
from magshell.evaluation.converged import converged

# Of the rigid plate: surface charges and a volume integral agree to 3e-7.
PULL = 168.6582915e-3
# Tip (X1, X3) of the inextensible strip with its clamp at (-20, 0) mm, m; force N and moment N m of its clamp.
TIP = (-13.7554e-3, 16.9090e-3)
FORCE, MOMENT = (-0.0720234e-3, 0.0, 0.0922167e-3), 1.51885e-6

# The same E I and A B_rem at a quarter of the thickness; next to no couple stress, and twice the elements.
THIN = {
    "shell.thickness": "0.125 mm",
    "material.youngs_modulus": "19.2 MPa",
    "material.length_scale": "0.001 h",
    "remanence[0].vector": "400 mT",
    "mesh.blocks.strip.elements": [40, 1],
}
PLACE, CLAMP = 1.2e-3 * 20e-3, 5e-3
"""Of the strip as it is: its stretch and shear, which go with the square of the thickness."""


def test_the_clamp_of_the_plate_holds_the_pull_of_the_magnet(solved) -> None:
    """The plate bends by 8 µm at its corners, which pulls more by 6e-4."""
    path = solved("plate-over-magnet")
    step = path.steps[-1]
    (clamp,) = converged(path.discretisation, step).reactions
    assert clamp.force[2] == pytest.approx(PULL, rel=1e-3)
    assert np.abs(clamp.force[:2]).max() < 1e-9 * PULL
    (pull, _), *more = converged(path.discretisation, step).source_forces
    assert not more
    assert pull == pytest.approx(clamp.force, abs=1e-8 * PULL), "the magnet is pulled up as much as the plate down"


def check_strip(path: ms.Path, place: float, clamp: float) -> None:
    """Place of the tip within some metres; force and moment of the clamp within a share of their size."""
    step, node = path.steps[-1], path.model.probe_nodes["tip"]
    x = path.model.shell.mesh.points[node] + step.state.u[node]
    assert np.abs(x[[0, 2]] - TIP).max() < place
    (held,) = converged(path.discretisation, step).reactions
    assert held.force == pytest.approx(FORCE, abs=clamp * np.linalg.norm(FORCE))
    assert held.moment[1] == pytest.approx(MOMENT, rel=clamp)


def test_the_strip_over_the_magnet(solved) -> None:
    """It stretches a little, which the strip of the values does not."""
    path = solved("strip-over-magnet")
    check_strip(path, PLACE, CLAMP)
    step = path.steps[-1]
    assert max(step.balance.force_imbalance, step.balance.moment_imbalance) < 1e-8


def test_a_strip_a_quarter_as_thick_is_sixteen_times_as_near() -> None:
    problem = ms.problem.load("strip-over-magnet", THIN)
    check_strip(ms.solve(problem.model, problem.settings), PLACE / 16, CLAMP / 16)


def test_the_flower_closes_and_opens(solved) -> None:
    path = solved("magnet-approaches")
    ends = [step for step in path.steps if step.load_factor == 1.0]
    assert [step.stage for step in ends] == [0, 1, 2]
    corners = np.flatnonzero(np.linalg.norm(path.model.shell.mesh.points, axis=1) > 15.9e-3)
    radii = []
    for step in ends:
        x = (path.model.shell.mesh.points + step.state.u[: len(path.model.shell.mesh.points)])[corners]
        radii.append(np.linalg.norm(x[:, :2], axis=1))
        assert np.ptp(np.sort(radii[-1]).reshape(-1, 4), axis=1).max() < 1e-9, "all four petals do the same"
    far, near, away = (float(radius.mean()) for radius in radii)
    assert near < 4e-3 < 15e-3 < far
    assert away == pytest.approx(far, rel=1e-6)
