"""Level poses in free air: the way there, and the part of a target that they have in common."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from inspect_cli.interfaces import FREE, TOOL, Capabilities, Margins, Posture
from inspect_cli.planning.clearance import gap_along
from inspect_cli.planning.feasibility import Reason, gap_reasons, margin_reasons
from inspect_cli.planning.path import Stop, Way
from inspect_cli.planning.segments import margin_models, posture_model, triple
from inspect_cli.planning.tasks.situation import Situation
from inspect_cli.schema.base import Triple
from inspect_cli.schema.plan import Target
from inspect_cli.spatial.rotations import matrix_to_quaternion, quaternion_exp


@dataclass(frozen=True)
class FreePose:
    """A pose in free air with the way there; ``clearance_m`` is infinite without a structure."""

    posture: Posture
    way: Way
    margins: Margins
    clearance_m: float


def free_pose(
    situation: Situation, position_m: Triple, heading_deg: float, before: Stop
) -> FreePose | list[Reason]:
    """A level pose of O_b in free air with the way there, or why it cannot be."""
    capabilities = situation.capabilities
    q_WB = quaternion_exp(np.array([0.0, 0.0, np.radians(heading_deg)]))
    posture = Posture(np.array(position_m), q_WB, before.posture.joint_angle)
    margins = capabilities.margins(posture, FREE)
    gap = gap_along(capabilities, situation.scene, [posture, posture])
    reasons = [
        *margin_reasons(margins, "holding still there"),
        *gap_reasons(gap, situation.limits.clearance_m),
    ]
    if reasons:
        return reasons
    way = situation.way(before, Stop(posture, np.zeros(3)))
    if isinstance(way, list):
        return way
    return FreePose(posture, way, margins, gap.structure_m)


def looking_target(
    index: int,
    kind: str,
    label: str,
    impedance: str,
    capabilities: Capabilities,
    pose: FreePose,
) -> Target:
    """The part of a target in free air: the tool's own place and axis stand for the surface's."""
    p_WT, R_WT = capabilities.frame_pose(pose.posture, TOOL)
    w, x, y, z = (float(value) for value in matrix_to_quaternion(np.ascontiguousarray(R_WT)))
    here = posture_model(pose.posture)
    return Target.model_validate(
        {
            "index": index,
            "label": label,
            "kind": kind,
            "impedance": impedance,
            "surface": None,
            "uv_m": None,
            "p_WC": triple(p_WT),
            "n_W": triple(-R_WT[:, 2]),
            "q_WT": (w, x, y, z),
            "sensor": None,
            "law": None,
            "dwell_s": 0.0,
            "standoff_m": 0.0,
            "standoff": here,
            "contact": here,
            "margins": margin_models(pose.margins),
            "clearance_m": pose.clearance_m if np.isfinite(pose.clearance_m) else None,
        }
    )
