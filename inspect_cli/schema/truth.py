"""``truth:`` of a mission: what is really there. Only the simulator and the sensors see it.

Without an entry for something, the belief holds there: a surface without truth is exactly where
the planner's fit put it, the vehicle weighs what its platform file says.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from inspect_cli.schema.base import Count, Name, NonNegative, Positive, Strict, Triple
from inspect_cli.schema.disturbances import Disturbance, refuse_impossible
from inspect_cli.schema.geometry import Displacement, TrueShape
from inspect_cli.schema.specimens import Specimen


class ForceSensorModel(Strict):
    """A six-axis force and torque sensor that the whole surface is mounted on."""

    rate_hz: Count = 800
    """Must divide the platform's physics rate."""
    resolution_n: NonNegative = 0.1
    """Step of its output; 0 for none."""
    torque_resolution_nm: NonNegative = 0.002
    noise_n: NonNegative = 0.0
    """Standard deviation of each sample and axis."""
    torque_noise_nm: NonNegative = 0.0


class TrueSurface(Strict):
    """What one of the structure's surfaces really is, or a surface that nobody knows of."""

    geometry: TrueShape | None = None
    """The true shape; without it, the shape that the planner believes in. A surface that the
    structure does not name has to state it."""
    moved: Displacement = Displacement()
    """Turns and shifts the true shape, and the specimen with it."""
    absent: bool = False
    """Nothing is there at all."""
    friction: NonNegative = 0.5
    """Coulomb friction between the tool's tip and the surface."""
    specimen: Specimen | None = None
    force_sensor: ForceSensorModel | None = None
    """What measures, in the wall, the force of the tool on this surface."""

    @model_validator(mode="after")
    def _specimen_fits(self) -> TrueSurface:
        if self.specimen is not None and self.geometry is not None:
            self.specimen.refuse_unfit(self.geometry)
        return self


class TruePlatform(Strict):
    """How the real vehicle differs from its platform file."""

    mass_factor: Positive = 1.0
    """Scales mass and inertia of every body."""
    com_offset_m: Triple = (0.0, 0.0, 0.0)
    """Shifts the centre of mass of the core, in B."""
    odometry_drift_mps: Triple = (0.0, 0.0, 0.0)
    """What the odometry drifts in W all the time, at rest too, on top of its model."""


class ProximityEffects(Strict):
    """Aerodynamic effects of near surfaces on the rotors; see ``truth.proximity``."""

    ground: bool = True
    ceiling: bool = True
    wall: bool = True


WALL = "wall"
"""Name of the force sensor that a surface is mounted on, among the sensors of a flight."""


class SensorFault(Strict):
    """A sensor that fails during the flight."""

    sensor: Name
    """One of the platform's sensors, or ``wall`` for the force sensor that carries a surface."""
    fault: Literal["off", "nan", "holes"] = "off"
    """Silent, not a number, or (a depth camera alone) without a return in random patches."""
    share: Annotated[float, Field(gt=0, lt=1)] | None = None
    """Of the pixels that holes take from every image."""
    start_s: NonNegative = 0.0
    end_s: Positive | None = None
    """Without it, the fault lasts to the end of the flight."""

    @model_validator(mode="after")
    def _lasts(self) -> SensorFault:
        if self.end_s is not None and self.end_s <= self.start_s:
            raise ValueError(f"end_s {self.end_s:g} must be after start_s {self.start_s:g}")
        return self

    @model_validator(mode="after")
    def _holes_have_a_share(self) -> SensorFault:
        if self.fault == "holes" and self.share is None:
            raise ValueError("holes need a share of the pixels, such as share: 0.5")
        if self.fault != "holes" and self.share is not None:
            raise ValueError(f"share goes with fault: holes; {self.fault} takes everything")
        return self


class TruthModel(Strict):
    """Everything that is so and that no planner, estimator or controller may know."""

    structure: dict[Name, TrueSurface] = {}
    platform: TruePlatform = TruePlatform()
    disturbances: tuple[Disturbance, ...] = ()
    proximity: ProximityEffects = ProximityEffects()
    faults: tuple[SensorFault, ...] = ()

    @model_validator(mode="after")
    def _possible(self) -> TruthModel:
        refuse_impossible(self.disturbances)
        return self

    @property
    def loads_depend_on_the_flight(self) -> bool:
        """Whether a rope, a wind or the like acts: their forces are worth a channel of the log."""
        return any(entry.depends_on_flight for entry in self.disturbances)
