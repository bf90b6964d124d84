r"""How the mass of a shell is shared by its nodes.

A layer between the heights z_0 and z_1 over the mesh has, per unit parent area, the volume

    ∫ det(A_1 + z D,1, A_2 + z D,2, D) dz = (z_1 - z_0) a + (z_1² - z_0²)/2 b + (z_1³ - z_0³)/3 c,

    a = (A_1 × A_2) · D,    b = (A_1 × D,2 + D,1 × A_2) · D,    c = (D,1 × D,2) · D,

and the first moment (z_1² - z_0²)/2 a about the mesh; left out of this are the terms in b and c, which are smaller by
the thickness over the radius of curvature. Acceleration g does the work ∫ rho g · (δu + z δd) dV.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.errors import InputError
from magshell.model.loads.distribution import POINTS
from magshell.model.parts import REST, Part
from magshell.model.rows import Rows
from magshell.model.shell import Shell
from magshell.shell.geometry import director_functions
from magshell.shell.loaded import loaded
from magshell.shell.shape_functions import gauss_legendre
from magshell.shell.unknowns import COLUMNS


class Masses(NamedTuple):
    """Mass and first moment of mass of each row of the nodal arrays.

    Attributes
    ----------
    on_u : ndarray, shape (rows,)
        Integrals of the functions of u over the mass, kg.
    on_w : ndarray, shape (rows,)
        Integrals of the functions of the director times the height over the mesh, kg m; zero unless the mass lies more
        on one side of the mesh.
    """

    on_u: FloatArray
    on_w: FloatArray


def nodal_masses(shell: Shell, rows: Rows, members: IntArray) -> Masses:
    """Masses of some elements, at the rows of the nodal arrays.

    Raises
    ------
    InputError
        One of them, named by its region and layer, has no density.
    """
    chosen = np.zeros(len(shell.mesh.elements), dtype=bool)
    chosen[members] = True
    masses = Masses(np.zeros(len(rows.of)), np.zeros(len(rows.of)))
    for part in shell.parts:
        some = np.flatnonzero(chosen[part.elements])
        if some.size:
            _check_density(part, "gravity")
            _add(masses, shell, part, some, rows)
    return masses


class Mass(NamedTuple):
    """Of the undeformed shell.

    Attributes
    ----------
    total : float
        kg.
    centroid : ndarray, shape (3,)
        m.
    """

    total: float
    centroid: FloatArray


def whole_mass(shell: Shell, rows: Rows) -> Mass:
    """Mass and centroid of a shell.

    Raises
    ------
    InputError
        A part has no density.
    """
    total, moment = 0.0, np.zeros(3)
    for part in shell.parts:
        _check_density(part, "the mass")
        for layer in _layers_of(shell, part, np.arange(len(part.elements)), rows):
            total += float(layer.masses.sum())
            moment += np.einsum("ep,epx->x", layer.masses, layer.x) + np.einsum("ep,epx->x", layer.levers, layer.D)
    return Mass(total, moment / total)


def part_mass(part: Part, shell: Shell, rows: Rows) -> float | None:
    """Mass of a part, kg; None if a density is missing."""
    if any(layer.density is None for layer in part.layers):
        return None
    return float(nodal_masses(shell, rows, part.elements).on_u.sum())


def _check_density(part: Part, user: str) -> None:
    for number, layer in enumerate(part.layers):
        if layer.density is None:
            where = REST if part.name == REST else f"region '{part.name}'"
            of_layer = f": layers[{number}]" if part.layered else ""
            raise InputError(f"{where}{of_layer}: density is missing; {user} needs it")


class _Layer(NamedTuple):
    """A layer at the points of some elements: masses and first moments about the mesh (e, p), positions, normals."""

    masses: FloatArray
    moments: FloatArray
    levers: FloatArray
    x: FloatArray
    D: FloatArray


def _layers_of(shell: Shell, part: Part, some: IntArray, rows: Rows) -> Iterator[_Layer]:
    """The layers of some elements, by their places in a part; moments with the term in a alone, levers with all."""
    element, elements = shell.element, shell.mesh.elements[part.elements[some]]
    nodes = shell.mesh.points[elements]
    points, weights = gauss_legendre(POINTS)
    functions = element.functions(8, points, nodes)
    rest = element.functions(element.rest_nodes, points, nodes)
    ends = rows.normals[rows.elements[part.elements[some], : element.rest_nodes]]
    director = director_functions(ends, rest.values, rest.derivatives)
    x = np.einsum("epn,enx->epx", functions.values, nodes)
    A = np.einsum("epan,enx->epax", functions.derivatives, nodes)
    D, dD = np.einsum("epn,enx->epx", director[:, :, 0], ends), np.einsum("epan,enx->epax", director[:, :, 1:], ends)
    a, b, c = (
        np.einsum("epx,epx->ep", normal, D) * weights
        for normal in (
            np.cross(A[:, :, 0], A[:, :, 1]),
            np.cross(A[:, :, 0], dD[:, :, 1]) + np.cross(dD[:, :, 0], A[:, :, 1]),
            np.cross(dD[:, :, 0], dD[:, :, 1]),
        )
    )
    heights = np.stack(
        [
            np.einsum("epn,en->ep", functions.values, part.at_nodes[some, :, number])
            if callable(layer.thickness)
            else np.full(a.shape, layer.thickness)
            for number, layer in enumerate(part.layers)
        ]
    )
    offset = np.einsum("epn,en->ep", functions.values, part.offset_at_nodes[some])
    below = -0.5 * heights.sum(axis=0) - offset
    for layer, height in zip(part.layers, heights, strict=True):
        assert layer.density is not None
        above = below + height
        zeroth, first, second, third = ((above**n - below**n) / n for n in (1, 2, 3, 4))
        yield _Layer(
            layer.density * (zeroth * a + first * b + second * c),
            layer.density * first * a,
            layer.density * (first * a + second * b + third * c),
            x,
            D,
        )
        below = above


def _add(masses: Masses, shell: Shell, part: Part, some: IntArray, rows: Rows) -> None:
    """The masses of some elements of a part, by their places in it."""
    element, elements = shell.element, shell.mesh.elements[part.elements[some]]
    nodes, (points, _) = shell.mesh.points[elements], gauss_legendre(POINTS)
    carried = loaded(element, points, nodes).values
    rest = element.functions(element.rest_nodes, points, nodes)
    ends = rows.normals[rows.elements[part.elements[some], : element.rest_nodes]]
    director = director_functions(ends, rest.values, rest.derivatives)[:, :, 0]
    directors = rows.source[rows.elements[part.elements[some], : element.rest_nodes], COLUMNS["w"].start]
    for layer in _layers_of(shell, part, some, rows):
        np.add.at(masses.on_u, elements, np.einsum("ep,epn->en", layer.masses, carried))
        on_w = np.einsum("ep,epn->en", layer.moments, director)
        np.add.at(masses.on_w, directors, on_w)
