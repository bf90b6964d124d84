"""Regions and layers in problem files: what is built, printed, drawn and changed, and what is wrong with them."""

# ruff: noqa: E501 (a table reads best with one entry a line)

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from problem_files import changed

from magshell import problem
from magshell.cli import main
from magshell.materials import MicropolarMooneyRivlin
from magshell.output.rendering import RenderingUnavailable, require_rendering
from problem.layered import REGIONS

LAW = 'law = "micropolar-mooney-rivlin"'


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "halves.toml"
    path.write_text(REGIONS)
    return path


def test_what_is_built(file: Path) -> None:
    shell = problem.load(file).model.shell
    inner, outer = shell.parts
    assert (inner.name, inner.elements.tolist(), inner.levels) == ("shell", [0, 1], 2)
    assert (outer.name, outer.elements.tolist(), outer.levels, outer.layered) == ("outer", [2, 3], 3, True)
    assert shell.mesh.element_groups["ends"].tolist() == [3]
    assert [layer.density for part in shell.parts for layer in part.layers] == [1100.0, 1000.0, 2000.0]
    assert isinstance(outer.layers[1].material, MicropolarMooneyRivlin)
    np.testing.assert_allclose(inner.offset_at_nodes, -0.5e-3, rtol=1e-15)
    np.testing.assert_allclose(outer.offset_at_nodes, 0.1e-3, rtol=1e-15)
    x = shell.mesh.points[shell.mesh.elements[2:], 0]
    np.testing.assert_allclose(outer.at_nodes[..., 1], 0.9e-3 - 0.03 * x, rtol=1e-12)
    np.testing.assert_array_equal(inner.remanence[..., 0, :], np.broadcast_to([0.143, 0, 0], (2, 4, 3)))
    assert not outer.remanence[:, :, 0].any()
    np.testing.assert_array_equal(outer.remanence[:, :, 1], np.broadcast_to([0, 0, 0.05], (2, 4, 3)))


