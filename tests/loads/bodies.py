"""Shells under dead loads."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

import magshell as ms
from magshell.mesh import Mesh

RADIUS = 22.918e-3


def grouped(mesh: Mesh) -> Mesh:
    """The same mesh with more groups: of elements, of corner and mid-side nodes, of mid-side nodes, and a corner."""
    mid_sides = np.setdiff1d(np.arange(len(mesh.points)), mesh.corner_nodes)
    nodes = {
        "scattered": np.sort(np.append(mesh.corner_nodes[1::3], mid_sides[::4])),
        "mid-sides": mid_sides[:3],
        "corner": mesh.corner_nodes[:1],
    }
    return Mesh(mesh.points, mesh.elements, {"half": np.arange(len(mesh.elements))[::2]}, mesh.edge_groups, nodes)


def arm(
    loads: Sequence[Any], field: float = 0.0, stops: Sequence[float] = (), micro_rotation: bool = True, **shell: Any
) -> ms.Model:
    """Part of a sphere, clamped near the pole, in a coarse mesh; magnetised along its meridians."""
    mesh = grouped(ms.mesh.sphere_patch(RADIUS, polar=(15, 165), azimuth=(-15, 15), elements=(6, 2)))
    end = np.radians(165)
    mesh = mesh.select_nodes("tip", RADIUS * np.sin(end), 0.0, RADIUS * np.cos(end))
    micropolar = (13.5e3, 9e-5) if micro_rotation else (0.0, 0.0)
    material, shell["micro_rotation"] = ms.MicropolarNeoHookean(135e3, 3.25e6, *micropolar), micro_rotation
    body = ms.Shell(mesh, 0.9e-3, material, ms.remanence.meridional(94e-3), density=1100.0, **shell)
    return ms.Model(body, [ms.Clamp("top")], ms.UniformField([0, 0, field], stops), loads=loads)


def mixed_loads() -> list[Any]:
    """Loads of both kinds on groups of all kinds, which bend the arm by about half its radius."""
    return [
        ms.Force("bottom", (1e-3, 2e-4, 3e-4)),
        ms.Moment("bottom", (2e-6, -1e-5, 3e-6)),
        ms.Force("half", (-2e-4, 3e-4, 5e-4)),
        ms.Moment("half", (1e-6, 2e-6, -3e-6)),
        ms.Force("scattered", (1e-4, 1e-4, -2e-4)),
        ms.Moment("scattered", (3e-6, 1e-6, 2e-6)),
    ]


def loads_of_every_kind(micro_rotation: bool = True) -> list[Any]:
    """As `mixed_loads`, of all kinds; some need a micro-rotation."""
    loads = [
        ms.Moment("tip", (0, -5e-6, 0)),
        ms.Traction("half", (-0.5, 0.7, 1.2)),
        ms.Pressure("half", 1.0),
        ms.Gravity((-0.5, 0.3, 1.0)),
    ]
    if micro_rotation:
        loads.append(ms.Moment("bottom", (1e-6, -5e-6, 2e-6)))
        loads.append(ms.Moment("half", (1e-6, 2e-6, -3e-6)))
        loads.append(ms.Moment("scattered", (3e-6, 1e-6, 2e-6), follower=True))
        loads.append(ms.Force("bottom", (1e-4, 1e-4, 2e-4), follower=True))
    return loads
