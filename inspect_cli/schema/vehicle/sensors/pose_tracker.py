"""``kind: pose_tracker``: an external tracker of the body's pose."""

from __future__ import annotations

from typing import ClassVar, Literal

from inspect_cli.schema.base import Triple
from inspect_cli.schema.positioning import Estimation
from inspect_cli.schema.vehicle.sensors.base import PoseSourceModel


class PoseTrackerModel(PoseSourceModel):
    """The external tracker, such as a motion capture system."""

    estimation: ClassVar[Estimation] = "external"

    kind: Literal["pose_tracker"]
    body_misalignment_rad: Triple = (0.0, 0.0, 0.0)
    """Rotation vector (roll, pitch, yaw) from B to the frame that the tracker takes for the body.
    It stands for a calibration error of a ground truth, and only metrics use it: the pose that
    the vehicle flies on is free of it."""
