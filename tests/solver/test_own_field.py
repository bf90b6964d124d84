"""Paths of bodies that feel themselves: Newton's order, energy along the path, balance, limit points, the end."""

from __future__ import annotations

import logging
from itertools import pairwise

import numpy as np
import pytest

import magshell as ms
from magshell.errors import InputError
from magshell.output.vtu import grid
from magshell.solver.events import Iteration

LENGTH, WIDTH, GAP, J = 20e-3, 2e-3, 5e-3, 20e-3
COUNT = 4


def two_strips(upper: float, stage: ms.Stage, coupling: object | None = None) -> ms.Model:
    """Strips above each other, held at one end, magnetised through their thickness."""
    one = ms.mesh.rectangle(LENGTH, WIDTH, (COUNT, 1))
    points = np.concatenate([one.points, one.points + np.array((0, 0, GAP))])
    elements = np.concatenate([one.elements, one.elements + len(one.points)])
    mesh = ms.mesh.Mesh(points, elements, node_groups={"held": np.flatnonzero(points[:, 0] == 0)})
    remanence = ms.remanence.per_element(np.repeat([[0, 0, J], [0, 0, upper]], COUNT, axis=0))
    shell = ms.Shell(mesh, 0.5e-3, ms.MicropolarStVenantKirchhoff(150e3, 0.0), remanence)
    probes = {"lower": (LENGTH, 0.0, 0.0), "tip": (LENGTH, 0.0, GAP)}
    law = coupling or ms.MicroRotationEnergy()
    return ms.Model(shell, [ms.Clamp("held", name="held")], ms.SelfField(), law, probes, stages=[stage])


def test_soft_sheets_of_strong_remanence_are_told(caplog) -> None:
    with caplog.at_level(logging.WARNING):
        mild = two_strips(J, ms.Stage())
    assert not caplog.text
    assert not [doubt for doubt in mild.doubts() if "self_field" in doubt]
    strong = ms.Shell(mild.shell.mesh, 0.5e-3, mild.shell.material, ms.remanence.constant((0.0, 0.0, 0.1)))
    with caplog.at_level(logging.WARNING):
        model = ms.Model(strong, mild.supports, ms.SelfField())
    ratio = 0.1**2 / (3.0 * 4e-7 * np.pi * 150e3)
    (doubt,) = [doubt for doubt in model.doubts() if "self_field" in doubt]
    assert f"is {ratio:.2g}: touching elements strain each other" in doubt
    assert doubt in caplog.text


class Residuals(ms.Observer):
    def __init__(self) -> None:
        self.steps: list[list[float]] = []

    def iterated(self, iteration: Iteration) -> None:
        if iteration.iteration == 0:
            self.steps.append([])
        self.steps[-1].append(iteration.residual)


@pytest.fixture(scope="module")
def repelling() -> tuple[ms.Path, Residuals]:
    heard = Residuals()
    return ms.solve(two_strips(-J, ms.Stage(stops=16)), observers=[heard]), heard


def test_newtons_method_has_its_order(repelling) -> None:
    """The linear equations are solved to 1e-5 with the derivative of the own field."""
    _, heard = repelling
    for residuals in heard.steps:
        assert len(residuals) <= 5, residuals
        below = [pair for pair in pairwise(residuals) if pair[0] < 1e-2]
        assert all(after < 1e-3 * before for before, after in below), residuals


def test_tips_move_alike_and_balance_holds(repelling) -> None:
    path, _ = repelling
    up, down = (path.probe(name).u3 for name in ("tip", "lower"))
    assert up[-1] > 1e-3
    assert np.abs(up + down).max() < 1e-6 * up[-1]
    for step in path.steps[1:]:
        assert max(step.balance.force_imbalance, step.balance.moment_imbalance) < 1e-8
    reaction = path.table()[["held.R1", "held.R2", "held.R3"]].to_numpy()
    assert np.abs(reaction).max() < 1e-8 * path.steps[-1].balance.force_scale, "on itself the body exerts no force"


def test_elastic_energy_is_what_the_field_did(repelling) -> None:
    """With W at multiplier s: E(1) + W(1) = ∫ W ds; the trapezoidal rule has second order."""
    table = repelling[0].table()
    factor, elastic = table["load_factor"].to_numpy(), table["elastic"].to_numpy()
    W = np.divide(table["magnetic"].to_numpy(), factor, out=np.zeros(len(factor)), where=factor > 0.0)
    stops = np.arange(1, 17) / 16
    at = [int(np.argmin(np.abs(factor - stop))) for stop in stops]
    assert np.abs(factor[at] - stops).max() < 1e-12
    errors = []
    for every in (4, 2, 1):
        s, w = factor[at][3::every], W[at][3::every]
        change = elastic[at][-1] - elastic[at][3] + W[at][-1] * 1.0 - W[at][3] * 0.25
        errors.append(abs(np.trapezoid(w, s) - change) / elastic[-1])
    assert errors[2] < 2e-3
    assert 3.0 < errors[0] / errors[1] < 5.0
    assert 3.0 < errors[1] / errors[2] < 5.0


def test_they_snap_together_at_a_limit_point() -> None:
    """The load factor turns; pivots are not told, bifurcations not sought; the mode is the direction of the path."""
    stage = ms.Stage(control="displacement", probe="tip", component=3, target=-1.5e-3)
    path = ms.solve(two_strips(J, stage))
    (point,) = path.critical_points
    assert point.kind == "limit point"
    assert point.load_factor > path.steps[-1].load_factor + 1e-3
    assert all(step.negative_pivots is None for step in path.steps)
    tip = path.model.probe_nodes["tip"]
    assert -0.5 * GAP / 2 < point.state.u[tip, 2] < -0.25 * GAP / 2
    assert abs(point.mode[tip, 2]) == pytest.approx(1.0, abs=0.05)


def test_a_couple_has_its_work(repelling) -> None:
    """The couple of the paper bends by 10 % otherwise and has no energy; its work is counted."""
    path = ms.solve(two_strips(-J, ms.Stage(stops=16), ms.MicropolarCouple()))
    table = path.table()
    assert table["magnetic"].isna().all()
    assert path.probe("tip").u3[-1] == pytest.approx(repelling[0].probe("tip").u3[-1], rel=0.02)
    assert table["work_field"].iloc[-1] == pytest.approx(table["elastic"].iloc[-1], rel=0.02)


def test_files_have_what_the_body_adds(repelling) -> None:
    path, _ = repelling
    written = grid(path.discretisation, path.steps[-1])
    own = written.cell_data["self_flux_density"]
    assert 1e-4 < np.linalg.norm(own, axis=1).max() < J
    assert not written.point_data["flux_density"].any(), "no field is applied"


def test_buckling_refuses_it() -> None:
    with pytest.raises(InputError, match="leave self_field out"):
        ms.buckling(two_strips(J, ms.Stage()))
