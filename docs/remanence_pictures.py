"""Pictures of docs/remanence.md and of the flower: `python docs/make_figures.py remanence`, a minute."""

from __future__ import annotations

import pathlib
from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure

import magshell as ms
from magshell.output.bodies import Body, shifted, step_at
from magshell.output.panels import Place, colour_bar, colour_scale, draw_sequence, field_arrow, pixels, put
from magshell.output.setup import draw_setup, setup_scene
from magshell.output.style import deliver

FLOWER = pathlib.Path(__file__).parent / "gallery" / "flower" / "flower.toml"
RUBBER = ms.MicropolarNeoHookean(shear_modulus=135e3, lame_lambda=3.25e6, coupling_modulus=13.5e3, length_scale=9e-5)
X1, X3 = (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)
SHEET = (3.7e-3, 1.5e-3)
FIELDS = (1.0, 2.0, 5.0, 20.0)


def draw(images: pathlib.Path) -> None:
    """All of them."""
    draw_kinds(images / "remanence-kinds.png")
    draw_template(images / "remanence-rolled.png")
    draw_flower(images)


def bodies() -> Mapping[str, ms.Model]:
    """A part for every kind of remanence, by its name."""
    sheet = ms.mesh.rectangle(*SHEET, (16, 6))
    ring = ms.mesh.annulus(6e-3, 14e-3, (5, 40))
    tube = ms.mesh.cylinder(8e-3, 24e-3, (24, 12), angle=(0, 180), axis=X1, zero=(0, 1, 0))
    r = ms.remanence
    parts = {
        "profile": (sheet, r.profile(0.1, (0, SHEET[0]), X1, X1, np.radians((45, 405)), X3)),
        "radial": (ring, r.radial(0.1)),
        "along-curve": (wave(), r.along_curve("bottom", 0.1)),
        "tangential": (tube, r.tangential(0.1, (0, 1, 0.2))),
    }
    return {name: model(mesh, remanence) for name, (mesh, remanence) in parts.items()}


def wave() -> ms.mesh.Mesh:
    """A meandering band."""
    straight = ms.mesh.rectangle(30e-3, 6e-3, (30, 5))
    x = straight.points
    lifted = x + np.stack([0 * x[:, 0], 4e-3 * np.sin(2 * np.pi * x[:, 0] / 20e-3), 0 * x[:, 0]], axis=1)
    return ms.mesh.Mesh(lifted, straight.elements, {}, straight.edge_groups)


def model(mesh: ms.mesh.Mesh, remanence: ms.remanence.Remanence) -> ms.Model:
    """Something that can be drawn: the part in a field."""
    mesh = ms.mesh.Mesh(mesh.points, mesh.elements, {}, mesh.edge_groups, {"held": np.arange(3)})
    shell = ms.Shell(mesh, 1e-4, RUBBER, remanence)
    return ms.Model(shell, [ms.Clamp("held")], ms.UniformField((0.0, 1e-3, 1e-3)))


def draw_kinds(file: pathlib.Path) -> None:
    """One part for each kind."""
    figure = Figure(figsize=(11, 7), dpi=110, facecolor="white")
    for number, (name, one) in enumerate(bodies().items()):
        column, row = number % 2, number // 2
        place = (0.02 + 0.5 * column, 0.56 - 0.5 * row, 0.46, 0.41)
        put(figure, place, setup_scene(one, pixels(figure, place), bare=True).picture, name)
    deliver(figure, file)


def draw_template(file: pathlib.Path) -> None:
    """A sheet rolled once round in the magnetising field, and released."""
    figure = Figure(figsize=(11, 4), dpi=110, facecolor="white")
    roll = ms.remanence.rolled(SHEET[0] / (2 * np.pi), (0, 0, 0), X1, X3)
    sheet = model(ms.mesh.rectangle(*SHEET, (18, 6)), ms.remanence.template(roll, 62e-3, (1, 0, 1)))
    for column, title in enumerate(("rolled, in the magnetising field", "released")):
        place = (0.02 + 0.5 * column, 0.14, 0.46, 0.83)
        put(figure, place, setup_scene(sheet, pixels(figure, place), template=not column, bare=True).picture, title)
    deliver(figure, file)


def draw_flower(images: pathlib.Path) -> None:
    """The flower before the solve, and its petals closing."""
    problem = ms.problem.load(FLOWER)
    draw_setup(problem.model, images / "flower-show.png", "Flower of six petals")
    figure = Figure(figsize=(12, 8), dpi=110, facecolor="white")
    for column, title in enumerate(("magnetised as a bud", "released: what it remembers")):
        place = (0.05 + 0.47 * column, 0.5, 0.42, 0.48)
        put(figure, place, setup_scene(problem.model, pixels(figure, place), not column, True).picture, title)
    path = ms.solve(problem.model, problem.settings)
    shown = [Body(path, step_at(path, 1e-3 * field), shifted(), "u3") for field in FIELDS]
    width = 0.87 / len(FIELDS)
    places: list[Place] = [(0.04 + width * column, 0.08, 0.97 * width, 0.31) for column in range(len(FIELDS))]
    titles = [f"{field:g} mT" for field in FIELDS]
    scale = colour_scale(shown, component=3)
    draw_sequence(figure, [[body] for body in shown], titles, places, scale, view=(-60, 30), level=True)
    field_arrow(figure, 0.022, 0.22, np.array([0.0, 1.0]))
    colour_bar(figure, (0.925, 0.1, 0.012, 0.24), scale, "$u_3$ (mm)")
    deliver(figure, images / "flower.png")
