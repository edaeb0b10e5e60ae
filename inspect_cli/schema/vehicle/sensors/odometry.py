"""``kind: odometry``: visual-inertial odometry on board."""

from __future__ import annotations

from typing import ClassVar, Literal

from inspect_cli.schema.base import NonNegative
from inspect_cli.schema.positioning import Estimation
from inspect_cli.schema.vehicle.sensors.base import PoseSourceModel


class OdometryModel(PoseSourceModel):
    """Visual-inertial odometry: white noise, and a drift that grows with motion."""

    uneven: ClassVar[bool] = True
    estimation: ClassVar[Estimation] = "onboard"

    kind: Literal["odometry"]
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
