"""The multifrontal solver beside SciPy's, on random patterns."""

import numpy as np
import pytest
import scipy.sparse as sp
from hypothesis import given
from hypothesis import strategies as st

from magshell.linalg import make_solver, nested_dissection
from magshell.linalg.multifrontal import schedule, solver
from magshell.linalg.multifrontal.fronts import analyse


def random_matrix(nodes, links, widths, seed, symmetric=False):
    """A matrix of blocks of given widths, coupled at random, dominated by diagonals of either sign."""
    random = np.random.default_rng(seed)
    link = random.integers(0, nodes, (links, 2))
    graph = sp.csr_array((np.ones(len(link)), link.T), shape=(nodes, nodes))
    graph = sp.csr_array(graph + graph.T + sp.eye_array(nodes))
    graph.data[:] = 1.0
    order = nested_dissection(graph)
    width = random.choice(widths, nodes)
    owner = np.repeat(np.arange(nodes), width)
    pattern = sp.csc_array(graph[order][:, order][owner][:, owner])
    pattern.sort_indices()
    matrix = pattern.copy()
    matrix.data = random.normal(size=pattern.nnz)
    if symmetric:
        matrix = sp.csc_array(matrix + matrix.T)
    size = matrix.shape[0]
    largest = abs(matrix).sum(axis=1) + 1.0
    return sp.csc_array(matrix + sp.diags_array(largest * random.choice([-1.0, 1.0], size))), size


def grid(nodes, seed=0, symmetric=False):
    """A matrix of a plane grid of nodes of seven unknowns."""
    line = sp.diags_array([np.ones(nodes)] * 3, offsets=[-1, 0, 1], shape=(nodes, nodes))
    graph = sp.csr_array(sp.kron(line, line))
    order = nested_dissection(graph)
    owner = np.repeat(np.arange(nodes**2), 7)
    matrix = sp.csc_array(graph[order][:, order][owner][:, owner])
    matrix.sort_indices()
    matrix.data = np.random.default_rng(seed).normal(size=matrix.nnz)
    if symmetric:
        matrix = sp.csc_array(matrix + matrix.T)
    return sp.csc_array(matrix + sp.diags_array(abs(matrix).sum(axis=1)))


patterns = {
    "nodes": st.integers(1, 40),
    "links": st.integers(0, 120),
    "widths": st.lists(st.integers(1, 9), min_size=1, max_size=3),
    "seed": st.integers(0, 2**31),
    "symmetric": st.booleans(),
}


@given(**patterns)
def test_solutions_and_pivots_of_random_patterns(nodes, links, widths, seed, symmetric):
    """Backward errors of the system and of the transposed one; as many negative pivots as SciPy finds."""
    matrix, size = random_matrix(nodes, links, widths, seed, symmetric)
    factors = make_solver("multifrontal").factorise(matrix)
    right_side = np.random.default_rng(seed).normal(size=size)
    for solve, same in ((factors.solve, matrix), (factors.solve_transposed, matrix.T)):
        error = np.abs(same @ solve(right_side) - right_side).max()
        assert error < 1e-12, f"{error:.1e}"
    assert factors.negative_pivots() == make_solver("superlu").factorise(matrix).negative_pivots()


@given(**patterns)
def test_every_entry_has_its_place(nodes, links, widths, seed, symmetric):
    """The symbolic phase: each pivot in one front, each entry of the matrix in one place of the panels."""
    matrix, size = random_matrix(nodes, links, widths, seed, symmetric)
    fronts, entries = analyse(matrix.indptr, matrix.indices)
    assert np.array_equal(np.sort(fronts.order), np.arange(size))
    assert fronts.begin[-1] == size
    width = np.diff(entries.starts)
    column = np.repeat(np.arange(len(width)), np.diff(entries.pointer))
    places = []
    for pair in range(len(entries.rows)):
        i, j = np.ogrid[: width[entries.rows[pair]], : width[column[pair]]]
        upper = entries.target[pair] < 0
        first = ~entries.target[pair] if upper else entries.target[pair]
        places += [(upper, at) for at in (first + i * entries.row_step[pair] + j * entries.column_step[pair]).ravel()]
    assert len(set(places)) == len(places) == matrix.nnz
    for upper, sizes in ((False, fronts.lower), (True, fronts.upper)):
        assert all(0 <= at < sizes[-1] for side, at in places if side == upper)


def test_a_symmetric_matrix_needs_half_the_room():
    plain, symmetric = (solver.Multifrontal().factorise(grid(12, symmetric=same)) for same in (False, True))
    assert plain._factors.upper.size > 0
    assert symmetric._factors.upper.size == 0


