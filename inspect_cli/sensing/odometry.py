"""Simulated visual-inertial odometry: poses without an absolute reference.

It starts at the true pose and adds up motion. Between two samples the body moves by Δ in W, over
the distance d = |Δ|, and turns by the angle θ; with the run's constants s, α and standard normal
numbers n_i,

    ψ ← ψ + √(σ_ψd² d + σ_ψθ² θ) n₁                  drift of the yaw
    p̂ ← p̂ + (1 + s) R_z(ψ) Δ + σ_p √d n₂             drift of the position
    p̂ ← p̂ + u Δt                                   a steady drift, where the truth states one
    p_m = p̂ + σ_w n₃
    R_m = R_z(ψ) R_WB Exp((α_x, α_y, 0)) Exp(σ_θ n₄)

The variance of the random walks so is σ² times the distance travelled, whatever the rate is, and
but for u, which stands for a place with poor features, nothing drifts while the body is at rest.
Gravity is observed: roll and pitch have the constant misalignment α of the inertial unit and white
noise, but no drift. A wrong yaw bends the path, as dead reckoning does. Distance is taken between
samples, along the chord: at 30 Hz a path of radius 0.1 m flown at 1 m/s is 0.5 % longer.

s ~ N(0, ``scale_error``²) and α_i ~ N(0, ``tilt_error_rad``²) are drawn once per run. Source of
the form: drift of visual odometry is stated, and evaluated, per distance travelled (A. Geiger et
al., "Are we ready for autonomous driving? The KITTI vision benchmark suite", CVPR 2012); position
and yaw are the four unobservable directions of visual-inertial estimation (J. Hesch et al.,
"Consistency analysis and improvement of vision-aided inertial navigation", T-RO 30, 2014).
"""

from __future__ import annotations

import numpy as np

from inspect_cli.compiled import bound, kernel
from inspect_cli.records import Odometry, State
from inspect_cli.schema.base import Triple
from inspect_cli.schema.vehicle import OdometryModel
from inspect_cli.sensing.instrument import Noise, Surroundings
from inspect_cli.sensing.pose_tracker import measure_pose
from inspect_cli.spatial.arrays import Indices, Matrix, Vector
from inspect_cli.spatial.rotations import (
    quaternion_conjugate,
    quaternion_exp,
    quaternion_log,
    quaternion_multiply,
    rotate,
)
from inspect_cli.truth.snapshot import Truth


@kernel
def yaw_turn(yaw: float) -> Vector:
    """The quaternion of R_z(yaw)."""
    return np.array([np.cos(0.5 * yaw), 0.0, 0.0, np.sin(0.5 * yaw)])


@kernel
def drift(
    p: Vector, q: Vector, last: Vector, walks: Vector, scale: float, noise: Vector, believed: Vector
) -> None:
    """Add the motion from ``last`` (7,) = (p, q) to (p, q) to ``believed`` (4,) = (p̂, ψ).

    ``walks`` (3,) = (σ_p, σ_ψd, σ_ψθ); ``noise`` (4,) standard normal for ψ and p̂. ``last`` becomes
    (p, q).
    """
    moved = p - last[:3]
    distance = np.sqrt(moved[0] ** 2 + moved[1] ** 2 + moved[2] ** 2)
    turn = quaternion_log(quaternion_multiply(quaternion_conjugate(last[3:]), q))
    angle = np.sqrt(turn[0] ** 2 + turn[1] ** 2 + turn[2] ** 2)
    believed[3] += np.sqrt(walks[1] ** 2 * distance + walks[2] ** 2 * angle) * noise[0]
    seen = rotate(yaw_turn(believed[3]), moved)
    for i in range(3):
        believed[i] += (1.0 + scale) * seen[i] + walks[0] * np.sqrt(distance) * noise[1 + i]
        last[i] = p[i]
    for i in range(4):
        last[3 + i] = q[i]


@kernel
def dead_reckon(
    t: Vector,
    p: Vector,
    q: Vector,
    noises: Matrix,
    row: Indices,
    steady: Vector,
    tilt: Vector,
    last: Vector,
    walks: Vector,
    scale: float,
    believed: Vector,
    white: Vector,
    t_measured: Vector,
    p_measured: Vector,
    q_measured: Vector,
) -> None:
    """Write time (1,) and pose, measured with the noise ``noises[row[0]]`` (10,).

    ``steady`` (3,) m/s is u in W, ``tilt`` (4,) the misalignment as a quaternion, ``white`` (2,)
    = (σ_w, σ_θ). ``t_measured`` before the call is the time of the last sample.
    """
    noise = noises[row[0]]
    since = t[0] - t_measured[0]
    for i in range(3):
        believed[i] += steady[i] * since
    drift(p, q, last, walks, scale, noise[0:4], believed)
    turned = quaternion_multiply(yaw_turn(believed[3]), quaternion_multiply(q, tilt))
    t_measured[0] = t[0]
    measure_pose(believed[0:3], turned, noise[4:10], white, p_measured, q_measured)


class OdometrySensor:
    """Pose of the body, by adding up its motion from the first sample on.

    ``drift_mps`` (3,) is u in W.
    """

    def __init__(
        self,
        model: OdometryModel,
        rng: np.random.Generator,
        drift_mps: Triple = (0.0, 0.0, 0.0),
    ) -> None:
        self._drift_mps = np.array(drift_mps)
        self.measurement = Odometry.create()
        self._walks = np.array([model.position_walk, model.yaw_walk_moved, model.yaw_walk_turned])
        self._white = np.array([model.position_noise_m, model.attitude_noise_rad])
        constants = rng.standard_normal(3)
        self._scale = float(model.scale_error * constants[0])
        tilt = np.array([model.tilt_error_rad, model.tilt_error_rad, 0.0])
        tilt[:2] *= constants[1:]
        self._tilt = quaternion_exp(tilt)
        self._noise = Noise(rng, 10)
        self._last = np.zeros(7)
        self._believed = np.zeros(4)
        self._state: State | None = None
        self._started = False

    def sample(self, truth: Truth) -> Odometry:
        """Measure now."""
        state = truth.state
        if not self._started:
            self._believed[:3] = self._last[:3] = state.p_WB
            self._last[3:] = state.q_WB
            self.measurement.t_s = state.t_s
            self._started = True
        if state is not self._state:
            self._state = state
            true, measured = state.views, self.measurement.views
            self._measure = bound(
                dead_reckon,
                true["t_s"],
                true["p_WB"],
                true["q_WB"],
                self._noise.block,
                self._noise.row,
                self._drift_mps,
                self._tilt,
                self._last,
                self._walks,
                self._scale,
                self._believed,
                self._white,
                measured["t_s"],
                measured["p_WB"],
                measured["q_WB"],
            )
        self._noise.advance()
        self._measure()
        return self.measurement


def odometry_sensor(model: OdometryModel, around: Surroundings) -> OdometrySensor:
    """The odometry of a flight, with the steady drift that the truth states."""
    return OdometrySensor(model, around.rng, around.truth.platform.odometry_drift_mps)
