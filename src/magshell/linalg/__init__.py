"""Sparse direct solvers behind one protocol, and the elimination order."""

from magshell.errors import InputError, suggest
from magshell.linalg.factorisation import Factorisation, LinearSolver, SingularMatrix
from magshell.linalg.multifrontal.solver import Multifrontal
from magshell.linalg.ordering import nested_dissection
from magshell.linalg.pardiso import Pardiso
from magshell.linalg.superlu import SuperLU

__all__ = ["SOLVERS", "Factorisation", "LinearSolver", "SingularMatrix", "make_solver", "nested_dissection"]

SOLVERS: dict[str, type[Multifrontal] | type[SuperLU] | type[Pardiso]] = {
    "multifrontal": Multifrontal,
    "superlu": SuperLU,
    "pardiso": Pardiso,
}


def make_solver(name: str) -> LinearSolver:
    """Solver by its name in the settings.

    Raises
    ------
    InputError
        Unknown name, or an extra that is not installed.
    """
    if name not in SOLVERS:
        raise InputError(f"solver: linear_solver is '{name}'. {suggest(name, SOLVERS)}")
    return SOLVERS[name]()
