"""The load–displacement curves of an example, over the nondimensional load of the paper."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from magshell.arrays import FloatArray
from magshell.output.abscissa import FLUX, abscissa
from magshell.output.curve import LOAD, dress, load_per_mT, second_axis
from magshell.output.style import COLOURS, INK, TEXT
from magshell.reproduction.numbers import length_of
from magshell.reproduction.references import ASPECT_RATIOS, MEASURED, MEASURED_ON, QUOTED

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from magshell.reproduction.catalogue import Example
    from magshell.solver.path import Path

DPI = 120
SIZE = (7.4, 5.6)
SAMPLES = 400
MARK: dict[str, Any] = {
    "linestyle": "none", "marker": "D", "markersize": 9, "color": "none", "markeredgecolor": INK, "zorder": 5,
}  # fmt: skip
DOT: dict[str, Any] = {"linestyle": "none", "marker": "o", "markersize": 7, "color": INK, "zorder": 5}


def curves_figure(example: Example, paths: Mapping[str, Path]) -> Figure:
    """The curves at the paper's points, with the numbers that it quotes, or the four strips with the experiment."""
    return _strips(paths) if len(example.problems) > 1 else _probes(example, paths[example.name])


def load_axes(path: Path, ordinate: str, axes: Axes) -> Axes:
    """Make axes ones over the nondimensional load, with the field in mT above."""
    dress(axes)
    axes.set_xlabel(LOAD, **TEXT)
    axes.set_ylabel(ordinate, **TEXT)
    second_axis(axes, 1.0 / load_per_mT(path), FLUX)
    return axes


def new_figure(size: tuple[float, float] = SIZE) -> Figure:
    """An empty figure of curves."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=size, dpi=DPI, facecolor="white")
    figure.set_layout_engine("constrained", w_pad=0.12, h_pad=0.12)
    return figure


def add_curve(axes: Axes, path: Path, values: FloatArray, **style: Any) -> None:
    """A smooth curve through the values at the converged steps, which are marked."""
    from scipy.interpolate import PchipInterpolator

    load = load_per_mT(path) * abscissa(path).of(path.steps)
    fine = np.linspace(load[0], load[-1], SAMPLES)
    colour = style.pop("color")
    marker, label = style.pop("marker", "o"), style.pop("label")
    axes.plot(fine, PchipInterpolator(load, values)(fine), color=colour, linewidth=2.0, **style)
    points = {"linestyle": "none", "marker": marker, "markersize": 5, "markeredgecolor": "white"}
    axes.plot(load, values, color=colour, markeredgewidth=0.5, **points)
    axes.plot([], [], color=colour, linewidth=2.0, marker=marker, markersize=5, label=label, **style)


def legend(axes: Axes, **options: Any) -> None:
    """The legend in the house style."""
    axes.legend(frameon=False, fontsize=13, labelspacing=0.45, **options)


def _probes(example: Example, path: Path) -> Figure:
    figure = new_figure()
    several = len({component for _, component in example.curves}) > 1
    axes = load_axes(path, "displacement (mm)" if several else f"$u_{example.component}$ (mm)", figure.subplots())
    probes = list(dict.fromkeys(probe for probe, _ in example.curves))
    lines, markers = {1: "--", 3: "-"}, {1: "s", 3: "o"}
    for probe, component in _from_the_top(example.curves, path):
        u = 1e3 * path.probe(probe).u[:, component - 1]
        style = {"linestyle": lines[component], "marker": markers[component]}
        label = rf"{probe}  $u_{component}$"
        add_curve(axes, path, u, color=COLOURS[probes.index(probe)], label=label, **style)
    first = True
    for entry in QUOTED:
        if entry.example == example.name:
            sign = np.sign(path.probe(entry.probe).u[-1, entry.component - 1])
            label = f"{entry.probe}, paper's number" if first else "_"
            axes.plot(load_per_mT(path) * entry.field, sign * entry.value, label=label, **MARK)
            first = False
    legend(axes)
    return figure


def _from_the_top(curves: Sequence[tuple[str, int]], path: Path) -> list[tuple[str, int]]:
    """The curves in the order of their ends, so that the legend reads as the picture."""
    return sorted(curves, key=lambda curve: -path.probe(curve[0]).u[-1, curve[1] - 1])


def _strips(paths: Mapping[str, Path]) -> Figure:
    figure = new_figure()
    axes = load_axes(paths[MEASURED_ON], "$u_3/L$ at the tip", figure.subplots())
    for number, (name, ratio) in reversed(list(enumerate(ASPECT_RATIOS.items()))):
        path = paths[name]
        add_curve(axes, path, path.probe("tip").u3 / length_of(path), color=COLOURS[number], label=f"{ratio:g}")
    at, measured = np.transpose(MEASURED)
    ratio = ASPECT_RATIOS[MEASURED_ON]
    axes.plot(load_per_mT(paths[MEASURED_ON]) * at, measured, label=f"{ratio:g}, experiment", **DOT)
    legend(axes, title="length / thickness", title_fontsize=13)
    return figure
