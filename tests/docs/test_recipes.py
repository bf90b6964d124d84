"""The recipes of `docs/layout.md` do what they say: each program runs, and a problem file may use what it adds."""

from __future__ import annotations

import importlib
import pathlib
import re
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache
from typing import Annotated, ClassVar, NamedTuple

import numpy as np
import pytest
from problem_files import BLOCKS, STRIP, changed

import magshell as ms
from magshell import cli
from magshell.evaluation.outputs import OUTPUTS
from magshell.evaluation.series import SERIES
from magshell.keys import Key
from magshell.magnetics import COUPLINGS
from magshell.magnetics import law as coupling_laws
from magshell.magnetics.remanence import REMANENCES
from magshell.materials import MATERIALS, keys_of
from magshell.materials import law as material_laws
from magshell.model.loads import LOADS
from magshell.model.supports import SUPPORTS
from magshell.output import rendering
from magshell.output.series import chosen
from magshell.output.vtu import grid
from magshell.problem.building import build
from magshell.problem.reading import check, parse
from magshell.problem.schema import load_tables, material_tables
from magshell.shell.elements import ELEMENTS

LAYOUT = (pathlib.Path(__file__).parents[2] / "docs" / "layout.md").read_text()
RECIPES = dict(re.findall(r"^## (Add .+?)\n(.*?)(?=^## |\Z)", LAYOUT, re.MULTILINE | re.DOTALL))
LAWS = (material_laws.callbacks, coupling_laws.callbacks)
REGISTRIES = (COUPLINGS, ELEMENTS, LOADS, MATERIALS, OUTPUTS, REMANENCES, SERIES, SUPPORTS, *LAWS)


@cache
def can_draw() -> bool:
    """Whether this machine can draw in three dimensions."""
    try:
        rendering.require_rendering()
    except rendering.RenderingUnavailable:
        return False
    return True


def block(recipe: str, language: str) -> str:
    found = re.findall(rf"^```{language}\n(.*?)^```", RECIPES[recipe], re.MULTILINE | re.DOTALL)
    assert len(found) == 1, f"{recipe}: {len(found)} blocks of {language}"
    return str(found[0])


@pytest.fixture
def registries() -> Iterator[None]:
    """What a recipe registers is forgotten afterwards."""
    before = [dict(registry) for registry in REGISTRIES]
    conservative = set(coupling_laws._conservative)
    yield
    for registry, entries in zip(REGISTRIES, before, strict=True):
        registry.clear()
        registry.update(entries)
    coupling_laws._conservative.clear()
    coupling_laws._conservative.update(conservative)


@pytest.fixture
def follow(registries: None, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[str], object]:
    """Run the program of a recipe, as a module of its own."""
    monkeypatch.syspath_prepend(tmp_path)

    def run(recipe: str) -> object:
        name = recipe.replace(" ", "_")
        (tmp_path / f"{name}.py").write_text(block(recipe, "python"))
        module = importlib.import_module(name)
        monkeypatch.delitem(sys.modules, name)
        return module

    return run


@pytest.fixture
def used(tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]) -> Callable[[str], tuple[str, ms.Path]]:
    """Check, show and solve a problem file: what `check` says, and the path."""

    def use(text: str) -> tuple[str, ms.Path]:
        file, picture = tmp_path / "part.toml", tmp_path / "part.png"
        file.write_text(text)
        assert cli.main(["check", str(file)]) == 0
        said = capsys.readouterr().out
        if can_draw():
            assert cli.main(["show", str(file), "--out", str(picture)]) == 0
            assert picture.read_bytes().startswith(b"\x89PNG")
        problem = ms.problem.load(file)
        return said, ms.solve(problem.model, problem.settings)

    return use


def tip(path: ms.Path) -> np.ndarray:
    return path.probe("tip").u[-1]


def tip_of(text: str) -> np.ndarray:
    """Of a problem file that needs nothing new."""
    file = check(parse(text, "plain"), "plain")
    return tip(ms.solve(build(file, "plain").model))


