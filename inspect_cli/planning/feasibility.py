"""Why a point cannot be touched: reach of the cable, force, actuators, room for the body."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from inspect_cli.interfaces import FREE, Capabilities, ContactLaw, Margins, least, pushed_along
from inspect_cli.planning.clearance import Gap, Scene, gap_along
from inspect_cli.planning.contact_poses import Touch
from inspect_cli.planning.points import ContactPoint, in_words
from inspect_cli.schema.start import Start
from inspect_cli.spatial.arrays import Vector


class Reason(NamedTuple):
    """What stands in the way, with its numbers, and what may help."""

    what: str
    hint: str = ""


@dataclass(frozen=True)
class Limits:
    """What a mission and its instrument ask of every contact.

    ``clamp_W`` (3,) m is where the cable is fastened.
    """

    clearance_m: float
    cable_m: float
    clamp_W: Vector
    min_force_n: float


@dataclass(frozen=True)
class Assessment:
    """What a touch comes to; it can be flown when there are no reasons against it."""

    law: ContactLaw
    margins: Margins
    gap: Gap
    reasons: tuple[Reason, ...]


def assess(
    capabilities: Capabilities, scene: Scene, point: ContactPoint, touch: Touch, limits: Limits
) -> Assessment:
    """Check one way of touching a point, from standoff to contact and back.

    In contact the surface pushes the tool's tip along its outward normal with the expected
    force f: the wrench on the tip is (f n, 0).
    """
    law = capabilities.contact_law(point.options, point.impedance)
    force_n = law.expected_force_n
    free = capabilities.margins(touch.standoff, FREE)
    loaded = capabilities.margins(touch.contact, pushed_along(point.n_W, force_n))
    gap = gap_along(capabilities, scene, [touch.standoff, touch.contact])
    reasons = [
        *cable_reasons(point, limits),
        *_force_reasons(force_n, point, limits),
        *margin_reasons(free, "holding still before it"),
        *margin_reasons(loaded, f"pressing with {force_n:.2f} N"),
        *gap_reasons(gap, limits.clearance_m),
    ]
    return Assessment(law, least([free, loaded]), gap, tuple(reasons))


def clamp_of(start: Start) -> Vector:
    """Where the cable is fastened, (3,) m in W: on the ground under the start."""
    return np.array([*start.position_m, 0.0])


def cable_span_m(point: ContactPoint, clamp_W: Vector) -> float:
    """The straight distance, m, that the cable has to span."""
    return float(np.linalg.norm(point.p_WC - clamp_W))


def cable_reasons(point: ContactPoint, limits: Limits) -> list[Reason]:
    """Whether the cable spans the straight distance from its clamp."""
    span_m = cable_span_m(point, limits.clamp_W)
    if span_m <= limits.cable_m:
        return []
    what = f"{span_m:.2f} m from the start, the cable is {limits.cable_m:.2f} m long"
    return [Reason(what, "start closer to the points or use a longer cable")]


def margin_reasons(margins: Margins, doing: str) -> list[Reason]:
    """Which of the vehicle's limits do not hold, in the vehicle's own words."""
    reasons = []
    for name, margin in margins.items():
        if not margin.holds:
            lack = margin.lack or f"leaves a margin '{name}' of {margin.value:.3g} {margin.unit}"
            reasons.append(Reason(f"{doing} {lack}", margin.hint))
    return reasons


def gap_reasons(gap: Gap, clearance_m: float) -> list[Reason]:
    """Whether the body has the room that is asked for."""
    reasons = []
    where = f"'{gap.surface}' near {in_words(gap.p_W)}"
    if gap.structure_m < 0.0:
        what = f"the body overlaps {where} by {-gap.structure_m:.3f} m"
        reasons.append(Reason(what, "move the point away from it, or use a longer tool"))
    elif not gap.structure_m >= clearance_m:
        what = (
            f"the body comes within {gap.structure_m:.3f} m of {where}, "
            f"clearance_m is {clearance_m:.3f}"
        )
        reasons.append(Reason(what, "move the point away from it, or allow less clearance"))
    if not gap.ground_m >= 0.0:
        what = f"the body reaches {-gap.ground_m:.3f} m below the ground"
        reasons.append(Reason(what, "touch a higher point, or use a tool at another angle"))
    return reasons


def _force_reasons(force_n: float, point: ContactPoint, limits: Limits) -> list[Reason]:
    if point.sensor is None or force_n >= limits.min_force_n:
        return []
    what = (
        f"press_m {point.options.press_m:.3f} gives {force_n:.2f} N, "
        f"the instrument needs {limits.min_force_n:.2f} N"
    )
    return [Reason(what, "press deeper")]
