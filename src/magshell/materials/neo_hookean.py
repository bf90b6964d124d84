r"""Micropolar neo-Hookean material.

Energy per unit reference volume, of U = R̃ᵀF with J = det U (the form whose derivative is the stress printed in
Dadgar-Rad and Hossain, *A micropolar shell model for hard-magnetic soft materials*, eq. PK11; the energy printed
there has twice the eta):

    W = (mu + eta)/2 tr(U Uᵀ) - eta/2 tr(U²) + lambda/2 (ln J)² - mu ln J - 3 mu/2,

zero in the undeformed state.
Stress, with d ln J / dU = U⁻ᵀ:

    P = (mu + eta) U - eta Uᵀ - (mu - lambda ln J) U⁻ᵀ.

Tangent, with d(U⁻ᵀ)_pj / dU_ql = -(U⁻ᵀ)_pl (U⁻ᵀ)_qj:

    C_pjql = (mu + eta) δ_pq δ_jl - eta δ_pl δ_jq + lambda U⁻ᵀ_pj U⁻ᵀ_ql + (mu - lambda ln J) U⁻ᵀ_pl U⁻ᵀ_qj.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.materials.law import BY_DEFAULT, Material, material_law
from magshell.materials.tensors import inverse_transpose


def _law(material: Material, U: FloatArray, P: FloatArray, C: FloatArray) -> float:
    mu, eta, lam = material.shear_modulus, material.coupling_modulus, material.lame_lambda
    V, J = inverse_transpose(U)
    log_J = np.log(J)
    pressure = mu - lam * log_J
    square, product = 0.0, 0.0
    for p in range(3):
        for j in range(3):
            square += U[p, j] * U[p, j]
            product += U[p, j] * U[j, p]
            P[p, j] = (mu + eta) * U[p, j] - eta * U[j, p] - pressure * V[p, j]
            for q in range(3):
                for l in range(3):
                    C[p, j, q, l] = lam * V[p, j] * V[q, l] + pressure * V[p, l] * V[q, j]
    for p in range(3):
        for j in range(3):
            C[p, j, p, j] += mu + eta
            C[p, j, j, p] -= eta
    return 0.5 * (mu + eta) * square - 0.5 * eta * product + 0.5 * lam * log_J**2 - mu * log_J - 1.5 * mu


@material_law(_law)
class MicropolarNeoHookean(NamedTuple):
    """Micropolar neo-Hookean material.

    Parameters
    ----------
    shear_modulus : float
        mu, Pa.
    lame_lambda : float
        lambda, Pa.
    coupling_modulus : float, optional
        eta, Pa; ties the micro-rotation to the macro-rotation (mu/10 in the source). By default mu.
    length_scale : float, optional
        l, m; couple stress M̃ = mu l² G. By default a hundredth of the thickness (a tenth in the source).
    """

    shear_modulus: float
    lame_lambda: float
    coupling_modulus: float = BY_DEFAULT
    length_scale: float = BY_DEFAULT

    @property
    def couple_modulus(self) -> float:
        """Modulus mu l² of the couple stress, N."""
        return self.shear_modulus * self.length_scale**2

    def problems(self) -> list[str]:
        """What is wrong with the parameters beyond their signs."""
        return []
