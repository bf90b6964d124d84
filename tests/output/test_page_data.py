"""The page as text: numbers, names, no network; and outputs that are registered later."""

from __future__ import annotations

import base64
import html
import json
import re
from types import SimpleNamespace

import numpy as np
import pytest
from conftest import LENGTH, RADIUS, FakePath

from magshell.errors import InputError
from magshell.evaluation import outputs
from magshell.evaluation.converged import converged
from magshell.evaluation.outputs import OUTPUTS, Output, find
from magshell.materials import MicropolarMooneyRivlin, MicropolarNeoHookean, MicropolarStVenantKirchhoff
from magshell.output.animation import draw_steps
from magshell.output.curve import curve_figure
from magshell.output.history import HistoryWriter
from magshell.output.page import page, shown_steps, steps, write_page
from magshell.output.page.arrays import LARGEST, MISSING, quantised, span
from magshell.output.page.facts import facts
from magshell.output.series import MOST_CURVES
from magshell.output.shape import shown_values
from magshell.output.tessellation import Tessellation
from magshell.output.vtu import grid


def header(text: str) -> dict:
    return json.loads(re.search(r'id="header">(.*?)</script>', text, re.S)[1])


def array(text: str, name: str, kind: str) -> np.ndarray:
    return np.frombuffer(base64.b64decode(re.search(rf'id="array-{name}">(.*?)<', text)[1]), kind)


@pytest.fixture
def written(path):
    return page(path, "Tube")


@pytest.mark.parametrize("scale", [1e-12, 1.0, 1e9])
def test_numbers_lose_half_a_step_of_sixteen_bits(scale):
    values = scale * np.random.default_rng(1).normal(size=1000)
    codes, (low, high) = quantised(values)
    error = np.abs(low + (high - low) / LARGEST * codes - values).max()
    assert error <= 0.500001 * (high - low) / LARGEST, error


def test_values_that_are_not_finite_are_missing():
    values = np.array([1.0, np.nan, np.inf, 3.0, -np.inf])
    codes, ends = quantised(values)
    assert codes.tolist() == [0, MISSING, MISSING, LARGEST, MISSING]
    assert ends == (1.0, 3.0)
    assert span(np.array([np.nan])) == (0.0, 0.0)
    assert quantised(np.full(3, 7.0))[0].tolist() == [0, 0, 0]


def test_every_output_has_its_registered_texts(written):
    about = {output["name"]: output for output in header(written)["outputs"]}
    usual = {name for name, output in OUTPUTS.items() if output.usual}
    assert set(about) == usual | {"stress_top", "stress_middle", "stress_bottom", "membrane_force"}
    for name in about:
        output = OUTPUTS[name]
        assert about[name]["sentence"] == output.sentence
        assert about[name]["where"] == ("cell" if output.where == "cell" else "point")
        assert len(about[name]["letters"]) == len(about[name]["ranges"])
        codes = array(written, name, "<u2")
        assert len(codes) == about[name]["steps"] * about[name]["rows"] * output.components, name


def test_what_never_changes_is_stored_once(written, path):
    about = {output["name"]: output for output in header(written)["outputs"]}
    assert about["normal"]["steps"] == about["element_group"]["steps"] == 1
    assert about["displacement"]["steps"] == len(path.steps)


def test_nothing_of_the_page_is_elsewhere(written):
    for needle in ("http:", "https:", "//cdn", "@import", "url(", "src=", "import("):
        found = [match.start() for match in re.finditer(re.escape(needle), written)]
        allowed = {"http:": 'const SVG = "http://www.w3.org/2000/svg"'}.get(needle)
        places = [written[at - 13 : at + 30] for at in found]
        assert all(allowed and allowed[:30] in place for place in places), (needle, places)
    assert "default-src 'none'" in written


@pytest.mark.parametrize("name", ["</script><script>x", "<!--<script>", "a\"b'c&d", "${title}$$", "größer 磁石 \u2028"])
def test_names_are_escaped(name):
    text = page(FakePath(probes={name: (0.0, 0.0, 10e-3)}), name, about=[(name, name)])
    plain = page(FakePath(probes={"tip": (0.0, 0.0, 10e-3)}), "Tube", about=[("a", "b")])
    assert text.count("<script") == plain.count("<script")
    assert text.count("</script") == plain.count("</script")
    assert "<!--" not in text
    assert {line["label"] for line in header(text)["curves"][0]["lines"]} <= {name}
    assert f"<h1>{html.escape(name)}</h1>" in text


