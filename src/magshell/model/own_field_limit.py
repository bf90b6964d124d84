"""Whether the body's own field is so strong that touching elements strain each other.

Elements that touch attract as if they were cut apart there, by stresses of the order B̃²/mu0 that grow as the mesh gets
finer (`benchmarks/own_field.py`): a strip alone strains by 0.2 to 0.8 times B̃²/(mu0 E), E about 3 mu.
"""

from __future__ import annotations

import logging
from collections.abc import Iterator

import numpy as np

from magshell.magnetics.fields import Field
from magshell.magnetics.fields.magnets import VACUUM_PERMEABILITY
from magshell.magnetics.fields.own import has_own
from magshell.model.shell import Shell

logger = logging.getLogger(__name__)

NOTICEABLE = 1e-3
"""B̃²/(3 mu0 mu) above which this is told."""


def reached(shell: Shell, field: Field) -> Iterator[str]:
    """A sentence for the layer on which this has the largest effect, if it is noticeable."""
    if not has_own(field):
        return
    largest, where = 0.0, ""
    for part in shell.parts:
        for number, layer in enumerate(part.layers):
            remanence = float(np.linalg.norm(part.remanence[:, :, number], axis=-1).max())
            ratio = remanence**2 / (3.0 * VACUUM_PERMEABILITY * layer.material.shear_modulus)
            if ratio > largest:
                largest, where = ratio, part.name
    if largest > NOTICEABLE:
        of_part = f" of region '{where}'" if len(shell.parts) > 1 else ""
        yield (
            f"self_field: B_rem²/(3 mu0 mu){of_part} is {largest:.2g}: touching elements strain each other by some "
            "tenths of that, more on finer meshes. Trust what separate pieces do to each other, not what bending "
            "sheets do to themselves; compare two meshes"
        )
