"""Loops over the elements: residual and tangent, enhanced parameters, predicted stresses.

Nodal arrays have ten columns: u (3), w (3), φ, spin ϑ (3); a column that a node does not carry stays zero.
Rows and columns of nodes with a frame of their own (oblique supports) are turned into that frame.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.compiled import Kernel, inline
from magshell.magnetics.law import Coupling
from magshell.materials.law import Material
from magshell.shell.bubble import Hold, hold_vector
from magshell.shell.element import (
    Layout,
    add_radial_force,
    carriers,
    condense,
    contract,
    gather,
    padded,
    place,
    point_values,
    spin_derivatives,
    transpose,
)
from magshell.shell.geometry import Interpolation, SectionGeometry
from magshell.shell.plane_stress import eliminate_stretch
from magshell.shell.point import SIZE, workspace
from magshell.shell.rotation import LAST, NEXT
from magshell.shell.section import predicted_stress, section
from magshell.shell.state import State
from magshell.shell.unknowns import COMPONENTS

ELIMINATION_STEPS = 30


class Body(NamedTuple):
    """The undeformed shell, as arrays.

    Attributes
    ----------
    elements : ndarray, shape (elements, 8)
    layout : Layout
    geometry : SectionGeometry
    shape : Interpolation
    remanence : ndarray, shape (elements, points, 3)
        T.
    plane_stress : bool
        Whether φ is eliminated at each point.
    hold : Hold
        What holds the bubbles of u and the turning fields of triangles.
    """

    elements: IntArray
    layout: Layout
    geometry: SectionGeometry
    shape: Interpolation
    remanence: FloatArray
    plane_stress: bool
    hold: Hold


class Stresses(NamedTuple):
    """Stresses of the geometric part at every point: S = U⁻¹ P (e, p, k, 3, 3) in Pa, kappa (e, p, 2, 3) in rad."""

    S: FloatArray
    kappa: FloatArray


class Equations(NamedTuple):
    """Where an element's values go.

    Attributes
    ----------
    local_node, local_component : ndarray, shape (values,)
        Node of the element and column of the nodal arrays of each of the element's values.
    number : ndarray, shape (nodes, 10)
        Equation, -1 where fixed or absent.
    rank : ndarray, shape (nodes, 10)
        Equation minus the node's first one.
    whole : ndarray of bool, shape (nodes,)
        Whether every component that the node carries is free.
    indptr : ndarray, shape (equations + 1,)
        Column pointers of the matrix.
    offset : ndarray, shape (elements, 8, 8)
        Position of the first row of node I in the columns of node J, at [e, J, I].
    frame_of : ndarray, shape (nodes, 3)
        Frame of the node's u, w and spin, -1 for the global one.
    frames : ndarray, shape (frames, 3, 3)
        Rows are the frame's base vectors.
    """

    local_node: IntArray
    local_component: IntArray
    number: IntArray
    rank: IntArray
    whole: AnyArray
    indptr: IntArray
    offset: IntArray
    frame_of: IntArray
    frames: FloatArray


class Assembled(NamedTuple):
    """What `assemble` fills.

    Attributes
    ----------
    data : ndarray, shape (nonzeros,)
        Values of the condensed tangent, compressed columns.
    residual : ndarray, shape (nodes, 10)
        Internal minus external forces.
    condensed : ndarray, shape (nodes, 10)
        The same after the elimination of α, plus the tangent's product with the imposed increments.
    gain : ndarray, shape (elements, 3 modes, values)
    offset : ndarray, shape (elements, 3 modes)
        Δα = -offset - gain Δv.
    scale : ndarray, shape (4, 2)
        Of u, w, φ, ω: sums of squares of the elements' internal forces and of their magnetic forces.
    enhancement_residual : ndarray, shape (1,)
        Sum of squares of the residuals of α.
    """

    data: FloatArray
    residual: FloatArray
    condensed: FloatArray
    gain: FloatArray
    offset: FloatArray
    scale: FloatArray
    enhancement_residual: FloatArray


@inline
def _turn_rows(nodes: IntArray, equations: Equations, layout: Layout, rows: FloatArray) -> None:
    """Rotate the rows of each node's vectors into the node's own frame."""
    width = rows.shape[1]
    for field in range(3):
        component = 0 if field == 0 else 3 if field == 1 else 7
        stride = carriers(component, layout)
        for n in range(stride):
            frame = equations.frame_of[nodes[n], field]
            if frame < 0:
                continue
            R, at = equations.frames[frame], place(component, n, layout)
            for j in range(width):
                a0, a1, a2 = rows[at, j], rows[at + stride, j], rows[at + 2 * stride, j]
                for i in range(3):
                    rows[at + i * stride, j] = R[i, 0] * a0 + R[i, 1] * a1 + R[i, 2] * a2


@inline
def _one_rotation_held(number: IntArray) -> bool:
    """Whether a node has exactly one held component of rotation."""
    held = 0
    for c in range(COMPONENTS - 3, COMPONENTS):
        held += number[c] < 0
    return held == 1


@inline
def _add_spin_transport(r: FloatArray, layout: Layout, n: int, Kt: FloatArray) -> None:
    """K -= [r]×/2 on a node's spins: from the chart exp(ϑ) R̃ to the spins of the new state.

    The node's couples add up to its reaction, which vanishes unless a rotation is held, and does not meet free
    rotations unless exactly one is.
    """
    for i in range(3):
        j, k = place(7 + NEXT[i], n, layout), place(7 + LAST[i], n, layout)
        half = 0.5 * r[place(7 + i, n, layout)]
        Kt[k, j] += half
        Kt[j, k] -= half


@inline
def _scatter_tangent(
    e: int,
    nodes: IntArray,
    equations: Equations,
    layout: Layout,
    Kt: FloatArray,
    imposed: FloatArray,
    data: FloatArray,
    condensed: FloatArray,
) -> None:
    """Add the element's tangent to the matrix, and its product with imposed increments to `condensed`.

    The rows of one node lie side by side in a column.
    """
    nu, nw, nφ, nq = layout.u, layout.w, layout.phi, layout.q
    at_w, at_φ, at_q = place(3, 0, layout), place(6, 0, layout), place(7, 0, layout)
    for component in range(COMPONENTS):
        for J in range(carriers(component, layout)):
            number, K = equations.number[nodes[J], component], Kt[place(component, J, layout)]
            if number < 0:
                if imposed[nodes[J], component] != 0.0:
                    for c in range(COMPONENTS):
                        for I in range(carriers(c, layout)):
                            condensed[nodes[I], c] += K[place(c, I, layout)] * imposed[nodes[J], component]
                continue
            start = equations.indptr[number]
            for I in range(nu):
                node, at = nodes[I], start + equations.offset[e, J, I]
                if equations.whole[node]:
                    for c in range(3):
                        data[at + c] += K[c * nu + I]
                    at += 3
                    if I < nw:
                        for c in range(3):
                            data[at + c] += K[at_w + c * nw + I]
                        at += 3
                    if I < nφ:
                        data[at] += K[at_φ + I]
                        at += 1
                    if I < nq:
                        for c in range(3):
                            data[at + c] += K[at_q + c * nq + I]
                else:
                    for c in range(COMPONENTS):
                        if equations.number[node, c] >= 0 and I < carriers(c, layout):
                            data[at + equations.rank[node, c]] += K[place(c, I, layout)]


@Kernel
def assemble(
    material: Material,
    couple_modulus: float,
    coupling: Coupling,
    B: FloatArray,
    body: Body,
    state: State,
    stresses: Stresses,
    mixed: bool,
    tangent: bool,
    imposed: FloatArray,
    equations: Equations,
    out: Assembled,
) -> tuple[int, float]:
    """Residual and, with `tangent`, the condensed tangent; returns the first inverted element (or -1), det F there."""
    shape, geometry = body.shape, body.geometry
    layout, points, rest, modes = body.layout, geometry.volume.shape[1], body.layout.q, body.layout.modes
    nodal = place(10, 0, layout)
    size = nodal + 3 * modes
    full = size + rest
    v, x, w, T, radial = np.zeros(full), np.zeros(SIZE), workspace(), np.zeros((rest, 4, 3)), np.zeros(rest)
    narrow, wide = padded(SIZE), padded(size)
    g, g_mixed, H = np.zeros((SIZE, 2)), np.zeros(SIZE), np.zeros((SIZE, narrow))
    scratch, scratch_2 = np.zeros((4, wide)), np.zeros((4, 2))
    GH, HG, Kt, r = (
        np.zeros((size, narrow)),
        np.zeros((SIZE, wide)),
        np.zeros((size, wide)),
        np.zeros((size, 2)),
    )
    r_sum, factor = np.zeros(size), np.zeros((3 * modes, 3 * modes + nodal + 1))
    vectors, kind_of = np.zeros((4, 3)), equations.local_component
    if tangent:
        out.data[:] = 0.0
        out.condensed[:, :] = 0.0
    out.residual[:, :] = 0.0
    out.scale[:, :] = 0.0
    out.enhancement_residual[0] = 0.0
    for e in range(len(body.elements)):
        nodes = body.elements[e]
        gather(nodes, state.u, state.w, state.phi, state.q, state.alpha[e], layout, v)
        spin_derivatives(v, layout, T)
        r[:, :] = 0.0
        Kt[:, :] = 0.0
        radial[:] = 0.0
        for p in range(points):
            point_values(shape, e, p, layout, v, x)
            eliminated = not body.plane_stress
            for _ in range(ELIMINATION_STEPS):
                J = section(
                    material, couple_modulus, coupling, B, geometry, body.remanence, e, p, x,
                    stresses.S[e, p], stresses.kappa[e, p], mixed, tangent or body.plane_stress, w, g, g_mixed, H,
                )  # fmt: skip
                if not J > 0.0:
                    return e, J
                eliminated = eliminated or eliminate_stretch(geometry.z[-1], x, g, H)
                if eliminated:
                    break
            if not eliminated:
                return e, 0.0
            contract(shape, e, p, layout, T, g, scratch_2, r)
            if tangent:
                GH[:, :] = 0.0
                contract(shape, e, p, layout, T, H, scratch, GH)
                transpose(GH, HG)
                contract(shape, e, p, layout, T, HG, scratch, Kt)
                add_radial_force(shape, e, p, layout, g_mixed, v, radial)
        for number in range(len(body.hold.k)):
            hold_vector(body.hold, number, e, layout, v, state.alpha[e, modes - 1 - number], vectors, r[:, 0], Kt)
        for l in range(nodal):
            c = kind_of[l]
            kind = 0 if c < 3 else 1 if c < 6 else 2 if c == 6 else 3
            out.scale[kind, 0] += r[l, 0] ** 2
            out.scale[kind, 1] += r[l, 1] ** 2
        for l in range(size):
            r_sum[l] = r[l, 0] + r[l, 1]
        for l in range(nodal, size):
            out.enhancement_residual[0] += r_sum[l] ** 2
        if tangent:
            for n in range(rest):
                for c in range(7, 10):
                    at = place(c, n, layout)
                    Kt[at, at] -= 0.25 * radial[n]
                if _one_rotation_held(equations.number[nodes[n]]):
                    _add_spin_transport(r_sum, layout, n, Kt)
            for l in range(size):
                r[l, 0] = r_sum[l]
            if not condense(Kt, r_sum, nodal, out.gain[e], out.offset[e], factor):
                return e, 0.0
            for l in range(size):
                r[l, 1] = r_sum[l]
            _turn_rows(nodes, equations, layout, Kt)
            _turn_rows(nodes, equations, layout, Kt.T)
        else:
            for l in range(size):
                r[l, 0] = r_sum[l]
        _turn_rows(nodes, equations, layout, r)
        for l in range(nodal):
            out.residual[nodes[equations.local_node[l]], kind_of[l]] += r[l, 0]
        if tangent:
            for l in range(nodal):
                out.condensed[nodes[equations.local_node[l]], kind_of[l]] += r[l, 1]
            _scatter_tangent(e, nodes, equations, layout, Kt, imposed, out.data, out.condensed)
    return -1, 1.0


@inline
def _gather_increment(nodes: IntArray, increment: FloatArray, layout: Layout, dv: FloatArray) -> None:
    """Fill dv with an element's nodal increments, spins at the end."""
    for component in range(COMPONENTS):
        at = place(component, 0, layout)
        for n in range(carriers(component, layout)):
            dv[at + n] = increment[nodes[n], component]


