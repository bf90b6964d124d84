"""Pictures of the page on the published shells: load–deflection curves and rows of the tables, errors."""

from __future__ import annotations

import pathlib
from collections.abc import Mapping, Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter, NullFormatter

from magshell.output.style import ACCENT, COLOURS, GREY, INK, PALE, TEXT, TICKS, deliver
from published_study.page import Errors
from published_study.problems import CLASSICAL, MICROPOLAR, PAPER, Published, Variant
from published_study.runs import Run

IMAGES = pathlib.Path(__file__).parents[1] / "images"
DPI = 120
LEAST = 1e-4
"""Errors below are not shown: no limit here is known so well."""
SYMBOLS = {
    "minus_u_tip": "$-u_1$ of the tip",
    "w_tip": "$u_3$ of the tip",
    "w_A": "$u_3$ of A",
    "w_B": "$u_3$ of B",
    "smaller_radial": "$u_1$, pulled",
    "larger_radial": "$-u_2$, pushed",
    "minus_w": "$-u_3$ under the force",
    "minus_w_C": "$-u_3$ of the crown",
}
LOOK: dict[Variant, dict[str, Any]] = {
    CLASSICAL: {"color": COLOURS[0], "marker": "o"},
    MICROPOLAR: {"color": COLOURS[2], "marker": "D"},
    PAPER: {"color": ACCENT, "marker": "s"},
}


def draw_curves(found: Sequence[tuple[Published, Run]], name: str) -> None:
    """Every problem's path, and the rows of its table."""
    figure = Figure(figsize=(12.6, 8.0), dpi=DPI)
    for axes, (published, run) in zip(figure.subplots(2, 3).flat, found, strict=True):
        data = published.data
        for column, colour in zip(published.columns, (COLOURS[0], ACCENT), strict=False):
            axes.plot(run.values[column.name], run.loads, color=colour, linewidth=2.0, label=SYMBOLS[column.name])
            style = {"markersize": 6.5, "markerfacecolor": "white", "markeredgecolor": colour, "markeredgewidth": 1.5}
            axes.plot(data[column.name], data["load_ratio"], "o", **style)
        axes.plot([], [], "o", markersize=6.5, markerfacecolor="white", markeredgecolor=GREY, label="table")
        _plain(axes)
        axes.grid(color="#e5e7eb", linewidth=0.8)
        axes.set_ylim(bottom=0.0)
        axes.set_title(published.title, fontsize=15, color=INK, pad=10)
        axes.legend(frameon=False, fontsize=12, handlelength=1.4, borderpad=0.1)
    for axes in figure.axes[::3]:
        axes.set_ylabel("load over its largest value", **TEXT)
    for axes in figure.axes:
        axes.set_xlabel("displacement" + (" (mm)" if axes in figure.axes[4:] else ""), fontsize=13, color=INK)
    figure.tight_layout(h_pad=1.6, w_pad=1.4)
    deliver(figure, IMAGES / f"{name}.png")


def draw_errors(found: Sequence[tuple[Published, Mapping[Variant, Errors]]], name: str) -> None:
    """Errors against unknowns of every problem and variant."""
    figure = Figure(figsize=(12.6, 8.0), dpi=DPI)
    panels = figure.subplots(2, 3, sharey=True)
    for axes, (published, members) in zip(panels.flat, found, strict=True):
        axes.axhline(0.01, color=PALE, linewidth=1.0, linestyle=(0, (4, 3)), zorder=0)
        for variant, errors in members.items():
            fill = {"markersize": 7, "linewidth": 1.8, **LOOK[variant]}
            axes.loglog(errors.unknowns, errors.values, markeredgecolor="white", markeredgewidth=0.7, **fill)
            hollow = {**LOOK[variant], "markersize": 7, "markerfacecolor": "white", "markeredgewidth": 1.6}
            axes.loglog(errors.unknowns[-1], errors.values[-1], **hollow)
            axes.plot([], [], label=variant.name, **fill)
        _plain(axes)
        axes.grid(which="major", color="#e5e7eb", linewidth=0.8)
        axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{100 * value:g} %"))
        axes.yaxis.set_minor_formatter(NullFormatter())
        axes.xaxis.set_major_locator(FixedLocator([100, 200, 500, 1000, 2000, 5000, 10000]))
        axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.0f}".replace(",", "\u2009")))
        axes.xaxis.set_minor_formatter(NullFormatter())
        axes.set_title(published.title, fontsize=15, color=INK, pad=10)
        axes.set_xlabel("unknowns", fontsize=13, color=INK)
    for row in panels:
        row[0].set_ylabel("error", **TEXT)
    panels[0, 0].set_ylim(bottom=max(panels[0, 0].get_ylim()[0], LEAST))
    panels[1, 1].legend(frameon=False, fontsize=13, loc="lower left", handlelength=1.4, borderpad=0.1)
    figure.tight_layout(h_pad=1.6, w_pad=1.2)
    deliver(figure, IMAGES / f"{name}.png")


def _plain(axes: Axes) -> None:
    axes.spines[["right", "top"]].set_visible(False)
    axes.tick_params(which="both", **(TICKS | {"labelsize": 11}))
