"""What `magshell check` tells: the dimensionless figures, and doubts about slips of units."""

from __future__ import annotations

import numpy as np
import pytest
from problem_files import BLOCKS, LOADED, PUMP, STRIP, changed

from magshell import problem
from magshell.problem.building import build
from magshell.problem.reading import check, parse
from magshell.problem.report import Report, describe

MU0 = 4e-7 * np.pi


def report_of(text: str) -> Report:
    return describe(build(check(parse(text, "test.toml"), "test.toml"), "test.toml"))


def entry(report: Report, section: str, label: str) -> str:
    return dict(report.sections[section])[label]


def number(text: str) -> float:
    return float(text.split()[0])


def test_figures_of_the_strip() -> None:
    report = report_of(STRIP)
    mu, lam, load = 303e3, 7300e3, 0.143 * 2e-3
    young = mu * (3 * lam + 2 * mu) / (lam + mu)
    assert number(entry(report, "Shell", "L/h")) == pytest.approx(20.0, rel=1e-3)
    assert "R/h" not in dict(report.sections["Shell"])
    expected = 1e3 * load / (mu * MU0)
    assert number(entry(report, "Field", "10³ |B| |Brem| / (mu mu0)")) == pytest.approx(expected, rel=1e-3)
    expected = 12 * load / (MU0 * young) * 20**2
    assert number(entry(report, "Field", "12 |B| |Brem| / (mu0 E) (L/h)²")) == pytest.approx(expected, rel=1e-3)
    assert entry(report, "Material", "coupling modulus eta") == "30.3 kPa = 0.1 mu"
    assert entry(report, "Material", "length scale l") == "0.1 mm = 0.1 h"
    assert entry(report, "Mesh", "elements, nodes") == "4, 23"
    assert entry(report, "Mesh", "unknowns") == f"{9 * 20 + 10}, and {9 * 23 + 10} before supports"
    assert entry(report, "Supports", "left") == "clamp, 3 nodes"
    assert entry(report, "Probes", "tip").endswith("at (20 mm, 0, 0)")
    assert entry(report, "Field", "stops") == "1 mT, 2 mT"


@pytest.mark.parametrize(("name", "radius"), [("pump", 24 * 6 / (2 * np.pi)), ("gripper", 12 / (np.pi / 6))])
def test_radius_of_curvature(name: str, radius: float) -> None:
    ratio = number(entry(describe(problem.load(name)), "Shell", "R/h"))
    assert ratio == pytest.approx(radius / 0.9, rel=1e-3)


def test_remanence_by_group() -> None:
    old = '[[remanence]]\nkind = "constant"\nvector = ["143 mT", 0, 0]\n'
    report = report_of(changed(BLOCKS, (old, old + 'group = "two"\n')))
    assert entry(report, "Remanence", "two") == "143 mT, constant, along (1, 0, 0)"
    assert entry(report, "Remanence", "none in") == "2 of 4 elements"


def test_prescribed_values_have_their_unit() -> None:
    text = '[[supports]]\nkind = "prescribe"\ngroup = "far"\nfield = "{}"\n{}value = {}\n'
    for field, component, value, shown in (
        ("u", "component = 3\n", '"1 mm"', "prescribe u3 = 1 mm, 3 nodes"),
        ("u", "", '["1 mm", 0, 0]', "prescribe u = (1 mm, 0, 0), 3 nodes"),
        ("omega", "component = 2\n", '"30 deg"', "prescribe omega2 = 30 deg, 3 nodes"),
        ("phi", "", '"2 1/m"', "prescribe phi = 2 1/m, 3 nodes"),
    ):
        report = report_of(STRIP + text.format(field, component, value))
        assert entry(report, "Supports", "far") == shown


def test_loads() -> None:
    report = report_of(LOADED)
    force, moment, length, thickness = 2e-3, 1e-5, 20e-3, 1e-3
    young = 303e3 * (3 * 7300e3 + 2 * 303e3) / (7300e3 + 303e3)
    assert report.sections["Loads"][:2] == [
        ("far", "force (0, 0, 2 mN), 3 nodes"),
        ("right", "moment (0, 0.01 N mm, 0), 3 nodes"),
    ]
    expected = 12 * (force * length + moment) / (young * thickness**3)
    assert number(entry(report, "Loads", "12 (F L + M) / (E h³)")) == pytest.approx(expected, rel=1e-3)
    assert report.sections["Field"] == [("flux density B", "none")]
    assert "Loads" not in report_of(STRIP).sections


DOUBTS = [
    (STRIP, '"1 mm"\n\n[mat', '"5 mm"\n\n[mat', "too thick for a shell"),
    (STRIP, '"1 mm"\n\n[mat', '"1 um"\n\n[mat', "thinner than any film"),
    (STRIP, '"2 mT"]\nst', '"6 T"]\nst', "the field is 6 T"),
    (STRIP, '"143 mT"', '"143 T"', "more than any magnet keeps"),
    (STRIP, '"303 kPa"', '"303 Pa"', "softer than a gel"),
    (STRIP, '"303 kPa"', '"303 GPa"', "stiffer than magnesium"),
    (STRIP, '"7300 kPa"', '"7300 MPa"', "nearly incompressible"),
    (STRIP, '["143 mT", 0, 0]', '[0, 0, "143 mT"]', "parallel to the remanence"),
    (STRIP, '"143 mT"', '"14 uT"', "hardly move"),
    (STRIP, 'tip = ["20 mm", 0, 0]', "", "no probes"),
    (LOADED, '"2 mN"', '"2 kN"', "loads beyond any experiment"),
    (LOADED, '"0.01 N mm"', '"10 N m"', "12 (F L + M) / (E h³)"),
    (BLOCKS, '["20 mm", "5 mm"]', '["60 mm", "5 mm"]', "badly shaped"),
]


def test_nothing_to_doubt() -> None:
    for text in (STRIP, BLOCKS, PUMP, LOADED):
        assert report_of(text).warnings == []


@pytest.mark.parametrize(("base", "old", "new", "words"), DOUBTS, ids=[words for *_, words in DOUBTS])
def test_doubts(base: str, old: str, new: str, words: str) -> None:
    warnings = report_of(changed(base, (old, new))).warnings
    assert any(words in warning for warning in warnings), warnings
