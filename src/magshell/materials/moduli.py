"""Moduli of the isotropic linear limit: any two of five determine shear modulus and Lamé constant."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

from magshell.errors import InputError
from magshell.keys import Key

MODULI: Mapping[str, Key] = {
    "shear_modulus": Key("PositiveStress", "$\\mu$.", "from two others"),
    "lame_lambda": Key("NonNegativeStress", "$\\lambda$.", "from two others"),
    "youngs_modulus": Key("PositiveStress", "$E$.", "from two others"),
    "poissons_ratio": Key("Number", "$\\nu$, at least 0 and below 0.5.", "from two others"),
    "bulk_modulus": Key("PositiveStress", "$K$.", "from two others"),
}
"""The five moduli as keys; two of them are given."""

LEAST = -1e-9
"""A Lamé constant over the shear modulus that is 0 but for round-off, and taken as 0."""


def _of_young_and_bulk(E: float, K: float) -> tuple[float, float]:
    return 3.0 * K * E / (9.0 * K - E), 3.0 * K * (3.0 * K - E) / (9.0 * K - E)


def _of_lame_and_young(lam: float, E: float) -> tuple[float, float]:
    root = math.sqrt(E**2 + 9.0 * lam**2 + 2.0 * E * lam)
    return 2.0 * E * lam / (root + 3.0 * lam - E) if 3.0 * lam > E else 0.25 * (E - 3.0 * lam + root), lam


# mu and lambda of each pair, in the order of MODULI.
_PAIRS: Mapping[tuple[str, str], Callable[[float, float], tuple[float, float]]] = {
    ("shear_modulus", "lame_lambda"): lambda mu, lam: (mu, lam),
    ("shear_modulus", "youngs_modulus"): lambda mu, E: (mu, mu * (E - 2.0 * mu) / (3.0 * mu - E)),
    ("shear_modulus", "poissons_ratio"): lambda mu, nu: (mu, 2.0 * mu * nu / (1.0 - 2.0 * nu)),
    ("shear_modulus", "bulk_modulus"): lambda mu, K: (mu, K - 2.0 * mu / 3.0),
    ("lame_lambda", "youngs_modulus"): _of_lame_and_young,
    ("lame_lambda", "poissons_ratio"): lambda lam, nu: (0.5 * lam * (1.0 - 2.0 * nu) / nu, lam),
    ("lame_lambda", "bulk_modulus"): lambda lam, K: (1.5 * (K - lam), lam),
    ("youngs_modulus", "poissons_ratio"): lambda E, nu: (
        0.5 * E / (1.0 + nu),
        E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)),
    ),
    ("youngs_modulus", "bulk_modulus"): _of_young_and_bulk,
    ("poissons_ratio", "bulk_modulus"): lambda nu, K: (
        1.5 * K * (1.0 - 2.0 * nu) / (1.0 + nu),
        3.0 * K * nu / (1.0 + nu),
    ),
}


def lame_of(moduli: Mapping[str, float | None]) -> tuple[float, float]:
    """Shear modulus and Lamé constant of two moduli.

    Parameters
    ----------
    moduli : mapping of str to float
        Two of shear_modulus, lame_lambda, youngs_modulus, bulk_modulus (Pa) and poissons_ratio; None: not given.

    Returns
    -------
    mu, lam : float
        Pa.

    Raises
    ------
    InputError
        Another number of moduli, or two that no material with a shear modulus above 0 and Poisson's ratio from 0 to
        below 0.5 has.
    """
    given = {name: moduli[name] for name in MODULI if moduli.get(name) is not None}
    if len(given) != 2:
        raise InputError(_wrong_number(list(given)))
    values = {}
    for name, value in given.items():
        values[name] = number = float(value)  # type: ignore[arg-type]
        may_vanish = name in ("lame_lambda", "poissons_ratio")
        if not math.isfinite(number) or number < 0.0 or (number == 0.0 and not may_vanish):
            raise InputError(f"{name} is {number:g}; it must be finite and {'zero or ' if may_vanish else ''}positive")
    nu = values.get("poissons_ratio")
    if nu is not None and nu >= 0.5:
        raise InputError(
            f"poissons_ratio is {nu:g}; it must be at least 0 and below 0.5 (rubber: 0.48 to 0.4999; the laws here are "
            "compressible)"
        )
    (one, first), (other, second) = values.items()
    try:
        mu, lam = _PAIRS[one, other](first, second)
    except (ZeroDivisionError, OverflowError):
        mu, lam = math.nan, math.nan
    if lam < 0.0 and lam >= LEAST * mu:
        lam = 0.0
    if not (math.isfinite(mu) and mu > 0.0 and math.isfinite(lam) and lam >= 0.0):
        raise InputError(f"{one} = {first:g} and {other} = {second:g} do not go together: {_bounds(one, other, first)}")
    return mu, lam


def _wrong_number(given: list[str]) -> str:
    *others, last = MODULI
    if len(given) > 2:
        return f"{', '.join(given[:-1])} and {given[-1]} are given; two moduli determine the others: leave out the rest"
    pair = "shear_modulus and lame_lambda, or youngs_modulus and poissons_ratio"
    if not given:
        return f"shear_modulus is missing; two moduli are needed, such as {pair}"
    rest = [name for name in (*others, last) if name != given[0]]
    return f"{given[0]} is given alone; a second modulus is missing: {', '.join(rest[:-1])} or {rest[-1]}"


def _bounds(one: str, other: str, first: float) -> str:
    """What the second of two moduli may be beside the first, for a shear modulus above 0 and a lambda of at least 0."""
    match one, other:
        case "shear_modulus", "youngs_modulus":
            return f"youngs_modulus must be at least {2.0 * first:g} and below {3.0 * first:g}"
        case "shear_modulus", "bulk_modulus":
            return f"bulk_modulus must be at least {2.0 * first / 3.0:g}"
        case "lame_lambda", "bulk_modulus":
            return f"bulk_modulus must be above {first:g}"
        case "youngs_modulus", "bulk_modulus":
            return f"bulk_modulus must be at least {first / 3.0:g}"
        case _:
            return "beside lame_lambda and poissons_ratio give another modulus if one of them is 0"
