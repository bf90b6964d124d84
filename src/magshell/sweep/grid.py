"""The cells of a sweep: every combination of the values, each checked before any is solved."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from magshell.errors import InputError, NothingLoads
from magshell.model import coupling_limit, own_field_limit, symmetry
from magshell.problem.alternatives import Setting, Value
from magshell.problem.building import build
from magshell.problem.building.material import by_default
from magshell.problem.changes import changed, label
from magshell.problem.reading import MOST_ERRORS, Source, check, parse

MOST_CELLS = 10_000


@dataclass(frozen=True)
class Cell:
    """One problem of a sweep.

    Attributes
    ----------
    number : int
        From 1; the values of the last setting vary fastest.
    values : tuple of Value
        One for each setting.
    label : str
        Those that vary, in words.
    source : Source
        The problem file with these values.
    probes : tuple of str
    undeformed : bool
        Nothing acts on the shell, so there is nothing to solve.
    doubts : tuple of str
        Broken mirror planes, and a couple of the field that is too strong.
    note : str or None
        Note on defaults of its file that have changed.
    """

    number: int
    values: tuple[Value, ...]
    label: str
    source: Source
    probes: tuple[str, ...]
    undeformed: bool = False
    doubts: tuple[str, ...] = ()
    note: str | None = None

    @property
    def name(self) -> str:
        """Its folder."""
        return f"{self.number:04d}"


def grid(
    source: Source, settings: Sequence[Setting], checked: Callable[[int], None] = lambda count: None
) -> list[Cell]:
    """All cells, in the order of their numbers.

    Parameters
    ----------
    source : Source
        The problem file that is varied.
    settings : sequence of Setting
    checked : callable
        Told how many cells have been checked.

    Raises
    ------
    InputError
        Too many cells, or what is wrong with any of them: one line per error, with file, key and cells.
    """
    if not settings:
        raise InputError("--set: is missing; give at least one KEY=VALUES, such as shell.thickness=0.4,0.8 mm")
    count = math.prod(len(setting.values) for setting in settings)
    if count > MOST_CELLS:
        raise InputError(f"--set: asks for {count} cells; a sweep has at most {MOST_CELLS}")
    cells: list[Cell] = []
    faults: dict[str, list[str]] = {}
    varied = [setting.key for setting in settings if count == 1 or len(setting.values) > 1]
    for number, values in enumerate(itertools.product(*(setting.values for setting in settings)), start=1):
        changes = {setting.key: value for setting, value in zip(settings, values, strict=True)}
        words = label({key: changes[key] for key in varied})
        try:
            cells.append(_cell(number, words, changes, source))
        except InputError as error:
            for line in str(error).splitlines():
                faults.setdefault(line, []).append(f"cell {number}: {words}")
        checked(number)
    if faults:
        raise InputError("\n".join(_lines(faults, count, source.name)))
    return cells


def doubts(cells: Sequence[Cell]) -> list[str]:
    """What is doubtful of the cells, each once, with the first of them."""
    where: dict[str, list[str]] = {}
    for cell in cells:
        for fault in cell.doubts:
            where.setdefault(fault, []).append(f"cell {cell.number}: {cell.label}")
    return _lines(where, len(cells), "sweep", "warnings")


def _cell(number: int, words: str, changes: dict[str, Value], source: Source) -> Cell:
    found = changed(source, changes)
    file = check(parse(found.text, found.name), found.name)
    cell = Cell(number, tuple(changes.values()), words, found, tuple(file.probes))
    try:
        model = build(file, *found).model
    except NothingLoads:
        return replace(cell, undeformed=True)
    weak = [
        *coupling_limit.reached(model.shell, model.coupling, model.largest_field),
        *own_field_limit.reached(model.shell, model.field),
    ]
    return replace(cell, doubts=(*symmetry.broken(model), *weak), note=by_default(file))


def _lines(faults: dict[str, list[str]], count: int, name: str, what: str = "errors") -> list[str]:
    """What is wrong, and in which cells."""
    lines = []
    for fault, where in faults.items():
        others = f"; and {len(where) - 1} more" if len(where) > 1 else ""
        lines.append(f"{fault} (every cell)" if len(where) == count else f"{fault} ({where[0]}{others})")
    if len(lines) > MOST_ERRORS:
        lines[MOST_ERRORS:] = [f"{name}: and {len(lines) - MOST_ERRORS} more {what}"]
    return lines
