"""`index.html`: everything on one page that needs no network and no other file."""

from __future__ import annotations

import base64
import html
import pathlib
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from magshell.files import write_atomically
from magshell.reproduction.catalogue import Example
from magshell.reproduction.table import WORTH_A_NOTE, Row

STYLE = """
:root { color-scheme: light; }
body { margin: 0 auto; max-width: 72rem; padding: 2rem 1.5rem 4rem; background: #fff; color: #1a1f26;
  font: 16px/1.55 system-ui, sans-serif; }
h1 { font-size: 1.9rem; margin: 0 0 .4rem; } h2 { font-size: 1.4rem; margin: 3.5rem 0 .4rem; }
p { max-width: 46rem; } .quiet { color: #4b5563; } nav a { margin-right: 1.1rem; }
a { color: #1d4ed8; text-decoration: none; } a:hover { text-decoration: underline; }
figure { margin: 1rem 0; } figure img { width: 100%; height: auto; display: block; }
figcaption { color: #4b5563; font-size: .9rem; max-width: 46rem; }
.pair { display: grid; grid-template-columns: repeat(auto-fit, minmax(22rem, 1fr)); gap: 1.5rem; align-items: end; }
.scroll { overflow-x: auto; } table { border-collapse: collapse; font-size: .92rem; width: 100%; margin: 1rem 0; }
th, td { text-align: left; padding: .4rem .9rem .4rem 0; border-bottom: 1px solid #e5e7eb; vertical-align: top; }
th { font-weight: 600; border-bottom-color: #9aa3ad; } td.number, th.number { text-align: right; white-space: nowrap;
  font-variant-numeric: tabular-nums; }
tr.note td { border-bottom: 1px solid #e5e7eb; color: #4b5563; padding: 0 .9rem .6rem 1.2rem; font-size: .88rem; }
tr.noted td { border-bottom: 0; } .far { color: #c2410c; } .failed { color: #b91c1c; }
"""


class Section(NamedTuple):
    """An example on the page.

    Attributes
    ----------
    example : Example
    rows : sequence of Row
    figures : sequence of (pathlib.Path, str)
        Files and captions.
    remarks : sequence of str
        What went wrong, or is missing and why.
    """

    example: Example
    rows: Sequence[Row]
    figures: Sequence[tuple[pathlib.Path, str]] = ()
    remarks: Sequence[str] = ()


def write_page(sections: Sequence[Section], missing: Sequence[str], version: str, file: pathlib.Path) -> None:
    """Write the page in one go.

    Parameters
    ----------
    sections : sequence of Section
    missing : sequence of str
        Titles of examples that are not there yet.
    version : str
        Of magshell.
    file : pathlib.Path

    Raises
    ------
    OSError
        The disk refuses; the message names the file.
    """
    links = " ".join(f'<a href="#{one.example.name}">{_text(one.example.title)}</a>' for one in sections)
    quoted = [row for section in sections for row in section.rows if row.paper is not None]
    parts = [
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f"<title>The paper reproduced</title><style>{STYLE}</style></head><body>",
        "<h1>The paper reproduced</h1>",
        "<p>The examples of F. Dadgar-Rad and M. Hossain, <em>A micropolar shell model for hard-magnetic soft "
        f"materials</em>, solved by magshell {_text(version)} with the paper’s element on the paper’s meshes.</p>",
        f'<p class="failed">Not here: {_text(", ".join(missing))}.</p>' if missing else "",
        f"<nav>{links}</nav>",
        "<h2>Numbers of the paper</h2>" + _table(quoted) if quoted else "",
        *map(_section, sections),
        "</body></html>\n",
    ]
    write_atomically(file, "\n".join(parts).encode())


def _section(section: Section) -> str:
    example = section.example
    first, rest = section.figures[:2], section.figures[2:]
    return "\n".join(
        [
            f'<section id="{example.name}"><h2>{_text(example.title)}</h2>',
            f"<p>{_text(example.about)}</p>",
            *(f'<p class="failed">{_text(remark)}</p>' for remark in section.remarks),
            f'<div class="pair">{"".join(map(_figure, first))}</div>' if first else "",
            *map(_figure, rest),
            _table(section.rows) if section.rows else "",
            "</section>",
        ]
    )


def _figure(figure: tuple[pathlib.Path, str]) -> str:
    file, caption = figure
    data = base64.b64encode(file.read_bytes()).decode()
    words = _text(caption)
    return f'<figure><img alt="{words}" src="data:image/png;base64,{data}"><figcaption>{words}</figcaption></figure>'


def _table(rows: Iterable[Row]) -> str:
    head = "".join(
        f"<th{' class=number' if number else ''}>{name}</th>"
        for name, number in (("Quantity", 0), ("Unit", 0), ("Paper", 1), ("Computed", 1), ("Difference", 1))
    )
    body = "".join(map(_row, rows))
    return f'<div class="scroll"><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>'


def _row(row: Row) -> str:
    difference = row.difference_percent
    far = difference is not None and abs(difference) > WORTH_A_NOTE
    cells = [
        f"<td>{_text(row.example)}: {_text(row.quantity)}</td><td>{_text(row.unit)}</td>",
        f'<td class="number">{"" if row.paper is None else f"{row.paper:g}"}</td>',
        f'<td class="number">{"" if row.computed is None else f"{row.computed:#.4g}"}</td>',
        f'<td class="number{" far" if far else ""}">{"" if difference is None else f"{difference:+.1f} %"}</td>',
    ]
    line = f"<tr{' class=noted' if row.note else ''}>{''.join(cells)}</tr>"
    return line + (f'<tr class="note"><td colspan="5">{_text(row.note)}</td></tr>' if row.note else "")


def _text(text: str) -> str:
    return html.escape(text)
