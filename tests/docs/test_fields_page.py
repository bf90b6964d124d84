"""docs/fields.md does what it says: its Python with the numbers in its comments, its problem file."""

from __future__ import annotations

import contextlib
import io
import pathlib
import re

import numpy as np
import pytest
from problem_files import STRIP, changed

from magshell.magnetics.fields import SelfField
from magshell.magnetics.fields.differences import STEP
from magshell.magnetics.fields.lattice import NEAREST
from magshell.problem.building import build
from magshell.problem.building.field import build_field
from magshell.problem.reading import check, parse
from magshell.problem.source_report import driven

PAGE = (pathlib.Path(__file__).parents[2] / "docs" / "fields.md").read_text()
WITHOUT = changed(STRIP, ('[field]\nflux_density = [0, 0, "2 mT"]\nstops = ["1 mT", "2 mT"]\n', ""))
BLOCKS = {language: re.findall(rf"```{language}\n(.*?)```", PAGE, re.DOTALL) for language in ("python", "toml")}


@pytest.mark.parametrize("code", BLOCKS["python"])
def test_python(code):
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(code, "fields.md", "exec"), {})
    assert printed.getvalue().splitlines() == re.findall(r"^print\(.*\)  # (.*)$", code, re.MULTILINE)


def test_problem_file():
    text, _, own = BLOCKS["toml"]
    file = check(parse(WITHOUT + text, "page.toml"), "page.toml")
    field = build_field(file, pathlib.Path())
    assert field.stages == 3
    B = field.at(field.ends(3)[2], np.zeros((1, 3))).flux_density[0]
    assert B[0] == pytest.approx(0.8**1.5 * 4e-7 * np.pi * 240 / 0.1, rel=1e-6), "the axis of the pair is X1"
    assert B[2] > 0.1
    assert build(file, "page.toml").model.field.drives == field.drives
    file = check(parse(WITHOUT + own, "page.toml"), "page.toml")
    assert build(file, "page.toml").model.field.drives == SelfField.drives


def test_moving_arm():
    _, text, _ = BLOCKS["toml"]
    model = build(check(parse(WITHOUT + text, "page.toml"), "page.toml"), "page.toml").model
    assert [stage.name for stage in model.stages] == ["far", "approach", "retreat"]
    assert driven(model, 0) == "drives magnet.multiplier 0 to 1"
    assert driven(model, 1) == "drives magnet.d3 0 to -65 mm"
    assert driven(model, 2) == "drives magnet.d3 -65 mm to 0"


def test_figures():
    assert f"The step is {STEP:g} of the distance" in PAGE
    assert f"At {NEAREST} spacings" in PAGE
    assert f"Nearer than {NEAREST} spacings is refused" in PAGE
