"""README.md does what it says: its Python, its problem file and its commands, as written."""

from __future__ import annotations

import pathlib
import re

import numpy as np
import pytest

import magshell as ms
from magshell import cli

ROOT = pathlib.Path(__file__).parents[2]
README = (ROOT / "README.md").read_text()


def block(language: str, text: str = README) -> str:
    """The first block of code in a language."""
    return re.search(rf"```{language}\n(.*?)```", text, re.DOTALL)[1]


@pytest.fixture(scope="module")
def ten_lines(tmp_path_factory):
    """What the Python block leaves behind: its names, and the folder it ran in."""
    folder, names = tmp_path_factory.mktemp("readme"), {}
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        exec(compile(block("python"), "README.md", "exec"), names)
    return names, folder


def test_the_displacement_is_the_one_in_the_comment(ten_lines):
    names, _ = ten_lines
    said = float(re.search(r"print\(.*\)  # ([0-9.]+) m", README)[1])
    computed = names["path"].probe("equator").u3[-1]
    assert round(computed, 4) == said, computed


def test_the_file_for_paraview_is_written(ten_lines):
    names, folder = ten_lines
    steps = len(re.findall("<DataSet ", (folder / "gripper.pvd").read_text()))
    assert steps == len(names["path"].steps), steps


def test_the_problem_file_is_the_same_model(ten_lines, tmp_path):
    file = tmp_path / "gripper.toml"
    file.write_text(block("toml"))
    written, coded = ms.problem.load(file).model, ten_lines[0]["model"]
    mesh, other = written.shell.mesh, coded.shell.mesh
    assert np.array_equal(mesh.elements, other.elements)
    assert np.abs(mesh.points - other.points).max() < 1e-12
    assert written.shell.thickness == pytest.approx(coded.shell.thickness, rel=1e-12)
    assert list(written.shell.material) == pytest.approx(list(coded.shell.material), rel=1e-12)
    at = mesh.points[mesh.elements]
    assert np.abs(written.shell.remanence(mesh, at) - coded.shell.remanence(other, at)).max() < 1e-12
    assert np.array_equal(written.constraints.fixed, coded.constraints.fixed)
    assert written.field.vector == pytest.approx(coded.field.vector, rel=1e-12)
    assert type(written.coupling) is type(coded.coupling)
    assert dict(written.probe_nodes) == dict(coded.probe_nodes)


def test_the_problem_file_passes_the_check(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    pathlib.Path("gripper.toml").write_text(block("toml"))
    assert cli.main(["check", "gripper.toml"]) == 0, capsys.readouterr()


def test_its_commands_exist():
    named = set(
        re.findall(r"^magshell ([a-z]+)", "".join(re.findall(r"```sh\n(.*?)```", README, re.DOTALL)), re.MULTILINE)
    )
    assert named
    assert named <= set(cli.COMMANDS), named - set(cli.COMMANDS)


def test_the_front_page_has_the_same_ten_lines():
    assert block("python", (ROOT / "docs" / "index.md").read_text()) == block("python")