def test_no_number_of_the_page_is_not_finite(path, monkeypatch):
    broken = np.linspace(0, 1, len(path.discretisation.mesh.elements))
    broken[::3] = np.nan
    monkeypatch.setitem(
        outputs.OUTPUTS, "energy", Output("energy", "W", "J", "Broken.", "cell", 1, lambda reached: broken)
    )
    text = page(path)
    assert not re.search(r"\b(NaN|Infinity)\b", json.dumps(header(text)))
    assert (array(text, "energy", "<u2")[: len(broken)] == MISSING).sum() == len(broken[::3])


def test_round_off_has_no_colours(path):
    """A component that symmetry makes zero, and a shape that has gone back: noise of any pattern."""
    noise = 1e-16 * np.random.default_rng(3).normal(size=path.steps[-1].state.u.shape)
    for step in path.steps:
        step.state.u[:, 1] = noise[:, 1]
    path.steps[-1].state.u[:] = noise
    (values,) = shown_values(path, path.steps[-1:], *find("u3"), Tessellation(path.discretisation.mesh.elements))
    assert abs(values).max() == 0
    about = next(output for output in header(page(path))["outputs"] if output["name"] == "displacement")
    assert about["ranges"][1] == len(path.steps) * [[0, 0]]
    assert about["ranges"][2][-1] == [0, 0]
    assert about["ranges"][2][-2][1] > 0


def test_interrupted_path_says_where_it_ends():
    path = FakePath()
    path.converged, path.reason = False, "interrupted"
    assert "ends at step 4: interrupted" in page(path)


def long_path(monkeypatch, most: int):
    """Forty steps in two stages, with a critical point, when a page may have so many."""
    path = FakePath(np.linspace(0, 1, 41))
    for step in path.steps[18:]:
        step.stage = 1
    path.critical_points = [SimpleNamespace(arc_length=0.5 * (path.steps[28].arc_length + path.steps[29].arc_length))]
    monkeypatch.setattr(steps, "MOST_BYTES", (most + 0.5) * steps._bytes_of_step(path))
    return path


@pytest.mark.parametrize("most", [40, 25, 12, 7])
def test_too_long_path_keeps_what_must_not_be_missed(monkeypatch, most):
    numbers = [step.number for step in shown_steps(long_path(monkeypatch, most))]
    assert len(numbers) == most
    assert {0, 17, 28, 29, 40} <= set(numbers)
    assert max(np.diff(numbers)) <= 2 * 41 / (most - 4), numbers


def test_limit_holds_also_where_every_step_tells(monkeypatch):
    path = long_path(monkeypatch, 9)
    for step in path.steps:
        step.stage = step.number
    numbers = [step.number for step in shown_steps(path)]
    assert (len(numbers), numbers[0], numbers[-1]) == (9, 0, 40)
    monkeypatch.setattr(steps, "MOST_BYTES", 1)
    assert [step.number for step in shown_steps(path)] == [0, 40]


def test_page_of_a_long_path_is_small_says_so_and_has_whole_curves(monkeypatch):
    path = long_path(monkeypatch, 10)
    path.critical_points = []
    text = page(path)
    assert dict(facts(path, shown_steps(path)))["steps"] in text
    numbers = sum(len(content) for content in re.findall(r'id="array-(?:displacement|rotation|energy)">(.*?)<', text))
    assert numbers <= steps.MOST_BYTES
    about = {output["name"]: output for output in header(text)["outputs"]}
    assert about["displacement"]["steps"] == len(header(text)["steps"]) == 10
    assert len(header(text)["over"][0]["x"]) == len(path.steps) == 41


def test_short_path_is_shown_whole(path):
    assert shown_steps(path) == path.steps
    assert "steps" not in dict(facts(path, path.steps))


def test_table_of_the_page_is_the_file(path, tmp_path):
    writer = HistoryWriter(tmp_path)
    writer.resumed(path)
    assert array(page(path), "history", "u1").tobytes() == (tmp_path / "history.csv").read_bytes()


