"""How strong the mechanical loads of a model are; implausible magnitudes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from magshell.model.doubts.asked import Asked
from magshell.model.doubts.figures import Whole
from magshell.model.loads.load import Size


@dataclass(frozen=True)
class Strength:
    """Sums of the loads' largest magnitudes, each over the path, against the stiffness of the shell.

    Attributes
    ----------
    force : float
        Forces and tractions, N.
    moment : float
        N m.
    weight : float
        N.
    pressure : float
        Pa.
    extent, thickness, youngs_modulus : float
        L, h (m) and E (Pa).
    """

    force: float
    moment: float
    weight: float
    pressure: float
    extent: float
    thickness: float
    youngs_modulus: float

    @property
    def bending(self) -> float:
        """12 (F L + M) / (E h³): a square plate bends visibly from about 0.1."""
        return self._bending(self.force + self.moment / self.extent)

    @property
    def weight_bending(self) -> float:
        """12 W L / (E h³), for a square plate 12 rho g L³ / (E h²): its visible bending as above."""
        return self._bending(self.weight)

    @property
    def stretching(self) -> float:
        """p L / (E h): a balloon of diameter L is strained by a quarter of it, times 1 - nu."""
        return self.pressure * self.extent / (self.youngs_modulus * self.thickness)

    @property
    def overall(self) -> float:
        """12 (F L + M + W L + p L³) / (E h³)."""
        return self.bending + self.weight_bending + self._bending(self.pressure * self.extent**2)

    def _bending(self, force: float) -> float:
        return 12.0 * force * self.extent / (self.youngs_modulus * self.thickness**3)


def strength(model: Asked, figures: Whole) -> Strength:
    """The loads of a model, in numbers, against thickness and modulus of its most flexible part."""
    soft = figures.most_flexible
    peaks = [max(map(abs, load.history or (1.0,))) for load in model.loads]
    sizes = [load.size(forces) for load, forces in zip(model.loads, model.forces_at_rest, strict=True)]
    force, moment, weight, pressure = (
        sum(peak * size[column] for peak, size in zip(peaks, sizes, strict=True)) for column in range(len(Size._fields))
    )
    return Strength(
        force=force,
        moment=moment,
        weight=weight,
        pressure=pressure,
        extent=figures.extent,
        thickness=soft.thinnest,
        youngs_modulus=soft.youngs_modulus,
    )


def doubts(model: Asked, strong: Strength) -> Iterator[str]:
    """Implausible magnitudes, most often a slip of units."""
    densities = [layer.density for part in model.shell.parts for layer in part.layers]
    known = sorted({density for density in densities if density is not None})
    for density in known:
        if not 10.0 <= density <= 25e3:
            what = "lighter than a foam" if density < 10.0 else "heavier than any metal"
            yield f"the density is {density:.3g} kg/m^3: {what}; check shell.density"
    if known and not strong.weight:
        yield "there is a density but no gravity: it is used for the mass alone"
    beyond = "beyond any experiment; check the units"
    if strong.bending > 1e5:
        yield f"12 (F L + M) / (E h³) is {strong.bending:.2g}: loads {beyond}"
    if strong.weight_bending > 1e5:
        yield f"12 W L / (E h³) is {strong.weight_bending:.2g}: a weight {beyond}"
    if strong.stretching > 1e3:
        yield f"p L / (E h) is {strong.stretching:.2g}: a pressure {beyond}"
    moved = np.any(model.constraints.values)
    if model.loads and not model.field_magnitude and not moved and strong.overall < 1e-3:
        yield f"12 (F L + M + W L + p L³) / (E h³) is {strong.overall:.2g}: the shell will hardly move; check the units"
