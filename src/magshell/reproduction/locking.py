"""The paper's figure on the thickness stretch: the strips with it, without it and with plane stress."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from magshell.output.curve import load_per_mT
from magshell.output.style import COLOURS, TEXT
from magshell.reproduction.curves import DOT, MARK, add_curve, legend, load_axes, new_figure
from magshell.reproduction.numbers import length_of
from magshell.reproduction.references import ASPECT_RATIOS, MEASURED, MEASURED_ON, SOLID, SOLID_FIELDS
from magshell.reproduction.variants import LOCKING, STRETCHES, stretched

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from magshell.reproduction.catalogue import Example
    from magshell.solver.path import Path

LABELS = {"linear": "φ free", "plane-stress": "no φ, plane stress", "none": "no φ"}


def locking_figure(example: Example, paths: Mapping[str, Path]) -> Figure:
    """Tip deflection of three strips with the thickness stretch, without it, and with plane stress instead."""
    figure = new_figure((15.0, 5.4))
    for number, (panel, name) in enumerate(zip(figure.subplots(1, len(LOCKING), sharey=True), LOCKING, strict=True)):
        axes = load_axes(paths[name], "$u_3/L$ at the tip" if number == 0 else "", panel)
        axes.set_title(f"length / thickness = {ASPECT_RATIOS[name]:g}", pad=12, **TEXT)
        for colour, stretch in zip(COLOURS, STRETCHES, strict=False):
            path = paths[stretched(name, stretch)]
            style = {"linestyle": "--"} if stretch == "plane-stress" else {}
            add_curve(axes, path, path.probe("tip").u3 / length_of(path), color=colour, label=LABELS[stretch], **style)
        scale = load_per_mT(paths[name])
        axes.plot(scale * np.array(SOLID_FIELDS), SOLID[name], label="solid, no shell", **MARK)
        if name == MEASURED_ON:
            at, measured = np.transpose(MEASURED)
            axes.plot(scale * at, measured, label="experiment", **DOT)
        legend(axes, loc="lower right")
    return figure
