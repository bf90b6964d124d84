"""Loops over the elements: matrices and forces, enhanced parameters, predicted stresses, stretches of the levels.

Nodal arrays have eleven columns: u (3), w (3), φ, spin ϑ (3), s; a column that a node does not carry stays zero.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.compiled import Kernel, inline
from magshell.shell.bubble import Hold, hold_vector
from magshell.shell.element import (
    Layout,
    add_radial_force,
    condense,
    contract,
    copy,
    gather,
    padded,
    point_values,
    spin_derivatives,
    transpose,
)
from magshell.shell.level import Laws
from magshell.shell.level_stretch import ZETA, level_scratch, solve_level_stretch
from magshell.shell.point import INTERNAL, MAGNETIC, PADDED, SIZE, Q, workspace
from magshell.shell.rotation import LAST, NEXT, rotation_matrix
from magshell.shell.section import Mixed, Request, predicted_stress, section
from magshell.shell.state import State
from magshell.shell.ties import (
    Ties,
    any_tied,
    chain_matrix,
    chain_row,
    stretch_directors,
    stretch_increments,
)
from magshell.shell.varying_field import ElementAt, contract_position, copy_slopes, slopes_scratch


class Body(NamedTuple):
    """The undeformed shell, as arrays.

    Attributes
    ----------
    elements : ndarray, shape (elements, 8)
        Rows of the nodal arrays.
    normals : ndarray, shape (elements, 8, 3)
        Directors of the undeformed shell at the nodes.
    by_level : ndarray of bool, shape (elements,), or None
        Whether the levels of an element stretch each by itself; None: no element's do.
    ties : Ties
    layout : Layout
    points : ndarray of POINT, shape (elements, points)
    levels : ndarray of LEVEL, shape (elements, points, levels)
    enhancement : ndarray, shape (elements, points, 3, modes)
        What the element's own parameters add to g_1, g_2, g_3.
    laws : Laws
    hold : Hold
        What holds the bubbles of u and the turning fields of triangles.
    """

    elements: IntArray
    normals: FloatArray
    by_level: AnyArray | None
    ties: Ties
    layout: Layout
    points: AnyArray
    levels: AnyArray
    enhancement: FloatArray
    laws: Laws
    hold: Hold


class Stresses(NamedTuple):
    """Stresses of the geometric part at every point: S = U⁻¹ P (e, p, k, 3, 3) in Pa, kappa (e, p, 2, 3) in rad."""

    S: FloatArray
    kappa: FloatArray


class Filled(NamedTuple):
    """What `fill` fills.

    Attributes
    ----------
    K : ndarray, shape (range, most, padded)
        Transposed condensed tangents of a range of elements; only rows and columns of nodal values count. There is
        room for 3 modes more.
    r : ndarray, shape (2, elements, values)
        Residuals as they are, and condensed.
    gain : ndarray, shape (elements, 3 modes, values)
    offset : ndarray, shape (elements, 3 modes)
        Δα = -offset - gain Δv.
    energy : ndarray, shape (elements, 2)
        Elastic and magnetic, J.
    scale : ndarray, shape (5, 2)
        Of u, w, φ, ω, s: sums of squares of the elements' internal forces and of their magnetic forces.
    enhancement_residual : ndarray, shape (1,)
        Sum of squares of the residuals of α.
    """

    K: FloatArray
    r: FloatArray
    gain: FloatArray
    offset: FloatArray
    energy: FloatArray
    scale: FloatArray
    enhancement_residual: FloatArray


@inline
def _add_spin_transport(r: FloatArray, layout: Layout, n: int, Kt: FloatArray) -> None:
    """K -= [r]×/2 on a node's spins: from the chart exp(ϑ) R̃ to the spins of the new state.

    The node's couples add up to its reaction, which vanishes unless a rotation is held, and does not meet free
    rotations if all are.
    """
    for i in range(3):
        j, k = layout.at_q + NEXT[i] * layout.q + n, layout.at_q + LAST[i] * layout.q + n
        half = 0.5 * r[layout.at_q + i * layout.q + n]
        Kt[k, j] += half
        Kt[j, k] -= half


@Kernel
def fill(
    body: Body, state: State, stresses: Stresses, request: Request, transported: AnyArray, first: int, out: Filled
) -> tuple[int, float]:
    """Fill in what the elements from `first` on are; returns the first inverted element (or -1), and det F there.

    The spins of nodes in `transported` (nodes,) are those of the new state in the reaction, too.
    """
    layout, rest, modes = body.layout, body.layout.q, body.layout.modes
    nodal = layout.nodal
    size, tangent = nodal + 3 * modes, request.tangent
    full = size + rest
    v, T, radial = np.zeros(full), np.zeros((rest, 4, 3)), np.zeros(rest)
    wide = padded(max(size, nodal + layout.s))
    scratch, vectors, forces = np.zeros((4, wide)), np.zeros((5, 3)), np.zeros((size, 3))
    g, H = np.zeros((SIZE, 3)), np.zeros((SIZE, PADDED))
    GH, HG = np.zeros((size, PADDED)), np.zeros((SIZE, wide))
    r_sum, factor = np.zeros(size), np.zeros((3 * modes, 3 * modes + nodal + 1))
    records = workspace()
    across = level_scratch(body.by_level, body.levels.shape[2])
    position = np.zeros((3, max(size, SIZE), 3))
    slopes = slopes_scratch(request.field.slopes, body.levels.shape[2])
    for e in range(first, min(first + len(out.K), len(body.elements))):
        w = records[0]  # here, for Numba frees what is not used any more: the record alone does not keep its memory
        nodes, Kt, r = body.elements[e], out.K[e - first], out.r[0, e]
        gather(nodes, state, state.alpha[e], layout, v)
        if any_tied(body.ties.kind[e]):
            stretch_directors(nodes, body.normals[e], state, layout, v)
        spin_derivatives(v, layout, T)
        forces[:, :], radial[:] = 0.0, 0.0
        if tangent:
            Kt[:, :] = 0.0
        out.energy[e, :] = 0.0
        for p in range(body.points.shape[1]):
            point, levels, enhancement = body.points[e, p], body.levels[e, p], body.enhancement[e, p]
            levels = levels[: point.levels]
            point_values(point, enhancement, layout, v, w.x)
            at = e if len(request.field.flux_density) > 1 else 0
            B = request.field.flux_density[at, p]
            copy_slopes(request.field.slopes, at, p, slopes)
            mixed = Mixed(stresses.S[e, p], stresses.kappa[e, p])
            J = section(w, point, levels, request, B, slopes, mixed, across)
            if not J > 0.0:
                return e, J
            out.energy[e, INTERNAL] += w.energy[INTERNAL]
            out.energy[e, MAGNETIC] += w.energy[MAGNETIC]
            for stage in range(3 if tangent else 1):  # one call: the compiler makes one copy of `contract`
                rows, target = g, forces
                if stage == 0:
                    copy(w.g, g)
                elif stage == 1:
                    copy(w.H, H)
                    GH[:, :] = 0.0
                    rows, target = H, GH
                else:
                    transpose(GH, HG)
                    rows, target = HG, Kt
                contract(point, enhancement, layout, T, rows, scratch, target)
            here = ElementAt(point, enhancement, layout, T)
            contract_position(slopes, w, here, scratch, position, forces, Kt, tangent)
            if tangent:
                add_radial_force(point, layout, w.g, v, radial)
        for number in range(len(body.hold.k)):
            out.energy[e, INTERNAL] += hold_vector(body.hold, number, e, layout, v, vectors, forces, Kt)
        for l in range(size):
            r_sum[l] = forces[l, INTERNAL] + forces[l, MAGNETIC]
            if l < nodal:
                r[l] = r_sum[l]
                kind = 0 if l < layout.at_w else 1 if l < layout.at_phi else 2 if l < layout.at_q else 3
                out.scale[kind, INTERNAL] += forces[l, INTERNAL] ** 2
                out.scale[kind, MAGNETIC] += forces[l, MAGNETIC] ** 2
            else:
                out.enhancement_residual[0] += r_sum[l] ** 2
        if tangent:
            for n in range(rest):
                for i in range(3):
                    at = layout.at_q + i * layout.q + n
                    Kt[at, at] -= 0.25 * radial[n]
            if not condense(Kt, r_sum, nodal, out.gain[e], out.offset[e], factor):
                return e, 0.0
            for l in range(nodal):
                out.r[1, e, l] = r_sum[l]
        if any_tied(body.ties.kind[e]):
            if tangent:
                chain_matrix(body, e, state, layout, forces, Kt)
                chain_row(body, e, state, layout, out.r[1, e])
                for a in range(3 * modes):
                    chain_row(body, e, state, layout, out.gain[e, a])
            chain_row(body, e, state, layout, r)
        if tangent:
            for n in range(rest):
                if transported[nodes[n]]:
                    _add_spin_transport(r, layout, n, Kt)
    return -1, 1.0


@inline
def _gather_increment(nodes: IntArray, increment: FloatArray, layout: Layout, dv: FloatArray) -> None:
    """Fill dv with an element's nodal increments, spins at the end."""
    for i in range(3):
        for n in range(layout.u):
            dv[i * layout.u + n] = increment[nodes[n], i]
        for n in range(layout.w):
            dv[layout.at_w + i * layout.w + n] = increment[nodes[n], 3 + i]
        for n in range(layout.q):
            dv[layout.at_q + i * layout.q + n] = increment[nodes[n], 7 + i]
    for n in range(layout.phi):
        dv[layout.at_phi + n] = increment[nodes[n], 6]


