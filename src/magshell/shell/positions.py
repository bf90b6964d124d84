"""Where the levels of a deformed shell are (`varying_field.py` has their formula)."""

from __future__ import annotations

import numpy as np

from magshell.arrays import FloatArray
from magshell.shell.body import Reference
from magshell.shell.state import State


def level_positions(reference: Reference, state: State) -> FloatArray:
    """Positions (elements, p, k, 3) of the levels, m."""
    body, shape = reference.body, reference.shape
    rows, phi = body.elements[:, : body.layout.w], body.elements[:, : body.layout.phi]
    middle = np.einsum("epn,enx->epx", body.points["position"], reference.coordinates + state.u[body.elements])
    directors = (1.0 + state.s[rows][..., None]) * (body.normals[:, : body.layout.w] + state.w[rows])
    d = np.einsum("epn,enx->epx", shape.director[:, :, 0], directors)
    φ = np.einsum("epn,en->ep", shape.phi, state.phi[phi])
    if body.by_level is not None:
        φ[body.by_level] = 0.0
    z = body.levels["z"]
    return np.asarray(middle[:, :, None] + (z * (1.0 + z * φ[..., None]))[..., None] * d[:, :, None])
