"""docs/materials.md does what it says: its Python with the numbers in its comments, its tables, its command."""

from __future__ import annotations

import contextlib
import io
import math
import pathlib
import re
import shlex

import pytest
from problem_files import STRIP

import magshell as ms
from magshell.materials.mixture import STIFFENINGS
from magshell.problem.alternatives import read_settings
from magshell.problem.reading import find
from magshell.sweep.grid import grid

PAGE = (pathlib.Path(__file__).parents[2] / "docs" / "materials.md").read_text()
BLOCKS = {language: re.findall(rf"```{language}\n(.*?)```", PAGE, re.DOTALL) for language in ("python", "toml", "sh")}


@pytest.mark.parametrize("code", BLOCKS["python"])
def test_python(code):
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(code, "materials.md", "exec"), {})
    assert printed.getvalue().splitlines() == re.findall(r"^print\(.*\)  # (.*)$", code, re.MULTILINE)


@pytest.mark.parametrize("table", BLOCKS["toml"])
def test_tables(table, tmp_path):
    """Each in place of that of a strip."""
    name = re.match(r"\[+(\w+)\]+\n", table)[0]
    before, rest = STRIP.split(name)
    (tmp_path / "strip.toml").write_text(before + table + "\n" + rest[rest.index("\n[") + 1 :])
    model = ms.problem.load(tmp_path / "strip.toml").model
    if "remanence" in name:
        assert model.shell.remanence_at_points[0, 0, 0] == pytest.approx(0.143, rel=1e-4)


def test_the_sweep():
    (command,) = BLOCKS["sh"]
    words = shlex.split(command)
    settings = read_settings([words[place + 1] for place, word in enumerate(words) if word == "--set"])
    assert len(grid(find(words[2]), settings)) == 3


def test_the_formulas_differ_as_it_says():
    figures = re.findall(r"at (?:\$f = )?(0\.\d)\$? (?:the three differ )?by (\d+) %", PAGE)
    assert len(figures) == 2
    for fraction, said in figures:
        factors = [factor(float(fraction)) for factor in STIFFENINGS.values()]
        assert round(100 * (max(factors) / min(factors) - 1)) == int(said), factors


def test_the_stretch_at_gents_limit():
    said = float(re.search(r"a stretch of ([\d.]+) in tension", PAGE)[1])
    assert said**2 + 2 / said - 3 == pytest.approx(30, rel=0.02)
    assert math.isclose(said, 5.7)
