"""The element written from the paper's formulas, in jets: first and second derivatives come without further algebra.

Interpolation, stretched directors, spins and enhanced parameters; the point is `point_oracle`. Nothing of this is
shared with the package but the order of the nodes.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from materials import reference as material_reference

from shell import jets
from shell.point_oracle import (
    Section,
    axial,
    deformation_gradients,
    eliminated,
    flat,
    make_point,
    rotation,
    sheared_by,
    skew,
    wryness_vectors,
)

__all__ = ["axial", "deformation_gradients", "make_point", "rotation", "skew", "wryness_vectors"]

COLUMNS = 11
NODAL = 8 * COLUMNS
"""An element's variables: u, w, φ, spin, s of each of its eight nodes (some unused), then α (modes, 3)."""


def four(parent):
    """Bilinear functions of the corners."""
    xi, eta = parent
    return 0.25 * np.array([(1 - xi) * (1 - eta), (1 + xi) * (1 - eta), (1 + xi) * (1 + eta), (1 - xi) * (1 + eta)])


def eight(parent):
    """Serendipity functions: bubbles of the sides, and the corners less half of their two sides'."""
    xi, eta = parent
    sides = 0.5 * np.array(
        [(1 - xi**2) * (1 - eta), (1 + xi) * (1 - eta**2), (1 - xi**2) * (1 + eta), (1 - xi) * (1 - eta**2)]
    )
    return np.concatenate([four(parent) - 0.5 * (sides + np.roll(sides, 1)), sides])


def eight_complete(parent, coordinates):
    """The functions that interpolate in the span of 1, ξ, η, ξη, ξ², η², ξ²η + α ξ²η²/2 and ξη² + β ξ²η²/2.

    X = a ξ + b η + c ξη + …, c = α a + β b + what points out of the plane of a and b. A square of the position has
    2 α β ξη … ξ²η², and of these ξ²η² comes with ξ²η and ξη² in just these proportions.
    """
    bottom, right, top, left = coordinates[4:]
    a, b = 0.5 * (right - left), 0.5 * (top - bottom)
    c = 0.25 * (coordinates[0] - coordinates[1] + coordinates[2] - coordinates[3])
    α, β = np.linalg.lstsq(np.column_stack([a, b]), c, rcond=None)[0]

    def span(xi, eta):
        both = 0.5 * xi**2 * eta**2
        one = 1.0 + 0.0 * xi
        return np.array([one, xi, eta, xi * eta, xi**2, eta**2, xi**2 * eta + α * both, xi * eta**2 + β * both])

    ring = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [0, -1], [1, 0], [0, 1], [-1, 0]], dtype=float)
    return np.linalg.inv(span(*ring.T)) @ span(*parent)


def is_triangle(coordinates):
    """Whether corners 3 and 4 of (8, 3) are one."""
    return bool(np.all(coordinates[2] == coordinates[3]))


def areal(parent):
    """Shares (1 - r - s, r, s) of the corners of a triangle at a point of the square whose upper side is one corner."""
    r, s = 0.25 * (1 + parent[0]) * (1 - parent[1]), 0.5 * (1 + parent[1])
    return np.array([1 - r - s, r, s])


def six(parent):
    """Functions that interpolate in the span of the quadratics in r and s, at a, b, c, c, ab, bc, c, ca; none twice."""
    span = lambda r, s: np.array([1 + 0 * r, r, s, r * r, r * s, s * s])  # noqa: E731
    nodes = np.array([[0, 0], [1, 0], [0, 1], [0.5, 0], [0.5, 0.5], [0, 0.5]])
    a, b, c, ab, bc, ca = np.linalg.inv(span(*nodes.T)) @ span(*areal(parent)[1:])
    return np.array([a, b, c, 0 * c, ab, bc, 0 * c, ca])


def functions(element, nodes, parent, coordinates):
    """Functions of a field on 4 or 8 nodes."""
    if is_triangle(coordinates):
        return six(parent) if nodes == 8 else np.array([*areal(parent), 0 * parent[0]])
    if nodes == 4:
        return four(parent)
    return eight_complete(parent, coordinates) if element.complete else eight(parent)


