"""The page: its parts put together, every text in it escaped."""

from __future__ import annotations

import html
import json
import os
import pathlib
import string
from collections.abc import Callable, Sequence
from importlib import resources
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

from magshell.errors import InputError
from magshell.files import with_suffix, write_atomically
from magshell.output.page.data import collect
from magshell.output.page.facts import Facts, facts
from magshell.output.page.steps import shown_steps

if TYPE_CHECKING:
    from magshell.solver.path import Path

SCRIPTS = (
    "data.js", "files.js", "body.js", "camera.js", "scene.js", "sight.js", "curves.js", "probes.js", "pointer.js",
    "solid.js", "page.js",
)  # fmt: skip
TITLE = "Deformed shell"


def write_page(
    path: Path,
    file: str | os.PathLike[str] = "view.html",
    title: str = TITLE,
    color: str = "u3",
    about: Sequence[tuple[str, str]] = (),
    advance: Callable[[float], None] = lambda share: None,
) -> pathlib.Path:
    """Write a path as one HTML file that shows itself in any browser, without a network.

    Of a path that would be too large for a browser, the page shows the steps of `shown_steps`, and says so.

    Parameters
    ----------
    path : Path
        Of one converged step or more.
    file : path
    title : str
    color : str
        Output that colours the shape when the page opens, as in `magshell.evaluation.outputs.find`.
    about : sequence of (str, str)
        Labels and texts said of the problem before what the model itself tells.
    advance : callable
        Told the share of the work that is done.

    Returns
    -------
    pathlib.Path
        The file.

    Raises
    ------
    InputError
        A path without steps, no such output, or a name that says another format.
    OSError
        The disk refuses; the message names the file.
    """
    target = with_suffix(file, ".html", ".htm")
    write_atomically(target, page(path, title, color, about, advance).encode())
    return target


def page(
    path: Path,
    title: str = TITLE,
    color: str = "u3",
    about: Sequence[tuple[str, str]] = (),
    advance: Callable[[float], None] = lambda share: None,
) -> str:
    """The text of `write_page`'s file."""
    if not path.steps:
        raise InputError("the path has no converged step, so there is nothing to show")
    steps = shown_steps(path)
    data = collect(path, steps, color, advance)
    arrays = [
        f'<script type="text/plain" id="array-{html.escape(name)}">{content}</script>'
        for name, content in data.arrays.items()
    ]
    return string.Template(_part("page.html")).substitute(
        title=html.escape(title),
        version=html.escape(version("magshell")),
        facts=_list([*about, *facts(path, steps)]),
        style=_part("page.css"),
        header=_json(data.header),
        arrays="\n".join(arrays),
        script="\n".join(_part(name) for name in SCRIPTS),
    )


def _part(name: str) -> str:
    return resources.files(__package__).joinpath(name).read_text(encoding="utf-8")


def _list(lines: Facts) -> str:
    return "\n".join(f"<div><dt>{html.escape(label)}</dt><dd>{html.escape(text)}</dd></div>" for label, text in lines)


def _json(value: Any) -> str:
    """JSON that neither ends the element it stands in nor holds a number that is not finite."""
    text = json.dumps(value, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    return text.translate({ord(sign): f"\\u{ord(sign):04x}" for sign in "<>&\u2028\u2029"})
