"""What a load that says nothing of itself is in `check`, in pictures and at mirror planes follows from its forces."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
import pytest

import magshell as ms
from loads.cases import CASES, at_rest, shell_of
from magshell.model import symmetry
from magshell.model.loads import LOADS, Load
from magshell.model.loads.dead import DeadForces, nodal
from magshell.model.loads.load import resultant
from magshell.model.rows import Rows, rows_of
from magshell.units import FORCE, MOMENT

MESH = ms.mesh.rectangle(2.0, 1.0, (4, 2))
SHELL = shell_of(MESH)


@dataclass(frozen=True, eq=False)
class Pull(Load):
    """The same force on every node of a group."""

    kind = "pull"
    amount = ("pull", FORCE)

    pull: Any
    group: str | None = None
    history: Sequence[float] | None = None

    def applied(self, shell: ms.Shell, rows: Rows) -> Any:
        on_u = np.zeros_like(shell.mesh.points)
        on_u[self.members(shell)] = np.broadcast_to(self.pull, 3)
        return DeadForces(on_u)


@dataclass(frozen=True, eq=False)
class Twist(Pull):
    """A couple about X1 on every node."""

    kind = "twist"
    amount = ("pull", MOMENT)

    def applied(self, shell: ms.Shell, rows: Rows) -> Any:
        class Couples(DeadForces):
            def forces(self, state: Any) -> np.ndarray:
                return nodal("omega", self.on_u)

        on_u = np.zeros_like(shell.mesh.points)
        on_u[:, 0] = self.pull
        return Couples(on_u)


def forces(load: Load) -> np.ndarray:
    return load.applied(SHELL, rows_of(SHELL)).forces(at_rest(MESH))


def test_a_vector_on_nodes() -> None:
    load = Pull((0.0, 3.0, 4.0), "left")
    count = len(MESH.nodes_of("left"))
    assert load.words(SHELL, forces(load)) == f"pull (0, 3 N, 4 N), 5 nodes, in all (0, {3 * count} N, {4 * count} N)"
    assert load.size(forces(load)) == pytest.approx((5.0 * count, 0.0, 0.0, 0.0))
    places, vectors, name = load.arrows(SHELL, forces(load))
    assert name == "left: pull, 5 N"
    np.testing.assert_array_equal(vectors, [[0.0, 3.0, 4.0]])
    np.testing.assert_allclose(places, [[0.0, 0.5, 0.0]], atol=1e-15)


def test_a_number_on_the_whole_shell() -> None:
    load = Pull(2.0)
    nodes = len(MESH.points)
    places, vectors, name = load.arrows(SHELL, forces(load))
    assert name == "whole shell: pull, 2 N"
    np.testing.assert_array_equal(places, MESH.points)
    np.testing.assert_allclose(vectors, 3**-0.5)
    assert load.words(SHELL, forces(load)).startswith(f"pull 2 N, {nodes} nodes, in all (")


def test_couples() -> None:
    load = Twist(2.0)
    nodes = len(MESH.points)
    assert load.words(SHELL, forces(load)) == f"twist 2 N m, {nodes} nodes, in all ({2 * nodes} N m, 0, 0)"
    assert load.size(forces(load)) == pytest.approx((0.0, 2.0 * nodes, 0.0, 0.0))
    np.testing.assert_allclose(load.arrows(SHELL, forces(load)).vectors, np.tile([1.0, 0.0, 0.0], (nodes, 1)))


def test_nothing_is_no_arrow() -> None:
    load = Pull(0.0)
    assert len(load.arrows(SHELL, forces(load)).places) == 0


def test_a_mirror_plane() -> None:
    supports = [ms.Clamp("left"), ms.SymmetryPlane("bottom", (0.0, 1.0, 0.0))]
    broken = ms.Model(SHELL, supports, loads=[Pull((0.0, 1.0, 1.0), "bottom")])
    whole = ms.Model(SHELL, supports, loads=[Pull((1.0, 0.0, 1.0), "bottom")])
    (fault,) = symmetry.broken(broken)
    assert fault.startswith("symmetry 'bottom': pull on 'bottom' (0, 1 N, 1 N) is 45° off the plane: its support takes")
    assert symmetry.broken(whole) == []


@pytest.mark.parametrize("load", LOADS.values(), ids=LOADS)
def test_keys_are_the_parameters(load: type[Load]) -> None:
    assert set(load.keys) == {parameter.name for parameter in fields(load)}
    assert load.amount[0] in load.keys


def test_the_default_size_is_that_of_parallel_forces() -> None:
    load = ms.Force("top", CASES["force on edges"].load.total)
    found = forces(load)
    assert Load.size(load, found).force == pytest.approx(load.size(found).force, rel=1e-12)
    assert resultant(found) == pytest.approx(load.total, rel=1e-12)
