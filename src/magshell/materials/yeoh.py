r"""Micropolar Yeoh material: a cubic in the first invariant, which many tensile tests fit.

O. H. Yeoh, *Some forms of the strain energy function for rubber*, Rubber Chemistry and Technology 66 (1993) 754. With
x = I1 - 3, C10 = mu/2 and the energy of `magshell.materials.first_invariant`,

    w(x) = C10 x + C20 x² + C30 x³.

Its derivatives are

    w' = C10 + 2 C20 x + 3 C30 x²,      w'' = 2 C20 + 6 C30 x,

so 4 w''(0) = 8 C20 and k = lambda - 8 C20. Stress and tangent are those of `first_invariant`. Without C20 and C30 it is
the neo-Hookean law. C20 may be negative (rubber that first softens) as long as w' > 0 at every stretch.
"""

from __future__ import annotations

from typing import Annotated, NamedTuple

from magshell.arrays import FloatArray
from magshell.keys import Key
from magshell.materials.first_invariant import fill, first_invariant
from magshell.materials.law import BY_DEFAULT, material_law


def _law(material: MicropolarYeoh, U: FloatArray, P: FloatArray, C: FloatArray) -> float:
    mu, c20, c30 = material.shear_modulus, material.c20, material.c30
    x = first_invariant(U)
    derivatives = (0.5 * mu + (2.0 * c20 + 3.0 * c30 * x) * x, 2.0 * c20 + 6.0 * c30 * x)
    moduli = (mu, material.lame_lambda - 8.0 * c20, material.coupling_modulus)
    return fill(U, derivatives, moduli, P, C) + (0.5 * mu + (c20 + c30 * x) * x) * x


@material_law(_law)
class MicropolarYeoh(NamedTuple):
    """Micropolar Yeoh material.

    Parameters
    ----------
    shear_modulus : float
        mu of the linear limit, twice C10, Pa.
    lame_lambda : float
        lambda of the linear limit, Pa; at least eight times C20.
    c20, c30 : float
        C20 and C30, Pa. C20 may be negative while the stress still grows with the stretch: C20² < 3 C10 C30.
    coupling_modulus : float, optional
        eta, Pa; ties the micro-rotation to the macro-rotation. By default mu.
    length_scale : float, optional
        l, m; couple stress M̃ = mu l² G. By default a hundredth of the thickness.
    """

    shear_modulus: float
    lame_lambda: float
    c20: Annotated[float, Key("Stress", "$C_{20}$; may be negative while $C_{20}^2 < 3\\,C_{10}C_{30}$.")]
    c30: Annotated[float, Key("Stress", "$C_{30}$; $C_{10}$ is $\\mu/2$.")]
    coupling_modulus: float = BY_DEFAULT
    length_scale: float = BY_DEFAULT

    @property
    def couple_modulus(self) -> float:
        """Modulus mu l² of the couple stress, N."""
        return self.shear_modulus * self.length_scale**2

    def problems(self) -> list[str]:
        """What is wrong with the parameters beyond their signs."""
        if self.c30 < 0.0:
            return [f"c30 is {self.c30:g} Pa; below 0 the law softens without end"]
        if self.c20 < 0.0 and self.c20**2 >= 1.5 * self.shear_modulus * self.c30:
            least = -((1.5 * self.shear_modulus * self.c30) ** 0.5)
            return [f"c20 is {self.c20:g} Pa; with this shear_modulus and c30 it must be above {least:g} Pa"]
        if self.lame_lambda < 8.0 * self.c20:
            return [f"lame_lambda is {self.lame_lambda:g} Pa; with this c20 at least {8.0 * self.c20:g} Pa"]
        return []
