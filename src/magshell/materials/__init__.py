"""Material laws, one per file."""

from __future__ import annotations

from collections.abc import Mapping
from typing import get_args, get_type_hints

from magshell.keys import Key
from magshell.materials.gent import MicropolarGent
from magshell.materials.law import BY_DEFAULT, DEFAULTS, Material, Multiple, completed, laws
from magshell.materials.mixture import Composite, composite
from magshell.materials.moduli import MODULI, lame_of
from magshell.materials.mooney_rivlin import MicropolarMooneyRivlin
from magshell.materials.neo_hookean import MicropolarNeoHookean
from magshell.materials.st_venant_kirchhoff import MicropolarStVenantKirchhoff
from magshell.materials.yeoh import MicropolarYeoh

MATERIALS: dict[str, type[Material]] = {
    "micropolar-neo-hookean": MicropolarNeoHookean,
    "micropolar-mooney-rivlin": MicropolarMooneyRivlin,
    "micropolar-st-venant-kirchhoff": MicropolarStVenantKirchhoff,
    "micropolar-gent": MicropolarGent,
    "micropolar-yeoh": MicropolarYeoh,
}
"""The laws that problem files know, by their names there; see also `names_of`."""

_PREFIX = "micropolar-"
_COMMON = {
    **{name: MODULI[name] for name in ("shear_modulus", "lame_lambda")},
    "coupling_modulus": Key(
        "CouplingModulus",
        '$\\eta$, which ties the micro-rotation to the macro-rotation; `"0.1 mu"` is a multiple of $\\mu$.',
        "$\\mu$",
    ),
    "length_scale": Key(
        "LengthScale",
        '$l$ of the couple stress $\\mu l^2\\,\\Gamma$; `"0.1 h"` is a multiple of the thickness.',
        "$h/100$",
    ),
}


def names_of(name: str) -> tuple[str, ...]:
    """What a problem file may call the law of this name in `MATERIALS`: `micropolar-` may be left out."""
    short = name.removeprefix(_PREFIX)
    return (name,) if short in MATERIALS else (name, short)


def law_named(name: str) -> type[Material]:
    """The law that a problem file calls so."""
    return MATERIALS[name if name in MATERIALS else _PREFIX + name]


def own_keys(law: type[Material]) -> Mapping[str, Key]:
    """The keys of a law that not every law has; a `Key` in the annotation of the parameter describes them."""
    hints = get_type_hints(law, include_extras=True)
    return {name: part for name, hint in hints.items() for part in get_args(hint) if isinstance(part, Key)}


def keys_of(law: type[Material]) -> Mapping[str, Key]:
    """The keys that are parameters of a law."""
    return {**_COMMON, **own_keys(law)}


__all__ = [
    "BY_DEFAULT",
    "DEFAULTS",
    "MATERIALS",
    "MODULI",
    "Composite",
    "Material",
    "MicropolarGent",
    "MicropolarMooneyRivlin",
    "MicropolarNeoHookean",
    "MicropolarStVenantKirchhoff",
    "MicropolarYeoh",
    "Multiple",
    "completed",
    "composite",
    "keys_of",
    "lame_of",
    "law_named",
    "laws",
    "names_of",
    "own_keys",
]
