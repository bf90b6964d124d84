"""Compilation of the numerical kernels: once per version of the sources, then read from a cache (`kernel_cache.py`)."""

from __future__ import annotations

import contextlib
import inspect
import os
import pathlib
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from typing import Any, TypeVar

import numba
import numpy as np
from llvmlite import ir
from numba.core import cgutils
from numba.core.ccallback import CFunc
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.extending import intrinsic

from magshell.arrays import FloatArray, IntArray
from magshell.files import lock
from magshell.kernel_cache import WAITING, Store, digest, log

Function = TypeVar("Function", bound=Callable[..., Any])

# Sums may be reordered and fused (vector instructions), but NaN and infinity keep their meaning.
_LAW_OPTIONS = {"fastmath": {"reassoc", "contract", "nsz", "arcp"}, "error_model": "numpy"}
_OPTIONS = _LAW_OPTIONS | {"no_cfunc_wrapper": True}  # nobody calls kernels from C
# Threads compile one after the other: of a law that two have compiled, the code of the first would be freed.
_one_thread = threading.RLock()


def user_cache() -> pathlib.Path | None:
    """Folder of the compiled kernels of all versions; None where the user has no home."""
    if os.environ.get("NUMBA_CACHE_DIR"):
        return pathlib.Path(os.environ["NUMBA_CACHE_DIR"])
    with contextlib.suppress(RuntimeError):
        if sys.platform == "win32":
            return pathlib.Path(os.environ.get("LOCALAPPDATA", pathlib.Path.home() / "AppData" / "Local")) / "magshell"
        return pathlib.Path(os.environ.get("XDG_CACHE_HOME", pathlib.Path.home() / ".cache")) / "magshell"
    return None


class _Kept:
    """What has machine code in the cache, under a digest of its sources."""

    shown: str

    def _store(self) -> Store:
        raise NotImplementedError

    def is_compiled(self) -> bool:
        """Whether it waits in the cache, so that its first use is quick."""
        return self._store().holds_any()

    @contextlib.contextmanager
    def _one_process(self) -> Iterator[None]:
        """Hold back other processes that would compile the same, until they can read it from the cache."""
        with contextlib.ExitStack() as until:
            store = self._store()
            if store.folder is not None and not store.holds_any():
                with contextlib.suppress(OSError):
                    store.folder.mkdir(parents=True, exist_ok=True)
                    file = until.enter_context(open(store.folder / f"{store.name}.lock", "w"))
                    if not lock(file):
                        log.info(WAITING, self.shown)
                        lock(file, wait=True)
            yield


class Kernel(_Kept):
    """A compiled function of arrays, called as the Python function it was made from.

    Parameters
    ----------
    function : callable
    """

    def __init__(self, function: Callable[..., Any]) -> None:
        self.py_func = function
        self.shown = f"the kernel {function.__name__}"
        self._compiled: Callable[..., Any] | None = None

    def __call__(self, *arguments: Any) -> Any:
        if self._compiled is None:
            with _one_thread, self._one_process():
                if self._compiled is not None:
                    return self._compiled(*arguments)
                dispatcher = numba.njit(**_OPTIONS, nogil=True)(self.py_func)
                dispatcher._cache = self._store()
                self._compiled = dispatcher
                return dispatcher(*arguments)
        return self._compiled(*arguments)

    def _store(self) -> Store:
        """Where its machine code is kept; nowhere if it has no source file, for instance typed at a prompt."""
        folder = _cache_folder("kernels", self.py_func)
        return Store(folder, self.py_func.__name__, self.shown)


class Callback(_Kept):
    """A C function of pointers and numbers made of a Python function, which kernels call by its address.

    Nothing of it is in the machine code of a kernel that calls it, so it is compiled once, and the kernel once.

    Parameters
    ----------
    function : callable
        Of a pointer to float64 for each "p" of the signature and a float for each "d"; returns a float. It may
        allocate.
    signature : str
        For instance "ppd".
    owner : type
        The law that it belongs to: names the folder of the cache.
    sources : sequence of callable
        Further functions that it is made of.
    """

    def __init__(
        self, function: Callable[..., float], signature: str, owner: type, sources: Sequence[Callable[..., Any]]
    ) -> None:
        self._function, self._owner, self._sources = function, owner, (owner, *sources)
        kinds = {"p": numba.types.CPointer(numba.float64), "d": numba.float64}
        self._signature = tuple(kinds[letter] for letter in signature), numba.float64
        self.shown = f"the law {owner.__name__}"
        self._compiled: Any = None

    @property
    def address(self) -> int:
        """Address of the machine code in this process; the first use compiles it or reads it from the cache."""
        with _one_thread:
            if self._compiled is None:
                self._compiled = self._made()
            return int(self._compiled.address)

    def _made(self) -> Any:
        """The machine code, which the addresses that were given away need as long as this object lives."""
        with self._one_process():
            made: Any = CFunc(self._function, self._signature, locals={}, options=dict(_LAW_OPTIONS))
            made._cache = self._store()
            made.compile()
            return made

    def _store(self) -> Store:
        folder = _cache_folder(f"law-{self._owner.__module__}.{self._owner.__name__}", *self._sources)
        return Store(folder, self._owner.__name__, self.shown)


