"""What the readers of clouds and meshes have in common."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from inspect_cli.errors import EnvironmentFault, GeometryError, InputError, Location, Problem
from inspect_cli.spatial.arrays import Points


@dataclass(frozen=True)
class ReadPoints:
    """Points (n, 3), m, in the file's coordinates, and how many invalid ones it held."""

    points: Points
    dropped: int


def confined(root: Path, file: str) -> Path:
    """The path of a file in the campaign folder; InputError where it leads out of it."""
    path = (root / file).resolve()
    if not path.is_relative_to(root.resolve()):
        raise InputError(
            f"'{file}' lies outside of the campaign folder {root}",
            hint="copy the file into the folder and name it relative to the folder",
        )
    return path


def refused(path: Path, what: str, hint: str) -> GeometryError:
    """The error that names the file, what is wrong with it and what to do."""
    return GeometryError(Problem(what, Location(str(path)), hint))


def require_file(path: Path, suffixes: Collection[str], noun: str) -> str:
    """The file's suffix in lower case; GeometryError if it is not one that can be read."""
    suffix = path.suffix.lower()
    if suffix not in suffixes:
        raise refused(
            path,
            f"'{path.suffix}' is no {noun} that can be read",
            f"convert it to one of {' '.join(suffixes)}",
        )
    if not path.is_file():
        raise refused(path, "there is no such file", f"check the {noun}'s path in the mission")
    if path.stat().st_size == 0:
        raise refused(path, "the file is empty", "export or copy it again")
    return suffix


def truncated(path: Path, promised: str, found: str) -> GeometryError:
    """The error for a file that ends before what its header promises."""
    return refused(
        path,
        f"the file is truncated: its header promises {promised}, it holds {found}",
        "export or copy it again",
    )


@contextmanager
def muted_stderr() -> Iterator[None]:
    """Nothing reaches the process's standard error meanwhile, not from C libraries either.

    The PLY parser within Open3D writes there by itself; what it minds is refused by name anyway.
    """
    try:
        kept = os.dup(2)
    except OSError:  # there is no standard error
        yield
        return
    try:
        with open(os.devnull, "wb") as nowhere:
            os.dup2(nowhere.fileno(), 2)
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)


def open3d() -> Any:
    """The module open3d, imported on first use: it is large, and silent from here on.

    Open3D links to libusb, which a fresh machine lacks; the wheel ``libusb-package`` brings it.
    """
    try:
        import ctypes

        import libusb_package

        ctypes.CDLL(str(libusb_package.get_library_path()))
        import open3d as module
    except (ImportError, OSError) as error:
        raise EnvironmentFault(
            f"open3d cannot be imported: {error}",
            hint="run inspect doctor; reinstalling open3d-cpu and libusb-package usually helps",
        ) from error
    module.utility.set_verbosity_level(module.utility.VerbosityLevel.Error)
    return module
