"""Linear buckling where nothing moves before: Euler's column, the bifurcation of a path, a loaded state."""

from __future__ import annotations

import csv

import numpy as np
import pytest

import magshell as ms
from magshell.cli import main
from magshell.output.buckling import write_buckling

YOUNG, LENGTH, WIDTH, THICKNESS = 1e6, 1.0, 0.1, 0.01
# Of an elastic line clamped at one end.
EULER = np.pi**2 * YOUNG * WIDTH * THICKNESS**3 / 12 / (4 * LENGTH**2)

# The same column as a problem file.
COLUMN = f"""
[mesh]
generator = "rectangle"
length = "1 m"
width = "0.1 m"
elements = [10, 1]

[shell]
thickness = "10 mm"

[material]
law = "micropolar-st-venant-kirchhoff"
shear_modulus = "500 kPa"
lame_lambda = 0
coupling_modulus = "50 kPa"
length_scale = "0.1 mm"

[[loads]]
kind = "force"
group = "right"
total = ["{-EULER} N", 0, 0]

[[supports]]
kind = "clamp"
group = "left"
"""


def column(load, micro_rotation=False, **options):
    """A strip clamped at one end and pressed at the other along its axis, without Poisson's effect."""
    mesh = ms.mesh.rectangle(LENGTH, WIDTH, (10, 1))
    coupling = (YOUNG / 20, THICKNESS / 100) if micro_rotation else (0.0, 0.0)
    material = ms.MicropolarStVenantKirchhoff(YOUNG / 2, 0.0, *coupling)
    shell = ms.Shell(mesh, THICKNESS, material, micro_rotation=micro_rotation)
    loads = [ms.Force("right", (-load, 0.0, 0.0), history=options.pop("history", None))]
    return ms.Model(shell, [ms.Clamp("left")], loads=loads, probes={"tip": (LENGTH, 0, 0)}, **options)


@pytest.mark.parametrize("micro_rotation", [False, True], ids=["7 parameters", "10 parameters"])
def test_columns_buckle_at_the_loads_of_euler(micro_rotation):
    """(1, 3, 5)² times Euler's load; shear, which lowers them, is of the order of their strain, up to 2e-3 here."""
    found = ms.buckling(column(EULER, micro_rotation), modes=3)
    loads = np.array([mode.load_factor for mode in found.modes])
    assert loads == pytest.approx([1.0, 9.0, 25.0], rel=4e-3), loads
    waves = found.modes[0].mode[found.path.model.shell.mesh.nodes_of("bottom"), 2]
    x = found.path.model.shell.mesh.points[found.path.model.shell.mesh.nodes_of("bottom"), 0]
    shape = 1.0 - np.cos(0.5 * np.pi * x / LENGTH)
    error = np.abs(waves / waves[np.argmax(np.abs(waves))] - shape).max()
    assert error < 2e-3, f"{error:.1e}"


def test_about_a_loaded_state_the_same_load_is_found():
    """Half of the load first; the path does not bend, so the sum is the same but for the square of the strain."""
    once = ms.buckling(column(EULER), modes=1).modes[0].load_factor
    twice = ms.buckling(column(2.0 * EULER, history=(0.25, 1.0)), modes=1)
    assert 0.25 + 0.75 * twice.modes[0].load_factor == pytest.approx(0.5 * once, rel=1e-4)
    assert twice.path.converged
    assert twice.modes[0].stage == 1


def test_a_straight_path_bifurcates_where_it_buckles():
    """A strip magnetised against the field stays straight until then, so that the estimate is exact."""
    mesh = ms.mesh.rectangle(17.2e-3, 5e-3, (8, 1))
    shell = ms.Shell(
        mesh, 0.84e-3, ms.MicropolarNeoHookean(303e3, 7.3e6, 30.3e3, 0.84e-4), ms.remanence.constant((143e-3, 0, 0))
    )
    model = ms.Model(shell, [ms.Clamp("left")], ms.UniformField((-8e-3, 0, 0)))
    path = ms.solve(model)
    mode = ms.buckling(model, modes=1).modes[0]
    first = path.critical_points[0]
    assert first.kind == "bifurcation"
    assert mode.load_factor == pytest.approx(first.load_factor, rel=1e-5)
    assert mode.flux_density == pytest.approx(first.flux_density, rel=1e-5)
    alike = abs(np.vdot(mode.mode[:, :3], first.mode[:, :3])) / np.linalg.norm(mode.mode[:, :3])
    assert alike == pytest.approx(np.linalg.norm(first.mode[:, :3]), rel=1e-6)


def test_modes_are_written(tmp_path):
    found = ms.buckling(column(EULER), modes=1)
    pictures = write_buckling(found, tmp_path)
    with open(tmp_path / "buckling.csv", encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["load_factor"]) for row in rows] == [mode.load_factor for mode in found.modes]
    assert [float(row["rotation"]) for row in rows] == [mode.rotation for mode in found.modes]
    assert [float(row["strain"]) for row in rows] == [mode.strain for mode in found.modes]
    assert all((tmp_path / row["mode"]).exists() for row in rows)
    assert len(pictures) == 1


def test_command(tmp_path, capsys):
    problem = tmp_path / "column.toml"
    problem.write_text(COLUMN, encoding="utf-8")
    assert main(["buckling", str(problem), "--modes", "1", "--out", str(tmp_path)]) == 0
    said = capsys.readouterr().out
    assert "mode 1: load factor 1.00" in said, said
    assert main(["buckling", str(problem), "--modes", "0", "--out", str(tmp_path)]) == 2
    assert "modes is 0" in capsys.readouterr().err
