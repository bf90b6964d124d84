"""The curves of a page, what they can be drawn against, and the probes that have them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from magshell.output.abscissa import FIELD, abscissae
from magshell.output.curve import LOAD_TEXT, displacements, load_per_mT
from magshell.output.series import LONGEST_NAME, Curve, Group, groups, shorten, some

if TYPE_CHECKING:
    from magshell.solver.critical import CriticalPoint
    from magshell.solver.path import Path
    from magshell.solver.step import Step


def over(path: Path) -> list[dict[str, Any]]:
    """What curves can be drawn against: at all steps, and at the critical points."""
    scale = load_per_mT(path)
    return [
        {
            "name": one.name,
            "label": one.text,
            "x": one.of(path.steps).tolist(),
            "critical": one.of(path.critical_points).tolist(),
            "above": {"factor": scale, "label": LOAD_TEXT} if one.name == FIELD and scale > 0 else None,
        }
        for one in abscissae(path)
    ]


def curves(path: Path) -> list[dict[str, Any]]:
    """Displacements as `magshell.output.curve` draws them, mm, and each group of `magshell.output.series`."""
    points: list[Step | CriticalPoint] = [*path.steps, *path.critical_points]
    drawn, note = some(displacements(path, points), len(path.model.probe_nodes))
    drawn = sorted(drawn, key=lambda curve: -curve.values[len(path.steps) - 1])
    critical = [
        {
            "y": [float(1e3 * curve.values[len(path.steps) + number]) for curve in drawn],
            "label": f"{point.kind}, load factor {point.load_factor:.4g} of stage {point.stage + 1}",
        }
        for number, point in enumerate(path.critical_points)
    ]
    return [
        _group("displacement", "displacement (mm)", 1e3, drawn, len(path.steps), note) | {"critical": critical},
        *(_of_series(group, len(path.steps)) for group in groups(path)),
    ]


def _of_series(group: Group, steps: int) -> dict[str, Any]:
    drawn, note = some(group.curves)
    return _group(group.name, group.title, group.factor, drawn, steps, note)


def _group(name: str, title: str, factor: float, drawn: Sequence[Curve], steps: int, note: str) -> dict[str, Any]:
    lines = [
        {
            "label": shorten(curve.name, LONGEST_NAME),
            "component": curve.letter,
            "colour": curve.style["color"],
            "dash": curve.style["linestyle"],
            "marker": curve.style["marker"],
            "y": (factor * curve.values[:steps]).tolist(),
        }
        for curve in drawn
    ]
    return {"name": name, "ylabel": title, "lines": lines, "critical": [], "note": note}


def probes(path: Path) -> list[dict[str, Any]]:
    """Name, node and colour of each probe: the colour of its curves where they have one of their own."""
    names = path.model.probe_nodes
    drawn, _ = some(displacements(path), len(names))
    colours = {curve.name: curve.style["color"] for curve in drawn} if len(names) > 1 else {}
    return [{"name": name, "node": int(node), "colour": colours.get(name)} for name, node in names.items()]
