"""Curves of paths in the style of the page: whole lines where stable, broken where not, marks at critical points."""

from __future__ import annotations

import pathlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from accuracy_study.page import LABEL, LEGEND, TEXT, dress, figure, number, percent, table
from blocks import write_blocks

from magshell.output.style import ACCENT, GREY, deliver
from path_study.runs import Place

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

DOCS = pathlib.Path(__file__).parents[1]
COMMAND = "docs/make_path_study.py"
FINENESS = 12
"""Points that the line between two places is drawn with."""

__all__ = ["LABEL", "LEGEND", "TEXT", "Findings", "draw", "dress", "figure", "number", "percent", "table", "write"]

Value = Callable[[Place], float]


@dataclass
class Findings:
    """What a part of the study found: blocks of the page, and pictures, by name."""

    blocks: dict[str, str] = field(default_factory=dict)
    pictures: dict[str, Figure] = field(default_factory=dict)


def write(findings: Findings) -> None:
    """Put blocks between their marks and pictures beside the page."""
    write_blocks(DOCS / "path-following.md", findings.blocks, COMMAND)
    for name, picture in findings.pictures.items():
        deliver(picture, DOCS / "images" / f"path-{name}.png")


def draw(axes: Axes, places: Sequence[Place], x: Value, y: Value, colour: str, label: str = "", **style: Any) -> None:
    """The curve through places: steps as dots, hollow where unstable, and critical points.

    Between places it is a monotone cubic in the arc length, which no critical point overshoots.
    """
    steps = [place for place in places if place.kind == "step"]
    s, xs, ys = _smooth(places, x, y)
    look = {"color": colour, "linewidth": 2.0, **style}
    ends = [place.arc_length for place in places if place.kind != "step"]
    for low, high in zip([-np.inf, *ends], [*ends, np.inf], strict=True):
        inside = (s >= low) & (s <= high)
        between = [place for place in steps if low < place.arc_length < high]
        stable = all(place.stable for place in between)
        axes.plot(xs[inside], ys[inside], linestyle="-" if stable else (0, (3, 2)), **look)
    for stable in (True, False):
        some = [place for place in steps if place.stable == stable]
        fill = {"markerfacecolor": colour if stable else "white", "markeredgecolor": colour, "markersize": 4.5}
        axes.plot([x(p) for p in some], [y(p) for p in some], "o", linestyle="none", **fill)
    for kind, marker, size in (("limit point", "D", 8.0), ("bifurcation", "s", 7.5)):
        some = [place for place in places if place.kind == kind]
        look = {"markerfacecolor": ACCENT if marker == "D" else "white", "markeredgecolor": ACCENT, "zorder": 5}
        axes.plot([x(p) for p in some], [y(p) for p in some], marker, markersize=size, linestyle="none", **look)
    if label:
        axes.plot([], [], "o-", color=colour, linewidth=2.0, markersize=4.5, label=label)


def legend_of_marks(axes: Axes, kinds: Sequence[str]) -> None:
    """Entries for what lines and marks mean."""
    axes.plot([], [], "o-", color=GREY, linewidth=2.0, markersize=4.5, label="stable")
    axes.plot([], [], "o", linestyle=(0, (3, 2)), color=GREY, markerfacecolor="white", markersize=4.5, label="unstable")
    marks = {"limit point": ("D", ACCENT), "bifurcation": ("s", "white")}
    for kind in kinds:
        marker, fill = marks[kind]
        axes.plot([], [], marker, linestyle="none", markersize=8, color=ACCENT, markerfacecolor=fill, label=kind)


def _smooth(places: Sequence[Place], x: Value, y: Value) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    from scipy.interpolate import PchipInterpolator

    s = np.array([place.arc_length for place in places])
    first = np.append(True, np.diff(s) > 1e-9 * max(s[-1], 1e-30))
    s = s[first]
    fine = np.unique(np.concatenate([np.linspace(a, b, FINENESS) for a, b in pairwise(s)]))
    values = (np.array([function(place) for place in places])[first] for function in (x, y))
    xs, ys = (PchipInterpolator(s, value)(fine) for value in values)
    return fine, xs, ys
