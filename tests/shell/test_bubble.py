"""How stiffly the bubble is held in the plane: what section 3 of the theory says."""

from __future__ import annotations

import pathlib
import re

import numpy as np
import pytest

from magshell.mesh import rectangle
from magshell.shell.bubble import hold
from magshell.shell.element import layout_of
from magshell.shell.elements import ELEMENTS
from magshell.shell.geometry import interpolation
from magshell.shell.shape_functions import bubble, gauss_legendre
from shell.kernel_access import held_energy

THEORY = (pathlib.Path(__file__).parents[2] / "docs" / "theory.md").read_text()


def test_the_hold_over_full_integration():
    """On a square, for incompressible material in plane stress: of modulus 4 mu, and mu in shear."""
    element, side, thickness, shear_modulus = ELEMENTS["quadratic"], 3.0, 1e-5, 2.0
    square = rectangle(side, side, (1, 1))
    X = square.points[square.elements]
    shape = interpolation(X, np.broadcast_to([0.0, 0.0, 1.0], X.shape), element, micro_rotation=True)
    amplitude = (shape.enhancement[0, :, :2, -1] / bubble(element.rule.points)[1])[0, 0]
    held = hold(X, element, np.full(1, thickness), np.full(1, shear_modulus))
    layout = layout_of(8, element.rest_nodes, element.stretch_nodes, element.rest_nodes, element.vectors)
    of_hold = held_energy(held, 0, 0, layout, (1.0, 0.0, 0.0))

    (xi, eta), weights = gauss_legendre(3)[0].T, gauss_legendre(3)[1]
    # The combination 3 ξ²η² - ξ² - η² with the coefficient of ξ²η² that the bubble has.
    along, across = 2.0 * xi * (3.0 * eta**2 - 1.0) / 3.0, 2.0 * eta * (3.0 * xi**2 - 1.0) / 3.0
    stress_work = shear_modulus * (4.0 * along**2 + across**2)
    of_integration = 0.5 * thickness * amplitude**2 * weights @ stress_work

    said = re.search(r"on a square of\s+incompressible material by \$\\frac\{(\d+)\}\{(\d+)\}\$", THEORY)
    assert of_hold / of_integration == pytest.approx(int(said[1]) / int(said[2]), rel=1e-6)
