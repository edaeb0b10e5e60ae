"""Sensors that inspect does not have: a six-axis sensor under the foot and joint encoders."""

from __future__ import annotations

import numpy as np

from inspect_cli.records import Record, State, vector
from inspect_cli.spatial.rotations import rotate_back
from inspect_cli.vehicles.contacts import ContactWrench
from pitching_crawler.numbers import CrawlerNumbers


class FootWrench(Record):
    """A sample of the force and torque on the foot, in the foot's frame, which is parallel to B."""

    topic = "/sensor/foot_wrench"

    f_B = vector(3, "N", "B", "force of the surface on the foot")
    t_B = vector(3, "N·m", "B", "its torque about the middle of the sole")


class Encoders(Record):
    """A sample of the angles of all joints."""

    topic = "/sensor/encoders"

    angle = vector("n_joints", "rad", "", "angles of the arm's hinge and of the wheel")


class FootSensor:
    """The true wrench of the foot with white noise."""

    def __init__(self, numbers: CrawlerNumbers, rng: np.random.Generator) -> None:
        self.measurement = FootWrench.create()
        self._noise_n, self._noise_nm = numbers.foot_force_noise_n, numbers.foot_torque_noise_nm
        self._rng = rng

    def sample(self, state: State, foot: ContactWrench) -> None:
        """Measure now."""
        noise = self._rng.standard_normal((2, 3))
        self.measurement.t_s = state.t_s
        self.measurement.f_B = rotate_back(state.q_WB, foot.f_W) + self._noise_n * noise[0]
        self.measurement.t_B = rotate_back(state.q_WB, foot.t_W) + self._noise_nm * noise[1]


class EncoderSensor:
    """The true angles rounded to the encoders' steps."""

    def __init__(self, numbers: CrawlerNumbers, lengths: dict[str, int]) -> None:
        self.measurement = Encoders.create(lengths)
        self._step = numbers.encoder_step_rad

    def sample(self, state: State) -> None:
        """Measure now."""
        self.measurement.t_s = state.t_s
        self.measurement.angle = self._step * np.round(state.joint_angle / self._step)
