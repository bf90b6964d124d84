"""What the report says of a remanence: its sense, in words."""

from __future__ import annotations

from magshell.magnetics.remanence import REMANENCES
from magshell.problem import schema


def sense(entry: schema.RemanenceTable) -> str:
    """Where an entry points."""
    way = REMANENCES[entry.kind]
    return way.words(**way.values(entry))
