"""The valid name that somebody meant."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from magshell.materials import MATERIALS, names_of
from magshell.model.loads import LOADS
from magshell.model.supports import SUPPORTS
from magshell.nearest import nearest, slips
from magshell.problem.schema import MaterialTable, ProblemFile, Rectangle

TABLES = list(ProblemFile.model_fields)
MODULI = list(MaterialTable.model_fields)


@pytest.mark.parametrize(
    ("name", "valid", "meant"),
    [
        ("young_modulus", MODULI, "youngs_modulus"),
        ("young_modulus", [name for name in MODULI if name != "youngs_modulus"], None),
        ("E", MODULI, "youngs_modulus"),
        ("nu", MODULI, "poissons_ratio"),
        ("Poisson's ratio", MODULI, "poissons_ratio"),
        ("modulus", MODULI, None),
        ("magnets", ["loads", "remanence", "stages"], "remanence"),
        ("magnetisation", TABLES, "remanence"),
        ("forces", TABLES, "loads"),
        ("points", TABLES, "probes"),
        ("boundary_conditions", TABLES, "supports"),
        ("steps", TABLES, "stages"),
        ("shel", TABLES, "shell"),
        ("magnetic_field", TABLES, "field"),
        ("fixed", SUPPORTS, "clamp"),
        ("pinned", SUPPORTS, "simple"),
        ("simply supported", SUPPORTS, "simple"),
        ("mirror", SUPPORTS, "symmetry"),
        ("weight", LOADS, "gravity"),
        ("linear elastic", [name for law in MATERIALS for name in names_of(law)], "st-venant-kirchhoff"),
        ("lenght", Rectangle.model_fields, "length"),
        ("divisions", Rectangle.model_fields, "elements"),
        ("hub-4", ["hub-1", "rim"], "hub-1"),
        ("tow", ["one", "two"], "two"),
        ("x", ["y", "z"], None),
        ("", ["a"], None),
        ("...", ["a"], None),
        ("anything", [], None),
    ],
)  # fmt: skip
def test_meant(name: str, valid: list[str], meant: str | None) -> None:
    assert nearest(name, valid) == meant


words = st.text("abc", max_size=6)


@given(first=words, second=words, third=words)
def test_slips(first: str, second: str, third: str) -> None:
    """Symmetric, zero for the same word only, one for one slip."""
    assert slips(first, second) == slips(second, first)
    assert (slips(first, second) == 0) == (first == second)
    assert slips(first + second, first + "x" + second) == 1
    assert slips(first + "xy" + second, first + "yx" + second) == 1
    assert abs(len(first) - len(second)) <= slips(first, second) <= max(len(first), len(second))
    assert slips(first + third, second + third) <= slips(first, second)


@given(name=st.text(max_size=12), valid=st.lists(st.text(max_size=12), max_size=5))
def test_any_text(name: str, valid: list[str]) -> None:
    found = nearest(name, valid)
    assert found is None or found in valid
    if name and name in valid and any(letter.isalnum() for letter in name):
        assert found is not None
