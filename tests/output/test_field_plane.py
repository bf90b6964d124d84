"""The field on a plane in pictures of steps."""

from __future__ import annotations

import numpy as np
import pytest
from magnetics.fields.cases import SHAPES

import magshell as ms
from magshell import cli
from magshell import mesh as meshes
from magshell.errors import InputError
from magshell.magnetics.fields import MagnetField, Motion, Source
from magshell.output import rendering
from magshell.output.animation import Frame, film
from magshell.output.field_plane import FieldArrows, FieldPlane, field_plane
from magshell.output.sources import Plane, arrows

LOW, RISE = -40e-3, 15e-3


@pytest.fixture(scope="module")
def path() -> ms.Path:
    """A soft strip over a magnet that comes nearer."""
    material = ms.MicropolarStVenantKirchhoff(1e6, 0.0, 1e6, 5e-6)
    shell = ms.Shell(meshes.rectangle(20e-3, 4e-3, (4, 1)), 0.5e-3, material, ms.remanence.constant((0.1, 0.0, 0.0)))
    motion = Motion(history=(1.0, 1.0), displacement=((0, 0, 0), (0, 0, RISE)))
    field = MagnetField([Source(SHAPES["cylinder"], (0.0, 0.0, LOW))], motion)
    return ms.solve(ms.Model(shell, [ms.Clamp("left")], field))


@pytest.mark.parametrize(
    ("text", "axis", "coordinate"),
    [("x2=0", 1, 0.0), ("x3=5 mm", 2, 5e-3), (" X1 = -1.5 cm ", 0, -15e-3)],
)
def test_planes_as_written(text: str, axis: int, coordinate: float) -> None:
    assert field_plane(text) == FieldPlane(axis, coordinate)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("y=0", "'y=0' is not a plane; write an axis and a coordinate"),
        ("x4=0", "is not a plane"),
        ("x2", "is not a plane"),
        ("x2=", "is not a plane"),
        ("x2=5", "no unit where a length"),
        ("x2=5 mT", "is a magnetic flux density where a length"),
        ("x2=nan mm", "not a finite number"),
    ],
)
def test_what_is_no_plane(text: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        field_plane(text)


def test_the_command_names_its_option(tmp_path, capsys) -> None:
    assert cli.main(["plot", str(tmp_path), "--field-plane", "y=0"]) != 0
    assert "--field-plane: 'y=0' is not a plane" in " ".join(capsys.readouterr().err.split())


def test_the_plane_holds_what_is_drawn() -> None:
    points = np.array([[0.0, 0.0, 0.0], [0.02, 0.0, 0.01]])
    grid = field_plane("x2=3 mm").over(points).grid()
    assert np.all(grid[:, 1] == 3e-3)
    assert np.all(grid.min(axis=0)[[0, 2]] < points.min(axis=0)[[0, 2]])
    assert np.all(grid.max(axis=0)[[0, 2]] > points.max(axis=0)[[0, 2]])


def test_no_arrows_inside_a_magnet() -> None:
    shape, amounts = SHAPES["cylinder"], np.array([1.0, 0, 0, 0, 0])
    field = MagnetField([Source(shape, (0.0, 0.0, LOW))])
    size = 0.2 * shape.size
    within = Plane((-size, 0.0, LOW - size), (2 * size, 0.0, 0.0), (0.0, 0.0, 2 * size), 3)
    assert shape.inside(within.grid() - [0.0, 0.0, LOW]).all()
    assert arrows(field, amounts, within).n_points == 0
    assert arrows(field, amounts, Plane((-0.05, 0.0, 0.0), (0.1, 0.0, 0.0), (0.0, 0.0, 0.05), 3)).n_points > 0


def test_a_plane_without_field(path: ms.Path) -> None:
    within = Plane((-1e-3, 0.0, LOW - 1e-3), (2e-3, 0.0, 0.0), (0.0, 0.0, 2e-3), 3)
    assert SHAPES["cylinder"].inside(within.grid() - [0.0, 0.0, LOW]).all()
    with pytest.raises(InputError, match="zero or not known on the whole plane"):
        FieldArrows(path, path.steps[:1], within)


def test_pictures_show_the_field(path: ms.Path) -> None:
    try:
        rendering.require_rendering()
    except rendering.RenderingUnavailable as unavailable:
        pytest.skip(str(unavailable))
    steps = [path.steps[0], path.steps[-1]]
    seen = {}
    for plane in (None, field_plane("x2=2 mm")):
        with film(path, steps, "u3", 24, (0, -1, 0), plane) as picture:
            seen[plane] = [np.asarray(picture(Frame(step, 0.0))) for step in steps]
    coloured = {plane: [_share(one) for one in pictures] for plane, pictures in seen.items()}
    first, last = (many - few for many, few in zip(*reversed(coloured.values()), strict=True))
    assert min(first, last) > 0.0


def _share(picture) -> float:
    """Of the pixels that are violet, as weak fields are."""
    red, green, blue = (picture[..., k].astype(int) for k in range(3))
    return float(np.mean((red > green + 30) & (blue > green + 30)))
