"""The one way in which a function of this project is compiled.

A kernel is a module-level pure function of numbers and arrays. ``NUMBA_DISABLE_JIT=1`` runs
the same source as plain Python: there is no second implementation of any formula. The machine
code is cached beside the source, so only the first run of an installation compiles.

To compile quickly a kernel writes arrays element by element: assigning one array to a slice of
another makes Numba compile its error messages about shapes, which takes seconds.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba

F = TypeVar("F", bound=Callable[..., Any])


def kernel(function: F) -> F:
    """Compile ``function`` on its first call and keep the machine code on disk."""
    return cast(F, numba.njit(cache=True, error_model="numpy")(function))
