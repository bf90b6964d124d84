"""The stretch that varies across the thickness: a field, absent, or eliminated at every point."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import magshell as ms
from magshell import problem
from magshell.evaluation.converged import converged
from magshell.problem.building import build
from magshell.shell.deformed import evaluate


@cache
def strip(element: str, stretch: str, divide: int = 1) -> ms.Path:
    """The problem strip-10 in 2 mT."""
    source, file = problem.read("strip-10")
    along, across = file.mesh.elements
    changes = {
        "mesh": file.mesh.model_copy(update={"elements": (along * divide, across * divide)}),
        "shell": file.shell.model_copy(update={"element": element, "thickness_stretch": stretch}),
    }
    model = build(file.model_copy(update=changes), source).model
    return ms.solve(ms.Model(model.shell, model.supports, ms.UniformField((0, 0, 2e-3)), model.coupling, model.probes))


def tip(*arguments: object) -> float:
    """Deflection of the tip, m."""
    return float(strip(*arguments).probe("tip").u3[-1])


def test_without_it_bending_locks() -> None:
    """By 38 %, as an independent program of the source's element has it."""
    less = tip("paper", "none") / tip("paper", "linear") - 1.0
    assert less == pytest.approx(-0.38, abs=0.005), f"{less:.1%}"


def test_locking_is_not_one_of_the_mesh() -> None:
    """It is the theory that is too stiff: a better element and a finer mesh do not help."""
    less = [tip("quadratic", "none", divide) / tip("quadratic", "linear", divide) - 1.0 for divide in (1, 2)]
    assert max(less) < -0.38, f"{less}"
    assert less[0] == pytest.approx(less[1], abs=0.01), f"{less}"


def test_plane_stress_at_the_points_is_the_field_on_a_fine_mesh() -> None:
    """They differ by how φ varies in between: by no more than the mesh's own error."""
    linear, points = (np.array([tip("quadratic", stretch, divide) for divide in (1, 2)]) for stretch in TWO)
    mesh = np.abs(np.diff(linear)) + np.abs(np.diff(points))
    assert abs(linear[1] - points[1]) < mesh, f"{linear}, {points}"
    assert abs(points[1] / linear[1] - 1.0) < 5e-4, f"{points[1] / linear[1] - 1.0:.1e}"


TWO = ("linear", "plane-stress")


def test_plane_stress_on_a_mesh_of_both_shapes() -> None:
    """The rules of the two shapes differ in length: the points of weight zero have no stretch to eliminate."""
    results = []
    for stretch in TWO:
        model = strip("quadratic", stretch).model
        mesh = ms.mesh.split(model.shell.mesh, "crossed", np.arange(0, len(model.shell.mesh.elements), 2))
        path = ms.solve(replace(model, shell=replace(model.shell, mesh=mesh)))
        energy = converged(path.discretisation, path.steps[-1]).energies[:, 0].sum()
        results.append([path.probe("tip").u3[-1], energy])
    difference = np.abs(np.divide(*results) - 1.0)
    assert difference.max() < 5e-4, f"tip and energy: {difference}"


ELIMINATED = {
    "quadratic": (0.0009872229058285663, -5.364573092348481e-05),
    "paper": (0.0009949436129853867, -5.452648392588009e-05),
}
"""u3 and u1 of the tip, m, of magshell 0.1.0, whose plane stress had φ as the variable that is eliminated."""


@pytest.mark.parametrize("element", ELIMINATED)
def test_two_levels_are_what_an_eliminated_phi_was(element: str) -> None:
    """The stretches of two levels of equal height are 2 z φ."""
    found = strip(element, "plane-stress").probe("tip")
    assert (found.u3[-1], found.u1[-1]) == pytest.approx(ELIMINATED[element], rel=1e-10)


@pytest.mark.parametrize("stretch", ["none", "plane-stress"])
def test_no_node_carries_it(stretch: str) -> None:
    path = strip("quadratic", stretch)
    assert not path.discretisation.carried[:, 6].any()
    assert not path.steps[-1].state.phi.any()
    assert path.discretisation.dofs < strip("quadratic", "linear").discretisation.dofs


@pytest.mark.parametrize("stretch", ["none", *TWO])
def test_balance(stretch: str) -> None:
    step = strip("quadratic", stretch).steps[-1]
    assert max(step.balance.force_imbalance, step.balance.moment_imbalance) < 1e-8, step.balance
    assert np.linalg.det(evaluate(strip("quadratic", stretch).discretisation.reference, step.state).F).min() > 0.9


def test_energy_is_half_the_work() -> None:
    """At a small load the stored energy is half of load times displacement; here of a dead force at the end."""
    for stretch in ("none", *TWO):
        model = strip("quadratic", stretch).model
        force = np.array([0.0, 0.0, 1e-6])
        pulled = ms.solve(ms.Model(model.shell, model.supports, probes=model.probes, loads=[ms.Force("right", force)]))
        step, d = pulled.steps[-1], pulled.discretisation
        work = 0.5 * float(np.sum(d.loads.forces(step.state, step.loads)[:, :3] * step.state.u))
        energy = float(converged(d, step).energies[:, 0].sum())
        assert energy == pytest.approx(work, rel=1e-5), f"{stretch}: {energy / work - 1.0:.1e}"
