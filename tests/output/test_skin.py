"""Bodies with their true thickness: closed where they step, with the volume that they have, and regions told apart."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

import magshell as ms
from magshell.equations.discretisation import Discretisation
from magshell.linalg import nested_dissection
from magshell.output.page.stencils import stencils
from magshell.output.setup import draw_setup, tints
from magshell.output.shape import draw_shape
from magshell.output.skin import Hull, Sheet, skin_of
from magshell.output.vtu import grid

RUBBER = ms.MicropolarNeoHookean(303e3, 7300e3, 303e3, 1e-5)
LENGTH, WIDTH = 20e-3, 5e-3


def strip(triangles=False):
    mesh = ms.mesh.rectangle(LENGTH, WIDTH, (4, 2))
    if triangles:
        from magshell.mesh import split

        mesh = split(mesh)
    return mesh.select_elements("outer", x1=(0.5 * LENGTH, LENGTH))


def path_of(mesh, **outer):
    regions = [ms.Region("outer", **outer)]
    shell = ms.Shell(mesh, 1e-3, RUBBER, ms.remanence.constant([0.1, 0, 0]), regions=regions)
    model = ms.Model(shell, [ms.Clamp("left")], ms.UniformField([0, 0, 1e-3]))
    d = Discretisation(model, nested_dissection)
    loading = model.loading(1.0)
    step = SimpleNamespace(
        number=1,
        stage=0,
        load_factor=1.0,
        state=d.undeformed(),
        flux_density=loading.flux_density,
        drives=loading.drives,
        negative_pivots=0,
    )
    return SimpleNamespace(model=model, discretisation=d, steps=[step], flux_density=lambda one: one.flux_density)


def placed(path):
    from magshell.evaluation.converged import converged

    return skin_of(path.model.shell).placed(converged(path.discretisation, path.steps[0]))


def volume(surface):
    x = surface.points[surface.triangles]
    return float(np.einsum("ni,ni->", x[:, 0], np.cross(x[:, 1], x[:, 2]))) / 6.0


TAPER = ms.thickness.profile([1, 0, 0], [0.5 * LENGTH, LENGTH], [1e-3, 0.5e-3])


@pytest.mark.parametrize("triangles", [False, True])
@pytest.mark.parametrize(
    ("outer", "mean"),
    [
        ({"thickness": 0.4e-3}, 0.4e-3),
        ({"thickness": 2e-3, "offset": "bottom"}, 2e-3),
        ({"thickness": TAPER, "offset": "top"}, 0.75e-3),
        ({"layers": [ms.Layer(0.3e-3, RUBBER), ms.Layer(0.4e-3, RUBBER)]}, 0.7e-3),
    ],
)
def test_faces_and_walls_enclose_the_volume(outer, mean, triangles):
    surface = placed(path_of(strip(triangles), **outer)).surface
    np.testing.assert_allclose(np.linalg.norm(surface.normals, axis=1), 1.0, rtol=1e-12)
    x = surface.points[surface.triangles]
    area = np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0])
    size = np.linalg.norm(area, axis=1)
    assert np.abs(area.sum(axis=0)).max() < 1e-12 * size.sum(), "it is closed"
    assert (np.einsum("ni,ni->n", area, surface.normals[surface.triangles[:, 0]]) > 0.0)[size > 0.0].all()
    assert volume(surface) == pytest.approx(0.5 * LENGTH * WIDTH * (1e-3 + mean), rel=1e-9)


def test_where_faces_meet_there_is_a_line_and_no_wall():
    path = path_of(strip(), material=RUBBER._replace(shear_modulus=1e6))
    outline = placed(path).outer
    border = (np.abs(outline[..., 0] - 0.5 * LENGTH) < 1e-12).all(axis=1)
    assert border.sum() == 2 * 2, "on both faces, once"
    surface = placed(path).surface
    centres = surface.points[surface.triangles].mean(axis=1)
    assert not (np.abs(centres[:, 0] - 0.5 * LENGTH) < 1e-9).any()


def test_a_plain_shell_is_its_mid_surface():
    shell = path_of(strip()).model.shell
    plain = ms.Shell(shell.mesh, 1e-3, RUBBER)
    assert isinstance(skin_of(plain), Sheet)
    assert isinstance(skin_of(shell), Hull)
    assert isinstance(skin_of(ms.Shell(shell.mesh, 1e-3, RUBBER, offset="top")), Hull)


def test_values_are_those_of_nodes_and_elements():
    path = path_of(strip(), thickness=0.4e-3)
    skin, mesh = skin_of(path.model.shell), path.discretisation.mesh
    surface = placed(path).surface
    np.testing.assert_allclose(skin.at_points(mesh.points)[:, :2], surface.points[:, :2], atol=1e-15)
    outer = np.isin(np.arange(len(mesh.elements)), mesh.element_groups["outer"])
    there = skin.on_elements(outer.astype(np.uint8))
    assert there.dtype == np.uint8
    assert (there[surface.points[:, 0] > 0.5 * LENGTH + 1e-9] == 1).all()
    assert (there[surface.points[:, 0] < 0.5 * LENGTH - 1e-9] == 0).all()


def test_regions_are_told_apart(can_draw, tmp_path):
    path = path_of(strip(), thickness=0.4e-3)
    shell = path.model.shell
    assert len(np.unique(tints(shell), axis=0)) == 2
    found = grid(path.discretisation, path.steps[0])
    assert found.cell_data["region"].tolist() == shell.part_of.tolist()
    assert bytes(found.field_data["region_names"]).decode().split("\n") == ["rest", "outer"]
    draw_setup(path.model, tmp_path / "show.png")
    assert draw_shape(path, None, color="u3").size == (1600, 1120)


def test_nodes_of_a_page_are_those_of_the_faces():
    """Put at their heights by the rows of the page, they are where the pictures have them."""
    path = path_of(strip(), thickness=0.4e-3, offset="bottom")
    shell = path.model.shell
    about, arrays = stencils(shell)
    assert about["thick"]
    hull = Hull(shell, shell.part_of).nodal(shell.mesh.elements)
    x = shell.mesh.points[hull.nodes] + hull.heights[:, None] * [0.0, 0.0, 1.0]
    surface = placed(path).surface
    assert len(arrays["heights"]) > 0
    for axis in range(3):
        assert x[:, axis].min() == pytest.approx(surface.points[:, axis].min(), abs=1e-15)
        assert x[:, axis].max() == pytest.approx(surface.points[:, axis].max(), abs=1e-15)
    middles = x[hull.elements[hull.tops : 2 * hull.tops]].mean(axis=1)[:, 2]
    np.testing.assert_allclose(middles, np.where(shell.part_of == 1, 0.0, -0.5e-3), atol=1e-15)
