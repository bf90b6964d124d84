"""The picture of reactions.md, from the problem file on that page."""

from __future__ import annotations

import pathlib
import re

import magshell as ms
from magshell.output.curve import draw_curve
from magshell.problem.building import Problem, build
from magshell.problem.reading import check, parse

PAGE = pathlib.Path(__file__).parent / "reactions.md"


def blocked() -> Problem:
    """The problem of the recipe."""
    found = re.findall(r"^```toml\n(title.*?)^```", PAGE.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    (text,) = found
    return build(check(parse(text, "blocked.toml"), "blocked.toml"), "blocked.toml", text)


def draw(images: pathlib.Path) -> None:
    """Solve and draw."""
    problem = blocked()
    draw_curve(ms.solve(problem.model, problem.settings), images / "blocked-force.png", ["stop.R3"])
