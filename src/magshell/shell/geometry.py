"""Functions and geometry of the undeformed shell at the integration points: isoparametric surface, nodal normals."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.shell import triangle
from magshell.shell.elements import ElementType


class Sections(NamedTuple):
    """Through the thickness: levels z (elements, p, k), from the mesh surface, and the height of each, both m.

    Elements of fewer levels than others repeat their first with a height of zero.
    """

    z: FloatArray
    heights: FloatArray


class SectionGeometry(NamedTuple):
    """What the point's section needs of the undeformed shell; p counts points, k levels through the thickness.

    Attributes
    ----------
    A : ndarray, shape (elements, p, 2, 3)
        Covariant base A_α = X,α of the mid-surface, m.
    D, dD : ndarray, shape (elements, p, 3) and (elements, p, 2, 3)
        Unit director of the undeformed shell and its derivatives D,α.
    z : ndarray, shape (elements, p, k)
        Levels, m.
    G : ndarray, shape (elements, p, k, 3, 3)
        Dual of (A_1 + z D,1, A_2 + z D,2, D): G^i = Q⁻¹ A^i with the shifter Q = I - z B; rows, 1/m.
    volume : ndarray, shape (elements, p, k)
        det Q √A times all weights, m³.
    """

    A: FloatArray
    D: FloatArray
    dD: FloatArray
    z: FloatArray
    G: FloatArray
    volume: FloatArray


class Interpolation(NamedTuple):
    """From an element's values to what its points see; rows of functions are the value and its two parent derivatives.

    Attributes
    ----------
    u : ndarray, shape (elements, p, 2, 8)
        Derivatives of the functions of u.
    director : ndarray, shape (elements, p, 3, nodes)
        Functions of the director displacement w.
    phi : ndarray, shape (elements, p, nodes)
        Functions of the thickness stretch φ.
    rotation : ndarray, shape (elements, p, 3, nodes)
        Functions of the quaternions.
    enhancement : ndarray, shape (elements, p, 3, modes)
        What the element's own parameters add to g_1, g_2, g_3. Enhanced modes: (√A at the centre / √A) f with
        ∫ f dξ dη = 0, on D or on a dual base vector of the centre, so that constant stress does no work on them; of
        triangles the `turning_field`; the bubble of u, the last: its derivatives. In g_1 and g_2 times half the root of
        the element's area, so that all parameters are numbers.
    """

    u: FloatArray
    director: FloatArray
    phi: FloatArray
    rotation: FloatArray
    enhancement: FloatArray


def director_functions(normals: FloatArray, N: FloatArray, dN: FloatArray) -> FloatArray:
    r"""Functions Ñ_I = N_I / ν and their derivatives, with ν = |Σ N_I D_I|: (elements, points, 3, nodes).

    The undeformed director is the interpolated normal made a unit vector, D = Σ Ñ_I D_I, and d = Σ Ñ_I (D_I + w_I).
    A rigid rotation w_I = (R - I) D_I then gives d = R D exactly at every point. (With the surface's own normal at the
    point in place of Σ Ñ_I D_I it does not: one element of the gripper turned by 77° shows the forces of a stretch of
    0.03–0.1 %, and its linear rotations are not zero-energy modes. At the Gauss points the two differ by O(h³) on a
    cylinder and O(h²) on a sphere.)

    Parameters
    ----------
    normals : ndarray, shape (elements, nodes, 3)
    N, dN : ndarray, shape (elements, points, nodes) and (elements, points, 2, nodes)
    """
    mean = np.einsum("epn,enx->epx", N, normals)
    slope = np.einsum("epan,enx->epax", dN, normals)
    ν = np.linalg.norm(mean, axis=-1)
    dν = np.einsum("epax,epx->epa", slope, mean) / ν[..., None]
    values = N / ν[..., None]
    derivatives = dN / ν[..., None, None] - values[:, :, None] * (dν / ν[..., None])[..., None]
    return np.concatenate([values[:, :, None], derivatives], axis=2)


def interpolation(
    node_coordinates: FloatArray, normals: FloatArray, element: ElementType, micro_rotation: bool
) -> Interpolation:
    """Functions of an element type at the points of its rule.

    Parameters
    ----------
    node_coordinates, normals : ndarray, shape (elements, 8, 3)
        m; unit normals at the nodes, shared by the elements that meet there.
    element : ElementType
    micro_rotation : bool
        Without it no node carries a quaternion.
    """
    parent, _ = element.integration(node_coordinates)
    u = element.functions(8, parent, node_coordinates)
    rest = element.functions(element.rest_nodes, parent, node_coordinates)
    φ = element.functions(element.stretch_nodes, parent, node_coordinates)
    director = director_functions(normals[:, : element.rest_nodes], rest.values, rest.derivatives)
    rotation = np.concatenate([rest.values[:, :, None], rest.derivatives], axis=2)
    if not micro_rotation:
        rotation = rotation[..., :0]
    enhancement = np.zeros((*u.values.shape[:2], 3, element.vectors))
    centre = element.functions(8, np.zeros((1, 2)), node_coordinates)
    area = _area(centre.derivatives, node_coordinates)
    if element.bubble:
        enhancement[:, :, :2, -1] = np.sqrt(area)[..., None] * element.bubbles(parent, node_coordinates)[1]
    if element.triangle_rule is not None:
        triangles = triangle.collapsed(node_coordinates)
        enhancement[triangles, :, :2, len(element.modes)] = turning_field(
            element, parent.triangles, node_coordinates[triangles]
        )
    if element.modes:
        ratio = area / _area(u.derivatives, node_coordinates)
        A = np.einsum("epan,enx->epax", u.derivatives, node_coordinates)
        A_0 = np.einsum("eian,enx->eiax", centre.derivatives, node_coordinates)
        dual = np.linalg.solve(A_0 @ np.swapaxes(A_0, -1, -2), A_0)
        leg = np.einsum("eigx,epax->epga", dual, A)
        for number, mode in enumerate(element.modes):
            f = element.rule.points[:, 0] ** mode.xi * element.rule.points[:, 1] ** mode.eta
            mean = element.rule.weights @ f / element.rule.weights.sum()
            if mode.column == 3:
                enhancement[:, :, 2, number] = ratio * (f - mean)
            else:
                enhancement[:, :, :2, number] = (np.sqrt(area) * ratio * (f - mean))[..., None] * leg[
                    :, :, mode.column - 1
                ]
    return Interpolation(*(np.ascontiguousarray(a) for a in (u.derivatives, director, φ.values, rotation, enhancement)))


def turning_field(element: ElementType, parent: FloatArray, node_coordinates: FloatArray) -> FloatArray:
    r"""What the vector of a triangle adds to g_1 and g_2 at parent points (p, 2): (triangles, p, 2).

    The linear fields on a triangle are six, and five are gradients of quadratic functions. The sixth turns about the
    centre: with f_i = L_j - L_k, (i, j, k) cyclic, F gains

        α ⊗ Σ_i f_i ∇L_i |_centre   (J at the centre / J),    J the area per area of the parent triangle,

    times half the root of the element's area. So with it F holds all fields that are linear on the element; no nodal
    values make the same, and its integral vanishes, so that constant stress does no work on it.
    """
    functions = element.functions(8, parent, node_coordinates)
    centre = element.functions(8, np.zeros((1, 2)), node_coordinates)
    A, A_0 = (np.einsum("epan,enx->epax", f.derivatives, node_coordinates) for f in (functions, centre))
    dual = np.linalg.solve(A_0 @ np.swapaxes(A_0, -1, -2), A_0)[:, 0]
    L, _ = triangle.barycentric(parent)
    slopes = triangle.barycentric(np.zeros((1, 2)))[1][0]
    field = np.einsum("pi,ai,eax->epx", L[:, [1, 2, 0]] - L[:, [2, 0, 1]], slopes, dual)
    area = _area(centre.derivatives, node_coordinates)
    ratio = area * (1.0 - parent[:, 1]) / _area(functions.derivatives, node_coordinates)
    return np.asarray((np.sqrt(area) * ratio)[..., None] * np.einsum("epx,epax->epa", field, A))


def _area(derivatives: FloatArray, node_coordinates: FloatArray) -> FloatArray:
    """√A (elements, points)."""
    A = np.einsum("epan,enx->epax", derivatives, node_coordinates)
    return np.asarray(np.linalg.norm(np.cross(A[:, :, 0], A[:, :, 1]), axis=-1))


def section_geometry(
    node_coordinates: FloatArray, normals: FloatArray, shape: Interpolation, weights: FloatArray, sections: Sections
) -> SectionGeometry:
    """Geometry at the points of a surface rule.

    Parameters
    ----------
    node_coordinates, normals : ndarray, shape (elements, 8, 3)
        m; unit normals at the nodes, shared by the elements that meet there.
    shape : Interpolation
    weights : ndarray, shape (elements, p) or (p,)
        Of the surface rule, on the parent square.
    sections : Sections
    """
    A = np.einsum("epan,enx->epax", shape.u, node_coordinates)
    rest = shape.director.shape[-1]
    D, dD = (
        np.einsum("epan,enx->epax", shape.director[:, :, rows], normals[:, :rest])
        for rows in (slice(0, 1), slice(1, 3))
    )
    z = sections.z
    base = base_at(A, D[:, :, 0], dD, z)
    G = dual(base)
    volume = np.linalg.det(base) * sections.heights * weights[..., None]
    return SectionGeometry(A, D[:, :, 0], dD, z, G, volume)


def base_at(A: FloatArray, D: FloatArray, dD: FloatArray, z: FloatArray) -> FloatArray:
    """Base A_1 + z D,1, A_2 + z D,2, D (elements, p, k, 3, 3), as rows, at heights z (elements, p, k)."""
    covariant = A[:, :, None] + z[..., None, None] * dD[:, :, None]
    return np.concatenate([covariant, np.broadcast_to(D[:, :, None, None], (*z.shape, 1, 3))], axis=3)


def dual(base: FloatArray) -> FloatArray:
    """Dual base (..., 3, 3) of a base, both as rows."""
    return np.asarray(np.swapaxes(np.linalg.inv(base), -1, -2))


def least_shifts(geometry: SectionGeometry, faces: FloatArray) -> FloatArray:
    """Least eigenvalue of the shifter I - z B at the two faces, (elements, p, 2): not positive where layers overlap.

    `faces` (elements, p, 2) are their z, m.
    """
    metric = np.einsum("epax,epbx->epab", geometry.A, geometry.A)
    slope = np.einsum("epax,epbx->epab", geometry.dD, geometry.A)
    curvatures = np.linalg.eigvals(np.linalg.solve(metric, slope)).real
    return np.asarray(1.0 + np.min(faces[..., None] * curvatures[:, :, None], axis=-1))


def unit_forces(geometry: SectionGeometry, shape: Interpolation, modulus: FloatArray) -> FloatArray:
    """Forces of a stress as large as the modulus whose contributions do not cancel: norms for u, w, φ, ω, s and α.

    A stress is known to round-off times the modulus, so this tells how small a residual can be told from zero.
    `modulus` is that of each level (elements, p, k), Pa.
    """
    volume, z = geometry.volume * modulus, np.abs(geometry.z)
    leg = np.linalg.norm(geometry.G, axis=-1)
    u = np.einsum("epan,epka,epk->en", np.abs(shape.u), leg[..., :2], volume)
    w = np.einsum("epan,epka,epk->en", np.abs(shape.director[:, :, 1:]), leg[..., :2], z * volume)
    w += np.einsum("epn,epk,epk->en", np.abs(shape.director[:, :, 0]), leg[..., 2], volume)
    φ = 2.0 * np.einsum("epn,epk,epk->en", np.abs(shape.phi), leg[..., 2], z * volume)
    ω = np.einsum("epn,epk->en", np.abs(shape.rotation[:, :, 0]), volume)
    α = np.einsum("epam,epka,epk->em", np.abs(shape.enhancement), leg, volume)
    return np.array([np.linalg.norm(forces) for forces in (u, w, φ, ω, w, α)])
