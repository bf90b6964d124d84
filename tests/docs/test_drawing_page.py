"""The recipe of `docs/meshes.md` for drawings: the problem is read, with the mesh that the page shows."""

from __future__ import annotations

import pathlib
import re
import shutil

import pytest

import magshell as ms

DOCS = pathlib.Path(__file__).parents[2] / "docs"
PAGE = (DOCS / "meshes.md").read_text(encoding="utf-8")


def test_the_recipe_runs(tmp_path):
    for package in ("gmsh", "ezdxf", "shapely"):
        pytest.importorskip(package, reason=f"{package} is not installed", exc_type=(ImportError, OSError))
    (recipe,) = [
        text for text in re.findall(r"^```toml\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL) if "paddle" in text
    ]
    (tmp_path / "paddle.toml").write_text(recipe)
    shutil.copy(DOCS / "meshes" / "paddle.dxf", tmp_path)
    problem = ms.problem.load(tmp_path / "paddle.toml")
    shown = PAGE.partition("<!-- drawing:")[2].partition("<!-- end of drawing -->")[0]
    assert problem.model.shell.mesh.groups == re.findall(r"^  group +(\S+) \(", shown, re.MULTILINE)
