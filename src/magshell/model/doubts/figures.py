"""Magnitudes of a model that `magshell check` reports and judges."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from magshell.arrays import FloatArray
from magshell.magnetics.fields import UniformField
from magshell.mesh.geometry import centres, unit
from magshell.model.doubts.asked import Asked

VACUUM_PERMEABILITY = 4e-7 * math.pi


@dataclass(frozen=True)
class Figures:
    """The magnitudes of a part that the report and its doubts are about, SI."""

    name: str
    extent: float
    thinnest: float
    thickest: float
    radius: float
    shear_modulus: float
    softest: float
    stiffest: float
    youngs_modulus: float
    poissons_ratio: float
    field: float
    strongest: float

    @property
    def slenderness(self) -> float:
        return self.extent / self.thinnest

    @property
    def magnetic_load(self) -> float:
        """10³ |B| |Brem| / (mu mu0), the abscissa of the source's figures."""
        return 1e3 * self.field * self.strongest / (self.shear_modulus * VACUUM_PERMEABILITY)

    @property
    def bending_load(self) -> float:
        """12 |Brem| |B| / (mu0 E) (L/h)²: an elastic line of this length bends visibly from about 0.1."""
        stress = self.field * self.strongest / VACUUM_PERMEABILITY
        return 12.0 * stress / self.youngs_modulus * self.slenderness**2

    @property
    def bending_stiffness(self) -> float:
        """E h³."""
        return self.youngs_modulus * self.thinnest**3


@dataclass(frozen=True)
class Whole:
    """The figures of all parts, and magnitudes of the whole shell, SI."""

    parts: list[Figures]
    extent: float
    field: float
    remanence: FloatArray
    couple: float

    @property
    def strongest(self) -> float:
        return float(self.remanence.max())

    @property
    def magnetic_load(self) -> float:
        return max(part.magnetic_load for part in self.parts)

    @property
    def bending_load(self) -> float:
        return max(part.bending_load for part in self.parts)

    @property
    def thinnest(self) -> float:
        return min(part.thinnest for part in self.parts)

    @property
    def thickest(self) -> float:
        return max(part.thickest for part in self.parts)

    @property
    def radius(self) -> float:
        return min(part.radius for part in self.parts)

    @property
    def most_flexible(self) -> Figures:
        return min(self.parts, key=lambda part: part.bending_stiffness)


def figures_of(model: Asked) -> Whole:
    """Of a model that has passed all checks."""
    shell, field = model.shell, model.field_magnitude
    mesh = shell.mesh
    vectors = shell.overall_remanence(mesh, centres(mesh.points, mesh.elements)[:, None])[:, 0]
    extent = float(np.ptp(mesh.points, axis=0).max())
    remanence = np.linalg.norm(vectors, axis=1)
    mu, lam = shell.mean_of("shear_modulus"), shell.mean_of("lame_lambda")
    parts = []
    for part in shell.parts:
        one, thickness = part.elements[0], part.at_nodes.sum(axis=2)
        moduli = [layer.material.shear_modulus for layer in part.layers]
        ratios = [_poissons_ratio(layer.material.shear_modulus, layer.material.lame_lambda) for layer in part.layers]
        parts.append(
            Figures(
                name=part.name,
                extent=extent,
                thinnest=float(thickness.min()),
                thickest=float(thickness.max()),
                radius=_smallest_radius(mesh.points[mesh.elements[part.elements]]),
                shear_modulus=float(mu[one]),
                softest=min(moduli),
                stiffest=max(moduli),
                youngs_modulus=float(mu[one] * (3.0 * lam[one] + 2.0 * mu[one]) / (lam[one] + mu[one])),
                poissons_ratio=max(ratios),
                field=field,
                strongest=float(remanence[part.elements].max()),
            )
        )
    if isinstance(model.field, UniformField):
        couple = float(np.linalg.norm(np.cross(vectors, model.field.vector), axis=1).max())
    else:
        couple = field * float(remanence.max())
    return Whole(parts=parts, extent=extent, field=field, remanence=remanence, couple=couple)


def _poissons_ratio(mu: float, lam: float) -> float:
    return 0.5 * lam / (lam + mu)


def _smallest_radius(x: FloatArray) -> float:
    """Least radius of curvature of elements (n, 8, 3), from the rise of their mid-side nodes; inf where flat."""
    start, end, middle = x[:, :4], np.roll(x[:, :4], -1, axis=1), x[:, 4:]
    centre = 0.5 * x[:, 4:].sum(axis=1) - 0.25 * x[:, :4].sum(axis=1)
    inward = 4.0 * centre[:, None] - 3.0 * middle - np.roll(middle, 2, axis=1)
    normal = unit(np.cross(end - start, inward))
    rise = np.abs(((middle - 0.5 * (start + end)) * normal).sum(axis=2))
    chord = np.linalg.norm(end - start, axis=2)
    curved = rise > 1e-9 * chord
    if not curved.any():
        return math.inf
    return float((0.125 * chord[curved] ** 2 / rise[curved] + 0.5 * rise[curved]).min())
