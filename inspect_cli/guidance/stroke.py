"""Set-points that move along a smooth line on a surface: the pieces of a stroke as a trajectory.

A piece is parametrised by its arc length, gone along by the law of ``guidance.progress`` from
rest to rest, and handed out as quintic stretches like any other motion. The postures at knots of
time are interpolated by a quintic spline, which is at rest at both ends; between two knots it
is one quintic, so nothing is lost by writing it as stretches.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.interpolate import make_interp_spline

from inspect_cli.guidance.contact_frame import ContactFrame
from inspect_cli.guidance.progress import Progress
from inspect_cli.guidance.quintic import quintic_between
from inspect_cli.guidance.trajectory import Stretch, turn_between
from inspect_cli.interfaces import Posture
from inspect_cli.spatial.arrays import Matrix, Points, Structured, Vector
from inspect_cli.spatial.primitives import normal_at, point_at
from inspect_cli.spatial.rotations import quaternion_exp, quaternion_to_matrix

KNOT_S = 0.1
"""Between the knots of the spline."""
LEAST_KNOTS = 6

PostureAt = Callable[[float, float], Posture]
"""The posture whose tool is at the set-point of (u, v) m."""


def corrected(
    prim: Structured, planned: ContactFrame, believed: ContactFrame
) -> Callable[[float, float], ContactFrame]:
    """The contact frame at each (u, v) m of a surface that is moved as its contact point was.

    The believed surface, PRIMITIVE (1,), is turned by the least rotation that brings the planned
    normal onto the one that was seen, and shifted so that the contact points coincide. The tool
    is carried along likewise, so that it does not turn over on a stroke that leads far round.
    """
    R = _least_rotation(planned.n_W, believed.n_W)

    def aim_at(u: float, v: float) -> ContactFrame:
        p_WC = believed.p_WC + R @ (point_at(prim, 0, u, v) - planned.p_WC)
        n_W = R @ normal_at(prim, 0, u, v)
        carried = replace(believed, R_WT=_least_rotation(believed.n_W, n_W) @ believed.R_WT)
        return carried.at(p_WC, n_W)

    return aim_at


def _least_rotation(a: Vector, b: Vector) -> Matrix:
    """R (3, 3) with R a = b for unit vectors (3,); where they are opposite, the identity."""
    axis = np.cross(a, b)
    sine = float(np.linalg.norm(axis))
    if sine == 0.0:
        return np.eye(3)
    return quaternion_to_matrix(quaternion_exp(axis * (float(np.arctan2(sine, a @ b)) / sine)))


class StrokePath:
    """One smooth piece with its law of progress; ``points_m`` (n, 2) are (u, v)."""

    def __init__(self, points_m: Points, speed_mps: float, acceleration_mps2: float) -> None:
        steps = np.linalg.norm(np.diff(points_m, axis=0), axis=1)
        kept = np.concatenate([[True], steps > 0.0])
        points = points_m[kept]
        self._s = np.concatenate(
            [[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
        )
        self._line = make_interp_spline(self._s, points, k=min(3, len(points) - 1))
        slowest = self._speed_in_bends(speed_mps, acceleration_mps2)
        self.progress = Progress.along(float(self._s[-1]), slowest, acceleration_mps2)

    @property
    def duration_s(self) -> float:
        """From rest to rest."""
        return self.progress.duration_s

    def at(self, t_s: float) -> tuple[float, float]:
        """(u, v) m at ``t_s`` after the start."""
        u, v = self._line(self.progress.at(t_s)[0])
        return float(u), float(v)

    def _speed_in_bends(self, speed_mps: float, acceleration_mps2: float) -> float:
        """The speed whose centripetal acceleration v² κ stays within the limit everywhere."""
        if len(self._s) < 4:
            return speed_mps
        # Between two points the second derivative is linear, so it peaks at one of them.
        s = np.sort(np.concatenate([self._s, 0.5 * (self._s[1:] + self._s[:-1])]))
        d, dd = self._line(s, 1), self._line(s, 2)
        cross = np.abs(d[:, 0] * dd[:, 1] - d[:, 1] * dd[:, 0])
        bend = cross / np.maximum(np.linalg.norm(d, axis=1), 1e-9) ** 3
        sharpest = float(bend.max())
        if sharpest <= 0.0:
            return speed_mps
        return min(speed_mps, float(np.sqrt(acceleration_mps2 / sharpest)))


def along(t_s: float, path: StrokePath, posture_at: PostureAt) -> list[Stretch]:
    """The piece as stretches that begin at ``t_s``, at rest at both ends."""
    count = max(LEAST_KNOTS, int(np.ceil(path.duration_s / KNOT_S)))
    times = np.linspace(0.0, path.duration_s, count + 1)
    postures = [posture_at(*path.at(t)) for t in times]
    q_0 = np.asarray(postures[0].q_WB)
    rows = (
        np.array([posture.p_WB for posture in postures]),
        np.array([turn_between(q_0, posture.q_WB) for posture in postures]),
        np.array([posture.joint_angle for posture in postures]),
    )
    position, rotation, arm = (_quintics(times, values) for values in rows)
    step = path.duration_s / count
    return [
        Stretch(t_s + times[k], step, step, position[k], rotation[k], q_0, arm[k])
        for k in range(count)
    ]


def _quintics(times: Vector, values: Points) -> list[Matrix]:
    """Coefficients (6, n) in s between each two knots of the spline through ``values``."""
    n = values.shape[1]
    if n == 0:
        return [np.zeros((6, 0))] * (len(times) - 1)
    rest = [(1, np.zeros(n)), (2, np.zeros(n))]
    spline = make_interp_spline(times, values, k=5, bc_type=(rest, rest))
    rate, acceleration = spline(times, 1), spline(times, 2)
    step = times[1] - times[0]
    found = []
    for k in range(len(times) - 1):
        c = np.empty((6, n))
        quintic_between(
            values[k], rate[k], acceleration[k],
            values[k + 1], rate[k + 1], acceleration[k + 1],
            step, c,
        )  # fmt: skip
        found.append(c)
    return found
