"""Whole paths of built-in problems with each linear solver, with one thread and with two.

    python benchmarks/linear_solvers.py [PROBLEM ...]

Each runs in a process of its own, the second of two solves counts (the first reads the kernels). Paths agree: the
largest difference of the final displacements is printed over the largest displacement.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import magshell as ms
from magshell import problem

PROBLEMS = ("gripper", "strip-41", "thin-cross", "hemisphere", "slit-annulus")
CASES = (("multifrontal", 1), ("multifrontal", 2), ("superlu", 1))


def measure(name: str, solver: str, out: str) -> None:
    """Solve twice; print CPU and wall seconds and linear solves of the second, save its displacements."""
    model = problem.load(name).model
    settings = ms.Settings(linear_solver=solver)
    for _ in range(2):
        cpu, wall = time.process_time(), time.perf_counter()
        path = ms.solve(model, settings)
        cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
    np.save(out, path.steps[-1].state.u)
    print(cpu, wall, path.solves)


def main() -> None:
    """Print a line per problem and case."""
    if len(sys.argv) > 3 and sys.argv[1] == "--measure":
        return measure(*sys.argv[2:])
    for name in sys.argv[1:] or PROBLEMS:
        states: list[np.ndarray] = []
        for solver, threads in CASES:
            with tempfile.TemporaryDirectory() as folder:
                out = Path(folder, "u.npy")
                command = [sys.executable, __file__, "--measure", name, solver, str(out)]
                environment = os.environ | {"OMP_NUM_THREADS": str(threads), "OPENBLAS_NUM_THREADS": "1"}
                done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
                states.append(np.load(out))
            cpu, wall, solves = map(float, done.stdout.split())
            difference = np.abs(states[-1] - states[0]).max() / np.abs(states[0]).max()
            print(
                f"{name:14s} {solver:13s} {threads} thread{'s' * (threads > 1)}  {cpu:7.2f} CPU s  {wall:7.2f} s"
                f"  {solves:4.0f} solves  difference {difference:.0e}",
                flush=True,
            )
    return None


if __name__ == "__main__":
    main()
