"""The problems of `peers.py` on fine meshes, by magshell and NGSolve: python benchmarks/peers_limit.py [PROBLEM ...].

With transverse shear a free edge is softer in torsion by a layer as wide as the shell is thick: meshes for Naghdi's
shell are graded to a third of that at the free edges. Koiter's shell, without shear, is a tenth of a per cent off.
"""

from __future__ import annotations

import dataclasses
import importlib.util
import sys

import numpy as np
from peers_magshell import BUILT_IN, values
from peers_problems import PROBLEMS

import magshell as ms

# Length along s; loads at which NGSolve stops on its way.
LENGTHS = {"hemisphere": 10 * np.radians(72), "annulus": 4.0}
STOPS = {"hemisphere": (0.5, 1.0), "annulus": (0.1, 0.25, 0.45, 0.7, 0.85, 1.0)}


def graded(length: float, first: float, largest: float) -> np.ndarray:
    """Divisions of 0 to 1: at both ends of length `first`, then twice as long each, and at most `largest`."""
    layer = first * 2.0 ** np.arange(np.ceil(np.log2(largest / first)))
    inner = length - 2.0 * layer.sum()
    count = int(np.ceil(inner / largest))
    sizes = np.concatenate([layer, np.full(count, inner / count), layer[::-1]])
    return np.concatenate([[0.0], np.cumsum(sizes) / length])


def by_magshell(name: str, refinement: float) -> tuple[int, dict[str, float]]:
    """Unknowns and displacements, with so many times the elements along each side."""
    model = ms.problem.load(BUILT_IN[name]).model
    elements = [round(refinement * count) for count in PROBLEMS[name].elements]
    if name == "hemisphere":
        mesh = ms.mesh.sphere_patch(10.0, polar=(18, 90), azimuth=(0, 90), elements=elements)
        mesh = mesh.select_nodes("pulled", x1=10.0).select_nodes("pushed", x2=10.0)
    else:
        mesh = ms.mesh.annulus(6.0, 10.0, elements=elements, slit=True)
    path = ms.solve(dataclasses.replace(model, shell=dataclasses.replace(model.shell, mesh=mesh)))
    return path.discretisation.dofs, values(name, path)


def by_ngsolve(name: str, s: np.ndarray, around: int, shear: bool) -> tuple[int, dict[str, float]]:
    """The same by NGSolve, order 3; divisions s, and so many elements along t."""
    from peers_ngsolve import Shell

    shell = Shell(name, 3, (s, around), shear)
    for stop in STOPS[name]:
        if not shell.step(stop):
            return 0, {}
    return sum(shell.space.FreeDofs(True)), shell.values()


def main() -> None:
    """Command line."""
    for name in sys.argv[1:] or PROBLEMS:
        length, h, (_, n) = LENGTHS[name], PROBLEMS[name].thickness, PROBLEMS[name].elements
        runs = [(f"magshell, {k:g} times as fine", by_magshell(name, k)) for k in (1, 1.5, 2, 3)]
        if importlib.util.find_spec("ngsolve"):
            layers, uniform = graded(length, h / 3, length / 6), np.linspace(0, 1, PROBLEMS[name].elements[0] + 1)
            runs.append(("NGSolve, Naghdi's shell", by_ngsolve(name, layers, n, shear=True)))
            runs.append(("NGSolve, Koiter's shell", by_ngsolve(name, uniform, n, shear=False)))
        for label, (unknowns, displacements) in runs:
            text = "  ".join(f"{key} {value:.4f}" for key, value in displacements.items())
            print(f"{name:10s} {label:36s} {unknowns:6d} unknowns  {text}", flush=True)


if __name__ == "__main__":
    main()
