"""A quarter tube bent by a formula: a body for files and pictures that needs no solve."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from magshell.evaluation.converged import Converged
from magshell.evaluation.work import Work
from magshell.magnetics import remanence
from magshell.magnetics.fields.uniform import UniformField
from magshell.magnetics.micropolar_couple import MicropolarCouple
from magshell.materials import MicropolarNeoHookean
from magshell.mesh import cylinder
from magshell.model.course import Loading
from magshell.model.shell import Shell
from magshell.output import rendering
from magshell.shell.state import State
from magshell.solver.history import History

RADIUS, LENGTH = 10e-3, 16e-3
RUBBER = MicropolarNeoHookean(135e3, 3.25e6, 13.5e3, 9e-5)
PROBES = {"tip": (LENGTH, 0, RADIUS), 'edge, "low"': (LENGTH, RADIUS, 0)}
NOTHING = Loading(np.zeros(3), np.zeros(0), np.zeros((1, 11)), np.zeros(0))
LOADS = (0.0, 0.1, 0.3, 0.6, 1.0)


class FakeDiscretisation:
    """The members that output reads, as formulas."""

    def __init__(self, model, mesh):
        self.model, self.mesh, self.dofs = model, mesh, 7 * len(mesh.points)
        self.reference = SimpleNamespace(remanence=np.tile([0.0, 0.0, 80e-3], (len(mesh.elements), 4, 2, 1)))
        radial = mesh.points * [0, 1, 1]
        self.normals = radial / np.linalg.norm(radial, axis=1, keepdims=True)
        self.rows = SimpleNamespace(elements=mesh.elements)


class FakeConverged:
    """What outputs are evaluated of, as formulas."""

    def __init__(self, discretisation, state, loading):
        self.discretisation, self.state, self.loading = discretisation, state, loading
        self.mesh = discretisation.mesh
        self._u = state.u[self.mesh.elements]

    @property
    def displacement(self):
        return self.state.u

    def director(self):
        return self.discretisation.normals + self.state.w

    def phi(self):
        return self.state.phi

    def normal(self):
        return self.discretisation.normals

    def element_phi(self):
        return self.state.phi[self.mesh.elements]

    def element_stretch(self):
        return np.zeros(self.mesh.elements.shape)

    def rotation(self):
        return 2 * self.state.q[:, 1:]

    def remanence(self):
        return np.tile([0.0, 0.0, 80e-3], (len(self._u), 1))

    def thickness_ratio(self):
        return 1 - 20 * np.abs(self._u).mean(axis=(1, 2))

    def at_face(self, name, face):
        size = {"top": 2e3, "middle": 1e3, "bottom": -1e3}[face] * self.state.u
        return size[:, :, None] * size[:, None] if name == "stress" else np.linalg.norm(size, axis=1)

    def resultant(self, name):
        return 5.0 * np.stack([self.state.u, -self.state.u], axis=2)

    reactions = ()
    body_motions = body_forces = jumps = np.zeros((0, 2, 3))
    magnetic_torque = (0.0, 0.0, 1e-6)
    acting = "known"

    def work_from(self, before):
        return Work(1e-6, 2e-6)

    @property
    def energies(self):
        return np.column_stack([1e-6 * np.abs(self._u).sum(axis=(1, 2)), np.zeros(len(self._u))])


@pytest.fixture(autouse=True)
def formulas(monkeypatch):
    """What has converged on a fake path is a fake, too."""

    def made(discretisation, *reached):
        fake = isinstance(discretisation, FakeDiscretisation)
        return (FakeConverged if fake else Converged)(discretisation, *reached)

    monkeypatch.setattr("magshell.evaluation.converged.Converged", made)


class FakePath:
    """A path of formula states with the members that output reads."""

    def __init__(self, loads=LOADS, probes=PROBES, field=(0.0, 0.0, 20e-3), material=RUBBER, remanent=80e-3):
        mesh = cylinder(RADIUS, LENGTH, elements=(8, 6), angle=(0, 90), axis=(1, 0, 0), zero=(0, 1, 0))
        half = len(mesh.elements) // 2
        groups = {"lower": np.arange(half), "größer": np.arange(half, len(mesh.elements))}
        mesh = replace(mesh, element_groups=groups)
        self.model = SimpleNamespace(
            field=UniformField(field),
            coupling=MicropolarCouple(),
            shell=Shell(mesh, 0.9e-3, material, remanence.constant((0.0, 0.0, remanent))),
            outputs=("stress", "membrane_force"),
            named_supports=(),
            springs=(),
            turns=(),
            reactions=(),
            stages=[SimpleNamespace(branch=None)] * 3,
            probe_nodes={name: mesh.node_at(position) for name, position in probes.items()},
            course=lambda stage: SimpleNamespace(
                at=lambda load_factor: Loading(np.zeros(3), np.zeros(0), np.zeros((1, 11)), np.zeros(0)),
                reported=lambda load_factor, flux_density: flux_density,
            ),
        )
        self.discretisation = FakeDiscretisation(self.model, mesh)
        self.courses = [SimpleNamespace(amounts=lambda load: SimpleNamespace(drives=np.array([load, 0.0])))] * 3
        self.critical_points, self.converged, self.reason = [], True, "the end of the path is reached"
        self.steps = [self._step(number, load) for number, load in enumerate(loads)]
        self.history = History(self.discretisation)
        self.summary = {"converged": True, "reason": "", "linear_solves": np.int64(21), "cpu_seconds": 0.125}

    def flux_density(self, step):
        return step.flux_density

    def _step(self, number, load):
        X = self.discretisation.mesh.points
        s = X[:, 0] / LENGTH
        bend = np.tanh(2 * load)
        u = np.stack([-0.4 * LENGTH * s**3 * bend, 0.05 * X[:, 1] * s, LENGTH * s**2 * (0.8 + 20 * X[:, 2])], axis=1)
        q = np.zeros((len(u), 4))
        q[:, 0], q[:, 2] = np.cos(bend * s / 2), -np.sin(bend * s / 2)
        state = State(u * bend, 6 * u * bend, -0.3 * s * bend / RADIUS, q, np.zeros(len(u)), np.zeros((0, 0, 3)))
        return SimpleNamespace(
            number=number, load_factor=load, state=state, flux_density=load * self.model.field.vector,
            drives=np.array([load, 0.0]),
            stage=0, arc_length=2.0 * load, negative_pivots=int(load == 0.6), loads=np.zeros(0),
            balance=None,
        )  # fmt: skip


@pytest.fixture
def path():
    """Five steps and two probes, one with a name that CSV must quote."""
    return FakePath()


@pytest.fixture(scope="session")
def can_draw():
    """Skip the test, saying why, where nothing three-dimensional can be drawn."""
    try:
        rendering.require_rendering()
    except rendering.RenderingUnavailable as unavailable:
        pytest.skip(str(unavailable))
