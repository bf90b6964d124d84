"""The built-in problems give the values of independent programs."""

from __future__ import annotations

import pytest

from examples.problems import read, value_at, variant
from examples.references import FINE_MESH, SAME_MESH, STRIP_LENGTHS, Reference
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


@pytest.fixture(scope="module")
def default() -> dict[str, Path]:
    """Paths with the default element on the meshes of the problem files, by name."""
    return {}


@pytest.mark.parametrize("reference", FINE_MESH, ids=[one.label for one in FINE_MESH])
def test_value_of_the_solid_with_the_default_element(reference: Reference, default: dict[str, Path]) -> None:
    """It needs no finer mesh: what is left is the difference of the theories.

    To that belong the neglected terms of the thickness, (h/L)² of bending: 1 % for the thickest strip.
    """
    length = STRIP_LENGTHS.get(reference.problem)
    thickness = read(reference.problem)[1].shell.thickness
    neglected = (thickness / length) ** 2 if length else 0.0
    check_solid(reference, default, divide=1, element="quadratic", allowed=ANOTHER_THEORY + neglected)


PAPER_FINE = [one for one in FINE_MESH if one.problem in ("strip-10", "thin-cross")]


@pytest.mark.parametrize("reference", PAPER_FINE, ids=[one.label for one in PAPER_FINE])
def test_value_of_the_solid_on_a_mesh_twice_as_fine(reference: Reference, refined: dict[str, Path]) -> None:
    check_solid(reference, refined, divide=2, element="paper", allowed=ANOTHER_THEORY)


def check_solid(reference: Reference, paths: dict[str, Path], divide: int, element: str, allowed: float) -> None:
    name = reference.problem
    if name not in paths:
        fields = {one.field for one in FINE_MESH if one.problem == name}
        stops = tuple(sorted(field * 1e-3 for field in fields))
        model = variant(name, divide=divide, stops=stops, element=element).model
        paths[name] = solve(model, Settings(tolerance=1e-6))
    found = value_at(paths[name], reference)
    difference = found / reference.value - 1.0
    assert abs(difference) < allowed, (
        f"{reference.label}: {reference.component} = {found:.5g} {reference.unit}, {reference.source} have "
        f"{reference.value:g}: {difference:+.2%}"
    )
