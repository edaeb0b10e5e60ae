"""``kind: constant``: a force and a torque that stay as they are."""

from __future__ import annotations

from typing import ClassVar, Literal

from inspect_cli.schema.base import NonNegative, Triple
from inspect_cli.schema.disturbances.base import DisturbanceModel


class ConstantWrench(DisturbanceModel):
    """A force and a torque that act on the body from ``start_s`` on."""

    depends_on_flight: ClassVar[bool] = False

    kind: Literal["constant"] = "constant"
    frame: Literal["world", "body"] = "world"
    force_n: Triple = (0.0, 0.0, 0.0)
    torque_nm: Triple = (0.0, 0.0, 0.0)
    start_s: NonNegative = 0.0
    ramp_s: NonNegative = 1.0
    """The wrench rises linearly over this time."""
