"""The gripper's arm on meshes of any size: the problem of all benchmarks."""

from __future__ import annotations

import numpy as np

import magshell as ms
from magshell.shell.elements import ElementType


def arm(along: int, around: int, element: str | ElementType = "quadratic") -> ms.Model:
    """The built-in `gripper` with along × around elements."""
    radius = 12e-3 / (np.pi / 6)
    mesh = ms.mesh.sphere_patch(radius, polar=(15, 165), azimuth=(-15, 15), elements=(along, around))
    rubber = ms.MicropolarNeoHookean(
        shear_modulus=135e3, lame_lambda=3.25e6, coupling_modulus=13.5e3, length_scale=0.09e-3
    )
    shell = ms.Shell(mesh, thickness=0.9e-3, material=rubber, remanence=ms.remanence.meridional(94e-3), element=element)
    field = ms.UniformField([0, 0, 10e-3], stops=[1e-3, 2e-3, 4e-3, 6.8e-3])
    return ms.Model(shell, supports=[ms.Clamp("top")], field=field, probes={"B": (radius, 0, 0)})
