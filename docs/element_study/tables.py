"""Tables of the page on the element, and how they get there."""

from __future__ import annotations

import pathlib
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from blocks import write_blocks

from element_study.cases import Case, Quantity
from element_study.convergence import Cost, Series, at_equal_unknowns, cost

PAGE = pathlib.Path(__file__).parents[1] / "element.md"
COMMAND = "docs/make_element_study.py"
BODIES, FORMS = ("element", "patch"), ("flat", "curved")
MARK = 0.01
"""The error at which CPU times are compared."""


class Pair(NamedTuple):
    """A quantity of a case with the series of both members."""

    case: Case
    quantity: Quantity
    quadratic: Series
    paper: Series

    @property
    def name(self) -> str:
        """As in tables."""
        body = self.case.title.split(",")[0].replace("strip of aspect ratio", "strip")
        return f"{body.split(' with ')[0]}, {self.quantity.name}"


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Markdown; every column but the first is set to the right."""
    lines = [head, ["---"] + ["---:"] * (len(head) - 1), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def ratio_table(pairs: Sequence[Pair]) -> str:
    """Errors at equal unknowns and CPU times at equal errors."""
    rows = []
    for pair in pairs:
        ratios = at_equal_unknowns(pair.quadratic, pair.paper)
        costs = [cost(one, MARK) for one in (pair.quadratic, pair.paper)]
        rows.append(
            [pair.name, f"{ratios.min():.2g}", f"{np.exp(np.log(ratios).mean()):.2g}", f"{ratios.max():.2g}"]
            + [f"{one.sign}{one.seconds:.2g}" for one in costs]
            + [times(*costs)]
        )
    head = ("Quantity", "Least", "Mean", "Largest", "`quadratic` (s)", "`paper` (s)", "Ratio")
    return table(head, rows)


def times(quadratic: Cost, paper: Cost) -> str:
    """Ratio of two costs, with the sign of what is only a bound."""
    sign = "> " if "<" in quadratic.sign or ">" in paper.sign else ""
    if ">" in quadratic.sign or "<" in paper.sign:
        sign = "not comparable" if sign else "< "
    return sign if sign == "not comparable" else f"{sign}{paper.seconds / quadratic.seconds:.2g}"


def limit_table(pairs: Sequence[Pair]) -> str:
    """Both members' limits, their orders, and values of others."""
    rows = []
    for pair in pairs:
        q, p = pair.quadratic, pair.paper
        rows.append([
            pair.name, f"{q.limit:.4g} {pair.quantity.unit}".strip(), f"{q.order:.1f}", f"{100 * q.errors[-1]:.2f} %",
            f"{p.limit:.4g}", f"{p.order:.1f}", f"{100 * p.errors[-1]:.2f} %",
            f"{100 * (p.limit / q.limit - 1):+.2f} %", pair.quantity.independent or "–",
        ])  # fmt: skip
    head = ("Quantity", "`quadratic`", "Order", "Finest mesh", "`paper`", "Order", "Finest mesh", "Difference",
            "Independent")  # fmt: skip
    return table(head, rows)


def mesh_table(pairs: Sequence[Pair], kinds: Mapping[str, Sequence[tuple[int, int]]]) -> str:
    """Unknowns, values and errors on every mesh, of some quantities of one case."""
    rows = []
    for member in ("quadratic", "paper"):
        shown = [getattr(pair, member) for pair in pairs]
        for i, divisions in enumerate(kinds[member]):
            cells = [f"{one.values[i]:.4g} ({100 * one.errors[i]:.2g} %)" for one in shown]
            rows.append([f"`{member}` {divisions[0]} × {divisions[1]}", f"{shown[0].unknowns[i]:.0f}", *cells])
    return table(("Element, mesh", "Unknowns", *(pair.quantity.name for pair in pairs)), rows)


def stabilisation_table(found: Mapping[str, Mapping[str, Any]], limits: Mapping[str, float]) -> str:
    """Candidates: zero modes, softest modes, errors, points."""
    rows = []
    for title, entry in found.items():
        modes = entry["modes"]
        zeros = " ".join(str(modes[key][0]) for key in modes)
        softest = (
            f"{min(modes[f'{what}, flat'][1], modes[f'{what}, curved'][1]):.1e}" for what in ("element", "patch")
        )
        errors = (_error(entry["displacements"][key], limits[key]) for key in limits)
        rows.append([title, str(entry["points"]), zeros, *softest, *errors])
    head = ("Candidate", "Points", "Zero modes", "Softest, element", "patch", *limits)
    return table(head, rows)


def _error(value: float, limit: float) -> str:
    return f"{100 * (value / limit - 1):+.1f} %" if np.isfinite(value) else "singular"


def published_table(found: Mapping[str, Mapping[str, float]], pairs: Sequence[Pair]) -> str:
    """What the published problems give with l = h/10 and h/100."""
    rows = []
    for pair in pairs:
        entry, limit = found[pair.case.name], pair.quadratic.limit
        small = limit * entry["small"] / entry["large"]
        published = float(pair.quantity.independent.split()[-1])
        rows.append([
            pair.name, f"{published:g}", *(f"{value:.3f} ({100 * (value / published - 1):+.1f} %)"
                                           for value in (limit, small)),
        ])  # fmt: skip
    return table(("Problem", "Published", "$l = h/10$", "$l = h/100$"), rows)


def write(tables: Mapping[str, str]) -> None:
    """Put every table between its marks on the page."""
    write_blocks(PAGE, tables, COMMAND)
