"""Meshes of 8-node quadrilaterals with named groups: made by a generator, or from arrays."""

from __future__ import annotations

from magshell.mesh.generators import annulus, cylinder, rectangle, sphere_patch
from magshell.mesh.mesh import Mesh
from magshell.mesh.multiblock import blocks

__all__ = ["Mesh", "annulus", "blocks", "cylinder", "rectangle", "sphere_patch"]
