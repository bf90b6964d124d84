"""Slips that `check` and `run` tell: mirror planes that are broken, supports everywhere, places between elements."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from problem_files import BLOCKS, STRIP, changed

import magshell as ms
from magshell.problem import examples, load
from magshell.problem.building import Problem, build
from magshell.problem.reading import check, parse
from magshell.problem.report import describe

SECTOR = Path(__file__).with_name("sector-broken.toml")
BROKEN = SECTOR.read_text(encoding="utf-8")
PLANES = BROKEN[BROKEN.index('[[supports]]\nkind = "symmetry"') : BROKEN.index("[probes]")]
PROBE = BROKEN[BROKEN.index("A = [") :]
OTHER = ("elements = [8, 4]", "elements = [2, {}]"), ('["17 deg", "57 deg"]', '["0 deg", "{} deg"]')


def problem_of(text: str) -> Problem:
    return build(check(parse(text, "test.toml"), "test.toml"), "test.toml")


def ring(degrees: int, planes: str) -> Problem:
    """The part of the ring from 0 to an angle, with 12 elements to a whole turn."""
    (elements, few), (angles, other) = OTHER
    return problem_of(
        changed(
            BROKEN,
            (elements, few.format(degrees // 30)),
            (angles, other.format(degrees)),
            (PLANES, planes),
            (PROBE, 'A = ["15 mm", 0, 0]\n'),
        )
    )


def test_a_field_across_the_planes_of_a_sector() -> None:
    """It was solved without a word; its tip goes down by 5.3 mm, that of the ring by 6.9 mm."""
    found = describe(load(SECTOR)).warnings
    assert len(found) == 2
    for text, name, angle in zip(found, ("start", "stop"), (17, 57), strict=True):
        assert text.startswith(f"symmetry '{name}': the field (5 mT, 0, 0) is {angle}° off the plane")


def test_half_the_ring_in_planes_along_the_field() -> None:
    plane = '[[supports]]\nkind = "symmetry"\ngroup = "{}"\nnormal = [0, 1, 0]\n'
    half, whole = ring(180, plane.format("start") + plane.format("stop")), ring(360, "")
    report = describe(half)
    assert not report.warnings
    assert dict(report.sections["Supports"])["start"].endswith("5 nodes; the other half has the remanence mirrored")
    tips = [ms.solve(one.model).probe("A").u[-1] for one in (half, whole)]
    assert tips[1][2] < -2e-3
    assert np.abs(tips[0] - tips[1]).max() < 1e-8 * np.abs(tips[1]).max()


@pytest.mark.parametrize("name", examples.names())
def test_built_in_problems_break_no_plane(name: str) -> None:
    assert not describe(load(name)).warnings


MIRROR = '[[supports]]\nkind = "symmetry"\ngroup = "right"\nnormal = [1, 0, 0]\n\n[probes]'
CONSTANT = 'kind = "constant"\nvector = ["143 mT", 0, 0]'
RADIAL = 'kind = "radial"\nmagnitude = "143 mT"\naxis = [0, 1, 0]\nthrough = ["{}", 0, "9 mm"]'
PROFILE = """kind = "profile"
along = [1, 0, 0]
positions = [0, "20 mm"]
angle = ["0 deg", "90 deg"]
magnitude = "143 mT"
direction = {}
towards = [0, 0, 1]"""


@pytest.mark.parametrize(
    ("remanence", "field", "words"),
    [
        (CONSTANT, '[0, 0, "2 mT"]', "would be (143 mT, 0, 0), but with this field the other half has it mirrored"),
        (CONSTANT.replace('"143 mT", 0, 0', '0, "143 mT", 0'), '[0, 0, "2 mT"]', None),
        (CONSTANT, '["2 mT", 0, 0]', None),
        (CONSTANT.replace('"143 mT", 0, 0', '0, "143 mT", 0'), '["2 mT", 0, 0]', "mirrored and reversed: (0, -143 mT"),
        (PROFILE.format("[1, 0, 0]"), '[0, 0, "2 mT"]', "the remanence 'profile' would be"),
        (RADIAL.format("20 mm"), '[0, 0, "2 mT"]', None),
        (RADIAL.format("9 mm"), '[0, 0, "2 mT"]', "'radial'"),
        ('kind = "tangential"\nmagnitude = "143 mT"\ndirection = [0, 1, 0]', '[0, 0, "2 mT"]', None),
        ('kind = "tangential"\nmagnitude = "143 mT"\ndirection = [1, 0, 0]', '[0, 0, "2 mT"]', "'tangential'"),
    ],
)  # fmt: skip
def test_remanence_of_the_whole_part(remanence: str, field: str, words: str | None) -> None:
    """What a formula says beyond the plane, against what the field demands there."""
    text = changed(STRIP, (CONSTANT, remanence), ('[0, 0, "2 mT"]', field), ("[probes]", MIRROR))
    found = [doubt for doubt in describe(problem_of(text)).warnings if "symmetry" in doubt]
    assert bool(found) == bool(words), found
    assert words is None or (len(found) == 1 and words in found[0]), found


def test_a_remanence_of_a_group_says_nothing_of_the_other_half() -> None:
    """As of the arms of a cross that all point away from its middle."""
    entry = f"[[remanence]]\n{CONSTANT}"
    groups = "\n\n".join(f'{entry}\ngroup = "{name}"' for name in ("one", "two"))
    plane = MIRROR.replace('"right"', '"far"')
    text = changed(
        BLOCKS,
        (entry, groups),
        ("[probes]", plane),
        ("[mesh.edge_groups]", '[mesh.edge_groups]\nfar = { x1 = "20 mm" }'),
    )
    report = describe(problem_of(text))
    assert not report.warnings
    assert dict(report.sections["Supports"])["far"].endswith("the other half has the remanence mirrored")


def test_elements_between_two_places(tmp_path: Path) -> None:
    """A table at the nodes of a grid, not at the centres of the elements."""
    rows = "".join(f"{5 * i};{y};0;{143 * i};0;0\n" for i in range(5) for y in (0, 5))
    (tmp_path / "scan.csv").write_text(f"X1 [mm];X2;X3;b1;b2;b3\n{rows}")
    table = 'kind = "file"\nfile = "scan.csv"\nflux_density_unit = "μT"\nlength_unit = "mm"'
    text = changed(STRIP, (CONSTANT, table))
    problem = build(check(parse(text, "test.toml"), "test.toml"), "test.toml", folder=tmp_path)
    expected = "remanence: 4 elements (first element 0) with several places of the table as near: the mean is taken"
    assert expected in "\n".join(describe(problem).warnings)
    assert np.abs(problem.model.shell.remanence_at_points[:, 0, 0] / 143e-6 - [0.5, 1.5, 2.5, 3.5]).max() < 1e-12


def test_supports_that_hold_every_node() -> None:
    clamp = 'kind = "clamp"\ngroup = "left"'
    far = 'far = { x1 = "20 mm" }\n'
    text = changed(STRIP, (far, far + "[mesh.node_groups]\nall = { x3 = 0 }\n"), (clamp, clamp.replace("left", "all")))
    assert "the supports hold every node" in "".join(describe(problem_of(text)).warnings)
