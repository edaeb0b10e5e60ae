"""The platform file of a pitching crawler, and the geometry that follows from its numbers."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

import numpy as np
from pydantic import AfterValidator, Field

from inspect_cli.schema.base import Positive, PositiveTriple, Strict, Triple
from inspect_cli.schema.vehicle.base import PlatformBase
from inspect_cli.schema.vehicle.sensors.base import SensorModel
from inspect_cli.schema.vehicle.sensors.imu import ImuModel
from inspect_cli.spatial.arrays import Points, Vector
from pitching_crawler.sensor_models import EncodersModel

FOOT = "foot"
"""The frame of the foot, its z out of the sole."""


def _even(count: int) -> int:
    if count % 2:
        raise ValueError(f"every second rotor turns the other way; {count} is odd")
    return count


class Hub(Strict):
    """The body that carries rotors, arm and foot."""

    mass_kg: Positive
    inertia_kgm2: PositiveTriple
    gear_height_m: Positive
    """From O_b down to the legs' ends."""


class CoplanarRotors(Strict):
    """Equal rotors on a circle around O_b, all of which push along z_B."""

    count: Annotated[int, Field(ge=4), AfterValidator(_even)]
    distance_m: Positive
    radius_m: Positive
    max_thrust_n: Positive
    moment_constant_m: Positive
    lag_s: Positive


class SprungArm(Strict):
    """An arm on a passive hinge about y_B; a spring holds it level."""

    hinge_B_m: Triple
    hinge_stiffness_nmprad: Positive
    hinge_damping_nmsprad: Positive
    length_m: Positive
    """From the hinge to the wheel's hub."""
    mass_kg: Positive


class DrivenWheel(Strict):
    """The wheel at the arm's tip, about y_B, and its drive."""

    mass_kg: Positive
    radius_m: Positive
    armature_kgm2: Positive
    lag_s: Positive
    max_speed_radps: Positive
    torque_nm: Positive
    stiffness_nmprad: Positive
    damping_nmsprad: Positive


class Foot(Strict):
    """A square plate on top."""

    height_m: Positive
    """From O_b up to the sole."""
    half_m: Positive
    thickness_m: Positive


class CrawlerPlatform(PlatformBase):
    """Coplanar rotors, an arm on a sprung hinge with a driven wheel, a foot plate on top."""

    needed: ClassVar[tuple[type[SensorModel], ...]] = (ImuModel, EncodersModel)
    needs_pose_source: ClassVar[bool] = True

    kind: Literal["pitching_crawler"]
    hub: Hub
    rotors: CoplanarRotors
    arm: SprungArm
    wheel: DrivenWheel
    foot: Foot

    @property
    def arm_moment_kgm(self) -> float:
        """Mass of arm and wheel times the distance of their centre from the hinge."""
        return (0.5 * self.arm.mass_kg + self.wheel.mass_kg) * self.arm.length_m

    @property
    def tip_length_m(self) -> float:
        """From the hinge to the wheel's farthest point."""
        return self.arm.length_m + self.wheel.radius_m


def rotor_geometry(rotors: CoplanarRotors) -> tuple[Points, Vector]:
    """Positions (n, 3) m in B and spins (n,) of the rotors; +1 is counter-clockwise from above."""
    n, d = rotors.count, rotors.distance_m
    psi = 2.0 * np.pi / n * (0.5 + np.arange(n))
    spins = np.where(np.arange(n) % 2, -1.0, 1.0)
    return np.column_stack([d * np.cos(psi), d * np.sin(psi), np.zeros(n)]), spins
