"""Contacts: the parts of a vehicle that touch surfaces on purpose, and the law of each.

All slide at the Coulomb limit μ N, with the friction μ of the surface that they touch.
``simulation.world`` turns the laws into MuJoCo's numbers.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

from inspect_cli.records import Record, vector

SETTLING_S = 0.005
"""Time constant in which a stiff contact settles; MuJoCo asks for two steps or more."""


@dataclass(frozen=True)
class PointContact:
    """A sphere that touches at one point, with a stated spring and damper along the normal."""

    name: str
    geoms: tuple[str, ...]
    """Names of the geoms that touch."""
    frame: str
    """The site whose origin torques refer to."""
    stiffness_npm: float
    damping_ratio: float
    """Of the whole vehicle's mass on that spring."""


@dataclass(frozen=True)
class WheelContact:
    """A wheel, stiff along the normal; it rolls on its joint without slip below the limit."""

    name: str
    geoms: tuple[str, ...]
    frame: str
    joint: str
    radius_m: float
    """The wheel rolls ``radius_m`` per radian of its joint."""
    settling_s: float = SETTLING_S


@dataclass(frozen=True)
class PatchContact:
    """A plate, stiff along the normal, which also resists twisting about the normal.

    Points at the distance r from the middle that carry N together hold a torque up to
    μ N √(r² + lever²) about the normal.
    """

    name: str
    geoms: tuple[str, ...]
    frame: str
    torsion_lever_m: float
    """Lever of the friction inside each point: of a disc of radius a, evenly pressed, 2a/3."""
    settling_s: float = SETTLING_S


Contact = PointContact | WheelContact | PatchContact


class ContactWrench(Record):
    """True force and torque on one contact; each contact has a topic of its own below this."""

    topic = "/truth/contact"

    f_W = vector(3, "N", "W", "force of the surface on the contact")
    t_W = vector(3, "N·m", "W", "its torque about the origin of the contact's frame")


@cache
def wrench_record(contact: str) -> type[ContactWrench]:
    """The record of a contact, with the topic ``/truth/contact/<name>``."""
    topic = f"{ContactWrench.topic}/{contact}"
    return type(ContactWrench.__name__, (ContactWrench,), {"topic": topic, "__slots__": ()})
