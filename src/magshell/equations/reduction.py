r"""The tangent of some unknowns from that of more: K = Tᵀ K' T with constant T, value by value.

u beyond a jump of a periodic cell is that of another node and the jump, so that its columns and rows of the tangent
count for both. What K' has at (i, j) is at (r, c) of K with the factor T_ir T_jc: the values of K are those of K' times
a matrix that is made once.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from magshell.arrays import FloatArray


class Reduction:
    """From the values of a matrix (m, m) to the matrix (n, n) of fewer unknowns.

    Parameters
    ----------
    matrix : csc_array, shape (m, m)
        Its pattern counts.
    following : csr_array, shape (m, n)
        T.
    """

    def __init__(self, matrix: sp.csc_array, following: sp.csr_array) -> None:
        m, n = following.shape
        T, count = following, np.diff(following.indptr)
        i, j = matrix.indices, np.repeat(np.arange(m), np.diff(matrix.indptr))
        several = count[i] * count[j]
        of = np.repeat(np.arange(len(i)), several)
        within = np.arange(len(of)) - np.repeat(np.cumsum(several) - several, several)
        row = T.indptr[i[of]] + within // count[j[of]]
        column = T.indptr[j[of]] + within % count[j[of]]
        places, at = np.unique(T.indices[column].astype(np.int64) * n + T.indices[row], return_inverse=True)
        self._sums = sp.csr_array((T.data[row] * T.data[column], (at, of)), shape=(len(places), len(i)))
        indptr = np.searchsorted(places, np.arange(n + 1) * n)
        kind = matrix.indices.dtype
        self._reduced = sp.csc_array((np.zeros(len(places)), (places % n).astype(kind), indptr.astype(kind)), (n, n))

    def of(self, values: FloatArray) -> sp.csc_array:
        """K from the values of K'; the next call overwrites it."""
        self._reduced.data[:] = self._sums @ values
        return self._reduced
