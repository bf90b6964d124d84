"""From regions and layers to parts: who has which elements, and what the arrays hold."""

from __future__ import annotations

import dataclasses
import pickle

import numpy as np
import pytest

import magshell as ms
from regions.models import ALONG, LENGTH, SOFT, STIFF, THICKNESS, of_regions, solved, strip

UP = ms.remanence.constant([0.0, 0.0, 0.2])


def test_a_shell_without_regions_is_one_part():
    shell = of_regions()
    (part,) = shell.parts
    assert shell.plain
    assert part.elements.tolist() == [0, 1, 2, 3]
    assert (part.name, part.layered, part.levels, len(part.layers)) == ("shell", False, 2, 1)
    assert part.at_points.shape == (4, 4, 1)
    assert part.at_nodes.shape == (4, 8, 1)
    assert (part.at_points == THICKNESS).all()
    assert not part.offset_at_nodes.any()
    np.testing.assert_array_equal(shell.remanence_at_points, part.remanence[:, :, 0])


def test_what_a_region_leaves_out_is_that_of_the_shell():
    outer = ms.Region("outer", thickness=0.4e-3, density=900.0)
    shell = of_regions(outer, density=1100.0, offset="bottom", levels=3)
    rest, part = shell.parts
    assert (rest.elements.tolist(), part.elements.tolist()) == ([0, 1], [2, 3])
    assert (part.name, part.levels, part.layers[0].material) == ("outer", 3, SOFT)
    assert (rest.layers[0].density, part.layers[0].density) == (1100.0, 900.0)
    assert (part.at_nodes == 0.4e-3).all()
    assert (part.offset_at_nodes == -0.2e-3).all()
    assert (part.remanence == [0.1, 0.0, 0.0]).all()
    np.testing.assert_array_equal(shell.part_of, [0, 0, 1, 1])
    np.testing.assert_allclose(shell.faces_at_nodes[2, 0], [0.0, 0.4e-3], atol=1e-18)


def test_regions_are_of_several_groups_or_of_numbers():
    shell = of_regions(ms.Region(["inner"], thickness=0.5e-3), ms.Region([3], thickness=0.7e-3))
    assert [(part.name, part.elements.tolist()) for part in shell.parts] == [
        ("shell", [2]),
        ("inner", [0, 1]),
        ("regions[1]", [3]),
    ]
    whole = of_regions(ms.Region(("inner", "outer"), thickness=0.5e-3))
    assert [part.name for part in whole.parts] == ["inner, outer"]


def test_without_a_default_all_elements_are_in_regions():
    regions = [ms.Region("inner", 1e-3, SOFT), ms.Region("outer", layers=[ms.Layer(1e-3, STIFF), ms.Layer(2e-3, SOFT)])]
    parts = ms.Shell(strip(), regions=regions).parts
    assert [part.name for part in parts] == ["inner", "outer"]
    assert parts[1].layered
    assert not parts[0].remanence.any()


def test_layers_from_the_bottom_to_the_top():
    layers = [ms.Layer(0.6e-3, SOFT, density=1000.0), ms.Layer(0.2e-3, STIFF, UP)]
    (part,) = ms.Shell(strip(), layers=layers, density=2000.0, offset="top", levels=1).parts
    assert (part.levels, part.layered) == (1, True)
    assert [layer.density for layer in part.layers] == [1000.0, 2000.0]
    np.testing.assert_array_equal(part.at_points[0, 0], [0.6e-3, 0.2e-3])
    np.testing.assert_allclose(part.offset_at_points, 0.4e-3, rtol=1e-15)
    np.testing.assert_array_equal(part.remanence[0, 0], [[0, 0, 0], [0, 0, 0.2]])


def test_means_over_the_layers():
    layers = [ms.Layer(0.6e-3, SOFT, ALONG), ms.Layer(0.2e-3, STIFF, UP)]
    shell = ms.Shell(strip(), THICKNESS, SOFT, ALONG, regions=[ms.Region("outer", layers=layers)])
    np.testing.assert_allclose(shell.mean_of("shear_modulus"), [100e3, 100e3, 150e3, 150e3], rtol=1e-14)
    np.testing.assert_allclose(shell.remanence_at_points[2:], np.tile([0.075, 0, 0.05], (2, 4, 1)), rtol=1e-14)
    middle = shell.mesh.points[shell.mesh.elements].mean(axis=1, keepdims=True)
    everywhere = shell.overall_remanence(shell.mesh, middle)[:, 0]
    np.testing.assert_allclose(everywhere, shell.remanence_at_points[:, 0], atol=1e-16)


def opposed(mesh, material=SOFT):
    """Two layers whose remanence has no mean."""
    layers = [ms.Layer(0.5e-3, material, ms.remanence.constant([sign * 0.1, 0, 0])) for sign in (-1, 1)]
    return ms.Shell(mesh, layers=layers)