def test_every_recipe_with_a_program_is_here() -> None:
    source = pathlib.Path(__file__).read_text()
    programs = {name for name, text in RECIPES.items() if "```python" in text}
    assert programs == {name for name in RECIPES if f'follow("{name}")' in source}


def table_of(text: str, name: str) -> str:
    """A table of a problem file."""
    found = re.search(rf"^\[{name}\]\n.*?(?=^\[)", text, re.MULTILINE | re.DOTALL)
    assert found is not None
    return found[0]


def slope(function: Callable[[float], np.ndarray], step: float = 1e-4) -> np.ndarray:
    """Derivative at zero, by differences of fourth order."""
    return (8.0 * (function(step) - function(-step)) - (function(2.0 * step) - function(-2.0 * step))) / (12.0 * step)


def curvature(function: Callable[[float], np.ndarray], step: float = 1e-3) -> np.ndarray:
    """Second derivative at zero, of a function that is quadratic."""
    return (function(step) - 2.0 * function(0.0) + function(-step)) / step**2


def test_a_material_law(follow: Callable, used: Callable) -> None:
    law = follow("Add a material law").MicropolarQuadratic(1.0, 1.7, 0.3, 0.2)
    rng = np.random.default_rng(0)
    U, along = np.eye(3) + 0.2 * rng.normal(size=(3, 3)), rng.normal(size=(3, 3))

    def at(t: float) -> tuple[np.ndarray, ...]:
        return material_laws.evaluate(law, U + t * along)

    energy, P, C = at(0.0)
    J = np.linalg.det(U)
    expected = 0.65 * np.sum(U * U) - 0.15 * np.sum(U * U.T) - np.log(J) + 0.85 * (J - 1.0) ** 2 - 1.5
    assert energy == pytest.approx(expected, rel=1e-12)
    assert slope(lambda t: at(t)[0]) == pytest.approx(np.sum(P * along), rel=1e-9)
    np.testing.assert_allclose(slope(lambda t: at(t)[1]), np.einsum("pjql,ql->pj", C, along), rtol=0.0, atol=1e-8)
    said, path = used(STRIP.replace(table_of(STRIP, "material"), block("Add a material law", "toml") + "\n"))
    assert re.search("law +quadratic", said)
    # The volumetric energies differ by a third power of J - 1.
    plain = tip_of(STRIP)
    off = np.linalg.norm(tip(path) - plain) / np.linalg.norm(plain)
    assert 1e-12 < off < 1e-5, off


