"""The recipe of the page about reactions: the blocked force, against the beam's answer; the program beside it."""

from __future__ import annotations

import importlib.util
import pathlib
import re

import numpy as np
import pytest

import magshell as ms
from magshell.errors import InputError
from magshell.output.series import chosen, groups

DOCS = pathlib.Path(__file__).parents[2] / "docs"
PAGE = (DOCS / "reactions.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def path() -> ms.Path:
    source = importlib.util.spec_from_file_location("reaction_pictures", DOCS / "reaction_pictures.py")
    module = importlib.util.module_from_spec(source)
    source.loader.exec_module(module)
    problem = module.blocked()
    return ms.solve(problem.model, problem.settings)


def test_blocked_force_is_that_of_a_beam(path: ms.Path) -> None:
    """b h Brem B / mu0, first of all at small fields."""
    rows = np.array(path.history.rows(path.steps), dtype=object)
    column = dict(zip(path.history.columns, rows.T.tolist(), strict=True))
    beam = 5e-3 * 1e-3 * 143e-3 * np.array(column["B3"]) / (4e-7 * np.pi)
    force = -np.array(column["stop.R3"], dtype=float)
    ratio = force[1:] / beam[1:]
    assert ratio[0] == pytest.approx(1.0, abs=0.03), ratio
    assert ratio[-1] == pytest.approx(1.0, abs=0.1), ratio
    assert f"{1e3 * beam[-1]:.1f} mN at 10 mT" in " ".join(PAGE.split())
    assert np.abs(np.array(column["foot.R3"], dtype=float) - force).max() < 1e-9 * force.max()
    assert np.abs(np.array(column["stop.R1"], dtype=float)).max() < 1e-9 * force.max()


def test_its_curves_can_be_chosen(path: ms.Path) -> None:
    group = chosen(path, ["stop.R3"])
    assert (group.title, group.factor) == ("reaction force (mN)", 1e3)
    by_name = {group.name: group for group in groups(path)}
    assert {curve.name for curve in by_name["reaction force"].curves} == {"foot", "stop"}
    assert {curve.letter for curve in by_name["reaction force"].curves} == {"R₃"}
    assert {curve.letter for curve in by_name["energy"].curves} == {"elastic"}
    with pytest.raises(InputError, match=r"There is no curve 'stop\.F3'"):
        chosen(path, ["stop.F3"])


def test_the_program_runs(capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("pandas")
    (program,) = re.findall(r"^```python\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)
    exec(compile(program, "reactions.md", "exec"), {})
    assert "left.M2" in capsys.readouterr().out
