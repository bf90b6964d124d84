"""Keys of the shell table and laws that change the theory."""

from __future__ import annotations

import pytest

from magshell import MicropolarStVenantKirchhoff, problem
from magshell.errors import InputError
from magshell.problem.building import build
from magshell.problem.schema import material_tables
from magshell.shell.elements import ELEMENTS


def changed(name, **tables):
    source, file = problem.read(name)
    updates = {table: getattr(file, table).model_copy(update=values) for table, values in tables.items()}
    return build(file.model_copy(update=updates), source).model


@pytest.mark.parametrize("element", ELEMENTS)
def test_every_element_type_can_be_named(element):
    assert changed("strip-10", shell={"element": element}).shell.element is ELEMENTS[element]


def test_the_default_is_the_first_type():
    assert problem.load("strip-10").model.shell.element is next(iter(ELEMENTS.values()))


def test_without_micro_rotation_nothing_is_left_of_its_parameters():
    model = changed("strip-10", shell={"micro_rotation": False}, field={"coupling": "deformation-gradient"})
    assert model.shell.material[2:] == (0.0, 0.0)
    assert not model.shell.carriers["omega"].any()


def test_a_couple_needs_the_micro_rotation():
    with pytest.raises(InputError, match=r"MicropolarCouple works on the micro-rotation, which this shell does not"):
        changed("strip-10", shell={"micro_rotation": False})


def test_a_coupling_modulus_needs_the_micro_rotation():
    with pytest.raises(InputError, match=r"coupling_modulus is 1000; without micro-rotation it must be 0"):
        changed("strip-10", shell={"micro_rotation": False}, material={"coupling_modulus": 1000.0})


@pytest.mark.parametrize("law", ["micropolar-st-venant-kirchhoff", "st-venant-kirchhoff"])
def test_st_venant_kirchhoff(law):
    source, file = problem.read("strip-10")
    table = material_tables()["micropolar-st-venant-kirchhoff"](law=law, shear_modulus="300 kPa", lame_lambda="1 MPa")
    material = build(file.model_copy(update={"material": table}), source).model.shell.material
    assert isinstance(material, MicropolarStVenantKirchhoff)
    assert material == pytest.approx((3e5, 1e6, 3e5, 0.01 * file.shell.thickness))
