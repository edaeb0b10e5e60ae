"""What the simulated instruments share: standard normal numbers, drawn in blocks."""

from __future__ import annotations

from typing import Final

import numpy as np

from inspect_cli.spatial.arrays import Matrix, Vector

BLOCK: Final = 256
"""Samples drawn at once; one call of the generator per sample would cost more than the sample."""


class Noise:
    """A stream of independent standard normal vectors (``width``,) from one generator.

    ``block`` (BLOCK, width) holds those that were drawn last.
    """

    def __init__(self, rng: np.random.Generator, width: int) -> None:
        self._rng = rng
        self.block: Matrix = np.empty((BLOCK, width))
        self._next = BLOCK

    def next_row(self) -> int:
        """The row of ``block`` with the next vector; it stays as it is until the next call."""
        if self._next == BLOCK:
            self._rng.standard_normal(out=self.block)
            self._next = 0
        row = self._next
        self._next = row + 1
        return row

    def draw(self) -> Vector:
        """The next vector: a view that stays as it is until the next call."""
        row: Vector = self.block[self.next_row()]
        return row
