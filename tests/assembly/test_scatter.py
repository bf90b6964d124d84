"""From element matrices to equations: every entry in its place, in the nodes' own frames, whatever the numbering."""

from __future__ import annotations

import numpy as np
import pytest
from battery import (
    FIELD,
    PATCHES,
    TRIANGULAR,
    TYPES,
    dense,
    each_element,
    free_body,
    patch,
    random_increment,
    random_state,
    scaled_error,
)
from parts import PARTS, jointed
from shell import oracle

from magshell.equations.instant import Instant
from magshell.linalg import nested_dissection
from magshell.model.supports import Clamp, Prescribe, SymmetryPlane
from magshell.shell.elements import QUADRATIC

SUPPORTS = (
    SymmetryPlane("left", (1.0, 2.0, -0.5)),
    SymmetryPlane("bottom", (0.3, -1.0, 0.8)),
    Prescribe("right", "u", 2, 0.1),
    Prescribe("top", "omega", 3, -0.2),
    Prescribe("top", "phi", value=0.3),
)
ORDERINGS = {
    "as numbered": lambda graph: np.arange(graph.shape[0]),
    "at random": lambda graph: np.random.default_rng(3).permutation(graph.shape[0]),
    "nested dissection": nested_dissection,
}


def assembled(d, state):
    """Residual before and after condensation and tangent, (node, component) pairs in global axes, by plain loops."""
    size = d.free.size
    r, r_condensed, K = np.zeros(size), np.zeros(size), np.zeros((size, size))
    for e in range(len(d.mesh.elements)):
        _, r_e, K_e = oracle.element(d, state, e, FIELD)
        where = oracle.where(d, e)
        r_c, K_c, _, _ = oracle.condensed(d, r_e, K_e)
        np.add.at(r, where, r_e[: oracle.NODAL])
        np.add.at(r_condensed, where, r_c)
        np.add.at(K, np.ix_(where, where), K_c)
    return r, r_condensed, K


def frames(d):
    """Block-diagonal matrix that turns (node, component) pairs into the nodes' frames."""
    constraints = d.model.constraints
    T = np.eye(d.free.size)
    for node, field in zip(*np.nonzero(constraints.frame_of >= 0), strict=True):
        at = oracle.COLUMNS * node + (0, 3, 7)[field]
        T[at : at + 3, at : at + 3] = constraints.frames[constraints.frame_of[node, field]]
    return T


def expected(d, reference):
    """Residual before and after condensation and tangent of a body with supports, in the nodes' frames.

    Elements differentiate in the chart exp(ϑ) R̃. The couple c of a node is measured on the spins of the new state, in
    which the chart's is c + c × ϑ / 2: where exactly one rotation is held, c is its reaction, and -[c]×/2 acts between
    the two free ones. Elsewhere it vanishes in equilibrium or has no free partner, and is left out.
    """
    r, r_condensed, K = reference
    T, transport = frames(d), np.zeros_like(K)
    for node in np.flatnonzero(d.model.constraints.fixed[:, 7:10].sum(axis=1) == 1):
        at = slice(oracle.COLUMNS * node + 7, oracle.COLUMNS * node + 10)
        transport[at, at] = -0.5 * oracle.skew(r[at])
    return T @ r, T @ r_condensed, T @ (K + transport) @ T.T


CASES = {name: (element, None) for name, element in TYPES.items()}
CASES |= {f"{name} parts": (QUADRATIC, parts) for name, parts in PARTS.items()}
CASES |= {
    "parts of triangles": (TRIANGULAR, PARTS["layered"]),
    "layered parts, paper": (TYPES["paper"], PARTS["layered"]),
}


@pytest.fixture(scope="module", params=CASES.values(), ids=CASES)
def reference(request):
    element, parts = request.param
    mesh = PATCHES["curved patch"]()
    d = jointed(mesh, parts, element) if parts else free_body(mesh, element=element)
    state = random_state(d, 31)
    return d, state, assembled(d, state)


def supported(body, supports=SUPPORTS, ordering=ORDERINGS["as numbered"]):
    """The same body with supports."""
    shell = body.model.shell
    return free_body(body.mesh, element=shell.element, regions=shell.regions, supports=supports, ordering=ordering)


@pytest.mark.parametrize("ordering", ORDERINGS.values(), ids=ORDERINGS)
@pytest.mark.parametrize("supports", [(), SUPPORTS], ids=["free", "oblique supports"])
def test_matrix_and_right_side(reference, supports, ordering):
    body, state, arrays = reference
    d = supported(body, supports, ordering)
    if supports:
        assert (d.model.constraints.frame_of >= 0).any()
    assembly = d.assemble(Instant(state, d.model.loading(1.0)))
    (r, r_condensed, K), free = expected(d, arrays), d.free.ravel()
    right_side = np.zeros(free.size)
    right_side[free] = assembly.right_side[d.numbering.number[d.free]]
    errors = {
        "residual": scaled_error(assembly.residual.ravel(), r),
        "right side": scaled_error(right_side, np.where(free, -r_condensed, 0.0)),
        "matrix": scaled_error(dense(d, assembly.matrix), np.where(np.outer(free, free), K, 0.0)),
    }
    assert max(errors.values()) < 1e-11, errors
    assert d.dofs == free.sum() == assembly.matrix.shape[0]


