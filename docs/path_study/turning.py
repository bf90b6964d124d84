"""A strip in a field that turns at constant magnitude, and one that carries its weight before the field comes."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

import magshell as ms
from magshell.output.style import ACCENT, COLOURS, GREY
from path_study.page import LEGEND, TEXT, Findings, draw, dress, figure, legend_of_marks, table
from path_study.runs import Place, Runs, Trace, profile
from path_study.strip import LAME, LENGTH, MU, REMANENCE, THICKNESS, WIDTH, strip, tip

if TYPE_CHECKING:
    from matplotlib.axes import Axes

WEAK, STRONG = 3e-3, 6e-3
"""Below and above the field at which the strip buckles when it is reversed, T."""
LIFTING = 5e-3
TURNED, THIN = 5e-3, 0.42e-3
HOLDS = {
    "at both corners of one end and the middle of the other": ((0.0, 0.0), (0.0, 1.0), (1.0, 0.5)),
    "at three corners": ((0.0, 0.0), (0.0, 1.0), (1.0, 0.0)),
    "at both corners of one end and half-way along a side": ((0.0, 0.0), (0.0, 1.0), (0.5, 0.0)),
    "at both corners of one end and a quarter along a side": ((0.0, 0.0), (0.0, 1.0), (0.25, 0.0)),
    "at both corners of one end and an eighth along a side": ((0.0, 0.0), (0.0, 1.0), (0.125, 0.0)),
    "across its middle": ((0.5, 0.0), (0.5, 1.0), (0.625, 0.0)),
}
"""Three points that hold a thin strip, in parts of its length and width."""
DENSITY = 2400.0
FINE = ms.Settings(largest_step=0.04)


def turning(magnitude: float) -> ms.Model:
    """A field along the strip first, which then turns once around."""
    field = ms.UniformField(
        (magnitude, 0.0, 0.0), history=(1.0, 1.0), rotation_axis=(0.0, -1.0, 0.0), rotation=(0.0, 2.0 * math.pi)
    )
    return replace(strip(), field=field, stages=(ms.Stage("on"), ms.Stage("around", "arc-length")))


def held(hold: str, elements: tuple[int, int] = (8, 2)) -> ms.Model:
    """A thin strip on three points, which hold it as a body and no more, in a field that turns once around."""
    mesh = ms.mesh.rectangle(LENGTH, WIDTH, elements)
    for name, (along, across) in zip("abc", HOLDS[hold], strict=True):
        mesh = mesh.select_nodes(name, x1=along * LENGTH, x2=across * WIDTH)
    held = [("a", 1), ("a", 2), ("a", 3), ("b", 1), ("b", 3), ("c", 3)]
    material = ms.MicropolarNeoHookean(MU, LAME, MU / 10, THIN / 10)
    return ms.Model(
        ms.Shell(mesh, THIN, material, ms.remanence.constant((REMANENCE, 0, 0))),
        [ms.Prescribe(name, "u", component, 0.0) for name, component in held],
        ms.UniformField((TURNED, 0, 0), history=(1, 1), rotation_axis=(0, 1, 0), rotation=(0, 2.0 * math.pi)),
        stages=[ms.Stage(), ms.Stage()],
    )


def weighed(order: tuple[str, ...]) -> ms.Model:
    """Weight and an upward field, one after the other in this order; then the field goes again."""
    mesh = ms.mesh.rectangle(LENGTH, WIDTH, (20, 2))
    material = ms.MicropolarNeoHookean(MU, LAME, MU / 10, THICKNESS / 10)
    shell = ms.Shell(mesh, THICKNESS, material, ms.remanence.constant((REMANENCE, 0, 0)), density=DENSITY)
    weight, field = ((1.0, 1.0, 1.0), (0.0, 1.0, 0.0)) if order[0] == "weight" else ((0.0, 1.0, 1.0), (1.0, 1.0, 0.0))
    return ms.Model(
        shell,
        supports=[ms.Clamp("left")],
        field=ms.UniformField((0.0, 0.0, LIFTING), history=field),
        loads=[ms.Gravity((0.0, 0.0, -9.81), history=weight)],
        probes={"tip": (LENGTH, 0.5 * WIDTH, 0.0)},
        stages=[ms.Stage(), ms.Stage(), ms.Stage()],
    )


def shapes_around(path: ms.Path) -> dict[str, Any]:
    """Edges at some angles, and the last state's distance from the straight one."""
    limits = [point for point in path.critical_points if point.kind == "limit point"]
    largest = max(float(np.abs(step.state.u).max()) for step in path.steps)
    around = [step for step in path.steps if step.stage == 1]
    wanted = (45.0, 90.0, 135.0)
    shown = [min(around, key=lambda step: abs(360.0 * step.load_factor - angle)) for angle in wanted]
    shown += limits
    return {
        "angles": [360.0 * at.load_factor for at in shown],
        "shapes": [profile(path, at) for at in shown],
        "closed": float(np.abs(path.steps[-1].state.u).max()) / largest,
    }


def ends(path: ms.Path) -> dict[str, Any]:
    """Displacements of all nodes, mm, and edges at the end of every stage."""
    last = {step.stage: step for step in path.steps}
    return {
        "u": [(1e3 * last[stage].state.u).tolist() for stage in range(3)],
        "shapes": [profile(path, step) for step in (path.steps[0], last[0], last[1])],
    }


