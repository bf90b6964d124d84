"""What a material law is, and how the kernels call it.

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
from fractions import Fraction
from typing import Any, Protocol, TypeVar

import numba
import numpy as np
from numba.np.unsafe.ndarray import to_fixed_tuple

from magshell.arrays import FloatArray, IntArray
from magshell.compiled import Callback, Kernel, also_compiled, call, table
from magshell.materials.moduli import MODULI, lame_of

BY_DEFAULT: Any = None
"""In place of a coupling modulus or a length scale: what `completed` puts there when the thickness is known."""


class Multiple(float):
    """A multiple of the shear modulus or the thickness in place of a value, which is not a number before it is known.

    A shell of another thickness puts in another value.

    Attributes
    ----------
    factor : Fraction
    """

    factor: Fraction

    def __new__(cls, factor: Fraction | str, value: float = np.nan) -> Multiple:
        """With its value, where it is known."""
        made = super().__new__(cls, value)
        made.factor = Fraction(factor)
        return made

    def __getnewargs__(self) -> tuple[Any, ...]:
        return self.factor, float(self)

    def of(self, whole: float) -> Multiple:
        """With the nearest double to its value, for a shear modulus or a thickness."""
        return Multiple(self.factor, float(self.factor * Fraction(whole)))


DEFAULTS = {"coupling_modulus": Multiple("1"), "length_scale": Multiple("1/100")}
"""What is taken in place of `BY_DEFAULT`: of the shear modulus, and of the thickness."""


class Material(Protocol):
    """Parameters of a law; every one is a float in SI units.

    Coupling modulus and length scale may be left out: `Shell` puts in the shear modulus and a hundredth of its
    thickness. `from_moduli`, which `material_law` gives every law, takes other moduli.
    """

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

    The class receives the class method `from_moduli`.

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
        setattr(cls, "from_moduli", classmethod(_from_moduli))  # noqa: B010
        return cls

    return register


def _from_moduli(cls: Any, /, **parameters: Any) -> Any:
    """The material with two moduli of the linear limit, of any kind.

    Parameters
    ----------
    shear_modulus, lame_lambda, youngs_modulus, bulk_modulus : float
        Pa, and
    poissons_ratio : float
        at least 0 and below 0.5: two of the five.
    **parameters : float
        Those that the law has beside shear modulus and Lamé constant.

    Raises
    ------
    InputError
        Not two moduli, or two that do not go together.
    """
    mu, lam = lame_of({name: parameters.pop(name) for name in MODULI if name in parameters})
    return cls(shear_modulus=mu, lame_lambda=lam, **parameters)


def completed(material: Any, thickness: float, micro_rotation: bool = True) -> Any:
    """The material with what was left out or given as multiples; without micro-rotation both are 0."""
    values = {}
    for name, default in DEFAULTS.items():
        given = getattr(material, name, 0.0)
        multiple = default if given is BY_DEFAULT else given
        if isinstance(multiple, Multiple):
            whole = material.shear_modulus if name == "coupling_modulus" else thickness
            values[name] = multiple.of(whole if micro_rotation else 0.0)
    return material._replace(**values)


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
        Its length scale does not matter.
    U : ndarray, shape (..., 3, 3)
        With positive determinants.

    Returns
    -------
    W, P, C : ndarray, shape (...,), (..., 3, 3) and (..., 3, 3, 3, 3)
        J/m³ and Pa.
    """
    material = completed(material, thickness=0.0)
    points = np.ascontiguousarray(U, dtype=float).reshape(-1, 3, 3)
    count, places = len(points), np.shape(U)[:-2]
    W, P, C = np.empty(count), np.empty((count, 3, 3)), np.empty((count, 3, 3, 3, 3))
    _at_points(callbacks[type(material)].address, np.array(material, dtype=float), points, W, P, C)
    return W.reshape(places), P.reshape(*places, 3, 3), C.reshape(*places, 3, 3, 3, 3)


def addresses(materials: Sequence[Material]) -> tuple[IntArray, FloatArray]:
    """Addresses (n,) of the laws of some materials, and their parameters (n, most), padded with zeros."""
    return table([callbacks[type(material)] for material in materials], materials)
