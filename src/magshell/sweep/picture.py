"""The picture of a sweep: where probes end, against what was varied."""

from __future__ import annotations

import itertools
import math
import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.output.curve import NEGLIGIBLE, dress
from magshell.output.style import COLOURS, DPI, GREY, TEXT, TICKS, deliver
from magshell.problem.alternatives import Setting
from magshell.sweep.grid import Cell
from magshell.sweep.outcomes import WAITING, Outcome, displacement

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MOST_CURVES = 8
_MARKS = "os^Dv<>P"


class _Axis(NamedTuple):
    """A setting to draw against: its place among the settings, its label, its values in the unit of the label."""

    place: int
    label: str
    values: FloatArray


class _Moved(NamedTuple):
    """A component of a probe's displacement: its label, and its value in mm for each cell; NaN where there is none."""

    label: str
    values: FloatArray


def draw_sweep(
    settings: Sequence[Setting],
    cells: Sequence[Cell],
    outcomes: Mapping[int, Outcome],
    file: str | os.PathLike[str],
) -> str:
    """Draw the displacement of probes against the number that has most values.

    With one setting every component that matters is drawn. With more, the largest one: a curve for each combination of
    the others, or, where these are more than eight values of one number, a map of colours. Cells that are not solved
    are gaps.

    Returns
    -------
    str
        Why there is no picture; empty if it was written.

    Raises
    ------
    OSError
        The disk refuses; the message names the file.
    """
    axes = sorted(_axes(settings), key=lambda axis: -len(axis.values))
    moved = _moved(cells, outcomes)
    if not axes:
        return "no setting has several numbers to draw against"
    if not moved:
        return "no probe has moved" if any(cell.probes for cell in cells) else "the problem has no probes"
    others = [setting for place, setting in enumerate(settings) if place != axes[0].place and len(setting.values) > 1]
    shape = [len(setting.values) for setting in settings]
    if math.prod(len(setting.values) for setting in others) <= MOST_CURVES:
        deliver(_curves(axes[0], others, moved, shape), file)
    elif len(others) == 1 and len(axes) == 2:
        deliver(_map(axes[0], axes[1], moved[0], shape), file)
    else:
        return "there are too many combinations for one picture"
    return ""


def _axes(settings: Sequence[Setting]) -> list[_Axis]:
    """The settings with several numbers."""
    axes = []
    for place, setting in enumerate(settings):
        numbers = np.array([value.number for value in setting.values if value.number is not None])
        if len(numbers) < max(2, len(setting.values)):
            continue
        dimension = next((value.dimension for value in setting.values if value.dimension.units), None)
        if dimension is None:
            axes.append(_Axis(place, setting.key, numbers))
        else:
            largest = np.abs(numbers).max()
            unit = next(unit for unit, smallest in dimension.display if largest >= smallest)
            axes.append(_Axis(place, f"{setting.key} ({unit})", numbers / float(dimension.units[unit])))
    return axes


def _moved(cells: Sequence[Cell], outcomes: Mapping[int, Outcome]) -> list[_Moved]:
    """Every component of every probe that matters, the largest first."""
    found: list[tuple[float, _Moved]] = []
    for probe in dict.fromkeys(name for cell in cells for name in cell.probes):
        ends = [displacement(outcomes.get(cell.number, WAITING), probe) for cell in cells]
        for i in range(3):
            values = np.array([math.nan if (u := end[i]) is None else 1e3 * u for end in ends])
            largest = float(np.abs(values[np.isfinite(values)]).max(initial=0.0))
            found.append((largest, _Moved(f"{probe}  $u_{i + 1}$", values)))
    found.sort(key=lambda one: -one[0])
    return [moved for largest, moved in found if largest > NEGLIGIBLE * found[0][0]]


def _curves(axis: _Axis, others: Sequence[Setting], moved: Sequence[_Moved], shape: Sequence[int]) -> Figure:
    figure, axes = _figure()
    order = np.argsort(axis.values)
    if others:
        combinations = itertools.product(*([value.text for value in setting.values] for setting in others))
        grid = np.moveaxis(moved[0].values.reshape(shape), axis.place, -1).reshape(-1, len(axis.values))
        curves = [(", ".join(texts), row) for texts, row in zip(combinations, grid, strict=True)]
    else:
        curves = [(one.label, one.values) for one in moved[:MOST_CURVES]]
    for (label, values), colour, mark in zip(curves, COLOURS, _MARKS, strict=False):
        look: dict[str, Any] = {"color": colour, "marker": mark, "linewidth": 2.0, "markersize": 6.5}
        look |= {"markeredgecolor": "white", "markeredgewidth": 0.7, "label": _literal(label)}
        axes.plot(axis.values[order], values[order], **look)
    axes.axhline(0, color="#9aa3ad", linewidth=0.8, zorder=1)
    axes.set_xlabel(_literal(axis.label), **TEXT)
    axes.set_ylabel(f"{_literal(moved[0].label)}  (mm)" if others or len(moved) == 1 else "displacement (mm)", **TEXT)
    dress(axes)
    axes.spines["top"].set_visible(False)
    if len(curves) > 1:
        title = _literal(",\n".join(setting.key for setting in others)) or None
        figure.legend(
            loc="outside right center", title=title, title_fontsize=13, alignment="left",
            frameon=False, fontsize=14, labelspacing=0.7,
        )  # fmt: skip
    return figure


def _map(across: _Axis, up: _Axis, moved: _Moved, shape: Sequence[int]) -> Figure:
    from matplotlib.cm import ScalarMappable

    figure, axes = _figure()
    grid = np.moveaxis(moved.values.reshape(shape), (up.place, across.place), (-2, -1))
    grid = grid.reshape(len(up.values), len(across.values))
    rows, columns = np.argsort(up.values), np.argsort(across.values)
    mesh: ScalarMappable = axes.pcolormesh(
        across.values[columns], up.values[rows], grid[np.ix_(rows, columns)], cmap="viridis", shading="nearest"
    )
    axes.set_facecolor("#e5e7eb")
    axes.set_xlabel(_literal(across.label), **TEXT)
    axes.set_ylabel(_literal(up.label), **TEXT)
    axes.tick_params(**TICKS)
    bar = figure.colorbar(mesh, ax=axes, pad=0.02)
    bar.set_label(f"{_literal(moved.label)}  (mm)", **TEXT)
    bar.ax.tick_params(**TICKS)
    bar.outline.set_visible(False)
    for side in axes.spines.values():
        side.set_color(GREY)
    return figure


def _figure() -> tuple[Figure, Axes]:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.0, 5.6), dpi=DPI, facecolor="white")
    figure.set_layout_engine("constrained", w_pad=0.12, h_pad=0.12)
    return figure, figure.subplots()


def _literal(text: str) -> str:
    """A user's name, safe from being read as mathematics."""
    return text if "$u_" in text else text.replace("$", r"\$")
