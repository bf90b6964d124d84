"""Elimination order of the nodes."""

from __future__ import annotations

import logging

import numpy as np
import scipy.sparse as sp

from magshell.arrays import IntArray

logger = logging.getLogger(__name__)


def nested_dissection(graph: sp.csr_array) -> IntArray:
    """Fill-reducing order of the nodes of a symmetric graph, by METIS.

    Without METIS (pymetis has no wheel for Windows) the reverse Cuthill–McKee order is used, with a warning.
    """
    try:
        import pymetis
    except ImportError:
        from scipy.sparse.csgraph import reverse_cuthill_mckee

        logger.warning("pymetis is not installed: equations in reverse Cuthill–McKee order, factorisation is slower")
        return np.asarray(reverse_cuthill_mckee(graph, symmetric_mode=True), dtype=np.int64)
    loops_removed = sp.coo_array(graph)
    off_diagonal = loops_removed.row != loops_removed.col
    row, column = loops_removed.row[off_diagonal], loops_removed.col[off_diagonal]
    if row.size == 0:
        return np.arange(graph.shape[0])
    adjacency = sp.csr_array((np.ones(row.size, dtype=np.int8), (row, column)), shape=graph.shape)
    order, _ = pymetis.nested_dissection(pymetis.CSRAdjacency(adjacency.indptr, adjacency.indices))
    return np.asarray(order, dtype=np.int64)
