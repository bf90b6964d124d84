"""Order of convergence on problems without corners: regular meshes, each with elements of half the size."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import magshell as ms
from elements.linear import SMALL, respond, rubber
from magshell.mesh import split
from magshell.shell.elements import ELEMENTS, ElementType

MU_0 = 4e-7 * np.pi


def orders(work: Callable[[int], float], elements: tuple[int, ...]) -> np.ndarray:
    """Orders from successive differences, which fall as the errors do."""
    values = np.array([work(n) for n in elements])
    changes = np.diff(values)
    return np.log2(np.abs(changes[:-1] / changes[1:]))


def wave(element: ElementType, elements: int, slenderness: float, nu: float, triangles: bool = False) -> float:
    """Work on a plate in plane strain, magnetised by half a wave, between planes of symmetry."""
    thickness = 1.0 / slenderness
    mesh = ms.mesh.rectangle(1.0, 0.25, (elements, 1))
    mesh = (split(mesh, "rising") if triangles else mesh).select_nodes("origin", x1=0)
    magnets = ms.remanence.function(lambda X: np.outer(np.sin(np.pi * X[:, 0]), [1.0, 0.0, 0.0]))
    shell = ms.Shell(mesh, thickness, rubber(nu, thickness), magnets, element)
    supports = [
        *(ms.SymmetryPlane(side, (1, 0, 0)) for side in ("left", "right")),
        *(ms.SymmetryPlane(side, (0, 1, 0)) for side in ("bottom", "top")),
        ms.Prescribe("origin", "u", 3),
    ]
    field = ms.UniformField((0, 0, SMALL * thickness**2 * MU_0))
    return respond(ms.Model(shell, supports, field)).work


@pytest.mark.parametrize("slenderness", [10, 1000])
@pytest.mark.parametrize("element", ELEMENTS.values(), ids=ELEMENTS)
def test_flat(element: ElementType, slenderness: float) -> None:
    """Strains that are linear on an element converge with h², their energy with h⁴; constant ones with h and h²."""
    expected = 4.0 if element.rest_nodes == 8 else 2.0
    found = orders(lambda n: wave(element, n, slenderness, 0.3), (4, 8, 16))[-1]
    print(f"{found:.2f}")
    assert found == pytest.approx(expected, abs=0.2), f"order {found:.2f}, expected {expected}"


@pytest.mark.parametrize("slenderness", [10, 1000])
def test_flat_and_nearly_incompressible(slenderness: float) -> None:
    found = orders(lambda n: wave(ELEMENTS["quadratic"], n, slenderness, 0.4999), (4, 8, 16))[-1]
    assert found == pytest.approx(4.0, abs=0.2), f"order {found:.2f}"


@pytest.mark.parametrize("slenderness", [10, 1000])
def test_flat_with_triangles(slenderness: float) -> None:
    """The same order, or more where triangles across the wave add to the error of coarse meshes."""
    found = orders(lambda n: wave(ELEMENTS["quadratic"], n, slenderness, 0.3, triangles=True), (4, 8, 16))[-1]
    print(f"{found:.2f}")
    assert found > 3.8, f"order {found:.2f}"


def test_curved_with_triangles() -> None:
    found = orders(lambda n: tube(ELEMENTS["quadratic"], n, 10, triangles=True), (8, 16, 32))[-1]
    print(f"{found:.2f}")
    assert found > 3.7, f"order {found:.2f}"


def tube(element: ElementType, elements: int, slenderness: float, nu: float = 0.45, triangles: bool = False) -> float:
    """Work on half a ring in plane strain, magnetised along its circumference, between planes of symmetry."""
    thickness = 1.0 / slenderness
    mesh = ms.mesh.cylinder(1.0, 0.1, (elements, 1), angle=(-90, 90), axis=(0, 1, 0), zero=(1, 0, 0))
    mesh = (split(mesh, "rising") if triangles else mesh).select_nodes("equator", x1=1.0, x3=0)
    magnets = ms.remanence.circumferential(1.0, axis=(0, 1, 0), towards=(0, 0, 1))
    shell = ms.Shell(mesh, thickness, rubber(nu, thickness), magnets, element)
    supports = [
        *(ms.SymmetryPlane(side, (0, 1, 0)) for side in ("start", "end")),
        *(ms.SymmetryPlane(side, (1, 0, 0)) for side in ("angle-start", "angle-stop")),
        ms.Prescribe("equator", "u", 3),
    ]
    field = ms.UniformField((0, 0, SMALL * thickness**2 * MU_0))
    return respond(ms.Model(shell, supports, field)).work


@pytest.mark.parametrize("element", ELEMENTS.values(), ids=ELEMENTS)
def test_curved(element: ElementType) -> None:
    """R/h = 10, elements down to the thickness."""
    expected = 4.0 if element.rest_nodes == 8 else 2.0
    found = orders(lambda n: tube(element, n, 10), (8, 16, 32))[-1]
    print(f"{found:.2f}")
    assert found == pytest.approx(expected, abs=0.3), f"order {found:.2f}, expected {expected}"


def test_curved_and_thin_is_of_second_order_with_a_small_error() -> None:
    """R/h = 1000: nothing but bending is left, and the arc is known to θ²/24 (see the ring): second order.

    What is kept of the fourth order is the size of the error: a tenth of that of the element of the source.
    """
    ours, source = ([tube(ELEMENTS[name], n, 1000) for n in (16, 32)] for name in ("quadratic", "paper"))
    limit = (4.0 * ours[1] - ours[0]) / 3.0
    errors = [abs(values[0] / limit - 1.0) for values in (ours, source)]
    print(errors)
    assert errors[0] < (np.pi / 16) ** 2 / 12.0, f"{errors}"
    assert errors[0] < 0.1 * errors[1], f"{errors}"
