"""Sparse linear algebra behind one protocol."""

from magshell.linalg.ordering import nested_dissection
from magshell.linalg.solver import SOLVERS, LinearSolver, SingularMatrix, make_solver

__all__ = ["SOLVERS", "LinearSolver", "SingularMatrix", "make_solver", "nested_dissection"]