class Surface(NamedTuple):
    """The undeformed element at a parent point: its functions and mid-surface.

    Functions of u, of the micro-rotation and of φ with two derivatives in rows 1 and 2; `director` those of the unit
    director, likewise.
    """

    u: np.ndarray
    rotation: np.ndarray
    phi: np.ndarray
    director: np.ndarray
    X: np.ndarray
    A: np.ndarray
    D: np.ndarray
    dD: np.ndarray
    area: float


def surface(d, e, parent):
    """Isoparametric surface; the director is the interpolated normal of unit length."""
    element, nodes, at = d.model.shell.element, d.mesh.elements[e], jets.variables(parent)
    coordinates = d.mesh.points[nodes]
    u, rest, phi = (
        functions(element, count, at, coordinates) for count in (8, element.rest_nodes, element.stretch_nodes)
    )
    normals = d.normals[nodes[: element.rest_nodes]]
    mean = rest @ normals
    director = rest / jets.sqrt(mean @ mean)
    X, D = u @ coordinates, director @ normals
    rows = lambda a: np.concatenate([jets.value(a)[None], jets.gradient(a).T])  # noqa: E731
    A = jets.gradient(X).T
    return Surface(
        rows(u), rows(rest), rows(phi), rows(director), jets.value(X), A, jets.value(D), jets.gradient(D).T,
        float(np.linalg.norm(np.cross(A[0], A[1]))),
    )  # fmt: skip


def enhancements(element, coordinates, parent, here, centre):
    """What each of the element's own vectors is multiplied with in g_1, g_2, g_3: (3, modes).

    F gains α ⊗ A^column of the centre, times a monomial ξ^a η^b less its mean over the square, which is
    1/((a + 1)(b + 1)) where both are even, times a ratio of areas. The bubble is a part of u. On triangles F gains
    α ⊗ ((3 s - 1) dr + (1 - 3 r) ds), which turns about r = s = 1/3, with dr and ds those of the square's centre: there
    areal() has A_1 = X,r / 4 and A_2 = X,s / 2 - X,r / 4.
    """
    columns, length = np.zeros((3, element.vectors)), np.sqrt(centre.area)
    dual = np.linalg.pinv(centre.A).T
    for number, mode in enumerate(element.modes):
        mean = 1.0 / ((mode.xi + 1) * (mode.eta + 1)) if mode.xi % 2 == mode.eta % 2 == 0 else 0.0
        f = centre.area / here.area * (parent[0] ** mode.xi * parent[1] ** mode.eta - mean)
        if mode.column == 3:
            columns[2, number] = f
        else:
            columns[:2, number] = length * f * here.A @ dual[mode.column - 1]
    triangle, at = is_triangle(coordinates), jets.variables(parent)
    if element.triangle_rule is not None and triangle:
        _, r, s = jets.value(areal(at))
        dr, ds = np.linalg.pinv(np.array([4.0 * centre.A[0], 2.0 * (centre.A[0] + centre.A[1])])).T
        ratio = centre.area * (1.0 - parent[1]) / here.area
        columns[:2, len(element.modes)] = length * ratio * here.A @ ((3 * s - 1) * dr + (1 - 3 * r) * ds)
    if element.bubble:
        bubble = 27.0 * np.prod(areal(at)) if triangle else (1 - at[0] ** 2) * (1 - at[1] ** 2)
        columns[:2, -1] = length * bubble.gradient
    return columns


def points(d, e):
    """Integration points of an element on the parent square, and their weights."""
    element, coordinates = d.model.shell.element, d.mesh.points[d.mesh.elements[e]]
    if not is_triangle(coordinates):
        return list(zip(*element.rule, strict=True))
    found = []
    for heavy in range(3):
        L = np.full(3, 1.0 / 6.0)
        L[heavy] = 2.0 / 3.0
        s = L[2]
        found.append((np.array([(L[1] - L[0]) / (1.0 - s), 2.0 * s - 1.0]), (4.0 / 3.0) / (2.0 - 2.0 * s)))
    return found


