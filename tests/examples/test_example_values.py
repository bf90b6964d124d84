"""The built-in problems give the values of independent programs."""

from __future__ import annotations

import pytest

from examples.problems import value_at, variant
from examples.references import FINE_MESH, SAME_MESH, Reference
from magshell import Path, solve
from magshell.solver import Settings

SAME_FORMULATION = 5e-3
ANOTHER_THEORY = 1e-2


@pytest.mark.parametrize("reference", SAME_MESH, ids=[one.label for one in SAME_MESH])
def test_value_of_the_same_formulation_on_the_same_mesh(reference: Reference, solved) -> None:
    found = value_at(solved(reference.problem), reference)
    difference = found / reference.value - 1.0
    assert abs(difference) < SAME_FORMULATION, (
        f"{reference.label}: {reference.component} = {found:.5g} {reference.unit}, {reference.source} has "
        f"{reference.value:g}: {difference:+.2%}"
    )


@pytest.fixture(scope="module")
def refined() -> dict[str, Path]:
    """Paths on meshes twice as fine, converged far below what is compared, by name."""
    return {}


@pytest.mark.parametrize("reference", FINE_MESH, ids=[one.label for one in FINE_MESH])
def test_value_of_the_solid_on_a_mesh_twice_as_fine(reference: Reference, refined: dict[str, Path]) -> None:
    name = reference.problem
    if name not in refined:
        fields = {one.field for one in FINE_MESH if one.problem == name}
        stops = tuple(sorted(field * 1e-3 for field in fields))
        refined[name] = solve(variant(name, divide=2, stops=stops).model, Settings(tolerance=1e-6))
    found = value_at(refined[name], reference)
    difference = found / reference.value - 1.0
    assert abs(difference) < ANOTHER_THEORY, (
        f"{reference.label}: {reference.component} = {found:.5g} {reference.unit}, {reference.source} have "
        f"{reference.value:g}: {difference:+.2%}"
    )
