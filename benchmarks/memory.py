"""Peak memory of a solve against what is told before it: square plates and strips of 1 000 to 30 000 elements.

python benchmarks/memory.py [LARGEST]       LARGEST: elements (default 10 000; 30 000 take 3 GB)

A peak is reached when the tangent, which the couple makes unsymmetric, is factorised twice: the solver holds no more at
any later iteration. Each size runs in a process of its own.
"""

from __future__ import annotations

import resource
import subprocess
import sys

import magshell as ms
from magshell.equations.discretisation import Discretisation
from magshell.equations.instant import Instant
from magshell.linalg import make_solver, nested_dissection
from magshell.solver.memory import need_of

SIZES = (
    (1000, "square", "quadratic"), (1000, "strip", "quadratic"), (3000, "square", "quadratic"),
    (3000, "strip", "quadratic"), (3000, "square", "paper"), (10000, "strip", "quadratic"),
    (10000, "square", "paper"), (30000, "strip", "paper"),
)  # fmt: skip
STRIP = 4


def plate(elements: int, shape: str, element: str) -> ms.Model:
    """A clamped plate in a field."""
    across = round(elements**0.5) if shape == "square" else STRIP
    divisions = (elements // across, across)
    mesh = ms.mesh.rectangle(0.1, 0.1 * divisions[1] / divisions[0], divisions)
    material = ms.MicropolarNeoHookean(303e3, 7.3e6, 30.3e3, 1e-4)
    shell = ms.Shell(mesh, 1e-3, material, ms.remanence.constant([0.143, 0.0, 0.0]), element)
    return ms.Model(shell, [ms.Clamp("left")], ms.UniformField([0.0, 0.0, 1e-3]))


def measure(elements: int, shape: str, element: str) -> None:
    """Print a row."""
    model, solver = plate(elements, shape, element), make_solver("multifrontal")
    need = need_of(model)
    discretisation = Discretisation(model, nested_dissection)
    state, factors = discretisation.undeformed(), None
    for _ in range(2):
        matrix = discretisation.assemble(
            Instant(state, model.course(0).at(1.0), discretisation.predicted(state))
        ).matrix
        assert matrix is not None
        factors = None
        factors = solver.factorise(matrix)
        factors.negative_pivots()
    peak = 1024.0 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    print(
        f"{shape:6} {element:10}{len(model.shell.mesh.elements):8} {discretisation.dofs:9} {need.factors:12.4g} "
        f"{need.memory / 1e9:9.2f} {peak / 1e9:9.2f} {need.memory / peak:6.2f}",
        flush=True,
    )


def main() -> None:
    """Print the table."""
    if len(sys.argv) == 4:
        return measure(int(sys.argv[1]), *sys.argv[2:])
    largest = int(sys.argv[1]) if len(sys.argv) > 1 else 10000
    print("mesh   element   elements  unknowns      entries  told, GB  peak, GB  ratio", flush=True)
    for elements, shape, element in SIZES:
        if elements <= largest:
            subprocess.run([sys.executable, __file__, str(elements), shape, element], check=True)
    return None


if __name__ == "__main__":
    main()
