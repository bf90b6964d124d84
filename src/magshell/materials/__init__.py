"""Material laws, one per file."""

from __future__ import annotations

from collections.abc import Mapping
from typing import get_args, get_type_hints

from magshell.keys import Key
from magshell.materials.law import Material, laws
from magshell.materials.mooney_rivlin import MicropolarMooneyRivlin
from magshell.materials.neo_hookean import MicropolarNeoHookean
from magshell.materials.st_venant_kirchhoff import MicropolarStVenantKirchhoff

MATERIALS: dict[str, type[Material]] = {
    "micropolar-neo-hookean": MicropolarNeoHookean,
    "micropolar-mooney-rivlin": MicropolarMooneyRivlin,
    "micropolar-st-venant-kirchhoff": MicropolarStVenantKirchhoff,
}
"""The laws that problem files know, by their names there."""

_COMMON = {
    "shear_modulus": Key("PositiveStress", "$\\mu$."),
    "lame_lambda": Key("NonNegativeStress", "$\\lambda$."),
    "coupling_modulus": Key(
        "NonNegativeStress", "$\\eta$, which ties the micro-rotation to the macro-rotation.", "$\\mu/10$"
    ),
    "length_scale": Key("PositiveLength", "$l$ of the couple stress $\\mu l^2\\,\\Gamma$.", "$h/10$"),
}


def own_keys(law: type[Material]) -> Mapping[str, Key]:
    """The keys of a law that not every law has; a `Key` in the annotation of the parameter describes them."""
    hints = get_type_hints(law, include_extras=True)
    return {name: part for name, hint in hints.items() for part in get_args(hint) if isinstance(part, Key)}


def keys_of(law: type[Material]) -> Mapping[str, Key]:
    """All keys of a law."""
    return {**_COMMON, **own_keys(law)}


__all__ = [
    "MATERIALS",
    "Material",
    "MicropolarMooneyRivlin",
    "MicropolarNeoHookean",
    "MicropolarStVenantKirchhoff",
    "keys_of",
    "laws",
    "own_keys",
]
