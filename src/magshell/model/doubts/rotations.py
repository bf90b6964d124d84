"""Prescribed rotations that do not turn the section, as they seem to."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from magshell.model.doubts.asked import Asked
from magshell.model.supports import Prescribe


def doubts(model: Asked) -> Iterator[str]:
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
