r"""Reflection in a plane: when half a magnetised shell stands for the whole.

The reflection S = I - 2 n ⊗ n in the plane with unit normal n takes the point X to S X. If x(X), R̃(X) is a state of the
shell, its image is

    x'(S X) = S x(X),    F' = S F S,    R̃' = S R̃ S,    d' = S d.

u, the director and forces are *polar* vectors, a -> S a. An *axial* vector (rotation, moment) belongs to a skew matrix,
[a]× -> S [a]× S = [det(S) S a]×, and det S = -1, so a -> -S a. A pressure is a number; that it stays normal to the
surface makes its force a polar vector.

Half a model stands for the whole if every state has the energy of its image. A dead force f at X needs S f at S X; in
the plane itself f = S f, so that f lies in it, and a moment has only the component along n. A weight needs S g = g.
The energy of the remanence B̃ in the field B is bilinear in both,

    -(1/μ0) B · F B̃   and, of the image,   -(1/μ0) B' · S F S B̃'

(R̃ in place of F for the law of the micro-rotation; the couple F B̃ × B becomes, for these, -S of itself, as an axial
vector must). They are equal if the remanence of the other half and the field are

    B̃(S X) = σ S B̃(X)   and   S B = σ B   with one sign σ.

A uniform B thus lies in the plane (σ = 1, the other half has the mirrored remanence) or is normal to it (σ = -1, the
other half has it mirrored and reversed). In every other direction the two halves deform differently, and no support in
the plane can say how. As B is an axial vector of the currents that make it, and so is B̃, nature's own image is σ = -1;
reversing both is a further symmetry of the energy, and gives σ = 1.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import AnyArray, FloatArray

# Sine of an angle that is round-off of numbers as people type them: 0.06°.
TYPED = 1e-3
# Sine of the angle between surface and mirror plane below which the surface does not cross the plane.
TOUCHING = 1e-6


def polar(vectors: ArrayLike, normal: FloatArray) -> FloatArray:
    """Images S a of polar vectors (..., 3), for instance positions, forces and directors."""
    a = np.asarray(vectors, dtype=float)
    return np.asarray(a - 2.0 * (a @ normal)[..., None] * normal)


def axial(vectors: ArrayLike, normal: FloatArray) -> FloatArray:
    """Images -S a of axial vectors (..., 3), for instance moments and rotations."""
    return -polar(vectors, normal)


def in_plane(vector: FloatArray, normal: FloatArray) -> bool:
    """Whether S a = a, as of a force in the plane."""
    return _same(vector, polar(vector, normal))


def is_normal(vector: FloatArray, normal: FloatArray) -> bool:
    """Whether S a = -a, as of a moment in the plane."""
    return _same(vector, axial(vector, normal))


def _same(vector: FloatArray, image: FloatArray) -> bool:
    return bool(np.linalg.norm(image - vector) <= 2.0 * TYPED * np.linalg.norm(vector))


def angle_to_plane(vector: FloatArray, normal: FloatArray) -> float:
    """Angle between a vector and the plane, degrees from 0 to 90."""
    sine = abs(float(vector @ normal)) / float(np.linalg.norm(vector))
    return float(np.degrees(np.arcsin(min(sine, 1.0))))


def in_mirror_planes(normals: FloatArray, planes: Iterable[tuple[AnyArray, FloatArray]]) -> FloatArray:
    """Normals (n, 3) of a surface, in the planes that some of them meet: the average with the mirror image.

    `planes` are pairs of a mask (n,) and a unit normal. Where the surface touches a plane nothing changes.
    """
    for meets, plane in planes:
        inside = normals[meets] - np.outer(normals[meets] @ plane, plane)
        length = np.linalg.norm(inside, axis=1)
        crosses = length > TOUCHING
        at = np.flatnonzero(meets)[crosses]
        normals[at] = inside[crosses] / length[crosses, None]
    return normals