def test_one_held_rotation_is_among_the_supports():
    held = free_body(PATCHES["curved patch"](), supports=SUPPORTS).model.constraints.fixed[:, 7:10].sum(axis=1)
    assert set(held) == {0, 1, 2, 3}, f"numbers of held rotations: {set(held)}"


def test_imposed_increments_go_to_the_right_side(reference):
    body, state, arrays = reference
    d = supported(body)
    (_, r_condensed, K), imposed = expected(d, arrays), d.imposed(0.7 * d.model.constraints.values[0])
    assert np.array_equal(imposed, 0.7 * d.model.constraints.values[0])
    assert np.count_nonzero(imposed) > 10
    right_side = d.assemble(Instant(state, d.model.loading(1.0)), imposed=imposed).right_side[
        d.numbering.number[d.free]
    ]
    error = scaled_error(right_side, -(r_condensed + K @ imposed.ravel())[d.free.ravel()])
    assert error < 1e-11, f"{error:.1e}"


def test_solution_satisfies_the_equations(reference):
    """The increment of free unknowns and imposed values balances K Δv = -r but for reactions."""
    body, state, arrays = reference
    d = supported(body)
    assembly = d.assemble(Instant(state, d.model.loading(1.0)), imposed=d.imposed(0.1 * d.model.constraints.values[0]))
    solution = np.linalg.solve(assembly.matrix.toarray(), assembly.right_side)
    local = frames(d) @ d.direction(solution, d.imposed(0.1 * d.model.constraints.values[0])).nodal.ravel()
    _, r_condensed, K = expected(d, arrays)
    unbalanced = K @ local + r_condensed
    error = np.abs(unbalanced[d.free.ravel()]).max() / np.abs(unbalanced).max()
    assert error < 1e-10, f"{error:.1e} of the reactions"
    held = local[d.model.constraints.fixed.ravel()]
    assert held == pytest.approx(d.imposed(0.1 * d.model.constraints.values[0])[d.model.constraints.fixed], abs=1e-14)


@each_element
def test_pattern_holds_no_more_than_neighbours(element):
    """Two unknowns share an entry if and only if an element has both of their nodes."""
    d = free_body(patch((3, 2)), element=element, supports=(Clamp("left"),), ordering=ORDERINGS["at random"])
    owner = np.empty(d.dofs, dtype=int)
    owner[d.numbering.number[d.free]] = np.nonzero(d.free)[0]
    neighbours = np.zeros((len(d.mesh.points),) * 2, dtype=bool)
    for nodes in d.mesh.elements:
        neighbours[np.ix_(nodes, nodes)] = True
    matrix = d.assemble(Instant(d.undeformed(), d.model.loading(0.0))).matrix
    stored = np.zeros(matrix.shape, dtype=bool)
    stored[matrix.indices, np.repeat(np.arange(d.dofs), np.diff(matrix.indptr))] = True
    assert matrix.has_canonical_format
    assert np.array_equal(stored, neighbours[np.ix_(owner, owner)])


@each_element
def test_mid_sides_carry_what_the_element_type_says(element):
    d = free_body(patch((3, 2)), element=element)
    mid_sides = np.setdiff1d(np.arange(len(d.mesh.points)), d.mesh.corner_nodes)
    rest, stretch = element.rest_nodes == 8, element.stretch_nodes == 8
    assert d.carried[d.mesh.corner_nodes, :10].all()
    assert not d.carried[:, 10].any()
    expected = [True] * 3 + [rest] * 3 + [stretch] + [rest] * 3
    assert np.array_equal(d.carried[mid_sides, :10], [expected] * len(mid_sides))
    extra = 3 + 6 * rest + stretch
    assert d.dofs == 10 * len(d.mesh.corner_nodes) + extra * len(mid_sides)


def test_frames_there_and_back():
    d = free_body(PATCHES["curved patch"](), supports=SUPPORTS)
    whole = random_increment(d, 5)
    increment = whole.nodal
    error = np.abs(d.to_global(d.to_frames(increment)) - increment).max()
    assert error < 1e-15, f"{error:.1e}"
    assert np.abs(d.to_frames(increment).ravel() - frames(d) @ increment.ravel()).max() < 1e-15
    held = d.to_frames(d.with_imposed(whole, 0.5 * d.model.constraints.values[0]).nodal)
    fixed = d.model.constraints.fixed
    assert held[fixed] == pytest.approx(0.5 * d.model.constraints.values[0][fixed], abs=1e-15)
    assert np.abs((held - d.to_frames(increment))[~fixed]).max() < 1e-15
