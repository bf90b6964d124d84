"""Dense products by SciPy's BLAS, called from compiled code.

The routine is called by its address, which reaches the kernels at run time, so that these can be cached. Matrices are
stored by columns.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import get_cython_function_address, intrinsic
from numba.np.arrayobj import populate_array

from magshell.compiled import inline

# Bytes of a number.
WIDTH = 8

AS_IT_IS, TRANSPOSED = (np.uint8(ord(letter)) for letter in "NT")


class Panel(NamedTuple):
    """A matrix in memory: address of its first entry, rows, columns, and entries from one column to the next."""

    address: int
    rows: int
    columns: int
    stride: int


def address_of_product() -> int:
    """Of BLAS's dgemm."""
    return int(get_cython_function_address("scipy.linalg.cython_blas", "dgemm"))


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


@intrinsic  # type: ignore[untyped-decorator]
def address_of(typing: Any, values: Any) -> Any:
    """Address of the first entry of an array."""

    def generate(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        data = context.make_array(values)(context, builder, given[0]).data
        return builder.ptrtoint(data, ir.IntType(64))

    return types.int64(values), generate


@intrinsic  # type: ignore[untyped-decorator]
def view(typing: Any, address: Any, start: Any, size: Any) -> Any:
    """So many entries of a panel or of an array from one on, (size,), by the address of the first of all.

    Unlike a slice it costs next to nothing to compile, and indices are not checked.
    """
    kind = types.Array(types.float64, 1, "C")

    def generate(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        made = context.make_array(kind)(context, builder)
        width = context.get_constant(types.intp, WIDTH)
        data = builder.gep(builder.inttoptr(given[0], made.data.type), [given[1]])
        populate_array(made, data, shape=[given[2]], strides=[width], itemsize=width, meminfo=None)
        return made._getvalue()

    return kind(types.int64, types.int64, types.int64), generate


@inline
def subtract_product(dgemm: int, A: Panel, B: Panel, form: np.uint8, C: Panel) -> None:
    """C -= A B, or C -= A Bᵀ; `form` is AS_IT_IS or TRANSPOSED."""
    if A.columns == 0 or C.rows == 0 or C.columns == 0:
        return
    inner = np.int32(A.columns)
    _call(
        dgemm,
        (
            AS_IT_IS, form, np.int32(C.rows), np.int32(C.columns), inner, -1.0, A.address, np.int32(A.stride),
            B.address, np.int32(B.stride), 1.0, C.address, np.int32(C.stride),
        ),
    )  # fmt: skip
