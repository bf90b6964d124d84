"""Problem files of folded shells, and what `magshell check` says of their kinks and joints."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from problem_files import MIURA, PROFILE, changed

from magshell.cli import main
from magshell.problem import load


def check(text: str, folder: Path, capsys: pytest.CaptureFixture[str]) -> str:
    """What the command says of a problem that is sound."""
    (folder / "folded.toml").write_text(text)
    assert main(["check", str(folder / "folded.toml")]) == 0
    return " ".join(capsys.readouterr().out.split())


def test_an_angle(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    said = check(PROFILE, tmp_path, capsys)
    assert "generator profile" in said
    assert "kinks 1 line, 5 nodes, 90°: knee, from (20 mm, 0, 0) to (20 mm, 0, 10 mm)" in said
    assert "groups post, arm, low, knee, high, start, end" in said
    mesh = load(tmp_path / "folded.toml").model.shell.mesh
    assert [len(mesh.elements_of(name)) for name in ("post", "arm")] == [8, 4]


def test_a_rib_that_nobody_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Told, and not refused."""
    rib = changed(PROFILE, ('high = ["20 mm"', 'far = ["30 mm", 0]\nhigh = ["20 mm"'))
    rib = changed(rib, ("arm = {", 'flange = { between = ["knee", "far"] }\narm = {'))
    assert "joints of three or more 1 line, 5 nodes: knee, from" in check(rib, tmp_path, capsys)
    blocks = "\n".join(
        f'[mesh.blocks.{name}]\ncorners = [[0, 0, 0], [0, "9 mm", 0], {there}]'
        for name, there in (
            ("low", '["20 mm", "9 mm", 0], ["20 mm", 0, 0]'),
            ("far", '["-9 mm", "9 mm", 0], ["-9 mm", 0, 0]'),
            ("fin", '[0, "9 mm", "9 mm"], [0, 0, "9 mm"]'),
        )
    )
    mesh = f'[mesh]\ngenerator = "blocks"\nelements = [2, 2]\n{blocks}\n\n[mesh.edge_groups.low-edge]\nx1 = "20 mm"\n\n'
    text = changed(
        PROFILE, (PROFILE[PROFILE.index("[mesh]") : PROFILE.index("[shell]")], mesh), ('"low"', '"low-edge"')
    )
    said = check(changed(text, ('tip = ["20 mm", 0, 0]', 'tip = ["-9 mm", 0, 0]')), tmp_path, capsys)
    assert "joints of three or more 1 line, 5 nodes: no group, from (0, 0, 0) to (0, 9 mm, 0)" in said


def test_miura(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    said = check(MIURA, tmp_path, capsys)
    assert "kinks 4 lines, 9 nodes" in said
    mesh = load(tmp_path / "folded.toml").model.shell.mesh
    sides = mesh.points[mesh.elements[0, [1, 3]]] - mesh.points[mesh.elements[0, 0]]
    assert np.linalg.norm(sides, axis=1) == pytest.approx([10e-3, 8e-3])
    angle = np.degrees(np.arccos(sides[0] @ sides[1] / (10e-3 * 8e-3)))
    assert min(angle, 180 - angle) == pytest.approx(60)
