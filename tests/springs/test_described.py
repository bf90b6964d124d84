"""Springs that make no sense are refused, with the group and what would be right; in problem files and pictures."""

from __future__ import annotations

import pathlib

import numpy as np
import pytest

import magshell as ms
from magshell import cli, problem
from magshell.output.marks import spring_marks

MESH = ms.mesh.rectangle(20.0, 10.0, (2, 1)).select_elements("all", x1=(0.0, 20.0))
SHELL = ms.Shell(MESH, 1.0, ms.MicropolarNeoHookean(1.0, 1.0))


@pytest.mark.parametrize(
    ("spring", "message"),
    [
        (ms.Spring("rihgt", stiffness=1.0), r"springs on 'rihgt': There is no group 'rihgt'.*Did you mean 'right'\?"),
        (ms.Spring("right"), "springs on 'right': no stiffness is given; give one of stiffness, per_length, per_area"),
        (
            ms.Spring("right", stiffness=1.0, per_length=1.0),
            "springs on 'right': stiffness and per_length are given; give one of",
        ),
        (
            ms.Spring("right", per_area=1.0),
            "springs on 'right': per_area needs a group of elements, and 'right' is a group of edges; give stiffness",
        ),
        (
            ms.Spring("all", per_length=1.0),
            "springs on 'all': per_length needs a group of edges, and 'all' is a group of elements; give stiffness",
        ),
        (ms.Spring("right", stiffness=0.0), "springs on 'right': stiffness is 0.0; it must be positive and finite"),
        (ms.Spring("right", stiffness=-1.0), "springs on 'right': stiffness is -1.0; it must be positive and finite"),
        (ms.Spring("right", per_length=np.nan), "springs on 'right': per_length is nan; it must be positive"),
        (ms.Spring("right", stiffness="1 N/m"), "springs on 'right': stiffness is '1 N/m'; it takes one number"),
        (ms.Spring("right", stiffness=1.0, direction=(0, 0, 0)), "springs on 'right': direction is .*; it must not be"),
        (ms.Spring("right", stiffness=1.0, direction=(0, 1)), "springs on 'right': direction is .*needs 3 finite"),
        (ms.Spring("right", stiffness=1.0, point=(0, np.inf, 0)), "springs on 'right': point is .*needs 3 finite"),
        (ms.Spring("left", stiffness=1.0), "springs on 'left': the reaction 'left' is that of another support; give"),
        (ms.Spring("right", stiffness=1.0, name=" "), "springs on 'right': name is ' '; it must be a text"),
    ],
)
def test_refused(spring, message):
    with pytest.raises(ms.InputError, match=message):
        ms.Model(SHELL, [ms.Clamp("left")], loads=[ms.Force("right", (0, 0, 1.0))], springs=[spring])


def test_two_of_one_name():
    springs = [ms.Spring("right", stiffness=1.0, direction=axis) for axis in np.eye(3)[:2]]
    with pytest.raises(ms.InputError, match="springs on 'right': the reaction 'right' is that of another support"):
        ms.Model(SHELL, [ms.Clamp("left")], loads=[ms.Force("right", (0, 0, 1.0))], springs=springs)


FILE = """
[mesh]
generator = "rectangle"
length = "200 mm"
width = "10 mm"
elements = [4, 1]

[mesh.element_groups]
bed = { x1 = [0, "100 mm"] }

[shell]
thickness = "2 mm"

[material]
law = "neo-hookean"
shear_modulus = "1 MPa"
lame_lambda = 0

[[loads]]
kind = "force"
group = "right"
total = [0, 0, "-1 mN"]

[[springs]]
kind = "translation"
group = "bed"
per_area = "0.2 kPa/mm"

[[springs]]
kind = "translation"
group = "left"
stiffness = "3 N/mm"
direction = [1, 0, 0]
name = "handle"
point = ["1 mm", 0, 0]

[probes]
tip = ["200 mm", 0, 0]
"""


def test_in_a_problem_file(tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Without supports, which the springs are."""
    file = tmp_path / "bed.toml"
    file.write_text(FILE)
    bed, handle = problem.load(file).model.springs
    assert (bed.group, bed.stiffness, bed.per_length, bed.per_area) == ("bed", None, None, pytest.approx(2e5))
    assert (handle.stiffness, handle.direction, handle.name, handle.point) == (3e3, (1, 0, 0), "handle", (1e-3, 0, 0))
    assert cli.main(["check", str(file)]) == 0
    said = capsys.readouterr().out
    assert "bed                    0.2 kPa/mm, 13 nodes" in said
    assert "left                   3 N/mm in all along (1, 0, 0), 3 nodes, reaction 'handle' about (1 mm, 0, 0)" in said


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('"0.2 kPa/mm"', '"0.2 kPa"', "springs[0].per_area: '0.2 kPa'"),
        ('group = "bed"', 'group = "bde"', "springs[0].group: There is no group 'bde'"),
        ('"3 N/mm"', '"-3 N/mm"', "springs[1].stiffness: '-3 N/mm' is not positive"),
        ("direction = [1, 0, 0]", "direction = [0, 0, 0]", "springs[1].direction: is the zero vector"),
        ('kind = "translation"', 'kind = "translatoin"', "springs[0].kind"),
        ('per_area = "0.2 kPa/mm"', "", "springs on 'bed': no stiffness is given"),
    ],
)
def test_bad_files(
    tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str], old: str, new: str, message: str
) -> None:
    file = tmp_path / "bed.toml"
    file.write_text(FILE.replace(old, new, 1))
    assert cli.main(["check", str(file)]) == 2
    assert message in capsys.readouterr().err


def test_in_pictures():
    """Coils that end on the nodes, along the springs' direction; down in the picture without one."""
    springs = [ms.Spring("left", stiffness=2e3, direction=(0, 0, 2)), ms.Spring("all", per_area=2e5)]
    axes = np.eye(3)
    model = ms.Model(SHELL, [], loads=[ms.Force("right", (0, 0, 1.0))], springs=springs)
    along, bed = spring_marks(model, 20.0, axes)
    assert (along.name, bed.name) == ("left: springs, 2 N/mm", "all: springs, 0.2 kPa/mm")
    for mark, axis in ((along, 2), (bed, 1)):
        length = np.abs(mark.vectors[:, axis])
        assert np.all(length > 0.0)
        assert np.allclose(np.linalg.norm(mark.vectors, axis=1), length)
        ends = mark.places + 0.56 * mark.vectors
        assert all(np.linalg.norm(MESH.points - end, axis=1).min() < 1e-12 for end in ends)
    assert {tuple(end) for end in (along.places + 0.56 * along.vectors).round(9)} <= {
        tuple(point) for point in MESH.points[MESH.nodes_of("left")].round(9)
    }
