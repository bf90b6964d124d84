"""Every magnet, coil and field, one of each: who joins a list joins all tests over it."""

from __future__ import annotations

import numpy as np

from magshell.magnetics import fields
from magshell.magnetics.fields import (
    CoilSystem,
    FunctionField,
    GradientField,
    MagnetField,
    Motion,
    SampledField,
    Source,
)

J = (0.3, -0.2, 1.3)
TETRAHEDRON = ([(0, 0, 0), (0.02, 0, 0), (0, 0.02, 0), (0, 0, 0.015)], [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)])

SHAPES = {
    "cuboid": fields.Cuboid((0.02, 0.015, 0.01), J),
    "cylinder": fields.Cylinder(0.02, 0.015, (0.0, 0.0, 1.3)),
    "cylinder, magnetised across": fields.Cylinder(0.02, 0.015, J),
    "ring": fields.Ring(0.008, 0.02, 0.01, (0.0, 0.0, 1.0)),
    "cylinder-segment": fields.CylinderSegment(0.01, 0.024, 0.01, np.deg2rad([-20.0, 75.0]), J),
    "sphere": fields.Sphere(0.02, J),
    "dipole": fields.Dipole((0.5, -1.0, 2.0)),
    "polyhedron": fields.Polyhedron(*TETRAHEDRON, J),
    "loop": fields.Loop(0.03, 50.0, 3),
    "polygon": fields.Polygon([(0.01, 0, 0), (0, 0.012, 0.004), (-0.01, 0, 0), (0, -0.01, -0.003)], 40.0),
    "solenoid": fields.Solenoid(0.02, 0.03, 5.0, 200, 2, 0.002),
    "rectangular": fields.RectangularWinding((0.03, 0.02), 0.01, 5.0, 100),
}

MOTION = Motion((1.0, 0.5), [(0.01, 0.0, -0.004), (0.002, 0.003, 0.0)], (1, 2, -1), (0.4, -0.9), (0.01, 0.0, 0.02))


def harmonic(points):
    """The gradient of a harmonic polynomial, with B of a few mT over 0.1 m."""
    x, y, z = points.T
    return np.stack(
        [0.05 * y + 0.2 * y * z + 0.01, 0.05 * x + 0.2 * x * z, 0.2 * x * y + 3.0 * (x**2 - y**2) * 0.0], axis=1
    )


def sampled(function=harmonic, step=0.01, motion=None):
    """A field on a grid over a cube of 0.2 m about the origin."""
    axes = [np.arange(-0.1, 0.1 + 0.5 * step, step)] * 3
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    return SampledField(axes, function(grid.reshape(-1, 3)).reshape(grid.shape), motion or Motion())


def magnets(motion=None, spacing=None, depth=0.03):
    """A turned cuboid and a loop beside it."""
    pair = (
        Source(SHAPES["cuboid"], (0.01, 0.0, -depth), (0.3, -0.5, 0.2)),
        Source(SHAPES["loop"], (-0.04, 0.0, -depth - 0.02), (0.0, 1.0, 0.0)),
    )
    return MagnetField(pair, motion or Motion(), spacing)


FIELDS = {
    "uniform": fields.UniformField((1e-3, 0, 2e-3), history=(1, 2), rotation_axis=(0, 1, 1), rotation=(0.3, 1.0)),
    "magnets": magnets(MOTION),
    "magnets by splines": magnets(MOTION, 2e-3, 0.06),
    "gradient": GradientField([(0.1, 0.2, 0), (0.2, -0.3, 0.1), (0, 0.1, 0.2)], (1e-3, 0, 0), (0.01, 0, 0), MOTION),
    "function": FunctionField(harmonic, 0.1, motion=MOTION),
    "sampled": sampled(motion=MOTION),
    "coils": CoilSystem(np.random.default_rng(0).normal(size=(8, 5)), np.random.default_rng(1).normal(size=(2, 5))),
}
FIELDS["sum"] = FIELDS["uniform"] + FIELDS["magnets"] + FIELDS["gradient"]


def around(shape, count=60, seed=0):
    """Points outside a shape, from near its surface to some sizes away."""
    random, size = np.random.default_rng(seed), shape.size or 0.01
    points = random.normal(size=(40 * count, 3))
    points *= size * random.uniform(0.2, 4.0, (len(points), 1)) / np.linalg.norm(points, axis=1, keepdims=True)
    keep = (shape.distance(points) > 0.1 * size) & ~shape.inside(points)
    return points[keep][:count]


def near(count=12, seed=0):
    """Points within 20 mm of the origin."""
    return np.random.default_rng(seed).uniform(-0.02, 0.02, (count, 3))
