"""Regions and layers in words: what each is made of, its mass, and remanence that it does not take."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from magshell.arrays import IntArray
from magshell.materials import MATERIALS
from magshell.model.loads.mass import part_mass
from magshell.model.parts import Part
from magshell.model.region import Layer
from magshell.model.words import name_of, offset_of, thickness_of
from magshell.problem import remanence_report
from magshell.problem.building import Problem
from magshell.units import DENSITY, FLUX_DENSITY, LENGTH, MASS, STRESS, show
from magshell.wording import counted


def has_several(problem: Problem) -> bool:
    """Whether there is more to say than of one thickness and one material."""
    parts = problem.model.shell.parts
    return len(parts) > 1 or parts[0].layered or bool(problem.model.shell.regions)


def lines(problem: Problem) -> Iterator[tuple[str, str]]:
    """Label and text for each region and each of its layers."""
    shell = problem.model.shell
    for part in shell.parts:
        mass = part_mass(part, shell, problem.model.rows)
        yield (
            name_of(part) if len(shell.parts) > 1 else "whole shell",
            f"{counted(len(part.elements), 'element')}, thickness {thickness_of(part)}{offset_of(part)}"
            + ("" if mass is None else f", mass {show(mass, MASS)}"),
        )
        for number, layer in enumerate(part.layers):
            height = f"{thickness_of(part, number)} of " if part.layered else ""
            yield (
                f"  layer {number}{_end(number, part)}" if part.layered else "  material",
                height + _made_of(layer) + _magnetised(part, number),
            )


def _end(number: int, part: Part) -> str:
    return " (bottom)" if number == 0 else " (top)" if number == len(part.layers) - 1 else ""


def _made_of(layer: Layer) -> str:
    material = layer.material
    mu, lam = material.shear_modulus, material.lame_lambda
    modulus, ratio = mu * (3.0 * lam + 2.0 * mu) / (lam + mu), 0.5 * lam / (lam + mu)
    words = f"{law_of(material)}, mu {show(mu, STRESS)}, E {show(modulus, STRESS)}, nu {ratio:.4g}"
    if material.coupling_modulus:
        words += f", eta {show(material.coupling_modulus, STRESS)}, l {show(material.length_scale, LENGTH)}"
    return words if layer.density is None else f"{words}, density {show(layer.density, DENSITY)}"


def _magnetised(part: Part, number: int) -> str:
    greatest = float(np.linalg.norm(part.remanence[:, :, number], axis=-1).max())
    if not greatest:
        return ", no remanence" if part.layered else ""
    return f", remanence up to {show(greatest, FLUX_DENSITY)}"


def law_of(material: object) -> str:
    """Its name in problem files."""
    return next((name for name, law in MATERIALS.items() if type(material) is law), type(material).__name__)


def remanences(problem: Problem) -> Iterator[tuple[str, str]]:
    """The remanence of regions and layers that have their own."""
    for name, layers, entries in (
        ("", problem.file.shell.layers, ()),
        *((", ".join(table.group), table.layers, table.remanence or ()) for table in problem.file.regions),
    ):
        for entry in entries:
            yield ", ".join(entry.group or (name,)), remanence_report.sense(entry)
        for number, layer in enumerate(layers):
            for entry in layer.remanence:
                yield f"{name or 'shell'} layer {number}", remanence_report.sense(entry)


def shared(problem: Problem) -> IntArray:
    """Numbers of the elements whose remanence is that of the whole shell."""
    shell = problem.model.shell
    parts = [p.elements for p in shell.parts if not p.layered and p.layers[0].remanence is shell.remanence]
    return np.concatenate([np.zeros(0, dtype=np.int64), *parts])


def doubts(problem: Problem) -> Iterator[str]:
    """Remanence that no element has; elements of a region and of the group of a remanence that it does not take."""
    shell, of_shell = problem.model.shell, shared(problem)
    for number, entry in enumerate(problem.file.remanence):
        for group in entry.group or ():
            members = shell.mesh.elements_of(group)
            lost = np.setdiff1d(members, of_shell)
            if lost.size:
                yield (
                    f"remanence[{number}]: {counted(len(lost), 'element')} of '{group}' (first element {lost[0]}) lie "
                    f"in the region '{shell.parts[shell.part_of[lost[0]]].name}', which has its own remanence or layers"
                )
        if entry.group is None and not of_shell.size:
            yield f"remanence[{number}]: no element has it: all regions have their own remanence or layers"
