"""Compilation of the numerical kernels: once per version of the sources, then read from a cache.

Numba invalidates a cached function when *its own* file changes, not when a function that it calls does. The cache
folder is therefore named by a digest of all sources that kernels are made of: any edit of those means a fresh cache.
"""

from __future__ import annotations

import contextlib
import hashlib
import inspect
import os
import sys
import tempfile
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

import numba
from numba.extending import overload

from magshell.files import lock

Function = TypeVar("Function", bound=Callable[..., Any])

LAWS = ("material", "coupling")
KERNEL_FOLDERS = ("shell", "materials", "magnetics")
# Sums may be reordered and fused (vector instructions), but NaN and infinity keep their meaning. Nobody calls from C.
_OPTIONS = {"fastmath": {"reassoc", "contract", "nsz", "arcp"}, "error_model": "numpy", "no_cfunc_wrapper": True}
_LAW_OPTIONS = _OPTIONS | {"_nrt": True}


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
        for source in sorted((Path(__file__).parent / kernels).glob("*.py")):
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


class Kernel:
    """A compiled function of laws and arrays, called as the Python function it was made from.

    Every combination of law types has a cache folder of its own, named by the laws and by a digest of their sources:
    a law outside this package never stands in the way of a process that does not know it.
    """

    def __init__(self, function: Callable[..., Any]) -> None:
        self.py_func = function
        names = list(inspect.signature(function).parameters)
        self._laws = [names.index(name) for name in LAWS if name in names]
        self._compiled: dict[tuple[type, ...], Callable[..., Any]] = {}

    def __call__(self, *arguments: Any) -> Any:
        laws = tuple(type(arguments[position]) for position in self._laws)
        if laws not in self._compiled:
            with self._one_process(laws):
                self._compiled[laws] = self._compile(laws)
                return self._compiled[laws](*arguments)
        return self._compiled[laws](*arguments)

    def _folder(self, laws: tuple[type, ...]) -> Path | None:
        """None where a law has no source file, for instance typed at a prompt."""
        parts = []
        for law in laws:
            try:
                digest = hashlib.sha256(Path(inspect.getfile(law)).read_bytes()).hexdigest()[:12]
            except (OSError, TypeError):
                return None
            parts.append(f"{law.__module__}.{law.__name__}-{digest}")
        return cache_directory().joinpath(*parts)

    @contextlib.contextmanager
    def _one_process(self, laws: tuple[type, ...]) -> Iterator[None]:
        """Hold back other processes that would compile the same, until they can read it from the cache."""
        folder = self._folder(laws)
        if folder is None or self.is_compiled(*laws):
            yield
            return
        folder.mkdir(parents=True, exist_ok=True)
        with open(folder / f"{self.py_func.__name__}.lock", "w") as file:
            lock(file, wait=True)
            yield

    def _compile(self, laws: tuple[type, ...]) -> Callable[..., Any]:
        options = _OPTIONS | {"nogil": True}
        folder = self._folder(laws)
        if folder is None:
            return numba.njit(**options)(self.py_func)
        folder.mkdir(parents=True, exist_ok=True)
        previous = numba.config.CACHE_DIR
        numba.config.CACHE_DIR = str(folder)
        try:
            return numba.njit(cache=True, **options)(self.py_func)
        finally:
            numba.config.CACHE_DIR = previous

    def is_compiled(self, *laws: type) -> bool:
        """Whether it waits in the cache for these laws, so that its first call is quick."""
        folder = self._folder(laws)
        return folder is not None and any(folder.rglob(f"*.{self.py_func.__name__}-*.nbi"))


def allocate(function: Function) -> Function:
    """Compile a function that makes the arrays of a kernel."""
    compiled: Function = numba.njit()(function)
    return compiled


def inline(function: Function) -> Function:
    """Compile a function that only kernels call (it is cached as a part of them).

    It must not allocate: without reference counting, calls and views of arrays cost nothing.
    """
    compiled: Function = numba.njit(**_OPTIONS, _nrt=False)(function)
    return compiled


def also_compiled(function: Callable[..., Any]) -> None:
    """Let kernels call a plain Python function: it is compiled as a part of them."""
    numba.extending.register_jitable(**_LAW_OPTIONS)(function)


def choose_by_type(generic: Callable[..., Any], implementations: dict[type, Callable[..., Any]]) -> None:
    """Let kernels that call `generic(law, …)` use the implementation registered for the NamedTuple type of `law`."""

    def choose(law: Any, *arguments: Any) -> Callable[..., Any] | None:
        return implementations.get(getattr(law, "instance_class", type(None)))

    overload(generic, strict=False, jit_options=_LAW_OPTIONS)(choose)
