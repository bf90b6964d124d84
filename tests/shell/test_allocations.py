"""Kernels give back all memory that they allocate, whatever laws and elements they are made for."""

from __future__ import annotations

from typing import NamedTuple

import numba
import numpy as np
import pytest
from battery import (
    FIELD,
    REMANENCE,
    THICKNESS,
    TYPES,
    Unsupported,
    each_pair,
    for_element,
    patch,
    random_increment,
    random_state,
)
from magshell.equations.assembly import Discretisation, InvertedElement
from numba.core.runtime import _nrt_python, rtsys
from solver.models import strip

import magshell as ms
from magshell.compiled import Kernel, inline
from magshell.magnetics.law import forces_of
from magshell.materials.law import stresses_of
from magshell.materials.tensors import inverse_transpose
from magshell.shell.section import _forces_and_tangent, _stress_and_tangent


@pytest.fixture(autouse=True)
def counted():
    """Numba counts allocations on request only."""
    _nrt_python.memsys_enable_stats()
    yield
    _nrt_python.memsys_disable_stats()


def allocations():
    """Allocations of the kernels so far, and how many of them are live."""
    stats = rtsys.get_allocation_stats()
    return stats.alloc, stats.alloc - stats.free


def left_by(call, times=3):
    """Allocations that calls leave behind; the first one may compile."""
    call()
    before, live = allocations()
    for _ in range(times):
        call()
    after, left = allocations()
    assert after > before, "nothing was counted"
    return left - live


def calls(d):
    """Every use of a kernel, by name."""
    state, loading = random_state(d, 1, strain=1e-3), d.model.loading(0.1)
    stresses, (increment, d_alpha) = d.stresses_at(state), random_increment(d, 1, 1e-3)
    inside_out = d.undeformed()._replace(w=-2.0 * d.normals)

    def inverted():
        with pytest.raises(InvertedElement):
            d.assemble(inside_out, loading)

    return {
        "residual": lambda: d.assemble(state, loading, tangent=False),
        "plain tangent": lambda: d.assemble(state, loading),
        "mixed tangent": lambda: d.assemble(state, loading, stresses),
        "a state that cannot be": inverted,
        "enhancement": lambda: d.recover(increment),
        "predicted stresses": lambda: d.predicted_stresses(state, increment, d_alpha),
        "stresses of a state": lambda: d.stresses_at(state),
    }


def body(material, coupling, element, **options):
    """Equations of a small shell that nothing holds."""
    mesh, magnets = for_element(patch((2, 2)), element), ms.remanence.constant(REMANENCE)
    shell = ms.Shell(mesh, THICKNESS, material, magnets, element, **options)
    return Discretisation(Unsupported(shell, ms.UniformField(FIELD), coupling), lambda graph: np.arange(graph.shape[0]))


@pytest.mark.parametrize("stretch", ["linear", "none", "plane-stress"])
@pytest.mark.parametrize("micro_rotation", [True, False], ids=["10 parameters", "7 parameters"])
@each_pair
def test_no_kernel_leaves_memory_behind(material, coupling, micro_rotation, stretch):
    if not micro_rotation:
        material = material._replace(coupling_modulus=0.0, length_scale=0.0)
    for element in TYPES.values():
        d = body(material, coupling, element, thickness_stretch=stretch, micro_rotation=micro_rotation)
        left = {name: left_by(call) for name, call in calls(d).items()}
        assert not any(left.values()), f"{element.name}: {left}"


def test_nor_does_a_whole_solve():
    model = strip()
    assert left_by(lambda: ms.solve(model), times=2) == 0


# -- laws of users ---------------------------------------------------------------------------------------------------


class AllocatingMaterial(NamedTuple):
    shear_modulus: float = 1.0


class AllocatingCoupling(NamedTuple):
    strength: float = 1.0


@numba.njit
def _doubled(values):
    result = np.empty(3)
    for i in range(3):
        result[i] = 2.0 * values[i]
    return result


def _stress(material, U, P, C):
    V, _ = inverse_transpose(U)
    work = np.zeros((3, 3))
    for i in range(3):
        row = _doubled(V[i])
        for j in range(3):
            work[i, j] += row[j]
            P[i, j] = work.T[j, i]


def _forces(coupling, m, n, B, f, c, K_m, K_ω):
    total = np.zeros(3)
    view = total[1:]
    for i in range(2):
        view[i] = _doubled(m)[i]
        f[i] = total[i]


@inline
def _laws(material, coupling, U, P, C, f):
    _stress_and_tangent(material, U, P, C)
    _forces_and_tangent(coupling, U[0], U[1], U[2], f, f, P, P)


@Kernel
def _many_points(material, coupling, U, P, C, f):
    for _ in range(100):
        _laws(material, coupling, U, P, C, f)


def test_laws_may_allocate(monkeypatch):
    """Called as the sections call them: by functions that are compiled without counting references."""
    monkeypatch.setitem(stresses_of, AllocatingMaterial, _stress)
    monkeypatch.setitem(forces_of, AllocatingCoupling, _forces)
    U = np.eye(3) + 0.1 * np.arange(9.0).reshape(3, 3)
    P, C, f = np.zeros((3, 3)), np.zeros((3, 3, 3, 3)), np.zeros(3)
    assert left_by(lambda: _many_points(AllocatingMaterial(), AllocatingCoupling(), U, P, C, f)) == 0
