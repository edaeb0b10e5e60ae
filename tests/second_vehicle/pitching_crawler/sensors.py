"""Simulated sensors that inspect does not have: joint encoders and a six-axis wrench sensor."""

from __future__ import annotations

import numpy as np

from inspect_cli.records import Lengths, Record, vector
from inspect_cli.sensing.instrument import Surroundings
from inspect_cli.spatial.rotations import rotate_back
from inspect_cli.truth.snapshot import Truth
from pitching_crawler.sensor_models import EncodersModel, WrenchSensorModel


class ContactForce(Record):
    """A sample of the force and torque on a contact, along the axes of B."""

    topic = "/sensor/contact_force"

    f_B = vector(3, "N", "B", "force of the surface on the contact")
    t_B = vector(3, "N·m", "B", "its torque about the origin of the contact's frame")


class Encoders(Record):
    """A sample of the angles of all joints."""

    topic = "/sensor/encoders"

    angle = vector("n_joints", "rad", "", "angles of the joints in the order of State.joint_angle")


class WrenchSensor:
    """The true wrench of a contact with white noise."""

    def __init__(self, model: WrenchSensorModel, rng: np.random.Generator) -> None:
        self.measurement = ContactForce.create()
        self._model, self._rng = model, rng

    def sample(self, truth: Truth) -> ContactForce:
        """Measure now."""
        model, noise = self._model, self._rng.standard_normal((2, 3))
        wrench_W, q_WB = truth.contact_wrench(model.contact), truth.state.q_WB
        self.measurement.t_s = truth.state.t_s
        self.measurement.f_B = rotate_back(q_WB, wrench_W[:3]) + model.force_noise_n * noise[0]
        self.measurement.t_B = rotate_back(q_WB, wrench_W[3:]) + model.torque_noise_nm * noise[1]
        return self.measurement


class EncoderSensor:
    """The true angles rounded to the encoders' steps."""

    def __init__(self, model: EncodersModel, lengths: Lengths) -> None:
        self.measurement = Encoders.create(lengths)
        self._step = model.step_rad

    def sample(self, truth: Truth) -> Encoders:
        """Measure now."""
        self.measurement.t_s = truth.state.t_s
        self.measurement.angle = self._step * np.round(truth.state.joint_angle / self._step)
        return self.measurement


def wrench_sensor(model: WrenchSensorModel, around: Surroundings) -> WrenchSensor:
    """The wrench sensor of a flight."""
    return WrenchSensor(model, around.rng)


def joint_encoders(model: EncodersModel, around: Surroundings) -> EncoderSensor:
    """The encoders of a flight."""
    return EncoderSensor(model, around.lengths)
