"""Every kind of remanence in a problem file: what it becomes, what is said of it, and what is refused."""

# ruff: noqa: E501 (a table reads best with one entry a line)

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest
from problem_files import BLOCKS, changed

from magshell.arrays import FloatArray
from magshell.errors import InputError
from magshell.problem.building import Problem, build
from magshell.problem.reading import check, parse
from magshell.problem.report import describe
from problem.magnetised import FIELDS, REMANENCE, SURFACES, TEMPLATES


def made(text: str, folder: object = None) -> Problem:
    file = check(parse(text, "test.toml"), "test.toml")
    return build(file, "test.toml", text, folder) if folder else build(file, "test.toml")


def at_centres(problem: Problem) -> tuple[FloatArray, FloatArray]:
    """Centres of the elements in mm and the remanence there in mT."""
    mesh = problem.model.shell.mesh
    centres = mesh.points[mesh.elements[:, :4]].mean(axis=1)
    return 1e3 * centres, 1e3 * problem.model.shell.remanence(mesh, centres[:, None])[:, 0]


def test_profile_and_curve() -> None:
    x, b = at_centres(made(FIELDS))
    angles, magnitudes = (np.radians(45), 0.5, np.radians(405)), (50, -20, 50)
    θ, M = (np.interp(x[:2, 0] - 1, (0, 5, 10), table) for table in (angles, magnitudes))
    assert np.abs(b[:2] - np.stack([M * np.cos(θ), 0 * θ, M * np.sin(θ)], axis=1)).max() < 1e-12
    assert np.abs(b[2:] - [80, 0, 0]).max() < 1e-12


def test_radial_and_tangential() -> None:
    x, b = at_centres(made(SURFACES))
    arm = np.array([20, 1, 0]) - x[:2]
    assert np.abs(b[:2] - 100 * arm / np.linalg.norm(arm, axis=1, keepdims=True)).max() < 1e-12
    assert np.abs(b[2:] - 80 * np.sqrt([0.5, 0.5, 0])).max() < 1e-12


def test_templates() -> None:
    x, b = at_centres(made(TEMPLATES))
    θ = x[:2, 0] / 3
    assert np.abs(b[:2] - 60 * np.stack([np.sin(θ), 0 * θ, np.cos(θ)], axis=1)).max() < 1e-12
    assert np.abs(b[2:] - [[60, 0, 0], [0, 0, 60]]).max() < 1e-12, "one panel upright, one level again"


def test_what_the_report_says() -> None:
    said = [describe(made(text)).sections["Remanence"] for text in (FIELDS, SURFACES, TEMPLATES)]
    assert [line for lines in said for line in lines] == [
        ("one", "1 mT to 29 mT, over 0 to 10 mm along (1, 0, 0), turning by 376.4 deg (1.045 turns)"),
        ("two", "80 mT, along the curve front, towards (1, 1, 0)"),
        ("one", "100 mT, radial, towards the axis (0, 0, 2)"),
        ("two", "80 mT, in the surface, along (1, 1, 1)"),
        ("one", "60 mT, magnetised along (0, 0, 1) while rolled to the radius 3 mm towards (0, 0, 1)"),
        ("two", "60 mT, magnetised along (0, 0, 1) while folded along 2 lines by 90 deg, 90 deg"),
    ]


FILE = '[[remanence]]\nkind = "file"\nfile = "b.csv"\nflux_density_unit = "mT"\nlength_unit = "mm"\n'
SHAPE = """[[remanence]]
kind = "deformed"
magnitude = "60 mT"
direction = [1, 0, 0]
displacements = "u.csv"
length_unit = "mm"
"""


def test_files_start_where_the_problem_file_is(tmp_path) -> None:
    plain = made(BLOCKS)
    x, _ = at_centres(plain)
    rows = np.hstack([x, np.arange(12).reshape(4, 3)])
    (tmp_path / "b.csv").write_text("x1,x2,x3,b1,b2,b3\n" + "\n".join(",".join(map(repr, r)) for r in rows.tolist()))
    problem = made(changed(BLOCKS, (REMANENCE, FILE)), tmp_path)
    assert np.abs(at_centres(problem)[1] - np.arange(12).reshape(4, 3)).max() < 1e-12
    assert describe(problem).sections["Remanence"] == [("everywhere", "2.236 mT to 17.38 mT, from b.csv")]
    points = 1e3 * plain.model.shell.mesh.points
    u = points @ np.array([[0, 0, 1], [0, 1, 0], [-1, 0, 0]]).T - points
    rows = np.hstack([points, u])
    (tmp_path / "u.csv").write_text("x1,x2,x3,u1,u2,u3\n" + "\n".join(",".join(map(repr, r)) for r in rows.tolist()))
    problem = made(changed(BLOCKS, (REMANENCE, SHAPE)), tmp_path)
    assert np.abs(at_centres(problem)[1] - [0, 0, 60]).max() < 1e-12
    said = "60 mT, magnetised along (1, 0, 0) while deformed as u.csv says"
    assert describe(problem).sections["Remanence"] == [("everywhere", said)]


