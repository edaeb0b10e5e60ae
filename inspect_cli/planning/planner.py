"""The Plan: from a mission to a flight that can be flown, or the reasons why it cannot."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from inspect_cli.errors import InfeasibleError, Problem
from inspect_cli.interfaces import Capabilities, Posture
from inspect_cli.planning.clearance import Scene, gap_along
from inspect_cli.planning.contact_poses import Touch, touches
from inspect_cli.planning.feasibility import (
    FREE,
    Limits,
    Reason,
    assess,
    cable_reasons,
    clamp_of,
    gap_reasons,
    margin_reasons,
)
from inspect_cli.planning.legs import Itinerary, Visit, plan_of
from inspect_cli.planning.order import visiting_order
from inspect_cli.planning.path import Stop, find_way
from inspect_cli.planning.points import ContactPoint, in_words, points_of_task
from inspect_cli.schema.mission import Mission, Start
from inspect_cli.schema.plan import Plan, PlannedSurface
from inspect_cli.schema.primitives import primitive_of
from inspect_cli.spatial.rotations import quaternion_exp


@dataclass(frozen=True)
class Situation:
    """What is the same for every point of a mission."""

    capabilities: Capabilities
    scene: Scene
    limits: Limits


def make_plan(
    mission: Mission,
    platform_name: str,
    capabilities: Capabilities,
    surfaces: tuple[PlannedSurface, ...],
    cable_m: float,
    min_force_n: float = 0.0,
    battery_wh: float = np.inf,
) -> Plan:
    """Plan the whole flight of a mission on the believed surfaces.

    ``cable_m`` is the length of the instrument's cable from the start, ``min_force_n`` the
    force below which the instrument does not read, ``battery_wh`` the usable energy. Raises
    InfeasibleError with one problem per point that cannot be touched: its label and the
    physical reasons.
    """
    scene = Scene.of(surfaces)
    standing, hover = _start_postures(mission.start, capabilities)
    limits = Limits(mission.flight.clearance_m, cable_m, clamp_of(mission.start), min_force_n)
    situation = Situation(capabilities, scene, limits)
    _check_start(situation, standing, hover)

    points = _in_order(mission, capabilities, surfaces, hover)
    visits, problems = _visit_all(situation, points, hover)
    last = visits[-1].stop if visits else Stop(hover, np.zeros(3))
    home = find_way(capabilities, scene, last, Stop(hover, np.zeros(3)), limits.clearance_m)
    if home is None:
        reason = f"no clear way home from point {visits[-1].point.label} to the start"
        problems.append(Problem(reason, hint="start elsewhere, or take off higher"))
    if problems or home is None:
        raise InfeasibleError(problems)
    itinerary = Itinerary(standing, hover, tuple(visits), home)
    plan = plan_of(mission, platform_name, capabilities, surfaces, itinerary)
    if plan.energy_wh > battery_wh:
        raise InfeasibleError(
            f"the flight takes {plan.duration_s:.0f} s and {plan.energy_wh:.0f} Wh; "
            f"the battery holds {battery_wh:g} Wh",
            hint="touch fewer points in one flight, dwell shorter, or start closer",
        )
    return plan


def _start_postures(start: Start, capabilities: Capabilities) -> tuple[Posture, Posture]:
    """The vehicle as it stands, and hovering above that at the height of take-off."""
    if start.takeoff_height_m <= capabilities.standing_height_m:
        raise InfeasibleError(
            f"start: takeoff_height_m {start.takeoff_height_m:.3f} is not above the height of "
            f"{capabilities.standing_height_m:.3f} m at which the vehicle stands",
            hint="take off higher",
        )
    x, y = start.position_m
    q_WB = quaternion_exp(np.array([0.0, 0.0, np.radians(start.heading_deg)]))
    bare = Posture(np.array([x, y, capabilities.standing_height_m]), q_WB)
    standing = _with_arm_at_rest(capabilities, bare)
    return standing, replace(standing, p_WB=np.array([x, y, start.takeoff_height_m]))


def _with_arm_at_rest(capabilities: Capabilities, bare: Posture) -> Posture:
    """The posture with its arm's angles; a vehicle takes a posture without them as at rest."""
    p_WT, R_WT = capabilities.tool_pose(bare)
    found = capabilities.posture_for_tool(p_WT, R_WT, bare)
    return bare if found is None else replace(bare, arm_angle=found.arm_angle)


