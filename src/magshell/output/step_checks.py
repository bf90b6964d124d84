"""Whether a step that was read can be one of a model's path: results folders may be of unknown origin."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from magshell.model.model import Model
from magshell.shell.state import State
from magshell.shell.unknowns import COMPONENTS
from magshell.solver.critical import BIFURCATION, LIMIT_POINT, CriticalPoint
from magshell.solver.goals import goals_of
from magshell.solver.path import Path
from magshell.solver.waypoint import Waypoint

# Of a quaternion's length from 1; of a field from that of the problem, relative.
ROUND_OFF = 1e-6
# Displacements in sizes of the body that no state has.
FAR = 1e6
# A step's arrays and those of so many critical points are the most that a file holds.
MOST_CRITICAL_POINTS = 100
_FLOATS_OF_A_NODE, _FLOATS_OF_A_MODE, _REST = 37, 6, 2**20


def most_bytes(model: Model) -> int:
    """Size of the largest file that a step of a model may have."""
    mesh = model.shell.mesh
    floats = (
        _FLOATS_OF_A_NODE * len(model.rows.of) + _FLOATS_OF_A_MODE * len(mesh.elements) * model.shell.element.vectors
    )
    return _REST + 8 * (MOST_CRITICAL_POINTS + 1) * floats


def fault_of(waypoint: Waypoint, before: Waypoint | None, model: Model) -> str | None:
    """Fault that no step of the model can have, in a few words; None if there is none.

    Parameters
    ----------
    waypoint : Waypoint
        With a state of the model's mesh.
    before : Waypoint or None
        The step before it.
    model : Model
    """
    return next(_faults(waypoint, before, model), None)


def _faults(waypoint: Waypoint, before: Waypoint | None, model: Model) -> Iterator[str]:
    step = waypoint.step
    previous = before.step.stage if before else 0
    if not previous <= step.stage < len(model.stages):
        yield f"stage is {step.stage + 1}, of {len(model.stages)}, after {previous + 1}"
    if before is None and (step.load_factor or np.any(step.state.u)):
        yield "the first step is not the undeformed state"
    if before is not None and step.stage == previous and step.arc_length < before.step.arc_length:
        yield f"arc_length is {step.arc_length:g}, after {before.step.arc_length:g}"
    if step.flux_density.shape != (3,) or step.loads.shape != (len(model.loads),):
        yield f"flux_density and loads have the shapes {step.flux_density.shape} and {step.loads.shape}"
    counts = (step.iterations, waypoint.taken, waypoint.cuts, waypoint.solves)
    if any(not 0 <= count < 2**53 for count in counts) or min(waypoint.radius, waypoint.cpu_seconds, step.residual) < 0:
        yield "a count, radius, residual or time is negative or too large"
    yield from _faults_of_state(step.state, model, "")
    slope = waypoint.slope
    yield from _of_shape("slope_increment", slope.increment.nodal, (len(model.rows.of), COMPONENTS))
    yield from _of_shape("slope_alpha", slope.increment.alpha, step.state.alpha.shape)
    if step.balance is not None:
        for name, values in step.balance._asdict().items():
            yield from _of_shape(f"balance_{name}", values, () if name.endswith(("_imbalance", "_scale")) else (3,))
    for number, point in enumerate(waypoint.critical_points, start=1):
        yield from _faults_of_critical(point, f"critical{number}_", model)


def _faults_of_state(state: State, model: Model, prefix: str) -> Iterator[str]:
    mesh = model.shell.mesh
    nodes = len(model.rows.of)
    alpha = (len(mesh.elements), model.shell.element.vectors, 3)
    shapes = {"u": (nodes, 3), "w": (nodes, 3), "phi": (nodes,), "q": (nodes, 4), "s": (nodes,), "alpha": alpha}
    for name, shape in shapes.items():
        yield from _of_shape(prefix + name, getattr(state, name), shape)
    far = np.flatnonzero(np.abs(state.u).max(axis=1) > FAR * mesh.size)
    if far.size:
        yield f"{prefix}u of node {model.rows.of[far[0]]} is {np.abs(state.u[far[0]]).max():g} m"
    stretched = np.flatnonzero(np.abs(np.linalg.norm(state.q, axis=1) - 1.0) > ROUND_OFF)
    if stretched.size:
        yield f"{prefix}q of node {model.rows.of[stretched[0]]} is not a unit quaternion"


def _of_shape(name: str, values: np.ndarray, shape: tuple[int, ...]) -> Iterator[str]:
    if np.shape(values) != shape or np.asarray(values).dtype != np.float64:
        yield f"{name} has the shape {np.shape(values)}, not {shape}"


def _faults_of_critical(point: CriticalPoint, prefix: str, model: Model) -> Iterator[str]:
    if point.kind not in (BIFURCATION, LIMIT_POINT):
        yield f"{prefix}kind is neither '{LIMIT_POINT}' nor '{BIFURCATION}'"
    if not 0 <= point.stage < len(model.stages):
        yield f"{prefix}stage is {point.stage + 1}, of {len(model.stages)}"
    yield from _of_shape(f"{prefix}flux_density", point.flux_density, (3,))
    yield from _of_shape(f"{prefix}mode", point.mode, (len(model.rows.of), COMPONENTS))
    yield from _faults_of_state(point.state, model, prefix)


def fault_of_path(path: Path) -> tuple[int, str] | None:
    """Number of the first step whose field or loads are not those of the problem at its load factor, and what is."""
    for step in path.steps[1:]:
        there = path.loading(step)
        for name, own, expected in (
            ("flux_density", step.flux_density, there.flux_density),
            ("loads", step.loads, there.loads),
        ):
            scale = max(float(np.abs(expected).max(initial=0.0)), path.model.field_magnitude if name[0] == "f" else 1.0)
            if np.abs(own - expected).max(initial=0.0) > ROUND_OFF * scale:
                return step.number, f"{name} is {own.tolist()}, but the problem has {expected.tolist()} there"
    last = path.trail[-1]
    if not 0 <= last.goal <= len(goals_of(path.model, path.courses[last.step.stage])):
        return last.step.number, f"goal is {last.goal}, which the stage does not have"
    return None
