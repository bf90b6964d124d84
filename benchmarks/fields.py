"""CPU time of a magnetic field with its derivatives, against values of B by magpylib alone; errors of the differences.

    OMP_NUM_THREADS=1 python benchmarks/fields.py [--points 100000] [--steps] [--path]

Points lie 5 to 25 mm above magnets of 20 mm, or within a ring of 16. The least of three runs counts.
With --steps, errors of the gradient and second derivatives against the step of the differences, at points a tenth of
the size to ten sizes away: exact for the dipole, for others against differences of two larger steps, extrapolated.
With --path, CPU time of a whole path of 1000 elements over a magnet, directly and by splines, and in the uniform field
that the magnet has at the shell's middle.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from typing import Any

import numpy as np

import magshell as ms
from magshell.arrays import FloatArray
from magshell.magnetics.fields import Cuboid, Cylinder, Dipole, Loop, MagnetField, Shape, Source, halbach
from magshell.magnetics.fields.differences import STEP, harmonic

J = (0.0, 0.0, 1.3)
ABOVE, WITHIN = (0.02, 0.02, 0.01), (0.025, 0.025, 0.01)


def seconds(call: Callable[[], Any]) -> float:
    """Least CPU time of three calls."""
    spent = []
    for _ in range(3):
        begin = time.process_time()
        call()
        spent.append(time.process_time() - begin)
    return min(spent)


def speed(count: int) -> None:
    """A table of sources."""
    random = np.random.default_rng(0)
    above = random.uniform(-1.0, 1.0, (count, 3)) * ABOVE + [0.0, 0.0, 0.025]
    within = random.uniform(-0.5, 0.5, (count // 10, 3)) * WITHIN
    amounts = np.array([1.0, 0.0, 0.0, 0.0, 0.0])
    cases = {
        "cylinder": ((Source(Cylinder(0.02, 0.02, J)),), above, 6e-4),
        "cuboid": ((Source(Cuboid((0.02, 0.02, 0.02), J)),), above, 6e-4),
        "dipole": ((Source(Dipole((0.0, 0.0, 6.5))),), above, 6e-4),
        "Halbach ring of 16": (halbach(0.05, 16, (0.01, 0.01, 0.01), 1.3), within, 1.5e-3),
    }
    print("                         B alone    B, ∇B, ∇∇B      ratio   by splines   first call   error of ∇B")
    print("                      µs a point     µs a point             µs a point            s   relative")
    for name, case in cases.items():
        print(f"{name:20s} {line(amounts, *case)}")


def line(amounts: FloatArray, sources: tuple[Source, ...], points: FloatArray, spacing: float) -> str:
    """The columns of some sources."""
    direct, spline = MagnetField(sources), MagnetField(sources, spacing=spacing)
    alone = 1e6 * seconds(lambda: direct._flux_density(points)) / len(points)
    whole = 1e6 * seconds(lambda: direct.at(amounts, points)) / len(points)
    begin = time.process_time()
    spline.at(amounts, points)
    first = time.process_time() - begin
    fast = 1e6 * seconds(lambda: spline.at(amounts, points)) / len(points)
    error = spline.interpolation_error(amounts, points[:1000])[1] / np.abs(direct.direct(points[:1000])[1]).max()
    return f"{alone:14.2f} {whole:14.2f} {whole / alone:10.1f} {fast:12.2f} {first:12.2f} {error:12.0e}"


def paths() -> None:
    """CPU time of a path in each field, for the same stops, and its ratio to that in the uniform one."""
    length, width, magnet = 0.04, 0.02, Source(Cylinder(0.02, 0.02, J), (0.02, 0.01, -0.07))
    material = ms.MicropolarStVenantKirchhoff(150e3, 0.0, 150e3, 5e-6)
    shell = ms.Shell(ms.mesh.rectangle(length, width, (50, 20)), 1e-3, material, ms.remanence.constant((0.05, 0, 0)))
    one = MagnetField((magnet,))
    middle = one.at(one.ends(1)[1], np.array([[0.5 * length, 0.5 * width, 0.0]]), second=False).flux_density[0]
    fields = {"uniform": ms.UniformField(middle), "direct": one, "splines": MagnetField((magnet,), spacing=2e-3)}
    stages = [ms.Stage(stops=np.linspace(0.1, 0.9, 9))]
    spent: dict[str, float] = {}
    print("field        steps   iterations   CPU s   over uniform   per iteration")
    for name, field in fields.items():
        model = ms.Model(shell, [ms.Clamp("left")], field, stages=stages)
        ms.solve(ms.Model(shell, [ms.Clamp("left")], field), ms.Settings())  # compiles, fills splines
        begin = time.process_time()
        path = ms.solve(model)
        spent[name] = time.process_time() - begin
        iterations = sum(step.iterations for step in path.steps)
        ratio, each = spent[name] / spent["uniform"], spent[name] / iterations
        print(f"{name:10s} {len(path.steps):7d} {iterations:12d} {spent[name]:7.1f} {ratio:14.2f} {each:15.3f}")


def steps() -> None:
    """A table of errors."""
    shapes = {
        "dipole": Dipole((0.5, -1.0, 2.0)),
        "cylinder": Cylinder(0.02, 0.02, J),
        "cuboid": Cuboid((0.02, 0.02, 0.02), (0.3, 0.0, 1.3)),
        "loop": Loop(0.02, 1e3),
    }
    print("step / distance   " + "   ".join(f"{name:>9s} ∇B    ∇∇B" for name in shapes))
    places = {name: around(shape) for name, shape in shapes.items()}
    exact = {name: reference(shape, places[name]) for name, shape in shapes.items()}
    for share in (1e-3, 2e-3, 4e-3, STEP, 1.6e-2, 3.2e-2):
        row = f"{share:15.4f}   "
        for name, shape in shapes.items():
            points = places[name]
            distance = shape.distance(points)
            values = harmonic(shape.flux_density, points, share * distance, True)
            B = norm(values.flux_density)
            first = norm(values.gradient - exact[name][0]) * distance / B
            second = norm(values.second - exact[name][1]) * distance**2 / B
            row += f"   {first.max():9.0e} {second.max():6.0e}"
        print(row)


def around(shape: Shape, count: int = 2000) -> FloatArray:
    """Points outside a source."""
    random = np.random.default_rng(1)
    points = random.normal(size=(count, 3))
    points *= 0.01 * 10 ** random.uniform(-0.5, 1.0, (count, 1)) / np.linalg.norm(points, axis=1, keepdims=True)
    return np.asarray(points[(shape.distance(points) > 1e-3) & ~shape.inside(points)])


def reference(shape: Shape, points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Gradient and second derivatives: exact, or without the error of sixth order."""
    if isinstance(shape, Dipole):
        exact = shape.values(points, True)
        return exact.gradient, exact.second
    distance = shape.distance(points)
    fine, coarse = (harmonic(shape.flux_density, points, share * distance, True) for share in (1.2e-2, 2.4e-2))
    pairs = ((fine.gradient, coarse.gradient), (fine.second, coarse.second))
    first, second = ((64.0 * one - other) / 63.0 for one, other in pairs)
    return first, second


def norm(array: FloatArray) -> FloatArray:
    """Of all but the first index."""
    return np.sqrt((array.reshape(len(array), -1) ** 2).sum(axis=1))


def main() -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--points", type=int, default=100_000)
    parser.add_argument("--steps", action="store_true", help="errors of the differences in place of times")
    parser.add_argument("--path", action="store_true", help="times of whole paths in place of those of values")
    asked = parser.parse_args()
    if asked.steps:
        steps()
    elif asked.path:
        paths()
    else:
        speed(asked.points)


if __name__ == "__main__":
    main()
