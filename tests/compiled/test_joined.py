"""Kernels that are joined do what they do one by one, to the last bit."""

from __future__ import annotations

import gc
import os
import subprocess
import sys
from typing import NamedTuple

import numpy as np

from inspect_cli.compiled import bound, kernel
from inspect_cli.compiled.joined import joined

ROW = np.dtype([("t_s", "<f8"), ("p", "<f8", (3,))])


class Pair(NamedTuple):
    """Arrays that a kernel takes as one argument."""

    a: np.ndarray
    n: np.ndarray


@kernel
def scale(x: np.ndarray, factor: float, row: np.ndarray) -> float:
    """x ← factor x, noted in the row (1,)."""
    for i in range(x.shape[0]):
        x[i] *= factor
        row[0]["p"][i] = x[i]
    return float(x[0])


@kernel
def shift(matrix: np.ndarray, pair: Pair, on: bool) -> None:
    """Add the column of a strided matrix, and count."""
    for i in range(3):
        if on:
            pair.a[i] += matrix[i, 1]
    pair.n[0] += 1


def setting() -> tuple[np.ndarray, np.ndarray, np.ndarray, Pair]:
    """Arrays of every kind: plain, structured, a view with strides, one within a tuple."""
    x, row = np.array([1.0, 2.0, 3.0]), np.zeros(1, ROW)
    matrix = np.arange(24.0).reshape(3, 8)[:, ::4]
    return x, row, matrix, Pair(x, np.zeros(1, np.int32))


def one_by_one_and_joined(between: bool) -> tuple[np.ndarray, np.ndarray]:
    """x, the row's p and the count after three rounds, both ways."""
    ends = []
    for join in (False, True):
        x, row, matrix, pair = setting()
        calls = [bound(scale, x, 1.1, row), bound(shift, matrix, pair, True)]
        if between:
            calls.insert(1, lambda x=x: x.__iadd__(0.5))
        run = joined(*calls) if join else lambda calls=calls: [call() for call in calls]
        for _ in range(3):
            run()
        ends.append(np.concatenate([x, row["p"][0], pair.n]))
    return ends[0], ends[1]


def test_joined_kernels_compute_what_they_compute_one_by_one() -> None:
    """Three rounds over arrays of every kind."""
    apart, together = one_by_one_and_joined(between=False)
    assert np.array_equal(apart, together)
    assert apart[-1] == 3.0


def test_a_plain_function_between_kernels_is_called_in_its_turn() -> None:
    """It changes what the next kernel sees."""
    apart, together = one_by_one_and_joined(between=True)
    assert np.array_equal(apart, together)


def test_arrays_live_as_long_as_the_function_that_uses_them() -> None:
    """Nobody else holds them."""
    x, row, _, _ = setting()
    run = joined(bound(scale, x.copy(), 2.0, row))
    gc.collect()
    run()
    run()
    assert row["p"][0].tolist() == [4.0, 8.0, 12.0]


def test_without_compilation_the_other_checks_pass() -> None:
    """With ``NUMBA_DISABLE_JIT=1`` the kernels run one by one as plain Python."""
    others = [sys.executable, "-m", "pytest", "-q", "-k", "not without_compilation", __file__]
    plain = os.environ | {"NUMBA_DISABLE_JIT": "1", "PYTEST_ADDOPTS": "-p no:cacheprovider"}
    run = subprocess.run(others, env=plain, capture_output=True, text=True)
    assert run.returncode == 0, run.stdout + run.stderr
    assert "3 passed" in run.stdout
