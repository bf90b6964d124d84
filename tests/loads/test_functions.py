"""What loads over elements work on: the nodes and the bubble that follows them."""

from __future__ import annotations

import numpy as np
import pytest
from battery import TYPES, each_element, for_element, patch

from loads.cases import MESHES, shell_of
from magshell.model.loads.distribution import nodal_areas
from magshell.shell.loaded import loaded
from magshell.shell.shape_functions import NODES
from magshell.shell.triangle import REPEATED

PARENT = np.random.default_rng(1).uniform(-1.0, 1.0, (20, 2))
BUBBLED = {name: element for name, element in TYPES.items() if element.bubble}
PLAIN = {name: element for name, element in TYPES.items() if not element.bubble}


def on(mesh, element, parent):
    return loaded(element, parent, mesh.points[mesh.elements])


@each_element
@pytest.mark.parametrize("mesh", MESHES.values(), ids=MESHES)
def test_they_add_up_to_one_and_are_the_nodes_own(mesh, element):
    mesh = for_element(mesh, element)
    values, derivatives = on(mesh, element, PARENT)
    assert np.abs(values.sum(axis=2) - 1.0).max() < 1e-14
    assert np.abs(derivatives.sum(axis=3)).max() < 1e-13
    at_nodes = on(mesh, element, NODES).values
    assert np.abs(at_nodes[~mesh.triangles] - np.eye(8)).max(initial=0.0) < 1e-15
    once = np.eye(8)
    once[REPEATED] = once[2]
    assert np.abs(at_nodes[mesh.triangles] - once).max(initial=0.0) < 1e-15


@each_element
def test_linear_fields_on_elements_with_straight_sides(element):
    mesh = for_element(MESHES["flat patch"], element)
    values, _ = on(mesh, element, PARENT)
    x, exact = mesh.points[mesh.elements], element.functions(8, PARENT, mesh.points[mesh.elements]).values
    error = np.abs(values @ x - exact @ x).max()
    assert error < 1e-15, f"{error:.1e}"


@pytest.mark.parametrize("element", PLAIN.values(), ids=PLAIN)
def test_without_a_bubble_they_are_the_elements_own(element):
    mesh = MESHES["curved patch"]
    own = element.functions(8, PARENT, mesh.points[mesh.elements])
    assert np.array_equal(on(mesh, element, PARENT).values, own.values)
    assert np.array_equal(on(mesh, element, PARENT).derivatives, own.derivatives)


@pytest.mark.parametrize("element", BUBBLED.values(), ids=BUBBLED)
@pytest.mark.parametrize("mesh", MESHES.values(), ids=MESHES)
def test_the_bubble_is_in_equilibrium(mesh, element):
    """Strains of an even tension at the element's points: their work on the bubble's vanishes."""
    mesh = for_element(mesh, element)
    X = mesh.points[mesh.elements]
    points, weights = element.integration(X)
    u = np.random.default_rng(2).uniform(-1.0, 1.0, 8)
    A = np.einsum("epan,enx->epax", element.functions(8, points, X).derivatives, X)
    dual, area = np.linalg.pinv(A), np.linalg.norm(np.cross(A[:, :, 0], A[:, :, 1]), axis=2) * weights
    gradient = np.einsum("epxa,epan,n->epx", dual, on(mesh, element, points).derivatives, u)
    of_bubble = np.einsum("epxa,epa->epx", dual, element.bubbles(points, X).derivatives)
    work = np.einsum("ep,epx,epx->e", area, gradient, of_bubble)
    assert np.abs(work).max() < 1e-14


def test_shares_of_a_square():
    shell = shell_of(patch((1, 1)))
    parts = nodal_areas(shell, np.array([0]))[shell.mesh.elements[0]]
    assert parts == pytest.approx([1.0 / 12.0] * 4 + [1.0 / 6.0] * 4, rel=1e-14)
