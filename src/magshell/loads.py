r"""Mechanical loads: dead forces and moments on groups, in proportion to the load factor.

A dead load keeps its direction in space. The virtual work of a force density t and of a moment density m, both
uniform over a group of edges or elements of the undeformed mid-surface,

    ∫ t · δu + m · δω = Σ_I F_I · δu_I + M_I · δω_I,    F_I = t ∫ N_I,    M_I = m ∫ M_I,

is that of nodal forces, with the functions N_I of the displacement (quadratic on an edge, 8-node on an element) and
those of the micro-rotation, M_I: the same where all nodes of an edge or element carry rotation, linear on an edge
and bilinear on an element where only the corners do. δω is the spin of the micro-rotation.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import FloatArray, IntArray
from magshell.errors import InputError
from magshell.mesh import Mesh
from magshell.shell.shape_functions import bilinear, gauss_legendre, serendipity
from magshell.supports import AnyBool

# Gauss points along an edge: they measure an edge that bends by a right angle to 1e-6 of its length.
POINTS = 5


class Load(Protocol):
    """Anything with a total over a group, and the columns of the nodal arrays (u 0–2, ω 7–9) that it works on."""

    kind: ClassVar[str]
    columns: ClassVar[slice]

    @property
    def group(self) -> str:
        """Group of nodes, edges or elements."""

    @property
    def total(self) -> ArrayLike:
        """Sum over the group (3,) at load factor 1."""


@dataclass(frozen=True, eq=False)
class Force:
    """A dead force on the displacements of a group, growing in proportion to the load factor.

    Parameters
    ----------
    group : str
        A group of nodes, which share it equally, of edges, along whose undeformed length it is uniform, or of elements,
        over whose undeformed area it is uniform.
    total : array_like, shape (3,)
        At load factor 1, N.
    """

    kind: ClassVar[str] = "force"
    columns: ClassVar[slice] = slice(0, 3)

    group: str
    total: ArrayLike


@dataclass(frozen=True, eq=False)
class Moment:
    """A dead moment on the micro-rotations of a group, growing in proportion to the load factor.

    Parameters
    ----------
    group : str
        A group of nodes, edges or elements, as for `Force`; nodes without rotation get none of it.
    total : array_like, shape (3,)
        At load factor 1, N m.
    """

    kind: ClassVar[str] = "moment"
    columns: ClassVar[slice] = slice(7, 10)

    group: str
    total: ArrayLike


def nodal_forces(mesh: Mesh, loads: Sequence[Load], rotating: AnyBool) -> FloatArray:
    """External forces (nodes, 10) of all loads at load factor 1, in global axes: N on u, N m on the spin.

    Parameters
    ----------
    mesh : Mesh
    loads : sequence of Load
    rotating : ndarray of bool, shape (nodes,)
        Nodes that carry a micro-rotation.

    Raises
    ------
    InputError
        Unknown group, a total that is not three finite numbers or is zero, a moment where nothing rotates.
    """
    nodal = np.zeros((len(mesh.points), 10))
    for load in loads:
        where = f"loads: {load.kind} on '{load.group}'"
        carries = rotating if load.columns == Moment.columns else np.ones_like(rotating)
        try:
            shares = _shares(mesh, load.group, carries)
        except InputError as error:
            raise InputError(f"{where}: {error}") from None
        nodal[:, load.columns] += shares[:, None] * _total(where, load.total)
    return nodal


def _total(where: str, value: ArrayLike) -> FloatArray:
    try:
        total = np.array(value, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"{where}: total is {value!r}; it takes three numbers") from None
    if total.shape != (3,) or not np.all(np.isfinite(total)):
        raise InputError(f"{where}: total is {value!r}; it needs 3 finite components")
    if not np.any(total):
        raise InputError(f"{where}: total is zero; leave the load out")
    return total


def _shares(mesh: Mesh, group: str, carries: AnyBool) -> FloatArray:
    """Each node's part (nodes,) of a total over a group, on the nodes that carry the field; they sum to one."""
    members = mesh.nodes_of(group)
    shares = np.zeros(len(mesh.points))
    if group in mesh.edge_groups:
        edges = mesh.edge_groups[group]
        np.add.at(shares, edges, _along_edges(mesh.points[edges], carries[edges[:, 2]]))
    elif group in mesh.element_groups:
        elements = mesh.elements[mesh.element_groups[group]]
        np.add.at(shares, elements, _over_elements(mesh.points[elements], np.all(carries[elements[:, 4:]], axis=1)))
    else:
        carrying: IntArray = members[carries[members]]
        if not carrying.size:
            raise InputError(f"node {members[0]} is a mid-side node and carries no rotation; it needs corner nodes")
        shares[carrying] = 1.0
    return np.asarray(shares / shares.sum())


def _along_edges(points: FloatArray, quadratic: AnyBool) -> FloatArray:
    """Integrals (edges, 3) of the functions of end, end and middle over the length of edges (edges, 3, 3), m."""
    s, weights = np.polynomial.legendre.leggauss(POINTS)
    linear = np.column_stack([0.5 * (1.0 - s), 0.5 * (1.0 + s), np.zeros(POINTS)])
    middle = 1.0 - s**2
    full = linear + np.column_stack([-0.5 * middle, -0.5 * middle, middle])
    slope = np.column_stack([s - 0.5, s + 0.5, -2.0 * s])
    length = np.linalg.norm(np.einsum("pn,enx->epx", slope, points), axis=-1) * weights
    return _integrals(length, linear, full, quadratic)


def _over_elements(points: FloatArray, quadratic: AnyBool) -> FloatArray:
    """Integrals (elements, 8) of the nodes' functions over the area of elements (elements, 8, 3), m²."""
    parent, weights = gauss_legendre(POINTS)
    full, slope, _ = serendipity(parent)
    corners = np.pad(bilinear(parent)[0], ((0, 0), (0, 4)))
    A = np.einsum("pan,enx->epax", slope, points)
    area = np.linalg.norm(np.cross(A[:, :, 0], A[:, :, 1]), axis=-1) * weights
    return _integrals(area, corners, full, quadratic)


def _integrals(measure: FloatArray, corners: FloatArray, full: FloatArray, quadratic: AnyBool) -> FloatArray:
    return np.where(quadratic[:, None], measure @ full, measure @ corners)
