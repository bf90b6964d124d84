"""Strain energies of the material laws, written independently of the package, for arrays of jets."""

from __future__ import annotations

import numpy as np
from shell.jets import log

from magshell.materials import (
    MicropolarGent,
    MicropolarMooneyRivlin,
    MicropolarNeoHookean,
    MicropolarStVenantKirchhoff,
    MicropolarYeoh,
)


def cofactor(U):
    """Rows are the cross products of the other two rows."""
    return np.cross(U[[1, 2, 0]], U[[2, 0, 1]])


def determinant(U):
    return U[0] @ cofactor(U)[0]


def relative_rotation(material, U):
    """eta/4 |U - Uᵀ|²: what holds the micro-rotation to the macro-rotation."""
    return 0.25 * material.coupling_modulus * np.sum((U - U.T) ** 2)


def neo_hookean(material, U):
    """mu/2 (|U|² - 3) - mu ln J + lambda/2 (ln J)²."""
    log_J, mu, lam = log(determinant(U)), material.shear_modulus, material.lame_lambda
    return 0.5 * mu * (np.sum(U**2) - 3) - mu * log_J + 0.5 * lam * log_J**2 + relative_rotation(material, U)


def mooney_rivlin(material, U):
    """Second invariant |cof U|², volumetric energy of Simo and Taylor."""
    J, share = determinant(U), material.second_invariant_share
    mu1, mu2 = (1 - share) * material.shear_modulus, share * material.shear_modulus
    invariants = 0.5 * mu1 * (np.sum(U**2) - 3) + 0.5 * mu2 * (np.sum(cofactor(U) ** 2) - 3)
    volumetric = 0.25 * (material.lame_lambda - 2 * mu2) * (J**2 - 1 - 2 * log(J))
    return invariants - (mu1 + 2 * mu2) * log(J) + volumetric + relative_rotation(material, U)


def st_venant_kirchhoff(material, U):
    """lambda/2 (tr E)² + mu tr E² with 2 tr E = I_1 - 3 and 4 tr E² = tr C² - 2 I_1 + 3, C = UᵀU."""
    C = U.T @ U
    first = np.trace(C)
    square = np.sum(C * C)
    volumetric = 0.125 * material.lame_lambda * (first - 3) ** 2
    return volumetric + 0.25 * material.shear_modulus * (square - 2 * first + 3) + relative_rotation(material, U)


def gent(material, U):
    """Gent's logarithm of tr C, and what makes the undeformed state free of stress with lambda as its constant."""
    mu, limit, log_J = material.shear_modulus, material.extension_limit, log(determinant(U))
    distortion = -0.5 * mu * limit * log((limit + 3 - np.trace(U.T @ U)) * (1 / limit))
    bulk = material.lame_lambda - 2 * mu / limit
    return distortion - mu * log_J + 0.5 * bulk * log_J**2 + relative_rotation(material, U)


def yeoh(material, U):
    """C10 x + C20 x² + C30 x³ with x = tr C - 3."""
    x, log_J, mu = np.trace(U.T @ U) - 3, log(determinant(U)), material.shear_modulus
    cubic = 0.5 * mu * x + material.c20 * x * x + material.c30 * x * x * x
    bulk = material.lame_lambda - 8 * material.c20
    return cubic - mu * log_J + 0.5 * bulk * log_J**2 + relative_rotation(material, U)


ENERGIES = {
    MicropolarNeoHookean: neo_hookean,
    MicropolarMooneyRivlin: mooney_rivlin,
    MicropolarStVenantKirchhoff: st_venant_kirchhoff,
    MicropolarGent: gent,
    MicropolarYeoh: yeoh,
}
"""W(U) by law; a new law needs its entry here."""
