"""The Plan: from a mission to a flight that can be flown, or the reasons why it cannot."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from inspect_cli.errors import InfeasibleError, Problem
from inspect_cli.interfaces import FREE, TOOL, Capabilities, FramePose, Posture
from inspect_cli.planning.clearance import Scene, gap_along
from inspect_cli.planning.feasibility import (
    Limits,
    Reason,
    clamp_of,
    gap_reasons,
    margin_reasons,
)
from inspect_cli.planning.legs import Itinerary, plan_of
from inspect_cli.planning.path import Stop, find_way
from inspect_cli.planning.segments import Segment
from inspect_cli.planning.tasks import planners_of
from inspect_cli.planning.tasks.situation import Planner, Situation
from inspect_cli.schema.mission import Mission
from inspect_cli.schema.plan import Plan, PlannedSurface
from inspect_cli.schema.primitives import primitive_of
from inspect_cli.schema.start import Start
from inspect_cli.spatial.rotations import quaternion_exp
from inspect_cli.structure.drawings import Stroke

NO_DRAWINGS: Mapping[int, Sequence[Stroke]] = {}


def make_plan(
    mission: Mission,
    platform_name: str,
    capabilities: Capabilities,
    surfaces: tuple[PlannedSurface, ...],
    cable_m: float,
    min_force_n: float = 0.0,
    battery_wh: float = np.inf,
    drawings: Mapping[int, Sequence[Stroke]] = NO_DRAWINGS,
) -> Plan:
    """Plan the whole flight of a mission on the believed surfaces.

    ``cable_m`` is the length of the instrument's cable from the start, ``min_force_n`` the
    force below which the instrument does not read, ``battery_wh`` the usable energy,
    ``drawings`` the strokes of the tasks that trace, by the task's place. Raises
    InfeasibleError with one problem per point that cannot be touched: its label and the
    physical reasons.
    """
    scene = Scene.of(surfaces)
    standing, hover = start_postures(mission.start, capabilities)
    limits = Limits(mission.flight.clearance_m, cable_m, clamp_of(mission.start), min_force_n)
    situation = Situation(capabilities, scene, limits)
    check_start(situation, standing, hover)

    prims = {surface.name: primitive_of(surface.shape) for surface in surfaces}
    planners = planners_of(mission, capabilities, prims, drawings, hover)
    segments, problems = _plan_all(situation, planners, hover)
    last = segments[-1].stop if segments else Stop(hover, np.zeros(3))
    home = find_way(capabilities, scene, last, Stop(hover, np.zeros(3)), limits.clearance_m)
    if home is None:
        reason = f"no clear way home from point {segments[-1].label} to the start"
        problems.append(Problem(reason, hint="start elsewhere, or take off higher"))
    if problems or home is None:
        raise InfeasibleError(problems)
    itinerary = Itinerary(standing, hover, tuple(segments), home)
    plan = plan_of(mission, platform_name, capabilities, surfaces, itinerary)
    if plan.energy_wh > battery_wh:
        raise InfeasibleError(
            f"the flight takes {plan.duration_s:.0f} s and {plan.energy_wh:.0f} Wh; "
            f"the battery holds {battery_wh:g} Wh",
            hint="touch fewer points in one flight, dwell shorter, or start closer",
        )
    return plan


def start_postures(start: Start, capabilities: Capabilities) -> tuple[Posture, Posture]:
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
    tool = FramePose(*capabilities.frame_pose(bare, TOOL))
    found = capabilities.solve({TOOL: tool}, FREE, bare)
    return replace(bare, joint_angle=found.joint_angle) if found else bare


def check_start(situation: Situation, standing: Posture, hover: Posture) -> None:
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


def _plan_all(
    situation: Situation, planners: Iterator[Planner], hover: Posture
) -> tuple[list[Segment], list[Problem]]:
    """Segments one after the other; one that fails is left out and its problem returned."""
    stop = Stop(hover, np.zeros(3))
    segments: list[Segment] = []
    problems: list[Problem] = []
    for planner in planners:
        found = planner.plan(situation, stop)
        if isinstance(found, list):
            problems.append(_problem(planner.name, found))
        else:
            segments.append(found)
            stop = found.stop
    return segments, problems


def _problem(who: str, reasons: Sequence[Reason]) -> Problem:
    hints = dict.fromkeys(reason.hint for reason in reasons if reason.hint)
    return Problem(f"{who}: " + "; ".join(r.what for r in reasons), hint="; ".join(hints))