def study(runs: Runs) -> Findings:
    """One picture, and what closes."""
    around = {
        field: runs.of(f"turning, {1e3 * field:g} mT", lambda field=field: turning(field), FINE, shapes_around)
        for field in (WEAK, STRONG)
    }
    first, other = (
        runs.of(f"weight, {order[0]} first", lambda order=order: weighed(order), FINE, ends)
        for order in (("weight", "field"), ("field", "weight"))
    )
    for trace in (*around.values(), first, other):
        if trace.reason:
            raise SystemExit(trace.reason)
    one, two = (np.array(trace.measured["u"]) for trace in (first, other))
    same, back = (
        float(np.abs(difference).max()) / float(np.abs(one).max()) for difference in (one[1] - two[1], one[0] - one[2])
    )
    turns = " and ".join(f"{angle(place):.2f}°" for place in around[STRONG].critical)
    straight = max(trace.measured["closed"] for trace in around.values())
    words = (
        f"After the full turn the strip is straight again, to {straight:.0e} of its largest displacement. At "
        f"{1e3 * STRONG:g} mT the path turns back at {turns}. Weight and field in either order end in the same state, "
        f"to {same:.0e}; without the field the strip sags again as before, to {back:.0e}."
    )
    rows = [_held_row(hold, runs.of(f"held {hold}", lambda hold=hold: held(hold))) for hold in HOLDS]
    head = [
        "Held",
        "Steps",
        "of them unstable",
        "Cuts",
        "Linear solves",
        "Limit points",
        "Runs back by (°)",
        "Reaches (°)",
    ]
    new = figure((13.0, 9.0))
    panels = new.subplot_mosaic([["angle", "weight"], ["around", "sagging"]], height_ratios=(1.2, 1.0))
    _angle_panel(panels["angle"], around)
    _weight_panel(panels["weight"], {"weight, then field": first, "field, then weight": other})
    _around_panel(panels["around"], around[STRONG].measured)
    _sagging_panel(panels["sagging"], first.measured["shapes"])
    return Findings({"turning": words, "turning-held": table(head, rows)}, {"turning": new})


def _held_row(hold: str, trace: Trace) -> list[str]:
    around = [place for place in trace.stages(1) if place.kind == "step"]
    angles = [0.0, *(angle(place) for place in around)]
    back = sum(max(before - after, 0.0) for before, after in pairwise(angles))
    figures = [
        sum(place.kind == "step" for place in trace.places) - 1, sum(not place.stable for place in around), trace.cuts,
        trace.solves, sum(place.kind == "limit point" for place in trace.critical),
    ]  # fmt: skip
    return [hold, *map(str, figures), f"{back:.0f}", f"{angles[-1]:.0f}"]


def angle(place: Place) -> float:
    """Of the field, degrees; it turns in the second stage."""
    return 360.0 * place.load_factor * place.stage


def _angle_panel(axes: Axes, around: dict[float, Any]) -> None:
    dress(axes, "angle between field and undeformed strip (degrees)", "$u_3/L$ of the tip")
    axes.set_xticks(range(0, 361, 60))
    for colour, (field, trace) in zip((COLOURS[0], ACCENT), around.items(), strict=True):
        draw(axes, [trace.stages(0)[-1], *trace.stages(1)], angle, tip, colour, f"{1e3 * field:g} mT")
    legend_of_marks(axes, ["limit point"])
    axes.legend(loc="upper right", **LEGEND)


def _weight_panel(axes: Axes, traces: dict[str, Trace]) -> None:
    dress(axes, "field upward (mT)", "")
    for colour, (label, trace) in zip(COLOURS[2:4], traces.items(), strict=True):
        draw(axes, trace.stages(0, 1), lambda place: place.flux_density[2], tip, colour, label)
    axes.legend(loc="lower right", **LEGEND)


def _around_panel(axes: Axes, measured: dict[str, Any]) -> None:
    for number, (at, shape) in enumerate(zip(measured["angles"], measured["shapes"], strict=True)):
        end, way = np.array(shape[-1]), np.array([math.cos(math.radians(at)), math.sin(math.radians(at))])
        colour = COLOURS[number]
        arrow = {"arrowstyle": "-|>,head_width=0.2,head_length=0.4", "color": colour, "linewidth": 1.4}
        axes.plot(*np.array(shape).T, color=colour, linewidth=3.0)
        axes.annotate("", end + 2.4 * way, end, arrowprops=arrow, annotation_clip=False)
        beside = 3.6 * way if at < 150.0 else np.array([2.2, 0.0])
        axes.text(*(end + beside), f"{at:.0f}°", color=colour, fontsize=12, ha="center", va="center")
    _side_view(axes, f"in a turning field of {1e3 * STRONG:g} mT; arrows: the field")


def _sagging_panel(axes: Axes, shapes: list[Any]) -> None:
    words = ("nothing", "weight", f"weight and {1e3 * LIFTING:g} mT")
    for word, colour, shape in zip(words, (GREY, COLOURS[0], COLOURS[2]), shapes, strict=True):
        axes.plot(*np.array(shape).T, color=colour, linewidth=3.0)
        axes.annotate(word, shape[-1], (8, 0), textcoords="offset points", color=colour, fontsize=12, va="center")
    _side_view(axes, "under its weight, and lifted by the field")


def _side_view(axes: Axes, title: str) -> None:
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.set_xlim(-1.0, 27.0)
    axes.text(0.5, -0.04, title, ha="center", va="top", transform=axes.transAxes, **TEXT)
