"""The only place where tests call compiled functions of the shell directly."""

from __future__ import annotations

import numpy as np

from magshell.compiled import Kernel
from magshell.shell import point
from magshell.shell.bubble import hold_vector
from magshell.shell.element import padded
from magshell.shell.point import workspace
from magshell.shell.section import LocalField, Mixed, Request, section

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
def _section(body, request, e, p, x, mixed, energy, g, H):
    records, across = workspace(), np.zeros((4, body.levels.shape[2]))
    w = records[0]
    w.x[:] = x
    point, levels, B = body.points[e, p], body.levels[e, p], request.field.flux_density[0, p]
    least = section(w, point, levels[: point.levels], request, B, None, mixed, across)
    energy[:], g[:, :], H[:, :] = w.energy, w.g, w.H[:, : len(x)]
    return least + 0.0 * len(records)


def energy_gradient_and_hessian(d, e, p, x, B, body=None):
    """Energies (2,) and gradients (31, 2), internal and magnetic, and the Hessian (31, 31) of the point p of element e.

    `body` is the discretisation's unless given.
    """
    body = body or d.reference.body
    field = LocalField(np.array(np.broadcast_to(B, (1, *body.levels.shape[1:], 3)), dtype=float, order="C"), None)
    request = Request(body.laws, field, mixed=False, tangent=True)
    energy, g, H = np.zeros(2), np.zeros((SIZE, 3)), np.zeros((SIZE, SIZE))
    S, kappa = np.zeros((body.levels.shape[2], 3, 3)), np.zeros((2, 3))
    determinant = _section(body, request, e, p, x, Mixed(S, kappa), energy, g, H)
    assert determinant > 0.0, f"the test's state is inadmissible: det F = {determinant:.3g}"
    return energy, g[:, :2], H


@Kernel
def _hold(held, number, e, layout, v, vectors, r, K):
    return hold_vector(held, number, e, layout, v, vectors, r, K)


def held_energy(held, number, e, layout, alpha):
    """Energy of a held vector (3,) of the undeformed element e."""
    size = 3 * layout.u + 3 * layout.w + layout.phi + 3 * layout.q + 3 * layout.modes
    v, r, K = np.zeros(size + layout.q), np.zeros((size, 3)), np.zeros((size, padded(size)))
    v[layout.at_q + 4 * layout.q + layout.modes - 1 - number :: layout.modes] = alpha
    return _hold(held, number, e, layout, v, np.zeros((5, 3)), r, K)
