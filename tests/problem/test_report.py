"""What `magshell check` tells: the dimensionless figures, and doubts about slips of units."""

# ruff: noqa: E501 (a table reads best with one entry a line)

from __future__ import annotations

import html

import numpy as np
import pytest
from problem_files import BLOCKS, LOADED, PUMP, STRIP, changed

from magshell import problem
from magshell.mesh import rectangle, split
from magshell.model.doubts import triangles
from magshell.problem.building import build
from magshell.problem.copies import digest
from magshell.problem.reading import check, parse
from magshell.problem.report import Report, describe
from problem.loaded import EVERY_LOAD

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


def test_every_kind_of_load() -> None:
    report = report_of(EVERY_LOAD)
    side, thickness, extent, gravity = 10e-3 * 5e-3, 1e-3, 20e-3, 9.81
    young = 303e3 * (3 * 7300e3 + 2 * 303e3) / (7300e3 + 303e3)
    weight = 1200.0 * side * thickness * gravity
    lines = report.sections["Loads"]
    assert lines[:5] == [
        ("far", "force (0, 0, 2 mN), 3 nodes, turns with the micro-rotation, times 0, 1 at the ends of the stages"),
        ("left", "moment (0, 0.01 N mm, 0), 3 nodes, turns with the micro-rotation, times 0.5, 1 at the ends of the stages"),
        ("two", "traction (0, 0, 5 Pa), 2 elements, in all (0, 0, 0.25 mN), times 0, -1 at the ends of the stages"),
        ("one", "pressure -8 Pa, against the normal of 2 elements, at first 0.4 mN on their area, times 0, 1 at the ends of the stages"),
        ("two", f"gravity (0, 0, -9.81 m/s^2), weight (0, 0, {-1e3 * weight:.4g} mN), times 1, 1 at the ends of the stages"),
    ]  # fmt: skip
    stiff = young * thickness**3 / (12 * extent)
    assert number(entry(report, "Loads", "12 (F L + M) / (E h³)")) == pytest.approx(
        (2e-3 + 1e-5 / extent + 5 * side) / stiff, rel=1e-3
    )
    assert number(entry(report, "Loads", "12 W L / (E h³)")) == pytest.approx(weight / stiff, rel=1e-3)
    assert number(entry(report, "Loads", "p L / (E h)")) == pytest.approx(8 * extent / (young * thickness), rel=1e-3)
    assert entry(report, "Shell", "density rho") == "1200 kg/m^3"
    assert entry(report, "Shell", "mass") == "0.12 g, centroid at (10 mm, 2.5 mm, 0)"
    assert report.sections["Shell"] != report_of(STRIP).sections["Shell"]


def test_name_and_point_of_a_reaction() -> None:
    clamp = 'kind = "clamp"\ngroup = "left"'
    plain = entry(report_of(STRIP), "Supports", "left")
    named = report_of(changed(STRIP, (clamp, f'{clamp}\nname = "foot"')))
    assert entry(named, "Supports", "left") == f"{plain}, reaction 'foot'"
    about = report_of(changed(STRIP, (clamp, f'{clamp}\npoint = [0, "2 mm", 0]')))
    assert entry(about, "Supports", "left") == f"{plain}, reaction about (0, 2 mm, 0)"


def test_a_history_counts_by_its_largest_multiplier() -> None:
    once, thrice = (report_of(changed(EVERY_LOAD, ("[0, -1]", history))) for history in ("[0, 0]", "[-3, 1]"))
    label = "12 (F L + M) / (E h³)"
    found = number(entry(thrice, "Loads", label)) - number(entry(once, "Loads", label))
    young = 303e3 * (3 * 7300e3 + 2 * 303e3) / (7300e3 + 303e3)
    expected = 12 * 3 * 5 * 10e-3 * 5e-3 * 20e-3 / (young * 1e-9)
    assert found == pytest.approx(expected, rel=2e-3)


