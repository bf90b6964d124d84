"""Two moduli of five, the defaults of the others, and the names of laws in problem files."""

from __future__ import annotations

import copy
import dataclasses
import itertools
import logging
import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from problem_files import BLOCKS, STRIP, changed
from pydantic import TypeAdapter, ValidationError

import magshell as ms
from magshell import materials, problem
from magshell.cli import main
from magshell.errors import InputError
from magshell.materials import MATERIALS, MODULI, lame_of, law_named, names_of
from magshell.materials.law import evaluate
from magshell.problem import fields
from magshell.problem.building import material as building

MODULUS = 'shear_modulus = "303 kPa"\nlame_lambda = "7300 kPa"\n'
COUPLING = 'coupling_modulus = "0.1 mu"\nlength_scale = "0.1 h"\n'


def all_moduli(mu, nu):
    """From the textbook, by shear modulus and Poisson's ratio."""
    return {
        "shear_modulus": mu,
        "lame_lambda": 2.0 * mu * nu / (1.0 - 2.0 * nu),
        "youngs_modulus": 2.0 * mu * (1.0 + nu),
        "poissons_ratio": nu,
        "bulk_modulus": 2.0 * mu * (1.0 + nu) / (3.0 * (1.0 - 2.0 * nu)),
    }


@given(mu=st.floats(1e-3, 1e12), nu=st.floats(0.0, 0.4999))
def test_any_two_moduli_determine_the_others(mu, nu):
    every = all_moduli(mu, nu)
    for pair in itertools.combinations(MODULI, 2):
        if "lame_lambda" in pair and (nu < 1e-6 and "poissons_ratio" in pair):
            continue  # lambda = nu = 0 says nothing
        found = lame_of({name: every[name] for name in pair})
        tolerance = 1e-14 / (0.5 - nu)  # of a difference that cancels as nu nears 1/2
        assert found[0] == pytest.approx(mu, rel=tolerance), pair
        assert found[1] == pytest.approx(every["lame_lambda"], rel=tolerance, abs=1e-14 * mu), pair


@pytest.mark.parametrize(
    ("moduli", "message"),
    [
        ({}, "shear_modulus is missing; two moduli are needed, such as .* youngs_modulus and poissons_ratio"),
        ({"bulk_modulus": 1.0}, "bulk_modulus is given alone; a second modulus is missing: shear_modulus, "),
        (
            {"shear_modulus": 1.0, "youngs_modulus": 2.5, "poissons_ratio": 0.25},
            "shear_modulus, youngs_modulus and poissons_ratio are given; two moduli determine the others",
        ),
        ({"youngs_modulus": 1.0, "poissons_ratio": 0.5}, "poissons_ratio is 0.5; it must be at least 0 and below 0.5"),
        ({"youngs_modulus": 1.0, "poissons_ratio": -0.1}, "poissons_ratio is -0.1; it must be finite and zero or"),
        ({"youngs_modulus": float("nan"), "poissons_ratio": 0.1}, "youngs_modulus is nan"),
        ({"youngs_modulus": 0.0, "poissons_ratio": 0.1}, "youngs_modulus is 0; it must be finite and positive"),
        ({"shear_modulus": 1.0, "youngs_modulus": 3.0}, "must be at least 2 and below 3"),
        ({"shear_modulus": 1.0, "youngs_modulus": 1.9}, "must be at least 2 and below 3"),
        ({"shear_modulus": 3.0, "bulk_modulus": 1.9}, "bulk_modulus must be at least 2"),
        ({"lame_lambda": 3.0, "bulk_modulus": 3.0}, "bulk_modulus must be above 3"),
        ({"youngs_modulus": 3.0, "bulk_modulus": 0.9}, "bulk_modulus must be at least 1"),
        ({"lame_lambda": 0.0, "poissons_ratio": 0.0}, "give another modulus if one of them is 0"),
        ({"lame_lambda": 0.0, "poissons_ratio": 0.2}, "give another modulus if one of them is 0"),
    ],
)
def test_moduli_that_determine_nothing(moduli, message):
    with pytest.raises(InputError, match=message):
        lame_of(moduli)
    with pytest.raises(InputError, match=message):
        ms.MicropolarNeoHookean.from_moduli(**moduli)


