"""``kind: tilt_rotor``: a body with tilting groups of coaxial rotors and a rigid arm."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import AfterValidator, Field

from inspect_cli.schema.base import Positive, Strict
from inspect_cli.schema.vehicle.base import RotorDrive
from inspect_cli.schema.vehicle.control import ImpedancePlatform
from inspect_cli.schema.vehicle.core import Core

SAME_AZIMUTH_DEG = 1e-6


class Rotor(Strict):
    """One rotor type; thrust T = k_f ω², reaction moment M = ±k_m T about its axis."""

    radius_m: Positive
    mass_kg: Positive
    thrust_constant_ns2: Positive
    time_up_s: Positive
    time_down_s: Positive
    drive_efficiency: Annotated[float, Field(gt=0, le=1)]
    """Of motor and controller: shaft power over electrical power."""


class TiltArm(Strict):
    """One tilting group of two coaxial rotors at an azimuth about z_B."""

    azimuth_deg: float
    upper_spin: Literal["ccw", "cw"]
    """Seen from above; the lower rotor turns the other way."""


class TiltUnit(Strict):
    """What is the same in all groups of a tilt-rotor vehicle."""

    distance_m: Positive
    """From O_b to the group's middle."""
    mass_kg: Positive
    """Of the tilting unit without rotors."""
    coaxial_offset_m: Positive
    """Between the two rotors of a group."""
    max_thrust_n: Positive
    """Of both rotors together."""
    moment_constant_upper_m: Positive
    moment_constant_lower_m: Positive
    servo_lag_s: Positive
    servo_rate_radps: Positive
    servo_torque_nm: Positive
    range_deg: Positive | None = None
    """± range of the tilt; without it the joint turns freely."""


class Tool(Strict):
    """A rigid arm from O_b to the tip at ``pitch_deg`` from −z_B, turned towards x_B."""

    pitch_deg: Annotated[float, Field(ge=0, le=180)]
    length_m: Positive
    mass_kg: Positive
    tip_radius_m: Positive
    tip_stiffness_npm: Positive
    tip_damping_ratio: Positive


def _apart(groups: tuple[TiltArm, ...]) -> tuple[TiltArm, ...]:
    for i, first in enumerate(groups):
        for j, second in enumerate(groups[i + 1 :], i + 1):
            between = math.remainder(second.azimuth_deg - first.azimuth_deg, 360.0)
            if abs(between) < SAME_AZIMUTH_DEG:
                raise ValueError(
                    f"groups {i} and {j} stand in the same place: "
                    f"azimuths {first.azimuth_deg:g}° and {second.azimuth_deg:g}°"
                )
    return groups


class TiltRotorPlatform(ImpedancePlatform):
    """A rigid body with tilting groups of coaxial rotors and a rigid arm (paper A)."""

    kind: Literal["tilt_rotor"]
    core: Core
    rotor: Rotor
    unit: TiltUnit
    groups: Annotated[tuple[TiltArm, ...], Field(min_length=3), AfterValidator(_apart)]
    tool: Tool

    def rotor_drives(self) -> tuple[RotorDrive, ...]:
        """Upper and lower of each group."""
        unit, rotor = self.unit, self.rotor
        pair = (unit.moment_constant_upper_m, unit.moment_constant_lower_m)
        drives = tuple(
            RotorDrive(rotor.thrust_constant_ns2, moment_m, rotor.drive_efficiency)
            for moment_m in pair
        )
        return drives * len(self.groups)
