"""The field of the body itself: errors for two plates, what neighbouring elements do to each other, and CPU time.

    OMP_NUM_THREADS=1 python benchmarks/own_field.py

The force between two square plates of 10 × 10 × 1 mm, 100 mT through the thickness, over gaps, against magpylib's of
two cuboids. The change of length of a strip of 20 × 2 × 0.5 mm, 300 kPa, 100 mT along it, by its own field alone, over
the mesh. CPU time of one evaluation of the field and of a path, over the number of elements.
"""

from __future__ import annotations

import time

import magpylib
import numpy as np

import magshell as ms
from magshell.arrays import FloatArray
from magshell.equations.discretisation import Discretisation
from magshell.evaluation.balance import on_levels
from magshell.model.model import Model

SIDE, THICKNESS, J = 10e-3, 1e-3, 0.1
GAPS = (1e-3, 1.5e-3, 2e-3, 3e-3, 5e-3)


def two_plates(gap: float, count: int) -> Model:
    """Plates of count × count elements, both held."""
    one = ms.mesh.rectangle(SIDE, SIDE, (count, count))
    points = np.concatenate([one.points, one.points + np.array((0.0, 0.0, gap + THICKNESS))])
    elements = np.concatenate([one.elements, one.elements + len(one.points)])
    held = {"all": np.arange(len(points))}
    mesh = ms.mesh.Mesh(points, elements, node_groups=held)
    material = ms.MicropolarStVenantKirchhoff(150e3, 0.0)
    shell = ms.Shell(mesh, THICKNESS, material, ms.remanence.constant((0.0, 0.0, J)))
    return Model(shell, [ms.Clamp("all")], ms.UniformField((0.0, 0.0, 1e-3)) + ms.SelfField())


def force(model: Model) -> FloatArray:
    """Of the lower plate on the upper one (3,), N."""
    d = Discretisation(model, lambda graph: np.arange(graph.shape[0]))
    loading = model.loading(1.0)._replace(drives=np.array([0.0, 0.0, 1.0]))
    state = d.undeformed()
    found = on_levels(d, state, d.shell.field.at(state, loading, second=False)).force
    return np.asarray(found[len(found) // 2 :].sum(axis=(0, 1, 2)))


def plates() -> None:
    """Errors of the force."""
    counts = (2, 4, 8)
    print("gap, mm   force, mN   " + "   ".join(f"elements of {1e3 * SIDE / count:g} mm" for count in counts))
    plate = {"dimension": (SIDE, SIDE, THICKNESS), "polarization": (0.0, 0.0, J)}
    for gap in GAPS:
        source, target = (magpylib.magnet.Cuboid(**plate, position=(0.0, 0.0, z)) for z in (0.0, gap + THICKNESS))
        exact = magpylib.getFT(source, target, meshing=20000)[0][2]
        errors = [force(two_plates(gap, count))[2] / exact - 1.0 for count in counts]
        row = "   ".join(f"{error:18.1e}" for error in errors)
        print(f"{1e3 * gap:7.1f} {1e3 * exact:11.4f}   {row}")


def strip(counts: tuple[int, int]) -> Model:
    """Held at one end, in its own field alone."""
    mesh = ms.mesh.rectangle(20e-3, 2e-3, counts)
    shell = ms.Shell(mesh, 0.5e-3, ms.MicropolarStVenantKirchhoff(150e3, 0.0), ms.remanence.constant((J, 0.0, 0.0)))
    probes = {"end": (20e-3, 0.0, 0.0)}
    return Model(shell, [ms.Clamp("left")], ms.SelfField(), ms.MicroRotationEnergy(), probes=probes)


def neighbours() -> None:
    """Strains of the strip and CPU times."""
    print("\nelements   length, mm   strain of the strip   CPU s of one sum   of the path   steps")
    for counts in ((10, 1), (20, 2), (40, 4)):
        model = strip(counts)
        d = Discretisation(model, lambda graph: np.arange(graph.shape[0]))
        own = d.shell.field.own
        assert own is not None
        own.at(d.undeformed())
        begin = time.process_time()
        own.at(d.undeformed())
        one = time.process_time() - begin
        begin = time.process_time()
        path = ms.solve(model)
        whole = time.process_time() - begin
        strain = path.probe("end").u1[-1] / 20e-3
        count = counts[0] * counts[1]
        print(f"{count:8d} {20.0 / counts[0]:12.2f} {strain:21.2e} {one:18.3f} {whole:13.1f} {len(path.steps):7d}")


if __name__ == "__main__":
    plates()
    neighbours()