@pytest.mark.parametrize("law", materials.laws(), ids=lambda law: law.__name__)
def test_every_law_takes_other_moduli(law):
    own = {name: getattr(battery_example(law), name) for name in materials.own_keys(law)}
    made = law.from_moduli(youngs_modulus=3.0, poissons_ratio=0.4, coupling_modulus=0.2, **own)
    assert made[:2] == pytest.approx((3.0 / 2.8, 3.0 * 0.4 / (1.4 * 0.2)), rel=1e-15)
    assert (made.coupling_modulus, made.length_scale) == (0.2, None)


def battery_example(law):
    from battery import example

    return example(law)


# -- what is left out ------------------------------------------------------------------------------------------------


def shell(material, thickness=2e-3, **options):
    return ms.Shell(ms.mesh.rectangle(0.02, 0.01, (1, 1)), thickness, material, **options)


def test_a_shell_gives_the_coupling_modulus_and_the_length_scale():
    rubber = ms.MicropolarNeoHookean(303e3, 7300e3)
    assert shell(rubber).material == (303e3, 7300e3, 303e3, 2e-5)
    assert shell(rubber, thickness=1e-3).material == (303e3, 7300e3, 303e3, 1e-5)
    assert shell(rubber._replace(coupling_modulus=0.0)).material == (303e3, 7300e3, 0.0, 2e-5)
    assert shell(rubber, micro_rotation=False).material == (303e3, 7300e3, 0.0, 0.0)
    assert rubber.length_scale is None


def test_another_shell_of_the_same_has_its_own():
    thin = shell(ms.MicropolarNeoHookean(303e3, 7300e3), thickness=1e-3)
    assert dataclasses.replace(thin, thickness=2e-3).material == (303e3, 7300e3, 303e3, 2e-5)
    assert dataclasses.replace(thin, micro_rotation=False).material[2:] == (0.0, 0.0)
    stiff = dataclasses.replace(thin, material=thin.material._replace(shear_modulus=400e3))
    assert stiff.material == (400e3, 7300e3, 400e3, 1e-5)
    given = shell(ms.MicropolarNeoHookean(303e3, 7300e3, 30e3, 1e-4), thickness=1e-3)
    assert dataclasses.replace(given, thickness=2e-3).material == (303e3, 7300e3, 30e3, 1e-4)


def test_a_multiple_survives_copies_and_processes():
    one = materials.Multiple("1/3", 2.0)
    for other in (copy.deepcopy(one), pickle.loads(pickle.dumps(one))):
        assert (other, other.factor) == (2.0, one.factor)
    assert one.of(6.0) == 2.0


def test_a_law_is_evaluated_without_them():
    U = np.array([[1.1, 0.2, 0.0], [0.1, 0.9, 0.0], [0.0, 0.0, 1.0]])
    given, left_out = ms.MicropolarNeoHookean(1.0, 2.0, 1.0, 1.0), ms.MicropolarNeoHookean(1.0, 2.0)
    assert np.array_equal(evaluate(left_out, U)[1], evaluate(given, U)[1])


def loaded(tmp_path, *changes, name="strip.toml"):
    (tmp_path / name).write_text(changed(STRIP, *changes))
    return problem.load(tmp_path / name)


def test_file_and_python_have_the_same_defaults(tmp_path):
    of_file = loaded(tmp_path, (COUPLING, "")).model.shell.material
    assert of_file == shell(ms.MicropolarNeoHookean(303e3, 7300e3), thickness=1e-3).material


def test_multiples_follow_the_modulus_and_the_thickness(tmp_path):
    (tmp_path / "strip.toml").write_text(STRIP)
    material = problem.load(tmp_path / "strip.toml").model.shell.material
    assert material == (303e3, 7300e3, 303e3 / 10.0, 1e-3 / 10.0)
    changes = {"shell.thickness": "2 mm", "material.coupling_modulus": "5e-1 \u03bc", "material.length_scale": ".2h"}
    material = problem.load(tmp_path / "strip.toml", changes).model.shell.material
    assert material == (303e3, 7300e3, 303e3 / 2.0, 2e-3 / 5.0)


@given(
    value=st.one_of(
        st.text(max_size=20),
        st.from_regex(r"[0-9.+-]{1,6}(e[0-9]{1,3})? ?(mu|\u03bc|\u00b5|h|mm|kPa)?", fullmatch=True),
        st.integers(),
        st.floats(),
        st.none(),
    ),
    kind=st.sampled_from([fields.CouplingModulus, fields.LengthScale]),
)
def test_whatever_stands_there_is_a_value_a_multiple_or_an_input_error(value, kind):
    try:
        read = TypeAdapter(kind).validate_python(value)
    except ValidationError:
        return
    number = read.of(2.0) if isinstance(read, fields.Multiple) else read
    assert isinstance(number, float)
    assert number >= 0.0
    assert np.isfinite(number)


