"""Supports that hold other rotations than they seem to."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from magshell.model.doubts.asked import Asked
from magshell.model.supports import Clamp, Prescribe


def doubts(model: Asked) -> Iterator[str]:
    """Of all supports."""
    yield from _micro_rotation_alone(model)
    yield from _both_sides_of_hinges(model)


def _micro_rotation_alone(model: Asked) -> Iterator[str]:
    """Of every group whose micro-rotation is given, and whose director is not."""
    given = [support for support in model.supports if isinstance(support, Prescribe)]
    sections = {support.group for support in given if support.field == "w"}
    sections |= {body.name for body in model.shell.rigid}
    for group in dict.fromkeys(one.group for one in given if one.field == "omega" and np.any(one.value)):
        if group not in sections:
            yield (
                f"support on '{group}': omega is that of the micro-rotation alone, which the section follows only in "
                'part; to turn the section, write kind = "turn" (in Python Turn), or make the group a rigid body'
            )


def _both_sides_of_hinges(model: Asked) -> Iterator[str]:
    """Of every clamp that holds a hinge: rotations of a node are held for all that meets there."""
    shell = model.shell
    for support in model.supports:
        if not isinstance(support, Clamp):
            continue
        held = shell.nodes_of(support.group)
        for hinge in shell.hinges:
            if np.isin(hinge.edges(shell.mesh), held).all(axis=1).any():
                yield (
                    f"support on '{support.group}': the clamp holds both sides of the hinge '{hinge.group}', which "
                    "cannot turn there; where it shall, hold u alone (simple), or leave the nodes of the hinge out"
                )
