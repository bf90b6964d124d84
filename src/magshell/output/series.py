"""Curves of the history: its series as groups of lines that pictures and pages show."""

from __future__ import annotations

import re
from collections.abc import Sequence
from textwrap import fill
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.errors import InputError, suggest
from magshell.evaluation.series import SERIES
from magshell.output.labels import in_pictures
from magshell.output.style import COLOURS

if TYPE_CHECKING:
    from magshell.solver.path import Path

# Line and mark of components 1 to 3.
COMPONENTS = (("--", "s"), (":", "^"), ("-", "o"))
# Of the sum of the magnitudes that balance each other: what round-off leaves of them.
ROUND_OFF = 1e-9
MOST_CURVES = 16
WIDEST_NAME, LONGEST_NAME = 24, 72
"""Letters of a name in a line of a legend, and in all."""
_NUMBERED = re.compile(r"(.*[^\d])([123])")


class Curve(NamedTuple):
    """A line against the field or the load factor.

    Attributes
    ----------
    name : str
        Whose it is, as the user calls it; empty: of the whole shell.
    symbol : str
    component : int or None
        1 to 3.
    values : FloatArray, shape (points,)
        SI.
    style : dict
        For matplotlib: color, linestyle, marker, linewidth.
    """

    name: str
    symbol: str
    component: int | None
    values: FloatArray
    style: dict[str, Any]

    @property
    def label(self) -> str:
        """For matplotlib, with mathematics."""
        name = _literal(fill(shorten(self.name, LONGEST_NAME), WIDEST_NAME))
        if self.symbol == "|u|":
            return f"{name} $|u|$"
        symbol = self.symbol
        if self.component is not None:
            letter = symbol if len(symbol) == 1 else r"\mathrm{" + symbol.replace("_", r"\_") + "}"
            symbol = f"${letter}_{self.component}$"
        return f"{name}  {symbol}".strip()

    @property
    def letter(self) -> str:
        """What is drawn, as text."""
        return self.symbol if self.component is None else f"{self.symbol}{'₁₂₃'[self.component - 1]}"


class Group(NamedTuple):
    """Curves of one unit.

    Attributes
    ----------
    name : str
    unit : str
        Shown.
    factor : float
        How many of it an SI unit is.
    curves : list of Curve
    """

    name: str
    unit: str
    factor: float
    curves: list[Curve]

    @property
    def title(self) -> str:
        """Of the axis."""
        return f"{self.name} ({self.unit})" if self.unit else self.name


def groups(path: Path) -> list[Group]:
    """All series of the history that have something to show: no empty columns, and no round-off."""
    numbers = _numbers(path)
    found = []
    for series in (one for one in SERIES.values() if one.curves):
        columns = {name: numbers[name] for name in series.columns(path.model)}
        known = {name: values for name, values in columns.items() if np.isfinite(values).all()}
        largest = max((float(np.abs(values).max()) for values in known.values()), default=0.0)
        least = max(ROUND_OFF * _scale(path, series.unit), ROUND_OFF * largest)
        told = {name: values for name, values in known.items() if np.abs(values).max() > least}
        if told:
            unit, factor = in_pictures(series.unit)
            found.append(Group(series.name, unit, factor, _curves(told)))
    return found


def chosen(path: Path, names: Sequence[str]) -> Group:
    """Columns of the history as one group.

    Raises
    ------
    InputError
        No such column, columns of several units, or one without numbers.

    Notes
    -----
    A column that is all round-off is zero.
    """
    of = {name: series for series in SERIES.values() for name in series.columns(path.model)}
    units = {f"{probe}.u{i}": "m" for probe in path.model.probe_nodes for i in (1, 2, 3)}
    units |= {name: series.unit for name, series in of.items()}
    for name in names:
        if name not in units:
            raise InputError(f"There is no curve '{name}'. {suggest(name, units)}")
    first = names[0]
    for name in names:
        if units[name] != units[first]:
            said = [f"'{one}' is {f'in {units[one]}' if units[one] else 'a number'}" for one in (first, name)]
            raise InputError(f"{' and '.join(said)}; the curves of one picture have one unit")
    numbers = _numbers(path)
    for name in names:
        if not np.isfinite(numbers[name]).all():
            raise InputError(f"'{name}' is empty for this problem. {of[name].sentence if name in of else ''}".strip())
    kinds = {of[name].name if name in of else "displacement" for name in names}
    unit, factor = in_pictures(units[first])
    least = ROUND_OFF * _scale(path, units[first])
    told = {name: numbers[name] * bool(np.abs(numbers[name]).max() > least) for name in names}
    return Group(", ".join(sorted(kinds)), unit, factor, _curves(told))


