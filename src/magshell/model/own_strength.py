"""How strong the field of a body's own remanence is, estimated without a solve."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.magnetics.dipole_sums import flux_density_at
from magshell.magnetics.fields.magnets import VACUUM_PERMEABILITY
from magshell.mesh.geometry import centres
from magshell.model.loads.distribution import element_areas
from magshell.model.shell import Shell

PLACES = 200
"""At most so many elements are asked."""
NEAREST = 0.1
"""Of the body's size: nearer parts do not count."""


class OwnStrength(NamedTuple):
    """Largest flux density of distant parts of the body at an element's centre, T, and from which distance on, m."""

    flux_density: float
    beyond: float


def own_strength(shell: Shell) -> OwnStrength:
    """Of the undeformed shell and the magnetic moments on it.

    Elements are dipoles at their centres. Those within a tenth of the body, or two elements, do not count: what they
    would add depends on the mesh.
    """
    mesh = shell.mesh
    x = centres(mesh.points, mesh.elements)
    thickness = np.empty(len(x))
    for part in shell.parts:
        thickness[part.elements] = part.at_points.sum(axis=2).mean(axis=1)
    volumes = element_areas(shell) * thickness
    moments = volumes[:, None] * shell.overall_remanence(mesh, x[:, None])[:, 0] / VACUUM_PERMEABILITY
    magnets = [body for body in shell.rigid if np.any(body.moment)]
    positions = np.array([*x, *(body.reference_point(mesh) for body in magnets)])
    moments = np.array([*moments, *(np.asarray(body.moment) for body in magnets)])
    corners = mesh.points[mesh.elements[:, :4]]
    size = float(np.linalg.norm(corners - corners.mean(axis=1, keepdims=True), axis=2).max())
    beyond = max(NEAREST * mesh.size, 4.0 * size)
    asked = np.unique(np.linspace(0, len(x) - 1, PLACES).round().astype(int))
    found = [np.linalg.norm(flux_density_at(x[one], positions, moments, beyond)) for one in asked]
    return OwnStrength(float(max(found)), beyond)
