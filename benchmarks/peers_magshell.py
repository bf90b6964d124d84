"""A problem of `peers.py` by magshell with its defaults: python benchmarks/peers_magshell.py PROBLEM [REFINEMENT].

The problems are those built in; only a refined mesh, for the limit of fine meshes, is made here.
"""

from __future__ import annotations

import contextlib
import dataclasses
import sys
import time

from peers_problems import PROBLEMS, Answer

import magshell as ms

BUILT_IN = {"hemisphere": "hemisphere", "annulus": "slit-annulus"}


def refined(name: str, refinement: float) -> ms.Model:
    """The built-in problem with so many times the elements along each side."""
    model = ms.problem.load(BUILT_IN[name]).model
    elements = tuple(round(refinement * count) for count in PROBLEMS[name].elements)
    if name == "hemisphere":
        mesh = ms.mesh.sphere_patch(10.0, polar=(18, 90), azimuth=(0, 90), elements=elements)
        mesh = mesh.select_nodes("pulled", x1=10.0).select_nodes("pushed", x2=10.0)
    else:
        mesh = ms.mesh.annulus(6.0, 10.0, elements=elements, slit=True)
    return dataclasses.replace(model, shell=dataclasses.replace(model.shell, mesh=mesh))


def main() -> None:
    """Command line."""
    name, refinement = sys.argv[1], float(sys.argv[2]) if len(sys.argv) > 2 else 1.0
    model = refined(name, refinement)
    answer = Answer("magshell", f"{model.shell.element.name}, 7 parameters", name)
    with contextlib.suppress(ms.SolveError):
        ms.solve(refined(name, 0.25))  # compiles the kernels, or reads them
    start = time.process_time()
    try:
        path = ms.solve(model)
    except ms.SolveError as error:
        path, answer.reason = error.path, error.reason
    answer.seconds = time.process_time() - start
    answer.unknowns, answer.steps, answer.solves = path.discretisation.dofs, len(path.steps) - 1, path.solves
    if path.converged:
        if name == "hemisphere":
            inwards, outwards = -path.probe("larger_radial").u2[-1], path.probe("smaller_radial").u1[-1]
            answer.values = {"inwards": inwards, "outwards": outwards}
        else:
            answer.values = {"w_A": path.probe("A").u3[-1], "w_B": path.probe("B").u3[-1]}
    answer.print()


if __name__ == "__main__":
    main()