def test_memory_that_serves_again_takes_the_new_matrix_as_it_is():
    """One front has no upper panel, so that symmetric and other matrices fit the same memory."""
    one = make_solver("multifrontal")
    right_side = np.arange(1.0, 4.0)
    matrix = sp.csc_array([[4.0, 1.0, 2.0], [1.0, 5.0, 1.0], [2.0, 1.0, 6.0]])
    one.factorise(matrix).solve(right_side)
    matrix.data[:] = [4.0, 3.0, 2.0, -1.0, 5.0, 1.0, 0.5, -2.0, 6.0]
    factors = one.factorise(matrix)
    assert not factors._factors.symmetric
    once = factors._solve_once(factors.scale * right_side, False)
    assert np.allclose(factors.matrix @ once, factors.scale * right_side, rtol=1e-14)


def test_the_same_bits_with_any_number_of_threads(monkeypatch):
    """On a matrix that is divided into tasks."""
    monkeypatch.setattr(schedule, "SMALL", 1e4)
    matrix = grid(20)
    right_side, solutions = np.ones(matrix.shape[0]), []
    for threads in (1, 2, 5):
        monkeypatch.setattr(solver, "threads", lambda threads=threads: threads)
        one = solver.Multifrontal()
        for _ in range(3):
            solutions.append(one.factorise(matrix).solve(right_side))
        assert len(one._analysis.schedule.tasks) > 5
    assert all(np.array_equal(solutions[0], other) for other in solutions[1:])


def test_tasks_and_top_are_all_fronts_once():
    matrix = grid(20)
    fronts, _ = analyse(matrix.indptr, matrix.indices)
    for small in (1e4, 1e12):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(schedule, "SMALL", small)
            divided = schedule.schedule_of(fronts)
        everyone = np.concatenate([*divided.tasks, divided.top])
        assert np.array_equal(np.sort(everyone), np.arange(len(fronts.parent)))
        assert (len(divided.tasks) > 5) == (small == 1e4)


@pytest.mark.parametrize("small", [0.0, 1e-13], ids=["zero", "tiny"])
def test_a_vanishing_pivot_is_left_to_a_solver_that_exchanges_rows(small):
    """[0 1; 1 0] has no LU without exchanges, and a bad one with a tiny pivot; both have good solutions."""
    matrix = sp.csc_array([[1.0, 1.0, 0.0], [1.0, 1.0, 2.0], [0.0, 2.0, 3.0]])
    matrix.setdiag([small, small, 3.0])
    factors = make_solver("multifrontal").factorise(matrix)
    solution = factors.solve(np.array([1.0, 2.0, 3.0]))
    assert np.allclose(matrix @ solution, [1.0, 2.0, 3.0], rtol=1e-13)
    dense = np.linalg.solve(matrix.toarray().T, [1.0, 2.0, 3.0])
    assert np.allclose(factors.solve_transposed(np.array([1.0, 2.0, 3.0])), dense, rtol=1e-12)


def test_a_loss_of_digits_is_made_good_by_refinement():
    """A pivot of 1e-7 costs as many digits, which two rounds bring back."""
    random = np.random.default_rng(3)
    matrix = random.normal(size=(30, 30))
    matrix[0, 0] = 1e-7
    matrix = sp.csc_array(matrix)
    factors = make_solver("multifrontal").factorise(matrix)
    right_side = random.normal(size=30)
    once = factors._solve_once(factors.scale * right_side, False)
    lost = np.abs(factors.matrix @ once - factors.scale * right_side).max()
    assert lost > 1e-12, f"{lost:.1e}: nothing to refine"
    error = np.abs(matrix @ factors.solve(right_side) - right_side).max()
    assert error < 1e-12, f"{error:.1e}"
    assert factors._other is None


@pytest.mark.parametrize("entries", [[[1.0, 2.0], [0.0, 1.0]], [[0.0, 2.0], [2.0, 1.0]], [[1.0, 0.0], [3.0, 1.0]]])
def test_a_pattern_that_is_not_symmetric_is_refused(entries):
    with pytest.raises(ValueError, match="must be symmetric"):
        make_solver("multifrontal").factorise(sp.csc_array(entries))


def test_another_pattern_is_analysed_anew():
    one = make_solver("multifrontal")
    for size in (5, 7):
        matrix = grid(size)
        right_side = np.ones(matrix.shape[0])
        assert np.abs(matrix @ one.factorise(matrix).solve(right_side) - right_side).max() < 1e-12
