"""``kind: half_cell``: a half-cell probe with a load cell at the tool's tip."""

from __future__ import annotations

from typing import ClassVar, Literal

from inspect_cli.schema.base import NonNegative, Positive
from inspect_cli.schema.survey import Electrode
from inspect_cli.schema.vehicle.sensors.base import SensorModel


class HalfCellModel(SensorModel):
    """The half-cell probe, its load cell and the rule for a valid reading."""

    on_demand: ClassVar[bool] = True

    kind: Literal["half_cell"]
    electrode: Electrode = "CSE"
    """What the probe reads against; readings are evaluated against CSE all the same."""
    potential_noise_v: NonNegative
    resistance_noise: NonNegative
    """Relative standard deviation."""
    force_noise_n: NonNegative
    cell_constant_m: Positive
    """Resistance = resistivity / cell constant."""
    wetting_s: Positive
    """Time constant with which the wetted contact reaches its final potential."""
    dry_offset_v: float
    """Offset of the potential at first touch, decaying with ``wetting_s``."""
    min_force_n: Positive = 1.0
    min_contact_s: Positive = 2.0
    stable_v: Positive = 0.005
    """The potential must stay within this band over ``stable_s``."""
    stable_s: Positive = 1.0
    timeout_s: Positive = 6.0
    """Longest time to wait beyond the dwell before the point is given up."""
    cable_m: Positive
    """Length of the cable to the reinforcement's clamp."""
