"""Where a vehicle gets its poses from: the external tracker, or the odometry on board."""

from __future__ import annotations

from typing import Literal

from inspect_cli.schema.base import NonNegative, Strict, Triple

Estimation = Literal["external", "onboard"]
"""Whether the vehicle knows its pose from the external tracker or from its own odometry."""


class PoseNoise(Strict):
    """What the filter is told of a pose measurement: its white noise, and whether it drifts."""

    position_noise_m: NonNegative
    attitude_noise_rad: NonNegative

    @property
    def walks(self) -> tuple[float, float, float]:
        """Random walks of the frame: position per √m, yaw per √m and per √rad; 0 for none."""
        return (0.0, 0.0, 0.0)


class PoseModel(PoseNoise):
    """The external tracker."""

    body_misalignment_rad: Triple = (0.0, 0.0, 0.0)
    """Rotation vector (roll, pitch, yaw) from B to the frame that the tracker takes for the body.
    It stands for a calibration error of a ground truth, and only metrics use it: the pose that
    the vehicle flies on is free of it."""


class OdometryModel(PoseNoise):
    """Visual-inertial odometry: white noise, and a drift that grows with motion."""

    position_walk: NonNegative
    """m/√m travelled, each axis."""
    scale_error: NonNegative
    """Standard deviation of the run's relative error of every distance."""
    yaw_walk_moved: NonNegative
    """rad/√m travelled."""
    yaw_walk_turned: NonNegative
    """rad/√rad turned."""
    tilt_error_rad: NonNegative
    """Standard deviation of the run's constant error of roll and of pitch."""

    @property
    def walks(self) -> tuple[float, float, float]:
        """Random walks of position and yaw, as above."""
        return (self.position_walk, self.yaw_walk_moved, self.yaw_walk_turned)
