"""Problem files with rigid bodies, hinges and turned groups, and what `magshell check` says of them."""

# ruff: noqa: E501 (a table reads best with one entry a line)

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from problem_files import JOINTED, MIURA, changed

from magshell.cli import main
from magshell.problem import load


def check(text: str, folder: Path, capsys: pytest.CaptureFixture[str]) -> str:
    """What the command says of a problem that is sound."""
    (folder / "jointed.toml").write_text(text)
    assert main(["check", str(folder / "jointed.toml")]) == 0
    return " ".join(capsys.readouterr().out.split())


def test_a_rigid_magnet_behind_a_hinge(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    said = check(JOINTED, tmp_path, capsys)
    assert "hinge fold, 1 edge, 5 mm, with a spring of 20 mN/rad" in said
    assert "joint nodes 3, where one rotation carries the directors of all sheets" in said
    assert (
        "Rigid bodies magnet group 'right', 3 nodes about (20 mm, 2.5 mm, 0), mass 1 g, magnetic moment "
        "(0.5 mA m^2, 0, 0) left 3 nodes about (0, 2.5 mm, 0), turned by a support"
    ) in said
    assert "left turned by 10 deg about (0, 1, 0), 3 nodes" in said
    assert "magnet 1 N/m in all, 3 nodes" in said
    assert "weight (0, 0, -9.81 mN)" in said
    model = load(tmp_path / "jointed.toml").model
    magnet, turned = model.shell.rigid
    assert (magnet.name, magnet.group, magnet.mass, turned.name) == ("magnet", "right", 1e-3, "left")
    assert np.allclose(magnet.moment, [0.5e-3, 0.0, 0.0])
    assert [(hinge.group, hinge.stiffness) for hinge in model.shell.hinges] == [("fold", 20e-3)]


def test_unknowns(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Eight more than the rows of a plain strip of four elements have would be wrong: those of the equations."""
    said = check(JOINTED, tmp_path, capsys)
    model = load(tmp_path / "jointed.toml").model
    free = int((model.rows.carried & ~model.constraints.fixed).sum())
    assert f"unknowns {free}, and {int(model.rows.carried.sum())} before supports" in said


def test_a_field_on_a_magnet_alone(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A remanence is not needed where a rigid body has a moment."""
    bare = changed(JOINTED, ('[[remanence]]\nkind = "constant"\nvector = ["143 mT", 0, 0]\n', ""))
    assert "does nothing" not in check(bare, tmp_path, capsys)


def test_creases_that_are_hinges(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """They are told as hinges, and no more as kinks."""
    hinges = "".join(f'[[hinges]]\ngroup = "{name}"\nstiffness = "1 mN/rad"\n\n' for name in ("mountain", "valley"))
    said = check(changed(MIURA, ("[shell]", hinges + "[shell]")), tmp_path, capsys)
    assert "kinks" not in said
    assert "hinge mountain, 3 edges, 28 mm, with a spring of 1 mN/rad" in said
    assert "hinge valley, 1 edge, 8 mm" in said


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('group = "fold"', 'group = "flod"', "hinges[0].group: hinge on 'flod': there is no such group of edges. Did you mean 'fold'?"),
        ('group = "fold"', 'group = "two"', "hinges[0].group: hinge on 'two': it is no group of edges"),
        ('"20 mN/rad"', '"20 mN"', "hinges[0].stiffness: '20 mN' is a force where a torsional stiffness per length is expected"),
        ('"20 mN/rad"', '"-20 mN/rad"', "hinges[0].stiffness: '-20 mN/rad' is not positive"),
        ('group = "right"', 'group = "rihgt"', "rigid[0].group: There is no group 'rihgt'"),
        ('["0.5 mA m^2", 0, 0]', '["0.5 mT", 0, 0]', "rigid[0].moment[0]: '0.5 mT'"),
        ('["0.5 mA m^2", 0, 0]', "[0, 0, 0]", "rigid[0].moment: is the zero vector"),
        ('mass = "1 g"', 'mass = "1 mm"', "rigid[0].mass: '1 mm'"),
        ('mass = "1 g"', 'weight = "1 g"', "rigid[0].weight: is an unknown key"),
        ("axis = [0, 1, 0]\nangle", "axis = [0, 0, 0]\nangle", "supports[0].axis: is the zero vector"),
        ('angle = "10 deg"', 'angle = "10 mm"', "supports[0].angle: '10 mm'"),
        ('kind = "translation"\ngroup = "magnet"', 'kind = "translation"\ngroup = "magnte"', "springs[0].group: There is no group or rigid body 'magnte'. Did you mean 'magnet'?"),
        ('name = "magnet"', 'name = "left"', "rigid body 'left': a group of the mesh has this name too"),
    ],
)  # fmt: skip
def test_bad_files(tmp_path: Path, capsys: pytest.CaptureFixture[str], old: str, new: str, message: str) -> None:
    file = tmp_path / "jointed.toml"
    text = JOINTED.replace('group = "magnet"', 'group = "left"') if new == 'name = "left"' else JOINTED
    file.write_text(changed(text, (old, new)))
    assert main(["check", str(file)]) == 2
    assert message in capsys.readouterr().err


def test_a_magnitude_of_the_moment(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """It keeps the direction that the file says, as that of a field does."""
    (tmp_path / "jointed.toml").write_text(JOINTED)
    assert main(["check", str(tmp_path / "jointed.toml"), "--set", "rigid[0].moment=2 mA m^2"]) == 0
    assert "magnetic moment (2 mA m^2, 0, 0)" in capsys.readouterr().out
