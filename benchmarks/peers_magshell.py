"""A problem of `peers.py` by magshell with its defaults: python benchmarks/peers_magshell.py PROBLEM."""

from __future__ import annotations

import contextlib
import sys
import time

from peers_problems import Answer

import magshell as ms

BUILT_IN = {"hemisphere": "hemisphere", "annulus": "slit-annulus"}


def values(name: str, path: ms.Path) -> dict[str, float]:
    """The displacements that the table has."""
    if name == "hemisphere":
        return {"inwards": -path.probe("larger_radial").u2[-1], "outwards": path.probe("smaller_radial").u1[-1]}
    return {"w_A": path.probe("A").u3[-1], "w_B": path.probe("B").u3[-1]}


def main() -> None:
    """Command line."""
    name = sys.argv[1]
    model = ms.problem.load(BUILT_IN[name]).model
    answer = Answer("magshell", f"{model.shell.element.name}, 7 parameters", name)
    with contextlib.suppress(ms.SolveError):
        ms.solve(model)  # compiles the kernels, or reads them
    start = time.process_time()
    try:
        path = ms.solve(model)
    except ms.SolveError as error:
        path, answer.reason = error.path, error.reason
    answer.seconds = time.process_time() - start
    answer.unknowns, answer.steps, answer.solves = path.discretisation.dofs, len(path.steps) - 1, path.solves
    if path.converged:
        answer.values = values(name, path)
    answer.print()


if __name__ == "__main__":
    main()
