"""Allocation of a wrench to fixed rotors that push one way only."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from canted_octorotor.file_model import CantedRotors, rotor_geometry
from inspect_cli.records import Command
from inspect_cli.spatial.arrays import Vector


class FixedAllocation:
    """wrench = A T with a constant A (6, 8), so T = A⁺ wrench; [F; τ] in B about O_b."""

    def __init__(self, rotors: CantedRotors) -> None:
        positions, directions, spins = rotor_geometry(rotors)
        reaction = -spins[:, None] * rotors.moment_constant_m * directions
        torques = np.cross(positions, directions) + reaction
        self.matrix = np.concatenate([directions.T, torques.T])
        self._inverse = np.linalg.pinv(self.matrix)
        self._limit_n = rotors.max_thrust_n

    def thrusts(self, wrench_B: Vector) -> Vector:
        """The thrust (8,) that each rotor would need, without limits, N."""
        return self._inverse @ wrench_B

    def bind(self, weight_B: Vector, command: Command) -> Callable[[], None]:
        """The call that turns the command's wrench into thrusts."""
        return partial(self._allocate, weight_B, command)

    def _allocate(self, weight_B: Vector, command: Command) -> None:
        """Grant weight and torque, then as much of the other forces as the rotors have left."""
        first = np.concatenate([weight_B, command.wrench_B[3:]])
        kept = np.clip(self.thrusts(first), 0.0, self._limit_n)
        more = self.thrusts(command.wrench_B - first)
        room = np.where(more > 0.0, self._limit_n - kept, kept)
        share = min(1.0, float(np.min(room / np.maximum(np.abs(more), 1e-12))))
        command.rotor_thrust[:] = kept + share * more
        command.allocated_B[:] = self.matrix @ command.rotor_thrust
        command.saturated = float(share < 1.0)
