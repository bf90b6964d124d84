"""Pressure: its resultants by Stokes' theorem from the rim alone, its potential, its symmetry."""

from __future__ import annotations

import numpy as np
import pytest
from battery import each_element, for_element, with_points

import magshell as ms
from loads.cases import applied, at_rest, crumpled, each_patch, moved, product, shell_of
from magshell.mesh import Mesh
from magshell.mesh.edges import find_edges
from magshell.shell.elements import QUADRATIC
from magshell.shell.loaded import loaded
from magshell.shell.shape_functions import gauss_legendre
from magshell.shell.unknowns import COMPONENTS

P = 1.7


def whole(mesh):
    """The same mesh with one more element group, of all."""
    elements = {**mesh.element_groups, "all": np.arange(len(mesh.elements))}
    return Mesh(mesh.points, mesh.elements, elements, mesh.edge_groups, mesh.node_groups)


def box(count=2):
    """The surface of a cube of side 2 about the origin, so many elements along an edge, normals outward."""
    x = np.array([[-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]])
    quarters = [np.eye(3), [[0, 0, 1], [0, 1, 0], [-1, 0, 0]], [[1, 0, 0], [0, 0, 1], [0, -1, 0]]]
    turns = [np.array(turn) for turn in quarters]
    turns += [np.diag([1, -1, -1]) @ turn if i == 0 else turn.T for i, turn in enumerate(turns)]
    return whole(ms.mesh.blocks({f"face {i}": x @ turn.T for i, turn in enumerate(turns)}, (count, count)))


def ball(count=2):
    """The box blown up to a sphere of radius 1."""
    mesh = box(count)
    return with_points(mesh, mesh.points / np.linalg.norm(mesh.points, axis=1, keepdims=True))


CLOSED = {"box": box(), "ball": ball()}
each_closed = pytest.mark.parametrize("mesh", CLOSED.values(), ids=CLOSED)


def pressure(mesh, element, group="all"):
    return applied(ms.Pressure(group, P), shell_of(mesh, element))


def rim_integrals(mesh, x, group):
    """½ ∮ x × dx and -½ ∮ x² dx along the rim of a group, each side the parabola through its three nodes."""
    edges = find_edges(mesh.elements[mesh.element_groups[group]])
    start, end, middle = (x[edges.sides[edges.boundary][:, i]] for i in range(3))
    s, weights = np.polynomial.legendre.leggauss(3)  # degree 5: x² dx is of that degree
    at = [0.5 * s * (s - 1.0), 0.5 * s * (s + 1.0), 1.0 - s**2]
    slope = [s - 0.5, s + 0.5, -2.0 * s]
    nodes = np.stack([start, end, middle])
    X = np.einsum("np,nex->epx", at, nodes)
    dX = np.einsum("np,nex,p->epx", slope, nodes, weights)
    area = 0.5 * np.cross(X, dX).sum(axis=(0, 1))
    return area, -0.5 * (np.sum(X * X, axis=2, keepdims=True) * dX).sum(axis=(0, 1))


def volume(mesh, element, state):
    """Enclosed volume ⅓ ∫ x · a_1 × a_2 at 6 × 6 points."""
    parent, weights = gauss_legendre(6)
    functions = loaded(element, parent, mesh.points[mesh.elements])
    x = (mesh.points + state.u)[mesh.elements]
    a = np.einsum("epan,enx->apex", functions.derivatives, x)
    return np.einsum("p,epn,enx,pex->", weights, functions.values, x, np.cross(a[0], a[1])) / 3.0


@each_element
@each_patch
def test_resultants_are_those_of_the_rim(mesh, element):
    """∫ da = ½ ∮ x × dx and ∫ x × da = -½ ∮ x² dx hold for any surface on the rim, crumpled or not."""
    mesh = for_element(mesh, element)
    state = crumpled(mesh, 1)
    x, F = mesh.points + state.u, pressure(mesh, element, "half").forces(state)
    assert not np.any(F[:, 3:])
    area, moment = rim_integrals(mesh, x, "half")
    size = np.abs(F).sum()
    error = np.abs(F[:, :3].sum(axis=0) - P * area).max() / size
    assert error < 1e-15, f"force: {error:.1e}"
    error = np.abs(np.cross(x, F[:, :3]).sum(axis=0) - P * moment).max() / (size * mesh.size)
    assert error < 1e-15, f"moment: {error:.1e}"


@each_element
def test_a_cylinder_and_its_lids(element):
    """A whole tube has two rims: the pressures on the lids through them balance the tube's, crumpled or not."""
    mesh = for_element(whole(ms.mesh.cylinder(1.0, 1.5, (6, 2))), element)
    for state in (at_rest(mesh), crumpled(mesh, 2)):
        F = pressure(mesh, element).forces(state)[:, :3]
        area, moment = rim_integrals(mesh, mesh.points + state.u, "all")
        size = np.abs(F).sum()
        assert np.abs(F.sum(axis=0) - P * area).max() < 1e-15 * size
        assert np.abs(np.cross(mesh.points + state.u, F).sum(axis=0) - P * moment).max() < 1e-15 * size * mesh.size


@each_element
@each_closed
def test_a_closed_surface_has_no_resultant(mesh, element):
    mesh = for_element(mesh, element)
    load = pressure(mesh, element)
    assert load.conservative
    state = crumpled(mesh, 3)
    F = load.forces(state)[:, :3]
    assert np.abs(F.sum(axis=0)).max() < 1e-15 * np.abs(F).sum()
    assert np.abs(np.cross(mesh.points + state.u, F).sum(axis=0)).max() < 1e-15 * np.abs(F).sum() * mesh.size


