"""The numbers of each example beside the paper's; differences of more than one per cent are explained with a number."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

import numpy as np

from magshell.arrays import FloatArray
from magshell.output.bodies import step_at
from magshell.reproduction.contact import INNER, MIDDLE, OUTER, Touch, first_touch, gap
from magshell.reproduction.references import (
    ASPECT_RATIOS,
    MEASURED,
    MEASURED_ON,
    QUOTED,
    SOLID,
    SOLID_FIELDS,
    TOUCHING,
    Quoted,
)
from magshell.reproduction.table import Row
from magshell.reproduction.variants import LARGER, LOCKING, OTHER_ELEMENT, STRETCHES, Stretch, stretched

if TYPE_CHECKING:
    from magshell.solver.path import Path
    from magshell.solver.step import Step

Paths = Mapping[str, "Path"]
WITHOUT = {"none": "no thickness stretch", "plane-stress": "plane stress instead of the thickness stretch"}


def rows_of(example: str, paths: Paths) -> list[Row]:
    """All rows of an example.

    Parameters
    ----------
    example : str
    paths : mapping of str to Path
        Of all its variants, by name.
    """
    return _ROWS[example](paths)


def at_probe(path: Path, probe: str, component: int, field: float) -> float:
    """Component (1, 2, 3) of a probe's displacement at a field in mT, mm."""
    return 1e3 * float(step_at(path, 1e-3 * field).state.u[path.model.probe_nodes[probe], component - 1])


def largest(path: Path, component: int, field: float) -> tuple[float, FloatArray]:
    """Largest size of a displacement component at a field in mT, mm, and the place (3,) in mm."""
    values = np.abs(step_at(path, 1e-3 * field).state.u[:, component - 1])
    node = int(values.argmax())
    return 1e3 * float(values[node]), 1e3 * path.discretisation.mesh.points[node]


def length_of(strip: Path) -> float:
    """Extent along X1, m."""
    return float(np.ptp(strip.model.shell.mesh.points[:, 0]))


def measured_differences(strip: Path) -> FloatArray:
    """Computed over measured tip deflection minus one, per cent, at every measured field."""
    from scipy.interpolate import PchipInterpolator

    tip, (at, measured) = strip.probe("tip"), np.transpose(MEASURED)
    curve = PchipInterpolator(1e3 * tip.flux_density[:, 2], tip.u3 / length_of(strip))
    return np.asarray(100.0 * (curve(at) / measured - 1.0))


def _quoted(entry: Quoted, paths: Paths, note: str = "") -> Row:
    computed = abs(at_probe(paths[entry.example], entry.probe, entry.component, entry.field))
    return Row(entry.example, entry.what, "mm", entry.value, computed, note)


def _entries(example: str) -> list[Quoted]:
    return [entry for entry in QUOTED if entry.example == example]


def _against(computed: float, paper: float) -> str:
    return f"{computed:.2f} mm ({_percent(computed, paper)})"


def _percent(computed: float, reference: float) -> str:
    return f"{round(100.0 * (computed / reference - 1.0), 1) + 0.0:+.1f} %"


def _strips(paths: Paths) -> list[Row]:
    rows = []
    for name, ratio in ASPECT_RATIOS.items():
        for field in (2.0, 5.0, 10.0, 15.0, 50.0):
            computed = at_probe(paths[name], "tip", 3, field) / (1e3 * length_of(paths[name]))
            note = ""
            if field in SOLID_FIELDS:
                solid = SOLID[name][SOLID_FIELDS.index(field)]
                note = f"{_percent(computed, solid)} from three-dimensional micropolar finite elements, {solid:.4f}"
            rows.append(
                Row("strips", f"u3/L at the tip, aspect ratio {ratio:g}, {field:g} mT", "1", None, computed, note)
            )
    rows += [_locked(name, stretch, paths) for name in LOCKING for stretch in STRETCHES if stretch != "linear"]
    off = measured_differences(paths[MEASURED_ON])
    worst = int(np.abs(off).argmax())
    note = (
        f"Zhao et al. 2019, {len(MEASURED)} points; from {off.min():+.1f} to {off.max():+.1f} %, mean size "
        f"{np.abs(off).mean():.1f} %; the largest at {MEASURED[worst][0]:g} mT"
    )
    quantity = f"largest difference from the experiment, aspect ratio {ASPECT_RATIOS[MEASURED_ON]:g}"
    return [*rows, Row("strips", quantity, "%", None, float(np.abs(off).max()), note)]


def _locked(name: str, stretch: Stretch, paths: Paths) -> Row:
    """Tip deflection without the thickness stretch at a small field, where a strip is stiffest against its load."""
    field = 2.0
    full, computed = (
        at_probe(paths[each], "tip", 3, field) / (1e3 * length_of(paths[name]))
        for each in (name, stretched(name, stretch))
    )
    quantity = f"the same with {WITHOUT[stretch]}, aspect ratio {ASPECT_RATIOS[name]:g}, {field:g} mT"
    note = f"{_percent(computed, full)} from {full:.4f} with the thickness stretch"
    if stretch == "plane-stress":
        note += "; the paper finds that plane stress hardly helps, but solved at each point it removes the locking"
    return Row("strips", quantity, "1", None, computed, note)


