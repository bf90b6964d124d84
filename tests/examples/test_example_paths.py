"""The load path of every built-in problem: stops, convergence, global balance."""

from __future__ import annotations

import numpy as np
import pytest

from magshell import Path, problem
from magshell.shell.evaluation import evaluate
from magshell.solver import Step

MU0 = 4e-7 * np.pi
BALANCE = 1e-8

every_problem = pytest.mark.parametrize("name", problem.names())


@every_problem
def test_path_hits_every_stop_and_the_end(name: str, solved) -> None:
    path = solved(name)
    factors = [step.load_factor for step in path.steps]
    stops = path.model.field.stop_factors
    assert set(stops) <= set(factors), f"{name}: stops {stops} are missed by {factors}"
    assert factors[0] == 0.0
    assert factors[-1] == 1.0
    assert np.all(np.diff(factors) > 0.0), f"{name}: {factors}"
    assert [step.number for step in path.steps] == list(range(len(path.steps)))


@every_problem
def test_path_converges(name: str, solved) -> None:
    path = solved(name)
    settings = path.settings
    assert path.converged, path.reason
    worst = max(path.steps[1:], key=lambda step: step.residual)
    assert worst.residual <= settings.tolerance, f"{name}: {worst.residual:.1e} at step {worst.number}"
    assert all(0 < step.iterations <= settings.max_iterations for step in path.steps[1:])
    kept = sum(step.iterations for step in path.steps)
    assert kept <= path.solves, f"{name}: {kept} solves in the steps, {path.solves} in all"
    assert (kept == path.solves) == (path.cuts == 0), f"{name}: {kept}, {path.solves}, {path.cuts} cuts"


@every_problem
def test_reactions_balance_the_magnetic_torque(name: str, solved) -> None:
    path = solved(name)
    for step in path.steps[1:]:
        balance = step.balance
        assert balance is not None
        assert balance.force_imbalance < BALANCE, f"{name}, step {step.number}: {balance.force_imbalance:.1e}"
        torque, total = _torque(path, step)
        apart = np.linalg.norm(balance.magnetic_torque - torque) / total
        assert apart < 1e-13 * len(path.model.shell.mesh.elements), f"{name}, step {step.number}: {apart:.1e}"
        off = np.linalg.norm(balance.reaction_moment + torque) / total
        assert off < BALANCE, f"{name}, step {step.number}: moments off by {off:.1e} of the torque's density"


def _torque(path: Path, step: Step) -> tuple[np.ndarray, float]:
    """Integral of (1/mu0) (F B̃) × B over the body, N m, and of its magnitude."""
    body = path.discretisation.body
    m = np.einsum("epkxy,epy->epkx", evaluate(body, step.state).F, body.remanence)
    field = step.load_factor * path.model.field.vector
    density = np.cross(m, field) * body.geometry.volume[..., None] / MU0
    return density.sum(axis=(0, 1, 2)), float(np.linalg.norm(density, axis=-1).sum())


@every_problem
def test_what_unbalances_the_forces_is_the_residual_of_the_free_nodes(name: str, solved) -> None:
    """Forces between elements cancel: all nodal residuals sum to zero, whatever the state."""
    path = solved(name)
    discretisation, step = path.discretisation, path.steps[-1]
    residual = discretisation.assemble(step.state, step.load_factor, tangent=False).residual
    nodal = discretisation.to_global(residual)[:, :3]
    off = np.linalg.norm(nodal.sum(axis=0)) / np.linalg.norm(nodal, axis=1).sum()
    assert off < len(nodal) * np.finfo(float).eps, f"{name}: {off:.1e}"
