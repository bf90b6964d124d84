"""A free element and a free patch have exactly six motions without energy, the rigid ones.

The thickness stretch enters the section by its value only. Functions on eight nodes have more values than four points
can see: the last test shows the spurious modes, which is why every element type has it on the corners.
"""

from __future__ import annotations

import numpy as np
import pytest
from battery import (
    MATERIAL,
    PATCHES,
    SINGLES,
    bowl,
    dense,
    each_element,
    each_material,
    each_mesh,
    example,
    free_body,
    patch,
)

from magshell.equations.instant import Instant
from magshell.shell.elements import QUADRATIC, ElementType
from magshell.shell.elements.definition import gauss

MESHES = SINGLES | PATCHES | {"regular curved patch": lambda: patch((2, 2), surface=bowl)}
# Element types with more than the rigid motions, by name: how many more for one element and for a patch.
SPURIOUS: dict[str, tuple[int, int]] = {}
each_thickness = pytest.mark.parametrize(
    ("thickness", "length"), [(0.15, 0.2), (0.01, 0.001)], ids=["thick", "thin as the source's"]
)


def spectrum(d):
    """Eigenvalues of the undeformed stiffness scaled to a diagonal of one, ascending; the stiffness and the scale."""
    free = d.free.ravel()
    K = dense(d, d.assemble(Instant(d.undeformed(), d.model.loading(0.0))).matrix)[np.ix_(free, free)]
    scale = 1.0 / np.sqrt(np.diag(K))
    return np.linalg.eigvalsh(scale[:, None] * K * scale), K, scale


def rigid_motions(d):
    """The six motions of (u, w, φ, ω, s) on the free unknowns, columns."""
    columns = []
    for axis in np.eye(3):
        motion = np.zeros(d.free.shape)
        motion[:, :3] = axis
        columns.append(motion[d.free])
        motion = np.concatenate(
            [
                np.cross(axis, d.mesh.points),
                np.cross(axis, d.normals),
                np.zeros((len(d.mesh.points), 1)),
                np.broadcast_to(axis, d.mesh.points.shape),
                np.zeros((len(d.mesh.points), 1)),
            ],
            axis=1,
        )
        columns.append(motion[d.free])
    return np.stack(columns, axis=1)


def check_zero_modes(d, count):
    """The first eigenvalue beyond zero falls with the squares of thickness and length scale; round-off does not."""
    eigenvalues, _, _ = spectrum(d)
    largest, thickness = eigenvalues[-1], d.model.shell.thickness
    zero, first = np.abs(eigenvalues[:count]).max(), eigenvalues[count]
    print(f"{len(d.mesh.elements)} elements: {count} modes below {zero / largest:.1e}, next {first / largest:.1e}")
    gap = f"mode {count} {zero:.1e}, mode {count + 1} {first:.1e}, largest {largest:.1e}"
    assert zero < 1e-13 * largest, gap
    assert first > 1e-4 * thickness**2 * largest, gap


@each_element
@each_mesh(MESHES)
@each_thickness
def test_exactly_six(mesh, thickness, length, element):
    more = SPURIOUS.get(element.name, (0, 0))[len(mesh.elements) > 1]
    material = example(MATERIAL)._replace(length_scale=length)
    check_zero_modes(free_body(mesh, material, thickness=thickness, element=element), 6 + more)


@each_material
def test_exactly_six_for_every_law(material):
    check_zero_modes(free_body(PATCHES["curved patch"](), material), 6)


@each_element
@each_mesh(SINGLES | PATCHES)
def test_they_are_the_rigid_motions(mesh, element):
    d = free_body(mesh, element=element)
    eigenvalues, K, scale = spectrum(d)
    motions = rigid_motions(d) / scale[:, None]
    motions /= np.linalg.norm(motions, axis=0)
    forces = np.abs(scale[:, None] * K * scale @ motions).max()
    assert forces < 1e-13 * eigenvalues[-1], f"forces of a rigid motion {forces:.1e}"


def test_without_couple_stress_a_single_element_has_more():
    """Why the length scale must not vanish: with l → 0 the seventh eigenvalue goes to zero with l²."""
    seventh = []
    for length in (1e-2, 1e-3):
        material = example(MATERIAL)._replace(length_scale=length)
        seventh.append(spectrum(free_body(SINGLES["flat"](), material))[0][6])
    assert seventh[1] / seventh[0] < 0.02, f"{seventh}"


FULLY_QUADRATIC = ElementType(name="fully quadratic", rest_nodes=8, stretch_nodes=8, rule=gauss(2))


@pytest.mark.parametrize(
    ("counts", "distortion", "more"),
    [((1, 1), 0.0, 4), ((1, 1), 0.2, 4), ((2, 2), 0.0, 6), ((2, 2), 0.2, 5)],
    ids=["one element", "one distorted element", "patch", "distorted patch"],
)
@each_thickness
def test_thickness_stretch_on_mid_sides_has_spurious_modes(counts, distortion, more, thickness, length):
    """They do not vanish in a patch: it has even more of them."""
    mesh, material = patch(counts, distortion), example(MATERIAL)._replace(length_scale=length)
    check_zero_modes(free_body(mesh, material, thickness=thickness, element=FULLY_QUADRATIC), 6 + more)
    check_zero_modes(free_body(mesh, material, thickness=thickness, element=QUADRATIC), 6)
