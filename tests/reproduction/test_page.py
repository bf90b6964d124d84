"""The page stands alone; its pictures are those on disk."""

from __future__ import annotations

import base64
import re
from html.parser import HTMLParser
from pathlib import Path

from magshell.reproduction.catalogue import find
from magshell.reproduction.page import Section, write_page
from magshell.reproduction.table import Row
from reproduction.conftest import Interrupted

VOID = {"meta", "img", "br", "link"}


class Checker(HTMLParser):
    """Collects what a page refers to, and elements that are not closed in order."""

    def __init__(self) -> None:
        super().__init__()
        self.references: list[str] = []
        self.anchors: set[str] = set()
        self.open: list[str] = []

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        if tag not in VOID:
            self.open.append(tag)
        for name, value in attributes:
            if name in ("src", "href", "srcset", "data", "action"):
                self.references.append(value or "")
            if name == "id":
                self.anchors.add(value or "")

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag, f"</{tag}> closes {self.open[-3:]}"


def parsed(text: str) -> Checker:
    checker = Checker()
    checker.feed(text)
    assert not checker.open, checker.open
    return checker


def test_page_refers_only_to_itself(interrupted: Interrupted) -> None:
    text = (interrupted.directory / "index.html").read_text()
    page = parsed(text)
    outside = [one[:60] for one in page.references if not one.startswith(("data:image/png;base64,", "#"))]
    assert not outside
    assert {one[1:] for one in page.references if one.startswith("#")} <= page.anchors
    assert not re.search(r"@import|url\(|<script|<link", text)


def test_pictures_of_the_page_are_the_files(interrupted: Interrupted) -> None:
    page = parsed((interrupted.directory / "index.html").read_text())
    inlined = {base64.b64decode(one.partition(",")[2]) for one in page.references if one.startswith("data:")}
    files = {file.read_bytes() for file in interrupted.directory.glob("thin-cross-*.png")}
    assert inlined == files
    assert all(one.startswith(b"\x89PNG") for one in inlined)


def test_text_is_escaped_and_differences_are_marked(tmp_path: Path) -> None:
    (example,) = find(["pump"])
    rows = [Row("pump", "a < b & |u|", "mm", 2.0, 2.05, "why: <5 %"), Row("pump", "close", "mm", 2.0, 2.0)]
    write_page([Section(example, rows, remarks=["no picture: <reason>"])], ["Thin cross"], "0", tmp_path / "page.html")
    text = (tmp_path / "page.html").read_text()
    parsed(text)
    assert "a &lt; b &amp; |u|" in text
    assert "why: &lt;5 %" in text
    assert "no picture: &lt;reason&gt;" in text
    assert text.count('class="number far"') == 2, "the row with 2.5 %, in the summary and in its section"
