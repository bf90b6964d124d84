"""Meshes from files and into files, and from geometry."""

from __future__ import annotations

from magshell.mesh.files.assembling import FileMesh, Origin
from magshell.mesh.files.cad import from_cad
from magshell.mesh.files.reading import read
from magshell.mesh.files.writing import write

__all__ = ["FileMesh", "Origin", "from_cad", "read", "write"]
