r"""How the mass of a shell is shared by its nodes.

A layer between the heights z_0 and z_1 over the mesh has, per unit parent area, the volume

    ∫ det(A_1 + z D,1, A_2 + z D,2, D) dz = (z_1 - z_0) a + (z_1² - z_0²)/2 b + (z_1³ - z_0³)/3 c,

    a = (A_1 × A_2) · D,    b = (A_1 × D,2 + D,1 × A_2) · D,    c = (D,1 × D,2) · D,

and the first moment (z_1² - z_0²)/2 a about the mesh; left out of this are the terms in b and c, which are smaller by
the thickness over the radius of curvature. Acceleration g does the work ∫ rho g · (δu + z δd) dV.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.errors import InputError
from magshell.model.loads.distribution import POINTS
from magshell.model.loads.functions import loaded
from magshell.model.parts import REST, Part
from magshell.model.shell import Shell
from magshell.shell.geometry import director_functions
from magshell.shell.shape_functions import gauss_legendre


class Masses(NamedTuple):
    """Mass and first moment of mass of each node.

    Attributes
    ----------
    on_u : ndarray, shape (nodes,)
        Integrals of the functions of u over the mass, kg.
    on_w : ndarray, shape (nodes,)
        Integrals of the functions of the director times the height over the mesh, kg m; zero unless the mass lies more
        on one side of the mesh.
    """

    on_u: FloatArray
    on_w: FloatArray


def nodal_masses(shell: Shell, normals: FloatArray, members: IntArray) -> Masses:
    """Masses of some elements, with unit normals (nodes, 3) at the nodes.

    Raises
    ------
    InputError
        One of them, named by its region and layer, has no density.
    """
    chosen = np.zeros(len(shell.mesh.elements), dtype=bool)
    chosen[members] = True
    count = len(shell.mesh.points)
    masses = Masses(np.zeros(count), np.zeros(count))
    for part in shell.parts:
        rows = np.flatnonzero(chosen[part.elements])
        if rows.size:
            _check_density(part)
            _add(masses, shell, part, rows, normals)
    return masses


def mass_of(part: Part, shell: Shell, normals: FloatArray) -> float | None:
    """Mass of a part, kg; None if a density is missing."""
    if any(layer.density is None for layer in part.layers):
        return None
    return float(nodal_masses(shell, normals, part.elements).on_u.sum())


def _check_density(part: Part) -> None:
    for number, layer in enumerate(part.layers):
        if layer.density is None:
            where = REST if part.name == REST else f"region '{part.name}'"
            of_layer = f": layers[{number}]" if part.layered else ""
            raise InputError(f"{where}{of_layer}: density is missing; gravity needs it")


def _add(masses: Masses, shell: Shell, part: Part, rows: IntArray, normals: FloatArray) -> None:
    """The masses of some elements of a part, by its rows."""
    element, elements = shell.element, shell.mesh.elements[part.elements[rows]]
    x = shell.mesh.points[elements]
    points, weights = gauss_legendre(POINTS)
    functions = element.functions(8, points, x)
    rest = element.functions(element.rest_nodes, points, x)
    ends = normals[elements[:, : element.rest_nodes]]
    director = director_functions(ends, rest.values, rest.derivatives)
    A = np.einsum("epan,enx->epax", functions.derivatives, x)
    D, dD = np.einsum("epn,enx->epx", director[:, :, 0], ends), np.einsum("epan,enx->epax", director[:, :, 1:], ends)
    a, b, c = (
        np.einsum("epx,epx->ep", normal, D)
        for normal in (
            np.cross(A[:, :, 0], A[:, :, 1]),
            np.cross(A[:, :, 0], dD[:, :, 1]) + np.cross(dD[:, :, 0], A[:, :, 1]),
            np.cross(dD[:, :, 0], dD[:, :, 1]),
        )
    )
    heights = np.stack(
        [
            np.einsum("epn,en->ep", functions.values, part.at_nodes[rows, :, number])
            if callable(layer.thickness)
            else np.full(a.shape, layer.thickness)
            for number, layer in enumerate(part.layers)
        ]
    )
    offset = np.einsum("epn,en->ep", functions.values, part.offset_at_nodes[rows])
    below = -0.5 * heights.sum(axis=0) - offset
    mass, moment = np.zeros(a.shape), np.zeros(a.shape)
    for layer, height in zip(part.layers, heights, strict=True):
        above = below + height
        first = 0.5 * (above**2 - below**2)
        mass += layer.density * (height * a + first * b + (above**3 - below**3) / 3.0 * c)
        moment += layer.density * first * a
        below = above
    np.add.at(masses.on_u, elements, np.einsum("ep,p,epn->en", mass, weights, loaded(element, points, x).values))
    on_w = np.einsum("ep,p,epn->en", moment, weights, director[:, :, 0])
    np.add.at(masses.on_w, elements[:, : element.rest_nodes], on_w)
