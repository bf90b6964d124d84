"""The parts of a page that a command makes: each between two marks that name the block and the command."""

from __future__ import annotations

import pathlib
from collections.abc import Mapping

from magshell.files import write_atomically


def filled(page: str, blocks: Mapping[str, str], command: str) -> str:
    """The page with these blocks of a command between their marks."""
    for name, content in blocks.items():
        begin, end = f"<!-- {name}: {command} -->", f"<!-- end of {name} -->"
        before, rest = page.split(begin)
        page = f"{before}{begin}\n{content}\n{end}{rest.split(end)[1]}"
    return page


def write_blocks(file: pathlib.Path, blocks: Mapping[str, str], command: str) -> None:
    """Put blocks of a command into the page in a file."""
    write_atomically(file, filled(file.read_text(encoding="utf-8"), blocks, command).encode())
