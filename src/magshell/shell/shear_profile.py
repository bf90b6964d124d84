r"""Transverse shear of layers, from equilibrium in cylindrical bending.

A director is straight across the thickness, so that it gives every layer the same shear strain, and a sandwich the
stiffness of its faces. In the bending of a laminate to a cylinder, with E' = E/(1 - ν²) of each layer, z_0 the neutral
axis and D = ∫ E' (z - z_0)² dz, a shear force Q makes the shear stress

    τ = Q S(z) / D,    S(z) = -∫_bottom^z E' (ζ - z_0) dζ,

whose energy ½ ∫ τ²/G dz is ½ Q²/K with the shear stiffness K = D² / ∫ S²/G dz. With the strain γ of the director,
Q = K γ, the strain of a level is τ/G = r γ, r = K S/(D G). In a homogeneous section K is 5/6 G h and r runs from 0 at
the faces to 5/4 in the middle.

The levels take r γ for their shear strain (`level.py`), scaled so that Σ G r² dz over the levels is K.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from magshell.arrays import FloatArray

# Gauss points of a layer that integrate S², of degree four, exactly.
POINTS = 3


class Moduli(NamedTuple):
    """Small-strain moduli of a layer: E' = E/(1 - ν²) and G, Pa."""

    plane: float
    shear: float

    @classmethod
    def of(cls, material: Any) -> Moduli:
        """Of a material law."""
        μ, λ = material.shear_modulus, material.lame_lambda
        return cls(4.0 * μ * (λ + μ) / (λ + 2.0 * μ), μ)


class Stiffness(NamedTuple):
    """Of a section, per width: bending D (N m) and transverse shear K (N/m), arrays (...,)."""

    bending: FloatArray
    shear: FloatArray


def stiffness(layers: FloatArray, moduli: Sequence[Moduli]) -> Stiffness:
    """Bending and shear stiffness of sections of layers (..., layers), m, from the bottom to the top."""
    parent, weights = np.polynomial.legendre.leggauss(POINTS)
    S, bending = _first_moment(layers, moduli, parent)
    G = np.array([one.shear for one in moduli])
    flexibility = np.einsum("...lg,...l,g->...", S**2, 0.5 * layers / G, weights)
    return Stiffness(bending, np.asarray(bending**2 / flexibility))


def profile(layers: FloatArray, moduli: Sequence[Moduli], parent: FloatArray, weights: FloatArray) -> FloatArray:
    """r - 1 (..., layers × points) at Gauss points of every layer, from the bottom to the top."""
    S, bending = _first_moment(layers, moduli, parent)
    shear = stiffness(layers, moduli).shear
    G = np.array([one.shear for one in moduli])
    r = S / (bending[..., None, None] * G[:, None])
    own = np.einsum("...lg,...l,g->...", r**2, 0.5 * layers * G, weights)
    scaled = r * np.sqrt(shear / own)[..., None, None]
    return np.asarray(scaled.reshape(*layers.shape[:-1], -1) - 1.0)


def middle(layers: FloatArray, moduli: Sequence[Moduli]) -> FloatArray:
    """r - 1 (...,) half-way between the faces."""
    half = 0.5 * layers.sum(axis=-1)
    tops = np.cumsum(layers, axis=-1)
    layer = np.argmax(tops >= half[..., None] * (1.0 - 1e-12), axis=-1)[..., None]
    z = np.take_along_axis(tops - 0.5 * layers, layer, axis=-1)[..., 0]
    thickness = np.take_along_axis(layers, layer, axis=-1)[..., 0]
    parent = 2.0 * (half - z) / thickness
    S, bending = _first_moment(layers, moduli, parent[..., None, None])
    G = np.array([one.shear for one in moduli])[layer[..., 0]]
    own = np.take_along_axis(S[..., 0], layer, axis=-1)[..., 0]
    return np.asarray(stiffness(layers, moduli).shear * own / (bending * G) - 1.0)


def _first_moment(layers: FloatArray, moduli: Sequence[Moduli], parent: FloatArray) -> tuple[FloatArray, FloatArray]:
    """S (..., layers, points), N, at parent points of the layers, and D (...,), N m."""
    E = np.array([one.plane for one in moduli])
    bottoms = np.cumsum(layers, axis=-1) - layers
    centres = bottoms + 0.5 * layers
    axis = np.sum(E * layers * centres, axis=-1, keepdims=True) / np.sum(E * layers, axis=-1, keepdims=True)
    low, high = bottoms - axis, bottoms + layers - axis
    bending = np.sum(E / 3.0 * (high**3 - low**3), axis=-1)
    whole = 0.5 * E * (high**2 - low**2)
    below = np.cumsum(whole, axis=-1) - whole
    z = (centres - axis)[..., None] + 0.5 * layers[..., None] * parent
    S = -(below[..., None] + 0.5 * E[:, None] * (z**2 - low[..., None] ** 2))
    return np.asarray(S), np.asarray(bending)
