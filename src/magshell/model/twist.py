r"""The angle of a rotation about an axis, and its derivatives.

A rotation p = (p_0, p) turns by

    ψ = 2 atan2(t, p_0),      t = p · T,

about the unit vector T, continuous up to two turns. Where p turns by δp = ½ Ω p,

    δψ = g · Ω,      g = (p_0² T + p_0 p × T + t p) / (p_0² + t²).
"""

from __future__ import annotations

import numpy as np

from magshell.arrays import FloatArray
from magshell.model.loads.cross import cross_matrix
from magshell.shell.rotation import cross


def twist(p: FloatArray, T: FloatArray) -> tuple[FloatArray, FloatArray]:
    """ψ (n,) and g (n, 3) of quaternions (n, 4) about axes (n, 3)."""
    p_0, vector = p[:, :1], p[:, 1:]
    t = np.sum(vector * T, axis=1, keepdims=True)
    g = (p_0**2 * T + p_0 * cross(vector, T) + t * vector) / (p_0**2 + t**2)
    return 2.0 * np.arctan2(t, p_0)[:, 0], g


def twist_slope(p: FloatArray, T: FloatArray) -> FloatArray:
    """dg/dΩ (n, 3, 3)."""
    p_0, vector = p[:, :1, None], p[:, 1:]
    t = np.sum(vector * T, axis=1)[:, None, None]
    d_p0 = -0.5 * _row(vector)
    d_vector = 0.5 * (p_0 * np.eye(3) - cross_matrix(vector))
    d_t = 0.5 * (p_0 * _row(T) + _row(cross(vector, T)))
    N = p_0**2 * _column(T) + p_0 * _column(cross(vector, T)) + t * _column(vector)
    D = p_0**2 + t**2
    d_N = (2.0 * p_0 * _column(T) + _column(cross(vector, T))) * d_p0 - p_0 * cross_matrix(T) @ d_vector
    d_N = d_N + _column(vector) * d_t + t * d_vector
    return np.asarray((d_N - N / D * (2.0 * p_0 * d_p0 + 2.0 * t * d_t)) / D)


def _column(vectors: FloatArray) -> FloatArray:
    return vectors[:, :, None]


def _row(vectors: FloatArray) -> FloatArray:
    return vectors[:, None, :]
