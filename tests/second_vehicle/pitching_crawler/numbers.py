"""The numbers of a pitching crawler; all of them are chosen."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from inspect_cli.schema.vehicle import ImuModel
from inspect_cli.schema.vehicle.sensors.pose_tracker import PoseTrackerModel
from inspect_cli.spatial.arrays import Points, Vector

N_ROTORS = 6
IMU = ImuModel(
    kind="imu",
    rate_hz=250,
    accel_noise=0.002,
    gyro_noise=0.0002,
    accel_bias_walk=0.0003,
    gyro_bias_walk=2e-5,
    accel_bias_initial_mps2=0.01,
    gyro_bias_initial_radps=0.001,
)
POSE = PoseTrackerModel(
    kind="pose_tracker", rate_hz=125, position_noise_m=0.001, attitude_noise_rad=0.001
)


@dataclass(frozen=True)
class CrawlerNumbers:
    """Six coplanar rotors, an arm on a sprung hinge with a driven wheel, a foot plate on top."""

    physics_hz: int = 1000
    control_hz: int = 250
    body_mass_kg: float = 2.0
    body_inertia_kgm2: tuple[float, float, float] = (0.040, 0.045, 0.075)
    gear_height_m: float = 0.25
    rotor_distance_m: float = 0.28
    rotor_radius_m: float = 0.12
    max_thrust_n: float = 12.0
    moment_constant_m: float = 0.016
    rotor_lag_s: float = 0.02
    hinge_B_m: tuple[float, float, float] = (0.05, 0.0, 0.0)
    hinge_stiffness_nmprad: float = 4.0
    hinge_damping_nmsprad: float = 0.5
    arm_length_m: float = 0.46
    """From the hinge to the wheel's hub."""
    arm_mass_kg: float = 0.20
    wheel_mass_kg: float = 0.10
    wheel_radius_m: float = 0.04
    wheel_lag_s: float = 0.05
    wheel_speed_radps: float = 15.0
    wheel_torque_nm: float = 0.5
    wheel_stiffness_nmprad: float = 16.0
    wheel_damping_nmsprad: float = 0.27
    wheel_armature_kgm2: float = 1e-3
    foot_height_m: float = 0.15
    """From O_b up to the foot's sole."""
    foot_half_m: float = 0.06
    foot_thickness_m: float = 0.006
    foot_force_noise_n: float = 0.02
    foot_torque_noise_nm: float = 0.002
    encoder_step_rad: float = 2.0 * np.pi / 4096
    imu: ImuModel = IMU
    pose: PoseTrackerModel = POSE

    @property
    def arm_moment_kgm(self) -> float:
        """Mass of arm and wheel times the distance of their centre from the hinge."""
        return (0.5 * self.arm_mass_kg + self.wheel_mass_kg) * self.arm_length_m

    @property
    def tip_length_m(self) -> float:
        """From the hinge to the wheel's farthest point."""
        return self.arm_length_m + self.wheel_radius_m


def rotor_geometry(numbers: CrawlerNumbers) -> tuple[Points, Vector]:
    """Positions (6, 3) m in B and spins (6,) of the rotors; +1 is counter-clockwise from above."""
    psi = np.radians(30.0 + 60.0 * np.arange(N_ROTORS))
    d = numbers.rotor_distance_m
    spins = np.where(np.arange(N_ROTORS) % 2, -1.0, 1.0)
    return np.column_stack([d * np.cos(psi), d * np.sin(psi), np.zeros(N_ROTORS)]), spins
