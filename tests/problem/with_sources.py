"""Problem files with every magnet, coil and other field."""

from __future__ import annotations

import pathlib

import numpy as np
from problem_files import STRIP

EVERY = {
    "cuboid": 'sides = ["20 mm", "10 mm", "5 mm"]\npolarisation = [0, 0, "1.3 T"]',
    "cylinder": 'diameter = "20 mm"\nheight = "10 mm"\npolarisation = ["100 kA/m", 0, 0]',
    "ring": 'inner_diameter = "8 mm"\nouter_diameter = "20 mm"\nheight = "10 mm"\npolarisation = [0, 0, "1 T"]',
    "cylinder-segment": 'inner_diameter = 0\nouter_diameter = "20 mm"\nheight = "10 mm"\n'
    'angles = ["-45 deg", "90 deg"]\npolarisation = [0, 0, "1 T"]',
    "sphere": 'diameter = "20 mm"\npolarisation = [0, 0, "1 T"]',
    "dipole": 'moment = [0, 0, "1.2 A m^2"]',
    "halbach": 'radius = "50 mm"\ncount = 16\nsides = ["10 mm", "10 mm", "20 mm"]\nremanence = "1.3 T"\norder = 2',
    "loop": 'diameter = "80 mm"\ncurrent = "2 A"\nturns = 10',
    "polygon": 'corners = [[0, 0, 0], ["10 mm", 0, 0], [0, "10 mm", 0]]\ncurrent = "2 A"',
    "solenoid": 'diameter = "20 mm"\nheight = "40 mm"\ncurrent = "2 A"\nturns = 100\nlayers = 2\nspacing = "1 mm"',
    "rectangular": 'sides = ["20 mm", "30 mm"]\nheight = "5 mm"\ncurrent = "2 A"\nturns = 100',
    "helmholtz": 'radius = "100 mm"\ncurrent = "2 A"\nturns = 100',
    "maxwell": 'radius = "100 mm"\ncurrent = "2 A"',
}
GRADIENT = (
    '\n[field.gradient]\ntensor = [["1 T/m", 0, 0], [0, "100 G/cm", 0], [0, 0, "-2 T/m"]]\ncentre = ["5 mm", 0, 0]\n'
)
MOVING = """position = ["300 mm", 0, "-1 cm"]
orientation_axis = [0, 1, 0]
orientation = "30 deg"
history = [1, 0.5]
displacement = [[0, 0, 0], [0, 0, "20 mm"]]
rotation_axis = [0, 0, 1]
rotation = [0, "90 deg"]
rotation_centre = [0, 0, "1 mm"]
"""


def entry(shape: str, more: str = "") -> str:
    """A magnet or coil, with more keys."""
    key = "coils" if "current" in EVERY[shape] else "magnets"
    return f'\n[[{key}]]\nshape = "{shape}"\n{EVERY[shape]}\n{more}\n'


EVERY_SOURCE = (
    STRIP + GRADIENT + "".join(entry(shape, MOVING if number % 2 else "") for number, shape in enumerate(EVERY))
)

EVERY_FIELD = (
    STRIP.replace("stops = [", 'spline_spacing = "1 mm"\nself_field = true\nstops = [')
    + """
[field.sampled]
file = "grid.csv"
flux_density_unit = "mT"
length_unit = "mm"
history = [1, 0.5]
displacement = [[0, 0, 0], [0, 0, "1 mm"]]

[field.coils]
calibration = "coils.csv"
currents = [["2 A", "-1000 mA"], ["1 A", 0]]
centre = ["10 mm", 0, 0]

[[stages]]
name = "on"

[[stages]]
name = "moved"
"""
    + entry("loop", MOVING)
    + entry("cylinder", MOVING.replace('rotation_centre = [0, 0, "1 mm"]\n', ""))
)
"""With the files `grid.csv` and `coils.csv`."""


def write_field_files(folder: pathlib.Path) -> None:
    """A grid of 4 × 4 × 4 positions about the strip, and the calibration of two coils."""
    axes = [np.linspace(low, high, 4) for low, high in ((-50, 60), (-50, 60), (-50, 50))]
    places = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    rows = np.column_stack([places, np.tile([0.0, 0.1, 3.0], (len(places), 1))])
    np.savetxt(folder / "grid.csv", rows, delimiter=",", header="x1,x2,x3,b1,b2,b3", comments="")
    np.savetxt(folder / "coils.csv", np.eye(8)[:, :2], delimiter=",")
