r"""Mechanical loads: dead forces and moments on groups, in proportion to the load factor.

A dead load keeps its direction in space. The virtual work of a force density t and of a moment density m, both
uniform over a group of edges or elements of the undeformed mid-surface,

    ∫ t · δu + m · δω = Σ_I F_I · δu_I + C_I · δω_I,    F_I = t ∫ N_I,    C_I = m ∫ M_I,

is that of nodal forces, with the functions N_I of the displacement and M_I of the micro-rotation. On an element they
are those of its type; on an edge they are quadratic, those of the micro-rotation linear where only corners carry it.
δω is the spin of the micro-rotation.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import FloatArray
from magshell.errors import InputError
from magshell.mesh import Mesh
from magshell.nodal import COLUMNS
from magshell.shell.elements import ElementType
from magshell.shell.shape_functions import gauss_legendre

# Gauss points along an edge: they measure an edge that bends by a right angle to 1e-6 of its length.
POINTS = 5


class Load(Protocol):
    """Anything with a total over a group, on one nodal field."""

    kind: ClassVar[str]
    field: ClassVar[str]

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
    field: ClassVar[str] = "u"

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
    field: ClassVar[str] = "omega"

    group: str
    total: ArrayLike


def nodal_forces(mesh: Mesh, element: ElementType, loads: Sequence[Load]) -> FloatArray:
    """External forces (nodes, 10) of all loads at load factor 1, in global axes: N on u, N m on the spin.

    Raises
    ------
    InputError
        Unknown group, a total that is not three finite numbers or is zero, a moment where no node carries rotation.
    """
    nodal = np.zeros((len(mesh.points), 10))
    for load in loads:
        where = f"loads: {load.kind} on '{load.group}'"
        try:
            shares = _shares(mesh, element, load)
        except InputError as error:
            raise InputError(f"{where}: {error}") from None
        nodal[:, COLUMNS[load.field]] += shares[:, None] * _total(where, load.total)
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


def _shares(mesh: Mesh, element: ElementType, load: Load) -> FloatArray:
    """Each node's part (nodes,) of the total; they sum to one."""
    members = mesh.nodes_of(load.group)
    carriers = 8 if load.field == "u" else element.rest_nodes
    shares = np.zeros(len(mesh.points))
    if load.group in mesh.edge_groups:
        edges = mesh.edge_groups[load.group]
        np.add.at(shares, edges, _along_edges(mesh.points[edges], carriers))
    elif load.group in mesh.element_groups:
        elements = mesh.elements[mesh.element_groups[load.group]]
        np.add.at(shares, elements[:, :carriers], _over_elements(mesh.points[elements], element, carriers))
    else:
        carrying = members[element.carriers(mesh.elements, len(mesh.points))[load.field][members]]
        if not carrying.size:
            raise InputError(f"node {members[0]} is a mid-side node and carries no rotation; it needs corner nodes")
        shares[carrying] = 1.0
    return shares / shares.sum()


def _along_edges(points: FloatArray, carriers: int) -> FloatArray:
    """Integrals (edges, 3) of the functions of end, end and middle over the length of edges (edges, 3, 3), m."""
    s, weights = np.polynomial.legendre.leggauss(POINTS)
    middle = 1.0 - s**2
    slope = np.column_stack([s - 0.5, s + 0.5, -2.0 * s])
    length = np.linalg.norm(np.einsum("pn,enx->epx", slope, points), axis=-1) * weights
    functions = np.column_stack([0.5 * (1.0 - s), 0.5 * (1.0 + s), np.zeros(POINTS)])
    if carriers == 8:
        functions += middle[:, None] * [-0.5, -0.5, 1.0]
    return length @ functions


def _over_elements(points: FloatArray, element: ElementType, carriers: int) -> FloatArray:
    """Integrals (elements, carriers) of the nodes' functions over the area of elements (elements, 8, 3), m²."""
    parent, weights = gauss_legendre(POINTS)
    A = np.einsum("epan,enx->epax", element.functions(8, parent, points).derivatives, points)
    area = np.linalg.norm(np.cross(A[:, :, 0], A[:, :, 1]), axis=-1) * weights
    return np.einsum("ep,epn->en", area, element.functions(carriers, parent, points).values)
