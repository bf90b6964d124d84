"""The built-in problems: each is what its source describes."""

# ruff: noqa: E501 (a table reads best with one entry a line)

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest

from magshell import problem
from magshell.arrays import FloatArray
from magshell.problem import examples
from magshell.problem.building import Problem
from magshell.problem.report import describe
from magshell.shell.shape_functions import gauss_legendre, serendipity

STRIP_STOPS = (1, 2, 3, 5, 10, 15, 20, 50)


class Example(NamedTuple):
    """Figures of the source: mm, kPa, mT."""

    name: str
    elements: int
    area: float
    thickness: float
    shear_modulus: float
    lame_lambda: float
    remanence: float
    field: float
    stops: tuple[float, ...]
    probes: str


class Published(NamedTuple):
    """Figures of a problem of Sze, Liu and Lo: m, Pa, and N or N m on the part that is modelled."""

    name: str
    area: float
    thickness: float
    youngs_modulus: float
    poissons_ratio: float
    loads: list[tuple[float, float, float]]
    probes: str


R = 24 * 6 / (2 * np.pi)
EXAMPLES = [
    Example("strip-10", 20, 11 * 5, 1.1, 303, 7300, 143, 50, STRIP_STOPS, "tip"),
    Example("strip-17", 30, 19.2 * 5, 1.1, 303, 7300, 143, 50, STRIP_STOPS, "tip"),
    Example("strip-20", 60, 17.2 * 5, 0.84, 303, 7300, 143, 50, STRIP_STOPS, "tip"),
    Example("strip-41", 80, 17.2 * 5, 0.42, 303, 7300, 143, 50, STRIP_STOPS, "tip"),
    Example("thin-cross", 3 * 3 + 2 * 12 * 3, 9 * 36 / 4, 0.9, 135, 3250, 94, 40, (2, 5, 10, 40), "A A' C D"),
    Example("h-shape", 15 * 16 // 4, 15 * 36 / 4, 0.9, 135, 3250, 94, -50, (2, 5, 15, 50), "A A' C D"),
    Example("hollow-cross", 6 * 36, 6 * 48, 0.41, 303, 7300, 102, -200, (10, 50, 100, 200), "A C E G"),
    Example("pump", 24 * 20, np.pi * R * 60, 0.9, 135, 3250, 94, 150, (20, 50, 100, 150), "A B C"),
    Example("magnetic-arch", 12 * 2, 4 * 45 * np.radians(25), 0.8, 303, 7300, 143, -6, (1, 2, 3, 4, 5), "crown"),
    Example("gripper", 30 * 6, np.pi / 3 * R**2 * np.cos(np.pi / 12), 0.9, 135, 3250, 94, 10, (1, 2, 4, 6.8), "A B C D E"),
]  # fmt: skip
PUBLISHED = [
    Published("cantilever-shear", 10.0, 0.1, 1.2e6, 0.0, [(0, 0, 4)], "tip"),
    Published("cantilever-moment", 12.0, 0.1, 1.2e6, 0.0, [(0, -50 * np.pi / 3, 0)], "tip"),
    Published("slit-annulus", np.pi * (100 - 36), 0.03, 21e6, 0.0, [(0, 0, 0.8 * 4)], "A B"),
    Published("hemisphere", np.pi / 2 * 100 * np.cos(np.pi / 10), 0.04, 6.825e7, 0.3, [(200, 0, 0), (0, -200, 0)], "smaller_radial larger_radial"),
    Published("semi-cylinder", np.pi / 2 * 0.1016 * 0.3048, 3e-3, 2068.5e6, 0.3, [(0, 0, -1000)], "A"),
    Published("hinged-roof", 0.1 * 2.54 * 0.254, 12.7e-3, 3102.75e6, 0.3, [(0, 0, -750)], "C"),
]  # fmt: skip


# Of several regions or layers, or with magnets: elements, area (mm²), thickness (mm) and E (kPa) of the layers of each part, probes.
MADE_OF = {
    "bilayer-strip": (32, 200.0, {"shell": [(0.6, 100.0), (0.4, 300.0)]}, "tip"),
    "stepped-strip": (32, 200.0, {"shell": [(1.0, 300.0)], "outer": [(0.5, 300.0)]}, "step tip"),
    "starfish": (132, 1.5 * 3**0.5 * 6**2 + 6 * 16 * 4.5, {"shell": [(0.8, 296.0)], "centre": [(1.6, 2960.0)]}, "tip-1 tip-4"),
    "plate-over-magnet": (100, 100.0, {"shell": [(0.5, 1e6)]}, "corner"),
    "strip-over-magnet": (20, 40.0, {"shell": [(0.5, 300.0)]}, "tip"),
    "magnet-approaches": (52, 25.0 + 4 * 13.5 * 4.0, {"shell": [(0.6, 300.0)]}, "tip"),
    "tip-magnet": (11, 110.0, {"shell": [(0.5, 300.0)]}, "magnet-end"),
    "rolled-strip": (48, 1200.0, {"shell": [(0.5, 300.0)]}, "middle handle"),
    "origami": (36, 4 * 100 * np.sin(np.pi / 3), {"shell": [(0.5, 50e3)]}, "base"),
    "rosette": (66, 3**0.5 / 4 * (7**2 - 3**2) + 0.5 * (16.3 * 12.3 - 11.3 * (9.7 - 3.5 * 3**0.5)), {"shell": [(0.5, 300.0)]}, "tip"),
    "wavy-sheet": (20, 80.0, {"shell": [(0.5, 300.0)]}, "crest"),
    "compass-needle": (16, 80.0, {"shell": [(1.0, 900.0)]}, "tip tail"),
    "ribbed-plate": (144, (40 + 2 * 6) * 120.0, {"shell": [(1.0, 1000.0)]}, "end rib"),
}  # fmt: skip


@pytest.fixture(scope="module")
def loaded() -> dict[str, Problem]:
    return {name: problem.load(name) for name in examples.names()}


def test_every_built_in_problem_is_described_here() -> None:
    assert examples.names() == sorted([*(example.name for example in [*EXAMPLES, *PUBLISHED]), *MADE_OF])


@pytest.mark.parametrize("example", EXAMPLES, ids=[example.name for example in EXAMPLES])
def test_is_what_the_source_describes(example: Example, loaded: dict[str, Problem]) -> None:
    this = loaded[example.name]
    shell, mesh = this.model.shell, this.model.shell.mesh
    material = shell.material
    assert len(mesh.elements) == example.elements
    assert _area(mesh.points[mesh.elements]) * 1e6 == pytest.approx(example.area, rel=1e-4)
    assert shell.thickness == pytest.approx(example.thickness * 1e-3, rel=1e-15)
    assert material.shear_modulus == example.shear_modulus * 1e3
    assert material.lame_lambda == example.lame_lambda * 1e3
    assert material.coupling_modulus == pytest.approx(material.shear_modulus / 10, rel=1e-15)
    assert material.length_scale == pytest.approx(shell.thickness / 10, rel=1e-15)
    assert this.file.field.flux_density == (0.0, 0.0, pytest.approx(example.field * 1e-3))
    reached = np.array(this.file.field.stops) * 1e3
    missed = [stop for stop in example.stops if not np.isclose(reached, stop, rtol=1e-12).any()]
    assert not missed, f"stops {reached} miss {missed}"
    assert list(this.model.probe_nodes) == example.probes.split()
    centres = mesh.points[mesh.elements].mean(axis=1)[:, None]
    magnitudes = np.linalg.norm(shell.remanence(mesh, centres), axis=2)
    assert set(np.round(magnitudes.ravel() * 1e3, 9)) <= {0.0, example.remanence}
    assert describe(this).warnings == []


@pytest.mark.parametrize("example", PUBLISHED, ids=[example.name for example in PUBLISHED])
def test_is_the_published_problem(example: Published, loaded: dict[str, Problem]) -> None:
    this = loaded[example.name]
    shell, mesh = this.model.shell, this.model.shell.mesh
    mu, lam = shell.material.shear_modulus, shell.material.lame_lambda
    assert _area(mesh.points[mesh.elements]) == pytest.approx(example.area, rel=1e-4)
    assert shell.thickness == pytest.approx(example.thickness, rel=1e-15)
    assert this.file.material.law == "micropolar-st-venant-kirchhoff"
    assert not shell.micro_rotation
    assert mu * (3 * lam + 2 * mu) / (lam + mu) == pytest.approx(example.youngs_modulus, rel=1e-12)
    assert lam / (2 * (lam + mu)) == pytest.approx(example.poissons_ratio, rel=1e-12)
    assert [load.total for load in this.file.loads] == [pytest.approx(load, rel=1e-15) for load in example.loads]
    assert list(this.model.probe_nodes) == example.probes.split()
    assert "Sze, Liu and Lo" in examples.text(example.name)
    assert describe(this).warnings == []


@pytest.mark.parametrize("name", MADE_OF)
def test_is_made_of_what_the_file_says(name: str, loaded: dict[str, Problem]) -> None:
    this, (elements, area, parts, probes) = loaded[name], MADE_OF[name]
    shell = this.model.shell
    assert len(shell.mesh.elements) == elements
    assert _area(shell.mesh.points[shell.mesh.elements]) * 1e6 == pytest.approx(area, rel=1e-4)
    assert [part.name for part in shell.parts] == list(parts)
    for part, layers in zip(shell.parts, parts.values(), strict=True):
        for layer, (thickness, modulus) in zip(part.layers, layers, strict=True):
            mu, lam = layer.material.shear_modulus, layer.material.lame_lambda
            assert layer.thickness == pytest.approx(thickness * 1e-3, rel=1e-15)
            assert mu * (3 * lam + 2 * mu) / (lam + mu) == pytest.approx(modulus * 1e3, rel=1e-12)
    assert list(this.model.probe_nodes) == probes.split()
    assert describe(this).warnings == []


@pytest.mark.parametrize(
    ("name", "directions"),
    [
        ("thin-cross", {(10, 1): (1, 0), (1, 10): (0, -1), (1, 1): (0, 0)}),
        ("h-shape", {(10, 1): (1, 0), (18, 8): (0, 1), (18, 1): (0, 0), (1, 1): (0, 0)}),
        (
            "hollow-cross",
            {
                (24, 4): (0, -1),
                (20, 8): (-1, 0),
                (10, 8): (1, 0),
                (8, 10): (0, 1),
                (8, 20): (0, -1),
                (4, 24): (-1, 0),
            },
        ),
    ],
)
def test_remanence_points_where_the_layout_says(
    name: str, directions: dict[tuple[float, float], tuple[float, float]], loaded: dict[str, Problem]
) -> None:
    shell = loaded[name].model.shell
    centres = shell.mesh.points[shell.mesh.elements].mean(axis=1)
    vectors = shell.remanence(shell.mesh, centres[:, None])[:, 0]
    for place, expected in directions.items():
        nearest = np.argmin(np.linalg.norm(centres[:, :2] * 1e3 - place, axis=1))
        unit = vectors[nearest, :2] / max(np.linalg.norm(vectors[nearest]), 1e-30)
        assert unit == pytest.approx(expected, abs=1e-12), f"at {place} mm"


def test_curved_remanence(loaded: dict[str, Problem]) -> None:
    for name in ("pump", "gripper"):
        shell = loaded[name].model.shell
        points = shell.mesh.points
        vectors = shell.remanence(shell.mesh, points[shell.mesh.elements])
        x = points[shell.mesh.elements]
        radial = x * [1, 0, 1] if name == "pump" else x
        off = np.abs(np.einsum("epi,epi->ep", radial, vectors)).max()
        assert off < 1e-12, f"{name}: component out of the surface {off}"
    pump = loaded["pump"].model.shell
    centres = pump.mesh.points[pump.mesh.elements].mean(axis=1)[:, None]
    assert (pump.remanence(pump.mesh, centres)[..., 2] > 0).all()
    gripper = loaded["gripper"].model.shell
    centres = gripper.mesh.points[gripper.mesh.elements].mean(axis=1)[:, None]
    assert (gripper.remanence(gripper.mesh, centres)[..., 2] * centres[..., 2] < 0).all()


def _area(x: FloatArray) -> float:
    """Area of 8-node quadrilaterals (elements, 8, 3), by 3×3 Gauss points."""
    points, weights = gauss_legendre(3)
    base = np.einsum("gan,eni->egai", serendipity(points)[1], x)
    return float((np.linalg.norm(np.cross(base[:, :, 0], base[:, :, 1]), axis=2) @ weights).sum())
