"""The shell's point written from the paper's formulas, in jets.

F = (F0 + ā ⊗ A³ + z F1) Q⁻¹ with the surface's own dual base and shifter, U = R̃ᵀF, the wryness as the axial vectors of
R̃ᵀR̃,α with R̃,α the derivative of the rotation *matrix*. Nothing of this is shared with the package. A point's x is a
dict of named parts (`kernel_access.unpack`), with `zeta` where each level has a stretch of its own.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from magnetics import reference as coupling_reference
from materials import reference as material_reference

from shell import jets


class Section(NamedTuple):
    """Through the thickness, k levels: places, heights, remanence, laws, shares of the transverse shear."""

    z: np.ndarray
    heights: np.ndarray
    remanence: np.ndarray
    materials: list
    warping: np.ndarray
    by_level: bool = False


class Point(NamedTuple):
    """The undeformed shell at a point, and what acts on it."""

    A: np.ndarray
    D: np.ndarray
    dD: np.ndarray
    dual: np.ndarray
    section: Section
    Q_inverse: np.ndarray
    volume: np.ndarray
    B: np.ndarray


def two_levels(thickness, remanence, material):
    """The section of one material with two Gauss points."""
    z = 0.5 * thickness * np.array([-1.0, 1.0]) / np.sqrt(3.0)
    return Section(z, np.full(2, 0.5 * thickness), np.tile(remanence, (2, 1)), [material] * 2, np.zeros(2))


def make_point(A, D, dD, weight, section, B):
    """Dual base of (A_1, A_2, D), shifter Q = I - z B with B = -D,α ⊗ A^α."""
    covariant = np.stack([A[0], A[1], D], axis=1)
    dual = np.linalg.inv(covariant)
    Q = np.eye(3) + section.z[:, None, None] * np.einsum("ai,aj->ij", dD, dual[:2])
    volume = weight * section.heights * np.linalg.det(covariant) * np.linalg.det(Q)
    return Point(A, D, dD, dual, section, np.linalg.inv(Q), volume, np.asarray(B))


def skew(v):
    """[v]×, with [v]× a = v × a."""
    return np.array([[0.0 * v[0], -v[2], v[1]], [v[2], 0.0 * v[0], -v[0]], [-v[1], v[0], 0.0 * v[0]]])


def axial(S):
    """axial([v]×) = v, of matrices (3, 3, …)."""
    return 0.5 * np.array([S[2, 1] - S[1, 2], S[0, 2] - S[2, 0], S[1, 0] - S[0, 1]])


def _rotation_form(p, q):
    """Symmetric bilinear matrix M(p, q) with M(q, q) = |q|² R(q), Rodrigues' formula in half angles."""
    v, w = p[1:], q[1:]
    return (
        (p[0] * q[0] - v @ w) * np.eye(3) + np.outer(v, w) + np.outer(w, v) + p[0] * skew(w) + q[0] * skew(v)
    )  # fmt: skip


def rotation(q):
    """Rotation matrix; q need not be a unit quaternion."""
    return _rotation_form(q, q) / (q @ q)


def rotation_along(q, dq):
    """Derivative of the rotation matrix along dq, by the quotient rule."""
    return 2.0 * (_rotation_form(q, dq) - (q @ dq) * rotation(q)) / (q @ q)


def deformation_gradients(f, point):
    """Eqs bfF2, F0F1_1 at each level, with the enhancement added to F0; f are the parts of x."""
    dual, d, section = point.dual, point.D + f["w"], point.section
    F0 = (point.A + f["du"]).T @ dual[:2] + np.outer(d + f["enhanced"], dual[2])
    F1 = (point.dD + f["dw"]).T @ dual[:2] + 2.0 * f["phi"] * np.outer(d, dual[2])
    own = f.get("zeta", np.zeros(len(section.z)))
    along = np.outer(d, dual[2])
    return [
        (F0 + z * F1 + ζ * along) @ Q_inverse for z, ζ, Q_inverse in zip(section.z, own, point.Q_inverse, strict=True)
    ]


def wryness_vectors(f):
    """axial(R̃ᵀ R̃,α), rows of (2, 3)."""
    R = rotation(f["q"])
    return np.array([axial(R.T @ rotation_along(f["q"], dq)) for dq in f["dq"]])


def sheared_by(share, U, D):
    """U + ρ (T S N + N S T): the transverse shear of S = ½ (U + Uᵀ), N = D ⊗ D and T = I - N."""
    if share == 0.0:
        return U
    S, N = 0.5 * (U + U.T), np.outer(D, D)
    T = np.eye(3) - N
    return U + share * (T @ S @ N + N @ S @ T)


def strain_energy(f, point):
    """Sum over the thickness of W(U) + mu l²/2 tr(Γ Γᵀ)."""
    R, κ, section, total = rotation(f["q"]), wryness_vectors(f), point.section, 0.0
    for k, F in enumerate(deformation_gradients(f, point)):
        material, Γ = section.materials[k], κ.T @ point.dual[:2] @ point.Q_inverse[k]
        W = material_reference.ENERGIES[type(material)](material, sheared_by(section.warping[k], R.T @ F, point.D))
        couple = 0.5 * material.shear_modulus * material.length_scale**2 * np.sum(Γ * Γ)
        total = total + point.volume[k] * (W + couple)
    return total


