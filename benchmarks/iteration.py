"""A whole Newton iteration over the bare factorisation and solve of the same matrix, by SuperLU and by PARDISO.

    python benchmarks/iteration.py [--elements 1000 10000 50000] [--solver superlu pardiso]

An iteration is: residual and tangent, scaling, factorisation, solve, recovery of the enhanced parameters, predicted
stresses, new state. Bare: the library's factorisation and solve of the scaled matrix alone.
"""

from __future__ import annotations

import argparse
import time

import numpy as np
from arm import arm

from magshell.assembly import Discretisation
from magshell.linalg import LinearSolver, make_solver, nested_dissection


def measure(elements: int, solver: str, repeats: int) -> None:
    """Print one line."""
    around = max(round(np.sqrt(elements / 5)), 1)
    model = arm(round(elements / around), around)
    start = time.perf_counter()
    discretisation = Discretisation(model, nested_dissection)
    setup = time.perf_counter() - start
    linear_solver = make_solver(solver)
    state = discretisation.undeformed()
    stresses = discretisation.stresses_at(state)
    discretisation.assemble(state, discretisation.model.loading(0.002), stresses)
    ratios, iterations, bares = [], [], []
    for repeat in range(repeats + 1):
        start = time.perf_counter()
        assembly = discretisation.assemble(state, discretisation.model.loading(0.002), stresses)
        linear_solver.factorise(assembly.matrix)
        increment = discretisation.expand(linear_solver.solve(assembly.right_side))
        d_alpha = discretisation.recover(increment)
        discretisation.predicted_stresses(state, increment, d_alpha)
        state.moved(increment, d_alpha)
        iteration = time.perf_counter() - start
        bare = bare_time(linear_solver, assembly.right_side)
        if repeat:  # the first one carries PARDISO's symbolic phase
            ratios.append(iteration / bare)
            iterations.append(iteration)
            bares.append(bare)
    print(
        f"{len(model.shell.mesh.elements):7d} elements {discretisation.dofs:8d} unknowns  {linear_solver.name:22s}"
        f" setup {setup:6.2f} s  iteration {np.median(iterations):7.3f} s  bare {np.median(bares):7.3f} s"
        f"  ratio {np.median(ratios):.2f} (asked: at most 1.6)",
        flush=True,
    )


def bare_time(linear_solver: LinearSolver, right_side: np.ndarray) -> float:
    """Seconds of the library's own factorisation and solve of the matrix that was last factorised."""
    start = time.perf_counter()
    linear_solver.refactorise()
    linear_solver.solve(right_side)
    return time.perf_counter() - start


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--elements", type=int, nargs="+", default=[1000, 10000, 50000])
    parser.add_argument("--solver", nargs="+", default=["superlu"], choices=["superlu", "pardiso"])
    arguments = parser.parse_args()
    for solver in arguments.solver:
        for elements in arguments.elements:
            measure(elements, solver, repeats=5 if elements <= 2000 else 2 if elements <= 20000 else 1)


if __name__ == "__main__":
    main()
