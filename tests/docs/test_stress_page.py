"""The recipe of the page on strain and stress runs as it stands."""

from __future__ import annotations

import pathlib
import re

import numpy as np
import pytest

from magshell.output import rendering

PAGE = pathlib.Path(__file__).parents[2] / "docs" / "stress.md"


def block(language: str) -> str:
    found = re.findall(rf"^```{language}\n(.*?)^```", PAGE.read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE)
    assert len(found) == 1
    return found[0]


def test_the_recipe_runs(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "arm.toml").write_text(block("toml"), encoding="utf-8")
    names: dict[str, object] = {}
    code = block("python")
    try:
        rendering.require_rendering()
    except rendering.RenderingUnavailable:
        code = "\n".join(line for line in code.splitlines() if ".plot(" not in line)
    exec(code, names)
    assert re.search(r"^\d+ Pa at node \d+, (top|bottom) face", capsys.readouterr().out)
    path, root = names["path"], names["root"]
    mesh = path.model.shell.mesh
    assert len(names["stress"]) > len(mesh.points), "nodes at the step are there twice"
    root = root[np.argsort(mesh.points[root, 1])]
    moment = np.array([1, 4, 2, 4, 1]) / 12.0 @ (path.values("M11")[root] + path.values("C21")[root]) * 4e-3
    torque = path.summary["magnetic_torque"][1]
    assert moment == pytest.approx(torque, rel=0.05), "what the clamp holds is the field's torque"
