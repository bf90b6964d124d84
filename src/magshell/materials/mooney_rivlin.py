r"""Micropolar Mooney–Rivlin material with the volumetric energy of Simo and Taylor.

With C = UᵀU = FᵀF, its invariants I1 = tr C, I2 = (I1² - tr C²)/2, J = det U, and the shear modulus shared between
the two invariants, mu1 = (1 - s) mu and mu2 = s mu, the energy per unit reference volume is

    W = mu1/2 (I1 - 3) + mu2/2 (I2 - 3) - (mu1 + 2 mu2) ln J + k/4 (J² - 1 - 2 ln J) + eta/2 (tr(U Uᵀ) - tr(U²)),

where k = lambda - 2 mu2 makes mu and lambda the Lamé constants of the linear limit. Stress, with V = U⁻ᵀ:

    P = mu1 U + mu2 (I1 U - U UᵀU) - (mu1 + 2 mu2) V + k/2 (J² - 1) V + eta (U - Uᵀ).

Tangent, with B = U Uᵀ and dV_pj / dU_ql = -V_pl V_qj:

    C_pjql = mu1 δ_pq δ_jl + mu2 (2 U_pj U_ql + I1 δ_pq δ_jl - δ_pq C_lj - U_pl U_qj - B_pq δ_jl)
           + (mu1 + 2 mu2 - k/2 (J² - 1)) V_pl V_qj + k J² V_pj V_ql + eta (δ_pq δ_jl - δ_pl δ_jq).
"""

from __future__ import annotations

from typing import Annotated, NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.keys import Key
from magshell.materials.law import BY_DEFAULT, material_law
from magshell.materials.tensors import inverse_transpose


def _law(material: MicropolarMooneyRivlin, U: FloatArray, P: FloatArray, C: FloatArray) -> float:
    eta = material.coupling_modulus
    mu2 = material.second_invariant_share * material.shear_modulus
    mu1 = material.shear_modulus - mu2
    bulk = material.lame_lambda - 2.0 * mu2
    V, J = inverse_transpose(U)
    right, left, cubic = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    for i in range(3):
        for k in range(3):
            right[i, k] = U[0, i] * U[0, k] + U[1, i] * U[1, k] + U[2, i] * U[2, k]
            left[i, k] = U[i, 0] * U[k, 0] + U[i, 1] * U[k, 1] + U[i, 2] * U[k, 2]
    for i in range(3):
        for k in range(3):
            cubic[i, k] = U[i, 0] * right[0, k] + U[i, 1] * right[1, k] + U[i, 2] * right[2, k]
    I1 = right[0, 0] + right[1, 1] + right[2, 2]
    pressure = mu1 + 2.0 * mu2 - 0.5 * bulk * (J**2 - 1.0)
    squares, skew = 0.0, 0.0
    for p in range(3):
        for j in range(3):
            squares += right[p, j] * right[p, j]
            skew += U[p, j] * (U[p, j] - U[j, p])
            P[p, j] = (mu1 + mu2 * I1) * U[p, j] - mu2 * cubic[p, j] - pressure * V[p, j] + eta * (U[p, j] - U[j, p])
            for q in range(3):
                for l in range(3):
                    C[p, j, q, l] = (
                        mu2 * (2.0 * U[p, j] * U[q, l] - U[p, l] * U[q, j])
                        + pressure * V[p, l] * V[q, j]
                        + bulk * J**2 * V[p, j] * V[q, l]
                    )
    for p in range(3):
        for j in range(3):
            C[p, j, p, j] += mu1 + mu2 * I1 + eta
            C[p, j, j, p] -= eta
            for k in range(3):
                C[p, j, p, k] -= mu2 * right[k, j]
                C[p, j, k, j] -= mu2 * left[p, k]
    I2 = 0.5 * (I1**2 - squares)
    distortion = 0.5 * mu1 * (I1 - 3.0) + 0.5 * mu2 * (I2 - 3.0) - (mu1 + 2.0 * mu2) * np.log(J)
    return distortion + 0.25 * bulk * (J**2 - 1.0 - 2.0 * np.log(J)) + 0.5 * eta * skew


@material_law(_law)
class MicropolarMooneyRivlin(NamedTuple):
    """Micropolar Mooney–Rivlin material.

    Parameters
    ----------
    shear_modulus : float
        mu of the linear limit, Pa.
    lame_lambda : float
        lambda of the linear limit, Pa; at least twice the second invariant's share of mu.
    coupling_modulus : float, optional
        eta, Pa; ties the micro-rotation to the macro-rotation. By default mu.
    length_scale : float, optional
        l, m; couple stress M̃ = mu l² G. By default a hundredth of the thickness.
    second_invariant_share : float
        s in [0, 1): part of mu carried by the second invariant.
    """

    shear_modulus: float
    lame_lambda: float
    coupling_modulus: float = BY_DEFAULT
    length_scale: float = BY_DEFAULT
    second_invariant_share: Annotated[
        float, Key("Number", "Part of $\\mu$ carried by the second invariant, in [0, 1).")
    ] = 0.25

    @property
    def couple_modulus(self) -> float:
        """Modulus mu l² of the couple stress, N."""
        return self.shear_modulus * self.length_scale**2

    def problems(self) -> list[str]:
        """What is wrong with the parameters beyond their signs."""
        if not 0.0 <= self.second_invariant_share < 1.0:
            return [f"second_invariant_share is {self.second_invariant_share:g}; it must be at least 0 and below 1"]
        least = 2.0 * self.second_invariant_share * self.shear_modulus
        if self.lame_lambda < least:
            return [f"lame_lambda is {self.lame_lambda:g} Pa; with this second_invariant_share at least {least:g} Pa"]
        return []
