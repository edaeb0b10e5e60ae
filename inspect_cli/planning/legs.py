"""The Plan as it is written: targets and legs with their times."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from inspect_cli.interfaces import FREE, Capabilities, Posture
from inspect_cli.planning.feasibility import clamp_of
from inspect_cli.planning.path import Way
from inspect_cli.planning.segments import Segment, Stretch, posture_model
from inspect_cli.planning.timing import duration_and_energy, path_m
from inspect_cli.schema.flight_times import PAUSE_S, SIGHT_S
from inspect_cli.schema.mission import FlightOptions, Mission
from inspect_cli.schema.plan import Leg, LegKind, Plan, PlannedSurface
from inspect_cli.spatial.arrays import Vector

JOULE_PER_WH = 3600.0
WAITING_S: dict[LegKind, float] = {
    "takeoff": PAUSE_S,
    "transit": PAUSE_S,
    "approach": 2.0 * PAUSE_S + SIGHT_S,
    "retreat": PAUSE_S,
    "land": PAUSE_S,
}
"""What the executive waits in a leg beyond its ways and its dwell: at rest at its end, and before
an approach for the surface to be seen."""


@dataclass(frozen=True)
class Itinerary:
    """The flight in postures: from standing to hover, the segments, the way home."""

    standing: Posture
    hover: Posture
    segments: tuple[Segment, ...]
    home: Way


def stretches(itinerary: Itinerary) -> Iterator[Stretch]:
    """The legs in order. A transit that leads nowhere is left out."""
    yield Stretch("takeoff", None, (itinerary.hover,))
    for index, segment in enumerate(itinerary.segments):
        if segment.way:
            yield Stretch("transit", index, segment.way)
        yield from segment.stretches(index)
    if itinerary.home:
        yield Stretch("transit", None, itinerary.home)
    yield Stretch("land", None, (itinerary.standing,))


def plan_of(
    mission: Mission,
    platform_name: str,
    capabilities: Capabilities,
    surfaces: tuple[PlannedSurface, ...],
    itinerary: Itinerary,
) -> Plan:
    """Put times to the legs and write everything down."""
    legs = []
    energy_j, length_m = 0.0, 0.0
    before = itinerary.standing
    for stretch in stretches(itinerary):
        leg, cost_j = leg_of(stretch, before, mission.flight, capabilities)
        energy_j += cost_j
        length_m += path_m((before, *stretch.postures))
        legs.append(leg)
        before = stretch.postures[-1]
    segments = itinerary.segments
    return Plan(
        mission=mission.name,
        platform=platform_name,
        impedance=mission.impedance if capabilities.impedances else None,
        surfaces=surfaces,
        start=posture_model(itinerary.standing),
        targets=tuple(segment.target(index) for index, segment in enumerate(segments)),
        legs=tuple(legs),
        duration_s=sum(leg.duration_s for leg in legs),
        energy_wh=energy_j / JOULE_PER_WH,
        path_m=length_m,
        cable_m=_cable_m(segments, clamp_of(mission.start)),
        warnings=tuple(_warnings(segments)),
    )


def leg_of(
    stretch: Stretch, before: Posture, flight: FlightOptions, capabilities: Capabilities
) -> tuple[Leg, float]:
    """The leg and the energy, J, that it takes."""
    speed_mps = stretch.speed_mps or _speed(stretch.kind, flight, capabilities)
    waiting_s = stretch.dwell_s + WAITING_S.get(stretch.kind, 0.0)
    if stretch.moving_s > 0.0:
        # The tool follows a line of its own; its time is known, its power is that of its end.
        time_s = stretch.moving_s + waiting_s
        cost_j = time_s * capabilities.power_w(stretch.postures[-1], FREE)
    else:
        postures = (before, *stretch.postures)
        time_s, cost_j = duration_and_energy(postures, speed_mps, waiting_s, capabilities)
    leg = Leg(
        kind=stretch.kind,
        target=stretch.target,
        postures=tuple(posture_model(posture) for posture in stretch.postures),
        speed_mps=speed_mps,
        duration_s=time_s,
    )
    return leg, cost_j


def _speed(kind: str, flight: FlightOptions, capabilities: Capabilities) -> float:
    slow = kind in ("approach", "press", "retreat")
    asked_mps = flight.approach_speed_mps if slow else flight.speed_mps
    return min(asked_mps, capabilities.max_speed_mps)


def _cable_m(segments: Sequence[Segment], clamp_W: Vector) -> float:
    """The longest straight distance that the cable has to span; 0 when nothing is touched."""
    tips = [tip for segment in segments for tip in segment.tips_W]
    return max((float(np.linalg.norm(tip - clamp_W)) for tip in tips), default=0.0)


def _warnings(segments: Sequence[Segment]) -> Iterator[str]:
    for segment in segments:
        if len(segment.way) > 1:
            more = len(segment.way) - 1
            yield f"point {segment.label}: no straight way is clear, it goes by {more} more"
