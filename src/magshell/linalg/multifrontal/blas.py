"""Dense products and triangular solves by SciPy's BLAS, called from compiled code.

The routines are called by address, which reaches the kernels at run time, so that these can be cached. Matrices are
stored by columns.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import get_cython_function_address, intrinsic

from magshell.arrays import AnyArray
from magshell.compiled import inline

NO, TRANSPOSED, LOWER, UPPER, RIGHT, LEFT, UNIT = (np.uint8(ord(letter)) for letter in "NTLURLU")


class Blas(NamedTuple):
    """Addresses of the routines of one precision, and the number one in it."""

    gemm: int
    trsm: int
    one: Any


class Panel(NamedTuple):
    """A matrix in memory: address of its first entry, rows, columns, and entries from one column to the next."""

    address: int
    rows: int
    columns: int
    stride: int


def routines(dtype: np.dtype[Any]) -> Blas:
    """The routines for float64 or float32."""
    letter = {"float64": "d", "float32": "s"}[dtype.name]
    addresses = [get_cython_function_address("scipy.linalg.cython_blas", letter + name) for name in ("gemm", "trsm")]
    return Blas(addresses[0], addresses[1], dtype.type(1.0))


@intrinsic  # type: ignore[untyped-decorator]
def _call(typing: Any, address: Any, arguments: Any) -> Any:
    """Call a Fortran routine: 64-bit integers are addresses of its arrays, everything else is passed by reference."""
    signature = types.void(types.int64, arguments)

    def generate(context: Any, builder: Any, sig: Any, values: Any) -> Any:
        byte = ir.IntType(8).as_pointer()
        pointers = []
        for position, kind in enumerate(arguments.types):
            value = builder.extract_value(values[1], position)
            if kind == types.int64:
                pointers.append(builder.inttoptr(value, byte))
            else:
                pointers.append(builder.bitcast(cgutils.alloca_once_value(builder, value), byte))
        function = ir.FunctionType(ir.VoidType(), [byte] * len(pointers))
        builder.call(builder.inttoptr(values[0], function.as_pointer()), pointers)
        return context.get_dummy_value()

    return signature, generate


@inline
def address_of(values: AnyArray) -> Any:
    """Address of the first entry of an array."""
    return np.int64(values.ctypes.data)


@inline
def subtract_product(blas: Blas, A: Panel, B: Panel, transposed: bool, C: Panel) -> None:
    """C -= A B, or C -= A Bᵀ."""
    inner = np.int32(A.columns)
    form = TRANSPOSED if transposed else NO
    _call(
        blas.gemm,
        (
            NO, form, np.int32(C.rows), np.int32(C.columns), inner, -blas.one, A.address, np.int32(A.stride),
            B.address, np.int32(B.stride), blas.one, C.address, np.int32(C.stride),
        ),
    )  # fmt: skip


@inline
def divide_by_upper(blas: Blas, U: Panel, X: Panel) -> None:
    """X := X U⁻¹."""
    _solve(blas, RIGHT, UPPER, NO, NO, U, X)


@inline
def divide_by_unit_lower(blas: Blas, L: Panel, X: Panel) -> None:
    """X := L⁻¹ X, ones on the diagonal of L."""
    _solve(blas, LEFT, LOWER, NO, UNIT, L, X)


@inline
def divide_by_unit_lower_transposed(blas: Blas, L: Panel, X: Panel) -> None:
    """X := X L⁻ᵀ, ones on the diagonal of L."""
    _solve(blas, RIGHT, LOWER, TRANSPOSED, UNIT, L, X)


@inline
def _solve(blas: Blas, side: Any, triangle: Any, form: Any, diagonal: Any, T: Panel, X: Panel) -> None:
    _call(
        blas.trsm,
        (
            side, triangle, form, diagonal, np.int32(X.rows),
            np.int32(X.columns), blas.one, T.address, np.int32(T.stride), X.address, np.int32(X.stride),
        ),
    )  # fmt: skip
