"""Conservative loads: their work along the path is the energy stored, and the tangent is symmetric.

Work is summed by the trapezoidal rule over points of the path that are evenly spaced in a parameter. Its error is a
series in even powers of their distance h, so that Romberg's extrapolation works: errors fall like h², then h⁴ and on.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from battery import scaled_error

import magshell as ms
from magshell import DeformationGradientEnergy, Model, Path, Settings, Step, solve
from magshell.equations.instant import Instant
from magshell.evaluation.converged import converged
from magshell.shell.deformed import evaluate
from solver.arches import arch, to_the_crown_at
from solver.models import LENGTH, THICKNESS, rubber
from solver.models import strip as field_strip

SHARP = Settings(tolerance=1e-11)
POINTS = 32


def plate(stops: Sequence[float] = (), edges: Sequence[str] = ("left", "right", "bottom", "top")) -> Model:
    """A square clamped at its edges, blown up by a pressure, with its weight, a traction and a force."""
    mesh = ms.mesh.rectangle(LENGTH, LENGTH, (4, 4)).select_nodes("middle", x1=LENGTH / 2, x2=LENGTH / 2)
    mesh = replace(mesh, element_groups={"all": np.arange(16), "part": np.arange(5)})
    shell = ms.Shell(mesh, THICKNESS, rubber(), density=1500.0)
    loads = [
        ms.Pressure("all", 10e3),
        ms.Traction("part", (4e3, 0.0, 0.0)),
        ms.Gravity((0.0, 500.0, 0.0)),
        ms.Force("middle", (0.0, 0.0, 0.1)),
    ]
    return Model(shell, [ms.Clamp(edge) for edge in edges], loads=loads, stages=[ms.Stage(stops=stops)])


def evenly(count: int) -> tuple[float, ...]:
    """Load factors after the first point, evenly spaced."""
    return tuple(np.arange(1, count + 1) / count)


def energy(path: Path, step: Step) -> float:
    """Strain energy of a step, J."""
    return float(converged(path.discretisation, step).energies[:, 0].sum())


def trapezoidal(values: np.ndarray, moved: np.ndarray) -> float:
    """∫ values · d moved, over the rows."""
    return float(np.sum(0.5 * (values[1:] + values[:-1]) * np.diff(moved, axis=0)))


def extrapolated(values: np.ndarray, moved: np.ndarray) -> list[np.ndarray]:
    """Romberg's table of the integral over 1, 2, 4, … intervals: column k is of order 2k + 2."""
    strides = 2 ** np.arange(int(np.log2(len(values) - 1)), -1, -1)
    table = [np.array([trapezoidal(values[::stride], moved[::stride]) for stride in strides])]
    while len(table[-1]) > 1:
        factor = 4.0 ** len(table)
        table.append((factor * table[-1][1:] - table[-1][:-1]) / (factor - 1.0))
    return table


def check_orders(table: list[np.ndarray], exact: float, accuracy: float, columns: int = 2) -> None:
    """The trapezoidal rule's error falls with h², once extrapolated with h⁴, and in the end the integral is met."""
    for column, order in ((0, 2), (1, 4))[:columns]:
        errors = np.abs(table[column][-2:] / exact - 1.0)
        found = np.log2(errors[0] / errors[1])
        assert found == pytest.approx(order, abs=0.15 * order), f"order {found:.2f} of {order}, errors {errors}"
    assert abs(table[-1][0] / exact - 1.0) < accuracy, f"off by {table[-1][0] / exact - 1.0:.1e}"


def load_work(path: Path, steps: Sequence[Step]) -> list[np.ndarray]:
    """Romberg's table of the loads' work on displacements and directors."""
    loads = path.discretisation.loads
    forces = [loads.forces(step.state, path.loading(step).loads)[:, :6].ravel() for step in steps]
    moved = [np.hstack([step.state.u, step.state.w]).ravel() for step in steps]
    return extrapolated(np.array(forces), np.array(moved))


@pytest.fixture(scope="module")
def blown() -> Path:
    return solve(plate(evenly(POINTS)), SHARP)


