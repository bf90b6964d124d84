"""Whole bodies: copies, faces, outlines, cameras."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from magshell import problem
from magshell.equations.discretisation import Discretisation
from magshell.linalg import nested_dissection
from magshell.output.bodies import Body, cameras_for, faces, mirrored, render, shifted, solid, step_at, turned
from magshell.output.panels import fitted


@pytest.fixture(scope="module")
def cross():
    """A quarter of the thin cross, undeformed and lifted."""
    model = problem.load("thin-cross").model
    discretisation = Discretisation(model, nested_dissection)
    first = discretisation.undeformed()
    lifted = first._replace(u=first.u + np.array([0.0, 0.0, 5e-3]))
    steps = [
        SimpleNamespace(stage=0, load_factor=load, state=state, flux_density=load * model.field.vector)
        for load, state in ((0.0, first), (1.0, lifted))
    ]
    return SimpleNamespace(model=model, discretisation=discretisation, steps=steps)


def test_copies_are_rotations_and_reflections() -> None:
    for copies, determinants in ((mirrored(0, 1), [1, -1, -1, 1]), (turned(5), [1] * 5), (shifted(x2=1.0), [1])):
        assert [round(float(np.linalg.det(copy.matrix))) for copy in copies] == determinants
        for copy in copies:
            np.testing.assert_allclose(copy.matrix @ copy.matrix.T, np.eye(3), atol=1e-15)
    np.testing.assert_allclose(shifted(x2=1.0)[0].of(np.zeros(3)), [0, 1, 0])


def test_faces_are_a_thickness_apart(cross) -> None:
    below, above = faces(cross, cross.steps[1])
    np.testing.assert_allclose(above - below, np.tile([0, 0, 0.9e-3], (len(above), 1)), atol=1e-18)


def test_outline_has_outer_edges_and_borders_of_blocks_but_no_mirror_plane(cross) -> None:
    part = solid(Body(cross, cross.steps[0], mirrored(0, 1), "u3"))
    middles = part.outline.mean(axis=1)
    flat = np.abs(part.outline[..., :2])
    inside = (flat < 1e-9).all(axis=1).any(axis=1)
    assert not inside.any(), middles[inside]
    border = (np.abs(middles[:, 0] - 3e-3) < 1e-9) & (middles[:, 1] < 3e-3)
    assert border.sum() == 2 * 3, "three elements of the border of the centre block, on both faces"


def test_walls_are_made_of_both_faces(cross) -> None:
    part = solid(Body(cross, cross.steps[0], mirrored(0, 1), "u3"))
    assert part.triangles.max() == len(part.points) - 1 == len(part.normals) - 1 == len(part.values) - 1
    np.testing.assert_allclose(np.linalg.norm(part.normals, axis=1), 1.0, rtol=1e-12)
    corners = part.points[part.triangles]
    areas = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    face, outer, thickness = 81e-6, 3e-3 * 2 + 12e-3 * 2, 0.9e-3
    assert areas.sum() == pytest.approx(2 * face + outer * thickness, rel=1e-9)


@pytest.mark.parametrize("level", [False, True])
def test_cameras_see_everything_in_one_scale(cross, level: bool) -> None:
    groups = [[Body(cross, step, mirrored(0, 1), "u3")] for step in cross.steps]
    cameras = cameras_for(groups, -60.0, 24.0, level=level)
    assert cameras[0].half_height == cameras[1].half_height
    for group, camera in zip(groups, cameras, strict=True):
        for body in group:
            points = np.concatenate([copy.of(face) for face in faces(body.path, body.step) for copy in body.copies])
            seen = camera.on_picture(points)
            assert seen.min() >= 0.0, f"{seen.min()}"
            assert seen.max() <= 1.0, f"{seen.max()}"
    lift = (cameras[1].centre - cameras[0].centre) @ cameras[0].axes[1]
    assert lift == pytest.approx(0.0 if level else 5e-3 * np.cos(np.radians(24.0)), abs=1e-12)


def test_step_must_be_a_stop(cross) -> None:
    assert step_at(cross, 40e-3) is cross.steps[1]
    with pytest.raises(ValueError, match="not a stop"):
        step_at(cross, 20e-3)


def test_body_arrow_and_nothing_else_are_drawn(cross, can_draw) -> None:
    body = Body(cross, cross.steps[1], mirrored(0, 1), "u3")
    (camera,) = fitted(cameras_for([[body]], -60.0, 24.0), [160 / 120])
    arrow = np.array([[0.0, 0.0, 6e-3], [0.0, 0.0, 11e-3]])

    def green(values: np.ndarray) -> np.ndarray:
        return np.tile(np.array([0, 200, 0], dtype=np.uint8), (len(values), 1))

    picture = render([body], camera, green, (160, 120), [arrow], "red").astype(int)
    shown = picture[..., 3] > 200
    reddish = shown & (picture[..., 0] > picture[..., 1] + 60)
    greenish = shown & (picture[..., 1] > picture[..., 0] + 60)
    assert picture.shape == (120, 160, 4)
    assert reddish.sum() > 20
    assert greenish.sum() > 2000
    assert not shown[:2].any()
    assert not shown[:, :2].any()