METRES, MICROMETRES = STRIP.replace(" mm", " m"), STRIP.replace(" mm", " um").replace("20 um", "8 um")
DOUBTS = [
    (STRIP, '"1 mm"\n\n[mat', '"5 mm"\n\n[mat', "too thick for a shell"),
    (STRIP, '"1 mm"\n\n[mat', '"1 um"\n\n[mat', "thinner than any film"),
    (STRIP, '"2 mT"]\nst', '"6 T"]\nst', "the field is 6 T"),
    (STRIP, '"143 mT"', '"143 T"', "more than any magnet keeps"),
    (STRIP, '"303 kPa"', '"303 Pa"', "softer than a gel"),
    (STRIP, '"303 kPa"', '"303 GPa"', "stiffer than magnesium"),
    (STRIP, '"7300 kPa"', '"7300 MPa"', "nearly incompressible"),
    (STRIP, '["143 mT", 0, 0]', '[0, 0, "143 mT"]', "parallel to the remanence"),
    (
        STRIP,
        '["143 mT", 0, 0]',
        '[0, 0, "143 mT"]',
        "so it stays as it is. Where it should buckle, try magshell buckling",
    ),
    (STRIP, '"143 mT"', '"14 uT"', "hardly move"),
    (
        STRIP,
        '"303 kPa"',
        '"303 MPa"',
        "turns the end of a strip of this length by 0.051 deg, so the shell will hardly move",
    ),
    (METRES, '"2 mT"]\nst', '"3 mT"]\nst', "the shell is 20 m long: larger than what moves in a magnetic field"),
    (MICROMETRES, 'width = "5 um"', 'width = "6 um"', "the shell is 8 um long: smaller than a cell"),
    (STRIP, 'tip = ["20 mm", 0, 0]', "", "no probes"),
    (LOADED, '"2 mN"', '"2 kN"', "loads beyond any experiment"),
    (LOADED, '"0.01 N mm"', '"10 N m"', "12 (F L + M) / (E h³)"),
    (
        LOADED,
        '"2 mN"]\n\n[[loads]]\nkind = "moment"\ngroup = "right"\ntotal = [0, "0.01 N mm", 0]',
        '"0.1 uN"]',
        "the shell will hardly move",
    ),
    (EVERY_LOAD, '"-9.81 m/s^2"', '"-9.81e9 mm/s^2"', "a weight beyond any experiment"),
    (EVERY_LOAD, '"-8 Pa"', '"-8 GPa"', "a pressure beyond any experiment"),
    (EVERY_LOAD, '"1.2 g/cm^3"', '"1.1 kg/m^3"', "lighter than a foam"),
    (EVERY_LOAD, '"1.2 g/cm^3"', '"1100 g/cm^3"', "heavier than any metal"),
    (STRIP, '"1 mm"\n\n[mat', '"1 mm"\ndensity = "1100 kg/m^3"\n\n[mat', "density but no gravity"),
    (BLOCKS, '["20 mm", "5 mm"]', '["60 mm", "5 mm"]', "badly shaped"),
]


def test_nothing_to_doubt() -> None:
    for text in (STRIP, BLOCKS, PUMP, LOADED, EVERY_LOAD):
        assert report_of(text).warnings == []


@pytest.mark.parametrize(("base", "old", "new", "words"), DOUBTS, ids=[words for *_, words in DOUBTS])
def test_doubts(base: str, old: str, new: str, words: str) -> None:
    warnings = report_of(changed(base, (old, new))).warnings
    assert any(words in warning for warning in warnings), warnings


def test_a_model_has_the_doubts_of_its_file() -> None:
    """In Python, and in a notebook."""
    text = changed(STRIP, ('"303 kPa"', '"303 Pa"'), ('["143 mT", 0, 0]', '[0, 0, "143 mT"]'))
    model = build(check(parse(text, "test.toml"), "test.toml"), "test.toml").model
    assert model.doubts() == report_of(text).warnings
    assert len(model.doubts()) > 1
    assert all(html.escape(doubt) in model._repr_html_() for doubt in model.doubts())


@pytest.mark.parametrize(("divisions", "ratio"), [((10, 2), 4.4), ((20, 4), 2.2), ((40, 8), None)])
def test_triangles_that_are_long_for_a_thin_shell(divisions: tuple[int, int], ratio: float | None) -> None:
    """Bent by a radian a strip of L/h = 1000 loses 8 to 11 % on the first mesh, 1 to 2 % on the second (the element page)."""
    plain = rectangle(1.0, 0.2, divisions)
    assert not list(triangles.doubts(plain, 1e-3, np.inf))
    for pattern in ("rising", "alternating"):
        told = list(triangles.doubts(split(plain, pattern), 1e-3, np.inf))
        assert len(told) == (ratio is not None)
        if ratio is not None:
            assert f"{ratio} times √(radius × thickness): where the shell bends to a radius of its size" in told[0]
    assert "where the shell is curved" in next(triangles.doubts(split(plain, "crossed"), 1e-3, 0.01))


def test_results_are_described_and_leave_the_path_alone() -> None:
    """Axes and outputs on request: said by check, and no part of what a results folder's steps depend on."""
    table = '[results]\nlocal_axis = [0, 1, 0]\noutputs = ["stress", "von_mises_top"]\n[probes]'
    texts = (STRIP, changed(STRIP, ("[probes]", table)))
    plain, asked = (build(check(parse(text, "a.toml"), "a.toml"), "a.toml", text) for text in texts)
    assert "Results" not in describe(plain).sections
    said = dict(describe(asked).sections["Results"])
    assert said["local axis"] == "(0, 1, 0), projected on the surface"
    assert said["outputs beside the usual"] == "von_mises_top, stress_top, stress_middle, stress_bottom"
    assert asked.model.outputs == ("stress", "von_mises_top")
    assert asked.model.local_axis.tolist() == [0.0, 1.0, 0.0]
    assert digest(asked) == digest(plain)
