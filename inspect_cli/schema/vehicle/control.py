"""``control:`` of the kinds of platform that fly by selective impedance."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from inspect_cli.schema.base import Name, PositiveTriple, Strict
from inspect_cli.schema.vehicle.base import PlatformBase
from inspect_cli.schema.vehicle.sensors import DepthCameraModel, ImuModel, SensorModel


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


class ImpedancePlatform(PlatformBase):
    """A platform whose flight stack is ``vehicles.stack.ImpedanceStack``."""

    needed: ClassVar[tuple[type[SensorModel], ...]] = (ImuModel, DepthCameraModel)
    needs_pose_source: ClassVar[bool] = True

    control: ControlModel

    @property
    def impedances(self) -> tuple[str, ...]:
        """The names of the impedance profiles that a mission may choose from."""
        return tuple(self.control.profiles)
