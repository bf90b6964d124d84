"""Tables and pictures in the style of the page, and their way into it."""

from __future__ import annotations

import math
import pathlib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from blocks import write_blocks

from magshell.output.style import GREY, INK, PALE, TICKS, deliver

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

DOCS = pathlib.Path(__file__).parents[1]
PAGE = DOCS / "how-accurate.md"
LEGEND: dict[str, Any] = {"frameon": False, "fontsize": 12, "labelspacing": 0.4}
LABEL: dict[str, Any] = {"fontsize": 14, "color": INK}
TEXT: dict[str, Any] = {"fontsize": 14, "color": GREY}


@dataclass
class Findings:
    """What a part of the study found: tables of the page, and pictures, by name."""

    tables: dict[str, str] = field(default_factory=dict)
    pictures: dict[str, Figure] = field(default_factory=dict)


def table(header: Sequence[str], rows: Iterable[Sequence[str]], words: int = 1) -> str:
    """A Markdown table, the first `words` columns aligned left, the others right."""
    lines = [f"| {' | '.join(header)} |", "|" + "---|" * words + "---:|" * (len(header) - words)]
    return "\n".join([*lines, *(f"| {' | '.join(row)} |" for row in rows)])


def number(value: float, digits: int = 4) -> str:
    """A number with so many significant digits; a dash where there is none."""
    return f"{value:#.{digits}g}".rstrip(".") if math.isfinite(value) else "–"


def percent(value: float, reference: float, digits: int = 1) -> str:
    """How far a value is from a reference; a dash where one of them is missing."""
    off = 100.0 * (value / reference - 1.0)
    if not math.isfinite(off):
        return "–"
    return f"{off + 0.0:+.{digits}f}" if round(abs(off), digits) else f"{0:.{digits}f}"


def figure(size: tuple[float, float]) -> Figure:
    """An empty figure."""
    from matplotlib.figure import Figure

    new = Figure(figsize=size, dpi=120, facecolor="white")
    new.set_layout_engine("constrained", w_pad=0.1, h_pad=0.1)
    return new


def dress(axes: Axes, abscissa: str = "", ordinate: str = "") -> Axes:
    """Axes without a box, with a faint grid."""
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    for side in ("left", "bottom"):
        axes.spines[side].set_color(PALE)
    axes.tick_params(which="both", color=PALE, **TICKS)
    axes.grid(True, which="major", color=PALE, alpha=0.22, linewidth=0.8)
    axes.set_axisbelow(True)
    axes.set_xlabel(abscissa, **LABEL)
    axes.set_ylabel(ordinate, **LABEL)
    axes.title.set_color(GREY)
    return axes


def write(findings: Findings) -> None:
    """Put tables between their marks and pictures beside the page."""
    write_blocks(PAGE, findings.tables, "docs/make_accuracy_study.py")
    for name, picture in findings.pictures.items():
        deliver(picture, DOCS / "images" / f"accuracy-{name}.png")
