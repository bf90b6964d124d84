"""The picture of the load–displacement curves."""

from __future__ import annotations

import os
from collections.abc import Sequence
from textwrap import fill
from typing import TYPE_CHECKING, Any

import numpy as np

from magshell.arrays import FloatArray
from magshell.output.abscissa import FIELD, abscissa
from magshell.output.rounding import STILL
from magshell.output.series import COMPONENTS, WIDEST_NAME, Curve, chosen, some
from magshell.output.style import ACCENT, COLOURS, DPI, TEXT, TICKS, deliver

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from PIL.Image import Image

    from magshell.solver.critical import CriticalPoint
    from magshell.solver.path import Path
    from magshell.solver.step import Step

NEGLIGIBLE = 0.01
LOAD = r"$10^3\,|B^\mathrm{ext}|\,|B^\mathrm{rem}|\,/\,(\mu\,\mu_0)$"
LOAD_TEXT = "10³ |B| |Bʳᵉᵐ| / (µ µ₀)"
ROUND, DEGREES = (1, 2, 5, 10), (1, 1.5, 3, 4.5, 9, 10)
INCHES = (9.0, 5.6)
LEGEND_POINTS, SMALLEST_POINTS = 14.0, 6.5
LINE = 1.9
"""Height of a line of the legend, over the size of its letters."""
CRITICAL: dict[str, Any] = {
    "linestyle": "none", "marker": "D", "markersize": 7, "color": ACCENT, "markeredgecolor": "white",
}  # fmt: skip


def draw_curve(
    path: Path,
    file: str | os.PathLike[str] | None = "curve.png",
    columns: Sequence[str] = (),
    over: str | None = None,
) -> Image | None:
    """Draw displacement against field at every probe, with a mark at every converged step, hollow if unstable.

    The field is given in mT below, negative where it is reversed, and above as the load 10³ |Bext| |Brem| / (mu mu0)
    of the literature, with the largest |Brem| of the shell. Where the field or a magnet turns, its angle takes its
    place, and where there is no uniform field the load factor (plus the number of the stages before). Components below
    1 % of the largest are left out. Of many probes some are drawn, and the picture says how many. Without probes the
    largest displacement anywhere is drawn. Limit points and bifurcations are marked with diamonds.

    Parameters
    ----------
    path : Path
    file : path, optional
        PNG file to write; None to get the picture instead.
    columns : sequence of str, optional
        Columns of the history to draw in place of the displacements, of one unit: `tip.R3`, `elastic`.
    over : str, optional
        What they are drawn against: `field` (|B|), `load_factor`, or an amount of the field that varies along the path,
        such as `field.angle` or `magnet.d3`.

    Returns
    -------
    PIL.Image.Image or None
        The picture, if no file was named.

    Raises
    ------
    InputError
        No such column or abscissa, or columns of several units.
    OSError
        The disk refuses; the message names the file.
    """
    return deliver(curve_figure(path, columns, over), file)