def test_multiples_vanish_without_micro_rotation(tmp_path):
    assert loaded(tmp_path, *CLASSICAL).model.shell.material[2:] == (0.0, 0.0)


def test_young_and_poisson_in_a_file(tmp_path):
    given = 'youngs_modulus = "300 kPa"\npoissons_ratio = 0.4999\n'
    material = loaded(tmp_path, (MODULUS, given)).model.shell.material
    every = all_moduli(150e3 / 1.4999, 0.4999)
    assert material[:2] == pytest.approx((every["shear_modulus"], every["lame_lambda"]), rel=1e-12)
    assert material.coupling_modulus == pytest.approx(material.shear_modulus / 10, rel=1e-15)


def test_two_other_moduli_replace_those_of_the_file(tmp_path):
    (tmp_path / "strip.toml").write_text(STRIP)
    pair = {"material.youngs_modulus": "300 kPa", "material.poissons_ratio": 0.25}
    assert problem.load(tmp_path / "strip.toml", pair).model.shell.material[:2] == pytest.approx((120e3, 120e3))
    with pytest.raises(InputError, match="material: shear_modulus, lame_lambda and youngs_modulus are given"):
        problem.load(tmp_path / "strip.toml", {"material.youngs_modulus": "300 kPa"})


def test_the_note_is_told_once_by_python_and_by_each_command(tmp_path, caplog, capsys):
    building.tell_once.cache_clear()
    with caplog.at_level(logging.WARNING, logger=building.__name__):
        for _ in range(2):
            loaded(tmp_path, (COUPLING, ""))
    assert [record.getMessage() for record in caplog.records] == [
        "strip.toml: by default coupling_modulus is mu and length_scale is h/100, where earlier versions took a tenth; "
        'write [material] coupling_modulus = "0.1 mu", length_scale = "0.1 h" for the earlier results'
    ]
    assert main(["check", str(tmp_path / "strip.toml")]) == 0
    assert capsys.readouterr().out.count("note: by default coupling_modulus is mu and length_scale is h/100") == 1


CLASSICAL = (
    ('thickness = "1 mm"', 'thickness = "1 mm"\nmicro_rotation = false'),
    ("[field]", '[field]\ncoupling = "deformation-gradient"'),
)


@pytest.mark.parametrize("changes", [(), ((COUPLING, ""), *CLASSICAL)], ids=["given", "classical"])
def test_no_note_where_nothing_changed(tmp_path, caplog, changes):
    building.tell_once.cache_clear()
    with caplog.at_level(logging.WARNING, logger=building.__name__):
        loaded(tmp_path, *changes)
    assert not caplog.records


# -- regions and layers ----------------------------------------------------------------------------------------------


def halves():
    mesh = ms.mesh.rectangle(0.02, 0.01, (4, 1))
    return ms.mesh.Mesh(mesh.points, mesh.elements, {"thin": [2, 3]}, mesh.edge_groups, mesh.node_groups)


def lengths(shell):
    return [layer.material.length_scale for part in shell.parts for layer in part.layers]


def test_each_region_has_the_length_scale_of_its_thickness():
    rubber = ms.MicropolarNeoHookean(303e3, 7300e3)
    thin = ms.Region("thin", thickness=5e-4, material=rubber._replace(shear_modulus=100e3))
    whole = ms.Shell(halves(), 1e-3, rubber, regions=[thin])
    assert lengths(whole) == [1e-5, 5e-6]
    assert [part.layers[0].material.coupling_modulus for part in whole.parts] == [303e3, 100e3]
    assert lengths(ms.Shell(halves(), 1e-3, rubber, regions=[ms.Region("thin", thickness=5e-4)])) == [1e-5, 5e-6]
    given = rubber._replace(length_scale=1e-4)
    assert lengths(ms.Shell(halves(), 1e-3, given, regions=[ms.Region("thin", thickness=5e-4)])) == [1e-4, 1e-4]


def test_layers_have_that_of_all_of_them_together():
    rubber, soft = ms.MicropolarNeoHookean(303e3, 7300e3), ms.MicropolarNeoHookean(30e3, 730e3, length_scale=2e-5)
    whole = ms.Shell(halves(), layers=[ms.Layer(4e-4, rubber), ms.Layer(6e-4, soft)])
    assert lengths(whole) == pytest.approx([1e-5, 2e-5], rel=1e-15)
    classical = ms.Shell(halves(), 4e-4, rubber, micro_rotation=False)
    assert lengths(classical) == [0.0]


