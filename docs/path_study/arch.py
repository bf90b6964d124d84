"""A magnetic arch that snaps: its loop over a field cycle, and the same states met again."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

import magshell as ms
from magshell import problem
from magshell.output.style import ACCENT, COLOURS, GREY, INK, PALE
from path_study.page import LABEL, LEGEND, TEXT, Findings, draw, dress, figure, legend_of_marks, table
from path_study.runs import Place, Runs, Trace, profile

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

CYCLES = 2
TARGETS = tuple(-1e-3 * value for value in (0.3, 0.6, 0.9, 1.2, 1.5, 1.8, 2.1))
"""Deflections of the crown, m, three of them on the unstable part."""
FINE = ms.Settings(largest_step=0.06)


def cycled() -> ms.Model:
    """The built-in arch: field down and up, twice, then off."""
    model = problem.load("magnetic-arch").model
    field: Any = model.field
    empty = {"up": (2 / 3,), "down": (1 / 3,)}
    ways = ["down", "up"] * CYCLES
    stages = [ms.Stage(way, "arc-length", empty[way] if number else ()) for number, way in enumerate(ways)]
    stages.append(ms.Stage("off", "arc-length"))
    return replace(model, field=replace(field, history=(*field.history[:2] * CYCLES, 0.0)), stages=stages)


def conservative() -> ms.Model:
    """The first way down with a coupling law that has an energy, so that the tangent is symmetric."""
    model = problem.load("magnetic-arch").model
    field: Any = model.field
    stages = (ms.Stage("down", "arc-length"),)
    return replace(model, field=replace(field, history=(1.0,)), stages=stages, coupling=ms.DeformationGradientEnergy())


def pressed() -> ms.Model:
    """The crown pressed down, let up and pressed down again, from target to target."""
    model = problem.load("magnetic-arch").model
    field: Any = model.field
    legs = (TARGETS, TARGETS[-2::-1], TARGETS[1:])
    history = [multiplier for leg, multiplier in zip(legs, (1.0, -0.5, 1.0), strict=True) for _ in leg]
    stages = [
        ms.Stage(control="displacement", probe="crown", component=3, target=target) for leg in legs for target in leg
    ]
    return replace(model, field=replace(field, history=history, stops=()), stages=stages)


# -- the same states again -------------------------------------------------------------------------------------------


def at_stops(path: ms.Path) -> dict[str, Any]:
    """Differences of the states met at the same fields, on the same part of the path; and profiles for the picture."""
    field: Any = path.model.field
    stops = [0.0, *field.stops, *(abs(multiplier) * field.magnitude for multiplier in field.history)]
    kept = [step for step in path.steps if np.min(np.abs(np.linalg.norm(step.flux_density) - stops)) < 1e-12]
    found = _differences(kept, lambda one, other: np.abs(one.flux_density - other.flux_density).max() < 1e-12)
    limits = [point for point in path.critical_points if point.kind == "limit point"][:2]
    gone = next(step for step in path.steps if step.stage == 1 and abs(step.flux_density[2]) < 1e-12)
    return found | {
        "shapes": [profile(path, at) for at in (path.steps[0], limits[0], gone, limits[1])],
        "fields": [-1e3 * float(at.flux_density[2]) for at in (path.steps[0], limits[0], gone, limits[1])],
    }


def at_targets(path: ms.Path) -> dict[str, Any]:
    """Differences of the states, and of their fields, met at the same deflections."""
    last = [one for one, next_one in pairwise(path.steps) if next_one.stage != one.stage] + [path.steps[-1]]
    targets = [stage.target for stage in path.model.stages]
    found = _differences(last, lambda one, other: targets[one.stage] == targets[other.stage])
    fields = {
        target: [float(step.flux_density[2]) for step in last if targets[step.stage] == target] for target in TARGETS
    }
    strongest = max(abs(value) for values in fields.values() for value in values)
    return found | {
        "field": max(max(values) - min(values) for values in fields.values()) / strongest,
        "unstable": len({targets[step.stage] for step in last if step.negative_pivots}),
    }


def _differences(steps: Sequence[ms.Step], same: Any) -> dict[str, Any]:
    """Number of states that were met more than once, how often at all, and their largest difference.

    The difference of displacements is over the largest anywhere on the path, that of rotations is in rad.
    """
    groups: list[list[ms.Step]] = []
    for step in steps:
        home = next((group for group in groups if same(group[0], step) and _near(group[0], step)), None)
        if home is None:
            groups.append([step])
        else:
            home.append(step)
    again = [group for group in groups if len(group) > 1]
    largest = max(float(np.abs(step.state.u).max()) for step in steps)
    pairs = [(group[0].state, step.state) for group in again for step in group[1:]]
    return {
        "states": len(again),
        "times": sum(len(group) for group in again),
        "u": max(float(np.abs(one.u - other.u).max()) for one, other in pairs) / largest,
        "q": max(2.0 * float(np.abs(one.q - other.q).max()) for one, other in pairs),
    }


def _near(one: ms.Step, other: ms.Step) -> bool:
    """On the same part of the path (parts at one field are a thickness apart)."""
    return float(np.abs(one.state.u - other.state.u).max()) < 1e-5


# -- page ------------------------------------------------------------------------------------------------------------


def study(runs: Runs) -> Findings:
    """The loop, its critical points, and how well it closes."""
    loop = runs.of("arch, cycled", cycled, FINE, at_stops)
    held = runs.of("arch, pressed", pressed, None, at_targets)
    symmetric = runs.of("arch, deformation-gradient", conservative)
    for trace in (loop, held, symmetric):
        if trace.reason:
            raise SystemExit(f"arch: {trace.reason}")
    return Findings({"arch": _closed(loop, held), "arch-points": _points(loop, symmetric)}, {"arch": _picture(loop)})


def _closed(loop: Trace, held: Trace) -> str:
    one, two = loop.measured, held.measured
    limits = sorted(down(place) for place in loop.critical if place.kind == "limit point")
    half = len(limits) // 2
    spread = max(np.ptp(limits[:half]), np.ptp(limits[half:])) / max(np.abs(limits))
    return (
        f"Around the loop {CYCLES} times by arc length: {one['states']} states, at the stops, are met {one['times']} "
        f"times; they differ by {one['u']:.0e} of the largest displacement and {one['q']:.0e} rad. The limit points, "
        f"met {len(limits)} times, agree to {spread:.0e} of the field.\n\n"
        f"The crown pressed down, let up and pressed down again by displacement control: {two['states']} states, "
        f"{two['unstable']} of them unstable, are met {two['times']} times; they differ by {two['u']:.0e} and "
        f"{two['q']:.0e} rad, their fields by {two['field']:.0e}."
    )


def _points(loop: Trace, symmetric: Trace) -> str:
    first = [place for place in loop.critical if place.stage == 0]
    rows = [
        [
            place.kind, f"{down(place):.3f}", f"{crown(place):.3f}", _counts(place),
            f"{down(other):.3f}", _counts(other),
        ]
        for place, other in zip(first, symmetric.critical, strict=True)
    ]  # fmt: skip
    header = ("On the way down", "Field (mT)", "$u_3$ of the crown (mm)", "Negative pivots",
              "With `deformation-gradient` (mT)", "Negative pivots")  # fmt: skip
    return table(header, rows)


def _counts(place: Place) -> str:
    return f"{place.pivots[0]} → {place.pivots[1]}"


def down(place: Place) -> float:
    """Field downward, mT."""
    return -place.flux_density[2]


def crown(place: Place) -> float:
    """u3 of the crown, mm."""
    return place.u("crown", 3)


def _picture(loop: Trace) -> Figure:
    new = figure((13.0, 6.0))
    left, right = new.subplots(1, 2, width_ratios=(1.25, 1.0))
    dress(left, "field downward (mT)", "$u_3$ of the crown (mm)")
    draw(left, [loop.stages(0)[-1], *loop.stages(1)], down, crown, COLOURS[0])
    limits = [place for place in loop.stages(1) if place.kind == "limit point"]
    for number, (limit, to) in enumerate(_jumps(loop.stages(1), limits)):
        start, end = crown(limit), to
        arrow = {"arrowstyle": "-|>,head_width=0.35,head_length=0.7", "color": INK, "linewidth": 1.8, "shrinkA": 6}
        left.annotate("", (down(limit), end), (down(limit), start), arrowprops=arrow)
        side = 1 if number else -1
        left.annotate(
            f"{'snaps back' if number == 0 else 'snaps'}\n{down(limit):.2f} mT", (down(limit), 0.5 * (start + end)),
            (10 * side, 0), textcoords="offset points", ha="left" if side > 0 else "right", va="center", **TEXT,
        )  # fmt: skip
    _ways(left)
    legend_of_marks(left, ["limit point", "bifurcation"])
    left.legend(loc="upper right", **LEGEND)
    left.set_ylim(-2.6, 0.75)
    _shapes(right, loop.measured)
    return new


def _jumps(places: Sequence[Place], limits: Sequence[Place]) -> Iterator[tuple[Place, float]]:
    """Each limit point and the crown's displacement in the other stable state at its field."""
    for limit in limits:
        away = [(down(place) - down(limit), crown(place)) for place in places if place.kind == "step" and place.stable]
        across = [sorted(pair) for pair in pairwise(away) if pair[0][0] * pair[1][0] <= 0.0]
        values = [float(np.interp(0.0, *np.transpose(pair))) for pair in across]
        yield limit, max(values, key=lambda value: abs(value - crown(limit)))


