"""Trial states: the polynomial through the last converged steps, extrapolated."""

from __future__ import annotations

import numpy as np

from magshell.arrays import FloatArray
from magshell.solver.newton import Trial
from magshell.solver.path import Path


def predicted(path: Path, load_factor: float) -> Trial:
    """Trial state at a load factor, by extrapolation of the last converged steps, its stresses predicted linearly."""
    discretisation, steps = path.discretisation, path.steps
    last = steps[-1]
    if len(steps) == 1:
        imposed = discretisation.imposed(load_factor)
        return Trial(
            last.state, load_factor, discretisation.stresses_at(last.state), imposed if np.any(imposed) else None
        )
    weights = _weights([step.load_factor for step in steps[-4:]], load_factor)
    return _extrapolated(path, weights, load_factor)


def along(path: Path, arc_length: float) -> Trial:
    """Trial state at a length of the path, by the same extrapolation, of the load factor too."""
    history = path.steps[-4:]
    weights = _weights([step.arc_length for step in history], arc_length)
    return _extrapolated(path, weights, float(weights @ [step.load_factor for step in history]))


def at_stop(path: Path, radius: float, stop: float) -> Trial:
    """Trial state where the extrapolated path meets a stop, within a radius from the last state."""
    near, far = path.steps[-1].arc_length, path.steps[-1].arc_length + radius
    lengths, factors = [step.arc_length for step in path.steps[-4:]], [step.load_factor for step in path.steps[-4:]]
    for _ in range(60):
        middle = 0.5 * (near + far)
        near, far = (near, middle) if _weights(lengths, middle) @ factors >= stop else (middle, far)
    return _extrapolated(path, _weights(lengths, far), stop)


def _weights(nodes: list[float], at: float) -> FloatArray:
    """Of the values at up to four nodes, in the polynomial through them."""
    return np.array([np.prod([(at - u) / (t - u) for u in nodes if u != t]) for t in nodes])


def _extrapolated(path: Path, weights: FloatArray, load_factor: float) -> Trial:
    """The weighted sum of the last states, as increments from the last of them, at a load factor."""
    discretisation, last = path.discretisation, path.steps[-1]
    total: FloatArray = np.zeros(())
    total_alpha: FloatArray = np.zeros(())
    for weight, step in zip(weights[:-1], path.steps[-len(weights) : -1], strict=True):
        increment, d_alpha = step.state.increment_from(last.state)
        total = total + weight * increment
        total_alpha = total_alpha + weight * d_alpha
    total = discretisation.with_imposed(total, load_factor - last.load_factor)
    return Trial(
        last.state.moved(total, total_alpha),
        load_factor,
        discretisation.predicted_stresses(last.state, total, total_alpha),
        None,
    )
