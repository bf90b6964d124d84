"""Memory that a solve will need, told before it is begun, and what the machine has.

Nearly all of it are the factors of the tangent. Their entries are counted, not guessed: a matrix with one unknown per
node, in the same elimination order, is factorised; an entry between two nodes there stands for as many as the product
of their numbers of unknowns.
"""

from __future__ import annotations

import pathlib
import sys

import numpy as np
import scipy.sparse as sp

from magshell.linalg import nested_dissection
from magshell.model import Model
from magshell.numbering import columns_of

# Measured by benchmarks/memory.py: bytes of the program itself, for each element, and for each entry of the factors.
PROGRAM, PER_ELEMENT, PER_ENTRY = 300e6, 100e3, 30.0


def memory_needed(model: Model) -> float:
    """Bytes at the peak of a solve, to a third or so (SuperLU)."""
    return PROGRAM + PER_ELEMENT * len(model.shell.mesh.elements) + PER_ENTRY * factor_entries(model)


def factor_entries(model: Model) -> float:
    """Entries of both triangular factors of the tangent."""
    from scipy.sparse.linalg import splu

    mesh, nodes = model.shell.mesh, len(model.shell.mesh.points)
    elements, corners = mesh.elements.shape
    starts = np.arange(0, elements * corners + 1, corners)
    incidence = sp.csr_array((np.ones(elements * corners), mesh.elements.ravel(), starts), shape=(elements, nodes))
    graph = sp.csr_array(incidence.T @ incidence)
    order = nested_dissection(graph)
    unknowns = (columns_of(model.shell.carriers) & ~model.constraints.fixed).sum(axis=1)[order].astype(float)
    dominant = sp.csc_array(graph[order][:, order] + 1e3 * sp.eye_array(nodes))
    factors = splu(dominant, permc_spec="NATURAL", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    lower = sp.csc_array((np.ones(factors.L.nnz), factors.L.indices, factors.L.indptr), shape=factors.L.shape)
    return float(2.0 * unknowns @ (lower @ unknowns) - unknowns @ unknowns)


def memory_free() -> float | None:
    """Bytes that this process may still take, of the machine or of its share of a cluster's; None: unknown."""
    if sys.platform != "linux":
        return None
    try:
        lines = pathlib.Path("/proc/meminfo").read_text().splitlines()
        machine = next(1024.0 * int(line.split()[1]) for line in lines if line.startswith("MemAvailable"))
        return min([machine, *_shares(pathlib.Path("/proc/self/cgroup").read_text())])
    except (OSError, ValueError, StopIteration):
        return None


def _shares(groups: str) -> list[float]:
    """What is left in each control group that the process is in, and in those around them."""
    left = []
    for line in groups.splitlines():
        _, controllers, group = line.split(":", 2)
        if controllers and "memory" not in controllers.split(","):
            continue
        root = pathlib.Path("/sys/fs/cgroup", "memory" if controllers else "")
        names = ("memory.limit_in_bytes", "memory.usage_in_bytes") if controllers else ("memory.max", "memory.current")
        inside = root / group.lstrip("/")
        for folder in (inside, *inside.parents):
            if folder.is_relative_to(root) and (folder / names[0]).is_file():
                most, used = ((folder / name).read_text().strip() for name in names)
                if most != "max":
                    left.append(float(most) - float(used))
    return left
