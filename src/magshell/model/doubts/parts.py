"""Parts of a shell that lie beside their mesh, and layers that one director does not describe."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from magshell.model.parts import Part
from magshell.model.shell import Shell
from magshell.model.words import name_of
from magshell.shell.shear_profile import Moduli, stiffness
from magshell.units import LENGTH, show

SHORT = 0.1
"""Part of the extent of the shell over which layers may bend apart unnoticed."""


def doubts(shell: Shell) -> Iterator[str]:
    """Of all parts."""
    yield from _outside(shell.parts)
    yield from _layers_that_bend_apart(shell)


def _outside(parts: Sequence[Part]) -> Iterator[str]:
    """A mesh that lies beyond a face, so that nothing of the shell is where it is drawn, supported and loaded."""
    for part in parts:
        beyond = np.abs(part.offset_at_nodes) - 0.5 * part.at_nodes.sum(axis=2)
        if beyond.max() > 1e-9 * part.at_nodes.max():
            yield (
                f"'{name_of(part)}': the mesh lies outside its faces, {show(float(beyond.max()), LENGTH)} from the "
                "nearer one; check offset"
            )


def _layers_that_bend_apart(shell: Shell) -> Iterator[str]:
    """Stacks that one director does not describe: stiff layers that a soft one hardly ties to each other.

    Beside a clamp or a load each layer bends about its own middle, over the length √(D' (1 - D'/D)/K) with the bending
    stiffness D of the stack, D' = Σ E' h³/12 of its layers alone, and its shear stiffness K.
    """
    extent = float(np.ptp(shell.mesh.points, axis=0).max())
    for part in shell.parts:
        if len(part.layers) < 2:
            continue
        moduli = [Moduli.of(layer.material) for layer in part.layers]
        whole = stiffness(part.at_nodes, moduli)
        alone = part.at_nodes**3 @ np.array([one.plane for one in moduli]) / 12.0
        length = float(np.sqrt(alone * (1.0 - alone / whole.bending) / whole.shear).max())
        if length > SHORT * extent:
            yield (
                f"layers of '{name_of(part)}': within {show(length, LENGTH)} of clamps, loads and borders the stiff "
                "ones bend apart, since the soft ones hardly tie them; the model, in which all share a director, is "
                "too stiff there"
            )
