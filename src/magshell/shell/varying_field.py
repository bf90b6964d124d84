r"""What a field that varies in space adds to a point: the force on the position of each level.

A level at the height z is at

    x = x̄ + z (1 + z φ) d,      δx = δx̄ + z (1 + z φ) δd + z² d δφ,      x̄ = Σ N_I (X_I + u_I),

with the functions N_I of loads (`loaded.py`), without which force and energy would not match. The coupling's rows X do
the work f_x · δx, so that with c = z (1 + z φ) and e = z² d the gradient gets f_x at x̄, c f_x at d and e · f_x at φ.
The tangent gets the same of its rows and columns, and 2 z² δφ f_x · δd.

x̄ is no part of the point's x (31,): its rows and columns of the Hessian stand apart, `H_x` (3, 31), `H_rx` (31, 3) and
`H_xx` (3, 3), until they go to the nodal u. Where levels have a stretch ζ of their own (`level_stretch.py`) φ is
absent from x, and the coupling of x̄ with ζ, which is of the order of the thickness over the distance on which the
field varies, is left out of the tangent. All of this is compiled only for fields that vary: `slopes` is None in others.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.compiled import allocate, inline
from magshell.magnetics.law import GRADIENTS, OMEGA, M, X
from magshell.shell.element import Layout, contract
from magshell.shell.point import MAGNETIC, MIXED, PHI, SIZE, Q, Record, W


class ElementAt(NamedTuple):
    """An element at one of its points: what `contract` takes."""

    point: Record
    enhancement: FloatArray
    layout: Layout
    T: FloatArray


@allocate
def slopes_scratch(slopes: FloatArray | None, levels: int) -> FloatArray | None:
    """Derivatives of the field at the levels of a point; None in a uniform field: then nothing of this is compiled."""
    if slopes is None:
        return None
    return np.zeros((levels, GRADIENTS))


@inline
def copy_slopes(slopes: FloatArray | None, element: int, point: int, own: Any) -> None:
    """Fill those of a point."""
    if slopes is not None:
        for k in range(slopes.shape[2]):
            for i in range(GRADIENTS):
                own[k, i] = slopes[element, point, k, i]


@inline
def clear_position(w: Record, tangent: bool) -> None:
    """Put all that is summed to zero."""
    w.g_x[:] = 0.0
    if tangent:
        w.H_x[:, :], w.H_rx[:, :], w.H_xx[:, :], w.H_xω[:, :], w.H_ωx[:, :] = 0.0, 0.0, 0.0, 0.0, 0.0


@inline
def set_slopes(w: Record, slopes: FloatArray) -> None:
    """Hand the gradients (36,) of a level to its law."""
    for i in range(GRADIENTS):
        w.gradients[i] = slopes[i]


@inline
def add_position(w: Record, point: Record, z: float, s: float, volume: float, by_level: bool, tangent: bool) -> None:
    """Add the work of a level on its position to the gradient and the Hessian; g_3 = s d + ā."""
    g, H, H_x, H_rx, H_xx, T, e, dg3 = w.g, w.H, w.H_x, w.H_rx, w.H_xx, w.work_tangent, w.e, w.dg3
    c, bilinear = z * (1.0 + z * w.x[PHI]), z * z
    if by_level:
        c, bilinear = z, 0.0
    for i in range(3):
        e[i] = bilinear * (point.D[i] + w.x[W + i])
        force = volume * w.forces[X + i]
        w.g_x[i] += force
        for column in (MAGNETIC, MIXED):
            g[W + i, column] += c * force
            g[PHI, column] += e[i] * force
    if not tangent:
        return
    for i in range(3):
        force = volume * w.forces[X + i]
        H[PHI, W + i] += bilinear * force
        H[W + i, PHI] += bilinear * force
        for j in range(3):
            t = volume * T[X + i, X + j]
            H_xx[i, j] += t
            H_x[i, W + j] += c * t
            H_x[i, PHI] += t * e[j]
            H_rx[W + i, j] += c * t
            H_rx[PHI, j] += e[i] * t
            H[W + i, W + j] += c * c * t
            H[W + i, PHI] += c * t * e[j]
            H[PHI, W + j] += c * e[i] * t
            H[PHI, PHI] += e[i] * t * e[j]
            turned, back = volume * T[X + i, OMEGA + j], volume * T[OMEGA + j, X + i]
            w.H_xω[i, j] += turned
            w.H_gω[W + i, j] += c * turned
            w.H_gω[PHI, j] += e[i] * turned
            w.H_ωx[j, i] += back
            w.H_ωg[j, W + i] += c * back
            w.H_ωg[j, PHI] += e[i] * back
            for a in range(3):
                first, κ1, second, κ2 = (12, s, 15, 1.0) if a == 2 else (3 * a, 1.0, 6 + 3 * a, z)
                row, column = volume * w.b[a] * T[X + i, M + j], volume * w.b[a] * T[M + j, X + i]
                _add_row(w, i, first + j, c, κ1 * row)
                _add_row(w, i, second + j, c, κ2 * row)
                _add_column(w, i, first + j, c, κ1 * column)
                _add_column(w, i, second + j, c, κ2 * column)
                if a == 2:
                    _add_row(w, i, PHI, c, dg3[j] * row)
                    _add_column(w, i, PHI, c, dg3[j] * column)


@inline
def _add_row(w: Record, i: int, place: int, c: float, value: float) -> None:
    """Add what component i of the position has by a place of x to the rows x̄, d and φ."""
    w.H_x[i, place] += value
    w.H[W + i, place] += c * value
    w.H[PHI, place] += w.e[i] * value


@inline
def _add_column(w: Record, i: int, place: int, c: float, value: float) -> None:
    """Likewise for columns."""
    w.H_rx[place, i] += value
    w.H[place, W + i] += c * value
    w.H[place, PHI] += w.e[i] * value


@inline
def finish_position(w: Record, by_level: bool) -> None:
    """Chain the spin to q̂ in the rows and columns of x̄."""
    for i in range(3):
        if by_level:
            w.H_x[i, PHI], w.H_rx[PHI, i] = 0.0, 0.0
        for b in range(4):
            row, column = 0.0, 0.0
            for l in range(3):
                row += 2.0 * w.H_xω[i, l] * w.V[l, b]
                column += 2.0 * w.V[l, b] * w.H_ωx[l, i]
            w.H_x[i, Q + b] += row
            w.H_rx[Q + b, i] += column


@inline
def contract_position(
    slopes: FloatArray | None,
    w: Record,
    at: ElementAt,
    scratch: FloatArray,
    position: FloatArray,
    forces: FloatArray,
    Kt: FloatArray,
    tangent: bool,
) -> None:
    """Add forces on x̄, and the rows and columns of x̄ of the point's Hessian, to an element's and its transposed matrix.

    `position` (3, at least 31 and the element's values, 3) and `scratch` are scratch.
    """
    if slopes is not None:
        point, layout = at.point, at.layout
        for n in range(layout.u):
            for i in range(3):
                force = point.position[n] * w.g_x[i]
                forces[i * layout.u + n, MAGNETIC] += force
                forces[i * layout.u + n, MIXED] += force
        if tangent:
            size = len(forces)
            rows, by_row, by_column = position[0, :SIZE], position[1, :size], position[2, :size]
            for side in range(2):  # one call: the compiler makes one copy of `contract`
                target = by_row if side == 0 else by_column
                for r in range(SIZE):
                    for i in range(3):
                        rows[r, i] = w.H_rx[r, i] if side == 0 else w.H_x[i, r]
                target[:, :] = 0.0
                contract(point, at.enhancement, layout, at.T, rows, scratch, target)
            for n in range(layout.u):
                N = point.position[n]
                for i in range(3):
                    place = i * layout.u + n
                    for l in range(size):
                        Kt[place, l] += N * by_row[l, i]
                        Kt[l, place] += N * by_column[l, i]
                    for m in range(layout.u):
                        for j in range(3):
                            Kt[j * layout.u + m, place] += N * point.position[m] * w.H_xx[i, j]
