"""Every problem of the paper: its path (stops, convergence, global balance), and the values of independent programs.

One file, so that one process solves each of them once.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import pytest

from examples.problems import PART_OF_THE_PUMP, read, value_at, variant
from examples.references import FINE_MESH, SAME_MESH, STRIP_LENGTHS, Reference
from magshell import Path, solve
from magshell.equations.instant import Instant
from magshell.reproduction.catalogue import EXAMPLES
from magshell.shell.deformed import evaluate
from magshell.solver import Settings, Step

SAME_FORMULATION = 5e-3
ANOTHER_THEORY = 1e-2
MU0 = 4e-7 * np.pi
BALANCE = 1e-8


def each(names: Iterable[str]) -> list[Any]:
    """Problems as parameters; the pump's is solved in a part for the tests, and to its end by `make verify`."""
    marks = {"pump": pytest.mark.verify}
    return [pytest.param(name, marks=marks.get(name, ())) for name in names]


def each_reference(references: Sequence[Reference]) -> list[Any]:
    return [
        pytest.param(one, id=one.label, marks=pytest.mark.verify if one.problem == "pump" else ()) for one in references
    ]


@pytest.mark.parametrize("reference", each_reference(SAME_MESH))
def test_value_of_the_same_formulation_on_the_same_mesh(reference: Reference, solved) -> None:
    found = value_at(solved(reference.problem), reference)
    difference = found / reference.value - 1.0
    assert abs(difference) < SAME_FORMULATION, (
        f"{reference.label}: {reference.component} = {found:.5g} {reference.unit}, {reference.source} has "
        f"{reference.value:g}: {difference:+.2%}"
    )


@pytest.fixture(scope="module")
def refined() -> dict[str, Path]:
    """Paths on meshes twice as fine, converged far below what is compared, by name."""
    return {}


@pytest.fixture(scope="module")
def default() -> dict[str, Path]:
    """Paths with the default element on the meshes of the problem files, by name."""
    return {}


@pytest.mark.parametrize("reference", each_reference(FINE_MESH))
def test_value_of_the_solid_with_the_default_element(reference: Reference, default: dict[str, Path]) -> None:
    """It needs no finer mesh: what is left is the difference of the theories.

    To that belong the neglected terms of the thickness, (h/L)² of bending: 1 % for the thickest strip.
    """
    length = STRIP_LENGTHS.get(reference.problem)
    thickness = read(reference.problem)[1].shell.thickness
    neglected = (thickness / length) ** 2 if length else 0.0
    check_solid(reference, default, divide=1, element="quadratic", allowed=ANOTHER_THEORY + neglected)


PAPER_FINE = [one for one in FINE_MESH if one.problem in ("strip-10", "thin-cross")]


@pytest.mark.parametrize("reference", PAPER_FINE, ids=[one.label for one in PAPER_FINE])
def test_value_of_the_solid_on_a_mesh_twice_as_fine(reference: Reference, refined: dict[str, Path]) -> None:
    check_solid(reference, refined, divide=2, element="paper", allowed=ANOTHER_THEORY)


def check_solid(reference: Reference, paths: dict[str, Path], divide: int, element: str, allowed: float) -> None:
    name = reference.problem
    if name not in paths:
        fields = {one.field for one in FINE_MESH if one.problem == name}
        stops = tuple(sorted(field * 1e-3 for field in fields))
        model = variant(name, divide=divide, stops=stops, element=element).model
        paths[name] = solve(model, Settings(tolerance=1e-6))
    found = value_at(paths[name], reference)
    difference = found / reference.value - 1.0
    assert abs(difference) < allowed, (
        f"{reference.label}: {reference.component} = {found:.5g} {reference.unit}, {reference.source} have "
        f"{reference.value:g}: {difference:+.2%}"
    )


every_problem = pytest.mark.parametrize(
    "name", each([*(name for example in EXAMPLES for name in example.problems), PART_OF_THE_PUMP])
)


@every_problem
def test_path_hits_every_stop_and_the_end(name: str, solved) -> None:
    path = solved(name)
    factors = [step.load_factor for step in path.steps]
    stops = path.model.course(0).stops()
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
    assert kept < path.solves, f"{name}: {kept} solves in the steps, {path.solves} in all, one for the first direction"
    if path.cuts == 0 and not path.critical_points:
        assert path.solves <= kept + len(path.steps), f"{name}: {kept}, {path.solves}, at most one more per step"


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
    body = path.discretisation.reference
    m = np.einsum("epkxy,epky->epkx", evaluate(body, step.state).F, body.remanence)
    field = step.load_factor * path.model.field.vector
    density = np.cross(m, field) * body.geometry.volume[..., None] / MU0
    return density.sum(axis=(0, 1, 2)), float(np.linalg.norm(density, axis=-1).sum())


@every_problem
def test_what_unbalances_the_forces_is_the_residual_of_the_free_nodes(name: str, solved) -> None:
    """Forces between elements cancel: all nodal residuals sum to zero, whatever the state."""
    path = solved(name)
    discretisation, step = path.discretisation, path.steps[-1]
    residual = discretisation.assemble(
        Instant(step.state, discretisation.model.loading(step.load_factor)), tangent=False
    ).residual
    nodal = discretisation.to_global(residual)[:, :3]
    off = np.linalg.norm(nodal.sum(axis=0)) / np.linalg.norm(nodal, axis=1).sum()
    assert off < len(nodal) * np.finfo(float).eps, f"{name}: {off:.1e}"
