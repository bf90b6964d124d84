"""Rows beside the paper's numbers, and what they say about a difference."""

from __future__ import annotations

import csv
from pathlib import Path as File

import numpy as np
import pytest

from magshell import Path, problem, solve
from magshell.equations.instant import Instant
from magshell.errors import InputError
from magshell.problem.building import build
from magshell.reproduction.catalogue import EXAMPLES, find
from magshell.reproduction.numbers import rows_of
from magshell.reproduction.references import QUOTED
from magshell.reproduction.table import WORTH_A_NOTE, Row, write_table
from magshell.reproduction.variants import LARGER, OTHER_ELEMENT, paper_file, scaled, variants


@pytest.fixture(scope="module")
def h_shape() -> Path:
    """The H with the element and on the mesh of the paper."""
    built = build(paper_file("h-shape"), "h-shape")
    return solve(built.model, built.settings)


def test_height_of_the_h_is_the_papers_at_the_edge_of_the_bar(h_shape: Path) -> None:
    centre, edge = rows_of("h-shape", {"h-shape": h_shape})
    assert centre.paper == edge.paper == 24.65
    assert abs(centre.difference_percent) > WORTH_A_NOTE > abs(edge.difference_percent)
    assert f"{edge.computed:.2f} mm" in centre.note, centre.note
    assert not edge.note


def test_every_quoted_number_belongs_to_an_example_its_probes_and_a_stop() -> None:
    for entry in QUOTED:
        (example,) = find([entry.example])
        (file,) = [file for name, file in variants(example).items() if name == entry.example]
        assert entry.probe in file.probes
        assert any(abs(1e3 * stop - entry.field) < 1e-12 for stop in file.field.stops), entry


def test_examples_show_only_stops_and_probes_of_their_problems() -> None:
    for example in EXAMPLES:
        for name in example.problems:
            file = paper_file(name)
            stops = {round(1e3 * stop, 9) for stop in file.field.stops}
            assert set(example.fields) <= stops, f"{name}: {example.fields}, stops {stops}"
            assert {probe for probe, _ in example.curves} <= set(file.probes)


def test_variants_have_the_papers_element() -> None:
    for example in EXAMPLES:
        for name, file in variants(example).items():
            assert (file.shell.element == "paper") != (name == OTHER_ELEMENT), name


def test_names_choose_in_the_order_of_the_paper() -> None:
    assert [example.name for example in find(["gripper", "strips"])] == ["strips", "gripper"]
    assert find([]) == list(EXAMPLES)
    with pytest.raises(InputError, match="Did you mean 'h-shape'"):
        find(["strips", "h-shap"])


def test_larger_hollow_cross_is_the_same_one_larger() -> None:
    """Its mesh, supports and probes are scaled, so its model can be built; its thickness stays."""
    one, other = (build(file, "hollow-cross").model for file in (paper_file("hollow-cross"), _larger()))
    np.testing.assert_allclose(other.shell.mesh.points, LARGER * one.shell.mesh.points, atol=1e-12)
    assert other.shell.thickness == one.shell.thickness
    assert dict(other.probe_nodes) == dict(one.probe_nodes)
    np.testing.assert_array_equal(other.constraints.fixed, one.constraints.fixed)


def _larger() -> problem.schema.ProblemFile:
    return scaled(paper_file("hollow-cross"), LARGER)


def test_heights_of_the_hollow_cross_are_free_of_where_it_is_held() -> None:
    """Both held points carry no force, by the symmetry about the diagonal: holding others only shifts all heights."""
    file = paper_file("hollow-cross")
    mesh = file.mesh.model_copy(update={"elements": (1, 1)})
    field = file.field.model_copy(update={"flux_density": (0.0, 0.0, -5e-3), "stops": ()})
    built = build(file.model_copy(update={"mesh": mesh, "field": field}), "hollow-cross")
    path = solve(built.model, built.settings)
    points, u = path.discretisation.mesh.points, path.steps[-1].state.u
    mirrored = np.array([path.discretisation.mesh.node_at(point) for point in points[:, [1, 0, 2]]])
    apart = np.abs(u[mirrored][:, [1, 0, 2]] - u).max() / np.abs(u).max()
    assert apart < 1e-8, f"{apart:.1e}"
    residual = path.discretisation.assemble(
        Instant(path.steps[-1].state, path.discretisation.model.loading(1.0)), tangent=False
    ).residual
    held = [path.model.probe_nodes[name] for name in ("A", "G")]
    others = np.abs(np.delete(residual[:, 2], held)).max()
    assert np.abs(residual[held, 2]).max() <= max(10.0 * others, 1e-12), f"{residual[held, 2]}, elsewhere {others:.1e}"


def test_table_leaves_unknown_numbers_empty(tmp_path: File) -> None:
    write_table([Row("pump", "a, b", "mm", None, 1.0, 'why "so"'), Row("pump", "lost")], tmp_path / "t.csv")
    with open(tmp_path / "t.csv", newline="") as file:
        first, second = csv.DictReader(file)
    assert (first["quantity"], first["paper"], first["computed"], first["difference_percent"]) == ("a, b", "", "1", "")
    assert first["note"] == 'why "so"'
    assert second["computed"] == ""
