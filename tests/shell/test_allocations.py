"""Kernels give back all memory that they allocate, whatever laws and elements they are made for."""

from __future__ import annotations

from typing import NamedTuple

import numba
import numpy as np
import pytest
from battery import (
    FIELD,
    MATERIAL,
    REMANENCE,
    THICKNESS,
    TYPES,
    Unsupported,
    each_pair,
    example,
    for_element,
    patch,
    random_increment,
    random_state,
)
from numba.core.runtime import _nrt_python, rtsys
from solver.models import strip

import magshell as ms
from magshell.equations.discretisation import Discretisation
from magshell.equations.instant import Instant
from magshell.equations.term import InvertedElement
from magshell.magnetics import law as coupling_laws
from magshell.materials import law as material_laws
from magshell.materials import neo_hookean
from magshell.materials.tensors import inverse_transpose


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
    instant = Instant(state, loading)
    prediction, increment = d.predicted(instant), random_increment(d, 1, 1e-3)
    inside_out = d.undeformed()._replace(w=-2.0 * d.normals)

    def inverted():
        with pytest.raises(InvertedElement):
            d.assemble(Instant(inside_out, loading))

    predicted = {
        "predicted stresses": lambda: d.predicted(instant, increment),
        "stresses of a state": lambda: d.predicted(instant),
    }
    return {
        "residual": lambda: d.assemble(Instant(state, loading), tangent=False),
        "plain tangent": lambda: d.assemble(Instant(state, loading)),
        "mixed tangent": lambda: d.assemble(Instant(state, loading, prediction)),
        "a state that cannot be": inverted,
    } | ({} if prediction is None else predicted)


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
    return work.sum()


def _forces(coupling, m, n, B, gradients, forces, tangent):
    total = np.zeros(3)
    view = total[1:]
    for i in range(2):
        view[i] = _doubled(m)[i]
        forces[i] += total[i]
    return total.sum()


def test_laws_may_allocate(registry):
    """Called as the sections call them: by functions that are compiled without counting references."""

    @material_laws.material_law(_stress)
    class AllocatingMaterial(NamedTuple):
        shear_modulus: float = 1.0

    @coupling_laws.coupling_law(_forces, has_energy=True)
    class AllocatingCoupling(NamedTuple):
        strength: float = 1.0

    U, B = np.tile(np.eye(3) + 0.1 * np.arange(9.0).reshape(3, 3), (100, 1, 1)), np.ones(3)
    assert left_by(lambda: material_laws.evaluate(AllocatingMaterial(), U)) == 0
    assert left_by(lambda: coupling_laws.evaluate(AllocatingCoupling(), U[:, 0], U[:, 1], B)) == 0
    assert np.allclose(material_laws.evaluate(AllocatingMaterial(), U)[1], 2.0 * np.linalg.inv(U).swapaxes(-1, -2))


def test_nor_does_a_solve_with_laws_that_allocate(registry):
    @material_laws.material_law(_neo_hookean)
    class Copying(MATERIAL):
        """The neo-Hookean law, of a copy of the stretch."""

    @coupling_laws.coupling_law(_energy, has_energy=True)
    class CopyingEnergy(NamedTuple):
        vacuum_permeability: float = 4e-7 * np.pi

    d = body(Copying(**PARAMETERS_OF_NEO_HOOKE), CopyingEnergy(0.8), TYPES["quadratic"])
    left = {name: left_by(call) for name, call in calls(d).items()}
    assert not any(left.values()), f"{left}"


PARAMETERS_OF_NEO_HOOKE = example(MATERIAL)._asdict()
_law = numba.extending.register_jitable(neo_hookean._law)


def _neo_hookean(material, U, P, C):
    return _law(material, U.copy(), P, C)


def _energy(coupling, m, n, B, gradients, forces, tangent):
    copied = B.copy() / coupling.vacuum_permeability
    for i in range(3):
        forces[i] -= copied[i]
    return -np.dot(m.copy(), copied)
