"""Files and pictures of a shell in a field that varies."""

from __future__ import annotations

import numpy as np
import pytest
from magnetics.fields.cases import SHAPES

import magshell as ms
from magshell import mesh as meshes
from magshell.evaluation.balance import magnetic
from magshell.magnetics.fields import MagnetField, Motion, Source
from magshell.output.page.sources import reached, sources
from magshell.output.setup import setup_scene
from magshell.output.sources import NORTH, REACH, SOUTH, extent, pieces
from magshell.output.vtu import grid

LENGTH, LOW, RISE = 20e-3, -40e-3, 15e-3


@pytest.fixture(scope="module")
def path() -> ms.Path:
    """A soft strip over a magnet that comes nearer in the second stage."""
    material = ms.MicropolarStVenantKirchhoff(1e6, 0.0, 1e6, 5e-6)
    shell = ms.Shell(meshes.rectangle(LENGTH, 4e-3, (4, 1)), 0.5e-3, material, ms.remanence.constant((0.1, 0.0, 0.0)))
    motion = Motion(history=(1.0, 1.0), displacement=((0, 0, 0), (0, 0, RISE)))
    field = MagnetField([Source(SHAPES["cylinder"], (0.0, 0.0, LOW))], motion)
    return ms.solve(ms.Model(shell, [ms.Clamp("left")], field))


def test_files_hold_field_and_force(path: ms.Path) -> None:
    step, discretisation = path.steps[-1], path.discretisation
    written = grid(discretisation, step)
    x = np.asarray(written.points) + written.point_data["displacement"]
    B = path.model.field.at(step.drives, x, second=False).flux_density
    assert np.allclose(written.point_data["flux_density"], B, rtol=1e-12, atol=0.0)
    volumes = discretisation.reference.geometry.volume.sum(axis=(1, 2))
    total = volumes @ written.cell_data["magnetic_force_density"]
    exerted = magnetic(discretisation, step.state, discretisation.model.course(1).at(1.0)).force
    assert np.linalg.norm(exerted) > 1e-6
    assert np.abs(total - exerted).max() < 1e-10 * np.linalg.norm(exerted)


def test_pages_have_the_magnet_where_it_is(path: ms.Path) -> None:
    told, arrays = sources(path, path.steps)
    assert [one["colour"] for one in told] == [NORTH, SOUTH]
    assert {one["array"] for one in told} == set(arrays)
    for one in told:
        assert len(one["turns"]) == len(one["shifts"]) == len(path.steps)
        assert np.array(one["shifts"][-1]) - one["shifts"][0] == pytest.approx([0.0, 0.0, RISE], abs=1e-12)
    part = path.model.shell.mesh.points
    everywhere = reached(path, path.steps, part)
    assert everywhere[:, 2].max() > LOW + RISE > LOW > everywhere[:, 2].min()


def test_pictures_reach_for_what_is_near() -> None:
    part = np.array([[0.0, 0.0, 0.0], [LENGTH, 0.0, 0.0]])
    amounts = np.array([1.0, 0, 0, 0, 0])
    near, far = (
        pieces(MagnetField([Source(SHAPES["cylinder"], (0.0, 0.0, z))]), amounts) for z in (LOW, -1.5 * REACH * LENGTH)
    )
    assert len(extent(near, part)) == sum(piece.surface.n_points for piece in near)
    assert len(extent(far, part)) == 0


def test_a_problem_is_drawn_with_its_magnet(path: ms.Path) -> None:
    scene = setup_scene(path.model, (160, 120))
    assert scene.sources == {NORTH, SOUTH}
    seen = scene.camera.on_picture(extent(pieces(path.model.field, path.steps[0].drives), path.model.shell.mesh.points))
    assert seen.min() >= 0.0
    assert seen.max() <= 1.0
