"""The page about the layout names what is there."""

from __future__ import annotations

import pathlib
import re

import pytest

ROOT = pathlib.Path(__file__).parents[2]
SOURCE = ROOT / "src" / "magshell"
LAYOUT = (ROOT / "docs" / "layout.md").read_text()
NAMED = set(re.findall(r"`([\w*./-]+(?:/|\.py|\.toml))`", LAYOUT.split("## How data flows")[0]))


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
