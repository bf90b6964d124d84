"""Files, pictures and registered outputs of a strip that really was solved."""

from __future__ import annotations

import json
import sys

import numpy as np
import pytest
import pyvista

import magshell as ms
from magshell.errors import InputError
from magshell.evaluation.converged import converged
from magshell.evaluation.outputs import OUTPUTS, chosen
from magshell.output.curve import displacements
from magshell.output.history import HistoryWriter
from magshell.output.pictures import draw_pictures
from magshell.output.series import chosen as series_chosen
from magshell.output.series import groups
from magshell.output.summary import write_summary
from magshell.output.vtu import VtuWriter

LENGTH, THICKNESS, REMANENCE = 11e-3, 1.1e-3, 143e-3


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """A clamped strip that a field turns upwards, solved with the writers watching: path and folder."""
    directory = tmp_path_factory.mktemp("results")
    shell = ms.Shell(
        ms.mesh.rectangle(LENGTH, 5e-3, elements=(4, 1)),
        thickness=THICKNESS,
        material=ms.MicropolarNeoHookean(303e3, 7.3e6, 30.3e3, THICKNESS / 10),
        remanence=ms.remanence.constant([REMANENCE, 0, 0]),
    )
    model = ms.Model(
        shell,
        supports=[ms.Clamp("left")],
        field=ms.UniformField([0, 0, 10e-3]),
        probes={"tip": (LENGTH, 0, 0)},
    )
    return ms.solve(model, observers=[HistoryWriter(directory), VtuWriter(directory)]), directory


def test_history_is_the_probes_path(results):
    path, directory = results
    rows = np.genfromtxt(directory / "history.csv", delimiter=",", names=True, deletechars="")
    tip = path.probe("tip")
    np.testing.assert_array_equal(rows["load_factor"], tip.load_factor)
    np.testing.assert_array_equal(rows["B3"], tip.flux_density[:, 2])
    for i in (1, 2, 3):
        np.testing.assert_array_equal(rows[f"tip.u{i}"], tip.u[:, i - 1])


def test_summary_has_what_scripts_count_on(results):
    path, directory = results
    summary = json.loads(write_summary(path, directory).read_text())
    assert summary["converged"] is True
    assert summary["steps"] == len(path.steps) - 1
    assert summary["elements"] == 4
    assert summary["dofs"] == path.discretisation.dofs
    assert summary["iterations"] >= sum(step.iterations for step in path.steps)
    assert summary["cpu_seconds"] > 0
    assert isinstance(summary["reason"], str)
    assert summary["probes"] == {"tip": path.steps[-1].state.u[path.model.probe_nodes["tip"]].tolist()}


def test_series_holds_every_output_of_every_step(results, tmp_path):
    path, directory = results
    path.save(tmp_path / "copy.pvd")
    for file in (directory / "shell.pvd", tmp_path / "copy.pvd"):
        reader = pyvista.get_reader(str(file))
        assert list(reader.time_values) == [step.load_factor for step in path.steps]
        for step in path.steps:
            reader.set_active_time_value(step.load_factor)
            grid = reader.read()[0]
            for output in chosen(()):
                array = (grid.cell_data if output.where == "cell" else grid.point_data)[output.name]
                np.testing.assert_array_equal(array, output.evaluate(converged(path.discretisation, step)))


def test_outputs_of_the_undeformed_strip(results):
    path, _ = results
    discretisation = path.discretisation
    nodes, elements = len(discretisation.mesh.points), 4
    upright = np.tile([0.0, 0.0, 1.0], (nodes, 1))
    expected = {
        "displacement": np.zeros((nodes, 3)),
        "director": upright,
        "phi": np.zeros(nodes),
        "rotation": np.zeros((nodes, 3)),
        "normal": upright,
        "remanence": np.tile([REMANENCE, 0, 0], (elements, 1)),
        "thickness_ratio": np.ones(elements),
        "energy": np.zeros(elements),
        "element_group": np.zeros(elements),
    }
    others = [output for name, output in OUTPUTS.items() if name not in expected]
    assert len(expected) + len(others) == len(OUTPUTS)
    for output in others:
        found = output.evaluate(converged(discretisation, path.steps[0]))
        rows = elements if output.where == "cell" else nodes
        assert found.shape == (rows, output.components)[: 1 + (output.components > 1)], output.name
        axes = np.eye(3)[int(output.name[-1]) - 1] if output.name.startswith("local_axis") else 0.0
        rest = 1.0 if output.name.startswith("principal_stretches") else axes
        scale = 303e3 if output.unit else 1.0
        np.testing.assert_allclose(found - rest, 0.0, atol=1e-14 * scale, err_msg=output.name)
    energy_scale = 303e3 * LENGTH * 5e-3 * THICKNESS
    for name, values in expected.items():
        found = OUTPUTS[name].evaluate(converged(discretisation, path.steps[0]))
        scale = energy_scale if name == "energy" else 1.0
        np.testing.assert_allclose(found, values, atol=1e-14 * scale, err_msg=name)


