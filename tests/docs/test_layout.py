"""The pages about the code name what is there."""

from __future__ import annotations

import pathlib
import re

import pytest

ROOT = pathlib.Path(__file__).parents[2]
SOURCE = ROOT / "src" / "magshell"
LAYOUT = (ROOT / "docs" / "layout.md").read_text()
FILE = r"`([\w*./-]+(?:/|\.py|\.toml))`"
NAMED = set(re.findall(FILE, LAYOUT.split("## How data flows")[0]))
OTHERS = {
    (page, name) for page in ("core.md", "theory.md") for name in re.findall(FILE, (ROOT / "docs" / page).read_text())
}
CORE = (ROOT / "docs" / "core.md").read_text().split("## Where the next features enter")[0]


def modules():
    """The package's own modules at its top, and its folders."""
    for path in sorted(SOURCE.rglob("*.py")):
        if path.parent != SOURCE and path.name == "__init__.py":
            yield f"{path.parent.name}/"
        elif path.parent == SOURCE and not path.name.startswith("__"):
            yield path.name


@pytest.mark.parametrize("name", list(modules()))
def test_every_folder_and_every_module_at_the_top_is_named(name):
    assert any(f"/{one}".endswith(f"/{name}") or one.startswith(name) for one in NAMED)


@pytest.mark.parametrize("name", sorted(NAMED))
def test_what_is_named_exists(name):
    places = (ROOT, ROOT / "docs", SOURCE)
    assert any(True for place in places for _ in place.glob(name)) or any(SOURCE.rglob(name)), name


@pytest.mark.parametrize(("page", "name"), sorted(OTHERS))
def test_what_other_pages_name_exists(page, name):
    assert any(True for place in (ROOT, SOURCE) for _ in place.glob(name)) or any(SOURCE.rglob(name)), f"{page}: {name}"


def test_the_page_about_the_core_uses_the_names_of_the_code():
    names = {part for name in re.findall(r"`([A-Za-z_][\w.]*)(?:\(.*?\))?`", CORE) for part in name.split(".")}
    code = set(re.findall(r"\w+", " ".join(file.read_text() for file in SOURCE.rglob("*.py"))))
    assert len(names) > 60
    assert names - {"py", "md"} <= code, sorted(names - code)
