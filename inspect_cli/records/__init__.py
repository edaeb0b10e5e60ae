"""What flows through the flight loop, declared once.

A record class lists its fields as (shape, unit, frame, meaning). From that one declaration
come the NumPy dtype that kernels see, the MCAP schema, the CSV header, the channel table of
the documentation, and the typed accessors below. An instance wraps a structured array of
length one (``.array``): cheap to hand to a kernel, and one assignment logs it.

    estimate = Estimate.create(lengths)
    estimate.p_WB[:] = 0.0        # a view into the array
    estimate.t_s = 0.0            # scalars are assigned

Shapes may name a length that the vehicle decides: ``n_rotors``, ``n_joints`` (measured),
``n_servos`` (commanded by angle), ``n_drives`` (by speed) and ``n_arm`` (stated by a posture);
one not named is 0.

Frames: see ``inspect_cli.spatial``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

from inspect_cli.records.half_cell import Probe, Reading
from inspect_cli.records.reading import InvalidReason, PointReading
from inspect_cli.records.record import (
    NO_LENGTHS,
    ArrayField,
    Field,
    Lengths,
    Record,
    ScalarField,
    scalar,
    vector,
)
from inspect_cli.spatial.arrays import Points, Vector

__all__ = [
    "CORE_RECORDS",
    "NO_LENGTHS",
    "WALL_SAMPLES",
    "ArrayField",
    "Command",
    "DepthImage",
    "Estimate",
    "Field",
    "Imu",
    "InvalidReason",
    "Lengths",
    "Measurement",
    "Odometry",
    "PointReading",
    "Pose",
    "Probe",
    "Reading",
    "Record",
    "Reference",
    "ScalarField",
    "State",
    "SurfaceEstimate",
    "TrueContact",
    "TrueDisturbance",
    "WallForce",
    "scalar",
    "vector",
]


class State(Record):
    """What is so: the true motion and forces. Only sensors, log and metrics may read it."""

    topic = "/truth/state"

    p_WB = vector(3, "m", "W", "position of the body")
    q_WB = vector(4, "1", "W", "attitude of the body, unit quaternion wxyz")
    v_WB_W = vector(3, "m/s", "W", "velocity of the body's origin")
    w_WB_B = vector(3, "rad/s", "B", "angular velocity of the body")
    a_WB_W = vector(3, "m/s²", "W", "acceleration of the body's origin during the last step")
    alpha_WB_B = vector(3, "rad/s²", "B", "angular acceleration during the last step")
    p_WT = vector(3, "m", "W", "position of the tool's tip")
    q_WT = vector(4, "1", "W", "attitude of the tool, unit quaternion wxyz")
    f_tool_W = vector(3, "N", "W", "contact force on the tool's tip")
    f_normal = scalar("N", "contact force against the tool's axis, pressing is positive")
    f_body = scalar("N", "contact force on anything but the tool and the landing gear")
    wrench_ext_B = vector(6, "N, N·m", "B", "all external force and torque about O_b but gravity")
    joint_angle = vector("n_joints", "rad", "", "angles of tilt and arm joints")
    joint_rate = vector("n_joints", "rad/s", "", "rates of tilt and arm joints")
    rotor_thrust = vector("n_rotors", "N", "", "thrust of each rotor in free air")


class TrueContact(Record):
    """What is so at the tool's tip: the nearest true surface and the specimen behind it."""

    topic = "/truth/contact"

    surface = scalar("1", "index of the nearest true surface, −1 for none")
    distance = scalar("m", "from the tip to that surface, negative when pressed into it")
    n_W = vector(3, "1", "W", "its outward normal at the tip")
    uv = vector(2, "m", "S", "coordinates of the tip along it")
    potential = scalar("V", "potential of the specimen there; NaN without a specimen")
    resistivity = scalar("Ω·m", "resistivity of the specimen there; NaN without a specimen")


class TrueDisturbance(Record):
    """What pulls at the vehicle in truth; only in logs of flights with a rope, wind or cable."""

    topic = "/truth/disturbance"

    f_rope_W = vector(3, "N", "W", "tension of the rope on the tool's tip")
    pull = scalar("1", "number of the pull at the rope, from 1 on; 0 while nobody pulls")
    wind_W = vector(3, "m/s", "W", "velocity of the air, gusts included")
    f_cable_W = vector(3, "N", "W", "force of the cable on its end at the vehicle")


class Imu(Record):
    """One sample of the inertial unit at O_b."""

    topic = "/sensor/imu"

    f_B = vector(3, "m/s²", "B", "specific force")
    w_B = vector(3, "rad/s", "B", "angular rate")


class Pose(Record):
    """One pose measurement of an external or on-board tracker."""

    topic = "/sensor/pose"

    p_WB = vector(3, "m", "W", "measured position of the body")
    q_WB = vector(4, "1", "W", "measured attitude of the body, wxyz")


class Odometry(Pose):
    """One pose of the odometry on board; its frame starts as W and drifts as the vehicle moves."""

    topic = "/sensor/odometry"


WALL_SAMPLES = 80
"""Samples in one row of ``WallForce``."""