def _ways(axes: Axes) -> None:
    """Which way the loop is run."""
    arrow = {"arrowstyle": "-|>,head_width=0.25,head_length=0.5", "color": GREY, "linewidth": 1.4}
    axes.annotate("", (3.0, -0.13), (1.8, 0.0), arrowprops=arrow)
    axes.annotate("", (2.2, -2.32), (3.6, -2.42), arrowprops=arrow)


def _shapes(axes: Axes, measured: dict[str, Any]) -> None:
    words = ("no field", "about to snap", "snapped, field off again", "about to snap back")
    looks = ((COLOURS[0], "-"), (COLOURS[0], (0, (3, 2))), (ACCENT, "-"), (ACCENT, (0, (3, 2))))
    for shape, word, field, (colour, line) in zip(measured["shapes"], words, measured["fields"], looks, strict=True):
        x, z = np.array(shape).T
        label = word if abs(field) < 1e-9 else f"{word}, {field:.2f} mT"
        axes.plot(x, z - 44.0, color=colour, linestyle=line, linewidth=3.0, label=label, solid_capstyle="butt")
    ends = np.array(measured["shapes"][0])[[0, -1]]
    axes.plot(ends[:, 0], ends[:, 1] - 44.0, "o", markersize=9, color=PALE, markeredgecolor=GREY)
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.set_ylim(-6.5, 3.0)
    axes.legend(loc="lower center", **LEGEND)
    axes.text(0.0, 2.4, "the arch from the side, to scale", ha="center", **TEXT)
    axes.set_xlabel("", **LABEL)