def magnetic_work(coupling, f, point):
    """Covector of the magnetic work and its Jacobian with respect to the variables of the jets.

    Of the energy where the law has one; else of f · δm + c · δω with δω the axial vector of δR̃ R̃ᵀ.
    """
    law, R, remanence = type(coupling), rotation(f["q"]), point.section.remanence
    gradients = deformation_gradients(f, point)
    m, n = ([A @ vector for A, vector in zip(by, remanence, strict=True)] for by in (gradients, [R] * len(remanence)))
    levels = list(zip(point.volume, m, n, strict=True))
    if law in coupling_reference.ENERGIES:
        energy = sum(volume * coupling_reference.ENERGIES[law](coupling, *both, point.B) for volume, *both in levels)
        return energy.gradient, energy.hessian
    R_0, R_1, R_2 = jets.value(R), jets.gradient(R), jets.hessian(R)
    spin = axial(np.einsum("ija,kj->ika", R_1, R_0))
    d_spin = axial(np.einsum("ijab,kj->ikab", R_2, R_0) + np.einsum("ija,kjb->ikab", R_1, R_1))
    g, H = 0.0, 0.0
    for volume, m_k, n_k in levels:
        force, couple = coupling_reference.FORCES[law](coupling, m_k, n_k, point.B)
        g = g + volume * (jets.value(force) @ jets.gradient(m_k) + jets.value(couple) @ spin)
        H = H + volume * (
            np.einsum("ka,kb->ab", jets.gradient(m_k), jets.gradient(force))
            + np.einsum("k,kab->ab", jets.value(force), jets.hessian(m_k))
            + np.einsum("ka,kb->ab", spin, jets.gradient(couple))
            + np.einsum("k,kab->ab", jets.value(couple), d_spin)
        )
    return g, H


def stress_energy(f, point, dS, dκ):
    """½ ΔS : UᵀU + mu l² Δκ · κ with fixed ΔS (levels, 3, 3) and Δκ (2, 3)."""
    R, κ, total = rotation(f["q"]), wryness_vectors(f), 0.0
    for k, F in enumerate(deformation_gradients(f, point)):
        U, legs, material = R.T @ F, point.dual[:2] @ point.Q_inverse[k], point.section.materials[k]
        modulus = material.shear_modulus * material.length_scale**2
        total = total + point.volume[k] * 0.5 * np.sum(dS[k] * (U.T @ U))
        total = total + point.volume[k] * modulus * np.sum((dκ.T @ legs) * (κ.T @ legs))
    return total


# -- stretches of the levels -----------------------------------------------------------------------------------------

NAMES = ("du", "dw", "w", "enhanced", "phi", "q", "dq")


def flat(parts):
    """The parts of x in one array."""
    return np.concatenate([np.asarray(parts[name]).reshape(-1) for name in NAMES])


def of_flat(x, shapes):
    """Named parts of one array."""
    sizes = np.cumsum([np.size(shapes[name]) for name in NAMES])[:-1]
    return {name: part.reshape(np.shape(shapes[name])) for name, part in zip(NAMES, np.split(x, sizes), strict=True)}


class Local(NamedTuple):
    """A point without its stretches: energy, gradients and Hessian in x, and what it is made of.

    `geometric` is the gradient that belongs to the Hessian; `slope` (levels, x) how the stretches `zeta` follow x (no
    rows where there are none); `parts` are jets of x and of these.
    """

    energy: float
    internal: np.ndarray
    magnetic: np.ndarray
    geometric: np.ndarray
    hessian: np.ndarray
    zeta: np.ndarray
    slope: np.ndarray
    parts: dict


def stretches(values, coupling, point):
    """ζ (levels,) of equilibrium under the constraint Σ c_k ζ_k = 0, by Newton's method with a multiplier."""
    heights, count = point.section.heights, len(point.section.z)
    f = of_flat(jets.constants(flat(values), count), values)
    ζ = np.zeros(count)
    for _ in range(100):
        f["zeta"] = jets.variables(ζ)
        energy, (g, H) = strain_energy(f, point), magnetic_work(coupling, f, point)
        K = np.block([[energy.hessian + H, heights[:, None]], [heights, np.zeros(1)]])
        step = np.linalg.solve(K, -np.append(energy.gradient + g, heights @ ζ))[:count]
        largest = np.abs(step).max()
        ζ = ζ + step * 0.2 / max(largest, 0.2)
        if largest < 1e-13:
            return ζ
    raise AssertionError(f"no equilibrium across the thickness: {ζ}")


def eliminated(values, coupling, point, extra=None):
    """The point that sees `values` (no jets), its stretches eliminated by a dense Schur complement.

    `extra`: ΔS and Δκ of `stress_energy`, which joins the Hessian only.
    """
    x = flat(values)
    ζ = stretches(values, coupling, point) if point.section.by_level else np.zeros(0)
    at = jets.variables(np.concatenate([x, ζ]))
    f = of_flat(at[: len(x)], values)
    if len(ζ):  # in place of φ
        f["zeta"], f["phi"] = at[len(x) :], 0.0 * f["phi"]
    energy, (g, H) = strain_energy(f, point), magnetic_work(coupling, f, point)
    H, geometric = H + energy.hessian, g + energy.gradient
    if extra is not None:
        added = stress_energy(f, point, *extra)
        H, geometric = H + added.hessian, geometric + added.gradient
    a, b = slice(0, len(x)), slice(len(x), None)
    K = np.block([[H[b, b], point.section.heights[: len(ζ), None]], [point.section.heights[: len(ζ)], np.zeros(1)]])
    slope = np.zeros((0, len(x)))
    if len(ζ):
        slope = -np.linalg.solve(K, np.vstack([H[b, a], np.zeros(len(x))]))[: len(ζ)]
    return Local(
        energy.value, energy.gradient[a], g[a], geometric[a], H[a, a] + H[a, b] @ slope, ζ, slope, f
    )  # fmt: skip
