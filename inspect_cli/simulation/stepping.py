"""Steps of the physics from within kernels, by pointers to MuJoCo's own functions.

A kernel takes model and data as the addresses that their Python objects state, and calls
``mj_step`` and ``mj_kinematics`` of the very library that those objects belong to: between two
instants at which Python has something to do the physics does not return to it. The functions are
symbols that LLVM resolves when machine code is loaded, so the code can be cached. With
``NUMBA_DISABLE_JIT=1`` the same kernels call the same functions by ctypes.

An error of MuJoCo that is no warning (its memory ran out) ends the process, as it does in C.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from pathlib import Path
from typing import Any

import llvmlite.binding
import mujoco
import numba

from inspect_cli.compiled import kernel
from inspect_cli.errors import EnvironmentFault
from inspect_cli.spatial.arrays import Indices

_NUMBA: Any = numba  # much of it has no annotations


def _library() -> str:
    """The shared library of the installed MuJoCo."""
    folder = Path(mujoco.__file__).parent
    names = ("libmujoco*.so*", "libmujoco*.dylib", "mujoco.dll")
    found = [file for name in names for file in folder.glob(name)]
    if not found:
        raise EnvironmentFault(
            f"{folder} holds no shared library of MuJoCo", hint="reinstall the package mujoco"
        )
    return str(found[0])


def _function(name: str) -> Callable[[int, int], None]:
    """A function of (model, data) of MuJoCo's library, for kernels."""
    if _NUMBA.config.DISABLE_JIT:
        plain: Callable[[int, int], None] = ctypes.CFUNCTYPE(
            None, ctypes.c_void_p, ctypes.c_void_p
        )((name, ctypes.CDLL(_library())))
        return plain
    llvmlite.binding.load_library_permanently(_library())
    types = _NUMBA.types
    compiled: Callable[[int, int], None] = types.ExternalFunction(
        name, types.void(types.int64, types.int64)
    )
    return compiled


mj_step = _function("mj_step")
mj_kinematics = _function("mj_kinematics")


@kernel
def advance(model: int, data: int, steps: Indices) -> None:
    """Let ``steps[0]`` steps of physics pass with what is applied now."""
    for _ in range(steps[0]):
        mj_step(model, data)


@kernel
def refresh(model: int, data: int) -> None:
    """Bring the places of bodies, geoms and sites up to date with the positions of the joints."""
    mj_kinematics(model, data)