def curve_figure(path: Path, columns: Sequence[str] = (), over: str | None = None) -> Figure:
    """The picture of `draw_curve` as a matplotlib figure, to go on working on."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=INCHES, dpi=DPI, facecolor="white")
    figure.set_layout_engine("constrained", w_pad=0.12, h_pad=0.12)
    axes = figure.subplots()
    along = abscissa(path, over)
    x, critical, note = along.of(path.steps), along.of(path.critical_points), ""
    unstable = np.array([bool(step.negative_pivots) for step in path.steps])
    if columns:
        group = chosen(path, columns)
        title, factor, every, critical = group.title, group.factor, group.curves, critical[:0]
    else:
        points: list[Step | CriticalPoint] = [*path.steps, *path.critical_points]
        every, note = some(displacements(path, points), len(path.model.probe_nodes))
        title, factor = "displacement (mm)", 1e3
    for curve in sorted(every, key=lambda curve: -curve.values[len(x) - 1]):
        values, at_critical = curve.values[: len(x)], curve.values[len(x) :]
        label, style = curve.label, curve.style
        axes.plot(x, factor * values, label=label, markersize=5, markeredgecolor="white", markeredgewidth=0.6, **style)
        if len(critical):
            axes.plot(critical, factor * at_critical, zorder=4, **CRITICAL)
        hollow = {"linestyle": "none", "marker": style["marker"], "color": style["color"], "markersize": 5}
        axes.plot(x[unstable], factor * values[unstable], markerfacecolor="white", **hollow)
    if len(critical):
        axes.plot([], [], label="critical point", **CRITICAL)
    if unstable.any():
        axes.plot([], [], "o", color="#6b7280", markerfacecolor="white", markersize=6, label="unstable")
    if note:
        axes.plot([], [], linestyle="none", label=fill(note, WIDEST_NAME))
    axes.axhline(0, color="#9aa3ad", linewidth=0.8, zorder=1)
    axes.set_xlabel(along.label, **TEXT)
    axes.set_ylabel(title, **TEXT)
    dress(axes, DEGREES if along.name.endswith(".angle") else ROUND)
    scale = load_per_mT(path) if along.name == FIELD else 0.0
    if scale > 0:
        second_axis(axes, scale, LOAD)
    else:
        axes.spines["top"].set_visible(False)
    _legend(figure, axes)
    return figure


def _legend(figure: Figure, axes: Axes) -> None:
    """Beside the axes; in smaller letters if there are many lines, and no more lines than fit."""
    handles, labels = axes.get_legend_handles_labels()
    lines = np.cumsum([1 + label.count("\n") for label in labels])
    room = 0.92 * 72.0 * INCHES[1] / LINE
    shown = int(np.searchsorted(lines, room / SMALLEST_POINTS - 1.0, side="right"))
    if shown < len(labels):
        left_out = axes.plot([], [], linestyle="none")
        handles, labels = [*handles[:shown], *left_out], [*labels[:shown], f"and {len(labels) - shown} more"]
    size = min(LEGEND_POINTS, max(SMALLEST_POINTS, room / lines[min(shown, len(lines) - 1)]))
    figure.legend(
        handles, labels, loc="outside right center", frameon=False, fontsize=size, handlelength=2.6,
        labelspacing=LINE - 1.2,
    )  # fmt: skip


def displacements(path: Path, points: Sequence[Step | CriticalPoint] | None = None) -> list[Curve]:
    """Every curve worth drawing, at points of the path or at its steps; one that is all round-off is zero."""
    states = [point.state for point in (path.steps if points is None else points)]
    noise = STILL * path.model.shell.mesh.size
    probes = {name: np.array([state.u[node] for state in states]) for name, node in path.model.probe_nodes.items()}
    probes = {name: np.where(np.abs(u).max(axis=0) > noise, u, 0.0) for name, u in probes.items()}
    if not probes:
        largest = np.array([np.linalg.norm(state.u, axis=1).max() for state in states])
        style = {"color": COLOURS[0], "linestyle": "-", "marker": "o", "linewidth": 2.0}
        return [Curve("largest", "|u|", None, largest * bool(largest.max() > noise), style)]
    threshold = NEGLIGIBLE * max(np.abs(u).max() for u in probes.values())
    found = []
    for number, (name, u) in enumerate(probes.items()):
        for i, (line, marker) in enumerate(COMPONENTS):
            if np.abs(u[:, i]).max() >= threshold:
                colour = COLOURS[(i if len(probes) == 1 else number) % len(COLOURS)]
                style = {"color": colour, "linestyle": line, "marker": marker, "linewidth": 2.0}
                found.append(Curve(name, "u", i + 1, u[:, i], style))
    return found


def curves(path: Path) -> list[tuple[str, FloatArray, dict[str, Any]]]:
    """Label, values in m and style of every curve worth drawing."""
    return [(curve.label, curve.values, curve.style) for curve in displacements(path)]


def dress(axes: Axes, steps: Sequence[float] = ROUND) -> None:
    """Give the axes of a curve the house style; `steps` are those between ticks, from 1 to 10."""
    from matplotlib.ticker import MaxNLocator

    axes.margins(x=0.02)
    axes.xaxis.set_major_locator(MaxNLocator(6, steps=steps))
    axes.grid(color="#e5e7eb", linewidth=0.8)
    axes.spines["right"].set_visible(False)
    axes.tick_params(**TICKS)


def second_axis(axes: Axes, factor: float, label: str) -> None:
    """The horizontal axis a second time, above, in a unit that gives `factor` times the numbers."""
    from matplotlib.ticker import MaxNLocator

    above = axes.secondary_xaxis("top", functions=(_times(factor), _times(1 / factor)))
    above.set_xlabel(label, labelpad=8, **TEXT)
    above.xaxis.set_major_locator(MaxNLocator(6, steps=ROUND))
    above.tick_params(**TICKS)


def load_per_mT(path: Path) -> float:
    """The nondimensional load of one millitesla: 10³ · 10⁻³ T · |Brem| / (mu mu0)."""
    shell = path.model.shell
    remanence = np.linalg.norm(shell.remanence_at_points, axis=-1).max(axis=1)
    return float((remanence / shell.mean_of("shear_modulus")).max() / path.model.coupling.vacuum_permeability)


def _times(factor: float) -> Any:
    return lambda values: factor * values
