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

from magshell.equations.discretisation import Discretisation
from magshell.equations.instant import Instant
from magshell.linalg import nested_dissection
from magshell.model.reference import LEVELS
from magshell.shell.elements import ELEMENTS, ElementType
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


def operations(element: ElementType, levels: int = LEVELS) -> int:
    """Multiplications and additions per element of the parts that can be counted on paper.

    Contractions with the shape functions (rows × terms × columns, twice), moduli on the legs (four stages of 81 sums
    of three per level), condensation. The point's laws and chain rules come on top and are not counted.
    """
    points, rest, enhanced = len(element.rule.weights), element.rest_nodes, 3 * element.vectors
    nodal = 3 * 8 + 6 * rest + element.stretch_nodes
    values = nodal + enhanced
    terms = 3 * 8 * 2 + 3 * rest * 3 + element.stretch_nodes + rest * (4 * 3 + 3 * 4) + 3 * enhanced
    contraction = points * 2 * terms * (SIZE + values)
    legs = points * levels * 4 * 81 * 3 * 2
    condensation = 2 * enhanced * nodal * (nodal + enhanced)
    return contraction + legs + condensation


def measure(element: ElementType) -> None:
    """Print the figures of one element type."""
    discretisation = Discretisation(arm(120, 24, element), nested_dissection)
    elements = len(discretisation.mesh.elements)
    state = discretisation.undeformed()
    stresses = discretisation.predicted(state)
    loading = discretisation.model.loading(0.01)
    discretisation.assemble(Instant(state, loading, stresses))
    residual = elements / best(lambda: discretisation.assemble(Instant(state, loading, stresses), tangent=False))
    tangent = elements / best(lambda: discretisation.assemble(Instant(state, loading, stresses)))
    share = operations(element) * tangent / dgemm_peak()
    print(
        f"{element.name:17s} {residual:9.0f} residual/s {tangent:9.0f} residual and tangent/s, "
        f"{operations(element)} counted operations each: {100 * share:.0f} % of the dgemm peak",
        flush=True,
    )


def main() -> None:
    """Print a line per element type."""
    print(f"elements per second on one core; dgemm peak {dgemm_peak() / 1e9:.1f} Gflop/s")
    for element in ELEMENTS.values():
        measure(element)


if __name__ == "__main__":
    main()
