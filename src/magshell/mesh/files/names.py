"""Names of groups as a problem file can write them, one for each group whatever its kind."""

from __future__ import annotations

import re
from collections.abc import Mapping

_STRANGE = re.compile(r"[^\w '*+.-]")
KINDS = ("elements", "edges", "nodes")


def named(groups: tuple[Mapping[str, object], ...]) -> tuple[dict[tuple[int, str], str], list[str]]:
    """New names of groups of elements, edges and nodes.

    A file may use one name for a surface and for its boundary: the group of lower dimension then gets its kind behind
    it. Characters that a problem file cannot write in a name become underscores.

    Parameters
    ----------
    groups : three mappings
        Of elements, edges and nodes, by the file's names.

    Returns
    -------
    dict of (kind, name) to str
        The kind is 0 for elements, 1 for edges, 2 for nodes.
    list of str
        What was changed, in words.
    """
    result: dict[tuple[int, str], str] = {}
    notes = []
    taken: set[str] = set()
    for kind, names in enumerate(groups):
        for name in names:
            clean = _STRANGE.sub("_", name.strip())
            clean = clean if re.match(r"\w", clean) else f"group{clean}"
            free = clean if clean not in taken else f"{clean}-{KINDS[kind]}"
            number = 2
            while free in taken:
                free = f"{clean}-{KINDS[kind]}-{number}"
                number += 1
            taken.add(free)
            result[kind, name] = free
            if free != name:
                notes.append(f"the group of {KINDS[kind]} '{name}' is called '{free}'")
    return result, notes
