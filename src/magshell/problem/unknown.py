"""Messages for what a problem file cannot express, or has in the wrong place or form."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from magshell.errors import suggest
from magshell.nearest import nearest

ABSENT = {
    "contact": "there is no contact: parts pass through each other",
    "friction": "there is no contact, and so no friction",
    "time": "there is no time: every state is an equilibrium",
    "dynamics": "there is no inertia: every state is an equilibrium",
    "damping": "there is no damping: every state is an equilibrium",
    "viscosity": "materials have no viscosity",
    "plasticity": "materials are elastic",
    "temperature": "there is no temperature",
    "fluid": "there is no fluid around the shell; a pressure is one of [[loads]]",
    "box": "a box is ranges of x1, x2 and x3",
    "units": "there is no system of units: every quantity is written with its own, in quotes",
}
"""What other programs have and this one does not, by the key that people write for it."""

_PLACES = {
    "density": "[shell] or [[regions]]",
    "thickness": "[shell] or [[regions]]",
    "remanence": "[[remanence]]",
    "flux_density": "[field]",
    "stops": "[field] or [[stages]]",
    "element_groups": "[mesh.element_groups]",
    "edge_groups": "[mesh.edge_groups]",
    "node_groups": "[mesh.node_groups]",
    "youngs_modulus": "[material]",
    "poissons_ratio": "[material]",
    "shear_modulus": "[material]",
    "coupling_modulus": "[material]",
    "length_scale": "[material]",
    "element": "[shell]",
    "coupling": "[field]",
    "linear_solver": "[solver]",
    "tolerance": "[solver]",
}
_ONE_ONLY = {
    "material": "; further materials belong to [[regions]] or layers",
    "shell": "; other thicknesses belong to [[regions]]",
    "mesh": "; pieces are blocks of one mesh, or surfaces of one file",
    "field": "; what acts with its own history is a load",
    "probes": '; each probe is a line of it: tip = ["10 mm", 0, 0]',
}


def unknown_key(key: str, known: Sequence[str], at_the_top: bool) -> str:
    """Message for a key that a table does not have."""
    near = nearest(key, known)
    if near is None and (absent := nearest(key, ABSENT)):
        return f"is an unknown key: {ABSENT[absent]}"
    if near is None and (moved := nearest(key, _PLACES)) and not (at_the_top and moved in known):
        return f"is an unknown key here: {moved} belongs to {_PLACES[moved]}"
    return f"is an unknown key. {suggest(key, known)}"


def not_a_table(place: str, given: object) -> str:
    """Message where a table is expected, by its place in the file."""
    if isinstance(given, list) and place in _ONE_ONLY:
        return f"is a list, [[{place}]]; there is one [{place}] only{_ONE_ONLY[place]}"
    if "." not in place and "[" not in place:
        return f"is not a table of keys and values: write [{place}], and its keys below it"
    return "is not a table of keys and values"


def meant(given: object, expected: str) -> str:
    """The nearest of the values that a message lists in quotes, as an addition to it; empty: none is near."""
    values: Iterable[str] = re.findall(r"'([^']+)'", expected)
    near = nearest(given, values) if isinstance(given, str) else None
    return f"; did you mean '{near}'?" if near else ""
