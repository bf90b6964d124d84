"""The pages of docs/examples: each made of a problem file, the Python that does the same, pictures and numbers."""

from __future__ import annotations

import contextlib
import io
import pathlib
import runpy
from collections.abc import Mapping, Sequence

import numpy as np

import magshell as ms
from magshell.problem import examples
from magshell.reproduction.catalogue import Example
from magshell.reproduction.numbers import at_probe
from magshell.reproduction.page import Section
from magshell.reproduction.references import QUOTED
from magshell.reproduction.table import Row

SAME = 1e-9
"""Largest difference between the runs of a script and of its problem file, over the largest displacement."""

Paths = Mapping[str, ms.Path]


def page(section: Section, built_in: Paths, script: pathlib.Path) -> str:
    """The page of an example.

    Parameters
    ----------
    section : Section
        Solved with the paper's element, its figures drawn.
    built_in : mapping of str to Path
        Of the built-in problems as they are, by name.
    script : pathlib.Path
        Python that does the same as the problem files; it is run and compared with them.
    """
    example = section.example
    paths = {name: built_in[name] for name in example.problems}
    printed, apart = _run(script, paths)
    texts = {name: examples.text(name) for name in example.problems}
    shown = example.problems[0]
    parts = [
        f"# {example.title}",
        example.about,
        *(f"![{caption}](../images/{file.name})" for file, caption in section.figures),
        "## Numbers",
        "With the element and the mesh of the paper, as `magshell reproduce` prints them:",
        table(section.rows),
        *notes(section.rows),
        *_with_the_file(example, paths),
        "## Problem file",
        f"`magshell run {shown} --out results` solves it; `magshell examples --copy {shown}` copies it."
        + (f" The other strips ({', '.join(f'`{n}`' for n in example.problems[1:])}) differ in sizes and mesh."
           if len(texts) > 1 else ""),
        f"```toml\n{texts[shown].strip()}\n```",
        "## The same in Python",
        f"```python\n{script.read_text(encoding='utf-8').strip()}\n```",
        f"It prints\n\n```text\n{printed.strip()}\n```",
        f"The displacements of all probes at all steps differ from those of the problem file by at most {apart:.0e} of "
        "the largest."
        if apart
        else "The displacements of all probes at all steps are those of the problem file, to the last digit.",
    ]  # fmt: skip
    return "\n\n".join(parts) + "\n"


def table(rows: Sequence[Row]) -> str:
    """Rows as Markdown; a number refers to a note below."""
    lines = ["| Quantity | Unit | Paper | Computed | Difference | |", "|---|---|---:|---:|---:|---|"]
    number = 0
    for row in rows:
        number += bool(row.note)
        difference = "" if row.difference_percent is None else f"{row.difference_percent:+.1f} %"
        paper = "" if row.paper is None else f"{row.paper:g}"
        reference = f"[{number}]" if row.note else ""
        quantity = row.quantity.replace("|", "\\|")
        lines.append(f"| {quantity} | {row.unit} | {paper} | {row.computed:#.4g} | {difference} | {reference} |")
    return "\n".join(lines)


def notes(rows: Sequence[Row]) -> list[str]:
    """The notes that `table` refers to."""
    texts = [row.note[0].upper() + row.note[1:].rstrip(".") for row in rows if row.note]
    return ["\n".join(f"{number}. {text}." for number, text in enumerate(texts, start=1))] if texts else []


def _run(script: pathlib.Path, paths: Paths) -> tuple[str, float]:
    """What the script prints, and how far its probes are from those of the problem files."""
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        names = runpy.run_path(str(script))
    own: Paths = names.get("paths") or {next(iter(paths)): names["path"]}
    apart = 0.0
    for name, path in own.items():
        for probe in path.model.probe_nodes:
            one, other = path.probe(probe), paths[name].probe(probe)
            if one.u.shape != other.u.shape:
                raise SystemExit(f"{script.name}: {name}: {len(one.u)} steps, the problem file has {len(other.u)}")
            apart = max(apart, float(np.abs(one.u - other.u).max() / np.abs(other.u).max()))
    if apart > SAME:
        raise SystemExit(f"{script.name}: differs from the problem file by {apart:.1e}")
    return printed.getvalue(), apart


def _with_the_file(example: Example, paths: Paths) -> list[str]:
    """What the problem file gives as it is, with its own element."""
    entries = [entry for entry in QUOTED if entry.example == example.name]
    if not entries:
        return []
    path = paths[example.name]
    element = path.model.shell.element.name
    values = ", ".join(
        f"{abs(at_probe(path, entry.probe, entry.component, entry.field)):.2f} mm for {entry.what}" for entry in entries
    )
    return [f"The problem file below, with the {element} element, gives {values}."]
