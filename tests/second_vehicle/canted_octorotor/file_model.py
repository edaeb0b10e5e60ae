"""The platform file of a canted octorotor, and the geometry that follows from its numbers."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from inspect_cli.schema.base import Positive, Strict, Triple
from inspect_cli.schema.vehicle import Core, ImpedancePlatform
from inspect_cli.spatial.arrays import Matrix, Points, Vector

N_ROTORS = 8


class CantedRotors(Strict):
    """Eight fixed rotors on a circle around O_b, leant along it, every second one backwards."""

    distance_m: Positive
    cant_deg: Annotated[float, Field(gt=0, lt=90)]
    radius_m: Positive
    max_thrust_n: Positive
    moment_constant_m: Positive
    time_up_s: Positive
    time_down_s: Positive


class Wrist(Strict):
    """A tool on a joint about y_B; at zero it points along x_B, a positive angle lowers it."""

    position_B_m: Triple
    length_m: Positive
    mass_kg: Positive
    range_deg: Annotated[float, Field(gt=0, lt=90)]
    servo_lag_s: Positive
    servo_rate_radps: Positive
    servo_torque_nm: Positive
    tip_radius_m: Positive
    tip_stiffness_npm: Positive
    tip_damping_ratio: Positive


class CantedOctorotorPlatform(ImpedancePlatform):
    """A body with eight fixed canted rotors, which stays level, and a wrist that pitches a tool."""

    kind: Literal["canted_octorotor"]
    core: Core
    """The body with its rotors."""
    rotors: CantedRotors
    wrist: Wrist


def rotor_geometry(rotors: CantedRotors) -> tuple[Points, Points, Vector]:
    """Positions (8, 3) m and thrust directions (8, 3) in B, and spins (8,) of the rotors.

    A spin of +1 is counter-clockwise seen from above. It opposes the lean, so that the moment of
    the leant thrust about z_B and the reaction moment add up.
    """
    psi = np.radians(22.5 + 45.0 * np.arange(N_ROTORS))
    lean = np.where(np.arange(N_ROTORS) % 2, -1.0, 1.0)
    angle = np.radians(rotors.cant_deg)
    zeros, ones = np.zeros(N_ROTORS), np.ones(N_ROTORS)
    outward = np.column_stack([np.cos(psi), np.sin(psi), zeros])
    along = np.column_stack([-np.sin(psi), np.cos(psi), zeros])
    up = np.column_stack([zeros, zeros, ones])
    directions = np.cos(angle) * up + np.sin(angle) * lean[:, None] * along
    return rotors.distance_m * outward, directions, -lean


def tool_in_body(wrist: Wrist, angle: float) -> tuple[Vector, Matrix]:
    """(p_BT, R_BT) with z_T = (cos θ, 0, −sin θ) and y_T = y_B."""
    y = np.array([0.0, 1.0, 0.0])
    z = np.array([np.cos(angle), 0.0, -np.sin(angle)])
    p_BT = np.array(wrist.position_B_m) + wrist.length_m * z
    return p_BT, np.column_stack([np.cross(y, z), y, z])
