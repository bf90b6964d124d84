r"""Rotations as unit quaternions, scalar part first.

A rotation vector ϑ is the unit quaternion exp(ϑ/2) = (cos |ϑ|/2, sin |ϑ|/2 ϑ/|ϑ|); q and -q are the same rotation.
Nodes carry unit quaternions; a spin ϑ updates them by q ← exp(ϑ/2) q. Points see q̂ = Σ N_I q_I, not normalised:
left multiplication commutes with the sum, so the interpolation is objective, and R̃(q̂/|q̂|) has no singularity.

Compiled for the point, with n² = |q̂|² and * the conjugate:

* an increment δq̂ = (s + v) q̂ has v = V δq̂ and s = q̂ · δq̂ / n²; it turns R̃ by exp(ω), ω = 2 v - 2 s v + O(δ³),
* the wryness vectors are κ_α = axial(R̃ᵀ R̃,α) = 2 vec(q̂* q̂,α) / n².
"""

from __future__ import annotations

import numpy as np

from magshell.arrays import FloatArray
from magshell.compiled import inline

# the other two axes, in cyclic order
NEXT, LAST = (1, 2, 0), (2, 0, 1)


def identity(count: int) -> FloatArray:
    """Quaternions (count, 4) of no rotation."""
    q = np.zeros((count, 4))
    q[:, 0] = 1.0
    return q


def cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """Vector products (..., 3). (`np.cross` takes ten times as long for a few vectors.)"""
    a1, a2, a3, b1, b2, b3 = a[..., 0], a[..., 1], a[..., 2], b[..., 0], b[..., 1], b[..., 2]
    return np.stack([a2 * b3 - a3 * b2, a3 * b1 - a1 * b3, a1 * b2 - a2 * b1], axis=-1)


def length(vectors: FloatArray) -> FloatArray:
    """Lengths (..., 1) of vectors (..., n)."""
    return np.sqrt(np.einsum("...i,...i->...", vectors, vectors))[..., None]


def product(p: FloatArray, q: FloatArray) -> FloatArray:
    """Quaternion product p q, arrays (..., 4): first q, then p."""
    p0, p1, p2, p3 = p[..., 0], p[..., 1], p[..., 2], p[..., 3]
    q0, q1, q2, q3 = q[..., 0], q[..., 1], q[..., 2], q[..., 3]
    result = np.empty(np.broadcast_shapes(p.shape, q.shape))
    result[..., 0] = p0 * q0 - p1 * q1 - p2 * q2 - p3 * q3
    result[..., 1] = p0 * q1 + q0 * p1 + p2 * q3 - p3 * q2
    result[..., 2] = p0 * q2 + q0 * p2 + p3 * q1 - p1 * q3
    result[..., 3] = p0 * q3 + q0 * p3 + p1 * q2 - p2 * q1
    return result


def conjugate(q: FloatArray) -> FloatArray:
    """Inverse of unit quaternions (..., 4)."""
    return q * np.array([1.0, -1.0, -1.0, -1.0])


def exponential(rotation_vector: FloatArray) -> FloatArray:
    """Unit quaternions (..., 4) of rotation vectors (..., 3), rad, any magnitude."""
    half = 0.5 * np.asarray(rotation_vector)
    angle = length(half)
    return np.concatenate([np.cos(angle), np.sinc(angle / np.pi) * half], axis=-1)


def logarithm(q: FloatArray) -> FloatArray:
    """Rotation vectors (..., 3), rad, of magnitude at most π, of unit quaternions (..., 4)."""
    q = np.where(q[..., :1] < 0.0, -q, q)
    sine = np.linalg.norm(q[..., 1:], axis=-1, keepdims=True)
    angle = np.arctan2(sine, q[..., :1])
    return np.asarray(2.0 * q[..., 1:] * np.where(sine > 0.0, angle / np.where(sine > 0.0, sine, 1.0), 1.0))


def matrix(q: FloatArray) -> FloatArray:
    """Rotation matrices (..., 3, 3) of quaternions (..., 4) of any length but zero."""
    q = q / np.linalg.norm(q, axis=-1, keepdims=True)
    q0, q1, q2, q3 = np.moveaxis(q, -1, 0)
    rows = [
        [1 - 2 * (q2 * q2 + q3 * q3), 2 * (q1 * q2 - q0 * q3), 2 * (q1 * q3 + q0 * q2)],
        [2 * (q1 * q2 + q0 * q3), 1 - 2 * (q1 * q1 + q3 * q3), 2 * (q2 * q3 - q0 * q1)],
        [2 * (q1 * q3 - q0 * q2), 2 * (q2 * q3 + q0 * q1), 1 - 2 * (q1 * q1 + q2 * q2)],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def compose(spin: FloatArray, q: FloatArray) -> FloatArray:
    """exp(spin/2) q, normalised: quaternions (..., 4) turned on by spins (..., 3)."""
    turned = product(exponential(spin), q)
    return np.asarray(turned / length(turned))


@inline
def rotation_matrix(q: FloatArray, R: FloatArray) -> float:
    """Fill R (3, 3) with the rotation of q (4,), not normalised; return n²."""
    n2 = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]
    two = 2.0 / n2
    for i in range(3):
        j, k = NEXT[i], LAST[i]
        R[i, i] = 1.0 - two * (q[1 + j] * q[1 + j] + q[1 + k] * q[1 + k])
        R[j, i] = two * (q[1 + i] * q[1 + j] + q[0] * q[1 + k])
        R[i, j] = two * (q[1 + i] * q[1 + j] - q[0] * q[1 + k])
    return n2


@inline
def spin_map(q: FloatArray, n2: float, V: FloatArray) -> None:
    """Fill V (3, 4): v = vec(δq̂ q̂*) / n²."""
    for i in range(3):
        j, k = NEXT[i], LAST[i]
        V[i, 0] = -q[1 + i] / n2
        V[i, 1 + i] = q[0] / n2
        V[i, 1 + k] = q[1 + j] / n2
        V[i, 1 + j] = -q[1 + k] / n2


@inline
def wryness_maps(q: FloatArray, r: FloatArray, n2: float, L: FloatArray, M: FloatArray, kappa: FloatArray) -> None:
    """Fill L, M (3, 4) and κ (3,): κ = 2 vec(q̂* r) / n², δκ = L δr + M δq̂ for r = q̂,α."""
    two = 2.0 / n2
    for i in range(3):
        j, k = NEXT[i], LAST[i]
        L[i, 0] = -two * q[1 + i]
        L[i, 1 + i] = two * q[0]
        L[i, 1 + k] = -two * q[1 + j]
        L[i, 1 + j] = two * q[1 + k]
        M[i, 0] = two * r[1 + i]
        M[i, 1 + i] = -two * r[0]
        M[i, 1 + k] = two * r[1 + j]
        M[i, 1 + j] = -two * r[1 + k]
    for i in range(3):
        kappa[i] = L[i, 0] * r[0] + L[i, 1] * r[1] + L[i, 2] * r[2] + L[i, 3] * r[3]
        for c in range(4):
            M[i, c] -= 2.0 * kappa[i] * q[c] / n2
