"""How the vehicle gave way to the pulls at a rope, and where it did not.

A pull begins with the first row that carries its number and is watched until the next one begins
or 3 s after its last row, so that what it set in motion has decayed. Motion is measured from the
beginning, less that of the reference, which stands still while the vehicle holds. Of several
pulls the least favourable one counts, so that a bound on the metric holds for each.

For one pull, with f(t) the cord's force on the tip in W and t* the moment of its peak:

    displacement    e(t) = Δp(t) − Δp(0), Δp = p_WB − p_ref
    along           max over t of e · d, d = f(t*)/|f(t*)|
    turn            δ(t) = Δq(0)* ⊗ Δq(t), Δq = q_ref* ⊗ q_WB
    attitude motion |p_BT| max over t of the angle of δ(t): how far the tip moves because the
                    body turns
    torque          ((p_WT − p_WB) × f) · z_B
    yaw             the angle about z of δ(t): where its x axis points in the (x, y) plane

Source of the questions: Bodie et al., "An Omnidirectional Aerial Manipulation Platform for
Contact-Based Inspection", section V-B (ledger rows A1 to A5).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from inspect_cli.metrics.flight import FlightData, NotMeasured, largest, mean
from inspect_cli.metrics.geometry import attitude_angle, direction_angle
from inspect_cli.records import TrueDisturbance
from inspect_cli.spatial.arrays import Points, Structured, Vector
from inspect_cli.spatial.rotations import quaternion_conjugate, quaternion_multiply, rotate

DECAY_S = 3.0
"""How long after a pull its effects are watched."""
STRONG = 0.5
"""The share of its peak above which a pull's direction counts."""


@dataclass(frozen=True)
class Pull:
    """What happened during one pull; the first row is its beginning."""

    state: Structured
    force_W: Points
    displacement: Points
    """e, (n, 3) m in W."""
    turn: Points
    """δ, (n, 4)."""

    @property
    def strength(self) -> Vector:
        """|f|, (n,) N."""
        lengths: Vector = np.linalg.norm(self.force_W, axis=1)
        return lengths

    @property
    def peak(self) -> float:
        """The largest |f|, N.

        Raises:
            NotMeasured: the cord was never taut.
        """
        peak = largest(self.strength)
        if peak <= 0.0:
            raise NotMeasured("the cord of a pull was never taut")
        return peak

    @property
    def along(self) -> float:
        """The largest displacement in the direction of the peak force, m."""
        direction = self.force_W[np.argmax(self.strength)] / self.peak
        return largest(self.displacement @ direction)

    @property
    def across(self) -> float:
        """The largest level displacement square to the peak force, m."""
        ahead = self.force_W[np.argmax(self.strength)]
        aside = np.array([-ahead[1], ahead[0], 0.0])
        length = float(np.linalg.norm(aside))
        if length == 0.0:
            raise NotMeasured("the cord pulled straight up or down")
        return largest(np.abs(self.displacement @ (aside / length)))

    @property
    def upwards(self) -> float:
        """The largest displacement up or down, m."""
        return largest(np.abs(self.displacement[:, 2]))

    @property
    def attitude_motion(self) -> float:
        """The largest motion of the tip by the body's rotation, m."""
        unturned = np.tile([1.0, 0.0, 0.0, 0.0], (len(self.turn), 1))
        arm_m = np.linalg.norm(self.state["p_WT"][0] - self.state["p_WB"][0])
        return largest(attitude_angle(self.turn, unturned)) * float(arm_m)

    @property
    def angle_to_x_B(self) -> float:
        """The largest angle between force and ±x_B while above half of the peak, rad."""
        strong = self.strength > STRONG * self.peak
        away = direction_angle(self.force_W[strong], _axes(self.state["q_WB"][strong], 0))
        return largest(np.minimum(away, np.pi - away))

    @property
    def torque(self) -> float:
        """The cord's largest torque about z_B through O_b, N·m."""
        torque_W = np.cross(self.state["p_WT"] - self.state["p_WB"], self.force_W)
        return largest(np.abs(np.sum(torque_W * _axes(self.state["q_WB"], 2), axis=1)))

    @property
    def yaw(self) -> float:
        """The largest yaw away from the beginning, rad."""
        ahead = _axes(self.turn, 0)
        return largest(np.abs(np.arctan2(ahead[:, 1], ahead[:, 0])))


