"""A magnet that moves does work on the body; sources that are far away make a uniform field."""

from __future__ import annotations

import numpy as np
import pytest

import magshell as ms
from magshell.magnetics import DeformationGradientEnergy, MicroRotationEnergy
from magshell.magnetics.fields import Cylinder, Dipole, MagnetField, Motion, Source

LENGTH, WIDTH, RISE, STOPS = 20e-3, 2e-3, 15e-3, 16


def strip(field: ms.UniformField, coupling: object, stages: int = 1, stops: int = 1) -> ms.Model:
    """Held at one end and magnetised along itself."""
    shell = ms.Shell(
        ms.mesh.rectangle(LENGTH, WIDTH, (6, 1)),
        0.5e-3,
        ms.MicropolarStVenantKirchhoff(150e3, 0.0),
        ms.remanence.constant((0.1, 0.0, 0.0)),
    )
    path = [ms.Stage() for _ in range(stages - 1)] + [ms.Stage(stops=stops)]
    probes = {"tip": (LENGTH, 0.0, 0.0)}
    return ms.Model(shell, [ms.Clamp("left")], field, coupling, probes, stages=path)


@pytest.mark.parametrize("coupling", [MicroRotationEnergy(), DeformationGradientEnergy()], ids=["rotation", "gradient"])
def test_work_of_a_moved_magnet_is_the_change_of_energy(coupling: object) -> None:
    """What moves the magnet against the body's pull: -∫ F · dd, by the trapezoidal rule, whose error falls by four."""
    motion = Motion(history=(1, 1), displacement=((0, 0, 0), (0, 0, RISE)))
    magnet = MagnetField([Source(Cylinder(0.02, 0.02, (0.0, 0.0, 1.3)), (-5e-3, 0.0, -0.05))], motion, name="magnet")
    path = ms.solve(strip(magnet, coupling, 2, STOPS))
    table = path.table()
    table = table[table["stage"] == 2]
    wanted = np.arange(1, STOPS + 1) / STOPS
    at = [int(np.argmin(np.abs(table["load_factor"].to_numpy() - stop))) for stop in wanted]
    rows = table.iloc[at]
    assert np.abs(rows["load_factor"].to_numpy() - wanted).max() < 1e-12
    energy = (rows["elastic"] + rows["magnetic"]).to_numpy()[3::4]
    change = energy[-1] - energy[0]
    errors = []
    for every in (4, 2, 1):
        force, height = (rows[name].to_numpy()[3::every] for name in ("magnet.F3", "magnet.d3"))
        errors.append(abs(-np.trapezoid(force, height) - change) / abs(change))
    assert errors[2] < 1e-3
    assert 3.5 < errors[0] / errors[1] < 4.5
    assert 3.5 < errors[1] / errors[2] < 4.5


def dipole(distance: float, sides: tuple[int, ...]) -> MagnetField:
    """Dipoles on the axis X3 that together make 2 mT at the origin."""
    moment = 2e-3 / len(sides) * distance**3 / 2e-7
    middle = np.array((LENGTH / 2, WIDTH / 2, 0.0))
    return MagnetField([Source(Dipole((0, 0, moment)), tuple(middle + np.array((0, 0, s * distance)))) for s in sides])


@pytest.mark.parametrize("coupling", [MicroRotationEnergy(), ms.MicropolarCouple()], ids=["rotation", "couple"])
def test_far_sources_make_a_uniform_field(coupling: object) -> None:
    """At 100 body lengths: two whose gradients cancel to 1e-3; of one the gradient is left, half of it at 200."""
    uniform = ms.solve(strip(ms.UniformField((0, 0, 2e-3)), coupling)).probe("tip").u3[-1]
    assert uniform > 0.2 * LENGTH

    def apart(lengths: int, *sides: int) -> float:
        tip = ms.solve(strip(dipole(lengths * LENGTH, sides), coupling)).probe("tip").u3[-1]
        return abs(tip / uniform - 1.0)

    assert apart(100, -1, 1) < 1e-3
    one, farther = apart(100, 1), apart(200, 1)
    assert 1e-3 < one < 3e-2
    assert one / farther == pytest.approx(2.0, rel=0.1)
