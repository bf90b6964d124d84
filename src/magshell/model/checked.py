"""Checks of the materials and numbers that a shell is made of."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from magshell.arguments import real, shown
from magshell.arrays import FloatArray, three_finite
from magshell.errors import InputError
from magshell.materials import BY_DEFAULT, DEFAULTS, Multiple, own_keys


def checked_material(where: str, material: Any, micro_rotation: bool) -> Any:
    """A material whose parameters are finite numbers in their range.

    Raises
    ------
    InputError
        They are not, or they are of a micro-rotation that the shell does not have.
    """
    if isinstance(material, type) or not hasattr(material, "_fields") or not hasattr(material, "problems"):
        raise InputError(
            f"{where} is {shown(material)}; it must be a material law with its parameters, "
            "as ms.MicropolarNeoHookean(shear_modulus, lame_lambda)"
        )
    values = []
    signed = [name for name, key in own_keys(type(material)).items() if key.kind in ("Number", "Stress")]
    for name, value in zip(material._fields, material, strict=True):
        if name in DEFAULTS and (value is BY_DEFAULT or isinstance(value, Multiple)):
            values.append(value)
            continue
        value = real(f"{where}: {name}", value)
        positive_ = name == "shear_modulus" or (name == "length_scale" and micro_rotation)
        if not np.isfinite(value) or (name not in signed and (value < 0.0 or (value == 0.0 and positive_))):
            allowed = "" if name in signed else " and positive" if positive_ else " and zero or positive"
            raise InputError(f"{where}: {name} is {value:g}; it must be finite{allowed}")
        values.append(value)
        if not micro_rotation and name in ("coupling_modulus", "length_scale") and value > 0.0:
            raise InputError(
                f"{where}: {name} is {value:g}; without micro-rotation it must be 0: leave it out or write 0"
            )
    checked = type(material)(*values)
    for problem in checked.problems():
        raise InputError(f"{where}: {problem}")
    return checked


def positive(where: str, value: Any, unit: str) -> float:
    """A positive finite number.

    Raises
    ------
    InputError
        It is not.
    """
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise InputError(f"{where} is {value!r}; it must be a number ({unit})") from None
    if not np.isfinite(number) or number <= 0.0:
        raise InputError(f"{where} is {number:g} {unit}; it must be positive and finite")
    return number


def three_numbers(where: str, name: str, value: ArrayLike) -> FloatArray:
    """Three finite numbers.

    Raises
    ------
    InputError
        They are not.
    """
    found = three_finite(value)
    if found is None:
        raise InputError(f"{where}: {name} is {value!r}; it needs 3 finite numbers")
    return found
