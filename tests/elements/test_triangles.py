"""Triangles beside quadrilaterals: locking, orders of convergence, spurious modes, and what a corner's number means.

The patterns are those of `magshell.mesh.split`. What all element types must do is tested with them elsewhere.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
import scipy.linalg

import magshell as ms
from elements.linear import SMALL, respond, rubber
from magshell.equations.discretisation import Discretisation
from magshell.equations.instant import Instant
from magshell.linalg import nested_dissection
from magshell.mesh import Mesh, split
from magshell.model.loads.distribution import nodal_areas

each_pattern = pytest.mark.parametrize("pattern", ["rising", "alternating", "crossed"])


def plate_model(mesh: Mesh, slenderness: float) -> ms.Model:
    """Quarter of a clamped square plate with a force at its centre."""
    thickness = 1.0 / slenderness
    mesh = mesh.select_nodes("centre", x1=0.5, x2=0.5)
    supports = [ms.Clamp("left"), ms.Clamp("bottom")]
    supports += [ms.SymmetryPlane("right", (1, 0, 0)), ms.SymmetryPlane("top", (0, 1, 0))]
    load = ms.Force("centre", (0, 0, SMALL * thickness**3))
    return ms.Model(ms.Shell(mesh, thickness, rubber(0.3, thickness)), supports, loads=[load])


@cache
def plate_limit(slenderness: float) -> float:
    return respond(plate_model(ms.mesh.rectangle(0.5, 0.5, (24, 24)), slenderness)).work


@each_pattern
@pytest.mark.parametrize("slenderness", [100, 1000])
def test_clamped_plate_does_not_lock(pattern: str, slenderness: float) -> None:
    """Within 1 % with four divisions of a quarter, however thin.

    Without bubble and turning field the thin one loses two thirds in rising triangles, with the bubble alone a half.
    """
    mesh = split(ms.mesh.rectangle(0.5, 0.5, (4, 4)), pattern)
    off = respond(plate_model(mesh, slenderness)).work / plate_limit(slenderness) - 1.0
    print(f"{off:.1e}")
    assert abs(off) < 0.01, f"{off:.1e}"


@pytest.mark.parametrize(("slenderness", "elements"), [(100, 16), (1000, 50)])
def test_ring_with_elements_as_long_as_the_root_of_radius_times_thickness(slenderness: float, elements: int) -> None:
    """What is left of membrane locking there: a per cent. (Longer triangles lock; quadrilaterals do not.)"""
    thickness, width = 1.0 / slenderness, 0.1
    mesh = ms.mesh.cylinder(1.0, width, (elements, 1), angle=(0, 90), axis=(0, 1, 0), zero=(1, 0, 0))
    shell = ms.Shell(split(mesh, "rising"), thickness, rubber(0.0, thickness))
    force = SMALL * thickness**3
    model = ms.Model(shell, [ms.Clamp("angle-start")], loads=[ms.Force("angle-stop", (force, 0, 0))])
    stiffness = 2.0 * width * thickness**3 / 12.0 + shell.material.length_scale**2 * thickness * width
    off = respond(model).work / (0.5 * force**2 / stiffness * (0.75 * np.pi - 2.0)) - 1.0
    print(f"{off:.1e}")
    assert abs(off) < 0.01, f"{off:.1e}"


@each_pattern
def test_vibrations_of_a_cantilevered_plate(pattern: str) -> None:
    """The first twenty modes, of bending and of the membrane, are those of a fine mesh of quadrilaterals.

    A spurious mode would be one more among them. Masses stand at the nodes, as loads over the area are shared.
    """
    found, exact = (frequencies(mesh) for mesh in (split(square(6), pattern), square(10)))
    off = found / exact - 1.0
    print(np.round(100.0 * off, 1))
    assert np.abs(off).max() < 0.05, f"{np.round(100.0 * off, 1)} %"


def square(count: int) -> Mesh:
    return ms.mesh.rectangle(1.0, 1.0, (count, count))


@cache
def frequencies(mesh: Mesh, thickness: float = 0.02) -> np.ndarray:
    """The twenty lowest, times a constant, of masses at the nodes' displacements."""
    shell = ms.Shell(mesh, thickness, rubber(0.3, thickness))
    d = Discretisation(ms.Model(shell, [ms.Clamp("left")], loads=[ms.Force("right", (0, 0, SMALL))]), nested_dissection)
    matrix = d.assemble(Instant(d.undeformed(), d.model.loading(0.0))).matrix
    assert matrix is not None
    K, mass = matrix.toarray(), np.zeros(d.dofs)
    areas = nodal_areas(shell, np.arange(len(mesh.elements)))
    assert areas.min() > 0.0
    for column in range(3):
        free = d.free[:, column]
        mass[d.numbering.number[free, column]] = areas[free]
    light = np.flatnonzero(mass == 0.0)
    heavy = np.flatnonzero(mass)
    eliminated = np.linalg.solve(K[np.ix_(light, light)], K[np.ix_(light, heavy)])
    flexible = K[np.ix_(heavy, heavy)] - K[np.ix_(heavy, light)] @ eliminated
    root = np.sqrt(mass[heavy])
    return np.sqrt(scipy.linalg.eigvalsh(flexible / np.outer(root, root), subset_by_index=[0, 19]))
