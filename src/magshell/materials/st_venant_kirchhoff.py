r"""Micropolar St Venant–Kirchhoff material: linear between the second Piola–Kirchhoff stress and Green's strain.

Energy per unit reference volume, of U = R̃ᵀF, with E = (UᵀU - I)/2 and the relative rotation of the other laws:

    W = lambda/2 (tr E)² + mu tr(E²) + eta/2 (tr(U Uᵀ) - tr(U²)).

Stress, with S = lambda tr(E) I + 2 mu E:

    P = U S + eta (U - Uᵀ).

Tangent:

    C_pjql = δ_pq S_jl + lambda U_pj U_ql + mu ((U Uᵀ)_pq δ_jl + U_pl U_qj) + eta (δ_pq δ_jl - δ_pl δ_jq).

For moderate strains: under compression to det U = 0 the energy stays finite. Published shell problems use it (its
limit without micro-rotation, eta = 0, is the classical law).
"""

from __future__ import annotations

from typing import NamedTuple

from magshell.arrays import FloatArray
from magshell.materials.law import BY_DEFAULT, Material, material_law


def _law(material: Material, U: FloatArray, P: FloatArray, C: FloatArray) -> float:
    mu, eta, lam = material.shear_modulus, material.coupling_modulus, material.lame_lambda
    trace, square, skew = -1.5, 0.0, 0.0
    for p in range(3):
        for j in range(3):
            trace += 0.5 * U[p, j] * U[p, j]
            skew += U[p, j] * (U[p, j] - U[j, p])
            P[p, j] = eta * (U[p, j] - U[j, p])
            for q in range(3):
                for l in range(3):
                    C[p, j, q, l] = lam * U[p, j] * U[q, l] + mu * U[p, l] * U[q, j]
    for j in range(3):
        for l in range(3):
            strain = 0.5 * (U[0, j] * U[0, l] + U[1, j] * U[1, l] + U[2, j] * U[2, l])
            left = mu * (U[j, 0] * U[l, 0] + U[j, 1] * U[l, 1] + U[j, 2] * U[l, 2])
            if j == l:
                strain -= 0.5
            S = 2.0 * mu * strain
            if j == l:
                S += lam * trace
            square += strain**2
            for p in range(3):
                P[p, j] += U[p, l] * S
                C[p, j, p, l] += S
                C[j, p, l, p] += left
            C[j, l, j, l] += eta
            C[j, l, l, j] -= eta
    return 0.5 * lam * trace**2 + mu * square + 0.5 * eta * skew


@material_law(_law)
class MicropolarStVenantKirchhoff(NamedTuple):
    """Micropolar St Venant–Kirchhoff material.

    Parameters
    ----------
    shear_modulus : float
        mu, Pa.
    lame_lambda : float
        lambda, Pa.
    coupling_modulus : float, optional
        eta, Pa; ties the micro-rotation to the macro-rotation. By default mu.
    length_scale : float, optional
        l, m; couple stress M̃ = mu l² G. By default a hundredth of the thickness.
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
