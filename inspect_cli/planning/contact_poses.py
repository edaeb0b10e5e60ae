"""How a vehicle stands before a point, touches it, and leans on it.

The tool meets the surface head on, z_T = −z_C, and y_T is parallel to the ground, which for a
rigid arm levels y_B (Bodie et al., "An omnidirectional aerial manipulation platform for
contact-based inspection", RSS 2019, section IV-E). This leaves the sign of y_T free.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from inspect_cli.guidance.orientation import contact_orientation
from inspect_cli.interfaces import (
    FREE,
    TOOL,
    Capabilities,
    ContactLaw,
    FramePose,
    Posture,
    Shortfall,
    pushed_along,
)
from inspect_cli.planning.points import ContactPoint
from inspect_cli.spatial.arrays import Matrix, Vector
from inspect_cli.spatial.rotations import quaternion_to_matrix


@dataclass(frozen=True)
class Touch:
    """The postures of one contact: before it, with the tip on the surface, and set behind it.

    ``setpoint`` is what the vehicle is asked for while it presses; the surface holds it at
    ``contact``.
    """

    R_WT: Matrix
    standoff: Posture
    contact: Posture
    setpoint: Posture

    @property
    def upright(self) -> bool:
        """Whether z_B points up at the contact."""
        return bool(quaternion_to_matrix(self.contact.q_WB)[2, 2] > 0.0)


def tool_attitudes(n_W: Vector, y_near_W: Vector) -> tuple[Matrix, Matrix]:
    """The two R_WT (3, 3) with z_T = −n and level y_T; first the one nearer to ``y_near_W``.

    Where z_T is within 1° of the vertical, y_T is the level part of ``y_near_W`` made square to
    z_T, so that the heading is kept, or its opposite.
    """
    near = contact_orientation(n_W, _level(y_near_W))
    return near, near * np.array([-1.0, -1.0, 1.0])


def touches(
    capabilities: Capabilities, point: ContactPoint, law: ContactLaw, previous: Posture
) -> list[Touch] | Shortfall:
    """The ways to touch a point, best first; or why it is out of reach.

    Of the two, first the one closer to the heading of the posture ``previous``. The vehicle
    stays upright, z_B · z_W > 0, wherever one of them allows it. In contact and at the set-point
    the surface pushes the tool with the force that the law of contact expects.
    """
    y_near_W = capabilities.frame_pose(previous, TOOL)[1][:, 1]
    found, short = [], Shortfall()
    for R_WT in tool_attitudes(point.n_W, y_near_W):
        touch = _touch(capabilities, point, R_WT, law, previous)
        if isinstance(touch, Touch):
            found.append(touch)
        else:
            short = touch
    return [touch for touch in found if touch.upright] or found or short


def _touch(
    capabilities: Capabilities,
    point: ContactPoint,
    R_WT: Matrix,
    law: ContactLaw,
    previous: Posture,
) -> Touch | Shortfall:
    pushed = pushed_along(point.n_W, law.expected_force_n)
    postures: list[Posture] = []
    for distance_m, loads in (
        (point.options.standoff_m, FREE),
        (0.0, pushed),
        (-law.depth_m, pushed),
    ):
        near = postures[-1] if postures else previous
        goals = {TOOL: FramePose(point.in_front(distance_m), R_WT)}
        posture = capabilities.solve(goals, loads, near)
        if isinstance(posture, Shortfall):
            return posture
        postures.append(posture)
    return Touch(R_WT, *postures)


def _level(y_W: Vector) -> Vector:
    """The level part of a direction, of unit length; along y of W where it is vertical."""
    norm = float(np.hypot(y_W[0], y_W[1]))
    if norm < 1e-9:
        return np.array([0.0, 1.0, 0.0])
    return np.array([y_W[0] / norm, y_W[1] / norm, 0.0])