def some(curves: list[Curve], probes: int = 0) -> tuple[list[Curve], str]:
    """At most `MOST_CURVES` of them, and a sentence that says how many there are, empty if all are drawn.

    Curves of one name stay together. The names are spread evenly from that of the largest value to that of the
    smallest. Of probes their number is told, else that of the curves.
    """
    if len(curves) <= MOST_CURVES:
        return curves, ""
    largest: dict[str, float] = {}
    for curve in curves:
        largest[curve.name] = max(float(np.abs(curve.values).max()), largest.get(curve.name, 0.0))
    ranked = sorted(largest, key=lambda name: -largest[name])
    drawn: list[Curve] = []
    for count in range(min(len(ranked), MOST_CURVES), 0, -1):
        names = {ranked[i] for i in np.linspace(0, len(ranked) - 1, count).astype(int)}
        drawn = [curve for curve in curves if curve.name in names]
        if len(drawn) <= MOST_CURVES:
            break
    drawn = drawn[:MOST_CURVES]
    names_drawn = list(dict.fromkeys(curve.name for curve in drawn))
    if len(names_drawn) > 1:
        drawn = [
            curve._replace(style=curve.style | {"color": COLOURS[names_drawn.index(curve.name) % len(COLOURS)]})
            for curve in drawn
        ]
    counted = f"{len(names_drawn)} of {probes} probes" if probes else f"{len(drawn)} of {len(curves)} curves"
    return drawn, f"{counted} are drawn; history.csv has all."


def shorten(name: str, most: int) -> str:
    """A name of at most so many letters."""
    return name if len(name) <= most else f"{name[: most - 1]}…"


def _numbers(path: Path) -> dict[str, FloatArray]:
    """Columns of the history; NaN where there is none."""
    rows = np.array([[np.nan if one is None else one for one in row] for row in path.history.rows(path.steps)])
    return dict(zip(path.history.columns, rows.T, strict=True))


def _scale(path: Path, unit: str) -> float:
    """What a magnitude of this unit is round-off against, SI.

    Of forces and moments it is the largest sum of magnitudes on the path, of stresses the shear modulus, of strains 1,
    of energies that of a strain of the root of `ROUND_OFF`.
    """
    balances = [balance for step in path.steps if (balance := step.balance) is not None]
    if field := {"N": "force_scale", "N m": "moment_scale"}.get(unit):
        return max((getattr(balance, field) for balance in balances), default=0.0)
    shell = path.model.shell
    modulus, thickness = float(shell.mean_of("shear_modulus").max()), max(part.at_nodes.max() for part in shell.parts)
    return {"Pa": modulus, "": 1.0, "J": ROUND_OFF * modulus * thickness * shell.mesh.size**2}.get(unit, 0.0)


def _curves(columns: dict[str, FloatArray]) -> list[Curve]:
    """A colour for each name, or for each curve where there is one name; a line for each component."""
    parts = {name: _parts(name) for name in columns}
    owners = list(dict.fromkeys(owner for owner, _, _ in parts.values()))
    found = []
    for number, (name, values) in enumerate(columns.items()):
        owner, symbol, component = parts[name]
        line, marker = COMPONENTS[(component or 3) - 1]
        colour = COLOURS[(number if len(owners) == 1 else owners.index(owner)) % len(COLOURS)]
        style = {"color": colour, "linestyle": line, "marker": marker, "linewidth": 2.0}
        found.append(Curve(owner, symbol, component, values, style))
    return found


def _parts(column: str) -> tuple[str, str, int | None]:
    """Owner, symbol and component of a column such as `tip.R3`, `torque2` or `elastic`."""
    owner, _, rest = column.rpartition(".")
    numbered = _NUMBERED.fullmatch(rest)
    return (owner, numbered[1], int(numbered[2])) if numbered else (owner, rest, None)


def _literal(name: str) -> str:
    """A user's name, safe from being read as mathematics."""
    return name.replace("$", r"\$")
