"""A pitching crawler, built from its platform file."""

from __future__ import annotations

import mujoco

from inspect_cli.interfaces import TOOL
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.positioning import Estimation
from inspect_cli.vehicles.contacts import PatchContact, WheelContact
from inspect_cli.vehicles.fully_actuated.rigid_body import nominal_body
from inspect_cli.vehicles.kinds import Bodies
from pitching_crawler.abilities import CrawlerAbilities
from pitching_crawler.file_model import FOOT, CrawlerPlatform
from pitching_crawler.modes import BEHAVIOUR
from pitching_crawler.mujoco_model import JOINTS, actuators_of, build_spec
from pitching_crawler.stack import CrawlerStack


class PitchingCrawler:
    """One vehicle."""

    behaviour = BEHAVIOUR

    def __init__(self, platform: CrawlerPlatform) -> None:
        self.platform = platform
        self.bodies = Bodies(base="hub", gear=("legs",), protected=("guards", "arm"))
        self.frames = (TOOL, FOOT)
        self.contacts = (
            PatchContact(FOOT, ("sole",), FOOT, torsion_lever_m=platform.foot.half_m / 3.0),
            WheelContact("wheel", ("tyre",), TOOL, "wheel", platform.wheel.radius_m),
        )
        self.joints = JOINTS
        self.posture_joints = ("hinge",)
        self.actuators = actuators_of(platform)
        self._body = nominal_body(build_spec(platform))
        self.capabilities = CrawlerAbilities(platform, self._body, self.behaviour.modes)

    def nominal_spec(self) -> mujoco.MjSpec:
        """The nominal MuJoCo model, in free space."""
        return build_spec(self.platform)

    def flight_stack(self, plan: Plan, estimation: Estimation = "external") -> CrawlerStack:
        """A fresh stack of estimation, guidance and control."""
        start = plan.start.posture
        return CrawlerStack(self.platform, self.capabilities, self._body, start, estimation)