def test_page_has_the_curves_of_the_picture_without_round_off():
    """What is all round-off is zero in both, whatever its pattern."""
    path = FakePath(probes={"still": (LENGTH, 0, RADIUS)})
    rng = np.random.default_rng(5)
    for step in path.steps:
        step.state.u[:] = 1e-15 * LENGTH * rng.normal(size=step.state.u.shape)
    lines = header(page(path))["curves"][0]["lines"]
    in_picture = [line for line in curve_figure(path).axes[0].lines if "still" in line.get_label()]
    assert len(lines) == len(in_picture) > 0
    for line, drawn in zip(lines, in_picture, strict=True):
        assert line["y"] == [0.0] * len(path.steps) == drawn.get_ydata().tolist()


def test_curves_of_the_page_go_over_what_those_of_the_picture_go_over(path):
    path.steps[2].kind = "limit point"
    path.critical_points = [path.steps[2]]
    about = header(page(path))
    assert [(one["name"], one["label"]) for one in about["over"]] == [
        ("field", "|B| (mT)"),
        ("load_factor", "load factor"),
    ]
    for one in about["over"]:
        axes = curve_figure(path, over=one["name"]).axes[0]
        assert one["x"] == axes.lines[0].get_xdata().tolist()
        assert one["critical"] == [one["x"][2]]
        assert bool(one["above"]) == bool(axes.child_axes)


def test_page_of_many_probes_draws_some_of_their_curves():
    mesh = FakePath().discretisation.mesh
    probes = {f"probe-{i}": tuple(mesh.points[i]) for i in range(len(mesh.points))}
    path = FakePath(probes=probes)
    about = header(page(path))
    drawn = {line["label"] for line in about["curves"][0]["lines"]}
    assert about["curves"][0]["note"] == f"{len(drawn)} of {len(probes)} probes are drawn; history.csv has all."
    assert len(about["curves"][0]["lines"]) <= MOST_CURVES
    assert {one["name"]: one["node"] for one in about["probes"]} == path.model.probe_nodes
    for one in about["probes"]:
        colours = {line["colour"] for line in about["curves"][0]["lines"] if line["label"] == one["name"]}
        assert colours == ({one["colour"]} if one["colour"] else set())


def test_path_without_steps_is_bad_input():
    path = FakePath()
    path.steps = []
    with pytest.raises(InputError, match="no converged step"):
        page(path)


def test_wrong_colour_is_bad_input(path, tmp_path):
    with pytest.raises(InputError, match="Did you mean"):
        write_page(path, tmp_path / "view.html", color="enrgy")
    assert not list(tmp_path.iterdir())


def test_new_output_appears_everywhere(path, tmp_path, monkeypatch, can_draw):
    """One entry in the registry is all: files, menu of the page, colours of pictures."""
    over = lambda reached: reached.mesh.points[:, 2] + reached.state.u[:, 2]  # noqa: E731
    height = Output("height", "H", "m", "Height over the ground.", "point", 1, over)
    monkeypatch.setitem(outputs.OUTPUTS, height.name, height)
    file = grid(path.discretisation, path.steps[-1])
    values = height.evaluate(converged(path.discretisation, path.steps[-1]))
    np.testing.assert_array_equal(file.point_data["height"], values)
    text = page(path, color="H")
    assert header(text)["colour"] == "height 0"
    about = header(text)["outputs"][-1]
    assert (about["name"], about["letters"], about["unit"], about["sentence"]) == (
        "height",
        ["H"],
        "mm",
        height.sentence,
    )
    (picture,) = draw_steps(path, path.steps[-1:], tmp_path, "H")
    (other,) = draw_steps(path, path.steps[-1:], tmp_path / "u3", "u3")
    assert picture.read_bytes() != other.read_bytes()


@pytest.mark.parametrize(
    ("law", "words"),
    [
        (MicropolarNeoHookean, "micropolar neo-Hookean"),
        (MicropolarMooneyRivlin, "micropolar Mooney–Rivlin"),
        (MicropolarStVenantKirchhoff, "micropolar St. Venant–Kirchhoff"),
    ],
)
def test_problem_is_described_in_words(law, words):
    material = law(135e3, 3.25e6, 13.5e3, 9e-5)
    path = FakePath(material=material)
    said = dict(facts(path, path.steps))
    assert said["material"] == f"{words}, shear modulus 135 kPa"
    assert (said["thickness"], said["remanence"]) == ("0.9 mm", "up to 80 mT")
    without = FakePath(material=material, remanent=0.0)
    assert dict(facts(without, without.steps))["remanence"] == "none"
