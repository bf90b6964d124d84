"""Settings of a solve."""

from __future__ import annotations

from dataclasses import dataclass, fields
from numbers import Integral

from magshell.arguments import instance, real
from magshell.errors import InputError


@dataclass(frozen=True)
class Settings:
    """How the path is followed; the defaults solve all built-in problems.

    Attributes
    ----------
    tolerance : float
        Largest residual of each kind of unknown (u, w, φ, ω, α) over the elements' forces of that kind.
    max_iterations : int
        Linear solves after which a step is cut. (Few: a step that needs more has lost the path, or jumps to another.)
    target_iterations : int
        Linear solves per step that the step size aims at.
    first_step, largest_step : float
        Increments of the load factor: of a stage's first step, and of any.
    smallest_step : float
        Length of a step, displacements over the body's size, below which the solve gives up.
    mixed_tangent : bool
        Mixed-integration-point Newton (few, large steps); False: the plain one.
    linear_solver : {"multifrontal", "superlu", "pardiso"}
        The last needs an extra.
    """

    tolerance: float = 1e-9
    max_iterations: int = 8
    target_iterations: int = 4
    first_step: float = 0.01
    smallest_step: float = 1e-6
    largest_step: float = 1.0
    mixed_tangent: bool = True
    linear_solver: str = "multifrontal"

    def __post_init__(self) -> None:
        for entry in fields(self):
            value, where = getattr(self, entry.name), f"solver: {entry.name}"
            if isinstance(entry.default, bool):
                instance(where, value, bool, "True or False")
            elif isinstance(entry.default, float | int) and not 0 < real(where, value) < float("inf"):
                raise InputError(f"{where} is {value}; it must be positive and finite")
            elif isinstance(entry.default, str):
                instance(where, value, str, "the name of a solver")
            if entry.type == "int":
                instance(where, value, Integral, "a whole number")
        if self.tolerance >= 1e-2:
            raise InputError(f"solver: tolerance is {self.tolerance:g}; a result needs less than 1e-2")
        if not self.first_step <= self.largest_step <= 1.0:
            raise InputError(
                f"solver: steps must satisfy first_step ({self.first_step:g}) <= largest_step "
                f"({self.largest_step:g}) <= 1"
            )
        if self.smallest_step >= 1e-2:
            raise InputError(f"solver: smallest_step is {self.smallest_step:g} body sizes; a path needs less than 1e-2")
