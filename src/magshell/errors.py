"""What can go wrong, in the user's terms: bad input, a bad mesh, a solve that cannot go on."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from magshell.solver.path import Path


class InputError(ValueError):
    """The problem as stated cannot be solved; the message says what, where, and what would be right."""


class NothingLoads(InputError):
    """Nothing acts on the shell: it stays undeformed."""


class MeshError(InputError):
    """The mesh cannot carry a shell; the message names elements or nodes."""


class SolveError(RuntimeError):
    """The load path could not be followed to its end.

    Attributes
    ----------
    reason : str
        Why, and what to try.
    path : Path
        Every converged step up to the failure.
    """

    def __init__(self, reason: str, path: Path) -> None:
        super().__init__(reason)
        self.reason = reason
        self.path = path


def suggest(name: str, valid: Iterable[str]) -> str:
    """Sentence that names the nearest valid name, or lists what there is."""
    names = sorted(valid)
    if not names:
        return "There is none."
    close = difflib.get_close_matches(name, names, n=1, cutoff=0.5)
    listed = ", ".join(names[:20]) + (", …" if len(names) > 20 else "")
    return (f"Did you mean '{close[0]}'? " if close else "") + f"There is: {listed}."