def table(callbacks: Sequence[Callback], parameters: Sequence[Any]) -> tuple[IntArray, FloatArray]:
    """Addresses (n,) of callbacks, and their parameters (n, most), padded with zeros."""
    rows = [np.array(tuple(row), dtype=float) for row in parameters]
    padded = np.zeros((len(rows), max(map(len, rows))))
    for target, row in zip(padded, rows, strict=True):
        target[: len(row)] = row
    return np.array([callback.address for callback in callbacks], dtype=np.int64), padded


def _cache_folder(name: str, *sources: Any) -> pathlib.Path | None:
    """Folder of what is made of these functions and classes, in this version; None where one has no source file."""
    root = user_cache()
    try:
        version = digest(*map(_file_of, sources))
    except (OSError, TypeError, SyntaxError):
        return None
    return root and root / f"{name}-{version}"


def _file_of(thing: Any) -> pathlib.Path:
    return pathlib.Path(inspect.getfile(thing))


@intrinsic  # type: ignore[untyped-decorator]
def call(typing: Any, address: Any, *kinds: Any) -> Any:
    """Call the function at an address with the data pointers of arrays, and numbers; it returns a float."""

    def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        double = ir.DoubleType()
        pointers = []
        for kind, value in zip(kinds, cgutils.unpack_tuple(builder, values[1]), strict=True):
            is_array = isinstance(kind, numba.types.Array)
            pointers.append(context.make_array(kind)(context, builder, value).data if is_array else value)
        types = [double.as_pointer() if isinstance(kind, numba.types.Array) else double for kind in kinds]
        function = ir.FunctionType(double, types)
        target = builder.inttoptr(values[0], function.as_pointer())
        return builder.call(target, [builder.bitcast(p, t) for p, t in zip(pointers, types, strict=True)])

    return numba.float64(address, numba.types.StarArgTuple(kinds)), generate


class _Part(JITCodeLibrary):  # type: ignore[misc]
    """Code that is linked into kernels and has no machine code of its own: only kernels are optimised."""

    def add_llvm_module(self, module: Any) -> None:
        """Add it as it is."""
        self._final_module.link_in(module)

    def finalize(self) -> None:
        """Link what the part calls."""
        for library in dict.fromkeys(self._linking_libraries):
            self._reload_init.update(library._reload_init)
            self._final_module.link_in(library._get_module_for_linking(), preserve=True)
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:
        """There is none."""
        self._ensure_finalized()
        return 0

    @property
    def codegen(self) -> Any:
        """Itself: Numba asks it only to set the environment of the machine code."""
        return self

    def set_env(self, name: str, environment: Any) -> None:
        """There is none."""


class _PartCompiler(Compiler):  # type: ignore[misc]
    """Numba's compiler, for parts of kernels."""

    def __init__(self, typing: Any, target: Any, library: Any, *settings: Any) -> None:
        super().__init__(typing, target, _Part(target.codegen(), "part"), *settings)


def allocate(function: Function) -> Function:
    """Compile a function that makes the arrays of a kernel."""
    compiled: Function = numba.njit()(function)
    return compiled


def inline(function: Function) -> Function:
    """Compile a function that only kernels call (it is cached as a part of them).

    It must not allocate: without reference counting, calls and views of arrays cost nothing.
    """
    made: Function = numba.extending.register_jitable(**_OPTIONS, _nrt=False, pipeline_class=_PartCompiler)(function)
    return made


def also_compiled(function: Function) -> Function:
    """Let kernels and laws call a plain Python function: it is compiled as a part of them."""
    made: Function = numba.extending.register_jitable(**_LAW_OPTIONS, forceinline=True)(function)
    return made
