"""Layers with the default element: write tables of `regions.md`.

    python docs/make_layer_study.py       a quarter of a minute

A long strip in cylindrical bending under a small force at its end, against laminate theory with the shear stiffness
of equilibrium: u = F L³ / 3 D + F L / K. A bent strip of one material, integrated at 2 and at more levels.
"""

from __future__ import annotations

import pathlib
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from blocks import write_blocks

import magshell as ms
from magshell.shell.shear_profile import Moduli, stiffness

DOCS = pathlib.Path(__file__).parent
COMMAND = "docs/make_layer_study.py"
LENGTH, WIDTH, ELEMENTS = 20e-3, 1e-3, 20
# End deflection over length: so small that the response is linear.
SMALL = 1e-5


class Stack(NamedTuple):
    """Layers from the bottom: thickness (m), Young's modulus (Pa) and Poisson's ratio of each."""

    name: str
    layers: Sequence[tuple[float, float, float]]


STACKS = (
    Stack("one layer, ν 0.3", [(1e-3, 1e6, 0.3)]),
    Stack("one layer, ν 0.49", [(1e-3, 1e6, 0.49)]),
    Stack("ν 0.3 on ν 0.49, moduli 1 : 1", [(0.5e-3, 1e6, 0.49), (0.5e-3, 1e6, 0.3)]),
    Stack("ν 0.3 on ν 0.49, moduli 1000 : 1", [(0.5e-3, 1e3, 0.49), (0.5e-3, 1e6, 0.3)]),
    Stack("sandwich, core 0.001 of the faces, ν 0.3", [(0.1e-3, 1e6, 0.3), (0.8e-3, 1e3, 0.3), (0.1e-3, 1e6, 0.3)]),
    Stack("the same, core with ν 0.49", [(0.1e-3, 1e6, 0.3), (0.8e-3, 1e3, 0.49), (0.1e-3, 1e6, 0.3)]),
)


class Bent(NamedTuple):
    """Deflection of an end over that of laminate theory, and the share of it that shear makes."""

    ratio: float
    shear: float


def rubber(young: float, nu: float) -> ms.MicropolarNeoHookean:
    """With a couple stress that does not count."""
    return ms.MicropolarNeoHookean.from_moduli(youngs_modulus=young, poissons_ratio=nu, length_scale=1e-8)


def bent(stack: Stack, length: float = LENGTH) -> Bent:
    """A strip between mirror planes, whose other end is free to change its thickness."""
    materials = [rubber(young, nu) for _, young, nu in stack.layers]
    heights = np.array([height for height, _, _ in stack.layers])
    theory = stiffness(heights, [Moduli.of(material) for material in materials])
    bending, shear = length**3 / (3.0 * float(theory.bending)), length / float(theory.shear)
    force = SMALL * length / (bending + shear) * WIDTH
    mesh = ms.mesh.rectangle(length, WIDTH, (ELEMENTS, 1))
    supports = [
        ms.SymmetryPlane("left", (1, 0, 0)),
        ms.Prescribe("left", "u", 3, 0.0),
        ms.SymmetryPlane("top", (0, 1, 0)),
        ms.SymmetryPlane("bottom", (0, 1, 0)),
    ]
    shell = ms.Shell(
        mesh, layers=[ms.Layer(height, material) for height, material in zip(heights, materials, strict=True)]
    )
    model = ms.Model(shell, supports, loads=[ms.Force("right", (0, 0, force))], probes={"end": (length, 0, 0)})
    path = ms.solve(model, ms.Settings(first_step=1.0))
    return Bent(float(path.probe("end").u3[-1]) / (SMALL * length), shear / (bending + shear))


def rolled(levels: int, scale: float) -> float:
    """Deflection over length of a strip in a field at right angles, q = 5, with so many levels and l = scale h."""
    length, height, magnet, mu = 20e-3, 1e-3, 0.1, 1e5
    material = ms.MicropolarNeoHookean(mu, 24.0 * mu, 0.1 * mu, scale * height)
    stiff = 4.0 * mu * height**3 / 12.0
    field = 5.0 * 4e-7 * np.pi * stiff / (height * magnet * length**2)
    mesh = ms.mesh.rectangle(length, 5e-3, (16, 2))
    shell = ms.Shell(mesh, height, material, ms.remanence.constant((magnet, 0, 0)), levels=levels)
    model = ms.Model(shell, [ms.Clamp("left")], ms.UniformField((0, 0, field)), probes={"end": (length, 2.5e-3, 0)})
    return float(ms.solve(model).probe("end").u3[-1]) / length


def laminates() -> str:
    """Table of the stacks."""
    rows = ["| Layers | Shear makes (%) | Deflection over theory, L/h = 20 | L/h = 100 |", "|---|---:|---:|---:|"]
    for stack in STACKS:
        short, long = bent(stack), bent(stack, 5.0 * LENGTH)
        rows.append(f"| {stack.name} | {100.0 * short.shear:.1f} | {short.ratio:.5f} | {long.ratio:.5f} |")
    return "\n".join(rows)


def levels() -> str:
    """Table of the number of levels."""
    counts = (2, 3, 4)
    rows = [f"| Length scale | {' | '.join(f'{count} levels' for count in counts)} |", "|---|" + "---:|" * len(counts)]
    for scale in (0.1, 0.01):
        rows.append(f"| h/{1.0 / scale:.0f} | " + " | ".join(f"{rolled(count, scale):.6f}" for count in counts) + " |")
    return "\n".join(rows)


def main() -> None:
    """Write the blocks, and print them."""
    blocks = {"laminates": laminates(), "levels": levels()}
    for block in blocks.values():
        print(block, end="\n\n")
    write_blocks(DOCS / "regions.md", blocks, COMMAND)


if __name__ == "__main__":
    main()
