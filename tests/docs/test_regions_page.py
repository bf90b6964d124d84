"""The recipes of `docs/regions.md`: every problem file is built, every program runs, and both are the same."""

from __future__ import annotations

import pathlib
import re

import pytest

import magshell as ms
from magshell.problem.building import build
from magshell.problem.reading import check, parse
from magshell.problem.report import describe

PAGE = (pathlib.Path(__file__).parents[2] / "docs" / "regions.md").read_text()
SECTIONS = dict(re.findall(r"^## (.+?)\n(.*?)(?=^## |\Z)", PAGE, re.MULTILINE | re.DOTALL))
BOTH = ("Two thicknesses", "Layers")


def block(section: str, language: str) -> str:
    (found,) = re.findall(rf"^```{language}\n(.*?)^```", SECTIONS[section], re.MULTILINE | re.DOTALL)
    return str(found)


@pytest.mark.parametrize("section", BOTH)
def test_file_and_program_are_one_problem(section: str, capsys: pytest.CaptureFixture[str]) -> None:
    problem = build(check(parse(block(section, "toml"), "page.toml"), "page.toml"), "page.toml")
    assert describe(problem).warnings == []
    found = ms.solve(problem.model, problem.settings).probe("tip").u3[-1]
    exec(compile(block(section, "python"), section, "exec"), {})
    assert abs(found) > 1e-4
    assert float(capsys.readouterr().out) == pytest.approx(found, rel=1e-6)


def test_tapers(tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]) -> None:
    exec(compile(block("Tapers", "python"), "tapers", "exec"), {})
    assert float(capsys.readouterr().out) == pytest.approx(0.4e-3, rel=1e-12)
    (tmp_path / "measured.csv").write_text(
        "x1,x2,x3,thickness\n" + "".join(f"{x},2.5,0,0.7\n" for x in range(0, 41, 5))
    )
    start = block("Two thicknesses", "toml")
    for line in block("Tapers", "toml").splitlines():
        (tmp_path / "taper.toml").write_text(start.replace('thickness = "1 mm"', line))
        (rest, _) = ms.problem.load(tmp_path / "taper.toml").model.shell.parts
        expected = (0.7e-3, 0.7e-3) if "file" in line else (0.7e-3, 1e-3)
        assert (rest.at_nodes.min(), rest.at_nodes.max()) == pytest.approx(expected, rel=1e-12)
