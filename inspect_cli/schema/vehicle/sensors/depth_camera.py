"""``kind: depth_camera``: a time-of-flight camera, one depth point per pixel."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import AfterValidator, Field

from inspect_cli.schema.base import NonNegative, Positive
from inspect_cli.schema.vehicle.sensors.base import MountModel, SensorModel


def _rising(range_m: tuple[float, float]) -> tuple[float, float]:
    if range_m[0] >= range_m[1]:
        raise ValueError(
            f"the least range {range_m[0]:g} must be below the greatest {range_m[1]:g}"
        )
    return range_m


PinholeAngle = Annotated[float, Field(gt=0, lt=180)]


class DepthCameraModel(SensorModel):
    """A pinhole camera that looks along z_D; its columns count along −y_D, its rows along x_D."""

    uneven: ClassVar[bool] = True
    has_pixels: ClassVar[bool] = True

    kind: Literal["depth_camera"]
    mount: MountModel
    columns: Annotated[int, Field(ge=64, le=4096)]
    rows: Annotated[int, Field(ge=48, le=4096)]
    field_of_view_deg: tuple[PinholeAngle, PinholeAngle]
    range_m: Annotated[tuple[Positive, Positive], AfterValidator(_rising)]
    noise_m: NonNegative
    """Standard deviation of the range at 1 m; it grows with the square of the distance."""
    noise_floor_m: NonNegative
    neighbourhood_m: Positive
    """Radius of A′_t, the points around the tool's axis that the normal is fitted to."""
