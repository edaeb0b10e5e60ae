"""What every kind of sensor states in ``sensors:`` of a platform file."""

from __future__ import annotations

from typing import ClassVar, Literal

from inspect_cli.schema.base import Count, Strict, Triple
from inspect_cli.schema.positioning import Estimation, PoseNoise

Frame = Literal["body", "tool"]


class SensorModel(Strict):
    """A sensor on the vehicle or one that observes it. A kind adds its numbers."""

    uneven: ClassVar[bool] = False
    """Whether the rate may fail to divide the physics rate. A sample is then taken at the first
    physics step at or after each k / rate."""
    on_demand: ClassVar[bool] = False
    """Whether the sensor is only sampled in flights with a target that is read by it."""
    has_pixels: ClassVar[bool] = False
    """Whether it returns images, which a fault may leave holes in."""

    kind: str
    rate_hz: Count
    """Samples per second."""


class PoseSourceModel(SensorModel, PoseNoise):
    """A sensor whose poses an estimation can be based on."""

    estimation: ClassVar[Estimation]
    """The mission's ``estimation`` that flies on it."""


class MountModel(Strict):
    """Where a sensor sits: its frame D, fixed to a named frame of the vehicle.

    p_WD = p_WF + R_WF ``position_m`` and R_WD = R_WA Exp(``rotation_rad``), where F is ``frame``
    and A is ``axes``.
    """

    frame: Frame
    """What the origin is fixed to: ``body`` is B, ``tool`` is T with its origin in the tip."""
    position_m: Triple = (0.0, 0.0, 0.0)
    """Origin of D in that frame."""
    axes: Frame | None = None
    """The frame that the axes turn with, if another: a camera at an arm's first joint keeps its
    place in the body and turns with the tool."""
    rotation_rad: Triple = (0.0, 0.0, 0.0)
    """Rotation vector from those axes to the axes of D."""