def _hollow_cross(paths: Paths) -> list[Row]:
    (entry,) = _entries("hollow-cross")
    path = paths["hollow-cross"]
    points, u3 = path.discretisation.mesh.points, step_at(path, 1e-3 * entry.field).state.u[:, 2]
    across = np.flatnonzero(np.abs(points[:, 1]) < 1e-9)
    across = across[np.argsort(points[across, 0])]
    x, heights = 1e3 * points[across, 0], 1e3 * (u3[path.model.probe_nodes["C"]] - u3[across])
    held = float(np.interp(-entry.value, -heights, x)) if np.all(np.diff(heights) < 0.0) else float("nan")
    larger = at_probe(paths["hollow-cross, larger"], "C", 3, entry.field)
    per_percent = (larger - at_probe(path, "C", 3, entry.field)) / (100.0 * (LARGER - 1.0))
    needed = (entry.value - at_probe(path, "C", 3, entry.field)) / per_percent
    note = (
        f"Where across the outer bars the height 0 is held is a reading: at their inner edge, X1 = {x[0]:g} mm, "
        f"C rises {_against(heights[0], entry.value)}, at the outer edge, {x[-1]:g} mm, "
        f"{_against(heights[-1], entry.value)}; the paper's value belongs to X1 = {held:.1f} mm. So are the dimensions "
        f"in the plane, taken from other models of the experiment: {100.0 * (LARGER - 1.0):.0f} % larger give "
        f"{larger:.2f} mm, so {needed:.1f} % would make up the difference."
    )
    inner = at_probe(path, "E", 3, entry.field)
    close = "the paper: E and C are very close to each other at the end"
    return [_quoted(entry, paths, note), Row("hollow-cross", "u3 at E, inner corner, 200 mT", "mm", None, inner, close)]


def _thin_cross(paths: Paths) -> list[Row]:
    return [_quoted(entry, paths) for entry in _entries("thin-cross")]


def _h_shape(paths: Paths) -> list[Row]:
    (entry,) = _entries("h-shape")
    edge = at_probe(paths["h-shape"], "A'", 3, entry.field)
    note = (
        "Which point of the bar is A is a reading: this is its centre, (0, 0); "
        f"at its edge, (0, 3) mm, the height is {_against(edge, entry.value)}."
    )
    at_edge = Row("h-shape", "the same at the bar's edge", "mm", entry.value, edge)
    return [_quoted(entry, paths, note), at_edge]


def _pump(paths: Paths) -> list[Row]:
    (entry,) = _entries("pump")
    most, place = largest(paths["pump"], 1, entry.field)
    quantity = "largest |u1| anywhere, 150 mT"
    x1, x2, x3 = place
    note = f"at X = ({x1:.1f}, {x2:.1f}, {x3:.1f}) mm; the paper: the largest is at B, (22.9, 0, 0) mm"
    return [_quoted(entry, paths), Row("pump", quantity, "mm", entry.value, most, note)]


def _gripper(paths: Paths) -> list[Row]:
    path = paths["gripper"]
    rows = []
    for entry in _entries("gripper"):
        rows.append(_quoted(entry, paths))
        most, place = largest(path, 3, entry.field)
        polar = np.degrees(np.arccos(place[2] / np.linalg.norm(place)))
        at_b = at_probe(path, "B", 3, entry.field)
        note = (
            f"The paper calls its number the largest u3, but it is that of B, one of the two points of its curves: "
            f"here {_against(at_b, entry.value)}. The largest is below the equator, at the polar angle {polar:.0f}°."
        )
        rows.append(Row("gripper", f"largest u3 anywhere, {entry.field:g} mT", "mm", entry.value, most, note))
    return [*rows, *_touching(path, paths[OTHER_ELEMENT])]


def _touching(path: Path, finer: Path) -> list[Row]:
    middle, inner, outer = (first_touch(path, height) for height in (MIDDLE, INNER, OUTER))
    at_paper, at_one, early = step_at(path, 1e-3 * TOUCHING), step_at(path, 1e-3), path.steps[1]
    start = 1e3 * early.load_factor * path.model.field_magnitude
    rows = []
    overlaps = (f"{_overlap(path, at_paper, height):.2f} mm" for height in (MIDDLE, OUTER))
    note = (
        f"The mid-surfaces of neighbours meet at the polar angle {_polar(middle)}; at the paper's {TOUCHING:g} mT the "
        f"arms overlap: {' and '.join(overlaps)} at mid-surface and outer face, of a thickness of "
        f"{1e3 * path.model.shell.greatest_thickness:g} mm. It is not the mesh: the default element, which converges "
        f"faster, has them meet at {_field(first_touch(finer, MIDDLE)):.2f} mT. The paper does not say how it found "
        "its field."
    )
    rows.append(Row("gripper", "arms touch: mid-surfaces", "mT", TOUCHING, _field(middle), note))
    note = f"from here on their sides overlap through the whole thickness, first at the polar angle {_polar(inner)}"
    rows.append(Row("gripper", "arms touch: whole thickness", "mT", None, _field(inner), note))
    note = (
        "the arms cover the sphere without clearance, and bending widens their outer face next to the clamp (polar "
        f"angle {_polar(outer)}): there it is pressed against its neighbour from the first field on, by "
        f"{_overlap(path, early, OUTER):.3f} mm at {start:.2g} mT and {_overlap(path, at_one, OUTER):.3f} mm at 1 mT"
    )
    rows.append(Row("gripper", "arms touch: outer faces", "mT", None, _field(outer), note))
    return rows


def _overlap(path: Path, step: Step, height: float) -> float:
    """How deep two neighbours are in each other, mm."""
    return -2e3 * float(gap(path, step, height).min())


def _field(touch: Touch | None) -> float:
    return np.nan if touch is None else 1e3 * touch.field


def _polar(touch: Touch | None) -> str:
    return "(they do not)" if touch is None else f"{touch.polar:.0f}°"


_ROWS: dict[str, Callable[[Paths], list[Row]]] = {
    "strips": _strips,
    "hollow-cross": _hollow_cross,
    "thin-cross": _thin_cross,
    "h-shape": _h_shape,
    "pump": _pump,
    "gripper": _gripper,
}
