"""The Plan as it is written: targets and legs with their times."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from inspect_cli.interfaces import Capabilities, Posture
from inspect_cli.planning.contact_poses import Touch
from inspect_cli.planning.feasibility import Assessment, cable_span_m, clamp_of
from inspect_cli.planning.path import Stop, Way
from inspect_cli.planning.points import ContactPoint
from inspect_cli.planning.timing import duration_and_energy, path_m
from inspect_cli.schema.base import Triple
from inspect_cli.schema.mission import FlightOptions, Mission
from inspect_cli.schema.plan import Leg, LegKind, Plan, PlannedSurface, PostureModel, Target
from inspect_cli.spatial.arrays import Vector
from inspect_cli.spatial.rotations import matrix_to_quaternion

JOULE_PER_WH = 3600.0


@dataclass(frozen=True)
class Visit:
    """A point with the way to it, the postures there and what they ask of the vehicle."""

    point: ContactPoint
    touch: Touch
    way: Way
    assessment: Assessment

    @property
    def stop(self) -> Stop:
        """Where the visit begins and ends."""
        return Stop(self.touch.standoff, self.point.n_W)


@dataclass(frozen=True)
class Itinerary:
    """The flight in postures: from standing to hover, the visits, the way home."""

    standing: Posture
    hover: Posture
    visits: tuple[Visit, ...]
    home: Way


@dataclass(frozen=True)
class Stretch:
    """A leg before it has its times; ``postures`` are those after the leg before."""

    kind: LegKind
    target: int | None
    postures: Way
    dwell_s: float = 0.0


def stretches(itinerary: Itinerary) -> Iterator[Stretch]:
    """The legs in order. A transit that leads nowhere is left out."""
    yield Stretch("takeoff", None, (itinerary.hover,))
    for index, visit in enumerate(itinerary.visits):
        if visit.way:
            yield Stretch("transit", index, visit.way)
        yield Stretch("approach", index, (visit.touch.contact,))
        yield Stretch("press", index, (visit.touch.setpoint,), visit.point.options.dwell_s)
        yield Stretch("retreat", index, (visit.touch.standoff,))
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
        postures = (before, *stretch.postures)
        speed_mps = _speed(stretch.kind, mission.flight, capabilities)
        time_s, cost_j = duration_and_energy(postures, speed_mps, stretch.dwell_s, capabilities)
        energy_j += cost_j
        length_m += path_m(postures)
        legs.append(
            Leg(
                kind=stretch.kind,
                target=stretch.target,
                postures=tuple(posture_model(posture) for posture in stretch.postures),
                speed_mps=speed_mps,
                duration_s=time_s,
            )
        )
        before = postures[-1]
    visits = itinerary.visits
    clamp_W = clamp_of(mission.start)
    return Plan(
        mission=mission.name,
        platform=platform_name,
        surfaces=surfaces,
        start=posture_model(itinerary.standing),
        targets=tuple(_target(index, visit) for index, visit in enumerate(visits)),
        legs=tuple(legs),
        duration_s=sum(leg.duration_s for leg in legs),
        energy_wh=energy_j / JOULE_PER_WH,
        path_m=length_m,
        cable_m=max(cable_span_m(v.point, clamp_W) for v in visits),
        warnings=tuple(_warnings(visits)),
    )


def posture_model(posture: Posture) -> PostureModel:
    """A posture as it is written."""
    w, x, y, z = (float(value) for value in posture.q_WB)
    return PostureModel(
        p_WB=_triple(posture.p_WB),
        q_WB=(w, x, y, z),
        arm_angle_rad=tuple(float(angle) for angle in posture.arm_angle),
    )


def _speed(kind: LegKind, flight: FlightOptions, capabilities: Capabilities) -> float:
    slow = kind in ("approach", "press", "retreat")
    asked_mps = flight.approach_speed_mps if slow else flight.speed_mps
    return min(asked_mps, capabilities.max_speed_mps)


def _target(index: int, visit: Visit) -> Target:
    point, touch, found = visit.point, visit.touch, visit.assessment
    w, x, y, z = (float(value) for value in matrix_to_quaternion(touch.R_WT))
    tilt_rad = found.margins.tilt_rad
    return Target(
        index=index,
        label=point.label,
        kind="contact",
        surface=point.surface,
        uv_m=point.uv_m,
        p_WC=_triple(point.p_WC),
        n_W=_triple(point.n_W),
        q_WT=(w, x, y, z),
        sensor=point.sensor,
        press_m=point.options.press_m,
        dwell_s=point.options.dwell_s,
        standoff_m=point.options.standoff_m,
        off_target_m=point.options.off_target_m,
        standoff=posture_model(touch.standoff),
        contact=posture_model(touch.contact),
        expected_force_n=found.force_n,
        thrust_margin_n=found.margins.thrust_n,
        tilt_margin_rad=tilt_rad if np.isfinite(tilt_rad) else None,
        clearance_m=found.gap.structure_m,
    )


def _warnings(visits: Sequence[Visit]) -> Iterator[str]:
    for visit in visits:
        if len(visit.way) > 1:
            label = visit.point.label
            yield f"point {label}: no straight way is clear, it goes by {len(visit.way) - 1} more"


def _triple(a: Vector) -> Triple:
    return (float(a[0]), float(a[1]), float(a[2]))
