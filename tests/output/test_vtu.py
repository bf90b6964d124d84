"""VTU and PVD files, read back, against the registry and the states."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista

from magshell.errors import InputError
from magshell.evaluation.converged import converged
from magshell.evaluation.outputs import OUTPUTS, chosen, find
from magshell.output.vtu import VtuWriter, save_series

QUADRATIC_QUAD = int(pyvista.CellType.QUADRATIC_QUAD)


def texts(grid, name):
    return grid.field_data[name].tobytes().decode().split("\n")


@pytest.fixture
def written(path, tmp_path):
    writer = VtuWriter(tmp_path, name="tube")
    writer.started(path.discretisation, None)
    for step in path.steps:
        writer.converged(step)
    return tmp_path


def test_series_has_the_load_factor_as_time(path, written):
    reader = pyvista.get_reader(str(written / "tube.pvd"))
    assert list(reader.time_values) == [step.load_factor for step in path.steps]
    names = [dataset.path for dataset in reader.datasets]
    assert names == [f"steps/step-{number:04d}.vtu" for number in range(len(path.steps))]
    for step in path.steps:
        reader.set_active_time_value(step.load_factor)
        np.testing.assert_array_equal(reader.read()[0].point_data["displacement"], step.state.u)


@pytest.mark.parametrize(
    ("stages", "loads", "times"),
    [
        ([0, 0, 0, 1, 1], [0.0, 0.5, 1.0, 0.5, 1.0], [0.0, 0.5, 1.0, 1.5, 2.0]),
        ([0, 0, 0, 0, 0], [0.0, 0.5, 0.4, 0.3, 1.0], [0.0, 1.0, 2.0, 3.0, 4.0]),
    ],
    ids=["stages", "turning back"],
)
def test_times_rise(path, tmp_path, stages, loads, times):
    for step, stage, load in zip(path.steps, stages, loads, strict=True):
        step.stage, step.load_factor = stage, load
    save_series(path, tmp_path / "tube.pvd")
    assert list(pyvista.get_reader(str(tmp_path / "tube.pvd")).time_values) == times


def test_mesh_is_the_reference_body_of_quadratic_quads(path, written):
    grid = pyvista.read(written / "steps" / "step-0003.vtu")
    mesh = path.discretisation.mesh
    np.testing.assert_array_equal(grid.points, mesh.points)
    np.testing.assert_array_equal(grid.cells.reshape(-1, 9)[:, 1:], mesh.elements)
    assert set(grid.celltypes) == {QUADRATIC_QUAD}
    assert grid.point_data.active_vectors_name == "displacement"
    assert grid.point_data.active_normals_name is None


def test_quads_are_drawn_curved(path, written):
    grid = pyvista.read(written / "steps" / "step-0000.vtu")
    surface = grid.extract_surface(nonlinear_subdivision=3, algorithm="dataset_surface")
    radius = np.linalg.norm(surface.points[:, 1:], axis=1)
    straight = radius.max() * np.cos(np.pi / 4 / 8)
    assert surface.n_points > grid.n_points
    assert radius.min() > radius.max() - 0.01 * (radius.max() - straight), radius.min()


def test_files_hold_exactly_the_registered_outputs(path, written):
    for step in path.steps:
        grid = pyvista.read(written / "steps" / f"step-{step.number:04d}.vtu")
        outputs = {output.name: output for output in chosen(path.model.outputs)}
        assert set(grid.point_data.keys()) == {name for name in outputs if outputs[name].where != "cell"} | {"node"}
        assert set(grid.cell_data.keys()) == {name for name in outputs if outputs[name].where == "cell"}
        assert texts(grid, "outputs") == list(outputs)
        assert texts(grid, "units") == [output.unit for output in outputs.values()]
        assert texts(grid, "meanings") == [output.sentence for output in outputs.values()]
        for name, output in outputs.items():
            array = (grid.cell_data if output.where == "cell" else grid.point_data)[name]
            rows = grid.n_cells if output.where == "cell" else len(grid.points)
            assert array.shape == ((rows,) if output.components == 1 else (rows, output.components)), name
            np.testing.assert_array_equal(array, output.evaluate(converged(path.discretisation, step)), err_msg=name)


def test_meshio_opens_the_files(path, written):
    """It refuses files with arrays of texts."""
    meshio = pytest.importorskip("meshio")
    for step in path.steps:
        found = meshio.read(written / "steps" / f"step-{step.number:04d}.vtu")
        np.testing.assert_array_equal(found.points, path.discretisation.mesh.points)
        np.testing.assert_array_equal(found.cells_dict["quad8"], path.discretisation.mesh.elements)
        np.testing.assert_array_equal(found.point_data["displacement"], step.state.u)
        cells = {output.name for output in chosen(path.model.outputs) if output.where == "cell"}
        assert set(found.cell_data) == cells
        assert texts(pyvista.read(written / "steps" / f"step-{step.number:04d}.vtu"), "element_group_names") == (
            found.field_data["element_group_names"].astype(np.uint8).tobytes().decode().split("\n")
        )


def test_field_and_groups_are_recorded(path, written):
    grid = pyvista.read(written / "steps" / "step-0002.vtu")
    assert [grid.field_data[name] for name in ("step", "stage", "load_factor")] == [2, 1, 0.3]
    np.testing.assert_allclose(grid.field_data["flux_density"], [[0, 0, 6e-3]], rtol=1e-15)
    np.testing.assert_allclose(grid.field_data["flux_density_magnitude"], 6e-3, rtol=1e-15)
    names = texts(grid, "element_group_names")
    assert names == list(path.discretisation.mesh.element_groups) == ["lower", "größer"]
    for number, name in enumerate(names, start=1):
        members = np.flatnonzero(grid.cell_data["element_group"] == number)
        np.testing.assert_array_equal(members, path.discretisation.mesh.element_groups[name])


def test_new_run_replaces_an_old_longer_one(path, written):
    other = written / "steps" / "notes.txt"
    other.touch()
    writer = VtuWriter(written, name="tube")
    assert len(list((written / "steps").glob("*.vtu"))) == len(path.steps)
    writer.started(path.discretisation, None)
    assert not (written / "tube.pvd").exists()
    writer.converged(path.steps[0])
    assert sorted(item.name for item in (written / "steps").iterdir()) == ["notes.txt", "step-0000.vtu"]
    assert list(pyvista.get_reader(str(written / "tube.pvd")).time_values) == [0.0]


def test_save_of_a_whole_path_keeps_series_apart(path, tmp_path):
    save_series(path, tmp_path / "a & b.pvd")
    save_series(path, tmp_path / "other.pvd")
    for name in ("a & b", "other"):
        reader = pyvista.get_reader(str(tmp_path / f"{name}.pvd"))
        reader.set_active_time_value(1.0)
        np.testing.assert_array_equal(reader.read()[0].point_data["displacement"], path.steps[-1].state.u)


def test_disk_error_names_the_file(path, tmp_path):
    (tmp_path / "steps").touch()
    writer = VtuWriter(tmp_path)
    writer.started(path.discretisation, None)
    with pytest.raises(OSError, match="steps"):
        writer.converged(path.steps[0])


def test_registry_is_unambiguous_and_complete():
    words = [word for output in OUTPUTS.values() for word in {output.name, output.symbol}]
    for output in (one for one in OUTPUTS.values() if one.components > 1):
        assert len(output.suffixes) == output.components
        components = range(1, output.components + 1)
        words += [output.of_component(word, i) for word in (output.name, output.symbol) for i in components]
    assert len(words) == len(set(words))
    for name, output in OUTPUTS.items():
        assert output.name == name
        assert output.sentence.endswith(".")
        assert output.sentence[0].isupper()


def test_find_by_name_symbol_and_component():
    assert find("displacement") == find("u") == (OUTPUTS["displacement"], None)
    assert find("u3") == (OUTPUTS["displacement"], 3)
    assert find("s12_top") == find("stress12_top") == (OUTPUTS["stress_top"], 4)
    assert find("M21") == (OUTPUTS["bending_moment"], 4)
    with pytest.raises(InputError, match="Did you mean 'displacement'"):
        find("displacements")
    with pytest.raises(InputError, match="name one of s11_top, s22_top, s33_top, s12_top, s23_top, s13_top"):
        find("stress_top")


def test_outputs_beside_the_usual_ones_are_chosen_by_name_or_for_all_faces():
    usual = [output.name for output in OUTPUTS.values() if output.usual]
    assert [output.name for output in chosen(())] == usual
    more = {output.name for output in chosen(["stress", "energy_density"])} - set(usual)
    assert more == {"stress_top", "stress_middle", "stress_bottom", "energy_density"}
    with pytest.raises(InputError, match=r"There is no output 'strss'. Did you mean 'stress'"):
        chosen(["strss"])
