"""Forces of springs: shares as those of loads, their potential, their tangent, also through rigid bodies."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from battery import COUPLING, PATCHES, Unsupported, each_element, example, for_element
from loads.bodies import grouped
from loads.cases import applied as load_on
from loads.cases import at_rest, crumpled, shell_of

import magshell as ms
from magshell.equations.discretisation import Discretisation
from magshell.equations.instant import Instant
from magshell.model.places import Places
from magshell.model.rigid_body import RigidBody
from magshell.model.rows import rows_of
from magshell.model.springs import SPRINGS

CURVED = grouped(PATCHES["curved patch"]())
FLAT = grouped(PATCHES["flat patch"]())
U = np.array([0.3, -0.2, 0.5])
N = np.array([0.6, 0.0, 0.8])
K = 1.7
SPRING = {
    "in all, nodes": ms.Spring("scattered", stiffness=K),
    "in all, edges": ms.Spring("top", stiffness=K),
    "in all, elements": ms.Spring("half", stiffness=K, direction=N),
    "per length": ms.Spring("top", per_length=K, direction=3.0 * N),
    "per area": ms.Spring("half", per_area=K),
}
each_spring = pytest.mark.parametrize("spring", SPRING.values(), ids=SPRING)


def on(spring, mesh, element="quadratic"):
    shell = shell_of(mesh, element)
    return spring.applied(shell, Places(mesh, rows_of(shell).carriers))


def increment_of(mesh, seed):
    return np.random.default_rng(seed).uniform(-1.0, 1.0, (len(mesh.points), 3))


@each_element
@each_spring
def test_where_the_displacement_is_uniform_they_pull_as_a_load_does(spring, element):
    """Minus the forces of a `Force` of the size of the whole, or of a `Traction`, on the same group."""
    mesh = for_element(CURVED, element)
    state = at_rest(mesh)._replace(u=np.tile(U, (len(mesh.points), 1)))
    pull = K * (U if spring.direction is None else (U @ N) * N)
    if spring.per_area is not None:
        load = ms.Traction(spring.group, pull)
    else:
        s, weights = np.polynomial.legendre.leggauss(40)
        start, end, middle = np.moveaxis(mesh.points[mesh.edge_groups["top"]], 1, 0)
        slope = 0.5 * (end - start)[:, None] + (start + end - 2.0 * middle)[:, None] * s[:, None]
        length = float((np.linalg.norm(slope, axis=-1) @ weights).sum())
        load = ms.Force(spring.group, pull * (length if spring.per_length is not None else 1.0))
    expected = -load_on(load, shell_of(mesh, element)).forces(state)
    error = np.abs(on(spring, mesh, element).forces(state) - expected).max() / np.abs(expected).max()
    assert error < 1e-10, f"{error:.1e}"


@each_element
@each_spring
def test_forces_and_tangent_are_derivatives_of_the_energy(spring, element):
    """A quadratic energy: central differences are exact."""
    mesh = for_element(CURVED, element)
    springs, state, du = on(spring, mesh, element), crumpled(mesh, 1), increment_of(mesh, 2)
    ahead, behind = (state._replace(u=state.u + sign * du) for sign in (1.0, -1.0))
    slope = 0.5 * (springs.energy(ahead) - springs.energy(behind))
    assert -np.vdot(springs.forces(state)[:, :3], du) == pytest.approx(slope, rel=1e-12)
    curved = springs.energy(ahead) + springs.energy(behind) - 2.0 * springs.energy(state)
    (pairs,), (blocks,) = springs.pairs, springs.stiffness(state)
    product = np.einsum("ni,nij,nj->", du[pairs.rows], blocks, du[pairs.columns])
    assert product == pytest.approx(curved, rel=1e-12)
    assert curved > 0.0
    assert springs.energy(at_rest(mesh)) == 0.0
    assert not np.any(springs.forces(at_rest(mesh)))
    assert not np.any(springs.forces(state)[:, 3:])


def test_a_linear_displacement_of_elements():
    """½ ∫ k u² of u = a · x on flat elements with straight sides, by quadrature of its own."""
    a = np.array([0.3, -0.2, 0.0])
    state = at_rest(FLAT)._replace(u=np.outer(FLAT.points @ a, [0.0, 0.0, 1.0]))
    xi, weights = np.polynomial.legendre.leggauss(4)
    expected = 0.0
    for corners in FLAT.points[FLAT.elements[FLAT.element_groups["half"], :4]]:
        for s, ws in zip(xi, weights, strict=True):
            for t, wt in zip(xi, weights, strict=True):
                sides = np.array([1 - s, 1 + s, 1 + s, 1 - s]), np.array([1 - t, 1 - t, 1 + t, 1 + t])
                x = 0.25 * (sides[0] * sides[1]) @ corners
                x_s = 0.25 * (np.array([-1, 1, 1, -1]) * sides[1]) @ corners
                x_t = 0.25 * (sides[0] * np.array([-1, -1, 1, 1])) @ corners
                expected += 0.5 * K * (x @ a) ** 2 * np.linalg.norm(np.cross(x_s, x_t)) * ws * wt
    assert on(ms.Spring("half", per_area=K), FLAT).energy(state) == pytest.approx(expected, rel=1e-12)


SUPPORTS = (ms.SymmetryPlane("left", (1.0, 2.0, -0.5)),)


def body(rigid=(), **given):
    shell = dataclasses.replace(shell_of(CURVED), rigid=rigid)
    made = Unsupported(shell, ms.UniformField((0, 0, 0)), example(COUPLING), **given)
    return Discretisation(made, lambda graph: np.arange(graph.shape[0]))


@pytest.mark.parametrize("rigid", [(), (RigidBody("top", "handle"),)], ids=["free", "on a rigid body"])
def test_assembled(rigid):
    """Residual and tangent of a body with springs less those without: at oblique frames and through a rigid body.

    The residual is the derivative of the energy along increments of the free unknowns, and the tangent that of it.
    """
    springs = (*SPRING.values(), ms.Spring("handle", stiffness=0.3 * K)) if rigid else tuple(SPRING.values())
    supports = () if rigid else SUPPORTS
    bare, sprung = (body(supports=supports, rigid=rigid, springs=one) for one in ((), springs))
    away = sprung.direction(np.random.default_rng(3).uniform(-0.1, 0.1, sprung.dofs))
    state = sprung.moved(sprung.undeformed(), away)
    at = Instant(state, sprung.model.loading(0.0))
    found, without = sprung.assemble(at), bare.assemble(at)
    K_springs = (found.matrix - without.matrix).toarray()
    r_springs = without.right_side - found.right_side
    rng, step = np.random.default_rng(4), 1e-4
    for _ in range(3):
        increment = rng.uniform(-1.0, 1.0, sprung.dofs)
        sprung.assemble(at)
        ahead, behind = (sprung.moved(state, sprung.direction(sign * step * increment)) for sign in (1.0, -1.0))
        slope = (sprung.springs.energy(ahead) - sprung.springs.energy(behind)) / (2.0 * step)
        assert r_springs @ increment == pytest.approx(slope, rel=1e-6, abs=1e-6)
        change = sprung.springs.energy(ahead) + sprung.springs.energy(behind) - 2.0 * sprung.springs.energy(state)
        assert increment @ K_springs @ increment == pytest.approx(change / step**2, rel=1e-5)
    assert np.abs(K_springs - K_springs.T).max() < 1e-13 * np.abs(K_springs).max()


def test_every_kind_is_here():
    assert {spring.kind for spring in SPRING.values()} | {"torsion"} == set(SPRINGS)  # test_torsion.py
