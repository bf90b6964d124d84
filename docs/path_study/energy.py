"""Work of dead loads along a path against the strain energy at its end."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

import magshell as ms
from magshell.evaluation.converged import converged
from magshell.output.style import COLOURS, PALE
from path_study.page import LEGEND, Findings, dress, figure, table
from path_study.runs import Runs
from path_study.strip import LAME, LENGTH, MU, THICKNESS, WIDTH

if TYPE_CHECKING:
    from matplotlib.figure import Figure

STEPS = (4, 8, 16, 32, 64)


def loaded(steps: int) -> ms.Model:
    """The strip, not magnetised, bent far by three times its weight and a force on its end."""
    mesh = ms.mesh.rectangle(LENGTH, WIDTH, (12, 2))
    material = ms.MicropolarNeoHookean(MU, LAME, MU / 10, THICKNESS / 10)
    return ms.Model(
        ms.Shell(mesh, THICKNESS, material, density=2400.0),
        supports=[ms.Clamp("left")],
        loads=[ms.Gravity((0.0, 0.0, -30.0)), ms.Force("right", (-1e-3, 0.0, -1e-3))],
        probes={"tip": (LENGTH, 0.5 * WIDTH, 0.0)},
        stages=[ms.Stage(stops=[number / steps for number in range(1, steps)])],
    )


def balance(path: ms.Path) -> dict[str, float]:
    """Work by the trapezoidal and by Simpson's rule, and strain energy, J.

    The forces are λ F, with the load factor λ and constant F: the work is ∫ λ F·du. Integrated by parts it is
    λ F·u - ∫ F·u dλ at the end, where F·u is a function of λ known at equal distances, as Simpson's rule needs it.
    """
    forces = path.discretisation.loads.forces(path.steps[0].state, np.ones(len(path.model.loads)))[:, :3]
    load = np.array([step.load_factor for step in path.steps])
    moved = np.array([float(np.vdot(forces, step.state.u)) for step in path.steps])
    wanted = np.linspace(0.0, 1.0, len(path.courses[0].stops()) + 1)
    at = [int(np.abs(load - value).argmin()) for value in wanted]
    load, moved = load[at], moved[at]
    trapezoid = sum(0.5 * (a + b) * (v - u) for (a, b), (u, v) in zip(pairwise(load), pairwise(moved), strict=True))
    weights = np.ones(len(at))
    weights[1:-1:2], weights[2:-1:2] = 4.0, 2.0
    simpson = moved[-1] - float(weights @ moved) / (3.0 * (len(at) - 1))
    energy = float(converged(path.discretisation, path.steps[-1]).energies[:, 0].sum())
    return {"trapezoid": float(trapezoid), "simpson": simpson, "energy": energy}


def study(runs: Runs) -> Findings:
    """Difference against the number of steps, with its order."""
    settings = ms.Settings(tolerance=1e-11)
    found = [runs.of(f"energy, {n} steps", lambda n=n: loaded(n), settings, balance).measured for n in STEPS]
    off = {rule: np.array([abs(one[rule] / one["energy"] - 1.0) for one in found]) for rule in ("trapezoid", "simpson")}
    rows = []
    for number, steps in enumerate(STEPS):
        row = [str(steps)]
        for values in off.values():
            order = math.log2(values[number - 1] / values[number]) if number else math.nan
            row += [f"{values[number]:.1e}", f"{order:.2f}" if number else "–"]
        rows.append(row)
    header = ("Steps", "trapezoidal rule", "order", "Simpson's rule", "order")
    return Findings({"energy": table(header, rows)}, {"energy": _picture(off)})


def _picture(off: dict[str, Any]) -> Figure:
    new = figure((6.5, 4.6))
    axes = dress(new.subplots(), "steps", "|work / stored energy − 1|")
    for colour, (rule, values), order in zip(COLOURS, off.items(), (2, 4), strict=False):
        word = "trapezoidal rule" if rule == "trapezoid" else "Simpson's rule"
        axes.loglog(STEPS, values, "o-", color=colour, linewidth=2.0, markersize=7, label=word)
        line = values[0] * (STEPS[0] / np.array(STEPS, dtype=float)) ** order
        axes.loglog(STEPS, line, color=PALE, linewidth=1.2, linestyle="--", zorder=0)
    axes.loglog([], [], color=PALE, linestyle="--", label="orders 2 and 4")
    axes.set_xticks(STEPS, [str(steps) for steps in STEPS])
    axes.minorticks_off()
    axes.legend(**LEGEND)
    return new
