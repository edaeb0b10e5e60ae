"""A vehicle that leans to push: six coplanar rotors, a sprung arm with a driven wheel, a foot."""

from __future__ import annotations

import mujoco

from inspect_cli.interfaces import TOOL, Posture
from inspect_cli.vehicles.contacts import PatchContact, WheelContact
from inspect_cli.vehicles.fully_actuated.rigid_body import nominal_body
from inspect_cli.vehicles.kinds import Bodies
from pitching_crawler.abilities import CrawlerAbilities
from pitching_crawler.modes import BEHAVIOUR
from pitching_crawler.mujoco_model import FOOT, JOINTS, actuators_of, build_spec
from pitching_crawler.numbers import CrawlerNumbers
from pitching_crawler.stack import CrawlerStack


class PitchingCrawler:
    """One vehicle, built from its numbers."""

    behaviour = BEHAVIOUR

    def __init__(self, numbers: CrawlerNumbers | None = None) -> None:
        self.numbers = numbers or CrawlerNumbers()
        self.bodies = Bodies(base="hub", gear=("legs",), protected=("guards", "arm"))
        self.frames = (TOOL, FOOT)
        self.contacts = (
            PatchContact(FOOT, ("sole",), FOOT, torsion_lever_m=self.numbers.foot_half_m / 3.0),
            WheelContact("wheel", ("tyre",), TOOL, "wheel", self.numbers.wheel_radius_m),
        )
        self.joints = JOINTS
        self.posture_joints = ("hinge",)
        self.actuators = actuators_of(self.numbers)
        self._body = nominal_body(build_spec(self.numbers))
        self.capabilities = CrawlerAbilities(self.numbers, self._body)

    def nominal_spec(self) -> mujoco.MjSpec:
        """The nominal MuJoCo model, in free space."""
        return build_spec(self.numbers)

    def flight_stack(self, start: Posture) -> CrawlerStack:
        """A fresh stack of estimation, guidance and control."""
        return CrawlerStack(self.numbers, self.capabilities, self._body, start)
