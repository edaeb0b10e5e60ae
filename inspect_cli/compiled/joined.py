"""Bound kernels that always follow each other, as one call of machine code.

An ordinary call of a compiled function unpacks each of its arrays, 0.07 µs apiece: a microsecond
for a kernel of a dozen arrays, and the interpreter's own work on top. Here a small function,
written in LLVM's language, holds the addresses and shapes of all arrays as constants and calls one
kernel after the other. A call of it from Python costs 0.15 µs, however many kernels it holds.

The kernels stay those that ``kernel`` compiled and cached; joining five of them takes 20 ms. With
``NUMBA_DISABLE_JIT=1`` they are called one by one. A kernel that is joined must not raise: nobody
would hear it.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Sequence
from itertools import count, groupby
from typing import Any, cast

import llvmlite.ir
import numba
import numpy as np

from inspect_cli.compiled import Bound

_NUMBA: Any = numba  # much of it has no annotations
_IR: Any = llvmlite.ir
_numbers = count()


def joined(*calls: Callable[[], object]) -> Callable[[], object]:
    """One function that makes all calls in their order and drops what they return.

    Neighbours that are bound kernels become one call of machine code. Their arrays have to stay
    where they are in memory; the function keeps them alive.
    """
    parts: list[Callable[[], object]] = []
    for compiled, group in groupby(calls, _is_compiled):
        neighbours = list(group)
        parts += [_machine_code(neighbours)] if compiled else neighbours

    def one_by_one() -> None:
        for part in parts:
            part()

    return parts[0] if len(parts) == 1 else one_by_one


def _is_compiled(call: Callable[[], object]) -> bool:
    return isinstance(call, Bound) and call.overload is not None


def _machine_code(calls: Sequence[Any]) -> Callable[[], None]:
    """A function of machine code that calls bound kernels."""
    with _NUMBA.core.compiler_lock.global_compiler_lock:
        name = f"joined_{next(_numbers)}"
        module = _IR.Module(name)
        entry = _IR.Function(module, _IR.FunctionType(_IR.VoidType(), []), name)
        builder = _IR.IRBuilder(entry.append_basic_block())
        for call in calls:
            _add_call(module, builder, call.overload, call.args)
        builder.ret_void()
        library = calls[0].overload.library.codegen.create_library(name)
        library.add_ir_module(module)
        library.finalize()
        function: Any = ctypes.PYFUNCTYPE(None)(library.get_pointer_to_function(name))
    function.keeps = (library, calls)
    return cast(Callable[[], None], function)


def _add_call(module: Any, builder: Any, overload: Any, arguments: Sequence[object]) -> None:
    """Write the call of a compiled function; it is found by its name among what is loaded."""
    context, about = overload.target_context, overload.fndesc
    overload.library.get_pointer_to_function(about.llvm_func_name)  # loads it
    kinds = about.argtypes
    values = [_constant(context, *pair) for pair in zip(kinds, arguments, strict=True)]
    callee = context.declare_function(module, about)
    context.call_conv.call_function(builder, callee, about.restype, kinds, values)


def _constant(context: Any, kind: Any, value: Any) -> Any:
    """An argument as Numba passes it: an array by its address, shape and strides."""
    layout = context.get_value_type(kind)
    if isinstance(value, np.ndarray):
        none = _IR.Constant(layout.elements[0], None)
        size, word = layout.elements[2], layout.elements[5].element
        address = _IR.Constant(size, value.ctypes.data).inttoptr(layout.elements[4])
        lengths = (_IR.Constant.literal_array([_IR.Constant(word, n) for n in numbers])
                   for numbers in (value.shape, value.strides))  # fmt: skip
        sizes = (_IR.Constant(size, n) for n in (value.size, value.itemsize))
        return _IR.Constant.literal_struct([none, none, *sizes, address, *lengths])
    if isinstance(value, tuple):
        parts = zip(kind, value, strict=True)
        return _IR.Constant.literal_struct([_constant(context, *part) for part in parts])
    return context.get_constant(kind, value)