def test_check_lists_regions_and_layers(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", str(file)]) == 0
    shown = capsys.readouterr()
    said = " ".join(shown.out.split())
    for words in (
        "thickness h 0.7 mm to 1 mm",
        "rest 2 elements, thickness 1 mm, mesh at the bottom face, mass 55 mg",
        "outer 2 elements, thickness 0.7 mm to 1 mm, mesh 0.1 mm above the mid-plane, mass 65 mg",
        "layer 0 (bottom) 0.4 mm of micropolar-neo-hookean, mu 60 kPa, E 120 kPa, nu 0,",
        "density 1000 kg/m^3, no remanence",
        "layer 1 (top) 0.3 mm to 0.6 mm of micropolar-mooney-rivlin, mu 100 kPa",
        "density 2000 kg/m^3, remanence up to 50 mT",
        "elsewhere 143 mT, constant, along (1, 0, 0)",
        "outer layer 1 constant, along (0, 0, 1)",
        "weight (0, 0, -1.177 mN)",
    ):
        assert words in said, f"{words!r} is not in {said}"
    assert "warning" not in shown.err.lower(), shown.err


def test_one_problem_is_solved_and_drawn(file: Path, tmp_path: Path) -> None:
    try:
        require_rendering()
    except RenderingUnavailable as unavailable:
        pytest.skip(str(unavailable))
    assert main(["show", str(file), "--out", str(tmp_path / "halves.png")]) == 0
    out = tmp_path / "out"
    thin = ["--set", "regions[0].layers[0].thickness=0.2 mm", "--set", "regions[0].layers[1].remanence[0].vector=20 mT"]
    assert main(["run", str(file), "--out", str(out), *thin]) == 0
    part = problem.load(out / "problem.toml").model.shell.parts[1]
    assert part.at_points[0, 0, 0] == 0.2e-3
    np.testing.assert_allclose(part.remanence[0, 0, 1], [0, 0, 0.02], rtol=1e-12)
    assert main(["view", str(out)]) == 0
    assert "Mooney–Rivlin" in (out / "view.html").read_text()


def test_a_region_may_have_its_own_remanence_or_none(tmp_path: Path) -> None:
    layers = REGIONS[REGIONS.index("[[regions.layers]]") : REGIONS.index("[field]")]
    for remanence, expected in (
        ("", [0.143, 0, 0]),
        ("remanence = []", [0, 0, 0]),
        ('[[regions.remanence]]\nkind = "constant"\nvector = [0, "1 T", 0]\n', [0, 1, 0]),
    ):
        (tmp_path / "one.toml").write_text(changed(REGIONS, (layers, remanence + "\n")))
        outer = problem.load(tmp_path / "one.toml").model.shell.parts[1]
        np.testing.assert_array_equal(outer.remanence[:, :, 0], np.broadcast_to(expected, (2, 4, 3)))
        assert (outer.at_nodes == 1e-3).all()


def test_layers_of_the_whole_shell_and_thickness_from_a_table(tmp_path: Path) -> None:
    start, end = REGIONS.index("[shell]"), REGIONS.index("[[regions]]")
    without = REGIONS[:start] + REGIONS[end:].replace('[[regions]]\ngroup = "outer"', "[shell]").replace(
        "regions.", "shell."
    )
    table = "thickness\n" + 20 * "0.5\n" + "0.5\n0.5\n0.5\n"
    (tmp_path / "h.csv").write_text(table)
    text = changed(without, ('"0.4 mm"', '{ file = "h.csv", thickness_unit = "mm" }'))
    (tmp_path / "layers.toml").write_text(text)
    found = problem.load(tmp_path / "layers.toml")
    (part,) = found.model.shell.parts
    assert (part.layered, len(part.layers), part.levels) == (True, 2, 3)
    np.testing.assert_allclose(part.at_nodes[..., 0], 0.5e-3, rtol=1e-14)
    assert found.file.files() == [("shell.layers[0].thickness.file", "h.csv")]


class Broken(NamedTuple):
    name: str
    old: str
    new: str
    where: str
    words: tuple[str, ...]


LAYER = '[[regions.layers]]\nthickness = "0.4 mm"'
PROFILE = '{ along = [1, 0, 0], positions = ["10 mm", "20 mm"], values = ["0.6 mm", "0.3 mm"] }'
BROKEN = [
    Broken("unknown group", 'group = "outer"\n', 'group = "outre"\n', "regions[0].group", ("'outre'", "'outer'")),
    Broken("no group", 'group = "outer"\n', "", "regions[0].group", ("missing",)),
    Broken("unknown key", "levels = 3", "level = 3", "regions[0].level", ("unknown key", "'levels'")),
    Broken("no level", "levels = 3", "levels = 0", "regions[0].levels", ("whole number from 1 to 16",)),
    Broken("offset", '"0.1 mm"', '"botom"', "regions[0].offset", ("'botom'", "Did you mean 'bottom'")),
    Broken("offset in kPa", '"0.1 mm"', '"1 kPa"', "regions[0].offset", ("stress", "length")),
    Broken("offset out of sight", '"0.1 mm"', '"1 m"', "regions[0] ('outer')", ("offset is 1 m", "check the units")),
    Broken("layer of zero", '"0.4 mm"', "0", "regions[0].layers[0].thickness", ("not positive",)),
    Broken("layer without thickness", 'thickness = "0.4 mm"\n', "", "regions[0].layers[0].thickness", ("missing",)),
    Broken("layer without material", 'length_scale = "4 um"', 'length_scale = "4 um"\nmaterials = 1', "regions[0].layers[0].materials", ("unknown key", "'material'")),
    Broken("unknown law", LAW, 'law = "micropolar-money-rivlin"', "regions[0].layers[1].material.law", ("'micropolar-money-rivlin'", "'micropolar-mooney-rivlin'")),
    Broken("no law", LAW, "", "regions[0].layers[1].material.law", ("missing", "micropolar-neo-hookean")),
    Broken("modulus in mm", '"100 kPa"\nlame', '"100 mm"\nlame', "regions[0].layers[1].material.shear_modulus", ("length", "stress")),
    Broken("unknown remanence", 'kind = "constant"\nvector = [0, 0, "50 mT"]', 'kind = "konstant"\nvector = [0, 0, "50 mT"]', "regions[0].layers[1].remanence[0].kind", ("'konstant'", "'constant'")),
    Broken("remanence without unit", '[0, 0, "50 mT"]', "[0, 0, 50]", "regions[0].layers[1].remanence[0].vector[2]", ("no unit",)),
    Broken("remanence that is no list", "[[regions.layers.remanence]]", "[regions.layers.remanence]", "regions[0].layers[1].remanence", ("is not a list", "[[regions.layers.remanence]]")),
    Broken("remanence of another group", 'vector = [0, 0, "50 mT"]', 'vector = [0, 0, "50 mT"]\ngroup = "innr"', "regions[0].layers[1].remanence[0].group", ("'innr'", "'inner'")),
    Broken("thickness beside layers", "levels = 3", 'thickness = "1 mm"', "regions[0].thickness", ("beside layers",)),
    Broken("regions that are no list", "[[regions]]", "[regions]", "regions", ("is not a list", "[[regions]]")),
    Broken("overlap", "[field]", '[[regions]]\ngroup = "ends"\n[field]', "regions[1] ('ends')", ("element 3", "'outer'")),
    Broken("elements in none", 'thickness = "1 mm"\n', "", "shell", ("thickness is missing", "element 0 is in none of the regions (outer)")),
    Broken("profile that does not rise", '["10 mm", "20 mm"], v', '["20 mm", "10 mm"], v', "regions[0].layers[1].thickness.positions", ("do not rise",)),
    Broken("profile of two lengths", ', "0.3 mm"] }', "] }", "regions[0].layers[1].thickness.values", ("1 entries", "2 positions")),
    Broken("profile without unit", ', "0.3 mm"] }', ", 0.3] }", "regions[0].layers[1].thickness.values[1]", ("no unit",)),
    Broken("profile without positions", 'positions = ["10 mm", "20 mm"], ', "", "regions[0].layers[1].thickness.positions", ("missing",)),
    Broken("table of nothing", PROFILE, "{ }", "regions[0].layers[1].thickness", ("file", "along")),
    Broken("missing table", PROFILE, '{ file = "no.csv", thickness_unit = "mm" }', "regions[0].layers[1].thickness", ("no.csv", "no such file")),
    Broken("table without unit", PROFILE, '{ file = "no.csv" }', "regions[0].layers[1].thickness.thickness_unit", ("missing",)),
    Broken("elements across a bound", '[0, "10 mm"]', '[0, "9 mm"]', "mesh.element_groups.inner", ("lies across a bound",)),
    Broken("elements nowhere", '[0, "10 mm"]', '["21 mm", "22 mm"]', "mesh.element_groups.inner", ("no element lies there",)),
    Broken("elements of a range that falls", '[0, "10 mm"]', '["10 mm", 0]', "mesh.element_groups.inner", ("a least and a greatest",)),
    Broken("elements of nothing", '{ x1 = [0, "10 mm"] }', "{ }", "mesh.element_groups.inner", ("selects nothing",)),
    Broken("elements of no group", 'groups = ["outer"]', 'groups = ["outr"]', "mesh.element_groups.ends", ("'outr'", "'outer'")),
    Broken("one coordinate", '[0, "10 mm"]', '["10 mm"]', "mesh.element_groups.inner.x1", ("1 entries", "expected 2")),
]  # fmt: skip


@pytest.mark.parametrize("case", BROKEN, ids=[case.name.replace(" ", "-") for case in BROKEN])
def test_says_what_is_wrong_and_where(case: Broken, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "broken.toml").write_text(changed(REGIONS, (case.old, case.new)))
    status = main(["check", str(tmp_path / "broken.toml")])
    error = capsys.readouterr().err
    assert status == 2, error
    assert len(error.splitlines()) == 1, error
    assert error.startswith(f"error: broken.toml: {case.where}: "), error
    for word in case.words:
        assert word in error, f"{word!r} is not in {error!r}"


@pytest.mark.parametrize(("core", "told"), [("60 kPa", False), ("10 Pa", True)])
def test_layers_that_bend_apart_are_told(
    core: str, told: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Faces of 0.4 mm on a core of 0.6 mm that is 6e-5 times as stiff bend about their own middles over some 10 mm."""
    text = changed(REGIONS, ('"100 kPa"\nlame', f'"{core}"\nlame'), ('"1 MPa"', f'"{core}"'))
    face = text[
        text.index("[[regions.layers]]") : text.index("[[regions.layers]]", text.index("[[regions.layers]]") + 1)
    ]
    (tmp_path / "sandwich.toml").write_text(changed(text, ("[field]", face + "[field]")))
    assert main(["check", str(tmp_path / "sandwich.toml")]) == 0
    said = " ".join("".join(capsys.readouterr()).split())
    assert ("layers of 'outer': within" in said) is told, said


def test_a_remanence_that_no_element_takes_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    entry = 'kind = "constant"\nvector = ["143 mT", 0, 0]'
    (tmp_path / "lost.toml").write_text(changed(REGIONS, (entry, f'group = "outer"\n{entry}')))
    main(["check", str(tmp_path / "lost.toml")])
    said = " ".join("".join(capsys.readouterr()).split())
    assert "remanence[0]: 2 elements of 'outer' (first element 2) lie in the region 'outer', which has its own" in said


@pytest.mark.parametrize(("offset", "told"), [("0.5 mm", False), ("0.6 mm", True), ("-10 mm", True)])
def test_a_mesh_outside_its_faces_is_told(
    offset: str, told: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Beside the half of 0.7 to 1 mm the other is 1 mm thick."""
    (tmp_path / "apart.toml").write_text(changed(REGIONS, ('offset = "bottom"', f'offset = "{offset}"')))
    assert main(["check", str(tmp_path / "apart.toml")]) == 0
    said = " ".join("".join(capsys.readouterr()).split())
    assert ("'rest': the mesh lies outside its faces" in said) is told, said
