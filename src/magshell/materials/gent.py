r"""Micropolar Gent material: chains that can be stretched up to a limit.

A. N. Gent, *A new constitutive relation for rubber*, Rubber Chemistry and Technology 69 (1996) 59; the form for
compressible bodies follows C. O. Horgan and G. Saccomandi, Journal of Elasticity 77 (2004) 123. With x = I1 - 3, the
limit J_m of x and the energy of `magshell.materials.first_invariant`,

    w(x) = -mu J_m/2 ln(1 - x/J_m).

It is that of the neo-Hookean law for J_m → ∞. Its derivatives are

    w' = mu/2 / (1 - x/J_m),      w'' = mu/(2 J_m) / (1 - x/J_m)²,

so 4 w''(0) = 2 mu/J_m and k = lambda - 2 mu/J_m. Stress and tangent are those of `first_invariant`.

Beyond the limit there is no energy: the law gives NaN, and the solver refuses the state as one that is turned inside
out. Gent found J_m = 97.2 for natural rubber; softer and filled elastomers have less. In uniaxial tension of an
incompressible body x = λ² + 2/λ - 3.
"""

from __future__ import annotations

from typing import Annotated, NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.keys import Key
from magshell.materials.first_invariant import fill, first_invariant
from magshell.materials.law import BY_DEFAULT, material_law


def _law(material: MicropolarGent, U: FloatArray, P: FloatArray, C: FloatArray) -> float:
    mu, limit = material.shear_modulus, material.extension_limit
    x = first_invariant(U)
    left = 1.0 - x / limit if x < limit else np.nan
    derivatives = (0.5 * mu / left, 0.5 * mu / (limit * left**2))
    moduli = (mu, material.lame_lambda - 2.0 * mu / limit, material.coupling_modulus)
    return fill(U, derivatives, moduli, P, C) - 0.5 * mu * limit * np.log(left)


@material_law(_law)
class MicropolarGent(NamedTuple):
    """Micropolar Gent material, which cannot be stretched beyond a limit.

    Parameters
    ----------
    shear_modulus : float
        mu of the linear limit, Pa.
    lame_lambda : float
        lambda of the linear limit, Pa; at least 2 mu over the limit.
    extension_limit : float
        J_m, the limit of I1 - 3.
    coupling_modulus : float, optional
        eta, Pa; ties the micro-rotation to the macro-rotation. By default mu.
    length_scale : float, optional
        l, m; couple stress M̃ = mu l² G. By default a hundredth of the thickness.
    """

    shear_modulus: float
    lame_lambda: float
    extension_limit: Annotated[float, Key("PositiveNumber", "$J_m$, the limit of $I_1 - 3$.")]
    coupling_modulus: float = BY_DEFAULT
    length_scale: float = BY_DEFAULT

    @property
    def couple_modulus(self) -> float:
        """Modulus mu l² of the couple stress, N."""
        return self.shear_modulus * self.length_scale**2

    def problems(self) -> list[str]:
        """What is wrong with the parameters beyond their signs."""
        if self.extension_limit <= 0.0:
            return [f"extension_limit is {self.extension_limit:g}; it must be positive"]
        least = 2.0 * self.shear_modulus / self.extension_limit
        if self.lame_lambda < least:
            return [f"lame_lambda is {self.lame_lambda:g} Pa; with this extension_limit at least {least:g} Pa"]
        return []

    def extension(self, F: FloatArray) -> FloatArray:
        """I1 - 3 over its limit, of deformation gradients (..., 3, 3)."""
        return np.asarray((np.einsum("...ij,...ij->...", F, F) - 3.0) / self.extension_limit)