def test_names_of_files() -> None:
    for text, names in (
        (FILE, [("remanence[0].file", "b.csv")]),
        (SHAPE, [("remanence[0].displacements", "u.csv")]),
        (REMANENCE, []),
    ):
        file = check(parse(changed(BLOCKS, (REMANENCE, text)), "test.toml"), "test.toml")
        assert file.files() == names


class Broken(NamedTuple):
    """One change to a problem that works, and what must be said of it."""

    base: str
    old: str
    new: str
    message: str


WITH_FILE = changed(BLOCKS, (REMANENCE, FILE))
BROKEN = [
    Broken(FIELDS, '[0, "5 mm", "10 mm"]', '[0, "10 mm", "5 mm"]', "remanence[0]: positions are"),
    Broken(FIELDS, '[0, "5 mm", "10 mm"]', "[]", "remanence[0].positions: is empty"),
    Broken(FIELDS, '["50 mT", "-20 mT", "50 mT"]', '["50 mT", "60 mT"]', "remanence[0]: magnitudes are"),
    Broken(FIELDS, '"-20 mT"', '"-20 mm"', "remanence[0].magnitude[1]: '-20 mm' is a length"),
    Broken(FIELDS, '"0.5 rad"', "0.5", "remanence[0].angle[1]: '0.5' has no unit"),
    Broken(FIELDS, "towards = [0, 0, 1]\n", "", "remanence[0]: towards is missing"),
    Broken(FIELDS, 'curve = "front"', 'curve = "fornt"', "remanence[1]: There is no edge group 'fornt'. Did you mean"),
    Broken(FIELDS, 'curve = "front"', 'curve = "one"', "remanence[1]: 'one' is not a group of edges"),
    Broken(SURFACES, "direction = [1, 1, 1]", "direction = [0, 0, 1]", "remanence[1]: the direction"),
    Broken(SURFACES, '"20 mm", "1 mm", 0]', '"2.5 mm", "2.5 mm", 0]', "remanence[0]: the radial direction is undefined"),
    Broken(TEMPLATES, '"3 mm"', '"-3 mm"', "remanence[0].radius: '-3 mm' is not positive"),
    Broken(TEMPLATES, "through = [0, 0, 0]", 'through = [0, 0, "1 mm"]', "remanence[0]: the fold: element 0 lies 0.001 m"),
    Broken(TEMPLATES, '[1, 0, 0]\ntowards = [0, 0, -1]', '[1, 0, 0]\ntowards = [1, 0, -1]', "remanence[1].folds[1]: towards"),
    Broken(TEMPLATES, 'radius = "1 mm"', 'radius = "5 mm"', "remanence[1]: folds[1] begins before folds[0] has ended"),
    Broken(TEMPLATES, '"90 deg"\nradius', '"-90 deg"\nradius', "remanence[1].folds[0]: angle is"),
    Broken(TEMPLATES, 'towards = [0, 0, -1]\nangle', 'side = 1\ntowards = [0, 0, -1]\nangle', "remanence[1].folds[1].side"),
    Broken(WITH_FILE, '"b.csv"', '"missing.csv"', "missing.csv: there is no such file"),
    Broken(WITH_FILE, '"b.csv"', '""', "remanence[0].file: '' is not a file name"),
    Broken(WITH_FILE, '"b.csv"', "3", "remanence[0].file: '3' is not a file name; write it in quotes"),
    Broken(WITH_FILE, '"mm"\n', '"mT"\n', "remanence[0].length_unit: 'mT' is not a unit of length"),
    Broken(WITH_FILE, '_unit = "mT"', '_unit = "Tesla"', "remanence[0].flux_density_unit: 'Tesla' is not a unit"),
]  # fmt: skip


@pytest.mark.parametrize("broken", BROKEN, ids=[broken.message for broken in BROKEN])
def test_what_is_refused(broken: Broken) -> None:
    with pytest.raises(InputError) as caught:
        made(changed(broken.base, (broken.old, broken.new)))
    (line,) = str(caught.value).splitlines()
    assert line.startswith("test.toml: "), line
    assert broken.message in line, line


def test_places_need_their_unit(tmp_path) -> None:
    (tmp_path / "b.csv").write_text("x1,x2,x3,b1,b2,b3\n0,0,0,1,2,3\n")
    with pytest.raises(InputError, match=r"remanence\[0\]: b.csv: has the columns x1,x2,x3; length_unit must say"):
        made(changed(WITH_FILE, ('length_unit = "mm"\n', "")), tmp_path)
