"""``platform.yaml``: a vehicle's numbers. What every kind shares stands here.

A kind adds its own model by subclassing ``PlatformBase`` and one line in ``PLATFORM_KINDS``.
Numbers that no source gives are chosen once and listed under ``chosen`` with the reason.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Literal

from pydantic import AfterValidator, Field, model_validator

from inspect_cli.schema.base import (
    Count,
    Name,
    NonNegative,
    Positive,
    PositiveTriple,
    Strict,
    Triple,
)
from inspect_cli.schema.positioning import Estimation, OdometryModel, PoseModel, PoseNoise
from inspect_cli.schema.survey import Electrode

SAME_AZIMUTH_DEG = 1e-6
UNEVEN = ("odometry_hz",)
"""Rates that need not divide the physics rate: each tick is at the first step when it is due."""


class Rates(Strict):
    """Ticks per second. Every rate but the odometry's divides the physics rate."""

    physics_hz: Count = 1000
    control_hz: Count = 250
    imu_hz: Count = 250
    pose_hz: Count = 100
    odometry_hz: Count = 30
    tof_hz: Count = 10
    probe_hz: Count = 50
    mission_hz: Count = 50
    guidance_hz: Count = 5
    log_hz: Count = 100

    @model_validator(mode="after")
    def _divide(self) -> Rates:
        for name, hz in self:
            if name in UNEVEN and hz > self.physics_hz:
                raise ValueError(f"{name} {hz} is above physics_hz {self.physics_hz}")
            if name not in UNEVEN and self.physics_hz % hz:
                raise ValueError(f"{name} {hz} does not divide physics_hz {self.physics_hz}")
        return self


class ImuModel(Strict):
    """White noise densities and bias random walks of the inertial unit."""

    accel_noise: NonNegative
    """m/s²/√Hz."""
    gyro_noise: NonNegative
    """rad/s/√Hz."""
    accel_bias_walk: NonNegative
    """m/s³/√Hz."""
    gyro_bias_walk: NonNegative
    """rad/s²/√Hz."""
    accel_bias_initial_mps2: NonNegative
    """Standard deviation of the bias at the start."""
    gyro_bias_initial_radps: NonNegative


def _rising(range_m: tuple[float, float]) -> tuple[float, float]:
    if range_m[0] >= range_m[1]:
        raise ValueError(
            f"the least range {range_m[0]:g} must be below the greatest {range_m[1]:g}"
        )
    return range_m


PinholeAngle = Annotated[float, Field(gt=0, lt=180)]


class TofModel(Strict):
    """The depth camera: a pinhole at the arm's base, its axes parallel to the tool's."""

    position_B_m: Triple
    columns: Annotated[int, Field(ge=64)]
    rows: Annotated[int, Field(ge=48)]
    field_of_view_deg: tuple[PinholeAngle, PinholeAngle]
    range_m: Annotated[tuple[Positive, Positive], AfterValidator(_rising)]
    noise_m: NonNegative
    """Standard deviation of the range at 1 m; it grows with the square of the distance."""
    noise_floor_m: NonNegative
    neighbourhood_m: Positive
    """Radius of A′_t, the points around the tool's axis that the normal is fitted to."""


class HalfCellModel(Strict):
    """The half-cell probe, its load cell and the rule for a valid reading."""

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


class Sensors(Strict):
    """The instruments on board and the tracker that sees the vehicle."""

    imu: ImuModel
    pose: PoseModel
    odometry: OdometryModel | None = None
    """Without it the vehicle cannot fly by on-board estimation."""
    tof: TofModel
    half_cell: HalfCellModel


class ImpedanceProfile(Strict):
    """Multipliers of the system's inertia (paper A, Table III) in a named frame."""

    frame: Literal["tool", "body"]
    mass: PositiveTriple
    inertia: PositiveTriple
    stiffness_npm: PositiveTriple | None = None
    """Instead of the platform's, along the axes of B."""
    damping_nspm: PositiveTriple | None = None


class ControlModel(Strict):
    """Gains of the selective impedance controller and of the momentum observer."""

    stiffness_npm: PositiveTriple
    damping_nspm: PositiveTriple
    stiffness_nmprad: PositiveTriple
    damping_nmsprad: PositiveTriple
    observer_gain: PositiveTriple
    """Diagonal of K_I for forces, 1/s."""
    observer_gain_torque: PositiveTriple
    profiles: Annotated[dict[Name, ImpedanceProfile], Field(min_length=1)]


class Limits(Strict):
    """What a plan may ask of the vehicle."""

    speed_mps: Positive
    acceleration_mps2: Positive
    angular_rate_radps: Positive


class Battery(Strict):
    """Usable energy and the power model P = (Σ T^1.5 / √(2ρA)) / efficiency + avionics."""

    energy_wh: Positive
    avionics_w: NonNegative
    figure_of_merit: Annotated[float, Field(gt=0, le=1)]


@dataclass(frozen=True)
class RotorDrive:
    """What a rotor's speed follows from and what turning it costs.

    Thrust T = k_f ω² and shaft moment Q = k_m T in free air; ``efficiency`` is that of motor and
    controller, from the battery to the shaft.
    """

    thrust_constant_ns2: float
    moment_constant_m: float
    efficiency: float


class PlatformBase(Strict):
    """What every kind of vehicle states."""

    schema_version: Annotated[Literal[1], Field(alias="schema")] = 1
    name: Name
    extends: str | None = None
    """Another platform in the same folder whose entries hold where this file has none."""
    kind: str
    title: str = ""
    source: str = ""
    """Where the numbers come from."""
    chosen: dict[str, str] = {}
    """Numbers that no source gives, each with the reason for its choice."""
    rates: Rates = Rates()
    limits: Limits
    battery: Battery
    sensors: Sensors
    control: ControlModel

    def rotor_drives(self) -> tuple[RotorDrive, ...] | None:
        """The drive of each rotor in the order of the records; None where a kind states none."""
        return None

    def positioning(self, estimation: Estimation) -> tuple[PoseNoise, int]:
        """The white noise and the rate of the poses that an estimation is based on.

        Raises:
            ValueError: on-board estimation of a platform without odometry.
        """
        if estimation == "external":
            return self.sensors.pose, self.rates.pose_hz
        if self.sensors.odometry is None:
            raise ValueError(f"{self.name} has no odometry")
        return self.sensors.odometry, self.rates.odometry_hz


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


def _of_a_body(inertia: tuple[float, float, float]) -> tuple[float, float, float]:
    for i, axis in enumerate("xyz"):
        own, others = inertia[i], inertia[i - 1] + inertia[i - 2]
        if own > others:
            raise ValueError(
                f"no body has these moments of inertia: {own:g} about {axis} "
                f"is more than the sum of the other two, {others:g}"
            )
    return inertia


class Core(Strict):
    """The body without groups and arm."""

    mass_kg: Positive
    inertia_kgm2: Annotated[PositiveTriple, AfterValidator(_of_a_body)]
    com_m: Triple
    radius_m: Positive
    height_m: Positive
    gear_height_m: Positive
    """From O_b down to the feet."""


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


class TiltRotorPlatform(PlatformBase):
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


PLATFORM_KINDS: dict[str, type[PlatformBase]] = {"tilt_rotor": TiltRotorPlatform}
