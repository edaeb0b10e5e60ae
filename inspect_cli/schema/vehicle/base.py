"""``platform.yaml``: a vehicle's numbers. What every kind of platform shares stands here.

Numbers that no source gives are chosen once and listed under ``chosen`` with the reason.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar, Literal, Self, TypeVar, get_args

from pydantic import Field, ValidationError, model_validator
from pydantic_core import InitErrorDetails, PydanticCustomError

from inspect_cli.errors import InputError
from inspect_cli.schema.base import Count, Name, NonNegative, Positive, Strict
from inspect_cli.schema.positioning import Estimation
from inspect_cli.schema.vehicle.sensors import (
    AnySensor,
    InstrumentModel,
    PoseSourceModel,
    SensorModel,
)

Sensor = TypeVar("Sensor", bound=SensorModel)


RESERVED = {
    "tool": "that is a frame of the vehicle",
    "body": "that is a frame of the vehicle",
    "wall": "that is the force sensor in a wall, of the mission's truth",
    "wind": "that is a disturbance, whose random numbers go by that name",
}
"""Names that mean something else where a sensor is asked for by its name."""


class Rates(Strict):
    """Ticks per second of what is no sensor. Every rate divides the physics rate."""

    physics_hz: Annotated[int, Field(ge=1, le=100_000)] = 1000
    control_hz: Count = 250
    mission_hz: Count = 50
    guidance_hz: Count = 5
    log_hz: Count = 100

    @model_validator(mode="after")
    def _divide(self) -> Rates:
        for name, hz in self:
            if self.physics_hz % hz:
                raise ValueError(f"{name} {hz} does not divide physics_hz {self.physics_hz}")
        return self


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

    needed: ClassVar[tuple[type[SensorModel], ...]] = ()
    """Kinds of sensors that a platform of this kind cannot fly without."""
    needs_pose_source: ClassVar[bool] = False
    """Whether it cannot fly without a tracker or an odometry."""

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
    sensors: dict[Name, AnySensor] = {}
    """The sensors by name. A mission's faults and the random numbers of a run go by these names."""

    def rotor_drives(self) -> tuple[RotorDrive, ...] | None:
        """The drive of each rotor in the order of the records; None where a kind states none."""
        return None

    @property
    def impedances(self) -> tuple[str, ...]:
        """The names of the impedance profiles that a mission may choose from."""
        return ()

    def find(self, model: type[Sensor]) -> Sensor | None:
        """The sensor of a kind, by the kind's model; None if the platform has none."""
        found = (sensor for sensor in self.sensors.values() if isinstance(sensor, model))
        return next(found, None)

    def sensor(self, model: type[Sensor]) -> Sensor:
        """The sensor of a kind, by the kind's model.

        Raises:
            InputError: the platform has none.
        """
        found = self.find(model)
        if found is None:
            (kind,) = get_args(model.model_fields["kind"].annotation)
            raise InputError(self._lacks(kind))
        return found

    def _lacks(self, kind: str) -> str:
        listed = ", ".join(f"{n} ({s.kind})" for n, s in self.sensors.items()) or "none"
        return f"{self.name} has no sensor of kind {kind}; its sensors: {listed}"

    @property
    def instruments(self) -> dict[str, InstrumentModel]:
        """The sensors that read points, by kind."""
        sensors = self.sensors.values()
        return {s.kind: s for s in sensors if isinstance(s, InstrumentModel)}

    def instrument(self, kind: str) -> InstrumentModel:
        """The instrument of a kind.

        Raises:
            InputError: the platform has none.
        """
        found = self.instruments.get(kind)
        if found is None:
            raise InputError(self._lacks(kind))
        return found

    def name_of(self, model: type[SensorModel]) -> str | None:
        """The name of the sensor of a kind; None if the platform has none."""
        return next((n for n, sensor in self.sensors.items() if isinstance(sensor, model)), None)

    def pose_source(self, estimation: Estimation) -> PoseSourceModel:
        """The sensor whose poses an estimation is based on.

        Raises:
            InputError: the platform has none.
        """
        for sensor in self.sensors.values():
            if isinstance(sensor, PoseSourceModel) and sensor.estimation == estimation:
                return sensor
        raise InputError(f"{self.name} has no sensor for the estimation {estimation}")

    @model_validator(mode="after")
    def _sensors_fit(self) -> Self:
        refuse_unfit_sensors(self)
        return self


def refuse_unfit_sensors(platform: PlatformBase) -> None:
    """ValidationError, with the place in the file, where sensors do not fit the platform."""
    sensors, physics_hz = platform.sensors, platform.rates.physics_hz
    refused: list[tuple[tuple[str, ...], str]] = []
    for name, sensor in sensors.items():
        if name in RESERVED:
            what = f"a sensor cannot be called {name!r}: {RESERVED[name]}"
            refused.append((("sensors", name), what))
        if sensor.rate_hz > physics_hz:
            what = f"rate_hz {sensor.rate_hz} is above physics_hz {physics_hz}"
            refused.append((("sensors", name, "rate_hz"), what))
        elif physics_hz % sensor.rate_hz and not sensor.uneven:
            what = f"rate_hz {sensor.rate_hz} does not divide physics_hz {physics_hz}"
            refused.append((("sensors", name, "rate_hz"), what))
        same = [other for other, model in sensors.items() if model.kind == sensor.kind]
        if name == same[-1] and len(same) > 1:
            listed = " and ".join(same)
            what = f"a platform has one sensor of each kind; {listed} are of kind {sensor.kind}"
            refused.append((("sensors", name), what))
    for model in platform.needed:
        if platform.find(model) is None:
            (kind,) = get_args(model.model_fields["kind"].annotation)
            what = f"a platform of kind {platform.kind} needs a sensor of kind {kind}"
            refused.append((("sensors",), what))
    if platform.needs_pose_source and platform.find(PoseSourceModel) is None:
        what = (
            f"a platform of kind {platform.kind} needs a sensor that tells its pose, "
            "of kind pose_tracker or odometry"
        )
        refused.append((("sensors",), what))
    if refused:
        raise ValidationError.from_exception_data(
            platform.name,
            [
                InitErrorDetails(
                    type=PydanticCustomError("value_error", "{error}", {"error": what}),
                    loc=place,
                    input=None,
                )
                for place, what in refused
            ],
        )
