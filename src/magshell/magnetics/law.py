"""What a magnetic coupling law is, and how the kernels call it.

A law says what the external flux density B does at a material point whose remanence B̃ (reference configuration) is
carried along by the deformation gradient, m = F B̃, and by the micro-rotation, n = R̃ B̃. Per unit reference volume
its virtual work on the residual is

    r = f_m · δm + f_ω · δω + f_x · δx,      δω the spin of the micro-rotation, x the position,

and its tangent, for increments of m, x and the spin δω of the fixed chart exp(δω) R̃, is K (9, 9). A law is one file:
a NamedTuple of its parameters, and a function

    law(coupling, m, n, B, gradients, forces, tangent) -> energy per unit reference volume

that adds to forces (9,) and tangent (9, 9), zero before; their rows M, OMEGA and X are those of m, ω and x.
`gradients` (36,) holds ∂B_i/∂x_j (9) and ∂²B_i/∂x_j∂x_k (27); in a uniform field they vanish, and what a law has in
the rows and columns X is not used. A law without a potential returns 0.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, Protocol, TypeVar

import numba
import numpy as np
from numba.np.unsafe.ndarray import to_fixed_tuple

from magshell.arrays import FloatArray, IntArray
from magshell.compiled import Callback, Kernel, also_compiled, call, table

M, OMEGA, X = 0, 3, 6
WORK, GRADIENTS = 9, 36


class Coupling(Protocol):
    """Parameters of a law."""

    @property
    def vacuum_permeability(self) -> float:
        """mu0, N/A²."""


CouplingLaw = Callable[..., float]
AnyCoupling = TypeVar("AnyCoupling", bound=type)

callbacks: dict[type, Callback] = {}
_conservative: set[type] = set()


def laws() -> list[type]:
    """All registered laws: every test of the battery runs over this list."""
    return list(callbacks)


def is_conservative(coupling: Coupling) -> bool:
    """Whether the law derives from an energy, so that the tangent is symmetric."""
    return type(coupling) in _conservative


def coupling_law(
    law: CouplingLaw | None = None, has_energy: bool | None = None, **named: Any
) -> Callable[[AnyCoupling], AnyCoupling]:
    """Register a NamedTuple class of parameters with its function; a law without energy is not conservative.

    Raises
    ------
    TypeError
        It is not given one function (earlier versions took two), or not told whether there is an energy.
    """
    if law is None or named or not isinstance(has_energy, bool):
        raise TypeError(
            "coupling_law takes one function, law(coupling, m, n, B, gradients, forces, tangent), that adds to forces "
            "and tangent and returns the energy: write @coupling_law(law, has_energy=True) (False, if it has none) in "
            "place of @coupling_law(forces=..., energy=...)"
        )

    def register(cls: AnyCoupling) -> AnyCoupling:
        callbacks[cls] = Callback(_called(law, cls), "ppppppp", cls, (law, coupling_law))
        if has_energy:
            _conservative.add(cls)
        return cls

    return register


def _called(law: CouplingLaw, cls: Any) -> Callable[..., float]:
    """The function that kernels call: of pointers. It puts a zero behind the forces, unless the law raises an error."""
    count = len(cls._fields)
    compiled: Any = also_compiled(law)

    def called(parameters: Any, m: Any, n: Any, B: Any, gradients: Any, forces: Any, tangent: Any) -> Any:
        coupling = cls(*to_fixed_tuple(numba.carray(parameters, (count,)), count))
        m, n, B = numba.carray(m, (3,)), numba.carray(n, (3,)), numba.carray(B, (3,))
        gradients, forces = numba.carray(gradients, (GRADIENTS,)), numba.carray(forces, (WORK + 1,))
        energy = compiled(coupling, m, n, B, gradients, forces[:WORK], numba.carray(tangent, (WORK, WORK)))
        forces[WORK] = 0.0
        return energy

    return called


class _Seen(NamedTuple):
    """What a law sees at some points: m, n and B (p, 3), gradients (p, 36)."""

    m: FloatArray
    n: FloatArray
    B: FloatArray
    gradients: FloatArray


@Kernel
def _at_points(
    address: int,
    parameters: FloatArray,
    seen: _Seen,
    energy: FloatArray,
    forces: FloatArray,
    tangent: FloatArray,
) -> None:
    m, n, B, gradients = seen.m, seen.n, seen.B, seen.gradients
    for p in range(len(m)):
        energy[p] = call(address, parameters, m[p], n[p], B[p], gradients[p], forces[p], tangent[p])


def evaluate(
    coupling: Coupling, m: FloatArray, n: FloatArray, B: FloatArray, gradients: FloatArray | None = None
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Energy, forces and tangent of a law.

    Parameters
    ----------
    coupling : Coupling
    m, n : ndarray, shape (..., 3)
        T.
    B : ndarray, shape (3,) or (..., 3)
        T.
    gradients : ndarray, shape (..., 36), optional
        Of B, T/m and T/m²; by default the field is uniform.

    Returns
    -------
    energy, forces, tangent : ndarray, shape (...,), (..., 9) and (..., 9, 9)
        Rows M, OMEGA, X.
    """
    places, count = np.shape(m)[:-1], int(np.prod(np.shape(m)[:-1]))
    energy, forces, tangent = np.zeros(count), np.zeros((count, WORK + 1)), np.zeros((count, WORK, WORK))
    forces[:, WORK] = np.nan
    m, n = (np.ascontiguousarray(one, dtype=float).reshape(-1, 3) for one in (m, n))
    slopes = np.zeros((*places, GRADIENTS)) if gradients is None else np.asarray(gradients, dtype=float)
    B = np.array(np.broadcast_to(B, (*places, 3)), dtype=float, order="C").reshape(-1, 3)
    seen = _Seen(m, n, B, np.ascontiguousarray(slopes.reshape(-1, GRADIENTS)))
    address, parameters = callbacks[type(coupling)].address, np.array(coupling, dtype=float)
    _at_points(address, parameters, seen, energy, forces, tangent)
    energy, forces = energy + forces[:, WORK], forces[:, :WORK] + forces[:, WORK:]
    return energy.reshape(places), forces.reshape(*places, WORK), tangent.reshape(*places, WORK, WORK)


@also_compiled
def pull(moment: FloatArray, gradients: FloatArray, mu0: float, forces: FloatArray, tangent: FloatArray) -> None:
    """Add the force of the energy -(1/mu0) moment · B(x) on the position, and its derivative by the position."""
    for i in range(3):
        for j in range(3):
            forces[X + j] -= moment[i] * gradients[3 * i + j] / mu0
            for k in range(3):
                tangent[X + j, X + k] -= moment[i] * gradients[9 + 9 * i + 3 * j + k] / mu0


def addresses(couplings: Sequence[Coupling]) -> tuple[IntArray, FloatArray]:
    """Addresses (n,) of some laws, and their parameters (n, most), padded with zeros."""
    return table([callbacks[type(coupling)] for coupling in couplings], couplings)
