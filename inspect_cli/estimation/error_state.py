"""Error-state Kalman filter: inertial samples propagate, pose measurements correct.

The mathematics stands in ``inspect_cli.estimation.kalman``; here stand time, gate and recovery.

An inertial sample is taken at an instant. Between two samples the filter uses their mean (the
trapezoidal rule), so it is not half a sample behind. A pose that falls between two samples is
reached with the older sample held; the rest of the interval then gets what is missing from
the trapezoid.

Poses may come from a tracker or from odometry, which has no absolute reference: they are white
noise around a frame that drifts as the vehicle moves. The belief lives in that frame. What the
frame does between two poses, the inertial unit does not feel; it is process noise of position and
yaw (``frame_drifts``), without which the filter would hold a millimetre of drift for an outlier.
Nothing on board can observe the drift itself: ``covariance`` is that of the belief against the
odometry's frame, and the error against W is larger and grows without a bound.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final

import numpy as np

from inspect_cli.compiled import Bound, bound
from inspect_cli.estimation.filtering import advance_to_sample, correct_to_pose
from inspect_cli.estimation.kalman import STATES, publish
from inspect_cli.records import Estimate, Imu, Pose
from inspect_cli.schema.positioning import PoseNoise
from inspect_cli.schema.vehicle import ImuModel
from inspect_cli.spatial.rotations import quaternion_normalize

GATE: Final = 38.258
"""A pose is rejected above this: the χ² quantile (6 degrees of freedom) of probability 1 − 1e-6."""

RESTART_S: Final = 0.2
"""Poses rejected in a row for so long are believed against the filter."""

START_SPEED_MPS: Final = 1.0
"""Standard deviation of each velocity component when the motion (re)starts from a pose."""

# The least noise that the filter assumes. An ideal sensor still leaves out what happens between
# its samples, and a covariance of exactly zero would never learn again.
ACCEL_FLOOR: Final = 1e-4
GYRO_FLOOR: Final = 1e-5
POSITION_FLOOR_M: Final = 1e-5
ATTITUDE_FLOOR_RAD: Final = 1e-5


class ErrorStateFilter:
    """Position, velocity, attitude and inertial biases of the body.

    ``covariance`` (15, 15) is that of the error state, in the order of ``Estimate.sigma``.
    ``rejected`` counts the poses rejected in a row. A lone outlier is ignored; after
    ``restart_after`` of them (``RESTART_S``) position and attitude are taken from the pose
    and the velocity is learnt anew, while the biases and their covariance stay.
    """

    def __init__(
        self, imu_model: ImuModel, pose_model: PoseNoise, imu_hz: int, pose_hz: int
    ) -> None:
        self.restart_after = max(2, round(RESTART_S * pose_hz))
        self._bias_variance = np.repeat(
            [imu_model.accel_bias_initial_mps2**2, imu_model.gyro_bias_initial_radps**2], 3
        )
        density = [
            max(imu_model.accel_noise, ACCEL_FLOOR),
            max(imu_model.gyro_noise, GYRO_FLOOR),
            imu_model.accel_bias_walk,
            imu_model.gyro_bias_walk,
        ]
        self._noise = np.square(density)
        position_sd = max(pose_model.position_noise_m, POSITION_FLOOR_M)
        attitude_sd = max(pose_model.attitude_noise_rad, ATTITUDE_FLOOR_RAD)
        self._pose_variance = np.repeat([position_sd**2, attitude_sd**2], 3)
        self._walks = np.array(pose_model.walks)
        self._p, self._v, self._q = np.zeros(3), np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0])
        self._bias = np.zeros(6)
        self.covariance = np.zeros((STATES, STATES))
        self._held, self._times = np.zeros(6), np.array([0.0, math.nan, 0.0])
        self.rejected = 0
        self._belief = (self._p, self._v, self._q, self._bias, self.covariance)
        self._sampling = (self._held, self._times, self._noise, float(imu_hz))

    def start(self, pose: Pose, estimate: Estimate) -> None:
        """Begin at rest at a measured pose, with biases unknown as the model says.

        Raises ValueError for a pose that is not finite.
        """
        if not (np.isfinite(pose.p_WB).all() and np.isfinite(pose.q_WB).all()):
            raise ValueError("the filter cannot start from a pose that is not finite")
        self._bias[:] = 0.0
        self.covariance[:] = 0.0
        np.fill_diagonal(self.covariance[9:, 9:], self._bias_variance)
        self._held[:] = 0.0
        self._times[:] = (pose.t_s, math.nan, pose.t_s)
        self._restart_motion(pose)
        self._publish(estimate)

    def bind_propagation(self, imu: Imu, estimate: Estimate) -> Bound:
        """The advance to the time of an inertial sample; one that is not finite is ignored."""
        return bound(
            advance_to_sample,
            *imu.views.values(),
            *self._belief,
            *self._sampling,
            estimate.array,
        )

    def bind_correction(self, pose: Pose, estimate: Estimate) -> Callable[[], bool]:
        """The correction by a pose measurement; False if it was rejected or is not finite."""
        to_pose = bound(
            correct_to_pose,
            *pose.views.values(),
            *self._belief,
            *self._sampling,
            self._walks,
            self._pose_variance,
            GATE,
            estimate.array,
        )

        def correct() -> bool:
            chi2 = to_pose()
            if chi2 <= GATE:
                self.rejected = 0
                return True
            if not self._outvoted(pose, chi2):
                return False
            self._publish(estimate)
            return True

        return correct

    def _outvoted(self, pose: Pose, chi2: float) -> bool:
        """Count a rejection; restart from the pose when there were too many."""
        if math.isnan(chi2):
            return False
        self.rejected += 1
        if self.rejected < self.restart_after:
            return False
        self._restart_motion(pose)
        return True

    def _restart_motion(self, pose: Pose) -> None:
        self._p[:] = pose.p_WB
        self._q[:] = quaternion_normalize(pose.q_WB)
        self._v[:] = 0.0
        self.covariance[:9, :] = 0.0
        self.covariance[:, :9] = 0.0
        position, attitude = self._pose_variance[:3], self._pose_variance[3:]
        speed = np.full(3, START_SPEED_MPS**2)
        np.fill_diagonal(self.covariance[:9, :9], np.concatenate([position, speed, attitude]))
        self.rejected = 0

    def _publish(self, estimate: Estimate) -> None:
        publish(*self._belief, self._held, self._times, estimate.array)
