"""Actuators of a vehicle by kind, and their entries in a MuJoCo model.

Each actuator has one activation in MuJoCo, which follows its control with a first-order lag. A
joint without an actuator is passive: it is measured and never commanded.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

import mujoco
import numpy as np

from inspect_cli.spatial.arrays import Vector


@dataclass(frozen=True)
class Rotor:
    """A rotor at a site of the same name; it pushes along the site's z.

    The control is the thrust T in free air, N. The reaction moment about z is ``moment_m`` T.
    """

    name: str
    radius_m: float
    max_thrust_n: float
    moment_m: float
    """Positive when the reaction turns the body counter-clockwise seen from the site's +z."""
    time_up_s: float
    """Lag of rising thrust."""
    time_down_s: float
    """Lag of falling thrust."""


@dataclass(frozen=True)
class Servo:
    """A position servo of a joint; the control is its angle, rad.

    Its torque is stiffness · (lagged set-point − angle) − damping · rate, within ± ``torque_nm``.
    """

    name: str
    joint: str
    lag_s: float
    rate_radps: float
    """Fastest motion of the set-point."""
    torque_nm: float
    stiffness_nmprad: float
    damping_nmsprad: float


@dataclass(frozen=True)
class Drive:
    """A velocity drive of a joint, such as a wheel's; it is commanded a speed, rad/s.

    The control is an angle that moves on at the commanded speed, and a servo follows it: the same
    as a speed loop with an integral part. Asked to stand, it therefore does not creep under load.
    """

    name: str
    joint: str
    lag_s: float
    max_speed_radps: float
    torque_nm: float
    stiffness_nmprad: float
    damping_nmsprad: float

    @property
    def reach_rad(self) -> float:
        """How far the control may lead the joint, so that a blocked wheel does not catch up.

        Torque over stiffness, and at the greatest speed what lag and damping trail.
        """
        trail_s = self.lag_s + self.damping_nmsprad / self.stiffness_nmprad
        return self.torque_nm / self.stiffness_nmprad + self.max_speed_radps * trail_s


Actuator = Rotor | Servo | Drive
Kind = TypeVar("Kind", Rotor, Servo, Drive)


def of_kind(actuators: Sequence[Actuator], kind: type[Kind]) -> list[Kind]:
    """The actuators of one kind, in the order that the records' arrays have."""
    return [actuator for actuator in actuators if isinstance(actuator, kind)]


def rotor_radii_m(actuators: Sequence[Actuator]) -> Vector:
    """Radii (n_rotors,) of the rotors."""
    return np.array([rotor.radius_m for rotor in of_kind(actuators, Rotor)])


def add_actuators(spec: mujoco.MjSpec, actuators: Sequence[Actuator]) -> None:
    """Add actuators to a model whose sites and joints exist."""
    for actuator in actuators:
        if isinstance(actuator, Rotor):
            _add_rotor(spec, actuator)
        else:
            _add_servo(spec, actuator)


def _add_rotor(spec: mujoco.MjSpec, rotor: Rotor) -> None:
    spec.add_actuator(
        trntype=mujoco.mjtTrn.mjTRN_SITE,
        target=rotor.name,
        gear=[0.0, 0.0, 1.0, 0.0, 0.0, rotor.moment_m],
        ctrllimited=True,
        ctrlrange=[0.0, rotor.max_thrust_n],
        **_lagged(rotor.name, rotor.time_up_s, 1.0),
    )


def _add_servo(spec: mujoco.MjSpec, servo: Servo | Drive) -> None:
    spec.add_actuator(
        trntype=mujoco.mjtTrn.mjTRN_JOINT,
        target=servo.joint,
        biastype=mujoco.mjtBias.mjBIAS_AFFINE,
        biasprm=[0.0, -servo.stiffness_nmprad, -servo.damping_nmsprad] + [0.0] * 7,
        forcelimited=True,
        forcerange=[-servo.torque_nm, servo.torque_nm],
        **_lagged(servo.name, servo.lag_s, servo.stiffness_nmprad),
    )


def _lagged(name: str, lag_s: float, gain: float) -> dict[str, Any]:
    """The entries of an actuator whose force is ``gain`` times its lagged control."""
    return {
        "name": name,
        "dyntype": mujoco.mjtDyn.mjDYN_FILTEREXACT,
        "dynprm": [lag_s] + [0.0] * 9,
        "gaintype": mujoco.mjtGain.mjGAIN_FIXED,
        "gainprm": [gain] + [0.0] * 9,
    }
