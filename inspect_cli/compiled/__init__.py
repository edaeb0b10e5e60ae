"""The one way in which a function of this project is compiled.

A kernel is a module-level pure function of numbers and arrays. ``NUMBA_DISABLE_JIT=1`` runs
the same source as plain Python: there is no second implementation of any formula. The machine
code is cached beside the source, so only the first run of an installation compiles.

To compile quickly a kernel writes arrays element by element: assigning one array to a slice of
another makes Numba compile its error messages about shapes, which takes seconds.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, TypeVar, cast

import numba

F = TypeVar("F", bound=Callable[..., Any])
Number = float | int | bool
_NUMBA: Any = numba  # much of it has no annotations


def kernel(function: F) -> F:
    """Compile ``function`` on its first call and keep the machine code on disk."""
    return cast(F, numba.njit(cache=True, error_model="numpy")(function))


class Bound(partial[Any]):
    """A kernel with arguments that it keeps."""

    overload: Any = None
    """What Numba compiled for the types of the arguments; None where nothing is compiled."""


def bound(function: Callable[..., Any], *arguments: object, then: tuple[Number, ...] = ()) -> Bound:
    """A kernel with its first arguments fixed; ``then`` are examples of those that a call adds.

    An ordinary call looks up the type of every argument, which costs 0.4 µs for a structured
    array: more than most kernels compute. Here the types are resolved once, so the arguments are
    what lives as long as the caller and is changed in place: arrays, and numbers that stay.
    A call converts what it adds to the types of the examples. Kernels that always follow each
    other become one call by ``compiled.joined``.
    """
    if not isinstance(function, _NUMBA.core.dispatcher.Dispatcher):
        return Bound(function, *arguments)
    signature = tuple(_NUMBA.typeof(value) for value in (*arguments, *then))
    call = Bound(function.compile(signature), *arguments)
    call.overload = function.overloads[signature]
    return call