def test_a_taper_has_the_mean_however_it_is_divided():
    """Regions of one make share the stretch of the thickness at their border: their materials must be equal."""
    taper = ms.thickness.profile((1, 0, 0), (0.0, 0.02), (1e-3, 5e-4))
    rubber = ms.MicropolarNeoHookean(303e3, 7300e3)
    one = lengths(ms.Shell(halves(), taper, rubber))
    two = lengths(ms.Shell(halves(), taper, rubber, regions=[ms.Region("thin"), ms.Region([1])]))
    assert one == [pytest.approx(7.5e-6, rel=1e-12)]
    assert two == 3 * one


REGION = """
[[regions]]
group = "two"
thickness = "0.5 mm"
material = { law = "neo-hookean", youngs_modulus = "300 kPa", poissons_ratio = 0.49 }

"""


def test_regions_in_a_file(tmp_path, capsys):
    text = changed(BLOCKS, ("[[remanence]]", REGION + "[[remanence]]"))
    (tmp_path / "strip.toml").write_text(text)
    first, second = (part.layers[0].material for part in problem.load(tmp_path / "strip.toml").model.shell.parts)
    assert first == (303e3, 7300e3, 303e3 / 10.0, 1e-4)
    assert second == pytest.approx((300e3 / 2.98, 300e3 * 0.49 / (1.49 * 0.02), 300e3 / 2.98, 5e-6), rel=1e-12)
    assert main(["check", str(tmp_path / "strip.toml")]) == 0
    assert "note: by default coupling_modulus is mu and length_scale is h/100" in capsys.readouterr().out
    (tmp_path / "strip.toml").write_text(changed(text, ("poissons_ratio = 0.49", "poissons_ratio = 0.5")))
    with pytest.raises(InputError, match=r"regions\[0\]\.material: poissons_ratio is 0.5"):
        problem.load(tmp_path / "strip.toml")


def test_multiples_are_those_of_the_region(tmp_path):
    bare = changed(
        REGION, ('material = { law = "neo-hookean", youngs_modulus = "300 kPa", poissons_ratio = 0.49 }\n', "")
    )
    (tmp_path / "strip.toml").write_text(changed(BLOCKS, ("[[remanence]]", bare + "[[remanence]]")))
    assert lengths(problem.load(tmp_path / "strip.toml").model.shell) == [1e-4, 5e-5]


# -- names -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", MATERIALS)
def test_micropolar_may_be_left_out_of_a_name(name):
    assert names_of(name) == (name, name.removeprefix("micropolar-"))
    assert {law_named(one) for one in names_of(name)} == {MATERIALS[name]}


def test_the_short_name_in_a_file(tmp_path):
    material = loaded(tmp_path, ("micropolar-neo-hookean", "st-venant-kirchhoff")).model.shell.material
    assert isinstance(material, ms.MicropolarStVenantKirchhoff)


def test_a_law_of_ones_own_with_the_short_name_comes_first(monkeypatch):
    monkeypatch.setitem(MATERIALS, "neo-hookean", ms.MicropolarMooneyRivlin)
    assert law_named("neo-hookean") is ms.MicropolarMooneyRivlin
    assert names_of("micropolar-neo-hookean") == ("micropolar-neo-hookean",)
    assert names_of("neo-hookean") == ("neo-hookean",)


# -- the couple ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("eta", "warned"), [("225 Pa", True), ("230 Pa", False)])
def test_a_couple_that_reaches_the_coupling_modulus_is_told(tmp_path, caplog, capsys, eta, warned):
    """143 mT · 2 mT / mu0 = 227.6 Pa."""
    words = "the field's couple B_rem B/mu0 is up to 227.6 Pa in element 0 and reaches the coupling modulus 225 Pa"
    with caplog.at_level(logging.WARNING, logger="magshell.model.coupling_limit"):
        loaded(tmp_path, ('"0.1 mu"', f'"{eta}"'))
    assert any(record.getMessage().startswith(words) for record in caplog.records) is warned
    assert main(["check", str(tmp_path / "strip.toml")]) == 0
    assert (f"warning: {words}" in capsys.readouterr().out) is warned


def test_the_deformation_gradient_has_no_such_limit(tmp_path, caplog):
    with caplog.at_level(logging.WARNING, logger="magshell.model.coupling_limit"):
        loaded(tmp_path, ('"0.1 mu"', '"1 Pa"'), ("[field]", '[field]\ncoupling = "deformation-gradient"'))
    assert not caplog.records
