"""What simulated sensors share: their interface, what they are built from, and their noise."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Protocol, runtime_checkable

import numpy as np

from inspect_cli.compiled import Bound
from inspect_cli.records import Lengths, Measurement
from inspect_cli.schema.truth import TruthModel
from inspect_cli.spatial.arrays import Indices, Matrix, Vector
from inspect_cli.truth.geometry import StructureTruth
from inspect_cli.truth.snapshot import Truth

BLOCK: Final = 256
"""Samples drawn at once; one call of the generator per sample would cost more than the sample."""


class Noise:
    """A stream of independent standard normal vectors (``width``,) from one generator.

    ``block`` (BLOCK, width) holds those that were drawn last, ``row`` (1,) the number of the row
    with the present one: kernels read them.
    """

    def __init__(self, rng: np.random.Generator, width: int) -> None:
        self._rng = rng
        self.block: Matrix = np.empty((BLOCK, width))
        self.row: Indices = np.zeros(1, np.int32)
        self._next = BLOCK

    def advance(self) -> int:
        """Go on to the next vector; returns its row."""
        if self._next == BLOCK:
            self._rng.standard_normal(out=self.block)
            self._next = 0
        self.row[0] = row = self._next
        self._next = row + 1
        return row

    def draw(self) -> Vector:
        """The next vector: a view that stays as it is until the next call."""
        row: Vector = self.block[self.advance()]
        return row


class SimulatedSensor(Protocol):
    """A sensor that measures the truth."""

    @property
    def measurement(self) -> Measurement:
        """The last measurement; the same object as ``sample`` returns, or memory shared with it."""
        ...

    def sample(self, truth: Truth) -> Measurement | None:
        """Measure now; None where there is nothing to hand on yet."""
        ...


@runtime_checkable
class KernelSensor(Protocol):
    """A sensor whose whole measurement is one kernel, so that it can be joined with others."""

    noise: Noise
    """It has to be advanced before each call of the kernel."""

    def bind(self, truth: Truth) -> Bound:
        """The kernel: it overwrites ``measurement``."""
        ...


@dataclass(frozen=True)
class Surroundings:
    """What a simulated sensor is built from besides the numbers of its kind."""

    structure: StructureTruth
    """The true surfaces."""
    truth: TruthModel
    """What else is so in this flight."""
    lengths: Lengths
    """The vehicle's numbers that shapes in records refer to, such as ``n_joints``."""
    rng: np.random.Generator
    """The sensor's own generator."""
