"""The state of an approach: the target, how deep, the contact frame, and what is still to come."""

from __future__ import annotations

from dataclasses import dataclass

from inspect_cli.guidance.contact_frame import ContactFrame
from inspect_cli.guidance.motion import MotionLimits
from inspect_cli.guidance.surface_tracking import SurfaceTracking
from inspect_cli.schema.plan import Target


@dataclass
class Approach:
    """What is being approached."""

    target: Target
    depth_m: float
    limits: MotionLimits
    frame: ContactFrame
    announced: ContactFrame
    """The frame for which the time of arrival was last set."""
    facing_m: float | None = None
    """The distance that the tool keeps until it stands square to a surface just found."""
    faced_s: float = 0.0
    """When it does, as it was planned at the first sight."""
    sliding: bool = False
    tracking: SurfaceTracking | None = None
