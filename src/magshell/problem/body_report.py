"""Rigid bodies in words: what each is made of, and what is known of its motion."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from magshell.mesh.geometry import COINCIDENT
from magshell.model.model import Model
from magshell.model.rigid_body import RigidBody
from magshell.model.turn import Turn
from magshell.units import LENGTH, MAGNETIC_MOMENT, MASS, show
from magshell.wording import counted, quantity


def lines(model: Model) -> Iterator[tuple[str, str]]:
    """Label and text of each rigid body, of turned groups too."""
    turned = {support.group for support in model.supports if isinstance(support, Turn)}
    for body in model.shell.rigid:
        yield body.name, _said(model, body) + ", turned by a support" * (body.name in turned)


def _said(model: Model, body: RigidBody) -> str:
    mesh = model.shell.mesh
    group = "" if body.group == body.name else f"group '{body.group}', "
    point = body.reference_point(mesh)
    point = np.where(np.abs(point) > COINCIDENT * mesh.size, point, 0.0)
    about = ", ".join(show(x, LENGTH) for x in point)
    text = f"{group}{counted(len(mesh.nodes_of(body.group)), 'node')} about ({about})"
    if body.mass:
        text += f", mass {show(body.mass, MASS)}"
    if np.any(body.moment):
        text += f", magnetic moment {quantity(tuple(np.ravel(body.moment).tolist()), MAGNETIC_MOMENT)}"
    return text
