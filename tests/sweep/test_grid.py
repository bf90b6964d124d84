"""The cells of a sweep, and what is wrong with any of them before one is solved."""

from __future__ import annotations

from pathlib import Path

import pytest
from problem_files import LOADED, STRIP

from magshell.errors import InputError
from magshell.problem.alternatives import read_settings
from magshell.problem.reading import Source
from magshell.sweep.grid import MOST_CELLS, Cell, grid

SOURCE = Source("strip.toml", STRIP, Path())


def cells(*settings: str, text: str = STRIP) -> list[Cell]:
    return grid(SOURCE._replace(text=text), read_settings(settings))


def test_every_combination_the_last_fastest() -> None:
    found = cells("shell.thickness=0.8,1.2 mm", "shell.element=paper,quadratic", "solver.first_step=0.1")
    assert [cell.name for cell in found] == ["0001", "0002", "0003", "0004"]
    assert [[value.text for value in cell.values] for cell in found] == [
        ["0.8 mm", "paper", "0.1"],
        ["0.8 mm", "quadratic", "0.1"],
        ["1.2 mm", "paper", "0.1"],
        ["1.2 mm", "quadratic", "0.1"],
    ]
    assert found[2].label == "shell.thickness = 1.2 mm, shell.element = paper"
    assert all(cell.probes == ("tip",) for cell in found)
    assert len({cell.source.text for cell in found}) == 4


def test_a_cell_in_which_nothing_acts_is_undeformed() -> None:
    assert [cell.undeformed for cell in cells("field.flux_density=0 mT:2 mT:3")] == [True, False, False]
    assert [cell.undeformed for cell in cells("remanence[0].vector=0,1 mT")] == [True, False]
    assert not cells("field.flux_density=[0,0,0]", text=LOADED)[0].undeformed


def test_what_is_wrong_with_any_cell_is_said_before_the_first_is_solved() -> None:
    with pytest.raises(InputError) as error:
        cells("shell.thickness=-1,0,1 mm", "supports[0].group=left,lift")
    assert str(error.value).splitlines() == [
        "strip.toml: shell.thickness: '-1 mm' is not positive "
        "(cell 1: shell.thickness = -1 mm, supports[0].group = left; and 1 more)",
        "strip.toml: shell.thickness: '0 mm' is not positive "
        "(cell 3: shell.thickness = 0 mm, supports[0].group = left; and 1 more)",
        "strip.toml: supports[0].group: There is no group 'lift' in the mesh. Did you mean 'left'? There is: "
        "bottom, far, left, right, top. (cell 6: shell.thickness = 1 mm, supports[0].group = lift)",
    ]


def test_what_is_wrong_with_every_cell_is_said_once() -> None:
    with pytest.raises(InputError) as error:
        cells("shell.thicknes=0.8,1.2 mm")
    assert str(error.value).startswith("strip.toml: shell.thicknes: is an unknown key. Did you mean 'thickness'?")
    assert str(error.value).endswith("(every cell)")


def test_many_errors_are_cut_short() -> None:
    with pytest.raises(InputError) as error:
        cells("shell.thickness=-1 mm:-2 mm:20")
    assert len(str(error.value).splitlines()) == 11
    assert str(error.value).endswith("strip.toml: and 10 more errors")


def test_too_many_or_no_cells() -> None:
    with pytest.raises(InputError, match=f"asks for 1000000 cells; a sweep has at most {MOST_CELLS}"):
        cells("shell.thickness=1 mm:2 mm:1000", "mesh.length=1 mm:2 mm:1000")
    with pytest.raises(InputError, match="--set: is missing"):
        cells()
