"""Elements per second of one core: residual, and residual with the condensed tangent; share of the dgemm peak.

python benchmarks/kernels.py
"""

from __future__ import annotations

import os

os.environ.update(OPENBLAS_NUM_THREADS="1", MKL_NUM_THREADS="1", OMP_NUM_THREADS="1")

import time
from collections.abc import Callable

import numpy as np
from arm import arm

from magshell.assembly import Discretisation
from magshell.linalg import nested_dissection
from magshell.shell.point import SIZE


def best(function: Callable[[], object], repeats: int = 7) -> float:
    """Least CPU time of several calls, s."""
    times = []
    for _ in range(repeats):
        start = time.process_time()
        function()
        times.append(time.process_time() - start)
    return min(times)


def dgemm_peak(size: int = 768) -> float:
    """Floating-point operations per second of a large matrix product on one core."""
    a = np.random.default_rng(0).normal(size=(size, size))
    return 2.0 * size**3 / best(lambda: a @ a)


def operations(points: int = 4, levels: int = 2, count: int = 8, rest: int = 4, modes: int = 2) -> int:
    """Multiplications and additions per element of the parts that can be counted on paper.

    Contractions with the shape functions (rows × terms × columns, twice), moduli on the legs (four stages of 81 sums
    of three per level), condensation. The point's laws and chain rules come on top and are not counted.
    """
    values = 3 * count + 7 * rest + 3 * modes
    terms = 3 * count * 2 + 3 * rest * 3 + rest + rest * (4 * 3 + 3 * 4) + 3 * modes
    contraction = points * 2 * terms * (SIZE + values)
    legs = points * levels * 4 * 81 * 3 * 2
    nodal = values - 3 * modes
    condensation = 2 * 3 * modes * nodal * (nodal + 3 * modes)
    return contraction + legs + condensation


def main() -> None:
    """Print the figures."""
    discretisation = Discretisation(arm(120, 24), nested_dissection)
    elements = len(discretisation.mesh.elements)
    state = discretisation.undeformed()
    stresses = discretisation.stresses_at(state)
    discretisation.assemble(state, 0.01, stresses)
    residual = elements / best(lambda: discretisation.assemble(state, 0.01, stresses, tangent=False))
    tangent = elements / best(lambda: discretisation.assemble(state, 0.01, stresses))
    peak = dgemm_peak()
    print(f"{elements} elements, one core")
    print(f"residual                          {residual:9.0f} elements/s")
    print(f"residual and condensed tangent    {tangent:9.0f} elements/s  (asked: 15 000)")
    print(f"dgemm peak                        {peak / 1e9:9.1f} Gflop/s")
    print(
        f"counted operations                {operations():9d} per element: "
        f"{100 * operations() * tangent / peak:.0f} % of the dgemm peak"
    )


if __name__ == "__main__":
    main()
