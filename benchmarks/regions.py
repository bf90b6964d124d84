"""CPU time of an assembly with one region, with ten, and with layers, side by side.

    OMP_NUM_THREADS=1 python benchmarks/regions.py [--repeats 20]

The same strip of 400 elements each time. The ten regions have ten thicknesses, so that 99 nodes have a further row; the
layers have two levels each. The least of the repeats counts; they take turns.
"""

from __future__ import annotations

import argparse
import time

import numpy as np

import magshell as ms
from magshell.equations.discretisation import Discretisation
from magshell.equations.instant import Instant
from magshell.linalg import nested_dissection

COUNT = 10
RUBBER = ms.MicropolarNeoHookean(1e5, 5e5, 1e5, 1e-5)
MAGNET = ms.remanence.constant((0.1, 0.0, 0.0))
FORMS = ("one region", "ten equal regions", "ten thicknesses", "one layer", "two layers")


def model(form: str) -> ms.Model:
    """The strip made in one of `FORMS`."""
    mesh = ms.mesh.rectangle(40e-3, 10e-3, (40, 10))
    column = np.arange(len(mesh.elements)) * COUNT // len(mesh.elements)
    along = mesh.points[mesh.elements[:, 0], 0].argsort(kind="stable")
    part = np.empty_like(column)
    part[along] = column
    regions = [
        ms.Region(np.flatnonzero(part == number), thickness=(0.5 + 0.02 * number * (form == "ten thicknesses")) * 1e-3)
        for number in range(1, COUNT if form.startswith("ten") else 1)
    ]
    if "layer" in form:
        layers = 1 + (form == "two layers")
        shell = ms.Shell(mesh, layers=[ms.Layer(0.5e-3 / layers, RUBBER, MAGNET)] * layers)
    else:
        shell = ms.Shell(mesh, 0.5e-3, RUBBER, MAGNET, regions=regions)
    return ms.Model(shell, [ms.Clamp("left")], ms.UniformField((0.0, 0.0, 1e-3)))


def main() -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeats", type=int, default=20)
    repeats = parser.parse_args().repeats
    equations = [Discretisation(model(form), nested_dissection) for form in FORMS]
    best = np.full((len(FORMS), 3), np.inf)
    for _ in range(repeats + 1):
        for number, d in enumerate(equations):
            instant = Instant(d.undeformed(), d.model.loading(0.5))
            mixed = Instant(instant.state, instant.loading, d.predicted(instant))
            for column, work in enumerate(
                (
                    lambda d=d, mixed=mixed: d.assemble(mixed),
                    lambda d=d, instant=instant: d.assemble(instant, tangent=False),
                    lambda d=d, instant=instant: d.predicted(instant),
                )
            ):
                begin = time.process_time()
                work()
                best[number, column] = min(best[number, column], time.process_time() - begin)
    print(f"{'':20}{'unknowns':>9}{'tangent':>16}{'residual':>16}{'prediction':>16}   CPU ms, over one region")
    for form, d, row in zip(FORMS, equations, best, strict=True):
        cells = "".join(f"{1e3 * value:9.2f} ({value / one:4.2f})" for value, one in zip(row, best[0], strict=True))
        print(f"{form:20}{d.dofs:9d}{cells}")


if __name__ == "__main__":
    main()