def test_layers_magnetised_against_each_other_bend_in_a_field_along_them():
    """With the energy of m = F B̃ the stresses f ⊗ B̃ of the two have the moment h²/4 B B_rem / mu0 about the middle."""
    field, rubber = 1e-3, SOFT._replace(lame_lambda=0.0)
    shell = opposed(strip(), rubber)
    assert shell.magnetised
    coupling = ms.DeformationGradientEnergy()
    model = ms.Model(shell, [ms.Clamp("left")], ms.UniformField([field, 0, 0]), coupling)
    u = ms.solve(model).steps[-1].state.displacement(len(shell.mesh.points))
    moment = THICKNESS**2 / 4 * 0.1 * field / coupling.vacuum_permeability
    stiffness = 2 * rubber.shear_modulus * THICKNESS**3 / 12 + rubber.shear_modulus * rubber.length_scale**2 * THICKNESS
    np.testing.assert_allclose(u[:, 2].min(), -0.5 * moment * LENGTH**2 / stiffness, rtol=1e-3)


def test_a_field_off_a_mirror_plane_is_told_also_where_the_remanence_has_no_mean(caplog):
    ms.Model(
        opposed(strip()), [ms.Clamp("left"), ms.SymmetryPlane("top", [0, 1, 0])], ms.UniformField([0.0, 1e-3, 1e-3])
    )
    assert "the field (0, 1 mT, 1 mT) is 45° off the plane" in caplog.text


def test_a_remanence_is_asked_only_where_it_holds():
    asked = {}

    def noted(name):
        def sample(mesh, points):
            asked[name] = np.isfinite(points).all(axis=(1, 2))
            return np.where(np.isfinite(points), 0.1, np.nan)

        return sample

    shell = of_regions(ms.Region("outer", remanence=noted("region")), remanence=noted("shell"))
    assert (shell.remanence_at_points == 0.1).all()
    assert (asked["shell"].tolist(), asked["region"].tolist()) == (
        [True, True, False, False],
        [False, False, True, True],
    )


def test_templates_of_regions_move_only_their_elements():
    rolled = ms.remanence.template(ms.remanence.deformed(lambda x: x + np.array([0.0, 0.0, 1e-3])), 0.1, [1, 0, 0])
    shell = of_regions(ms.Region("outer", remanence=rolled))
    points = shell.mesh.points[shell.mesh.elements]
    moved = ms.remanence.placed(shell.overall_remanence, shell.mesh, points) - points
    np.testing.assert_allclose(moved[:2], 0.0, atol=1e-18)
    np.testing.assert_allclose(moved[2:, :, 2], 1e-3, rtol=1e-12)


def test_shells_are_replaced_shown_and_pickled():
    shell = of_regions(ms.Region("outer", thickness=0.4e-3))
    thinner = dataclasses.replace(shell, thickness=0.5e-3)
    assert [part.at_nodes.max() for part in thinner.parts] == [0.5e-3, 0.4e-3]
    assert "1 regions" in repr(shell)
    plain = dataclasses.replace(shell, remanence=ms.Shell(strip(), THICKNESS, SOFT).remanence)
    assert "outer" in repr(plain.parts[1].name)
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(shell.mesh)).points, shell.mesh.points)


def test_a_region_for_each_element_with_equal_data_is_one_region():
    whole = solved(of_regions())
    apart = solved(of_regions(*(ms.Region([number], THICKNESS, SOFT, ALONG) for number in range(4))))
    assert np.abs(whole).max() > 0.05 * LENGTH
    assert np.abs(apart - whole).max() <= 1e-12 * np.abs(whole).max()


def test_no_micro_rotation_reaches_a_region_without_coupling():
    loose = SOFT._replace(coupling_modulus=0.0)
    magnetic, passive = (ms.Region("outer", material=loose, remanence=of) for of in (ALONG, ms.Region("x").remanence))
    still = dataclasses.replace(passive, remanence=ms.remanence.constant([0, 0, 0]))
    ms.Model(of_regions(still), [ms.Clamp("left")], ms.UniformField([0, 0, 1e-3]))
    with pytest.raises(ms.InputError, match=r"^region 'outer': material: coupling_modulus is 0, so the micro-rotation"):
        ms.Model(of_regions(magnetic), [ms.Clamp("left")], ms.UniformField([0, 0, 1e-3]))
    moment = [ms.Moment("right", (0.0, 1e-6, 0.0))]
    with pytest.raises(ms.InputError, match=r"^region 'outer': material: .* that a moment works on"):
        ms.Model(of_regions(still), [ms.Clamp("left")], loads=moment)
