"""Memory that a solve will need, estimated before it starts, and memory that is free.

Nearly all of it are the factors of the tangent. Their entries are counted, not guessed: the symbolic phase of the
multifrontal solver, on nodes of so many unknowns.
"""

from __future__ import annotations

import pathlib
import sys
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp

from magshell.equations.numbering import elimination_order, place_graph
from magshell.linalg import nested_dissection
from magshell.linalg.multifrontal.fronts import fronts_of
from magshell.model.model import Model

# Measured by benchmarks/memory.py: bytes of the program itself, for each element, and for each entry of the factors.
PROGRAM, PER_ELEMENT = 300e6, 100e3
PER_ENTRY = {"multifrontal": 9.0, "superlu": 30.0, "pardiso": 16.0}


class Need(NamedTuple):
    """What a solve will take.

    Attributes
    ----------
    memory : float
        Bytes at its peak, to a third or so.
    factors : float
        Entries of both triangular factors of the tangent.
    tangent : float
        Entries of the tangent.
    """

    memory: float
    factors: float
    tangent: float


def need_of(model: Model, linear_solver: str = "multifrontal") -> Need:
    """What a solve of a model will take."""
    rows, elements = model.rows, len(model.shell.mesh.elements)
    graph = place_graph(rows, [rows.elements], joined=True)
    order = elimination_order(rows, [rows.elements], nested_dissection)
    free = (rows.carried & ~model.constraints.fixed).sum(axis=1)
    unknowns = np.bincount(rows.of, free, minlength=rows.places).astype(np.int64)
    order = order[unknowns[order] > 0]
    ordered = sp.csc_array(graph[order][:, order])
    ordered.sort_indices()
    widths = unknowns[order]
    fronts, _ = fronts_of(ordered.indptr.astype(np.int64), ordered.indices.astype(np.int64), widths)
    entries = fronts.lower[-1] + fronts.upper[-1]
    tangent = widths[ordered.indices] @ np.repeat(widths, np.diff(ordered.indptr))
    memory = PROGRAM + PER_ELEMENT * elements + PER_ENTRY[linear_solver] * entries
    return Need(float(memory), float(entries), float(tangent))


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
