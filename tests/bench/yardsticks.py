"""Fixed work to measure a machine by. It must not change, or the limits mean nothing.

``reference_workload_s`` is numerical work such as a survey's evaluation is made of: sorting,
neighbours, a sparse solution, and the writing of numbers as text, in about equal parts.
``python -m tests.bench.yardsticks`` compiles ``reference_kernel`` in a fresh process and prints
the seconds.
"""

from __future__ import annotations

import resource
import subprocess
import sys
from collections.abc import Mapping, Sequence
from time import process_time

import numba
import numpy as np
from scipy.sparse import diags_array, kron
from scipy.sparse.linalg import splu
from scipy.spatial import cKDTree

WORKLOAD = "a fixed workload of NumPy, SciPy and Python"
COMPILATION = "the compilation of a fixed kernel, eight times"
COPIES = 8


def reference_workload_s() -> float:
    """CPU seconds of the fixed workload."""
    begun = process_time()
    rng = np.random.default_rng(0)
    for _ in range(10):
        np.sort(rng.standard_normal(500_000))
    places = rng.uniform(0.0, 100.0, (100_000, 2))
    cKDTree(places).query(places, k=8)
    n = 160
    line = diags_array([-1.0, 2.05, -1.0], offsets=[-1, 0, 1], shape=(n, n))
    eye = diags_array([1.0], offsets=[0], shape=(n, n))
    splu((kron(line, eye) + kron(eye, line)).tocsc()).solve(np.ones(n * n))
    ",".join(f"{value:.3f}" for value in places.ravel().tolist())
    return process_time() - begun


def reference_kernel(rows, rotations, out):
    """Work on structured rows and small matrices, as a flight's kernels do it."""
    for i in range(rows.shape[0]):
        row = rows[i]
        for j in range(3):
            total = 0.0
            for k in range(3):
                total += rotations[i, j, k] * row["force"][k]
            out[i, j] = total
        norm = np.sqrt(out[i, 0] ** 2 + out[i, 1] ** 2 + out[i, 2] ** 2)
        if norm > row["limit"]:
            for j in range(3):
                out[i, j] *= row["limit"] / norm
        row["angle"] = np.arctan2(out[i, 1], out[i, 0]) + np.exp(-norm)
    return np.abs(out).max()


def compilation_s() -> float:
    """CPU seconds of the compilations in this process, which must be fresh."""
    kind = np.dtype([("force", np.float64, 3), ("limit", np.float64), ("angle", np.float64)])
    rows, rotations = np.zeros(2, kind), np.zeros((2, 3, 3))
    begun = process_time()
    for _ in range(COPIES):
        numba.njit(error_model="numpy")(reference_kernel)(rows, rotations, np.zeros((2, 3)))
    return process_time() - begun


def child_s(command: Sequence[str], environment: Mapping[str, str] | None = None) -> float:
    """CPU seconds of a fresh process, its own children included; it must succeed."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, env=environment, check=True, capture_output=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


if __name__ == "__main__":
    sys.stdout.write(f"{compilation_s()}\n")