def test_work_of_pressure_weight_traction_and_force_is_stored(blown: Path) -> None:
    stops = (0.0, *evenly(POINTS))
    steps = [step for step in blown.steps if step.load_factor in stops]
    assert len(steps) == POINTS + 1
    rise = steps[-1].state.u[:, 2].max()
    assert rise > 0.5 * THICKNESS, f"the plate should rise by more than half its thickness: {rise:.1e} m"
    check_orders(load_work(blown, steps), energy(blown, steps[-1]), 1e-8)


def test_work_through_a_snap_is_stored() -> None:
    """Evenly spaced in the depth of the crown, past both limit points; where the load is negative it takes work out.

    (Around them the load bends so sharply that only the first order of two shows.)
    """
    count = 2 * POINTS
    depths = 0.45 * np.array(evenly(count))
    path = solve(arch([to_the_crown_at(depth) for depth in depths]), SHARP)
    ends = [[step for step in path.steps if step.stage == stage][-1] for stage in range(count)]
    assert min(path.loading(step).loads[0] for step in ends) < 0.0
    table = load_work(path, [path.steps[0], *ends])
    check_orders(table, energy(path, ends[-1]), 2e-6, columns=1)


def test_work_of_a_field_is_stored() -> None:
    """The field's potential is s V(state), V = -∫ (F B̃) · B / mu0 dV; its work ∫ s d(-V), s the multiplier."""
    stops = evenly(POINTS)
    path = solve(
        field_strip(field=(0, 0, 10e-3), stops=[1e-2 * s for s in stops], coupling=DeformationGradientEnergy()), SHARP
    )
    steps = [min(path.steps, key=lambda step: abs(step.load_factor - s)) for s in (0.0, *stops)]
    body, B = path.discretisation.reference, path.model.field.vector

    def potential(step: Step) -> float:
        moment = np.einsum("epkij,epkj->epki", evaluate(body, step.state).F, body.remanence)
        return -float(np.sum((moment @ B) * body.geometry.volume)) / path.model.coupling.vacuum_permeability

    multipliers = np.array([[step.load_factor] for step in steps])
    table = extrapolated(multipliers, -np.array([[potential(step)] for step in steps]))
    check_orders(table, energy(path, steps[-1]), 1e-8)


def asymmetry(path: Path, step: Step) -> float:
    """Of the tangent, rows and columns scaled; the larger of the plain one and the mixed one with other stresses."""
    discretisation, loading = path.discretisation, path.loading(step)
    other = discretisation.predicted(Instant(path.steps[step.number // 2].state, loading))
    worst = 0.0
    for stresses in (None, other):
        matrix = discretisation.assemble(Instant(step.state, loading, stresses)).matrix
        assert matrix is not None
        tangent = matrix.toarray()
        worst = max(worst, scaled_error(tangent, tangent.T))
    return worst


def test_tangent_under_conservative_loads_is_symmetric(blown: Path, snapped: Path) -> None:
    for name, path in {"plate": blown, "arch": snapped}.items():
        for step in path.steps[:: max(1, len(path.steps) // 5)]:
            assert asymmetry(path, step) < 1e-12, f"{name}, step {step.number}: {asymmetry(path, step):.1e}"


def test_tangent_in_a_field_with_an_energy_is_symmetric() -> None:
    """Bent by a field that turns, without being symmetric itself: oblique mirror plane and all."""
    supports = [ms.Clamp("left"), ms.SymmetryPlane("bottom", (0.0, 1.0, 0.0))]
    model = field_strip(supports=supports, field=(3e-3, 0, 10e-3), coupling=DeformationGradientEnergy())
    path = solve(model)
    found = asymmetry(path, path.steps[-1])
    assert found < 1e-12, f"{found:.1e}"


def test_pressure_with_a_free_edge_is_not_conservative() -> None:
    """Nor is its tangent symmetric: what the tests above find is no accident."""
    path = solve(plate(edges=("left", "right", "bottom")))
    assert asymmetry(path, path.steps[-1]) > 1e-6
