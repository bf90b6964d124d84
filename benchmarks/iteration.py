"""Factorisations of the tangent, and a whole Newton iteration over a factorisation and a solve alone.

    python benchmarks/iteration.py [--elements 1000 10000] [--solver multifrontal superlu pardiso]

An iteration is: residual and tangent, factorisation, solve, recovery of the enhanced parameters, predicted stresses,
new state. Seconds are CPU seconds of one thread (OMP_NUM_THREADS=1); the symbolic phase is in the first factorisation,
which does not count.
"""

from __future__ import annotations

import argparse
import resource
import time

import numpy as np
from arm import arm

from magshell.equations.discretisation import Discretisation
from magshell.equations.instant import Instant, moved
from magshell.linalg import SOLVERS, make_solver, nested_dissection


def measure(elements: int, solver: str, repeats: int) -> None:
    """Print one line."""
    around = max(round(np.sqrt(elements / 5)), 1)
    model = arm(round(elements / around), around)
    start = time.process_time()
    discretisation = Discretisation(model, nested_dissection)
    setup = time.process_time() - start
    linear_solver, factors = make_solver(solver), None
    state = discretisation.undeformed()
    stresses = discretisation.predicted(state)
    iterations, factorisations, solves = [], [], []
    for _ in range(repeats + 1):
        start = time.process_time()
        assembly = discretisation.assemble(Instant(state, discretisation.model.loading(0.002), stresses))
        assembled = time.process_time()
        factors = None
        factors = linear_solver.factorise(assembly.matrix)
        factorised = time.process_time()
        increment = discretisation.correction(factors.solve(assembly.right_side))
        solved = time.process_time()
        discretisation.predicted(state, increment)
        moved(state, increment)
        iterations.append(time.process_time() - start)
        factorisations.append(factorised - assembled)
        solves.append(solved - factorised)
    iteration, factorisation, solve = (np.median(times[1:]) for times in (iterations, factorisations, solves))
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0**2
    print(
        f"{len(model.shell.mesh.elements):7d} elements {discretisation.dofs:8d} unknowns  {linear_solver.name:26s}"
        f" setup {setup:6.2f} s  factorisation {factorisation:7.3f} s  solve {solve:6.3f} s"
        f"  iteration {iteration:7.3f} s  ratio {iteration / (factorisation + solve):.2f} (asked: at most 1.6)"
        f"  peak {peak:.2f} GB",
        flush=True,
    )


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--elements", type=int, nargs="+", default=[1000, 10000])
    parser.add_argument("--solver", nargs="+", default=["multifrontal", "superlu"], choices=SOLVERS)
    arguments = parser.parse_args()
    for elements in arguments.elements:
        for solver in arguments.solver:
            measure(elements, solver, repeats=5 if elements <= 2000 else 2 if elements <= 20000 else 1)


if __name__ == "__main__":
    main()