@Kernel
def predict_stresses(
    body: Body,
    state: State,
    field: FloatArray,
    increment: FloatArray,
    d_alpha: FloatArray,
    stresses: Stresses,
) -> None:
    """Fill the stresses predicted linearly from `state` for a nodal increment (nodes, 11) and Δα.

    `field` (elements, p, k, 3) is that of `LocalField`.
    """
    layout = body.layout
    modes, rest, at = layout.modes, layout.q, layout.at_q
    full = layout.nodal + rest + 3 * modes
    v, dv, spins = np.zeros(full), np.zeros(full), np.zeros(layout.nodal)
    T, records, across = np.zeros((rest, 4, 3)), workspace(), level_scratch(body.by_level, body.levels.shape[2])
    for e in range(len(body.elements)):
        w = records[0]
        nodes = body.elements[e]
        gather(nodes, state, state.alpha[e], layout, v)
        _gather_increment(nodes, increment, layout, spins)
        if any_tied(body.ties.kind[e]):
            stretch_directors(nodes, body.normals[e], state, layout, v)
            stretch_increments(nodes, body.normals[e], state, increment, layout, spins)
        for l in range(at):
            dv[l] = spins[l]
        spin_derivatives(v, layout, T)
        for n in range(rest):
            for c in range(4):
                s = 0.0
                for i in range(3):
                    s += T[n, c, i] * spins[at + i * rest + n]
                dv[at + c * rest + n] = s
        for m in range(modes):
            for i in range(3):
                dv[at + 4 * rest + i * modes + m] = d_alpha[e, m, i]
        for p in range(body.points.shape[1]):
            point, levels, enhancement = body.points[e, p], body.levels[e, p], body.enhancement[e, p]
            levels, S, kappa = levels[: point.levels], stresses.S[e, p], stresses.kappa[e, p]
            point_values(point, enhancement, layout, v, w.x)
            point_values(point, enhancement, layout, dv, w.dx)
            B = field[e if len(field) > 1 else 0, p]
            predicted_stress(w, point, levels, body.laws, B, S, kappa, across)


