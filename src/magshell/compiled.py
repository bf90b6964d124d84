"""Compilation of the numerical kernels: once per version of the sources, then read from a cache (`kernel_cache.py`)."""

from __future__ import annotations

import contextlib
import inspect
import os
import pathlib
import sys
from collections.abc import Callable, Iterator
from typing import Any, TypeVar

import numba
from numba.extending import overload

from magshell.files import lock
from magshell.kernel_cache import Store, digest, log

Function = TypeVar("Function", bound=Callable[..., Any])

LAWS = ("material", "coupling")
# Sums may be reordered and fused (vector instructions), but NaN and infinity keep their meaning. Nobody calls from C.
_OPTIONS = {"fastmath": {"reassoc", "contract", "nsz", "arcp"}, "error_model": "numpy", "no_cfunc_wrapper": True}
_LAW_OPTIONS = _OPTIONS | {"_nrt": True}
# By law: what `choose_by_type` compiles for it.
_chosen: list[dict[type, Callable[..., Any]]] = []


def user_cache() -> pathlib.Path | None:
    """Folder of the compiled kernels of all versions; None where the user has no home."""
    if os.environ.get("NUMBA_CACHE_DIR"):
        return pathlib.Path(os.environ["NUMBA_CACHE_DIR"])
    with contextlib.suppress(RuntimeError):
        if sys.platform == "win32":
            return pathlib.Path(os.environ.get("LOCALAPPDATA", pathlib.Path.home() / "AppData" / "Local")) / "magshell"
        return pathlib.Path(os.environ.get("XDG_CACHE_HOME", pathlib.Path.home() / ".cache")) / "magshell"
    return None


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

    def _store(self, laws: tuple[type, ...]) -> Store:
        """Where its machine code is kept; nowhere if it or a law has no source file, for instance typed at a prompt."""
        name = self.py_func.__name__
        shown = f"{name} for {' and '.join(law.__name__ for law in laws)}" if laws else name
        root, folders = user_cache(), []
        try:
            version = digest(_file_of(self.py_func))
            for law in laws:
                functions = [chosen[law] for chosen in _chosen if law in chosen]
                folders.append(f"{law.__module__}.{law.__name__}-{digest(*map(_file_of, (law, *functions)))}")
        except (OSError, TypeError, SyntaxError):
            root, version = None, ""
        return Store(root and root / f"kernels-{version}", folders, name, shown)

    @contextlib.contextmanager
    def _one_process(self, laws: tuple[type, ...]) -> Iterator[None]:
        """Hold back other processes that would compile the same, until they can read it from the cache."""
        with contextlib.ExitStack() as until:
            store = self._store(laws)
            if store.folder is not None and not store.holds_any():
                with contextlib.suppress(OSError):
                    store.folder.mkdir(parents=True, exist_ok=True)
                    file = until.enter_context(open(store.folder / f"{self.py_func.__name__}.lock", "w"))
                    if not lock(file):
                        log.info("waiting for another process that compiles the kernel %s ...", self.py_func.__name__)
                        lock(file, wait=True)
            yield

    def _compile(self, laws: tuple[type, ...]) -> Callable[..., Any]:
        dispatcher = numba.njit(**_OPTIONS, nogil=True)(self.py_func)
        dispatcher._cache = self._store(laws)
        compiled: Callable[..., Any] = dispatcher
        return compiled

    def is_compiled(self, *laws: type) -> bool:
        """Whether it waits in the cache for these laws, so that its first call is quick."""
        return self._store(laws).holds_any()


def _file_of(thing: Any) -> pathlib.Path:
    return pathlib.Path(inspect.getfile(thing))


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

    _chosen.append(implementations)
    overload(generic, strict=False, jit_options=_LAW_OPTIONS)(choose)
