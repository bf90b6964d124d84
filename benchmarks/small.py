"""CPU time of a Newton iteration on a strip of four elements: kernels and factorisations, and Python around them.

    OMP_NUM_THREADS=1 python benchmarks/small.py [--repeats 40]

The time of a whole solve is divided by its linear solves; the setup of the equations is left out. That of kernels is
all time inside compiled functions. The least of several solves counts.
"""

from __future__ import annotations

import argparse
import time
from typing import Any

import magshell as ms
from magshell.compiled import Kernel
from magshell.solver.events import Observer


class Clock(Observer):
    """CPU time since the equations are set up, and how much of it was spent in kernels."""

    spent = 0.0

    def started(self, discretisation: Any, settings: Any) -> None:
        """Begin."""
        self.begin, Clock.spent = time.process_time(), 0.0

    def finished(self, path: Any) -> None:
        """End."""
        self.seconds, self.solves = time.process_time() - self.begin, path.solves


def counted(call: Any) -> Any:
    """A kernel's call that is timed."""

    def timed(kernel: Kernel, *arguments: Any) -> Any:
        begin = time.process_time()
        try:
            return call(kernel, *arguments)
        finally:
            Clock.spent += time.process_time() - begin

    return timed


def strip() -> ms.Model:
    """Four elements that a field bends."""
    material = ms.MicropolarNeoHookean(135e3, 3.25e6, 13.5e3, 9e-5)
    shell = ms.Shell(ms.mesh.rectangle(20e-3, 5e-3, (4, 1)), 1e-3, material, ms.remanence.constant((80e-3, 0.0, 0.0)))
    return ms.Model(shell, [ms.Clamp("left")], ms.UniformField((0.0, 0.0, 20e-3)))


def main() -> None:
    """Print one line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeats", type=int, default=40)
    repeats = parser.parse_args().repeats
    model, best = strip(), (float("inf"), 0.0, 1)
    ms.solve(model)
    Kernel.__call__ = counted(Kernel.__call__)  # type: ignore[method-assign]
    for _ in range(repeats):
        clock = Clock()
        ms.solve(model, observers=[clock])
        best = min(best, (clock.seconds, Clock.spent, clock.solves))
    seconds, inside, solves = best
    whole, kernels = 1e3 * seconds / solves, 1e3 * inside / solves
    print(
        f"{solves} solves: {whole:.2f} ms an iteration, {kernels:.2f} ms of it in kernels and factorisations, "
        f"{whole - kernels:.2f} ms around them (asked: at most 1 ms)"
    )


if __name__ == "__main__":
    main()
