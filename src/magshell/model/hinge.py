"""Hinges: edges along which sheets may turn against each other."""

from __future__ import annotations

from dataclasses import dataclass

from magshell.errors import InputError


@dataclass(frozen=True)
class Hinge:
    """An edge along which the elements on its sides share their displacement and nothing else.

    Parameters
    ----------
    group : str
        Group of edges, each shared by two or more elements.
    stiffness : float, optional
        Of a torsion spring along the edge, N m/rad per m: it resists a change of the angle between neighbouring sides.
        By default the hinge turns freely.

    Raises
    ------
    InputError
        The stiffness is negative or not finite.
    """

    group: str
    stiffness: float = 0.0

    def __post_init__(self) -> None:
        if not 0.0 <= float(self.stiffness) < float("inf"):
            raise InputError(f"hinge on '{self.group}': stiffness is {self.stiffness!r}; it must be 0 or positive")
