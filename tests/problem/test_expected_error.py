"""The rule of thumb for the error of a mesh: what it tells, of what it depends, and against refined meshes."""

from __future__ import annotations

import itertools
import re

import numpy as np
import pytest
from problem_files import STRIP, changed

import magshell as ms
from magshell import cli
from magshell.mesh.across import elements_across
from magshell.model.doubts.mesh_error import STEPS, in_words


def strip(elements: tuple[int, int], nu: float = 0.48, **more: object) -> ms.Model:
    mesh = ms.mesh.rectangle(20e-3, 5e-3, elements)
    rubber = ms.MicropolarNeoHookean.from_moduli(youngs_modulus=900e3, poissons_ratio=nu)
    shell = ms.Shell(mesh, 1e-3, rubber, ms.remanence.constant([0.1, 0, 0]), **more)
    return ms.Model(shell, [ms.Clamp("left")], ms.UniformField([0, 0, 20e-3]), probes={"tip": (20e-3, 2.5e-3, 0)})


@pytest.mark.parametrize(("name", "coarse"), [("strip-10", [5, 1]), ("strip-10", [5, 2]), ("cantilever-shear", [4, 1])])
def test_it_is_more_than_refining_the_mesh_changes(name: str, coarse: list[int]) -> None:
    """A small twin of `docs/make_mesh_study.py`."""
    tips = []
    for elements in (coarse, [2 * n for n in coarse]):
        problem = ms.problem.load(name, {"mesh.elements": elements})
        path = ms.solve(problem.model, problem.settings)
        tips.append(path.probe(next(iter(problem.model.probes))).u[-1])
        if elements == coarse:
            expected = problem.model.expected_error
    change = np.linalg.norm(tips[0] - tips[1]) / np.linalg.norm(tips[1])
    assert 1e-5 < change < expected < 0.1, (change, expected)


def test_it_falls_with_the_element_size() -> None:
    errors = [strip(elements).expected_error for elements in ((5, 1), (10, 2), (20, 4), (40, 8))]
    assert all(finer < 0.5 * coarser for coarser, finer in itertools.pairwise(errors)), errors


def test_elements_may_be_long_across_the_bending() -> None:
    """The couple bends the strip along itself: only the size along it counts, as long as rows across are alike."""
    along, square = strip((20, 2)).expected_error, strip((8, 2)).expected_error
    assert along < 0.5 * square, (along, square)
    turned = strip((20, 2))
    turned = ms.Model(turned.shell, turned.supports, ms.UniformField([0, 20e-3, 0]), probes=turned.probes)
    assert turned.expected_error > along, (
        "a couple about the normal has no direction of bending: the longest side counts"
    )


def test_one_element_across_costs_where_the_material_keeps_its_volume() -> None:
    one, none = strip((20, 1)).expected_error, strip((20, 1), nu=0.0).expected_error
    assert one - none == pytest.approx(0.03 * 0.96**2, rel=1e-9)


def test_a_stronger_field_needs_more_elements() -> None:
    """Layers of a length that falls with the root of the field, to the power 1.5."""
    weak = strip((20, 2), nu=0.0)
    strong = ms.Model(weak.shell, weak.supports, ms.UniformField([0, 0, 80e-3]), probes=weak.probes)
    assert strong.expected_error == pytest.approx(4.0**0.75 * weak.expected_error, rel=1e-9)


def test_it_does_not_depend_on_the_size_of_everything() -> None:
    """All lengths a thousandfold: the same numbers without dimension."""
    tube = [ms.mesh.cylinder(radius, 2 * radius, (8, 4), angle=(0, 90)) for radius in (10e-3, 10.0)]
    rubber = ms.MicropolarNeoHookean.from_moduli(youngs_modulus=900e3, poissons_ratio=0.48)
    found = [
        ms.Model(
            ms.Shell(mesh, thickness, rubber, ms.remanence.constant([0.1, 0, 0])),
            [ms.Clamp("start")],
            ms.UniformField([0, 0, 20e-3]),
        ).expected_error
        for mesh, thickness in zip(tube, (1e-3, 1.0), strict=True)
    ]
    assert found[0] == pytest.approx(found[1], rel=1e-9)


def test_of_the_papers_element_nothing_is_told() -> None:
    assert strip((10, 2), element="paper").expected_error is None
    assert in_words(None) == "not known for this element type"


@pytest.mark.parametrize(("error", "said"), [(1e-9, "0.1 %"), (0.0031, "1 %"), (0.01, "1 %"), (0.05, "10 %")])
def test_it_is_rounded_up(error: float, said: str) -> None:
    assert in_words(error) == f"up to about {said} of the largest displacement (rule of thumb)"
    assert in_words(1.01 * STEPS[-1]).startswith("more than 10 %")


def test_check_tells_it(tmp_path, capsys) -> None:
    file = tmp_path / "strip.toml"
    paper = changed(STRIP, ("[shell]", '[shell]\nelement = "paper"'))
    for text, said in ((STRIP, r"up to about \d+ % of"), (paper, "not known")):
        file.write_text(text)
        assert cli.main(["check", str(file)]) == 0
        (line,) = [line for line in capsys.readouterr().out.splitlines() if "expected error" in line]
        assert re.search(said, line), line


def free(mesh: ms.mesh.Mesh) -> np.ndarray:
    return np.zeros(len(mesh.points), dtype=bool)


def test_rows_of_elements() -> None:
    plate = ms.mesh.rectangle(10e-3, 4e-3, (10, 3))
    assert elements_across(plate, free(plate)) == 3
    mirrored = np.isclose(plate.points[:, 1], 0.0)
    assert elements_across(plate, mirrored) == 6
    tube = ms.mesh.cylinder(5e-3, 10e-3, (12, 7))
    assert elements_across(tube, free(tube)) == 7, "rows around the tube have no end"
    cross = ms.mesh.blocks(
        {
            "middle": [(0, 0), (3e-3, 0), (3e-3, 3e-3), (0, 3e-3)],
            "arm": [(3e-3, 0), (15e-3, 0), (15e-3, 3e-3), (3e-3, 3e-3)],
        },
        {"middle": (2, 2), "arm": (8, 2)},
    )
    assert elements_across(cross, free(cross)) == 2


def test_a_coarse_mesh_is_doubted() -> None:
    """Above the last step of `in_words`; no built-in problem is."""
    coarse = [said for elements in ((1, 1), (40, 8)) for said in strip(elements).doubts() if "coarse" in said]
    assert coarse == ["the mesh is coarse: its expected error is " + in_words(1.0) + ". Take smaller elements"]
    errors = {name: ms.problem.load(name).model.expected_error for name in ms.problem.names()}
    assert {name for name, error in errors.items() if error is not None and error > STEPS[-1]} == set()
