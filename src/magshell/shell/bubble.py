r"""Stabilisation of the bubble of u and of the turning field of triangles.

Reduced integration does not see one combination of the bubble with ξ² and η², that of 3ξ²η² - ξ² - η²: its derivatives
vanish at the 2 × 2 points. It is held by an energy of the bubble's vector α (times ½√A, the amplitude) on the current
tangents a_α at the element's centre,

    W = ½ k^αβ (α · a_α)(α · a_β) + ½ s α · α,      k^αβ = mu h A A^αβ,   s = c mu h³,

A the element's area, A^αβ the reference metric at the centre. In its plane the combination is stiffer than full
integration would make it, by 27/16 on a square of incompressible material; out of the plane it is of the order of
bending: there a larger stiffness would bring back the locking that the bubble removes. W is objective, since α
turns with the body, and vanishes with α.

The vector of the turning field of triangles is held in its plane by the same k^αβ, with s = 0. Free there, it lets a
mesh of triangles in rows have membrane modes that only the couple stress resists. Out of its plane it must be free:
that is what keeps triangles from locking. (Beside triangles, quadrilaterals have that vector too, without functions: it
is held with both, and stays zero.)

With c_α = α · a_α and T^α = k^αβ c_β:

    gradient   α: T^α a_α + s α,      a_α: T^α α
    Hessian    α α: k^αβ a_α ⊗ a_β + s I,      α a_β: k^αβ a_α ⊗ α + T^β I,      a_α a_β: k^αβ α ⊗ α.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.compiled import inline
from magshell.shell.element import Layout
from magshell.shell.elements import ElementType
from magshell.shell.point import INTERNAL, MIXED
from magshell.shell.shape_functions import serendipity
from magshell.shell.triangle import collapsed


class Hold(NamedTuple):
    """What holds vectors of the elements: the bubble's, and before it that of the turning field, if there are any.

    Attributes
    ----------
    du : ndarray, shape (2, 8)
        Derivatives of the functions of u at the centre.
    A : ndarray, shape (elements, 2, 3)
        Reference tangents there, m.
    k : ndarray, shape (held, elements, 2, 2)
        N/m, of the bubble first.
    s : ndarray, shape (held, elements)
        N m.
    """

    du: FloatArray
    A: FloatArray
    k: FloatArray
    s: FloatArray


def hold(node_coordinates: FloatArray, element: ElementType, thickness: FloatArray, shear_modulus: FloatArray) -> Hold:
    """The hold of elements with these nodes (elements, 8, 3), thickness and shear modulus (elements,)."""
    du = serendipity(np.zeros((1, 2)))[1][0]
    A = np.einsum("an,enx->eax", du, node_coordinates)
    metric = np.einsum("eax,ebx->eab", A, A)
    area = 4.0 * np.sqrt(np.linalg.det(metric))
    plane = (shear_modulus * thickness * area)[:, None, None] * np.linalg.inv(metric)
    bending = element.bubble * shear_modulus * thickness**3
    k, s = [plane], [bending]
    if element.triangle_rule is not None:
        k.append(plane)
        s.append(np.where(collapsed(node_coordinates), 0.0, bending))
    count = len(k) if element.bubble else 0
    return Hold(
        du,
        np.ascontiguousarray(A),
        np.array(k[:count]).reshape(-1, *plane.shape),
        np.array(s[:count]).reshape(-1, len(area)),
    )


@inline
def hold_vector(
    held: Hold,
    number: int,
    e: int,
    layout: Layout,
    v: FloatArray,
    vectors: FloatArray,
    r: FloatArray,
    K: FloatArray,
) -> float:
    """Add the gradient of W to the internal and mixed columns of r and its Hessian to K, for the element's values v.

    `vectors` (5, 3) is scratch. Returns W.
    """
    a, c, T, alpha, energy = vectors[:2], vectors[2], vectors[3], vectors[4], 0.0
    for i in range(3):
        alpha[i] = v[layout.at_q + 4 * layout.q + (i + 1) * layout.modes - 1 - number]
    for b in range(2):
        c[b] = 0.0
        for i in range(3):
            s, at = held.A[e, b, i], i * layout.u
            for n in range(layout.u):
                s += held.du[b, n] * v[at + n]
            a[b, i] = s
            c[b] += s * alpha[i]
    for b in range(2):
        T[b] = held.k[number, e, b, 0] * c[0] + held.k[number, e, b, 1] * c[1]
        energy += 0.5 * T[b] * c[b]
    last = layout.nodal + layout.modes - 1 - number
    for i in range(3):
        row, at = last + i * layout.modes, i * layout.u
        energy += 0.5 * held.s[number, e] * alpha[i] ** 2
        r[row, INTERNAL] += T[0] * a[0, i] + T[1] * a[1, i] + held.s[number, e] * alpha[i]
        K[row, row] += held.s[number, e]
        for n in range(layout.u):
            d = T[0] * held.du[0, n] + T[1] * held.du[1, n]
            r[at + n, INTERNAL] += d * alpha[i]
            r[at + n, MIXED] += d * alpha[i]
            K[row, at + n] += d
            K[at + n, row] += d
        for j in range(3):
            at_j, h = j * layout.u, 0.0
            for b in range(2):
                ka = held.k[number, e, b, 0] * a[0, i] + held.k[number, e, b, 1] * a[1, i]
                h += ka * a[b, j]
                for n in range(layout.u):
                    value = ka * held.du[b, n] * alpha[j]
                    K[row, at_j + n] += value
                    K[at_j + n, row] += value
            K[row, last + j * layout.modes] += h
            product = alpha[i] * alpha[j]
            for n in range(layout.u):
                k0 = held.du[0, n] * held.k[number, e, 0, 0] + held.du[1, n] * held.k[number, e, 1, 0]
                k1 = held.du[0, n] * held.k[number, e, 0, 1] + held.du[1, n] * held.k[number, e, 1, 1]
                for m in range(layout.u):
                    K[at + n, at_j + m] += product * (k0 * held.du[0, m] + k1 * held.du[1, m])
    return energy
