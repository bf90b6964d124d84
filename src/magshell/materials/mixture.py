r"""An elastomer with magnetic particles: moduli, remanence and density by volume fraction.

With the volume fraction f of particles that do not deform, the shear modulus grows by a factor g(f):

* Guth and Gold, g = 1 + 2.5 f + 14.1 f² (E. Guth, Journal of Applied Physics 16 (1945) 20): spheres that interact in
  pairs, up to f = 0.3 or so;
* Mooney, g = exp(2.5 f / (1 - k f)) with k = 1.35 (M. Mooney, Journal of Colloid Science 6 (1951) 162; k is 1.35 to
  1.91): often taken for hard-magnetic elastomers;
* Krieger and Dougherty, g = (1 - f/f_m)^(-2.5 f_m), f_m = 0.64 (I. M. Krieger and T. J. Dougherty, Transactions of the
  Society of Rheology 3 (1959) 137): diverges at the densest random packing of spheres, f_m.

The last two were found for the viscosity of suspensions. The modulus of an incompressible matrix grows by the same
factor. All have Einstein's slope 2.5 at f = 0. Poisson's ratio stays that of the matrix, so lambda grows by g too.

The moments of the particles add up, so the remanence is f times that of the powder, magnetised as the part is; the
density is that of the mixture. A measurement is better than any of this: the three factors are 2.1, 2.0 and 1.8 at
f = 0.2 and 3.0, 3.5 and 2.8 at f = 0.3, without what chemistry between powder and matrix adds.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import NamedTuple

from magshell.errors import InputError, suggest
from magshell.materials.moduli import MODULI, lame_of

PACKED = 0.64
"""Volume fraction of the densest random packing of equal spheres."""

STIFFENINGS: Mapping[str, Callable[[float], float]] = {
    "guth-gold": lambda f: 1.0 + 2.5 * f + 14.1 * f**2,
    "mooney": lambda f: math.exp(2.5 * f / (1.0 - 1.35 * f)),
    "krieger-dougherty": lambda f: (1.0 - f / PACKED) ** (-2.5 * PACKED),
}
"""The factor by which particles of a volume fraction raise the shear modulus."""


class Composite(NamedTuple):
    """An elastomer with particles.

    Attributes
    ----------
    shear_modulus, lame_lambda : float
        Pa.
    remanence : float
        Magnitude, T.
    density : float
        kg/m³.
    """

    shear_modulus: float
    lame_lambda: float
    remanence: float
    density: float


def composite(
    particle_fraction: float,
    particle_remanence: float,
    *,
    stiffening: str = "mooney",
    particle_density: float = 7600.0,
    matrix_density: float = 1070.0,
    **matrix_moduli: float,
) -> Composite:
    """Moduli, remanence and density of an elastomer filled with hard-magnetic powder.

    Parameters
    ----------
    particle_fraction : float
        Volume of the powder over that of the composite.
    particle_remanence : float
        Of the powder, magnetised as the part is, T; see its data sheet.
    stiffening : {"mooney", "guth-gold", "krieger-dougherty"}, optional
        The formula for the shear modulus, see `magshell.materials.mixture`.
    particle_density, matrix_density : float, optional
        kg/m³; by default those of NdFeB (7500 to 7650) and of a silicone.
    **matrix_moduli : float
        Two of shear_modulus, lame_lambda, youngs_modulus, bulk_modulus (Pa) and poissons_ratio: those of the matrix.

    Returns
    -------
    Composite

    Raises
    ------
    InputError
        A fraction that cannot be packed, no such formula, or moduli that do not determine the matrix.
    """
    numbers = {
        "particle_fraction": particle_fraction,
        "particle_remanence": particle_remanence,
        "particle_density": particle_density,
        "matrix_density": matrix_density,
    }
    for name, value in numbers.items():
        if not math.isfinite(value) or value < 0.0:
            raise InputError(f"composite: {name} is {value:g}; it must be finite and zero or positive")
    if particle_fraction >= PACKED:
        raise InputError(
            f"composite: particle_fraction is {particle_fraction:g}; it must be below {PACKED:g}, the densest random "
            "packing of spheres (a fraction of the volume, not of the mass)"
        )
    if stiffening not in STIFFENINGS:
        raise InputError(f"composite: stiffening is '{stiffening}'. {suggest(stiffening, STIFFENINGS)}")
    for name in matrix_moduli:
        if name not in MODULI:
            raise TypeError(f"composite has no argument '{name}'. {suggest(name, MODULI)}")
    try:
        mu, lam = lame_of(matrix_moduli)
    except InputError as error:
        raise InputError(f"composite: {error}") from None
    factor = STIFFENINGS[stiffening](particle_fraction)
    return Composite(
        shear_modulus=factor * mu,
        lame_lambda=factor * lam,
        remanence=particle_fraction * particle_remanence,
        density=particle_fraction * particle_density + (1.0 - particle_fraction) * matrix_density,
    )