@Kernel
def level_stretches(body: Body, state: State, field: FloatArray, zeta: FloatArray) -> None:
    """Fill the stretch ζ (e, p, k) that each level has of its own (`level_stretch.py`); zero where φ is a field.

    NaN where there is none in equilibrium. `field` (elements, p, k, 3) is that of `LocalField`.
    """
    layout = body.layout
    v, records = np.zeros(layout.nodal + layout.q + 3 * layout.modes), workspace()
    across = np.zeros((4, body.levels.shape[2]))
    for e in range(len(body.elements)):
        w = records[0]
        gather(body.elements[e], state, state.alpha[e], layout, v)
        if any_tied(body.ties.kind[e]):
            stretch_directors(body.elements[e], body.normals[e], state, layout, v)
        for p in range(body.points.shape[1]):
            point = body.points[e, p]
            zeta[e, p, :] = 0.0
            if point.by_level == 0:
                continue
            point_values(point, body.enhancement[e, p], layout, v, w.x)
            rotation_matrix(w.x[Q : Q + 4], w.R)
            levels = body.levels[e, p][: point.levels]
            B = field[e if len(field) > 1 else 0, p]
            if not solve_level_stretch(w, point, levels, body.laws, B, across):
                zeta[e, p, :] = np.nan
                continue
            for k in range(len(levels)):
                zeta[e, p, k] = across[ZETA, k]


def are_compiled() -> bool:
    """Whether the loops are in the cache: nothing else that a solve may compile takes long."""
    return fill.is_compiled() and predict_stresses.is_compiled()
