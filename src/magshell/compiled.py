"""Compilation of the numerical kernels: once per version of the sources, then read from a cache.

Numba invalidates a cached function when *its own* file changes, not when a function that it calls does. The cache
folder is therefore named by a digest of all sources that kernels are made of: any edit of those means a fresh cache.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import sys
import tempfile
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

import numba
from numba.extending import overload

Function = TypeVar("Function", bound=Callable[..., Any])

# Sums may be reordered and fused (vector instructions), but NaN and infinity keep their meaning.
KERNEL_FOLDERS = ("shell", "materials", "magnetics")
_FASTMATH = {"reassoc", "contract", "nsz", "arcp"}


def _user_cache() -> Path:
    if os.environ.get("NUMBA_CACHE_DIR"):
        return Path(os.environ["NUMBA_CACHE_DIR"])
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", Path.home() / "AppData" / "Local")) / "magshell"
    return Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "magshell"


@cache
def cache_directory() -> Path:
    """Folder of the compiled kernels of this version of the sources (in the temporary folder if none is writable)."""
    digest = hashlib.sha256(Path(__file__).read_bytes())
    for kernels in KERNEL_FOLDERS:
        for source in sorted((Path(__file__).parent / kernels).rglob("*.py")):
            digest.update(source.read_bytes())
    name = f"kernels-{digest.hexdigest()[:16]}"
    with contextlib.suppress(OSError, RuntimeError):
        folder = _user_cache() / name
        folder.mkdir(parents=True, exist_ok=True)
        if os.access(folder, os.W_OK):
            return folder
    folder = Path(tempfile.gettempdir()) / f"magshell-{os.getpid()}" / name
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def is_compiled(function: Any) -> bool:
    """Whether some specialisation of the kernel waits in the cache, so that its first call is quick."""
    return any(cache_directory().rglob(f"*.{function.py_func.__name__}-*.nbi"))


def jit(function: Function) -> Function:
    """Compile with Numba, cached on disk, releasing the GIL."""
    previous = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = str(cache_directory())
    try:
        compiled: Function = numba.njit(cache=True, nogil=True, fastmath=_FASTMATH, error_model="numpy")(function)
    finally:
        numba.config.CACHE_DIR = previous
    return compiled


def inline(function: Function) -> Function:
    """Compile a small function that is only called from kernels (it is cached as a part of them)."""
    compiled: Function = numba.njit(fastmath=_FASTMATH, error_model="numpy")(function)
    return compiled


def also_compiled(function: Callable[..., Any]) -> None:
    """Let kernels call a plain Python function: it is compiled as a part of them."""
    numba.extending.register_jitable(fastmath=_FASTMATH, error_model="numpy")(function)


def choose_by_type(generic: Callable[..., Any], implementations: dict[type, Callable[..., Any]]) -> None:
    """Let kernels that call `generic(law, …)` use the implementation registered for the NamedTuple type of `law`."""

    def choose(law: Any, *arguments: Any) -> Callable[..., Any] | None:
        return implementations.get(getattr(law, "instance_class", type(None)))

    overload(generic, strict=False, jit_options={"fastmath": _FASTMATH, "error_model": "numpy"})(choose)
