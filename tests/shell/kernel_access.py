"""The only place where tests call compiled functions of the shell directly."""

from __future__ import annotations

import numpy as np

from magshell.compiled import Kernel
from magshell.shell import point
from magshell.shell.point import workspace
from magshell.shell.section import section

SIZE = point.SIZE
_ORDER = {
    "du": (point.U1, (2, 3)),
    "dw": (point.W1, (2, 3)),
    "w": (point.W, (3,)),
    "enhanced": (point.ENHANCED, (3,)),
    "phi": (point.PHI, ()),
    "q": (point.Q, (4,)),
    "dq": (point.Q1, (2, 4)),
}


def unpack(x):
    """Named parts of what a point sees, x (31,)."""
    return {name: x[at : at + int(np.prod(shape, dtype=int))].reshape(shape) for name, (at, shape) in _ORDER.items()}


def pack(parts, concatenate=np.concatenate):
    """x (31,) of its named parts; pass the concatenation of another array library where needed."""
    order = sorted(_ORDER, key=lambda name: _ORDER[name][0])
    return concatenate([parts[name].reshape(-1) for name in order])


@Kernel
def _section(material, couple_modulus, coupling, B, geometry, remanence, e, p, x, P, kappa, mixed, g, g_mixed, H):
    return section(
        material, couple_modulus, coupling, B, geometry, remanence, e, p, x, P, kappa, mixed, True,
        workspace(), g, g_mixed, H,
    )  # fmt: skip


def gradient_and_hessian(d, e, p, x, B):
    """Internal and magnetic gradient (31,) and the Hessian (31, 31) of the point p of element e."""
    material, levels = d.model.shell.material, d.body.geometry.z.size
    g, g_mixed, H = np.zeros((SIZE, 2)), np.zeros(SIZE), np.zeros((SIZE, SIZE))
    determinant = _section(
        material, material.couple_modulus, d.model.coupling, np.asarray(B, dtype=float), d.body.geometry,
        d.body.remanence, e, p, x, np.zeros((levels, 3, 3)), np.zeros((2, 3)), False, g, g_mixed, H,
    )  # fmt: skip
    assert determinant > 0.0, f"the test's state is inadmissible: det F = {determinant:.3g}"
    return g[:, 0], g[:, 1], H
