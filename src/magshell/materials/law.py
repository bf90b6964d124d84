"""What a material law is, and how the kernels reach the one in use.

A law is a free energy Psi = W(U) + (gamma/2) tr(G Gᵀ) per unit reference volume, of the micropolar stretch
U = R̃ᵀF and the wryness G. It is one file: a NamedTuple of its parameters, and a function of U,

    law(material, U, P, C) -> W,      P = dW/dU (3, 3),      C = d²W/dUdU (3, 3, 3, 3),

that fills P and C. The couple-stress part is the same for all laws: gamma is the law's `couple_modulus`.

Kernels call it through a pointer, with the signature of laws that also have a memory and depend on the temperature:

    law(parameters, U, memory, time_step, temperature, P, C, memory_after) -> W.

The first number of `memory_after` is NaN before the call. A law that raises an error leaves it, and the residual is
NaN.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Protocol, TypeVar

import numba
import numpy as np
from numba.np.unsafe.ndarray import to_fixed_tuple

from magshell.arrays import FloatArray, IntArray
from magshell.compiled import Callback, Kernel, also_compiled, call, table


class Material(Protocol):
    """Parameters of a law; every one is a float in SI units."""

    @property
    def shear_modulus(self) -> float:
        """Shear modulus mu of the linear limit, Pa."""

    @property
    def lame_lambda(self) -> float:
        """First Lamé constant of the linear limit, Pa."""

    @property
    def coupling_modulus(self) -> float:
        """Modulus eta that ties the micro-rotation to the macro-rotation, Pa."""

    @property
    def length_scale(self) -> float:
        """Length scale l, m."""

    @property
    def couple_modulus(self) -> float:
        """Modulus gamma = mu l² of the couple stress M̃ = gamma G, N."""

    def problems(self) -> list[str]:
        """What is wrong with the parameters beyond their signs, a sentence each."""


ElasticLaw = Callable[..., float]
AnyMaterial = TypeVar("AnyMaterial", bound=type)

callbacks: dict[type, Callback] = {}


def laws() -> list[type]:
    """All registered laws: every test of the battery runs over this list."""
    return list(callbacks)


def material_law(law: ElasticLaw | None = None, *more: Any, **named: Any) -> Callable[[AnyMaterial], AnyMaterial]:
    """Register a NamedTuple class of parameters with its function `law(material, U, P, C) -> W`.

    Raises
    ------
    TypeError
        It is not given one function: earlier versions took two.
    """
    if law is None or more or named:
        raise TypeError(
            "material_law takes one function, law(material, U, P, C), that fills the stress P and the tangent C and "
            "returns the energy: write @material_law(law) in place of @material_law(energy=..., stress=...)"
        )

    def register(cls: AnyMaterial) -> AnyMaterial:
        callbacks[cls] = Callback(_elastic(law, cls), "pppddppp", cls, (law, material_law))
        return cls

    return register


def _elastic(law: ElasticLaw, cls: Any) -> Callable[..., float]:
    """The function that kernels call: of pointers, and without a memory."""
    count = len(cls._fields)
    compiled: Any = also_compiled(law)

    def called(
        parameters: Any,
        U: Any,
        memory: Any,
        time_step: float,
        temperature: float,
        P: Any,
        C: Any,
        memory_after: Any,
    ) -> Any:
        material = cls(*to_fixed_tuple(numba.carray(parameters, (count,)), count))
        U, P, C = numba.carray(U, (3, 3)), numba.carray(P, (3, 3)), numba.carray(C, (3, 3, 3, 3))
        energy = compiled(material, U, P, C)
        numba.carray(memory_after, (1,))[0] = 0.0
        return energy

    return called


@Kernel
def _at_points(
    address: int, parameters: FloatArray, U: FloatArray, W: FloatArray, P: FloatArray, C: FloatArray
) -> None:
    memory, memory_after = np.zeros(1), np.zeros(1)
    for n in range(len(U)):
        memory_after[0] = np.nan
        W[n] = call(address, parameters, U[n], memory, 0.0, 0.0, P[n], C[n], memory_after)
        P[n, 0, 0] += memory_after[0]


def evaluate(material: Material, U: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Energy, stress and tangent of a law.

    Parameters
    ----------
    material : Material
    U : ndarray, shape (..., 3, 3)
        With positive determinants.

    Returns
    -------
    W, P, C : ndarray, shape (...,), (..., 3, 3) and (..., 3, 3, 3, 3)
        J/m³ and Pa.
    """
    points = np.ascontiguousarray(U, dtype=float).reshape(-1, 3, 3)
    count, places = len(points), np.shape(U)[:-2]
    W, P, C = np.empty(count), np.empty((count, 3, 3)), np.empty((count, 3, 3, 3, 3))
    _at_points(callbacks[type(material)].address, np.array(material, dtype=float), points, W, P, C)
    return W.reshape(places), P.reshape(*places, 3, 3), C.reshape(*places, 3, 3, 3, 3)


def addresses(materials: Sequence[Material]) -> tuple[IntArray, FloatArray]:
    """Addresses (n,) of the laws of some materials, and their parameters (n, most), padded with zeros."""
    return table([callbacks[type(material)] for material in materials], materials)
