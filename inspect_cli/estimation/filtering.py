"""One inertial sample, or one pose, through the error-state filter: a single kernel for each.

The filter's memory is handed over in arrays that the kernels change: ``p``, ``v``, ``q``, ``bias``
and ``P`` as in ``inspect_cli.estimation.kalman``; ``held`` (6,) the last inertial sample (f, w);
``times`` (3,) s the time of the belief, of the last sample (NaN before the first) and of the last
pose. ``noise`` (4,) and ``imu_hz`` are constants of the inertial unit.
"""

from __future__ import annotations

import numpy as np

from inspect_cli.compiled import kernel
from inspect_cli.estimation.kalman import (
    correct_pose,
    frame_drifts,
    pose_innovation,
    propagate,
    publish,
    take_sample,
)
from inspect_cli.spatial.arrays import Matrix, Structured, Vector


@kernel
def advance(
    p: Vector,
    v: Vector,
    q: Vector,
    bias: Vector,
    P: Matrix,
    sample: Vector,
    times: Vector,
    noise: Vector,
    imu_hz: float,
    dt: float,
) -> None:
    """Propagate by ``dt`` s with one sample."""
    # A sample that serves for longer than its period carries its error all along.
    stretch = dt * imu_hz
    if stretch < 1.5:
        propagate(p, v, q, bias, P, sample, dt, noise)
    else:
        more = np.empty(4)
        for i in range(4):
            more[i] = noise[i] * stretch
        propagate(p, v, q, bias, P, sample, dt, more)
    times[0] += dt


@kernel
def advance_to_sample(
    t_measured: Vector,
    f: Vector,
    w: Vector,
    p: Vector,
    v: Vector,
    q: Vector,
    bias: Vector,
    P: Matrix,
    held: Vector,
    times: Vector,
    noise: Vector,
    imu_hz: float,
    estimate: Structured,
) -> None:
    """Advance to a sample (f, w) with the mean of it and the last; ignore what is not finite."""
    t = t_measured[0]
    dt = t - times[0]
    share = 1.0
    if dt > 0.0 and not np.isnan(times[1]):
        share = 0.5 * (t - times[1]) / dt
    mean = np.empty(6)
    if not take_sample(held, mean, f, w, share):
        return
    times[1] = t
    if dt > 0.0:
        advance(p, v, q, bias, P, mean, times, noise, imu_hz, dt)
    publish(p, v, q, bias, P, held, times, estimate)


@kernel
def correct_to_pose(
    t_measured: Vector,
    p_measured: Vector,
    q_measured: Vector,
    p: Vector,
    v: Vector,
    q: Vector,
    bias: Vector,
    P: Matrix,
    held: Vector,
    times: Vector,
    noise: Vector,
    imu_hz: float,
    walks: Vector,
    variance: Vector,
    gate: float,
    estimate: Structured,
) -> float:
    """Advance to a measured pose and correct with it; return the innovation's χ².

    ``walks`` (3,) are those of ``frame_drifts``, ``variance`` (6,) and ``gate`` those of
    ``correct_pose``.
    """
    t = t_measured[0]
    dt = t - times[0]
    if dt > 0.0 and not np.isnan(times[1]):
        advance(p, v, q, bias, P, held, times, noise, imu_hz, dt)
    since = t - times[2]
    times[2] = t
    if since > 0.0 and (walks[0] != 0.0 or walks[1] != 0.0 or walks[2] != 0.0):
        rate = np.empty(3)
        for i in range(3):
            rate[i] = held[3 + i] - bias[3 + i]
        frame_drifts(P, q, v, rate, walks, since)
    innovation = pose_innovation(p, q, p_measured, q_measured)
    chi2 = correct_pose(p, v, q, bias, P, innovation, variance, gate)
    publish(p, v, q, bias, P, held, times, estimate)
    return chi2
