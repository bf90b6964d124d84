"""Pictures of the page on the element: its nodes, and errors on log-log axes."""

from __future__ import annotations

import pathlib
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from matplotlib.ticker import FuncFormatter, NullFormatter

from element_study.convergence import Series
from magshell.output.style import ACCENT, COLOURS, GREY, INK, PALE, TEXT, TICKS, deliver
from magshell.shell.elements import PAPER, QUADRATIC
from magshell.shell.shape_functions import NODES, serendipity

IMAGES = pathlib.Path(__file__).parents[1] / "images"
DPI = 120
LEAST = 1e-4
"""Errors below are not shown: no limit here is known so well."""
LOOK = {"quadratic": {"color": COLOURS[0], "marker": "o"}, "paper": {"color": ACCENT, "marker": "s"}}


class Panel(NamedTuple):
    """A title, and the series of both members."""

    title: str
    members: Sequence[Series]


def draw_errors(panels: Sequence[Panel], name: str) -> None:
    """Errors against unknowns above, against CPU time below."""
    figure = Figure(figsize=(3.6 * len(panels) + 0.6, 6.9), dpi=DPI)
    axes = figure.subplots(2, len(panels), sharey=True, squeeze=False)
    for column, panel in enumerate(panels):
        for row, what in enumerate(("unknowns", "cpu")):
            _draw(axes[row, column], panel.members, what)
        axes[0, column].set_title(panel.title, fontsize=14, color=INK, pad=10)
        axes[0, column].set_xlabel("unknowns", fontsize=13, color=INK)
        axes[1, column].set_xlabel("CPU time (s)", fontsize=13, color=INK)
    for row in range(2):
        axes[row, 0].set_ylabel("error", **TEXT)
    axes[0, 0].set_ylim(bottom=max(axes[0, 0].get_ylim()[0], LEAST))
    axes[0, 0].legend(frameon=False, fontsize=13, loc="upper right", handlelength=1.4, borderpad=0.1)
    figure.tight_layout(h_pad=1.6, w_pad=1.2)
    deliver(figure, IMAGES / f"{name}.png")


def _draw(axes: Axes, members: Sequence[Series], what: str) -> None:
    axes.axhline(0.01, color=PALE, linewidth=1.0, linestyle=(0, (4, 3)), zorder=0)
    for one in members:
        x = getattr(one, what)
        fill: dict[str, Any] = {"markersize": 7, "linewidth": 1.8, **LOOK[one.member]}
        axes.loglog(x, one.errors, markeredgecolor="white", markeredgewidth=0.7, label=one.member, **fill)
        hollow = {"marker": fill["marker"], "markersize": 7, "color": fill["color"], "markerfacecolor": "white"}
        axes.loglog(x[-1], one.errors[-1], markeredgewidth=1.6, **hollow)
    axes.grid(which="major", color="#e5e7eb", linewidth=0.8)
    axes.spines[["right", "top"]].set_visible(False)
    axes.tick_params(which="both", **(TICKS | {"labelsize": 11}))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{100 * value:g} %"))
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.xaxis.set_minor_formatter(NullFormatter())
    if what == "cpu":
        axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))


# -- nodes -----------------------------------------------------------------------------------------------------------

CORNERS = np.array([[-1.02, -0.92], [1.0, -0.78], [0.88, 0.86], [-0.8, 1.02]])
BULGE = np.array([[0.02, -0.13], [0.15, 0.03], [-0.02, 0.15], [-0.12, 0.0]])
SHAPE = np.vstack([CORNERS, 0.5 * (CORNERS + np.roll(CORNERS, -1, axis=0)) + BULGE])


def draw_nodes() -> None:
    """Which nodes carry which field, and the points, of both members."""
    figure = Figure(figsize=(11.0, 5.2), dpi=DPI)
    axes = figure.subplots(2, 4)
    titles = ("$u$", "$w$ and micro-rotation", r"$\varphi$", "integration points")
    for row, element in enumerate((QUADRATIC, PAPER)):
        for column, count in enumerate((8, element.rest_nodes, element.stretch_nodes)):
            _outline(axes[row, column])
            place = SHAPE[:count]
            axes[row, column].plot(*place.T, "o", color=LOOK[element.name]["color"], markersize=11, clip_on=False)
        _outline(axes[row, 3])
        points = serendipity(element.rule.points)[0] @ SHAPE
        axes[row, 3].plot(*points.T, "x", color=GREY, markersize=9, markeredgewidth=2.0)
        axes[row, 0].text(-1.5, 0.0, element.name, rotation=90, va="center", ha="center", **TEXT)
        column, words = 1, f"and {3 * len(element.modes)} enhanced parameters"
        if element.bubble:
            column, words = 0, "and a bubble"
        axes[row, column].text(0.0, -1.42, words, ha="center", va="center", fontsize=12, color=GREY)
    for column, title in enumerate(titles):
        axes[0, column].set_title(title, pad=8, **TEXT)
    figure.subplots_adjust(left=0.05, right=0.99, top=0.91, bottom=0.04, wspace=0.05, hspace=0.12)
    deliver(figure, IMAGES / "element-nodes.png")


def _outline(axes: Axes) -> None:
    t = np.linspace(-1.0, 1.0, 30)
    ends = NODES[:4]
    around = np.vstack(
        [0.5 * (1 - t[:, None]) * ends[i] + 0.5 * (1 + t[:, None]) * ends[(i + 1) % 4] for i in range(4)]
    )
    curve = serendipity(around)[0] @ SHAPE
    axes.add_patch(Polygon(curve, closed=True, facecolor="#f3f4f6", edgecolor=PALE, linewidth=1.6))
    axes.set_xlim(-1.6, 1.6)
    axes.set_ylim(-1.55, 1.25)
    axes.set_aspect("equal")
    axes.set_axis_off()