@Kernel
def recover_enhancement(
    elements: IntArray,
    layout: Layout,
    increment: FloatArray,
    gain: FloatArray,
    offset: FloatArray,
    d_alpha: FloatArray,
) -> None:
    """Fill Δα (elements, modes, 3) = -offset - gain Δv."""
    modes = layout.modes
    dv = np.zeros(place(10, 0, layout))
    for e in range(len(elements)):
        _gather_increment(elements[e], increment, layout, dv)
        for m in range(modes):
            for i in range(3):
                a = i * modes + m
                s = offset[e, a]
                for l in range(dv.size):
                    s += gain[e, a, l] * dv[l]
                d_alpha[e, m, i] = -s


@Kernel
def predict_stresses(
    material: Material,
    body: Body,
    state: State,
    increment: FloatArray,
    d_alpha: FloatArray,
    stresses: Stresses,
) -> None:
    """Fill the stresses predicted linearly from `state` for a nodal increment (nodes, 10) and Δα."""
    shape, geometry, layout = body.shape, body.geometry, body.layout
    modes, rest, at = layout.modes, layout.q, place(7, 0, layout)
    full = place(10, 0, layout) + rest + 3 * modes
    v, dv, spins = np.zeros(full), np.zeros(full), np.zeros(place(10, 0, layout))
    x, dx, w, T = np.zeros(SIZE), np.zeros(SIZE), workspace(), np.zeros((rest, 4, 3))
    for e in range(len(body.elements)):
        nodes = body.elements[e]
        gather(nodes, state.u, state.w, state.phi, state.q, state.alpha[e], layout, v)
        _gather_increment(nodes, increment, layout, spins)
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
        for p in range(geometry.volume.shape[1]):
            point_values(shape, e, p, layout, v, x)
            point_values(shape, e, p, layout, dv, dx)
            predicted_stress(material, geometry, e, p, x, dx, w, stresses.S[e, p], stresses.kappa[e, p])


def are_compiled(material: type, coupling: type) -> bool:
    """Whether all kernels of a solve wait in the cache for these laws."""
    return all(
        kernel.is_compiled(*laws)
        for kernel, laws in (
            (assemble, (material, coupling)),
            (predict_stresses, (material,)),
            (recover_enhancement, ()),
        )
    )