class WallForce(Record):
    """A block of samples of a force sensor in the wall; the time is that of its last sample."""

    topic = "/sensor/wall_force"

    period = scalar("s", "between two samples")
    p_WS = vector(3, "m", "W", "origin of the sensor's frame S")
    q_WS = vector(4, "1", "W", "attitude of the sensor's frame S, wxyz")
    f_S = ArrayField((WALL_SAMPLES, 3), "N", "S", "force of the tool on the surface")
    t_S = ArrayField((WALL_SAMPLES, 3), "N·m", "S", "its torque about the origin of S")


class SurfaceEstimate(Record):
    """The local surface as the depth camera saw it."""

    topic = "/guidance/surface"

    p_WC = vector(3, "m", "W", "the surface point on the tool's axis")
    n_W = vector(3, "1", "W", "outward normal of the surface")
    distance = scalar("m", "from the tool's tip to the surface along z_T, negative behind it")
    n_points = scalar("1", "points in the neighbourhood A′_t of the tool's axis")
    rms = scalar("m", "RMS distance of those points from the fitted plane")
    valid = scalar("1", "1 if the estimate may be used, else 0")


class Estimate(Record):
    """What the vehicle believes of its own motion and of the forces on it."""

    topic = "/estimate"

    p_WB = vector(3, "m", "W", "position of the body")
    q_WB = vector(4, "1", "W", "attitude of the body, wxyz")
    v_WB_W = vector(3, "m/s", "W", "velocity of the body's origin")
    w_WB_B = vector(3, "rad/s", "B", "angular velocity of the body, bias removed")
    bias_f_B = vector(3, "m/s²", "B", "accelerometer bias")
    bias_w_B = vector(3, "rad/s", "B", "gyroscope bias")
    sigma = vector(15, "m, m/s, rad, m/s², rad/s", "", "standard deviations of p, v, θ, biases")
    wrench_B = vector(6, "N, N·m", "B", "external wrench about O_b by the momentum observer")


class Reference(Record):
    """Where the vehicle shall be; body pose with derivatives, and the tool's set-point."""

    topic = "/reference"

    p_WB = vector(3, "m", "W", "position of the body")
    q_WB = vector(4, "1", "W", "attitude of the body, wxyz")
    v_WB_W = vector(3, "m/s", "W", "velocity of the body's origin")
    w_WB_B = vector(3, "rad/s", "B", "angular velocity of the body, in the reference's B")
    a_WB_W = vector(3, "m/s²", "W", "acceleration of the body's origin")
    alpha_WB_B = vector(3, "rad/s²", "B", "angular acceleration, in the reference's B")
    p_WT = vector(3, "m", "W", "position of the tool's tip")
    arm_angle = vector("n_arm", "rad", "", "angles of the arm's joints")
    mode = scalar("1", "mode of the mission executive, by its number in modes.json")
    target = scalar("1", "index of the target in the plan, −1 for none")
    impedance = scalar("1", "which of the platform's impedance profiles to fly with, by its place")


class Command(Record):
    """What the actuators are told."""

    topic = "/command"

    wrench_B = vector(6, "N, N·m", "B", "wrench that the control law asks for")
    allocated_B = vector(6, "N, N·m", "B", "wrench that the allocation could grant")
    rotor_thrust = vector("n_rotors", "N", "", "thrust asked of each rotor")
    joint_angle = vector("n_servos", "rad", "", "angle asked of tilt and arm joints")
    drive_speed = vector("n_drives", "rad/s", "", "speed asked of driven wheels")
    saturated = scalar("1", "1 if the allocation had to scale the wrench down, else 0")


@dataclass(frozen=True)
class Pixels:
    """What a depth camera holds of its last image, in its frame D; m."""

    all: Callable[[], Points]
    """Points (rows, columns, 3); NaN for pixels without a return."""
    near: Callable[[Vector, Vector, float], Points]
    """Points (n, 3) of the pixels that may lie within a radius, m, of a line, row by row.

    The line goes through a point (3,) along a unit vector (3,). All points that do lie so near are
    among them.
    """


@dataclass(frozen=True)
class DepthImage:
    """One image of a depth camera. It is not logged as a row: see ``SurfaceEstimate``.

    The camera writes its next image into the same memory.
    """

    t_s: float
    pixels: Pixels

    @property
    def image(self) -> Points:
        """The measured points (rows, columns, 3), m, in the camera's frame D; NaN for pixels
        without a return."""
        return self.pixels.all()

    @property
    def points_D(self) -> Points:
        """The points of ``image`` as (rows · columns, 3)."""
        return self.image.reshape(-1, 3)

    @property
    def views(self) -> dict[str, Points]:
        """The measured numbers by name, as those of a record."""
        return {"image": self.image}


Measurement: TypeAlias = Record | DepthImage
"""What a sensor returns."""


CORE_RECORDS: tuple[type[Record], ...] = (
    State,
    TrueContact,
    TrueDisturbance,
    Imu,
    Pose,
    Odometry,
    WallForce,
    Probe,
    Reading,
    SurfaceEstimate,
    Estimate,
    Reference,
    Command,
)