def pulls(flight: FlightData) -> list[Pull]:
    """The pulls of a flight in order of time.

    Raises:
        NotMeasured: nobody pulled.
    """
    felt = flight.on_state_ticks(TrueDisturbance)
    times, number = flight.state["t_s"], felt["pull"]
    begun = np.flatnonzero((number > 0.0) & (number != np.r_[0.0, number[:-1]]))
    found = []
    for k, first in enumerate(begun):
        last_s = times[number == number[first]][-1]
        rows = (times >= times[first]) & (times <= last_s + DECAY_S)
        if k + 1 < len(begun):
            rows &= times < times[begun[k + 1]]
        found.append(_pull(flight.state[rows], flight.reference[rows], felt["f_rope_W"][rows]))
    if not found:
        raise NotMeasured("nobody pulled at a rope during the flight")
    return found


def _pull(state: Structured, reference: Structured, force_W: Points) -> Pull:
    apart = state["p_WB"] - reference["p_WB"]
    pairs = zip(reference["q_WB"], state["q_WB"], strict=True)
    turned = [quaternion_multiply(quaternion_conjugate(wanted), q) for wanted, q in pairs]
    start = quaternion_conjugate(turned[0])
    turn = np.array([quaternion_multiply(start, q) for q in turned])
    return Pull(state, force_W, apart - apart[0], turn)


def _each(flight: FlightData, of_pull: Callable[[Pull], float]) -> Vector:
    return np.array([of_pull(pull) for pull in pulls(flight)])


def _axes(attitudes: Points, axis: int) -> Points:
    """An axis (n, 3) of each of the attitudes (n, 4)."""
    unit = np.eye(3)[axis]
    return np.array([rotate(q, unit) for q in attitudes])


def _ratio(above: float, below: float, what: str) -> float:
    if below <= 0.0:
        raise NotMeasured(f"a pull caused no {what} at all to compare with")
    return above / below


def force_peak(flight: FlightData) -> float:
    """The largest force of the cord over all pulls, N."""
    return largest(_each(flight, lambda pull: pull.peak))


def angle_to_x_B_deg(flight: FlightData) -> float:
    """The largest angle between the cord's force and ±x_B above half of a pull's peak, degrees."""
    return float(np.degrees(largest(_each(flight, lambda pull: pull.angle_to_x_B))))


def displacement_max(flight: FlightData) -> float:
    """The largest distance of O_b from where it was when a pull began, m."""
    return largest(_each(flight, lambda pull: largest(np.linalg.norm(pull.displacement, axis=1))))


def displacement_along(flight: FlightData) -> float:
    """Of the pulls' displacements along their force the least, m."""
    return -largest(-_each(flight, lambda pull: pull.along))


def displacement_z(flight: FlightData) -> float:
    """The largest displacement up or down, m."""
    return largest(_each(flight, lambda pull: pull.upwards))


def attitude_motion(flight: FlightData) -> float:
    """The largest motion of the tip by the body's rotation, m."""
    return largest(_each(flight, lambda pull: pull.attitude_motion))


def along_over_z(flight: FlightData) -> float:
    """Displacement along the force over that in z; of the pulls the least."""
    return -largest(-_each(flight, lambda pull: _ratio(pull.along, pull.upwards, "motion in z")))


def along_over_attitude(flight: FlightData) -> float:
    """Displacement along the force over the tip's motion by rotation; of the pulls the least."""
    return -largest(
        -_each(flight, lambda pull: _ratio(pull.along, pull.attitude_motion, "rotation"))
    )


def metres_per_newton(flight: FlightData) -> float:
    """Displacement along the force over the peak force, mean over the pulls, m/N."""
    return mean(_each(flight, lambda pull: pull.along / pull.peak))


def torque_peak(flight: FlightData) -> float:
    """The cord's largest torque about z_B through O_b, N·m."""
    return largest(_each(flight, lambda pull: pull.torque))


def yaw_max(flight: FlightData) -> float:
    """The largest yaw away from where a pull began, rad."""
    return largest(_each(flight, lambda pull: pull.yaw))


def yaw_per_nm(flight: FlightData) -> float:
    """Largest yaw over largest torque about z_B, mean over the pulls, rad/(N·m)."""
    return mean(_each(flight, lambda pull: _ratio(pull.yaw, pull.torque, "torque about z_B")))