def test_a_coupling_law(follow: Callable, used: Callable) -> None:
    shared = follow("Add a coupling law").SharedEnergy
    law, rng = shared(vacuum_permeability=0.7, share=0.3), np.random.default_rng(0)
    m, n, B, dm, spin = rng.normal(size=(5, 3))
    along = np.concatenate([dm, spin, np.zeros(3)])

    def at(t: float) -> tuple[np.ndarray, ...]:
        turned = n + t * np.cross(spin, n) + 0.5 * t**2 * np.cross(spin, np.cross(spin, n))
        return coupling_laws.evaluate(law, m + t * dm, turned, B)

    energy, forces, tangent = at(0.0)
    assert energy == pytest.approx(-(0.7 * m + 0.3 * n) @ B / 0.7, rel=1e-12)
    assert slope(lambda t: at(t)[0]) == pytest.approx(forces @ along, rel=1e-9)
    assert curvature(lambda t: at(t)[0]) == pytest.approx(along @ tangent @ along, rel=1e-6)
    np.testing.assert_allclose(tangent, tangent.T, rtol=0.0, atol=1e-15)
    field = table_of(STRIP, "field")
    said, path = used(STRIP.replace(field, block("Add a coupling law", "toml") + "\n"))
    assert re.search("coupling law +shared", said)
    first, second = (
        tip_of(STRIP.replace(field, f'[field]\nflux_density = [0, 0, "2 mT"]\ncoupling = "{name}"\n'))
        for name in ("micro-rotation", "deformation-gradient")
    )
    # Half of each is about half way between the two laws; the whole of one is that law.
    assert abs(tip(path)[2] - 0.5 * (first + second)[2]) < 0.2 * abs(first - second)[2]
    whole = ms.solve(replace(path.model, coupling=shared(share=1.0)))
    assert tip(whole) == pytest.approx(first, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("former", [{"energy": len, "stress": len}, {"law": len, "stress": len}, {}])
def test_the_former_way_to_register_a_material_law_says_what_to_write(former: dict[str, Callable]) -> None:
    with pytest.raises(TypeError, match=r"takes one function, law\(material, U, P, C\).* write @material_law\(law\)"):
        material_laws.material_law(**former)


@pytest.mark.parametrize("former", [{"forces": len, "energy": len}, {"forces": len}, {"law": len}, {}])
def test_the_former_way_to_register_a_coupling_law_says_what_to_write(former: dict[str, Callable]) -> None:
    with pytest.raises(TypeError, match=r"law\(coupling, m, n, .* write @coupling_law\(law, has_energy=True\)"):
        coupling_laws.coupling_law(**former)


def test_former_laws_by_position_are_refused() -> None:
    with pytest.raises(TypeError, match="takes one function"):
        material_laws.material_law(len, len)
    with pytest.raises(TypeError, match="takes one function"):
        coupling_laws.coupling_law(len, len)


def test_a_load(follow: Callable, used: Callable, tmp_path: pathlib.Path) -> None:
    follow("Add a load")
    said, path = used(BLOCKS + block("Add a load", "toml"))
    assert re.search(r"whole shell +push 4 Pa, 4 elements, in all \(0, 0, 0\.4 mN\)", said)
    traction = '[[loads]]\nkind = "traction"\ngroup = "{}"\ntraction = [0, 0, "4 Pa"]\n'
    same = tip_of(BLOCKS + traction.format("one") + traction.format("two"))
    assert tip(path) == pytest.approx(same, rel=1e-9, abs=1e-15)
    assert abs(tip(path)[2] - tip_of(BLOCKS)[2]) > 1e-5
    slip = tmp_path / "slip.toml"
    slip.write_text(STRIP + '[[loads]]\nkind = "push"\npusch = "4 Pa"\n')
    with pytest.raises(
        ms.InputError, match=r"slip\.toml: loads\[0\]\.pusch: is an unknown key\. Did you mean 'push'\?"
    ):
        ms.problem.load(slip)


def test_a_way_to_magnetise(follow: Callable, used: Callable) -> None:
    follow("Add a way to magnetise")
    plain = BLOCKS[BLOCKS.index("[[remanence]]") : BLOCKS.index("[field]")]
    said, path = used(BLOCKS.replace(plain, block("Add a way to magnetise", "toml")))
    assert re.search(r"everywhere +143 mT, in stripes of 10 mm", said)
    group = '[[remanence]]\nkind = "constant"\ngroup = "{}"\nvector = ["{} mT", 0, 0]\n'
    same = tip_of(BLOCKS.replace(plain, group.format("one", 143) + group.format("two", -143)))
    assert tip(path) == pytest.approx(same, rel=1e-9, abs=1e-15)


def test_a_support(follow: Callable, used: Callable) -> None:
    follow("Add a support")
    said, path = used(STRIP + block("Add a support", "toml"))
    assert re.search(r"right +roller, 3 nodes", said)
    assert abs(tip(path)[2]) < 1e-12
    assert abs(tip_of(STRIP)[2]) > 1e-4


def test_an_element_type(follow: Callable, used: Callable) -> None:
    follow("Add an element type")
    _, path = used(changed(STRIP, ('thickness = "1 mm"', 'thickness = "1 mm"\nelement = "mine"')))
    assert path.model.shell.element is ELEMENTS["mine"]
    assert tip(path)[2] == pytest.approx(tip_of(STRIP)[2], rel=0.1)


def test_a_quantity(follow: Callable, used: Callable, tmp_path: pathlib.Path) -> None:
    follow("Add a quantity to the results")
    _, path = used(STRIP)
    step = path.steps[-1]
    np.testing.assert_array_equal(
        grid(path.discretisation, step).point_data["distance"], np.linalg.norm(step.state.u, axis=1)
    )
    path.view(tmp_path / "view.html", color="distance")
    if can_draw():
        assert path.plot(color="s").size


def test_a_column(follow: Callable, used: Callable, tmp_path: pathlib.Path) -> None:
    """It is in the file, in the table's columns and among the curves."""
    follow("Add a column to the history")
    path = ms.solve(build(check(parse(STRIP, "test.toml"), "test.toml"), "test.toml").model)
    assert path.history.columns[-1] == "farthest"
    largest = np.linalg.norm(path.steps[-1].state.u, axis=1).max()
    assert path.history.row(path.steps[-1])[-1] == pytest.approx(largest, rel=1e-14)
    assert chosen(path, ["farthest"]).title == "farthest (mm)"


def test_an_observer(follow: Callable, capsys: pytest.CaptureFixture[str]) -> None:
    module = follow("Add an observer")
    said = capsys.readouterr().out.splitlines()
    assert said[0] == "753 unknowns"
    assert said[-1] == f"1.000  {module.path.steps[-1].state.u[:, 2].max():.6f} m"


def test_a_law_is_known_by_its_name_in_the_registry(registries: None, used: Callable) -> None:
    MATERIALS["mine"], COUPLINGS["ours"] = MATERIALS["micropolar-neo-hookean"], COUPLINGS["couple"]
    own = changed(STRIP, ('"micropolar-neo-hookean"', '"mine"'), ("[field]", '[field]\ncoupling = "ours"'))
    said, path = used(own)
    assert re.search("law +mine", said)
    assert re.search("coupling law +ours", said)
    assert tip(path) == pytest.approx(tip_of(STRIP), rel=1e-12)


def test_a_key_of_a_law_is_described_beside_its_parameter(registries: None, tmp_path: pathlib.Path) -> None:
    class Stiffening(NamedTuple):
        shear_modulus: float
        lame_lambda: float
        coupling_modulus: float
        length_scale: float
        locking_stress: Annotated[float, Key("PositiveStress", "Where it locks.")] = 1e5

    assert list(keys_of(Stiffening))[-1] == "locking_stress"
    MATERIALS["stiffening"] = Stiffening
    table = material_tables()["stiffening"]
    common = {"law": "stiffening", "shear_modulus": "1 MPa", "lame_lambda": "3 MPa"}
    assert table.model_validate(common).locking_stress == 1e5
    assert table.model_validate({**common, "locking_stress": "2 kPa"}).locking_stress == 2e3
    text = changed(STRIP, ('law = "micropolar-neo-hookean"', 'law = "stiffening"\nlocking_stress = "-2 kPa"'))
    with pytest.raises(ms.InputError, match=r"a: material\.locking_stress: '-2 kPa' is not positive"):
        check(parse(text, "a"), "a")


def test_a_key_of_an_unknown_kind_is_refused(registries: None) -> None:
    class Slip(LOADS["force"]):  # type: ignore[misc]
        keys: ClassVar = {**LOADS["force"].keys, "total": Key("ForceVektor", "Its sum.")}

    LOADS["slip"] = Slip
    with pytest.raises(TypeError, match=r"'ForceVektor' of total is no kind of value\. Did you mean 'ForceVector'"):
        load_tables()


@pytest.mark.parametrize("keys", [("group",), ("group", "total", "tottal")])
def test_keys_that_are_not_the_parameters_are_refused(registries: None, keys: tuple[str, ...]) -> None:
    class Slip(LOADS["force"]):  # type: ignore[misc]
        pass

    Slip.keys = {key: Key("Name", "A slip.") for key in keys}
    LOADS["slip"] = Slip
    with pytest.raises(TypeError, match=r"slip: its keys \(group.*\) are not the parameters of .*Slip"):
        load_tables()
