"""Room for OpenBLAS, of which NumPy and SciPy bring a copy each.

OpenBLAS starts its threads when it is loaded and allocates a work array at its first use. Where the memory does not
suffice it tries again for ever, deaf to signals. So both happen here, after a look whether there is room.
"""

from __future__ import annotations

import mmap
from functools import cache

from magshell.processes import threads_of

# Of the address space, measured: a work array has 32 MiB, a thread one of its own and a stack, the library 40 MiB.
WORK_ARRAY, THREAD, LIBRARY = 64 << 20, 48 << 20, 64 << 20
MOST_THREADS = 64


def is_limited() -> bool:
    """Whether the address space of this process has a limit (`ulimit -v`)."""
    try:
        import resource
    except ModuleNotFoundError:
        return False
    return resource.getrlimit(resource.RLIMIT_AS)[0] != resource.RLIM_INFINITY


@cache
def allocate_buffers() -> None:
    """Load both copies and have their work arrays allocated, once in a process.

    Raises
    ------
    MemoryError
        There is no room for them.
    """
    if not is_limited():
        return
    threads = threads_of("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS")
    loading = LIBRARY + THREAD * min(threads, MOST_THREADS)
    _require(loading)
    import numpy as np

    _require(WORK_ARRAY)
    one = np.linalg.inv(np.eye(2))
    _require(loading)
    from scipy.linalg.blas import dtrsv

    _require(WORK_ARRAY)
    dtrsv(one, one[0])


def _require(room: int) -> None:
    try:
        mmap.mmap(-1, room, flags=mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS | getattr(mmap, "MAP_NORESERVE", 0)).close()
    except OSError:
        raise MemoryError("no room for the work arrays of the linear algebra") from None
