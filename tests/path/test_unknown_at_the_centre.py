"""A field that is not known at the shell's centre, where `history.csv` has it: a dipole in the middle of a ring."""

from __future__ import annotations

import csv
import dataclasses

import numpy as np
import pytest

import magshell as ms
from magshell.magnetics.fields import Dipole, MagnetField, Motion, Source
from magshell.output.abscissa import abscissa
from magshell.output.page.data import collect
from magshell.output.shape import field_title
from magshell.output.step_checks import fault_of_path


@pytest.fixture(scope="module")
def path() -> ms.Path:
    """The dipole rises from the middle in the second stage."""
    shell = ms.Shell(
        ms.mesh.annulus(10e-3, 20e-3, (1, 8)),
        1e-3,
        ms.MicropolarStVenantKirchhoff(1e6, 0.0),
        ms.remanence.constant((0.0, 0.0, 0.05)),
    )
    middle = ms.Model(shell, [ms.Clamp("inner")], ms.UniformField((0.0, 0.0, 1e-3))).course(0).centre
    motion = Motion(history=(1, 1), displacement=((0, 0, 0), (0, 0, 5e-3)))
    field = MagnetField([Source(Dipole((0.0, 0.0, 0.05)), tuple(middle))], motion, name="dipole")
    return ms.solve(ms.Model(shell, [ms.Clamp("inner")], field, stages=[ms.Stage(), ms.Stage()]))


def unknown(path: ms.Path) -> list[bool]:
    """Whether the dipole is in the middle."""
    return [step.stage == 0 for step in path.steps]


def test_the_history_has_empty_cells(path, tmp_path) -> None:
    path.save(f"{tmp_path}/made/")
    with open(tmp_path / "made" / "history.csv", newline="", encoding="utf-8") as lines:
        rows = list(csv.DictReader(lines))
    assert any(unknown(path)), "a path that says nothing"
    assert not all(unknown(path))
    for i in (1, 2, 3):
        assert [row[f"B{i}"] == "" for row in rows] == unknown(path)
    assert path.table()["B3"].isna().tolist() == unknown(path)
    again = ms.results.read(tmp_path / "made", own=True).path
    assert again.history.rows(again.steps) == path.history.rows(path.steps)


def test_what_shows_the_field_says_that_it_is_not_known(path) -> None:
    told = [path.flux_density(step) for step in path.steps]
    assert [bool(np.isnan(B).all()) for B in told] == unknown(path)
    first, last = told[unknown(path).index(True)], told[-1]
    assert field_title(first) == "field not known at the centre"
    assert field_title(last).endswith(" mT")
    assert field_title(np.zeros(3)) == "no field"
    shown = collect(path, path.steps, "u3", lambda share: None).header
    assert [step["field"] is None and step["magnitude"] is None for step in shown["steps"]] == unknown(path)
    assert shown["strongest"] == pytest.approx(max(np.linalg.norm(B) for B in told if np.isfinite(B).all()))
    assert np.isfinite(abscissa(path).of(path.steps)).all()


def test_steps_of_older_folders_still_belong_to_the_problem(path) -> None:
    """Steps hold 0 there, as they did; one with another field does not belong."""
    assert fault_of_path(path) is None
    steps = [path.steps[0], path.steps[1]._replace(flux_density=np.array((0, 0, 1e-3))), *path.steps[2:]]
    number, said = fault_of_path(dataclasses.replace(path, steps=steps))
    assert number == 1
    assert "flux_density" in said
