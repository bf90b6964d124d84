r"""How a load is shared by the nodes of a group.

The virtual work of a force density t and of a moment density m, both uniform over a group of edges or elements of the
undeformed mid-surface,

    ∫ t · δu + m · δω = Σ_I F_I · δu_I + C_I · δω_I,    F_I = t ∫ N_I,    C_I = m ∫ M_I,

is that of nodal forces, with the functions N_I of the displacement and M_I of the micro-rotation. On an element they
are those of its type (for the displacement see `shell/loaded.py`); on an edge they are quadratic, those of the
micro-rotation linear where only corners carry it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.errors import InputError
from magshell.model.shell import Shell
from magshell.shell.elements import ElementType
from magshell.shell.loaded import loaded
from magshell.shell.shape_functions import gauss_legendre

# Gauss points along an edge: they measure an edge that bends by a right angle to 1e-6 of its length.
POINTS = 5


def shares(shell: Shell, group: str, field: str) -> FloatArray:
    """Each node's part (nodes,) of a total over a group of nodes, edges or elements; they sum to one.

    Parameters
    ----------
    shell : Shell
    group : str
    field : {"u", "w", "omega"}
        What the load works on; nodes that do not carry it get no part.

    Raises
    ------
    InputError
        Unknown group, or none of its nodes carries the field.
    """
    mesh, element = shell.mesh, shell.element
    members = mesh.nodes_of(group)
    parts = np.zeros(len(mesh.points))
    if group in mesh.edge_groups:
        edges = mesh.edge_groups[group]
        np.add.at(parts, edges, _along_edges(mesh.points[edges], quadratic=field == "u" or element.rest_nodes == 8))
    elif group in mesh.element_groups:
        elements = mesh.elements[mesh.element_groups[group]]
        integrals = _over_elements(mesh.points[elements], element, field)
        np.add.at(parts, elements[:, : integrals.shape[1]], integrals)
    else:
        carrying = members[shell.carriers[field][members]]
        if not carrying.size:
            raise InputError(f"node {members[0]} is a mid-side node and carries no rotation; it needs corner nodes")
        parts[carrying] = 1.0
    return parts / parts.sum()


class Products(NamedTuple):
    """Integrals of products of the functions of u over a group, which sum to its measure.

    Attributes
    ----------
    rows, columns : ndarray, shape (n,)
        Pairs of nodes; a pair may stand here several times.
    values : ndarray, shape (n,)
        m along edges, m² over elements; of nodes one by one 1.
    """

    rows: IntArray
    columns: IntArray
    values: FloatArray


def products(shell: Shell, group: str) -> Products:
    """Products of the functions by which loads on a group of nodes, edges or elements are shared."""
    mesh = shell.mesh
    if group in mesh.edge_groups:
        members = mesh.edge_groups[group]
        functions, lengths = _edge_functions(mesh.points[members], quadratic=True)
        values = np.einsum("ep,pi,pj->eij", lengths, functions, functions)
    elif group in mesh.element_groups:
        members = mesh.elements[mesh.element_groups[group]]
        carried, areas = _element_functions(mesh.points[members], shell.element, "u")
        values = np.einsum("ep,epi,epj->eij", areas, carried, carried)
    else:
        members = mesh.nodes_of(group)[:, None]
        values = np.ones((len(members), 1, 1))
    count = members.shape[1]
    return Products(np.repeat(members, count, axis=1).ravel(), np.tile(members, count).ravel(), values.ravel())


def centroid_weights(shell: Shell, groups: Sequence[str]) -> FloatArray:
    """Weights (nodes,) whose mean of positions is the centroid of some groups; they sum to one.

    Groups of edges count by their length, groups of elements by their area, nodes one by one; so do groups of different
    kinds together.
    """
    mesh = shell.mesh
    weights = np.zeros(len(mesh.points))
    if all(group in mesh.edge_groups for group in groups):
        edges = np.unique(np.concatenate([mesh.edge_groups[group] for group in groups]), axis=0)
        np.add.at(weights, edges, _along_edges(mesh.points[edges], quadratic=True))
    elif all(group in mesh.element_groups for group in groups):
        members = np.unique(np.concatenate([mesh.element_groups[group] for group in groups]))
        weights = nodal_areas(shell, members)
    else:
        weights[np.concatenate([mesh.nodes_of(group) for group in groups])] = 1.0
    return np.asarray(weights / weights.sum())


def nodal_areas(shell: Shell, members: IntArray) -> FloatArray:
    """Integrals (nodes,) of the functions of u over the undeformed area of some elements, m²."""
    elements, areas = shell.mesh.elements[members], np.zeros(len(shell.mesh.points))
    np.add.at(areas, elements, _over_elements(shell.mesh.points[elements], shell.element, "u"))
    return areas


def element_areas(shell: Shell) -> FloatArray:
    """Undeformed area (elements,) of each element, m²."""
    mesh = shell.mesh
    return np.asarray(_element_functions(mesh.points[mesh.elements], shell.element, "u")[1].sum(axis=1))


def _along_edges(points: FloatArray, quadratic: bool) -> FloatArray:
    """Integrals (edges, 3) of the functions of end, end and middle over the length of edges (edges, 3, 3), m."""
    functions, lengths = _edge_functions(points, quadratic)
    return lengths @ functions


def _edge_functions(points: FloatArray, quadratic: bool) -> tuple[FloatArray, FloatArray]:
    """Functions (p, 3) of end, end and middle, and lengths (edges, p) of the points, of edges (edges, 3, 3), m."""
    s, weights = np.polynomial.legendre.leggauss(POINTS)
    middle = 1.0 - s**2
    slope = np.column_stack([s - 0.5, s + 0.5, -2.0 * s])
    length = np.linalg.norm(np.einsum("pn,enx->epx", slope, points), axis=-1) * weights
    functions = np.column_stack([0.5 * (1.0 - s), 0.5 * (1.0 + s), np.zeros(POINTS)])
    if quadratic:
        functions += middle[:, None] * [-0.5, -0.5, 1.0]
    return functions, length


def _over_elements(points: FloatArray, element: ElementType, field: str) -> FloatArray:
    """Integrals (elements, nodes) of a field's functions over the area of elements (elements, 8, 3), m²."""
    carried, areas = _element_functions(points, element, field)
    return np.einsum("ep,epn->en", areas, carried)


def _element_functions(points: FloatArray, element: ElementType, field: str) -> tuple[FloatArray, FloatArray]:
    """A field's functions (elements, p, nodes), and areas (elements, p) of the points, of elements (elements, 8, 3)."""
    parent, weights = gauss_legendre(POINTS)
    A = np.einsum("epan,enx->epax", element.functions(8, parent, points).derivatives, points)
    area = np.linalg.norm(np.cross(A[:, :, 0], A[:, :, 1]), axis=-1) * weights
    carried = loaded(element, parent, points) if field == "u" else element.functions(element.rest_nodes, parent, points)
    return np.asarray(carried.values), area
