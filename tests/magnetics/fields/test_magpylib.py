"""Objects of magpylib as they are: placed, turned, in collections; what cannot be taken says why."""

from __future__ import annotations

import subprocess
import sys

import magpylib
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from magnetics.fields.cases import SHAPES, near
from magshell.errors import InputError
from magshell.magnetics.fields import Cylinder, Loop, MagnetField, Ring

TURN = Rotation.from_rotvec((0.3, -1.0, 0.4))
J = (0.1, 0.5, 1.2)


def placed(make, **values):
    return make(position=(0.05, -0.06, 0.07), orientation=TURN, **values)


OBJECTS = {
    "Cuboid": placed(magpylib.magnet.Cuboid, dimension=(0.02, 0.03, 0.01), polarization=J),
    "Cuboid by magnetisation": placed(magpylib.magnet.Cuboid, dimension=(0.02, 0.03, 0.01), magnetization=(0, 0, 1e6)),
    "Cylinder": placed(magpylib.magnet.Cylinder, dimension=(0.02, 0.03), polarization=J),
    "CylinderSegment": placed(magpylib.magnet.CylinderSegment, dimension=(0.01, 0.02, 0.03, 10, 100), polarization=J),
    "ring": placed(magpylib.magnet.CylinderSegment, dimension=(0.01, 0.02, 0.03, 0, 360), polarization=J),
    "full cylinder": placed(magpylib.magnet.CylinderSegment, dimension=(0, 0.02, 0.03, 0, 360), polarization=J),
    "Sphere": placed(magpylib.magnet.Sphere, diameter=0.02, polarization=J),
    "Tetrahedron": placed(
        magpylib.magnet.Tetrahedron,
        vertices=[(0, 0, 0), (0.02, 0, 0), (0, 0.02, 0), (0, 0, 0.02)],
        polarization=J,
    ),
    "TriangularMesh": placed(
        magpylib.magnet.TriangularMesh.from_ConvexHull,
        points=[(0, 0, 0), (0.02, 0, 0), (0, 0.02, 0), (0, 0, 0.02), (0.02, 0.02, 0.03)],
        polarization=J,
    ),
    "Dipole": placed(magpylib.misc.Dipole, moment=(1, 2, 3)),
    "Circle": placed(magpylib.current.Circle, diameter=0.03, current=12.0),
    "Polyline": placed(
        magpylib.current.Polyline, vertices=[(0, 0, 0), (0.02, 0, 0), (0, 0.02, 0.01), (0, 0, 0)], current=5.0
    ),
}


@pytest.mark.parametrize("name", OBJECTS)
def test_the_same_field(name):
    source = OBJECTS[name]
    found = MagnetField(source).direct(near(), False).flux_density
    # magpylib's μ0 is that of CODATA, 1e-10 from 4π·1e-7, and matters for currents and moments only
    assert np.abs(found - source.getB(near())).max() < 2e-10 * np.abs(found).max()


def test_rings_and_full_cylinders_are_recognised():
    assert isinstance(MagnetField(OBJECTS["ring"]).sources[0].shape, Ring)
    assert isinstance(MagnetField(OBJECTS["full cylinder"]).sources[0].shape, Cylinder)


def test_a_nested_collection_that_was_moved():
    inner = magpylib.Collection(*(source.copy() for source in OBJECTS.values()))
    outer = magpylib.Collection(inner, magpylib.misc.Dipole(moment=(0, 0, 1), position=(0.1, 0, 0)))
    outer.move((0.01, 0.02, 0.3)).rotate_from_angax(40.0, "z")
    field = MagnetField([outer])
    assert len(field.sources) == len(OBJECTS) + 1
    assert np.abs(field.direct(near(), False).flux_density - outer.getB(near())).max() < 1e-10


def test_later_changes_of_the_object_change_nothing():
    magnet = OBJECTS["Cuboid"].copy()
    field = MagnetField([magnet])
    before = field.direct(near(), False).flux_density
    magnet.move((0.0, 0.0, 0.1))
    magnet.polarization = (0.0, 0.0, 0.0)
    assert np.array_equal(MagnetField([OBJECTS["Cuboid"]]).direct(near(), False).flux_density, before)
    assert np.array_equal(field.direct(near(), False).flux_density, before)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: magpylib.magnet.Cuboid(dimension=(1, 1, 1)), "Cuboid: polarization is not set"),
        (lambda: magpylib.magnet.Cylinder(polarization=J), "Cylinder: dimension is not set"),
        (lambda: magpylib.magnet.Sphere(diameter=0.01, polarization=(0, 0, 0)), "polarisation is zero: the magnet has"),
        (lambda: magpylib.current.Circle(diameter=0.01), "Circle: current is not set"),
        (lambda: magpylib.current.Circle(diameter=0.01, current=0.0), "current is 0.0 A"),
        (
            lambda: magpylib.current.Polyline(vertices=[(0, 0, 0), (1, 0, 0), (0, 1, 0)], current=1.0),
            "the polyline is open",
        ),
        (
            lambda: magpylib.misc.Dipole(moment=(0, 0, 1), position=np.zeros((4, 3))),
            "Dipole has a path of 4 places; give it one, and say with Motion",
        ),
        (lambda: magpylib.misc.CustomSource(), "CustomSource is not known here; known are Cuboid"),
        (lambda: magpylib.Sensor(), "Sensor is not known here"),
        (lambda: magpylib.Collection(), "there is no magnet and no coil"),
        (list, "there is no magnet and no coil"),
        (lambda: 3.0, "3.0 is no source and no list of sources"),
        (lambda: ["magnet"], r"magnets\[0\]: str is no source"),
    ],
)
def test_refused(make, message):
    with pytest.raises(InputError, match=message):
        MagnetField(make())


@pytest.mark.parametrize("name", SHAPES)
def test_containing_names_the_magnet(name):
    field = MagnetField([Loop(1.0, 1.0), SHAPES[name]])
    found = set(field.containing(field.ends(1)[1], near(300)).tolist())
    solid = not SHAPES[name].is_coil and name != "dipole"
    assert found == ({-1, 1} if solid else {-1})


def test_magpylib_is_imported_with_the_first_value_only():
    code = (
        "import sys, magshell as ms\n"
        "field = ms.UniformField((0, 0, 1)) + ms.MagnetField(ms.helmholtz(0.1, 1.0))\n"
        "assert 'magpylib' not in sys.modules\n"
        "field.at(field.ends(1)[1], [[0.0, 0.0, 0.0]] @ __import__('numpy').eye(3))\n"
        "assert 'magpylib' in sys.modules\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
