"""The tutorial as it is stored; that it runs is tested with the site."""

from __future__ import annotations

import pathlib

import nbformat
import pytest

DOCS = pathlib.Path(__file__).parents[2] / "docs"


@pytest.fixture(scope="module")
def cells():
    notebook = nbformat.read(DOCS / "tutorial.ipynb", as_version=4)
    nbformat.validate(notebook)
    return notebook.cells


def test_nothing_computed_is_stored(cells):
    code = [cell for cell in cells if cell.cell_type == "code"]
    assert code
    for cell in code:
        assert cell.outputs == [], cell.source
        assert cell.execution_count is None, cell.source


def test_it_checks_what_it_computes(cells):
    asserts = [line for cell in cells for line in cell.source.splitlines() if line.startswith("assert ")]
    assert len(asserts) >= 2, asserts
