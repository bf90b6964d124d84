"""Models and paths that are copied and pickled: the same numbers, and a path that goes on from them."""

from __future__ import annotations

import copy
import pickle
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import magshell as ms
from magshell.model import thickness
from magshell.solver.events import Observer
from magshell.solver.retracing import path_through
from magshell.solver.waypoint import Waypoint

LENGTH = 11e-3
DUPLICATES: dict[str, Callable[[Any], Any]] = {
    "copy": copy.copy,
    "deepcopy": copy.deepcopy,
    "pickle": lambda one: pickle.loads(pickle.dumps(one)),
}
X = (1.0, 0.0, 0.0)
PLACES, VECTORS = [[2e-3, 1e-3, 0], [8e-3, 1e-3, 0]], [[0.1, 0, 0], [0, 0.1, 0]]
REMANENCES = {
    "constant": ms.remanence.constant([0.1, 0, 0]),
    "meridional": ms.remanence.meridional(0.1),
    "circumferential": ms.remanence.circumferential(0.1, X, towards=(0, 1, 0)),
    "radial": ms.remanence.radial(0.1, through=(-1, 0, 0)),
    "tangential": ms.remanence.tangential(0.1, X),
    "along a curve": ms.remanence.along_curve("bottom", 0.1),
    "profile": ms.remanence.profile(0.1, [0, 1e-2], X, X, [0, 1], towards=(0, 0, 1)),
    "function": ms.remanence.function(np.cos),
    "of elements": ms.remanence.per_element(np.full((4, 3), 0.1)),
    "at places": ms.remanence.at_places(PLACES, VECTORS, 1.0),
    "folded": ms.remanence.template(ms.remanence.rolled(2e-3, (5e-3, 0, 0), X, (0, 0, 1)), 0.1, (0, 0, 1)),
    "of groups": ms.remanence.by_group({"part": ms.remanence.constant([0.1, 0, 0])}),
}


def taper(x: np.ndarray) -> np.ndarray:
    return 1e-3 + 0.1 * x[..., 0]


THICKNESSES = {
    "profile": thickness.profile(X, [0, LENGTH], [1e-3, 2e-3]),
    "of elements": thickness.per_element([1e-3, 2e-3, 1e-3, 2e-3]),
    "of nodes": thickness.per_node(np.full(23, 1e-3)),
    "function": thickness.function(taper),
    "at places": thickness.at_places(PLACES, [1e-3, 2e-3], tolerance=1.0),
}


def model(remanence: Any = REMANENCES["constant"]) -> ms.Model:
    mesh = ms.mesh.rectangle(LENGTH, 5e-3, (4, 1)).select_elements("part", within=lambda x: x[:, 0] < 6e-3)
    shell = ms.Shell(mesh, 1.1e-3, ms.MicropolarNeoHookean(303e3, 7.3e6), remanence)
    return ms.Model(shell, [ms.Clamp("left")], ms.UniformField([0, 0, 10e-3], [5e-3]), probes={"tip": (LENGTH, 0, 0)})


@pytest.fixture(scope="module")
def path() -> ms.Path:
    return ms.solve(model())


each_way = pytest.mark.parametrize("duplicate", DUPLICATES.values(), ids=DUPLICATES)


@each_way
@pytest.mark.parametrize("remanence", REMANENCES.values(), ids=REMANENCES)
def test_a_model_of_every_remanence(remanence: Any, duplicate: Callable[[Any], Any]) -> None:
    given = model(remanence)
    other = duplicate(given)
    np.testing.assert_array_equal(other.shell.remanence_at_points, given.shell.remanence_at_points)
    mesh = given.shell.mesh
    points = mesh.points[mesh.elements].mean(axis=1)[:, None]
    np.testing.assert_array_equal(other.shell.remanence(mesh, points), given.shell.remanence(mesh, points))
    assert other.probe_nodes == given.probe_nodes
    assert other.doubts() == given.doubts()


@pytest.mark.parametrize("made", THICKNESSES.values(), ids=THICKNESSES)
def test_every_thickness(made: Any) -> None:
    mesh = model().shell.mesh
    points = mesh.points[mesh.elements]
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(made))(mesh, points), made(mesh, points))


@each_way
def test_a_path(path: ms.Path, duplicate: Callable[[Any], Any]) -> None:
    other = duplicate(path)
    assert other.converged
    np.testing.assert_array_equal(other.probe("tip").u, path.probe("tip").u)
    np.testing.assert_array_equal(other.values("von_mises_top"), path.values("von_mises_top"))
    assert other.history.rows(other.steps) == path.history.rows(path.steps)
    assert other.summary == path.summary


def test_a_path_that_goes_on() -> None:
    """From the middle, to the same bits."""
    waypoints: list[Waypoint] = []

    class Collector(Observer):
        def kept(self, path: ms.Path) -> None:
            waypoints.append(path.trail[-1])

    path = ms.solve(model(), observers=[Collector()])
    stopped = pickle.loads(pickle.dumps(path_through(path.model, path.settings, waypoints[:3])))
    assert not stopped.converged
    np.testing.assert_array_equal(ms.resume(stopped).probe("tip").u, path.probe("tip").u)


def test_a_path_in_another_process(path: ms.Path, tmp_path: Path) -> None:
    """Where the compiled laws have other addresses."""
    file = tmp_path / "path.pickle"
    file.write_bytes(pickle.dumps(path))
    script = f"import pickle; print(pickle.load(open({str(file)!r}, 'rb')).values('s11_top').max().hex())"
    found = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert float.fromhex(found.stdout) == path.values("s11_top").max()


def test_a_function_of_nobodys_module() -> None:
    """What Python cannot find by its name it cannot pickle, and says so."""
    with pytest.raises((AttributeError, pickle.PicklingError), match="lambda"):
        pickle.dumps(model(ms.remanence.function(lambda x: x)))
