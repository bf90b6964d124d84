"""docs/recipes: every problem file and program of these pages runs, in order, and prints what the page says."""

from __future__ import annotations

import argparse
import contextlib
import importlib
import io
import pathlib
import re
import shlex
import shutil
from typing import NamedTuple

import pytest
from problem_files import STRIP

import magshell as ms
from magshell import cli
from magshell.output import rendering
from magshell.problem.reading import check, parse

DOCS = pathlib.Path(__file__).parents[2] / "docs"
FOLDER = DOCS / "recipes"
PAGES = sorted(page.stem for page in FOLDER.glob("*.md") if page.stem != "README")
LONG = ("stl", "strain")
"""Pages that mesh or draw for more than 5 s: they run in `make verify`."""
DRAWN = ("show", "plot")
"""Commands that need a machine that can draw in three dimensions."""


class Block(NamedTuple):
    language: str
    text: str


def blocks_of(page: str) -> list[Block]:
    text = (FOLDER / f"{page}.md").read_text(encoding="utf-8")
    return [Block(*found) for found in re.findall(r"^```(\w+)\n(.*?)^```", text, re.MULTILINE | re.DOTALL)]


def name_of_file(blocks: list[Block]) -> str:
    """The problem file that the commands and programs of a page name."""
    named = set(re.findall(r"\b(\w+\.toml)\b", "".join(block.text for block in blocks if block.language != "toml")))
    assert len(named) <= 1, f"a page has one problem file, not {named}"
    return named.pop() if named else "part.toml"


def with_table(text: str) -> str:
    """A problem file: as the page has it, or with its tables in place of those of a strip."""
    if text.startswith("[mesh]"):
        return text
    name = re.match(r"\[+(\w+)\]+\n", text)[1]
    kept = re.sub(rf"^\[+{name}\]+\n.*?(?=^\[|\Z)", "", STRIP, flags=re.MULTILINE | re.DOTALL)
    return kept + "\n" + text


def commands_of(block: Block) -> list[list[str]]:
    return [shlex.split(line, comments=True)[1:] for line in block.text.splitlines() if line.startswith("magshell ")]


def run(block: Block, names: dict[str, object], can_draw: bool) -> str:
    """What a block prints."""
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        if block.language == "python":
            exec(compile(block.text, "recipe", "exec"), names)
        else:
            for words in commands_of(block):
                if words[0] not in DRAWN or can_draw:
                    assert cli.main(words) == 0, words
    return printed.getvalue()


def can_draw() -> bool:
    try:
        rendering.require_rendering()
    except rendering.RenderingUnavailable:
        return False
    return True


@pytest.mark.parametrize(
    "page", [pytest.param(page, marks=pytest.mark.verify) if page in LONG else page for page in PAGES]
)
def test_a_page_runs_and_prints_what_it_says(page: str, tmp_path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    shutil.copy(DOCS / "meshes" / "plate.stl", tmp_path)
    blocks, names, printed, before = blocks_of(page), {}, "", ""
    for block in blocks:
        if block.language == "toml":
            file = pathlib.Path(name_of_file(blocks))
            file.write_text(with_table(block.text), encoding="utf-8")
            ms.problem.load(file)
        elif block.language == "text":
            lines = [line for line in printed.splitlines() if line] if before == "python" else block.text.splitlines()
            assert block.text.splitlines() == lines, printed
            missing = [line for line in block.text.splitlines() if line not in printed.splitlines()]
            assert not missing, printed
        else:
            assert block.language in ("python", "sh"), block.language
            printed = run(block, names, can_draw())
        before = block.language


@pytest.mark.parametrize("page", LONG)
def test_files_commands_and_programs_of_long_pages_are_sound(page: str) -> None:
    """The small twin: problem files are checked, commands have their options, programs compile."""
    for block in blocks_of(page):
        if block.language == "toml":
            check(parse(with_table(block.text), page), page)
        elif block.language == "python":
            compile(block.text, page, "exec")
        for words in commands_of(block) if block.language == "sh" else []:
            assert words[0] in cli.COMMANDS
            known = importlib.import_module(f"magshell.cli.{words[0]}")
            parser = argparse.ArgumentParser()
            known.add_arguments(parser)
            parser.parse_args(words[1:])


def test_every_page_is_in_the_list_and_no_longer_than_a_screen() -> None:
    index = (FOLDER / "README.md").read_text(encoding="utf-8")
    assert set(re.findall(r"\]\(([\w-]+)\.md\)", index)) == set(PAGES)
    for page in PAGES:
        text = (FOLDER / f"{page}.md").read_text(encoding="utf-8")
        assert len(text.splitlines()) <= 90, page
        assert re.search(r"^More: \[", text, re.MULTILINE), f"{page}: ends without links"