def bubble_energy(d, state, e, at):
    """What holds the bubble: its vector α on the current tangents of the element's centre, and by itself.

    Where there are triangles the vector before it too, on a triangle by the tangents only.

    mu h A/2 A^αβ (α·a_α)(α·a_β) + c mu h³/2 α·α with the area A of the parallelogram over the centre's tangents, mean
    thickness h and the mean mu of its layers. In the dual base of the centre the first is mu h A/2 |A^α (α·a_α)|².
    """
    shell, nodes = d.model.shell, d.mesh.elements[e]
    part, place = part_of(d, e)
    heights = part.at_points[place].mean(axis=0)
    h = heights.sum()
    mu = sum(layer.material.shear_modulus * own for layer, own in zip(part.layers, heights, strict=True)) / h
    tangents = lambda x: 0.5 * np.array([x[5] - x[7], x[6] - x[4]])  # noqa: E731
    A = tangents(d.mesh.points[nodes])
    a = tangents(d.mesh.points[nodes] + state.u[nodes] + at[:NODAL].reshape(8, COLUMNS)[:, :3])
    area, total = 4.0 * np.linalg.norm(np.cross(*A)), 0.0
    for number in range(1 + (shell.element.triangle_rule is not None)):
        alpha = (state.alpha[e] + at[NODAL:].reshape(-1, 3))[-1 - number]
        held = np.linalg.pinv(A) @ (a @ alpha)
        total = total + 0.5 * mu * h * area * held @ held
        if number == 0 or not is_triangle(d.mesh.points[nodes]):
            total = total + 0.5 * shell.element.bubble * mu * h**3 * alpha @ alpha
    return total


def turned(spin, q):
    """exp(spin/2) q to second order in the spin: as much as first and second derivatives see."""
    s, v = 1.0 - (spin @ spin) / 8.0, 0.5 * spin
    return np.concatenate([[s * q[0] - v @ q[1:]], s * q[1:] + q[0] * v + np.cross(v, q[1:])])


def unknowns(d):
    """Number of an element's variables."""
    return NODAL + 3 * d.model.shell.element.vectors


def element_parts(d, state, e, parent, at):
    """Parts of x at a parent point, jets of the element's variables, and the surface there.

    A row that is not the first of its node sees the director (1 + s)(D + w).
    """
    element, rows = d.model.shell.element, d.rows.elements[e]
    rest, stretch = rows[: element.rest_nodes], rows[: element.stretch_nodes]
    here, centre = surface(d, e, parent), surface(d, e, np.zeros(2))
    nodal = at[:NODAL].reshape(8, COLUMNS)
    u, w = state.u[rows] + nodal[:, :3], state.w[rest] + nodal[: len(rest), 3:6]
    normals = d.normals[d.mesh.elements[e][: element.rest_nodes]]
    for n, row in enumerate(rest):
        if row >= len(d.mesh.points):
            w[n] = (1.0 + state.s[row] + nodal[n, 10]) * (normals[n] + w[n]) - normals[n]
    phi = state.phi[stretch] + nodal[: len(stretch), 6]
    q = np.array([turned(nodal[n, 7:10], state.q[rest[n]]) for n in range(len(rest))])
    w_here, q_here = here.director @ w, here.rotation @ q
    enhanced = 0.0 * at[:9].reshape(3, 3)
    if element.vectors:
        enhanced = enhancements(element, d.mesh.points[d.mesh.elements[e]], parent, here, centre) @ (
            state.alpha[e] + at[NODAL:].reshape(-1, 3)
        )
    parts = {
        "du": here.u[1:] @ u + enhanced[:2],
        "w": w_here[0],
        "dw": w_here[1:],
        "enhanced": enhanced[2],
        "phi": here.phi[0] @ phi,
        "q": q_here[0],
        "dq": q_here[1:],
    }
    return parts, here


def part_of(d, e):
    """The part of the shell that holds an element, and its place there."""
    return next(
        (part, int(np.flatnonzero(part.elements == e)[0])) for part in d.model.shell.parts if e in part.elements
    )


def section_of(d, e, p):
    """Levels of every layer from the bottom to the top; the shares of transverse shear are the package's."""
    part, place = part_of(d, e)
    layers, by_level = part.at_points[place, p], part.layered or d.model.shell.thickness_stretch == "plane-stress"
    at, weights = np.polynomial.legendre.leggauss(part.levels)
    z, heights, bottom = [], [], -0.5 * layers.sum() - part.offset_at_points[place, p]
    for thickness in layers:
        z.append(bottom + 0.5 * thickness * (1.0 + at))
        heights.append(0.5 * thickness * weights)
        bottom += thickness
    warping = d.reference.body.levels["warping"][e, p, : len(layers) * part.levels]
    return Section(
        np.concatenate(z), np.concatenate(heights), np.repeat(part.remanence[place, p], part.levels, axis=0),
        [layer.material for layer in part.layers for _ in range(part.levels)], warping, by_level,
    )  # fmt: skip


