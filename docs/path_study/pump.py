"""The pump through its snap, by arc length, on three meshes."""

from __future__ import annotations

from dataclasses import replace

import magshell as ms
from magshell import problem
from magshell.output.style import COLOURS
from magshell.problem.building import build
from path_study.page import LABEL, LEGEND, Findings, draw, dress, figure, legend_of_marks, table
from path_study.runs import Place, Runs, Trace

MESHES = ((12, 10), (18, 15), (24, 20))
TOP = 45e-3


def pump(divisions: tuple[int, int]) -> ms.Model:
    """The built-in pump on another mesh, driven by arc length to 45 mT."""
    source, file = problem.read("pump")
    mesh = file.mesh.model_copy(update={"elements": divisions})
    model = build(file.model_copy(update={"mesh": mesh}), source).model
    return replace(model, field=ms.UniformField((0.0, 0.0, TOP)), stages=(ms.Stage(control="arc-length"),))


def side(place: Place) -> float:
    """|u1| at B, mm."""
    return -place.u("B", 1)


def strength(place: Place) -> float:
    """The field, mT."""
    return place.flux_density[2]


def study(runs: Runs) -> Findings:
    """Table of the limit points, picture of the fold."""
    traces = {f"{n} × {m}": runs.of(f"pump {n}x{m}", lambda mesh=(n, m): pump(mesh)) for n, m in MESHES}
    rows = [_row(mesh, trace) for mesh, trace in traces.items()]
    header = ("Mesh", "Unknowns", "Turns at (mT)", "and at (mT)", "$\\lvert u_1\\rvert$ at B there (mm)",
              "and there (mm)", "Negative pivots", "Steps", "Solves")  # fmt: skip
    new = figure((13.0, 5.4))
    whole, near = new.subplots(1, 2, width_ratios=(1.0, 1.4))
    for place, (mesh, trace) in enumerate(traces.items()):
        for axes in (whole, near):
            dress(axes, "field (mT)", "")
            draw(axes, trace.places, strength, side, COLOURS[(0, 2, 3)[place]], mesh if axes is near else "")
    whole.set_ylabel(r"$|u_1|$ at B (mm)", **LABEL)
    near.set_xlim(32.0, 34.4)
    near.set_ylim(7.5, 9.7)
    legend_of_marks(near, ["limit point"])
    near.legend(loc="upper left", **LEGEND)
    return Findings({"pump": table(header, rows)}, {"pump": new})


def _row(mesh: str, trace: Trace) -> list[str]:
    if trace.reason:
        raise SystemExit(f"pump {mesh}: {trace.reason}")
    turns = trace.critical
    pivots = ", ".join(f"{place.pivots[0]} → {place.pivots[1]}" for place in turns)
    steps = sum(place.kind == "step" for place in trace.places) - 1
    return [
        mesh, str(trace.unknowns), *(f"{strength(place):.3f}" for place in turns),
        *(f"{side(place):.3f}" for place in turns), pivots, str(steps), str(trace.solves),
    ]  # fmt: skip
