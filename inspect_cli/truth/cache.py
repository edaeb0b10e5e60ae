"""Arrays that took long to compute, kept on disk for the next run.

They lie in ``$INSPECT_CACHE_DIR``, or ``inspect`` in ``$XDG_CACHE_HOME``, or ``~/.cache/inspect``,
named by a hash of everything that they were computed from, and begin with a hash of their bytes. A
file that is damaged is computed anew; one that cannot be written or read is done without. What
comes from the cache is byte for byte what was computed.
"""

from __future__ import annotations

import hashlib
import io
import os
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Final

import numpy as np

from inspect_cli.errors import EnvironmentFault
from inspect_cli.files import write_whole
from inspect_cli.spatial.arrays import Matrix

DIGEST: Final = 32
"""Bytes of SHA-256."""


def cache_folder(environment: Mapping[str, str]) -> Path | None:
    """Where results are kept; None for a user without a home."""
    if environment.get("INSPECT_CACHE_DIR"):
        return Path(environment["INSPECT_CACHE_DIR"])
    if environment.get("XDG_CACHE_HOME"):
        return Path(environment["XDG_CACHE_HOME"]) / "inspect"
    try:
        return Path.home() / ".cache" / "inspect"
    except RuntimeError:
        return None


def kept(kind: str, inputs: str, compute: Callable[[], Matrix]) -> Matrix:
    """What ``compute`` returns, from the cache if ``inputs`` were computed before.

    Args:
        kind: names the file, beside the hash.
        inputs: everything that the result depends on, in one text.
        compute: called without arguments where the cache has nothing.
    """
    folder = cache_folder(os.environ)
    if folder is None:
        return compute()
    path = folder / f"{kind}-{hashlib.sha256(inputs.encode()).hexdigest()[:32]}"
    found = _read(path)
    if found is not None:
        return found
    result = compute()
    with suppress(EnvironmentFault):
        write_whole(path, _packed(result))
    return result


def _packed(array: Matrix) -> bytes:
    buffer = io.BytesIO()
    np.save(buffer, array, allow_pickle=False)
    data = buffer.getvalue()
    return hashlib.sha256(data).digest() + data


def _read(path: Path) -> Matrix | None:
    try:
        content = path.read_bytes()
    except OSError:
        return None
    digest, data = content[:DIGEST], content[DIGEST:]
    if hashlib.sha256(data).digest() != digest:
        return None
    array: Matrix = np.load(io.BytesIO(data), allow_pickle=False)
    return array