def point_of(d, here, e, p, weight, B):
    """The point p of a surface with its section."""
    return make_point(here.A, here.D, here.dD, weight, section_of(d, e, p), B)


def element(d, state, e, B, given=None):
    """Strain energy, residual (n,), tangent (n, n) before condensation, in the chart exp(ϑ/2) q about the state.

    With `given`, ΔS (points, levels, 3, 3) and Δκ (points, 2, 3), the tangent is that of W + ½ ΔS : UᵀU + mu l² Δκ · κ.
    """
    size = unknowns(d)
    strain, r, K = 0.0, np.zeros(size), np.zeros((size, size))
    for p, (parent, weight) in enumerate(points(d, e)):
        f, here = element_parts(d, state, e, parent, jets.variables(np.zeros(size)))
        values = {name: jets.value(part) for name, part in f.items()}
        extra = None if given is None else (given[0][p], given[1][p])
        local = eliminated(values, d.model.coupling, point_of(d, here, e, p, weight, B), extra)
        x = flat(f)
        J = jets.gradient(x)
        strain += local.energy
        r += J.T @ (local.internal + local.magnetic)
        K += J.T @ local.hessian @ J + np.einsum("i,iab->ab", local.geometric, jets.hessian(x))
    if d.model.shell.element.bubble:
        held = bubble_energy(d, state, e, jets.variables(np.zeros(size)))
        strain, r, K = strain + held.value, r + held.gradient, K + held.hessian
    return strain, r, K


def where(d, e):
    """Places (NODAL,) of an element's nodal variables among the body's (row, component) pairs, what is shared once."""
    rows, columns = d.rows.elements[e][:, None], np.arange(COLUMNS)
    own = (columns == 6) | (columns == 10)
    return (COLUMNS * np.where(own, rows, d.rows.of[rows]) + columns).ravel()


def condensed(d, r, K):
    """Residual and tangent after the elimination of α, and (K_αα⁻¹ r_α, K_αα⁻¹ K_αv)."""
    v, a = slice(0, len(r) - 3 * d.model.shell.element.vectors), slice(len(r) - 3 * d.model.shell.element.vectors, None)
    solved = np.linalg.solve(K[a, a], np.column_stack([r[a], K[a, v]]))
    return r[v] - K[v, a] @ solved[:, 0], K[v, v] - K[v, a] @ solved[:, 1:], solved[:, 0], solved[:, 1:]


def stresses(d, state, e, B, variation):
    """S = U⁻¹ P (points, levels, 3, 3) and κ (points, 2, 3) of an element, and derivatives along a variation (n,)."""
    S, dS, κ, dκ = [], [], [], []
    for p, (parent, weight) in enumerate(points(d, e)):
        f, here = element_parts(d, state, e, parent, jets.variables(np.zeros(unknowns(d))))
        point = point_of(d, here, e, p, weight, B)
        values = {name: jets.value(part) for name, part in f.items()}
        local = eliminated(values, d.model.coupling, point)
        dx = jets.gradient(flat(f)) @ variation
        along = np.concatenate([dx, local.slope @ dx])
        f = local.parts
        for k, F in enumerate(deformation_gradients(f, point)):
            U = rotation(f["q"]).T @ F
            energy = material_reference.ENERGIES[type(point.section.materials[k])]
            level = jets.variables(jets.value(U))
            W = energy(point.section.materials[k], sheared_by(point.section.warping[k], level, point.D))
            dU = jets.gradient(U) @ along
            S.append(np.linalg.solve(jets.value(U), W.gradient.reshape(3, 3)))
            dP = (W.hessian @ dU.ravel()).reshape(3, 3)
            dS.append(np.linalg.solve(jets.value(U), dP - dU @ S[-1]))
        vectors = wryness_vectors(f)
        κ.append(jets.value(vectors))
        dκ.append(jets.gradient(vectors) @ along)
    shape = (len(points(d, e)), -1, 3, 3)
    return np.reshape(S, shape), np.array(κ), np.reshape(dS, shape), np.array(dκ)
