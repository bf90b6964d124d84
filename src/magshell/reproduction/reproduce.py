"""The paper, reproduced: solve, compare, draw, write."""

from __future__ import annotations

import pathlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, field
from importlib.metadata import version
from typing import TYPE_CHECKING

from magshell.files import first_line, refuse_somebodys
from magshell.output.rendering import RenderingUnavailable
from magshell.output.style import deliver
from magshell.reproduction.catalogue import EXAMPLES, Example, find
from magshell.reproduction.curves import curves_figure
from magshell.reproduction.display import Display
from magshell.reproduction.locking import locking_figure
from magshell.reproduction.numbers import rows_of
from magshell.reproduction.page import Section, write_page
from magshell.reproduction.runs import solve_all
from magshell.reproduction.shapes import shapes_figure, undeformed_figure
from magshell.reproduction.table import COLUMNS, Row, write_table
from magshell.reproduction.variants import variants

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from rich.console import Console

    from magshell.solver.path import Path

TABLE, PAGE = "reproduction.csv", "index.html"
_LOCKING = (
    "Without the thickness stretch φ the strips are too stiff; plane stress, solved at each point, takes its place. "
    "Diamonds: three-dimensional micropolar finite elements. Dots: experiment of Zhao et al. (2019)."
)


@dataclass
class Reproduction:
    """What is done so far.

    Attributes
    ----------
    directory : pathlib.Path
    wanted : list of Example
    sections : dict of str to Section
        By example, those that are done or have failed.
    failed : list of str
        Examples that have failed.
    """

    directory: pathlib.Path
    wanted: list[Example]
    sections: dict[str, Section] = field(default_factory=dict)
    failed: list[str] = field(default_factory=list)

    @property
    def rows(self) -> list[Row]:
        """Of all examples that are done, in the paper's order."""
        return [row for example in self.wanted if example.name in self.sections for row in self._of(example).rows]

    @property
    def missing(self) -> list[str]:
        """Titles of wanted examples that are not done."""
        return [example.title for example in self.wanted if example.name not in self.sections]

    def _of(self, example: Example) -> Section:
        return self.sections[example.name]

    def write(self) -> None:
        """Write table and page of what is done."""
        write_table(self.rows, self.directory / TABLE)
        sections = [self._of(example) for example in self.wanted if example.name in self.sections]
        write_page(sections, self.missing, version("magshell"), self.directory / PAGE)


def reproduce(names: Sequence[str], directory: pathlib.Path, console: Console) -> Reproduction:
    """Run examples of the paper in parallel and write `reproduction.csv`, `index.html` and the figures.

    Each example is on disk as soon as it is solved; on Ctrl-C those that are done stay. One that fails is recorded with
    its reason, and the others go on.

    Parameters
    ----------
    names : sequence of str
        Of the examples; all of them if empty.
    directory : pathlib.Path
        Folder of the files, there already.
    console : rich.console.Console

    Returns
    -------
    Reproduction

    Raises
    ------
    InputError
        An unknown name; names the nearest.
    OSError
        The disk refuses; the message names the file.
    """
    result = Reproduction(directory, find(names))
    files = {example.name: variants(example) for example in result.wanted}
    owner = {name: example for example in result.wanted for name in files[example.name]}
    require_free(directory)
    _forget_earlier(directory)
    solved: dict[str, dict[str, Path]] = {example.name: {} for example in result.wanted}
    everything = {name: file for group in files.values() for name, file in group.items()}
    with Display(console, everything) as display, closing(solve_all(everything, display.reached)) as outcomes:
        for outcome in outcomes:
            example = owner[outcome.name]
            if outcome.path is None:
                _record_failure(result, example, f"{outcome.name}: {outcome.reason}")
                result.write()
                display.say(f"{example.name}: failed: {outcome.name}: {outcome.reason}", style="red")
                continue
            solved[example.name][outcome.name] = outcome.path
            if len(solved[example.name]) == len(files[example.name]):
                result.sections[example.name] = section_of(example, solved.pop(example.name), directory)
                result.write()
                display.say(f"{example.name}: done ({len(result.sections)} of {len(result.wanted)})")
    return result


def _record_failure(result: Reproduction, example: Example, reason: str) -> None:
    earlier = result.sections.get(example.name, Section(example, []))
    rows = [*earlier.rows, Row(example.name, "not solved", note=reason)]
    result.sections[example.name] = Section(example, rows, remarks=[*earlier.remarks, f"Not solved: {reason}"])
    result.failed = list(dict.fromkeys([*result.failed, example.name]))


def section_of(example: Example, paths: Mapping[str, Path], directory: pathlib.Path) -> Section:
    """Numbers and figures of an example, the figures written; one that this machine cannot draw leaves a remark.

    Parameters
    ----------
    example : Example
    paths : mapping of str to Path
        Of all its variants, by name.
    directory : pathlib.Path
        For the figures, `EXAMPLE-FIGURE.png`.
    """
    figures, remarks = [], []
    for name, caption, draw in _figures(example):
        file = directory / f"{example.name}-{name}.png"
        try:
            deliver(draw(example, paths), file)
            figures.append((file, caption))
        except RenderingUnavailable as unavailable:
            remarks = [str(unavailable)]
    return Section(example, rows_of(example.name, paths), figures, remarks)


def _figures(example: Example) -> Iterator[tuple[str, str, Callable[[Example, Mapping[str, Path]], Figure]]]:
    """Name, caption and function of every figure."""
    yield (
        "undeformed",
        "The undeformed body with its remanence (blue) and the external field (orange).",
        undeformed_figure,
    )
    experiment = " Dots: experiment of Zhao et al. (2019)." if len(example.problems) > 1 else ""
    diamonds = "" if experiment else " Diamonds: the numbers that the paper quotes."
    marks = "Small marks are converged steps."
    yield "curves", f"Displacement over the nondimensional load. {marks}{experiment}{diamonds}", curves_figure
    fields = ", ".join(f"{field:g}" for field in example.fields)
    if len(example.problems) > 1:
        yield "locking", _LOCKING, locking_figure
    yield "shapes", f"Deformed shapes at {fields} mT, true to scale and thickness.", shapes_figure


def require_free(directory: pathlib.Path) -> None:
    """Refuse a folder in which files that no run has made would be replaced or removed.

    Raises
    ------
    InputError
        Names them.
    """
    made = first_line(directory / TABLE).strip() == ",".join(COLUMNS)
    refuse_somebodys(directory, made, (TABLE, PAGE, *(f"{example.name}-*.png" for example in EXAMPLES)))


def _forget_earlier(directory: pathlib.Path) -> None:
    """Remove what an earlier run wrote, so that no page shows figures of another run."""
    for name in (TABLE, PAGE):
        (directory / name).unlink(missing_ok=True)
    for example in EXAMPLES:
        for file in directory.glob(f"{example.name}-*.png"):
            file.unlink()
