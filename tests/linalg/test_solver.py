"""Direct solvers on shell matrices: badly scaled, unsymmetric, singular; elimination orders."""

from __future__ import annotations

import logging
import sys

import numpy as np
import pytest
import scipy.sparse as sp
from battery import MATERIAL, PATCHES, example, free_body, patch, random_state

from magshell.equations.instant import Instant
from magshell.errors import InputError
from magshell.linalg import SOLVERS, SingularMatrix, make_solver, nested_dissection
from magshell.linalg.factorisation import scaled
from magshell.model.supports import Clamp, SimpleSupport


def solver_or_skip(name):
    if name == "pardiso":
        pytest.importorskip("pypardiso", reason="pypardiso is not installed")
    return make_solver(name)


each_solver = pytest.mark.parametrize("name", SOLVERS)


def thin_strip(supports):
    """Elements of 1 mm of a strip of 20 µm, in SI units: entries of its matrix range over many powers of ten."""
    mesh = patch((6, 2), distortion=0.1, map_plane=lambda plane: 1e-3 * plane)
    material = example(MATERIAL)._replace(
        shear_modulus=3e5, lame_lambda=7e6, coupling_modulus=3e4, length_scale=2e-6
    )  # fmt: skip
    return free_body(mesh, material, thickness=2e-5, supports=supports, ordering=nested_dissection)


@each_solver
def test_badly_scaled_shell_matrix(name):
    """Backward error |A x - b| over |A| |x| + |b|, row by row: of the order of round-off whatever the rows' units."""
    matrix = thin_matrix((Clamp("left"),))
    sizes = np.abs(matrix.data[matrix.data != 0.0])
    assert sizes.max() / sizes.min() > 1e15, f"spread {sizes.max() / sizes.min():.1e}: this matrix is not badly scaled"
    factors = solver_or_skip(name).factorise(matrix)
    for seed in range(3):
        exact = np.random.default_rng(seed).normal(size=matrix.shape[0]) * equilibration(matrix)
        right_side = matrix @ exact
        solution = factors.solve(right_side)
        backward = np.abs(matrix @ solution - right_side) / (abs(matrix) @ np.abs(solution) + np.abs(right_side))
        assert backward.max() < 1e-12, f"backward error {backward.max():.1e}"


@each_solver
def test_unsymmetric_matrix_is_not_transposed(name):
    """The couple's tangent at a random state, solved against NumPy."""
    d = free_body(PATCHES["curved patch"](), supports=(Clamp("left"),), ordering=nested_dissection)
    matrix = d.assemble(Instant(random_state(d, 1), d.model.loading(1.0))).matrix
    dense = matrix.toarray()
    assert np.abs(dense - dense.T).max() > 1e-3
    factors = solver_or_skip(name).factorise(matrix)
    right_side = np.random.default_rng(0).normal(size=len(dense))
    for solve, same in ((factors.solve, dense), (factors.solve_transposed, dense.T)):
        expected = np.linalg.solve(same, right_side)
        error = np.abs(solve(right_side) - expected).max() / np.abs(expected).max()
        assert error < 1e-10, f"{error:.1e}"


@each_solver
def test_factors_are_values(name):
    """Later factorisations in the same pattern, as Newton's method makes them, leave earlier ones as they are."""
    d = free_body(PATCHES["curved patch"](), supports=(Clamp("left"),), ordering=nested_dissection)
    solver = solver_or_skip(name)
    right_side, made = np.ones(d.dofs), []
    for seed in (1, 2, 3):
        matrix = d.assemble(Instant(random_state(d, seed), d.model.loading(1.0))).matrix
        made.append((matrix.copy(), solver.factorise(matrix)))
    assert solver.factorisations == 3
    for matrix, factors in made:
        error = np.abs(matrix @ factors.solve(right_side) - right_side).max()
        assert error < 1e-10, f"{error:.1e}"


def stored_zero():
    matrix = sp.csc_array(np.diag([2.0, 1.0, 3.0, 1.0]))
    matrix.data[1] = 0.0
    return matrix


def equal_rows():
    return sp.csc_array([[2.0, 1.0, 0.0], [2.0, 1.0, 0.0], [0.0, 0.0, 1.0]])


def free_matrix(supports):
    mesh = patch((3, 3), distortion=0.25, keep_boundary=True)
    d = free_body(mesh, supports=supports, ordering=nested_dissection)
    return d.assemble(Instant(d.undeformed(), d.model.loading(0.0))).matrix


def thin_matrix(supports):
    d = thin_strip(supports)
    return d.assemble(Instant(d.undeformed(), d.model.loading(0.0))).matrix


SINGULAR = {
    "a node without stiffness": stored_zero,
    "two equal rows": equal_rows,
    "a free body": lambda: free_matrix(()),
    "a hinge": lambda: free_matrix((SimpleSupport("left"),)),
    "a free thin strip": lambda: thin_matrix(()),
}


def equilibration(matrix):
    """The factors by which solvers scale rows and columns."""
    return scaled(matrix).scale


