"""Paths of `docs/path-following.md` on coarse meshes: the arch's loop closes, the strip buckles as the elastica."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

import magshell as ms
from magshell import problem
from magshell.problem.building import build

MU, LAME, REMANENCE = 303e3, 7300e3, 143e-3
YOUNG, POISSON = MU * (3 * LAME + 2 * MU) / (LAME + MU), LAME / (2 * (LAME + MU))
MU0 = 4e-7 * math.pi
CLOSED = 1e-8


# -- arch ------------------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def loop() -> ms.Path:
    """The built-in arch on a coarse mesh, field down, up and off."""
    source, file = problem.read("magnetic-arch")
    mesh = file.mesh.model_copy(update={"elements": (6, 1)})
    return ms.solve(build(file.model_copy(update={"mesh": mesh}), source).model)


def _downward(at: ms.Step | ms.CriticalPoint) -> float:
    return -1e3 * float(at.flux_density[2])


def test_the_loop_is_closed(loop: ms.Path) -> None:
    """Back without field, the arch is undeformed."""
    largest = max(float(np.abs(step.state.u).max()) for step in loop.steps)
    left = float(np.abs(loop.steps[-1].state.u).max()) / largest
    assert np.linalg.norm(loop.steps[-1].flux_density) < 1e-15
    assert left < CLOSED, f"{left:.1e} of the largest displacement is left"


def test_round_off_of_the_unloaded_end_is_no_imbalance(loop: ms.Path) -> None:
    """There every force is round-off, and balances nothing; the path's largest forces say how little it is."""
    summary = loop.summary
    assert max(summary["force_imbalance"], summary["moment_imbalance"]) < 1e-8, summary
    last = loop.steps[-1].balance
    assert last.force_scale < 1e-9 * max(step.balance.force_scale for step in loop.steps[1:])


def _pairs(path: ms.Path) -> Iterator[tuple[ms.Step, ms.Step]]:
    """Steps of different stages with the same field, on the same part of the path."""
    for number, one in enumerate(path.steps):
        for other in path.steps[number + 1 :]:
            same_field = np.abs(one.flux_density - other.flux_density).max() < 1e-14
            if same_field and other.stage != one.stage and np.abs(one.state.u - other.state.u).max() < 1e-5:
                yield one, other


def test_states_are_met_again(loop: ms.Path) -> None:
    largest = max(float(np.abs(step.state.u).max()) for step in loop.steps)
    pairs = list(_pairs(loop))
    fields = sorted({round(_downward(one), 9) for one, _ in pairs})
    worst = max(float(np.abs(one.state.u - other.state.u).max()) for one, other in pairs) / largest
    assert {-2.0, -1.0, 0.0, 4.0, 5.0} <= set(fields), f"fields met again: {fields}"
    assert worst < CLOSED, f"{worst:.1e} at {fields} mT"


def test_limit_points_are_met_again(loop: ms.Path) -> None:
    """Both on the way down and, in the other order, on the way up; the arch is stable before and behind them."""
    limits = [point for point in loop.critical_points if point.kind == "limit point"]
    assert [point.stage for point in limits] == [0, 0, 1, 1]
    assert [point.negative_pivots for point in limits] == [(0, 1), (1, 0)] * 2
    there, back = [_downward(point) for point in limits[:2]], [_downward(point) for point in limits[:1:-1]]
    assert back == pytest.approx(there, abs=1e-9), f"{there} mT, then {back} mT"
    stable = [step.negative_pivots == 0 for step in loop.steps]
    snapped = [step for step, fine in zip(loop.steps, stable, strict=True) if fine and abs(_downward(step)) < 0.5]
    crown = loop.model.probe_nodes["crown"]
    heights = [1e3 * float(step.state.u[crown, 2]) for step in snapped]
    assert min(heights) < -1.0 < max(heights), f"no two stable shapes near zero field: {heights} mm"


# -- strip -----------------------------------------------------------------------------------------------------------


def strip(plane_strain: bool, stages: tuple[ms.Stage, ...], history: tuple[float, ...], top: float) -> ms.Model:
    """A thin strip without couple stress in a field against its magnetisation, mT."""
    length, thickness = 20e-3, 0.4e-3
    mesh = ms.mesh.rectangle(length, 2 * thickness, (12, 1))
    material = ms.MicropolarNeoHookean(MU, LAME, MU / 10, 1e-3 * thickness)
    sides: list[Any] = [ms.SymmetryPlane(side, (0, 1, 0)) for side in ("bottom", "top")] if plane_strain else []
    return ms.Model(
        ms.Shell(mesh, thickness, material, ms.remanence.constant((REMANENCE, 0, 0))),
        supports=[ms.Clamp("left"), *sides],
        field=ms.UniformField((-1e-3 * top, 0, 0), history=history),
        probes={"tip": (length, 0, 0)},
        stages=stages,
    )


def elastica(young: float) -> float:
    """Field at which a strip with L/h = 50 buckles, q = 12 (Brem B / mu0 E) (L/h)² = π²/4, mT."""
    return 1e3 * math.pi**2 / 4.0 * MU0 * young / (12.0 * REMANENCE * 50.0**2)


@pytest.mark.parametrize(
    ("plane_strain", "young", "tolerance"), [(True, YOUNG / (1.0 - POISSON**2), 2e-3), (False, YOUNG, 8e-3)]
)
def test_buckling_field_of_the_elastica(plane_strain: bool, young: float, tolerance: float) -> None:
    """To (h/L)² = 4e-4 and the mesh; the clamp stiffens a narrow strip over a part of its width, 4 % of the length."""
    expected = elastica(young)
    path = ms.solve(strip(plane_strain, (ms.Stage(),), (1.0,), 1.3 * expected))
    (point,) = path.critical_points
    found = -1e3 * float(point.flux_density[0])
    assert point.kind == "bifurcation"
    assert point.negative_pivots == (0, 1)
    assert found == pytest.approx(expected, rel=tolerance), f"{found / expected - 1:+.2e}"


def test_branches_are_mirror_images() -> None:
    branches = tuple(ms.Stage(control="arc-length", branch=1, side=side) for side in (1, -1))
    top = 2.0 * elastica(YOUNG)
    path = ms.solve(strip(False, (ms.Stage(), *branches), (0.6, 1.0, 1.0), top))
    ends = [next(step for step in reversed(path.steps) if step.stage == stage) for stage in (1, 2)]
    one, other = (step.state.u[path.model.probe_nodes["tip"]] for step in ends)
    assert [step.negative_pivots for step in ends] == [0, 0]
    assert abs(one[2]) > 0.5 * 20e-3, f"the tip moves by {1e3 * one[2]:.2f} mm only"
    assert other == pytest.approx(one * [1, 1, -1], abs=1e-8 * abs(one[2])), f"{one} and {other}"