def test_a_closed_surface_that_is_pushed_both_ways_has_no_potential():
    """One side of the box faces inward: the pressure on it is not that of the enclosed volume."""
    box = CLOSED["box"]
    rows = box.elements.copy()
    side = box.elements_of("face 0")
    rows[side] = rows[side][:, [0, 3, 2, 1, 7, 6, 5, 4]]
    turned = ms.mesh.Mesh(box.points, rows, box.element_groups)
    assert applied(ms.Pressure("all", P), shell_of(box)).conservative
    assert not applied(ms.Pressure("all", P), shell_of(turned)).conservative


def test_positive_pressure_pushes_along_the_director():
    """The box's normals point outward: it is blown up, by p times the area of a side on each."""
    mesh = CLOSED["box"]
    F = applied(ms.Pressure("face 0", P), shell_of(mesh)).forces(at_rest(mesh))[:, :3]
    assert F.sum(axis=0) == pytest.approx([0.0, 0.0, 4.0 * P], rel=1e-14, abs=1e-14)


@each_element
@each_closed
def test_the_potential_is_the_pressure_times_the_enclosed_volume(mesh, element):
    """The volume V is cubic in the positions: its difference along δ is 2 h V'δ + 2 h³ V(δ), exactly."""
    mesh = for_element(mesh, element)
    step, load, state = 0.1, pressure(mesh, element), crumpled(mesh, 4)
    increment = np.random.default_rng(5).uniform(-1.0, 1.0, (len(mesh.points), COMPONENTS))
    ahead, behind = (volume(mesh, element, moved(state, sign * step * increment)) for sign in (1.0, -1.0))
    of_increment = volume(mesh, element, state._replace(u=increment[:, :3] - mesh.points))
    slope = (ahead - behind) / (2.0 * step) - step**2 * of_increment
    found = np.sum(load.forces(state) * increment)
    assert found == pytest.approx(P * slope, rel=1e-12), found / (P * slope) - 1.0


@each_element
def test_the_volume_of_the_ball(element):
    """The potential is that of a ball: eight nodes lack ξ²η² of the sphere's height, an error of the fourth order.

    What follows the nodes inside an element with a bubble lies lower by a part of the arc's rise, of the second.
    """
    counts, errors = (6, 12), []
    for count in counts:
        mesh = for_element(ball(count), element)
        errors.append(1.0 - volume(mesh, element, at_rest(mesh)) / (4.0 / 3.0 * np.pi))
    order = np.log2(errors[0] / errors[1])
    # the next term is smaller by the square of an element's angle
    expected = 2.0 if element.bubble else 4.0
    assert order == pytest.approx(expected, abs=(0.5 * np.pi / counts[0]) ** 2), f"order {order:.3f}, errors {errors}"


def skew_part(mesh, load, state):
    """Largest entry of K - Kᵀ for each pair of nodes, over the largest of K: (nodes, nodes)."""
    count = len(mesh.points)
    K = np.zeros((count, count, 3, 3))
    (pairs,), (blocks,) = load.pairs, load.stiffness(state)
    np.add.at(K, (pairs.rows, pairs.columns), blocks)
    skew = K - K.transpose(1, 0, 3, 2)
    return np.abs(skew).max(axis=(2, 3)) / np.abs(K).max()


@each_element
@each_closed
def test_symmetric_on_a_closed_surface(mesh, element):
    """To the round-off of sums over 3 × 3 points, or with triangles 5 × 5, where derivatives are larger too."""
    mesh = for_element(mesh, element)
    found = skew_part(mesh, pressure(mesh, element), crumpled(mesh, 6)).max()
    assert found < (5e-15 if mesh.triangles.any() else 1e-15), f"{found:.1e}"


@each_element
def test_symmetric_but_between_nodes_of_the_rim(element):
    """So also where the rim is held. Between its nodes it is not: such a load has no potential."""
    mesh = for_element(whole(ms.mesh.cylinder(1.0, 1.5, (6, 3))), element)
    load = pressure(mesh, element)
    assert not load.conservative
    skew = skew_part(mesh, load, crumpled(mesh, 7))
    rim = np.zeros(len(mesh.points), dtype=bool)
    rim[np.concatenate([mesh.edge_groups["start"].ravel(), mesh.edge_groups["end"].ravel()])] = True
    assert skew[np.ix_(rim, rim)].max() > 0.1
    skew[np.ix_(rim, rim)] = 0.0
    assert skew.max() < 1e-15, f"{skew.max():.1e}"


def test_the_work_on_an_increment_is_that_of_the_tangent():
    """Blocks at the pairs and forces are of one load: the forces are quadratic, so one product gives their change."""
    mesh = CLOSED["ball"]
    load, state = pressure(mesh, QUADRATIC), crumpled(mesh, 8)
    increment = np.random.default_rng(9).uniform(-0.5, 0.5, (len(mesh.points), COMPONENTS))
    there = moved(state, increment)
    mean = 0.5 * (product(load, state, increment) + product(load, there, increment))
    change = load.forces(there) - load.forces(state)
    error = np.abs(change + mean).max() / np.abs(change).max()
    assert error < 1e-13, f"{error:.1e}"
