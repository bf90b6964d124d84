"""Elements per second of one core: residual, and residual with the condensed tangent; share of the dgemm peak.

python benchmarks/kernels.py
python benchmarks/kernels.py --compilation     what the first solve on a machine compiles, and a further law, CPU s
"""

from __future__ import annotations

import os

os.environ.update(OPENBLAS_NUM_THREADS="1", MKL_NUM_THREADS="1", OMP_NUM_THREADS="1")

import argparse
import importlib
import json
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from arm import arm

import magshell as ms
from magshell import kernel_cache, materials
from magshell.equations.discretisation import Discretisation
from magshell.equations.instant import Instant
from magshell.linalg import nested_dissection
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


def operations(element: ElementType, levels: int) -> int:
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
    stresses = discretisation.predicted(Instant(state, discretisation.model.loading(0.01)))
    loading = discretisation.model.loading(0.01)
    discretisation.assemble(Instant(state, loading, stresses))
    residual = elements / best(lambda: discretisation.assemble(Instant(state, loading, stresses), tangent=False))
    tangent = elements / best(lambda: discretisation.assemble(Instant(state, loading, stresses)))
    counted = operations(element, discretisation.reference.body.levels.shape[2])
    share = counted * tangent / dgemm_peak()
    print(
        f"{element.name:17s} {residual:9.0f} residual/s {tangent:9.0f} residual and tangent/s, "
        f"{counted} counted operations each: {100 * share:.0f} % of the dgemm peak",
        flush=True,
    )


def solve(material: str, coupling: str) -> None:
    """Solve a strip with two laws, each a "module:class"; print CPU seconds of what is compiled, by name, as JSON."""
    spent: dict[str, float] = {}
    load, save = kernel_cache.Store.load_overload, kernel_cache.Store.save_overload

    def missed(store: kernel_cache.Store, *arguments: object) -> object:
        found = load(store, *arguments)
        if found is None:
            spent[store._shown] = spent.get(store._shown, 0.0) - time.process_time()
        return found

    def compiled(store: kernel_cache.Store, *arguments: object) -> None:
        spent[store._shown] += time.process_time()
        save(store, *arguments)

    kernel_cache.Store.load_overload, kernel_cache.Store.save_overload = missed, compiled
    problem = ms.problem.load("strip-10")
    model = problem.model
    own, field = (
        getattr(importlib.import_module(name.split(":")[0]), name.split(":")[1]) for name in (material, coupling)
    )
    shell = replace(model.shell, material=own(*model.shell.material[:4]))
    ms.solve(replace(model, shell=shell, coupling=field()), problem.settings)
    print(json.dumps({"compiled": spent, "total": time.process_time()}))


def compilation() -> None:
    """Print what is compiled in fresh processes that share a cache, empty before the first."""
    with tempfile.TemporaryDirectory() as folder:
        shutil.copy(str(materials.__path__[0]) + "/neo_hookean.py", Path(folder) / "users_law.py")
        found = os.environ.get("PYTHONPATH", "")
        environment = {**os.environ, "NUMBA_CACHE_DIR": f"{folder}/cache", "PYTHONPATH": f"{folder}{os.pathsep}{found}"}
        neo_hookean, couple = "magshell.materials:MicropolarNeoHookean", "magshell.magnetics:MicropolarCouple"
        cases = {
            "the first solve on a machine": (neo_hookean, couple),
            "the same again": (neo_hookean, couple),
            "another material law": ("magshell.materials:MicropolarMooneyRivlin", couple),
            "another coupling law": (neo_hookean, "magshell.magnetics:MicroRotationEnergy"),
            "a material law in a user's file": ("users_law:MicropolarNeoHookean", couple),
        }
        for name, laws in cases.items():
            command = [sys.executable, __file__, "--solve", *laws]
            done = json.loads(subprocess.check_output(command, env=environment))
            spent = done["compiled"]
            print(f"{name}: {sum(spent.values()):.1f} CPU s compiling, {done['total']:.1f} in all", flush=True)
            for shown, seconds in sorted(spent.items(), key=lambda item: -item[1]):
                print(f"    {seconds:5.2f}  {shown}")


def main() -> None:
    """Print a line per element type, or per solve."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--compilation", action="store_true")
    parser.add_argument("--solve", nargs=2, metavar=("MATERIAL", "COUPLING"), help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.solve:
        solve(*given.solve)
        return
    if given.compilation:
        compilation()
        return
    print(f"elements per second on one core; dgemm peak {dgemm_peak() / 1e9:.1f} Gflop/s")
    for element in ELEMENTS.values():
        measure(element)


if __name__ == "__main__":
    main()
