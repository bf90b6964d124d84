"""The tangent of every load against differences of its forces, at crumpled states."""

from __future__ import annotations

import numpy as np
from battery import each_element, for_element

from loads.cases import CASES, MESHES, crumpled, each_case, each_patch, moved, on_mesh, product
from magshell.shell.unknowns import COMPONENTS

CURVED = MESHES["curved patch"]


def difference(load, state, increment, step):
    """Minus the derivative of the forces along an increment, to second order in the step."""
    ahead, behind = (load.forces(moved(state, sign * step * increment)) for sign in (1.0, -1.0))
    return -(ahead - behind) / (2.0 * step)


def increment_of(mesh, seed):
    return np.random.default_rng(seed).uniform(-1.0, 1.0, (len(mesh.points), COMPONENTS))


@each_element
@each_patch
@each_case
def test_tangent(case, mesh, element):
    """A step of 1e-4 leaves 1e-8 of truncation, times third derivatives of the order of one."""
    mesh = for_element(mesh, element)
    load, state, increment = on_mesh(case, mesh, element), crumpled(mesh, 1), increment_of(mesh, 2)
    numeric = difference(load, state, increment, 1e-4)
    error = np.abs(numeric - product(load, state, increment)).max()
    scale = max(np.abs(numeric).max(), np.abs(load.forces(state)).max())
    assert error < 1e-7 * scale, f"{error / scale:.1e}"


@each_case
def test_the_difference_converges_with_its_second_order(case):
    """To the tangent, not merely near it; differences of quadratic forces and of constant ones are exact."""
    load, state, increment = on_mesh(case, CURVED), crumpled(CURVED, 3), increment_of(CURVED, 4)
    exact, size = product(load, state, increment), np.abs(load.forces(state)).max()
    coarse, fine = (np.abs(difference(load, state, increment, h) - exact).max() / size for h in (2e-2, 1e-2))
    polynomial = not load.pairs or case.load.kind == "pressure"
    if polynomial:
        assert coarse < 1e-12, f"{coarse:.1e}"
    else:
        order = np.log2(coarse / fine)
        assert abs(order - 2.0) < 0.02, f"order {order:.3f}, errors {coarse:.1e}, {fine:.1e}"


@each_case
def test_no_tangent_beyond_the_pairs(case):
    """Fields that the pairs do not name do not change the forces."""
    load, state, increment = on_mesh(case, CURVED), crumpled(CURVED, 5), increment_of(CURVED, 6)
    forces = load.forces(state)
    columns = {"u": slice(0, 3), "w": slice(3, 6), "phi": slice(6, 7), "omega": slice(7, 10)}
    for field, own in columns.items():
        alone = np.zeros_like(increment)
        alone[:, own] = increment[:, own]
        changes = not np.array_equal(load.forces(moved(state, alone)), forces)
        assert changes == any(pairs.column_field == field for pairs in load.pairs), field


@each_case
def test_what_is_said_of_a_potential(case):
    """A conservative load's tangent is symmetric; the patches' pressure and all couples and followers are not."""
    load, state = on_mesh(case, CURVED), crumpled(CURVED, 7)
    one, two = increment_of(CURVED, 8), increment_of(CURVED, 9)
    forth, back = np.sum(one * product(load, state, two)), np.sum(two * product(load, state, one))
    assert load.conservative == case.conservative
    if case.conservative:
        assert forth == back
    else:
        assert abs(forth - back) > 1e-3 * max(abs(forth), abs(back))


def test_every_kind_of_load_is_here():
    from magshell.model import loads

    kinds = {getattr(getattr(loads, name), "kind", None) for name in loads.__all__} - {None}
    assert kinds == {case.load.kind for case in CASES.values()}