def stiffness_along(matrix, vector):
    """|A v| / |v| in scaled unknowns, in which a stiffness of one is usual."""
    scale = equilibration(matrix)
    return np.linalg.norm(scale * (matrix @ vector)) / np.linalg.norm(vector / scale)


@pytest.mark.parametrize("name", ["multifrontal", "superlu"])
@pytest.mark.parametrize("make", [stored_zero, equal_rows])
def test_the_direction_without_stiffness_is_named(make, name):
    with pytest.raises(SingularMatrix) as caught:
        make_solver(name).factorise(make())
    stiffness = stiffness_along(make(), caught.value.null_vector)
    assert stiffness < 1e-8, f"stiffness {stiffness:.1e}"


@each_solver
@pytest.mark.parametrize("make", SINGULAR.values(), ids=SINGULAR)
def test_singular_matrix_is_not_solved_quietly(name, make):
    """Singular but for round-off: an error, or a solution of some 10¹³ times its load along the free direction.

    Newton's method tells the second by its size.
    """
    matrix, solver = make(), solver_or_skip(name)
    scale = equilibration(matrix)
    try:
        factors = solver.factorise(matrix)
        vector = factors.solve(np.random.default_rng(0).normal(size=len(scale)) / scale)
    except SingularMatrix as singular:
        vector = singular.null_vector
    else:
        size = np.linalg.norm(vector / scale) / np.sqrt(len(scale))
        assert size > 1e8, f"the solution is {size:.1e} times its load"
    stiffness = stiffness_along(matrix, vector)
    assert stiffness < 1e-8, f"stiffness {stiffness:.1e}"


@pytest.mark.parametrize("supports", [(Clamp("left"),), (Clamp("left"), SimpleSupport("right"))])
@each_solver
def test_a_supported_body_is_not_singular(name, supports):
    solver_or_skip(name).factorise(free_matrix(supports))
    solver_or_skip(name).factorise(thin_matrix(supports))


def test_equilibration():
    """Largest entries of the columns, many powers of ten apart, come within two of one; a zero column does no harm."""
    matrix = thin_matrix((Clamp("left"),))
    scale = sp.diags_array(equilibration(matrix))
    before, after = (abs(a).max(axis=0).toarray() for a in (matrix, scale @ matrix @ scale))
    assert before.max() / before.min() > 1e8, f"{before.max() / before.min():.1e}: this matrix is not badly scaled"
    assert after.min() > 1e-2, f"{after.min():.1e}"
    assert after.max() < 1.0 + 1e-12, f"{after.max():.1e}"
    assert np.isfinite(equilibration(stored_zero())).all()


def test_unknown_solver_is_refused_with_the_nearest_name():
    with pytest.raises(InputError, match=r"linear_solver is 'superLU'.*'superlu'"):
        make_solver("superLU")


def test_missing_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "pypardiso", None)
    with pytest.raises(InputError, match=r"pip install 'magshell\[pardiso\]'"):
        make_solver("pardiso")


# -- elimination order -----------------------------------------------------------------------------------------------


def node_graph(mesh):
    """Nodes that share an element, the diagonal included."""
    count, per_element = len(mesh.points), 8
    incidence = sp.csr_array(
        (np.ones(mesh.elements.size), mesh.elements.ravel(), np.arange(0, mesh.elements.size + 1, per_element)),
        shape=(len(mesh.elements), count),
    )
    return sp.csr_array(incidence.T @ incidence)


@pytest.mark.parametrize("counts", [(1, 1), (4, 3), (20, 5)])
def test_nested_dissection_is_a_permutation(counts):
    graph = node_graph(patch(counts))
    order = nested_dissection(graph)
    assert np.array_equal(np.sort(order), np.arange(graph.shape[0]))


def test_nodes_without_neighbours():
    assert np.array_equal(nested_dissection(sp.csr_array(np.eye(5))), np.arange(5))


def fill(matrix):
    """Nonzeros of the factors with the diagonal as pivots."""
    factors = sp.linalg.splu(
        sp.csc_array(matrix), permc_spec="NATURAL", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
    )
    return factors.L.nnz + factors.U.nnz


def test_nested_dissection_saves_fill():
    """Against nodes at random, three times at least on a plate of 24 × 24 elements."""
    pytest.importorskip("pymetis", reason="pymetis is not installed")
    graph = node_graph(patch((24, 24)))
    laplacian = sp.csc_array(sp.diags_array(graph.sum(axis=1) + 1.0) - graph)
    order = nested_dissection(graph)
    shuffled = np.random.default_rng(0).permutation(graph.shape[0])
    first, second = (fill(laplacian[by][:, by]) for by in (order, shuffled))
    assert first < second / 3, f"{first} nonzeros, at random {second}"


def test_without_metis_another_order_is_used_and_said(monkeypatch, caplog):
    monkeypatch.setitem(sys.modules, "pymetis", None)
    graph = node_graph(patch((4, 3)))
    with caplog.at_level(logging.WARNING):
        order = nested_dissection(graph)
    assert np.array_equal(np.sort(order), np.arange(graph.shape[0]))
    assert "pymetis is not installed" in caplog.text
