"""Segments of a flight: what the vehicle does at one place, with the way there.

A segment begins with the way there and ends at a stop from which the next way starts. The planner
of a task makes segments (``planning.tasks``), and ``planner`` joins them to a flight.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from inspect_cli.interfaces import Margins, Posture
from inspect_cli.planning.contact_poses import Touch
from inspect_cli.planning.feasibility import Assessment
from inspect_cli.planning.path import Stop, Way
from inspect_cli.planning.points import ContactPoint
from inspect_cli.schema.base import Triple
from inspect_cli.schema.plan import LegKind, MarginModel, PostureModel, Target
from inspect_cli.spatial.arrays import Vector
from inspect_cli.spatial.rotations import matrix_to_quaternion


@dataclass(frozen=True)
class Stretch:
    """A leg before it has its times; ``postures`` are those after the leg before.

    ``dwell_s`` is spent at its end, ``moving_s`` on a way that its postures do not show.
    """

    kind: LegKind
    target: int | None
    postures: Way
    dwell_s: float = 0.0
    moving_s: float = 0.0
    speed_mps: float | None = None
    """Instead of the speed of its kind."""


class Segment(Protocol):
    """One piece of work with the way to it."""

    @property
    def way(self) -> Way:
        """The way-points from the stop before; empty when it begins where the last one ended."""
        ...

    @property
    def label(self) -> str:
        """What people call it."""
        ...

    @property
    def stop(self) -> Stop:
        """Where it ends, as far as can be known."""
        ...

    @property
    def tips_W(self) -> tuple[Vector, ...]:
        """Where the tool's tip goes, for the reach of its cable."""
        ...

    def stretches(self, index: int) -> Iterator[Stretch]:
        """Its legs after the way there, as the ``index``-th target of the plan."""
        ...

    def target(self, index: int) -> Target:
        """Its entry among the plan's targets."""
        ...


def touching_target(
    index: int, kind: str, point: ContactPoint, touch: Touch, found: Assessment
) -> Target:
    """The part of a target that every touch of a believed surface has."""
    w, x, y, z = (float(value) for value in matrix_to_quaternion(touch.R_WT))
    options = point.options
    return Target.model_validate(
        {
            "index": index,
            "label": point.label,
            "kind": kind,
            "impedance": point.impedance,
            "surface": point.surface,
            "uv_m": point.uv_m,
            "p_WC": triple(point.p_WC),
            "n_W": triple(point.n_W),
            "q_WT": (w, x, y, z),
            "sensor": None,
            "law": found.law,
            "dwell_s": 0.0,
            "standoff_m": options.standoff_m,
            "standoff": posture_model(touch.standoff),
            "contact": posture_model(touch.contact),
            "margins": margin_models(found.margins),
            "clearance_m": found.gap.structure_m,
        }
    )


def margin_models(margins: Margins) -> dict[str, MarginModel]:
    """The margins as they are written; what has no limit is left out."""
    return {
        name: MarginModel(value=margin.value, unit=margin.unit)
        for name, margin in margins.items()
        if np.isfinite(margin.value)
    }


def posture_model(posture: Posture) -> PostureModel:
    """A posture as it is written."""
    w, x, y, z = (float(value) for value in posture.q_WB)
    return PostureModel(
        p_WB=triple(posture.p_WB),
        q_WB=(w, x, y, z),
        arm_angle_rad=tuple(float(angle) for angle in posture.joint_angle),
    )


def triple(a: Vector) -> Triple:
    """Three numbers as a file keeps them."""
    return (float(a[0]), float(a[1]), float(a[2]))