def _check_start(situation: Situation, standing: Posture, hover: Posture) -> None:
    """Refuse a start from which the vehicle cannot rise."""
    scene = situation.scene.without_stood_on(standing, situation.capabilities.standing_height_m)
    gap = gap_along(situation.capabilities, scene, [standing, hover])
    # Landing gear touches the ground before take-off; only the hover has to be clear of it.
    free = gap_along(situation.capabilities, scene, [hover, hover])
    reasons = [
        *gap_reasons(replace(gap, ground_m=free.ground_m), situation.limits.clearance_m),
        *margin_reasons(situation.capabilities.margins(hover, FREE), "hovering above it"),
    ]
    if reasons:
        raise InfeasibleError(_problem("start", reasons))


def _in_order(
    mission: Mission,
    capabilities: Capabilities,
    surfaces: Sequence[PlannedSurface],
    hover: Posture,
) -> list[ContactPoint]:
    """All points in the order of the visits, tasks one after the other."""
    prims = {surface.name: primitive_of(surface.shape) for surface in surfaces}
    tip_W = capabilities.tool_pose(hover)[0]
    ordered: list[ContactPoint] = []
    for task in mission.tasks:
        contact = task.contact
        points = points_of_task(task, prims[contact.on], len(ordered) + 1)
        ordered += [points[k] for k in visiting_order(contact, points, tip_W)]
        tip_W = ordered[-1].in_front(contact.standoff_m)
    return ordered


def _visit_all(
    situation: Situation, points: Sequence[ContactPoint], hover: Posture
) -> tuple[list[Visit], list[Problem]]:
    """Visits one after the other; a point that fails is left out and its problem returned."""
    stop = Stop(hover, np.zeros(3))
    visits: list[Visit] = []
    problems: list[Problem] = []
    for point in points:
        found = _visit(situation, point, stop)
        if isinstance(found, Visit):
            visits.append(found)
            stop = found.stop
        else:
            problems.append(_problem(f"point {point.label} on '{point.surface}'", found))
    return visits, problems


def _visit(situation: Situation, point: ContactPoint, before: Stop) -> Visit | list[Reason]:
    """The best way of touching a point that can be flown, or what speaks against the best."""
    if point.fault:
        return [Reason(point.fault, "give points on the patch, or enlarge it")]
    reasons: list[Reason] = []
    for touch in touches(situation.capabilities, point, before.posture):
        found = _attempt(situation, point, touch, before)
        if isinstance(found, Visit):
            return found
        reasons = reasons or found
    return reasons or [_unreachable(point), *cable_reasons(point, situation.limits)]


def _attempt(
    situation: Situation, point: ContactPoint, touch: Touch, before: Stop
) -> Visit | list[Reason]:
    found = assess(situation.capabilities, situation.scene, point, touch, situation.limits)
    if found.reasons:
        return list(found.reasons)
    stop = Stop(touch.standoff, point.n_W)
    way = find_way(
        situation.capabilities, situation.scene, before, stop, situation.limits.clearance_m
    )
    if way is None:
        origin = in_words(before.posture.p_WB)
        clearance_m = situation.limits.clearance_m
        what = f"no way from {origin} keeps {clearance_m:.3f} m from the structure"
        return [Reason(what, "start elsewhere, or allow less clearance")]
    return Visit(point, touch, way, found)


def _unreachable(point: ContactPoint) -> Reason:
    what = f"no posture brings the tool to {in_words(point.p_WC)} along {in_words(-point.n_W)}"
    return Reason(what, "use a tool at another angle, or touch another surface")


def _problem(who: str, reasons: Sequence[Reason]) -> Problem:
    hints = dict.fromkeys(reason.hint for reason in reasons if reason.hint)
    return Problem(f"{who}: " + "; ".join(r.what for r in reasons), hint="; ".join(hints))