def test_outputs_of_the_bent_strip_agree_with_each_other(results):
    """The couple c turns the micro-rotation ahead of the material by c / 4 eta; the coarse mesh may double that."""
    path, _ = results
    discretisation = path.discretisation
    value = {name: output.evaluate(converged(discretisation, path.steps[-1])) for name, output in OUTPUTS.items()}
    last = discretisation.mesh.elements[-1, :4]
    d = value["director"][last].mean(axis=0)
    turned = np.arctan2(-d[0], d[2])
    assert turned > 0.3, "the end turns towards the field"
    angle = -value["rotation"][last, 1].mean()
    ahead = REMANENCE * 10e-3 / (4e-7 * np.pi) * np.cos(turned) / (4 * path.model.shell.material.coupling_modulus)
    assert 0.0 < angle - turned < 2 * ahead, (angle, turned, ahead)
    b = value["remanence"][-1]
    assert np.arctan2(b[2], b[0]) == pytest.approx(turned, abs=2 * ahead), (b, turned)
    assert np.linalg.norm(b) == pytest.approx(REMANENCE, rel=0.02), b
    assert value["thickness_ratio"][-1] == pytest.approx(np.linalg.norm(d), rel=0.005), np.linalg.norm(d)
    assert value["energy"].min() > 0
    assert value["energy"].argmax() == 0, "the strip bends most at the clamp"


def test_pictures_of_the_strip(results, can_draw):
    path, directory = results
    assert draw_pictures(path, directory) == [directory / "curve.png", directory / "shape.png"]
    shown = path.plot(color="u3")
    assert shown._repr_png_().startswith(b"\x89PNG"), "a notebook shows it"


def test_table_has_the_columns_of_the_history(results):
    pandas = pytest.importorskip("pandas")
    path, directory = results
    table = path.table()
    pandas.testing.assert_frame_equal(table, pandas.read_csv(directory / "history.csv"), check_exact=True)
    assert table["stage"].dtype.kind == "i"
    assert table["left.M2"].iloc[-1] == converged(path.discretisation, path.steps[-1]).reactions[0].moment[1]


def test_table_without_pandas_says_what_to_install(results, monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(InputError, match=r'pip install "magshell\[pandas\]"'):
        results[0].table()


def test_summary_has_reactions_and_energies(results):
    path, _ = results
    last, summary = converged(path.discretisation, path.steps[-1]), path.summary
    (reaction,) = last.reactions
    assert summary["reactions"] == {"left": {"force": reaction.force.tolist(), "moment": reaction.moment.tolist()}}
    assert summary["elastic"] == last.energies[:, 0].sum()
    assert summary["magnetic"] is None
    assert summary["magnetic_torque"] == path.steps[-1].balance.magnetic_torque.tolist()


def test_what_is_nothing_but_round_off_is_drawn_as_zero():
    """A field along the remanence bends nothing: curves of 1e-20 mm and stresses of 1e-8 Pa are no result."""
    shell = ms.Shell(
        ms.mesh.rectangle(LENGTH, 5e-3, elements=(4, 1)),
        thickness=THICKNESS,
        material=ms.MicropolarNeoHookean(303e3, 7.3e6, 30.3e3, THICKNESS / 10),
        remanence=ms.remanence.constant([0.3 * REMANENCE, 0, 0.4 * REMANENCE]),
    )
    field = ms.UniformField(np.array([3e-3, 0, 4e-3]))
    path = ms.solve(ms.Model(shell, [ms.Clamp("left")], field, probes={"tip": (LENGTH, 0, 0)}))
    noisy = np.array([step.state.u for step in path.steps])
    noisy += 1e-15 * LENGTH * np.sin(np.arange(noisy.size)).reshape(noisy.shape)
    for step, u in zip(path.steps, noisy, strict=True):
        step.state.u[:] = u
    for curve in displacements(path):
        assert not curve.values.any()
    for group in groups(path):
        assert group.unit not in ("", "kPa", "Pa", "MPa", "J"), group
    assert not series_chosen(path, ["max_von_mises"]).curves[0].values.any()
