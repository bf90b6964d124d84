"""The coupling laws on a strip differ by what their theories differ by."""

from __future__ import annotations

import numpy as np
import pytest

from examples.problems import value_at, variant
from examples.references import MICROPOLAR_SOLID, STRIP_FIELDS, STRIPS, ZHAO_SOLID, Reference
from magshell import Path, solve
from magshell.shell.deformed import evaluate
from magshell.solver import Settings

NAME = "strip-10"
STOPS = tuple(field * 1e-3 for field in STRIP_FIELDS)
LAWS = ("couple", "deformation-gradient", "micro-rotation")


def _tip(path: Path) -> np.ndarray:
    """u3 / L at 2, 10 and 50 mT."""
    wanted = [Reference(NAME, "tip", "u3", field, 0.0, "L", "") for field in STRIP_FIELDS]
    return np.array([value_at(path, one) for one in wanted])


@pytest.fixture(scope="module")
def paths() -> dict[str, Path]:
    """Of the built-in problem, by law."""
    return {law: solve(variant(NAME, stops=STOPS, coupling=law).model) for law in LAWS}


@pytest.fixture(scope="module")
def without_couple_stress() -> np.ndarray:
    """Zhao's law with the length scale of the couple stress a tenth of the problem's, on a mesh twice as fine."""
    fine = variant(NAME, divide=2, stops=STOPS, coupling="deformation-gradient", length_scale=11e-6)
    return _tip(solve(fine.model, Settings(tolerance=1e-6)))


def test_law_of_zhao_is_the_solid_of_zhao_where_couple_stress_vanishes(without_couple_stress: np.ndarray) -> None:
    difference = without_couple_stress / STRIPS[ZHAO_SOLID][NAME] - 1.0
    assert np.abs(difference).max() < 0.01, f"{without_couple_stress}, solid {STRIPS[ZHAO_SOLID][NAME]}: {difference}"


def test_couple_stress_stiffens_bending_as_its_energy_says(paths: dict[str, Path], without_couple_stress) -> None:
    """With Γ = κ the couple stress adds mu l² h to the bending stiffness E h³/12 of a beam, E h³/12(1 - ν²) of a plate.

    The strip is between the two; its small deflection falls in that proportion.
    """
    mu, lam, ratio = 303e3, 7300e3, 0.1
    E = mu * (3 * lam + 2 * mu) / (lam + mu)
    nu = lam / (2 * (lam + mu))
    beam, plate = (12 * mu / stiffness * ratio**2 for stiffness in (E, E / (1 - nu**2)))
    found = without_couple_stress[0] / _tip(paths["deformation-gradient"])[0] - 1.0
    anticlastic = beam * (1 + nu**2)
    assert plate < found < anticlastic, f"{plate:.4f} < {found:.4f} < {anticlastic:.4f}"


def test_law_of_zhao_adds_a_shear_to_the_couple(paths: dict[str, Path]) -> None:
    """Its work is the couple's and that of the symmetric stress of b and B, which shears the strip the same way."""
    couple, zhao = _tip(paths["couple"]), _tip(paths["deformation-gradient"])
    more = zhao / couple - 1.0
    apart = np.divide(STRIPS[ZHAO_SOLID][NAME], STRIPS[MICROPOLAR_SOLID][NAME]) - 1.0
    assert np.all((more > 0.0) & (more < apart)), f"Zhao's law over the couple {more}, the solids {apart}"


def test_micro_rotation_energy_is_the_couple_of_a_remanence_that_does_not_stretch(paths: dict[str, Path]) -> None:
    """R̃ B̃ in place of F B̃ changes the couples by |F B̃ - R̃ B̃| / |B̃| at most, and the tip by less, as it stiffens."""
    path = paths["couple"]
    body, steps = path.discretisation.reference, path.steps
    at_stops = [step for step in steps if step.load_factor in path.model.course(0).stops()]
    couple, micro = _tip(path), _tip(paths["micro-rotation"])
    for step, one, other in zip(at_stops, couple, micro, strict=True):
        fields = evaluate(body, step.state)
        m = np.einsum("epkxy,epky->epkx", fields.F, body.remanence)
        n = np.einsum("epxy,epky->epkx", fields.R, body.remanence)
        bound = (np.linalg.norm(m - n, axis=-1) / np.linalg.norm(n, axis=-1)).max()
        change = abs(other / one - 1.0)
        assert 1e-5 < change < bound, f"load factor {step.load_factor}: tip changes by {change:.2e}, {bound:.2e}"
